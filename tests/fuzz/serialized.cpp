#include "fuzz.hpp"

#include <lightswitch/load/serialized.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.serialized", [](const auto& path) { load_serialized(path, 0); });
}
