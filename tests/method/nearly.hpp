#pragma once

// Consistent methods: how close they come to an unbiased one.

#include "method/bidirectional.hpp"

#include <lightswitch/method/photon_mapping.hpp>

namespace lightswitch::test {

/// Photon mapping, with and without final gathering, and VCM differ from bidirectional path tracing by no more than the
/// bias that their radius of half a pixel explains: where surfaces meet or end, photons are missing, or those of the
/// other surface count. With 16 pixels across that is up to 5 % of the whole image for photons seen directly, and much
/// less for those that are seen by a further bounce, or are weighed against connections. False alarm: `false_alarm` /
/// `share` in all.
inline void check_nearly_bdpt(const TransportCase& c, int max_depth, int replicas, int samples, double false_alarm,
                              int share) {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
    const Estimate truth = replicate_finite(scene, Bdpt{.max_depth = max_depth}, 8, replicas, samples, 5001).whole[1];
    const auto check = [&](const std::string& what, const auto& method, int more, double bound) {
        const Estimate ours = replicate_finite(scene, method, 8, replicas, more * samples).whole[1];
        const double p = welch_p(ours, truth, bound * truth.mean);
        CHECK_MESSAGE(p > sidak(false_alarm, 3 * share), c.name, ", ", what, ": p ", p, ", ",
                      BiasInterval(ours, truth));
    };
    const MergeRadius radius{.pixels = 0.5f};
    check("photon", PhotonMapping{.max_depth = max_depth, .radius = radius}, 4, 0.05);
    check("photon, final gathering", PhotonMapping{.max_depth = max_depth, .radius = radius, .final_gather = true}, 2,
          0.02);
    check("vcm", Vcm{.max_depth = max_depth, .radius = radius}, 1, 0.01);
}

}  // namespace lightswitch::test
