#pragma once

// One number for how far an image is from its reference: means over all pixels and channels, summed in double.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/film/image.hpp>

#include <cmath>

namespace lightswitch {

/// Added to denominators so that black pixels of the reference keep a finite weight, in units of radiance (squared in
/// `relmse`): small beside 1, so images are expected to have a mean near it.
inline constexpr double metric_offset = 1e-2;

namespace detail {

/// Mean of `term(x, r)` over all channels of the image (x) and its reference (r).
template <class Term>
double mean_over_channels(const Image& image, const Image& reference, Term term) {
    refuse_unless_comparable(image, reference);
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels().size(); ++i)
        for (int c = 0; c < 3; ++c)
            sum += term(static_cast<double>(image.pixels()[i][c]), static_cast<double>(reference.pixels()[i][c]));
    return sum / (3 * static_cast<double>(image.pixels().size()));
}

}  // namespace detail

// All of these throw as `refuse_unless_comparable`, and give NaN or infinity when a pixel is not finite.

/// Mean squared error: mean of (x - r)^2.
inline double mse(const Image& image, const Image& reference) {
    return detail::mean_over_channels(image, reference, [](double x, double r) { return (x - r) * (x - r); });
}

/// Square root of the mean squared error, in units of radiance.
inline double rmse(const Image& image, const Image& reference) { return std::sqrt(mse(image, reference)); }

/// Relative mean squared error: mean of (x - r)^2 / (r^2 + 0.01) (Rousselle et al. 2011, "Adaptive Sampling and
/// Reconstruction using Greedy Error Minimization").
inline double relmse(const Image& image, const Image& reference) {
    return detail::mean_over_channels(image, reference,
                                      [](double x, double r) { return (x - r) * (x - r) / (r * r + metric_offset); });
}

/// Mean absolute percentage error as a fraction: mean of |x - r| / (|r| + 0.01).
inline double mape(const Image& image, const Image& reference) {
    return detail::mean_over_channels(
        image, reference, [](double x, double r) { return std::abs(x - r) / (std::abs(r) + metric_offset); });
}

/// Symmetric mean absolute percentage error, from 0 to 2: mean of 2 |x - r| / (|x| + |r| + 0.01).
inline double smape(const Image& image, const Image& reference) {
    return detail::mean_over_channels(image, reference, [](double x, double r) {
        return 2 * std::abs(x - r) / (std::abs(x) + std::abs(r) + metric_offset);
    });
}

/// Mean of the image over mean of the reference: 1 when no light is gained or lost. NaN when both are black.
inline double mean_ratio(const Image& image, const Image& reference) {
    const double x = detail::mean_over_channels(image, reference, [](double value, double) { return value; });
    const double r = detail::mean_over_channels(image, reference, [](double, double value) { return value; });
    return x / r;
}

}  // namespace lightswitch
