#include "fuzz.hpp"

#include <lightswitch/load/obj_scene.hpp>
#include <lightswitch/scene/check.hpp>

using namespace lightswitch;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string obj =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 -2e-3\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1\nusemtl one\nf 2 3 4\n"
        "usemtl two\nf 1 3 4\nf 1 2 4\nusemtl three\nf 4 3 2 1\n";
    return test::read_bytes(data, size, "a.mtl", [](const auto&) {
        detail::check(load_obj_scene(test::fuzz_folder().write("a.obj", obj)));
    });
}
