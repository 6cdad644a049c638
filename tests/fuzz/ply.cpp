#include "fuzz.hpp"

#include <lightswitch/load/ply.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.ply", [](const auto& path) { load_ply(path); });
}
