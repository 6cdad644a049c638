#pragma once

#include "support/random_scenes.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

namespace lightswitch::test {

/// Path tracing with and without next event estimation must agree on random scenes, for every limit of the path length,
/// with a false alarm of at most `false_alarm` in all comparisons together. Tiles average over 64 pixels times all
/// samples of a replica.
inline void check_agreement(std::uint32_t first_scene, int scenes, int samples, double false_alarm) {
    constexpr int depths[] = {1, 2, 3, 4, 5, -1};
    const int comparisons = scenes * static_cast<int>(std::size(depths));
    for (std::uint32_t seed = first_scene; seed < first_scene + static_cast<std::uint32_t>(scenes); ++seed) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(random_scene(seed));
        for (const int depth : depths) {
            // Roulette from the first bounce on in one of them: nothing is shared between the two but the scene.
            const auto nee =
                replicate(scene, PathTracerNee{.max_depth = depth, .rr_depth = 1}, 8, 16, samples, Sampling::sobol, 1);
            const auto path =
                replicate(scene, PathTracer{.max_depth = depth}, 8, 16, samples, Sampling::independent, 1001);
            const Comparison comparison = compare(nee, path, false_alarm, comparisons);
            CHECK_MESSAGE(comparison.agree(), "scene ", seed, " depth ", depth, ": ", comparison);
        }
    }
}

}  // namespace lightswitch::test
