#pragma once

// How the iterations of a render are shared between processes that differ in speed.

#include <lightswitch/core/floating_point.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace lightswitch::detail {

/// How many iterations each of several processes makes in a round of about `seconds`, of at most `left` in all. `rates`
/// are iterations a second; 0 where that is not known yet, and then everyone makes one. With `in_time` nobody makes one
/// that would take longer than the round; without, everyone makes at least one. When what is left is little more than
/// one round, all of it is shared out, in proportion, so that all end together.
inline std::vector<std::uint64_t> shares(std::span<const double> rates, double seconds, std::uint64_t left,
                                         bool in_time) {
    std::vector<std::uint64_t> result(rates.size(), 1);
    const bool known = std::all_of(rates.begin(), rates.end(), [](double rate) { return rate > 0; });
    if (known)
        for (std::size_t i = 0; i < rates.size(); ++i) {
            const double most = std::min(std::floor(rates[i] * seconds), 0x1p30);
            result[i] = static_cast<std::uint64_t>(in_time ? std::max(most, 0.0) : std::max(most, 1.0));
        }
    const std::uint64_t sum = std::accumulate(result.begin(), result.end(), std::uint64_t{0});
    if (sum <= left && (in_time || !known || sum + sum / 2 < left)) return result;

    // By the largest remainders; of equal ones the first process comes first.
    const double all = known ? std::accumulate(rates.begin(), rates.end(), 0.0) : double(rates.size());
    std::vector<double> remainder(rates.size());
    std::uint64_t given = 0;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        const double ideal = double(left) * ((known ? rates[i] : 1.0) / all);
        result[i] = std::min(static_cast<std::uint64_t>(ideal), left - given);
        remainder[i] = ideal - double(result[i]);
        given += result[i];
    }
    for (; given < left; ++given) {
        const auto most = std::max_element(remainder.begin(), remainder.end());
        ++result[static_cast<std::size_t>(most - remainder.begin())];
        *most -= 1;
    }
    return result;
}

}  // namespace lightswitch::detail
