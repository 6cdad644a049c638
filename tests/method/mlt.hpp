#pragma once

// The comparison of Metropolis light transport with path tracing.

#include "bidirectional.hpp"

#include <lightswitch/method/mlt.hpp>

namespace lightswitch::test {

/// Plans differ with `bootstrap`, expected values do not: as many paths as each replica has in 16 x 16 pixels.
inline Mlt mlt_for_tests(int max_depth, int samples = 16) {
    return {.max_depth = max_depth, .bootstrap = 256 * samples};
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

/// On 8 x 8 pixels.
inline LibraryDescription start_up() {
    LibraryDescription scene = lamp_in_sphere();
    scene.film.width = scene.film.height = 8;
    return scene;
}

}  // namespace scenes

/// Few paths to plan by.
inline Mlt start_up_mlt(bool refine) { return {.bootstrap = 512, .refine = refine}; }

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
