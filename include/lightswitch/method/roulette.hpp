#pragma once

#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// How long paths may become: what every path-based method asks its user.
struct PathLength {
    int max_depth = -1;  ///< 1 is emission seen directly, 2 adds direct light, and so on; 0 is black, -1 unlimited
    int rr_depth = 5;    ///< Russian roulette begins after that many bounces
};

/// Russian roulette after `bounces` bounces (counted from 1): false ends the path; otherwise `throughput` is divided by
/// the probability of going on. `eta` is the product of the relative indices of refraction crossed: radiance grows by
/// its square inside a medium and falls again on leaving, and must not raise the survival (Walter's fix, as in Mitsuba
/// 3).
inline bool survives_roulette(Rgb& throughput, float eta, int bounces, int rr_depth, float u) {
    const float largest = max_component(throughput);
    if (largest == 0) return false;
    if (bounces <= rr_depth) return true;
    // In this order a NaN gives 0.95: such a path goes on until it is counted where its radiance arrives.
    const float probability = std::min(0.95f, largest * eta * eta);
    if (u >= probability) return false;
    throughput /= probability;
    return true;
}

}  // namespace lightswitch
