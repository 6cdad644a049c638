// All surface models, layers over them, and instances, against Mitsuba 3.9.1: tests/data/surfaces; and methods against
// each other on random scenes of them.

#include "method/reference.hpp"
#include "support/random_surfaces.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/scene/any_scene.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/mitsuba.hpp>

// False alarm: 1e-3 for the tiles of each comparison. Where Mitsuba is not exact (its fits of Beckmann's masking and of
// what plastic reflects inside, up to 0.4 % of a tile), the tiles are compared at the noise of fewer samples.

namespace {

constexpr int mitsuba_samples = 8192;

auto surfaces(const std::string& name) {
    return reference(
        build_scene<TexturedBsdfs, AllLights>(load_mitsuba(LIGHTSWITCH_TESTS_DIR "/data/surfaces/" + name + ".xml")),
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

// False alarm: 1e-3 in all comparisons together.
TEST_CASE("surfaces: methods agree on random ones, for every path length") {
    constexpr int scenes = 4, depths[] = {2, 3, 5};
    constexpr int comparisons = 2 * scenes * static_cast<int>(std::size(depths));
    for (std::uint32_t seed = 1; seed <= scenes; ++seed) {
        const TexturedScene scene = build_scene<TexturedBsdfs, AllLights>(random_surfaces(seed));
        for (const int depth : depths) {
            const auto nee = replicate(scene, PathTracerNee{.max_depth = depth, .rr_depth = 1}, 8, 16, 64);
            const auto check = [&](const auto& method, int samples) {
                const auto ours = replicate(scene, method, 8, 16, samples, Sampling::independent, 1001);
                const Comparison comparison = compare(ours, nee, 1e-3, comparisons);
                CHECK_MESSAGE(comparison.agree(), scene.name(), ", ", method.name, ", depth ", depth, ": ", comparison);
            };
            check(PathTracer{.max_depth = depth}, 128);
            check(Bdpt{.max_depth = depth, .rr_depth = 1}, 32);
        }
    }
}
