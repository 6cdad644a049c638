#pragma once

// Discrete probability distributions.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <span>
#include <vector>

namespace lightswitch {

/// Chooses an index with probability proportional to its weight, in constant expected time.
///
/// Inverts the cumulative distribution with a guide table (Chen and Asau 1974): unlike an alias table the map from `u` to the
/// index is monotone, which keeps the stratification of the sample points. Immutable: safe to use from several threads.
class DiscreteDistribution {
public:
    DiscreteDistribution() = default;
    /// Weights must be finite and not negative, with a positive sum; throws `Error` otherwise.
    explicit DiscreteDistribution(std::span<const double> weights) {
        double total = 0;
        for (const double w : weights) {
            if (!(w >= 0 && w <= std::numeric_limits<double>::max())) throw Error("a weight is negative or not finite");
            total += w;
        }
        if (!(total > 0 && total <= std::numeric_limits<double>::max())) throw Error("the weights add up to nothing");
        const std::size_t n = weights.size();
        cumulative_.resize(n);
        probability_.resize(n);
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += weights[i];
            cumulative_[i] = static_cast<float>(sum / total);
            probability_[i] = static_cast<float>(weights[i] / total);
        }
        // The last index that can be chosen catches what rounding leaves below 1.
        std::size_t last = n;
        while (last-- > 0 && !(weights[last] > 0)) {}
        for (std::size_t i = last; i < n; ++i) cumulative_[i] = 1;
        guide_.resize(n);
        std::uint32_t i = 0;
        for (std::size_t bucket = 0; bucket < n; ++bucket) {
            while (cumulative_[i] <= static_cast<float>(bucket) / static_cast<float>(n)) ++i;
            guide_[bucket] = i;
        }
    }

    std::size_t size() const { return probability_.size(); }
    bool empty() const { return probability_.empty(); }
    float probability(std::size_t index) const { return probability_[index]; }

    /// The index for `u` in [0, 1). Must not be empty.
    std::size_t sample(float u) const {
        const auto bucket = static_cast<std::size_t>(u * static_cast<float>(size()));
        std::size_t i = guide_[std::min(bucket, size() - 1)];
        while (i > 0 && cumulative_[i - 1] > u) --i;  // only when `u * size()` was rounded up into the next bucket
        while (cumulative_[i] <= u) ++i;
        return i;
    }

private:
    std::vector<float> cumulative_, probability_;
    std::vector<std::uint32_t> guide_;
};

}  // namespace lightswitch
