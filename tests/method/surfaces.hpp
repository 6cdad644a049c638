#pragma once

// Methods against path-nee on random scenes of all surface models, layers and instances, for every path length.

#include "support/random_surfaces.hpp"
#include "support/renders.hpp"
#include "support/statistics.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace lightswitch::test {

/// Which scenes, how long the paths, and how path-nee and the others sample.
struct SurfacesCase {
    std::uint32_t first_seed;
    int scenes;
    std::vector<int> depths;
    int methods;  ///< how many are checked each time
    int rr_depth, nee_samples;
    Sampling sampling;
};

/// `check_methods(depth, check)` calls `check(method, samples)` for each method. False alarm: 1e-3 in all.
void check_on_random_surfaces(const SurfacesCase& c, const auto& check_methods) {
    const int comparisons = c.methods * c.scenes * static_cast<int>(c.depths.size());
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(c.scenes); ++i) {
        const TexturedScene scene = build_scene<TexturedBsdfs, AllLights>(random_surfaces(c.first_seed + i));
        for (const int depth : c.depths) {
            const PathTracerNee path_nee{.max_depth = depth, .rr_depth = c.rr_depth};
            const auto nee = replicate(scene, path_nee, 8, 16, c.nee_samples);
            check_methods(depth, [&](const auto& method, int samples) {
                const auto ours = replicate(scene, method, 8, 16, samples, c.sampling, 1001);
                const Comparison comparison = compare(ours, nee, 1e-3, comparisons);
                CHECK_MESSAGE(comparison.agree(), scene.name(), ", ", method.name, ", depth ", depth, ": ", comparison);
            });
        }
    }
}

}  // namespace lightswitch::test
