// The smallest program: a scene, a method, an image.

#include <lightswitch/lightswitch.hpp>

#include <cstdio>

namespace ls = lightswitch;

int main() try {
    const auto scene = ls::stock::cornell_box();
    const ls::Image image = ls::render(scene, ls::PathTracerNee{}, {.samples = 64});
    ls::save("cornell-box.png", image);
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
