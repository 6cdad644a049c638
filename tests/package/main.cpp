// A program outside of the project: as much as shows that the headers, their dependencies and the targets work
// together.
#include <lightswitch/lightswitch.hpp>
#include <lightswitch/version.hpp>

#include <cstdio>

namespace ls = lightswitch;

int main() {
    const auto scene = ls::stock::furnace(0.5f);
    const ls::Image image = ls::render(scene, ls::PathTracer{.max_depth = 2}, {.samples = 1});
    const double mean = image.mean().x;
    if (mean != 1.5) {
        std::printf("the furnace up to direct light is %g, not 1.5\n", mean);
        return 1;
    }
    std::printf("lightswitch %s\n", lightswitch::version().c_str());
}
