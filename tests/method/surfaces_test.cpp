// All surface models, layers over them, and instances, against Mitsuba 3.9.1: tests/data/surfaces.

#include "method/reference.hpp"

#include <lightswitch/method/bdpt.hpp>
#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/mitsuba.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 for the tiles of each comparison. Where Mitsuba is not exact (its fits of Beckmann's masking and of
// what plastic reflects inside, up to 0.4 % of a tile), the tiles are compared at the noise of fewer samples.

namespace {

constexpr int mitsuba_samples = 8192;

auto surfaces(const std::string& name) {
    return reference(build_scene<TexturedBsdfs, AllLights>(
                         load_mitsuba(LIGHTSWITCH_TESTS_DIR "/data/surfaces/" + name + ".xml")),
                     mitsuba_samples, "surfaces");
}

void check_both(const std::string& name, int depth, const Effort& effort) {
    const auto scene = surfaces(name);
    check_reference(scene, PathTracerNee{.max_depth = depth, .rr_depth = 100}, effort);
    check_reference(scene, Bdpt{.max_depth = depth, .rr_depth = 100}, effort);
}

}  // namespace

TEST_CASE("surfaces: metals look as in Mitsuba") { check_both("metals", 8, {.samples = 16, .bias = 0.01}); }
TEST_CASE("surfaces: plastics look as in Mitsuba") { check_both("plastics", 8, {.samples = 16, .bias = 0.005}); }
TEST_CASE("surfaces: smooth, rough and thin glass look as in Mitsuba") {
    check_both("glass", 8, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: principled models look as in Mitsuba") {
    check_both("principled", 8, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: blends, masks, bump and normal maps, two sides look as in Mitsuba") {
    check_both("layers", 50, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: instances and a textured lamp look as in Mitsuba") {
    check_both("instances", 6, {.samples = 16, .bias = 0.01});
}

#endif
