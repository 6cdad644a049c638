#pragma once

// Running means and correlations, with their standard errors.

#include <cmath>
#include <cstdint>

namespace lightswitch::test {

/// Mean of independent values and its standard error (Welford 1962).
class Mean {
public:
    void add(double x) {
        ++count_;
        const double before = x - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (x - mean_);
    }
    double value() const { return mean_; }
    double variance() const { return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : 0; }
    double error() const { return std::sqrt(variance() / static_cast<double>(count_)); }
    std::uint64_t count() const { return count_; }
    /// How many standard errors the mean is away from `truth`. `rounding` is an absolute error that is no evidence.
    double sigmas(double truth, double rounding = 0) const {
        const double off = std::max(0.0, std::abs(mean_ - truth) - rounding);
        return off == 0 ? 0 : off / error();
    }

private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

/// Correlation of pairs of numbers that are uniform in [0, 1): the mean and deviation are known, not estimated.
class UniformCorrelation {
public:
    void add(double x, double y) { product_.add((x - 0.5) * (y - 0.5) * 12); }
    double value() const { return product_.value(); }
    /// Standard normal (for many pairs) when the numbers are independent: products have the deviation 1.
    double sigmas() const { return value() * std::sqrt(static_cast<double>(product_.count())); }

private:
    Mean product_;
};

}  // namespace lightswitch::test
