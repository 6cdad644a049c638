#pragma once

// Means of few noisy values, and whether two of them can have the same expectation: Welch's test, and what becomes of
// it when rare events decide.

#include <lightswitch/core/floating_point.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace lightswitch {

/// Regularised incomplete beta function I_x(a, b) by Lentz's continued fraction (Numerical Recipes, section 6.4).
inline double incomplete_beta(double a, double b, double x) {
    if (!(x > 0)) return 0;
    if (!(x < 1)) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
    double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), h = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + even * d);
        c = 1 + even / c;
        h *= c * d;
        d = 1 / (1 + odd * d);
        c = 1 + odd / c;
        h *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * h;
}

/// Probability that Student's t with that many degrees of freedom (may be infinite) is at least |t| away from 0, on
/// either side.
inline double student_p(double t, double freedom) {
    if (std::isinf(freedom)) return std::erfc(std::abs(t) / std::sqrt(2.0));
    return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

namespace detail {

/// The x >= 0 at which the falling function `f` reaches `value`.
template <class F>
double solve_falling(double value, F f) {
    double low = 0, high = 1;
    while (f(high) > value && high < 1e150) high *= 2;
    for (int i = 0; i < 80 && high - low > 1e-12 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) > value ? low : high) = middle;
    }
    return high;
}

}  // namespace detail

/// The |t| that is exceeded with probability `p`.
inline double student_quantile(double p, double freedom) {
    return detail::solve_falling(p, [freedom](double t) { return student_p(t, freedom); });
}

/// Mean, variance and third central moment of values that come one by one (Pebay 2008, "Formulas for robust, one-pass
/// parallel computation of covariances and arbitrary-order statistical moments").
class Moments {
public:
    void add(double x) {
        const double before = static_cast<double>(count_++), n = before + 1;
        const double delta = x - mean_, step = delta / n, term = delta * step * before;
        mean_ += step;
        third_ += term * step * (n - 2) - 3 * step * second_;
        second_ += term;
    }

    std::uint64_t count() const { return count_; }
    double mean() const { return mean_; }
    /// Unbiased; 0 for fewer than two values.
    double variance() const { return count_ > 1 ? second_ / static_cast<double>(count_ - 1) : 0; }
    /// Third central moment, unbiased; 0 for fewer than three values.
    double third() const {
        const double n = static_cast<double>(count_);
        return count_ > 2 ? third_ * n / ((n - 1) * (n - 2)) : 0;
    }

private:
    std::uint64_t count_ = 0;
    double mean_ = 0, second_ = 0, third_ = 0;
};

/// A mean, and the second and third central moment of the mean itself.
struct Estimate {
    double mean = 0, variance = 0;
    double freedom = std::numeric_limits<double>::infinity();  ///< degrees of freedom with which the variance is known
    double third = 0;
    double unseen = 0;  ///< how much one more rare event, such as may not have happened yet, would raise the mean

    /// What is known without noise.
    static Estimate exact(double value) { return {value, 0, std::numeric_limits<double>::infinity(), 0, 0}; }
    /// Of independent values that have the same expectation. Of the third moment only what exceeds two standard
    /// errors, as normal values would have them, counts: else the noise of a few values would look like skewness.
    static Estimate of(const Moments& m) {
        const double n = static_cast<double>(m.count());
        const double noise = 2 * std::sqrt(6 / n * m.variance()) * m.variance();
        const double third = std::copysign(std::max(0.0, std::abs(m.third()) - noise), m.third());
        return {m.mean(), m.variance() / n, n - 1, third / (n * n), 0};
    }
    static Estimate of(std::span<const double> values) {
        Moments moments;
        for (const double v : values) moments.add(v);
        return of(moments);
    }

    /// With the degrees of freedom of Welch and Satterthwaite.
    friend Estimate operator-(const Estimate& a, const Estimate& b) {
        const double sum = a.variance + b.variance;
        const double inverse = a.variance * a.variance / a.freedom + b.variance * b.variance / b.freedom;
        return {a.mean - b.mean, sum, inverse > 0 ? sum * sum / inverse : a.freedom + b.freedom, a.third - b.third, 0};
    }
};

