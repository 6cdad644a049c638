#include "fuzz.hpp"

#include <lightswitch/load/mitsuba.hpp>
#include <lightswitch/scene/check.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.xml", [](const auto& path) {
        detail::check(load_mitsuba(path, MitsubaOptions{.strictness = Strictness::lenient}));
    });
}
