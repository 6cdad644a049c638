// The method is chosen at run time, once per render: 02_switch [METHOD]
//
// Below the one std::visit everything is compiled for the concrete method and the concrete scene type.

#include <lightswitch/lightswitch.hpp>

#include <cstdio>
#include <string>

namespace ls = lightswitch;

int main(int argc, char** argv) try {
    const ls::AnyMethod method = ls::method_by_name(argc > 1 ? argv[1] : "phong");
    const auto scene = ls::stock::cornell_sculpture();
    const ls::Image image = std::visit([&](const auto& m) { return ls::render(scene, m, {.samples = 64}); }, method);

    const std::string file = "sculpture-" + std::string(ls::method_name(method)) + ".png";
    ls::save(file, image);
    std::printf("wrote %s\n", file.c_str());
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
