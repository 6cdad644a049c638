#include "fuzz.hpp"

#include <lightswitch/load/obj.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.obj", [](const auto& path) { load_obj(path); });
}
