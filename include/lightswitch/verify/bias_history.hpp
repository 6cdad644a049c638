#pragma once

// What the bias of a consistent method may be, by what it was when it had fewer samples.

#include <lightswitch/core/floating_point.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace lightswitch::detail {

/// The differences of every tile in all looks so far. Density estimation is off by the squared radius, over n
/// iterations by n^(-1/3); along edges by the radius, n^(-1/6) (Knaus and Zwicker 2011, with alpha = 2/3), and a little
/// slower while the first iterations still count. Half of the latter exponent is asked for here, and of looks that had
/// an eighth of the samples at most: bias that changes its sign on the way seems to rise meanwhile.
class BiasHistory {
public:
    /// A difference of two means, and its variance.
    struct Difference {
        double size = 0, variance = 0;
    };
    using OfTiles = std::vector<std::array<Difference, 3>>;
    using OfLevels = std::vector<OfTiles>;

    /// By part and level. Looks come with more and more samples per pixel.
    void add(double samples, std::vector<OfLevels> differences) { looks_.push_back({samples, std::move(differences)}); }

    /// How large the bias may be with that many samples per pixel, as an estimate that is not too small in the mean,
    /// with its variance: by the latest look that counts, or by an earlier one where the bias was surely larger.
    /// Nothing where there is none.
    std::optional<Difference> allowed(double samples, std::size_t part, std::size_t level, std::size_t tile,
                                      std::size_t channel) const {
        std::optional<Difference> result;
        for (auto look = looks_.rbegin(); look != looks_.rend(); ++look) {
            if (look->samples * 8 > samples) continue;
            const Difference& then = look->differences[part][level][tile][channel];
            const double falls = std::pow(look->samples / samples, 1.0 / 12);
            if (!result) result = {falls * then.size, falls * falls * then.variance};
            else result->size = std::max(result->size, falls * (then.size - 2 * std::sqrt(then.variance)));
        }
        return result;
    }

private:
    struct Look {
        double samples;
        std::vector<OfLevels> differences;
    };
    std::vector<Look> looks_;
};

}  // namespace lightswitch::detail