namespace detail {

/// -log of the probability that a sum of rare events falls `z` standard deviations short, where the deviation is
/// judged by the events that were seen and the sum has skewness `skew`.
///
/// A sum of Poisson events has skewness 1 / sqrt(number of events). When j were seen, z deviations short of k = j + z
/// sqrt(j), the probability of j or fewer is about exp(-(k - j - j log(k / j))). For skew -> 0 this is the normal z^2
/// / 2; its next term is that of Edgeworth's expansion of Student's t. It grows without bound only as the missing
/// events grow in number, so a sum that has not seen them cannot seem certain.
inline double shortfall_rate(double z, double skew) {
    if (z * skew < 1e-3) return 0.5 * z * z - z * z * z * skew / 3;
    return (z * skew - std::log1p(z * skew)) / (skew * skew);
}

/// log of the normal probability beyond |z| on either side, for z from 0 to far beyond what a double can hold.
inline double log_normal_p(double z) {
    if (z < 25) return std::log(std::erfc(z / std::sqrt(2.0)));
    return -0.5 * z * z - std::log(z * std::sqrt(0.5 * 3.14159265358979)) - 1 / (z * z);
}

/// log of the p-value z of which is corrected for skewness.
inline double log_corrected_p(double z, double skew) { return log_normal_p(z) + 0.5 * z * z - shortfall_rate(z, skew); }

/// The normal number as improbable as Student's t, and back; in proportion where that is less than any double.
inline double normal_from_student(double t, double freedom) {
    constexpr double least = 1e-300, infinite = std::numeric_limits<double>::infinity();
    if (std::isinf(freedom)) return t;
    if (const double p = student_p(t, freedom); p > least) return student_quantile(p, infinite);
    return t * student_quantile(least, infinite) / student_quantile(least, freedom);
}
inline double student_from_normal(double z, double freedom) {
    constexpr double least = 1e-300, infinite = std::numeric_limits<double>::infinity();
    if (std::isinf(freedom)) return z;
    if (const double log_p = log_normal_p(z); log_p > std::log(least))
        return student_quantile(std::exp(log_p), freedom);
    return z * student_quantile(least, freedom) / student_quantile(least, infinite);
}

/// Skewness of the difference a - b on the side that makes it seem too small: `a` missed rare large values, or `b` rare
/// negative ones.
inline double missing_skew(const Estimate& a, const Estimate& b) {
    const double third = std::max(0.0, a.third) + std::max(0.0, -b.third), variance = a.variance + b.variance;
    return variance > 0 ? third / std::pow(variance, 1.5) : 0;
}

}  // namespace detail

/// The probability of a difference at least as large when the expectations are equal: Welch's test, with two
/// corrections for rare events that the smaller side may have missed. Those of a kind that was seen: see
/// `detail::shortfall_rate`. Those of a kind that was not: if `Estimate::unseen` is what one of them adds, k =
/// difference / unseen of them are missing, which happens with probability exp(-k). Differences of up to `allowed`
/// are no evidence.
inline double welch_p(const Estimate& a, const Estimate& b, double allowed = 0) {
    const Estimate difference = a - b;
    const double beyond = std::abs(difference.mean) - allowed;
    if (!(beyond > 0)) return std::isnan(beyond) ? 0 : 1;
    const bool a_is_less = difference.mean < 0;
    const double unseen = a_is_less ? a.unseen : b.unseen, none_happened = unseen > 0 ? std::exp(-beyond / unseen) : 0;
    if (!(difference.variance > 0)) return none_happened;
    const double t = beyond / std::sqrt(difference.variance);
    double p = std::max(student_p(t, difference.freedom), 1e-300);
    if (const double skew = a_is_less ? detail::missing_skew(a, b) : detail::missing_skew(b, a); skew > 0 && p < 0.05) {
        p = std::exp(detail::log_corrected_p(detail::normal_from_student(t, difference.freedom), skew));
    }
    return std::min(1.0, std::max(p, none_happened));
}

/// An interval for a difference of expectations.
struct Interval {
    double low = 0, high = 0;
};

/// All differences of the expectations of `a` and `b` that `welch_p` does not refuse at the level `p`.
inline Interval welch_interval(const Estimate& a, const Estimate& b, double p) {
    const Estimate difference = a - b;
    const double sigma = std::sqrt(difference.variance);
    const auto reach = [&](double skew, double unseen) {
        double sigmas = 0;
        if (sigma > 0 && skew > 0) {
            const double z =
                detail::solve_falling(std::log(p), [skew](double x) { return detail::log_corrected_p(x, skew); });
            sigmas = detail::student_from_normal(z, difference.freedom);
        } else if (sigma > 0) {
            sigmas = student_quantile(p, difference.freedom);
        }
        return std::max(sigmas * sigma, -std::log(p) * unseen);
    };
    // The true difference is larger than it seems when `a` fell short.
    return {difference.mean - reach(detail::missing_skew(b, a), b.unseen),
            difference.mean + reach(detail::missing_skew(a, b), a.unseen)};
}

}  // namespace lightswitch
