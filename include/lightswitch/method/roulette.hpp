#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/render/recording.hpp>

namespace lightswitch {

/// How long paths may become: what every path-based method asks its user.
struct PathLength {
    int max_depth = -1;  ///< 1 is emission seen directly, 2 adds direct light, and so on; 0 is black, -1 unlimited
    int rr_depth = 5;    ///< Russian roulette begins after that many bounces
};

/// The probability with which a path of that throughput goes on once roulette has begun; see `survives_roulette`.
///
/// It is at most 0.999 so that paths between surfaces that absorb nothing end at all. A lower limit q would give paths
/// between surfaces of an albedo a > q weights that grow by a / q at every bounce: their variance is that of a sum of
/// (a^2 / q)^n over the bounces n, and infinite from a = sqrt(q) on.
inline float survival_probability(float largest, float eta) {
    // In this order a NaN gives 0.999: such a path goes on until it is counted where its radiance arrives.
    return std::min(0.999f, largest * eta * eta);
}

/// Russian roulette after `bounces` bounces (counted from 1): false ends the path; otherwise `throughput` is divided by
/// the probability of going on. `eta` is the product of the relative indices of refraction crossed: radiance grows by
/// its square inside a medium and falls again on leaving, and must not raise the survival (Walter's fix, as in Mitsuba
/// 3).
inline bool survives_roulette(Rgb& throughput, float eta, int bounces, int rr_depth, float u) {
    const float largest = max_component(throughput);
    if (largest == 0) return false;
    if (bounces <= rr_depth) return true;
    const float probability = survival_probability(largest, eta);
    if (u >= probability) return false;
    throughput /= probability;
    return true;
}

/// Tells a scene that listens of a bounce, before `survives_roulette` is asked with the same arguments. The path
/// carries `start` times the throughput.
[[gnu::always_inline]] inline void tell_bounce([[maybe_unused]] const auto& scene,
                                               [[maybe_unused]] const BsdfSample& scattered,
                                               [[maybe_unused]] const Vec3& direction,
                                               [[maybe_unused]] const Rgb& throughput, [[maybe_unused]] float eta,
                                               [[maybe_unused]] int bounces, [[maybe_unused]] int rr_depth,
                                               [[maybe_unused]] float u, [[maybe_unused]] const Rgb& start = Rgb(1)) {
    if constexpr (records<decltype(scene)>) {
        const float largest = max_component(throughput);
        const float survival = largest == 0 ? 0 : bounces <= rr_depth ? 1 : survival_probability(largest, eta);
        scene.tell(Scattered{.direction = direction,
                             .pdf = scattered.pdf,
                             .specular = scattered.specular,
                             .throughput = start * throughput,
                             .survival = survival,
                             .survived = !(u >= survival)});
    }
}

}  // namespace lightswitch
