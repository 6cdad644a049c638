#include "fuzz.hpp"

#include <lightswitch/texture/load_bitmap.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.png", [](const auto& path) { load_bitmap(path); });
}
