#include "fuzz.hpp"

#include <lightswitch/load/gltf.hpp>
#include <lightswitch/scene/check.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const bool binary = size >= 4 && std::string(data, data + 4) == "glTF";
    return test::read_bytes(data, size, binary ? "a.glb" : "a.gltf",
                            [](const auto& path) { detail::check(load_gltf(path)); });
}
