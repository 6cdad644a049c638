#include "fuzz.hpp"

#include <lightswitch/load/stl.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.stl", [](const auto& path) { load_stl(path); });
}
