#pragma once

// The comparison of Metropolis light transport with path tracing.

#include "bidirectional.hpp"

#include <lightswitch/method/mlt.hpp>

namespace lightswitch::test {

/// `refine` biases first iterations by about v / n, with v the relative variance of a path's target and n `bootstrap`.
/// v is 1 to 50 for most scenes here (168 for cornell-spheres, 230 for camera in glass, 470 for veach-mis, 650 for
/// light in mirror: as seen in the spread of `normalization` over seeds without `refine`), and a case's `samples` grows
/// with it, so that v / n is at most 0.6 % (2 % for the last two). The noise of the brightness alone, which is the
/// least that a comparison of 8 replicas must allow for, is about sqrt(v / n / 16): 2 % and more where v / n is that
/// large.
inline Mlt mlt_for_tests(int max_depth, int samples = 16) {
    return {.max_depth = max_depth, .bootstrap = 512 * samples};
}

/// Compares `mlt` with `truth`. False alarm: `false_alarm` / `share`.
template <class SceneType>
void check_mlt(const TransportCase& c, const SceneType& scene, const TileEstimates& truth, int depth, int replicas,
               double false_alarm, int share) {
    const auto estimates =
        replicate_finite(scene, mlt_for_tests(depth, c.samples), truth.side, replicas, 4 * c.samples, 401);
    const Comparison comparison = compare(estimates, truth, false_alarm, share);
    CHECK_MESSAGE(comparison.agree(), c.name, ", depth ", depth, ": ", comparison);
}

/// The same against path tracing with next event estimation.
inline void check_mlt_against_path_nee(const TransportCase& c, std::initializer_list<int> depths, int replicas,
                                       double false_alarm, int share) {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
    for (const int depth : depths)
        check_mlt(c, scene, replicate_finite(scene, PathTracerNee{.max_depth = depth}, 8, replicas, 4 * c.samples, 1),
                  depth, replicas, false_alarm, share * static_cast<int>(depths.size()));
}

namespace scenes {

/// On 8 x 8 pixels, which are 4 chains.
inline LibraryDescription start_up() {
    LibraryDescription scene = lamp_in_sphere();
    scene.film.width = scene.film.height = 8;
    return scene;
}

}  // namespace scenes

/// Few paths to start from, and chains that forget slowly.
inline Mlt start_up_mlt(bool refine) { return {.bootstrap = 512, .large_steps = 0.05f, .refine = refine}; }

/// Scenes of every kind of light, surface, camera and filter, of which some can be seen by few strategies only.
inline std::vector<TransportCase> mlt_cases() {
    using namespace scenes;
    std::vector<TransportCase> cases{{"cornell-box", on_small_film(stock::describe_cornell_box())},
                                     {"cornell-spheres", on_small_film(stock::describe_cornell_spheres()), false, 64},
                                     {"point in box", point_in_box()},
                                     {"white sphere", white_sphere_in_white()},
                                     {"stage under sun", stage_under_sun()},
                                     {"light in mirror", light_in_mirror(), true, 64},
                                     {"lens", lens()},
                                     {"far camera", far_camera()},
                                     {"gaussian", filtered(Filter::gaussian())}};
    for (const std::uint32_t number : {1u, 2u, 3u})
        cases.push_back({"random " + std::to_string(number), random_scene(number)});
    return cases;
}

}  // namespace lightswitch::test
