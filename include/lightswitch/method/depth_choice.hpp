#pragma once

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <vector>

namespace lightswitch {

/// A choice of path lengths from 2 segments on, up to a limit or without end: a table for the short ones, and a
/// geometric tail.
class DepthChoice {
public:
    /// Before anything is known: each length three quarters as often as the one before. `max_depth` (at least 2) is as
    /// in `PathLength`.
    explicit DepthChoice(int max_depth = 2) : max_depth_(max_depth) {
        weights_.resize(static_cast<std::size_t>(max_depth < 0 ? table_size : std::min(table_size, max_depth - 1)));
        double weight = 1;
        for (double& w : weights_) {
            w = weight;
            weight *= 0.75;
        }
        tail_ = bounded_by_table() ? 0 : weight * 4;
        normalize();
    }

    /// Half as before, half in proportion to `power[i]`, which lengths of i segments were found to carry; those beyond
    /// the table count to the tail.
    void learn(const std::vector<double>& power) {
        double sum = 0;
        for (const double p : power) sum += p;
        if (!(sum > 0)) return;
        for (std::size_t depth = 2; depth < power.size(); ++depth) {
            if (depth - 2 < weights_.size()) weights_[depth - 2] += power[depth] / sum;
            else if (!bounded_by_table()) tail_ += power[depth] / sum;
        }
        normalize();
    }

    /// The length for `u` in [0, 1).
    int sample(double u) const {
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            if (u < weights_[i]) return static_cast<int>(i) + 2;
            u -= weights_[i];
        }
        // Rounding may leave a rest without a tail.
        if (!(tail_ > 0)) return static_cast<int>(weights_.size()) + 1;
        const double steps = std::floor(std::log1p(-std::clamp(u / tail_, 0.0, 1 - 0x1p-53)) / std::log(ratio));
        const int depth = static_cast<int>(weights_.size()) + 2 + static_cast<int>(steps);
        return max_depth_ < 0 ? depth : std::min(depth, max_depth_);
    }

    double probability(int depth) const {
        const auto i = static_cast<std::size_t>(depth - 2);
        if (i < weights_.size()) return weights_[i];
        const double from_here = tail_ * std::pow(ratio, double(i - weights_.size()));
        return depth == max_depth_ ? from_here : from_here * (1 - ratio);
    }

private:
    static constexpr int table_size = 30;
    static constexpr double ratio = 0.9;  // of the tail

    bool bounded_by_table() const { return max_depth_ >= 0 && max_depth_ - 1 <= table_size; }
    void normalize() {
        double sum = tail_;
        for (const double w : weights_) sum += w;
        for (double& w : weights_) w /= sum;
        tail_ /= sum;
    }

    int max_depth_;
    std::vector<double> weights_;  // of lengths 2, 3, ...
    double tail_ = 0;              // of all longer ones
};

}  // namespace lightswitch
