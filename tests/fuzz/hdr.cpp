#include "fuzz.hpp"

#include <lightswitch/film/image_io.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return test::read_bytes(data, size, "a.hdr", [](const auto& path) { load_image(path); });
}
