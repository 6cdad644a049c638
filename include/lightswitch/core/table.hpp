#pragma once

// Discrete probability distributions.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <span>
#include <vector>

namespace lightswitch {

/// Chooses an index with probability proportional to its weight, in constant expected time.
///
/// Inverts the cumulative distribution with a guide table (Chen and Asau 1974): unlike an alias table the map from `u`
/// to the index is monotone, which keeps the stratification of the sample points. Probabilities are rounded to whole
/// multiples of 2^-24, the steps of the sampler's numbers, and to no less than one step for a positive weight: what
/// `probability` says is exactly what happens, so that values divided by it are unbiased. Immutable: safe to use from
/// several threads.
class DiscreteDistribution {
public:
    DiscreteDistribution() = default;
    /// At most 2^24 weights, finite and not negative, with a positive sum; throws `Error` otherwise.
    explicit DiscreteDistribution(std::span<const double> weights) {
        double total = 0;
        for (const double w : weights) {
            if (!(w >= 0 && w <= std::numeric_limits<double>::max())) throw Error("a weight is negative or not finite");
            total += w;
        }
        if (!(total > 0 && total <= std::numeric_limits<double>::max())) throw Error("the weights add up to nothing");
        const std::size_t n = weights.size();
        if (n > std::size_t{1} << 24) throw Error("more than 2^24 weights: too many for one number to choose from");
        std::size_t positive_left = n - static_cast<std::size_t>(std::count(weights.begin(), weights.end(), 0.0));
        cumulative_.resize(n);
        probability_.resize(n);
        double sum = 0, previous = 0;  // `previous` in steps of 2^-24
        for (std::size_t i = 0; i < n; ++i) {
            sum += weights[i];
            double steps = previous;
            if (weights[i] > 0) {
                --positive_left;
                steps = std::clamp(std::round(sum / total * 0x1p24), previous + 1,
                                   0x1p24 - static_cast<double>(positive_left));
            }
            cumulative_[i] = static_cast<float>(steps * 0x1p-24);
            probability_[i] = static_cast<float>((steps - previous) * 0x1p-24);
            previous = steps;
        }
        // Whatever the number, the search ends at an index that can be chosen.
        for (std::size_t i = n; i-- > 0 && cumulative_[i] == 1;) cumulative_[i] = infinity;
        guide_.resize(n);
        std::uint32_t i = 0;
        for (std::size_t bucket = 0; bucket < n; ++bucket) {
            while (cumulative_[i] <= static_cast<double>(bucket) / static_cast<double>(n)) ++i;
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
        while (cumulative_[i] <= u) ++i;
        return i;
    }

private:
    std::vector<float> cumulative_, probability_;
    std::vector<std::uint32_t> guide_;
};

}  // namespace lightswitch
