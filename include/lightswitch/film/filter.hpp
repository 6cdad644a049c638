#pragma once

// Pixel reconstruction filters, applied by importance sampling: a sample's position is drawn from the filter around the
// pixel's centre and counts with weight 1, so that a pixel's samples stay its own and pixels stay independent
// (Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006). All filters are non-negative.

#include <lightswitch/core/math.hpp>

#include <array>
#include <string>
#include <string_view>

namespace lightswitch {

namespace detail {

/// The positive half of the Gaussian of standard deviation 1, cut off at 4 and shifted to be 0 there, at equidistant
/// knots.
///
/// Its distribution has no closed inverse. It is inverted by finding the cell, whose probability is exact, and taking
/// the density as linear within it; the distribution then errs by less than 1e-6. Computed at compile time, without the
/// platform's maths library, so that the table is the same everywhere.
struct GaussianTable {
    static constexpr int cells = 64;
    static constexpr double cutoff = 4, width = cutoff / cells;
    static constexpr double value_at_cutoff = 3.3546262790251185e-4;  ///< exp(-8)

    std::array<float, cells + 1> density{};     ///< at the knots, up to a factor
    std::array<float, cells + 1> cumulative{};  ///< probability from 0 to the knot, of |x|
    double area = 0;                            ///< integral of `shape` from 0 to `cutoff`

    static constexpr double shape(double x) { return exp_of_minus(x * x / 2) - value_at_cutoff; }

    constexpr GaussianTable() {
        std::array<double, cells + 1> sum{};
        for (int i = 0; i < cells; ++i) {
            const double x = i * width;
            // Simpson's rule, here exact to 1e-9.
            const double mass = width / 6 * (shape(x) + 4 * shape(x + width / 2) + shape(x + width));
            density[index(i)] = static_cast<float>(shape(x));
            sum[index(i + 1)] = sum[index(i)] + mass;
        }
        area = sum[cells];
        for (int i = 0; i <= cells; ++i) cumulative[index(i)] = static_cast<float>(sum[index(i)] / area);
    }

    /// The x in [0, 4] below which the fraction `u` in [0, 1] lies.
    float inverse(float u) const {
        std::size_t cell = 0;
        for (std::size_t step = cells / 2; step > 0; step /= 2) cell += cumulative[cell + step] <= u ? step : 0;
        const float fraction = (u - cumulative[cell]) / (cumulative[cell + 1] - cumulative[cell]);
        const float a = density[cell], b = density[cell + 1];
        // Where products are fused into sums the radicand may fall below 0.
        const float t = fraction * (a + b) / (a + safe_sqrt(a * a + fraction * (b * b - a * a)));
        return (static_cast<float>(cell) + std::min(t, 1.0f)) * static_cast<float>(width);
    }

private:
    static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

    /// exp(-x) for 0 <= x <= 8: Taylor's series at x / 16, and four squarings.
    static constexpr double exp_of_minus(double x) {
        const double y = -x / 16;
        double sum = 1;
        for (int n = 16; n > 0; --n) sum = 1 + sum * y / n;
        for (int i = 0; i < 4; ++i) sum *= sum;
        return sum;
    }
};

inline constexpr GaussianTable gaussian_table{};

}  // namespace detail

/// A separable filter. Radii and standard deviation are in pixels.
class Filter {
public:
    enum class Kind { box, tent, gaussian };

    /// Constant over the pixel itself: radius 0.5.
    static Filter box() { return {Kind::box, 0.5f, 0}; }
    /// Falls linearly from the centre to 0 at `radius`.
    static Filter tent(float radius = 1) { return {Kind::tent, radius, 0}; }
    /// A Gaussian cut off at four standard deviations and shifted to be 0 there, as in Mitsuba.
    static Filter gaussian(float standard_deviation = 0.5f) {
        return {Kind::gaussian, 4 * standard_deviation, standard_deviation};
    }

    Kind kind() const { return kind_; }
    float radius() const { return radius_; }
    std::string_view name() const {
        switch (kind_) {
            case Kind::box: return "box";
            case Kind::tent: return "tent";
            case Kind::gaussian: break;
        }
        return "gaussian";
    }

    /// Why the radius is impossible, in words, or an empty string. Beyond 64 pixels neighbouring pixels differ by noise
    /// only.
    std::string problem() const {
        if (radius_ > 0 && radius_ <= 64) return {};
        return "a filter radius of " + std::to_string(radius_) + " pixels is not above 0 and at most 64" +
               (kind_ == Kind::gaussian ? " (the radius is four standard deviations)" : "");
    }

    /// Offset from the pixel's centre for a uniform `u` in [0,1)^2, distributed as the filter.
    Vec2 sample(const Vec2& u) const {
        switch (kind_) {
            case Kind::box: return u - 0.5f;
            case Kind::tent: return {sample_tent(u.x), sample_tent(u.y)};
            case Kind::gaussian: break;
        }
        return {sample_gaussian(u.x), sample_gaussian(u.y)};
    }

    /// Density of `sample` at `offset` (integral 1 over the plane).
    float pdf(const Vec2& offset) const { return pdf(offset.x) * pdf(offset.y); }

private:
    Filter(Kind kind, float radius, float sigma) : kind_(kind), radius_(radius), sigma_(sigma) {}

    float sample_tent(float u) const {
        const float v = 2 * u - 1;
        return std::copysign(radius_ * (1 - std::sqrt(1 - std::abs(v))), v);
    }

    float sample_gaussian(float u) const {
        const float v = 2 * u - 1;
        return std::copysign(sigma_ * detail::gaussian_table.inverse(std::abs(v)), v);
    }

    float pdf(float x) const {
        if (!(std::abs(x) <= radius_)) return 0;
        if (kind_ == Kind::box) return 0.5f / radius_;
        if (kind_ == Kind::tent) return (1 - std::abs(x) / radius_) / radius_;
        constexpr auto shift = static_cast<float>(detail::GaussianTable::value_at_cutoff);
        constexpr auto factor = static_cast<float>(0.5 / detail::gaussian_table.area);
        return std::max(std::exp(-0.5f * square(x / sigma_)) - shift, 0.0f) * factor / sigma_;
    }

    Kind kind_;
    float radius_, sigma_;
};

}  // namespace lightswitch
