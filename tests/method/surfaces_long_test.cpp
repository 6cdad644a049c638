// As surfaces_test.cpp, with more scenes, and the methods that connect and those that make Markov chains. Bounds for
// photons are in surfaces_test.cpp: they blur. Light tracing alone has outliers behind rough glass that no number of
// images here would show; bdpt holds its paths.

#include "method/bidirectional.hpp"
#include "support/random_surfaces.hpp"

#include <lightswitch/method/mlt.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 in all comparisons together.
TEST_CASE("surfaces: bdpt, vcm and mlt agree with path tracing on random ones, for every path length") {
    constexpr int scenes = 12, depths[] = {2, 3, 4, 6};
    constexpr int comparisons = 3 * scenes * static_cast<int>(std::size(depths));
    for (std::uint32_t seed = 101; seed <= 100 + scenes; ++seed) {
        const TexturedScene scene = build_scene<TexturedBsdfs, AllLights>(random_surfaces(seed));
        for (const int depth : depths) {
            const auto nee = replicate(scene, PathTracerNee{.max_depth = depth, .rr_depth = 3}, 8, 16, 512);
            const auto check = [&](const auto& method, int samples) {
                const auto ours = replicate(scene, method, 8, 16, samples, Sampling::sobol, 1001);
                const Comparison comparison = compare(ours, nee, 1e-3, comparisons);
                CHECK_MESSAGE(comparison.agree(), scene.name(), ", ", method.name, ", depth ", depth, ": ", comparison);
            };
            check(Bdpt{.max_depth = depth, .rr_depth = 3}, 128);
            check(connections_only(depth, 3), 128);
            check(Mlt{.max_depth = depth}, 256);
        }
    }
}
