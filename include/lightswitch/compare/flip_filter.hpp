#pragma once

// The filters of the FLIP metric: what an eye at the distance of the display sees of colours, edges and points.

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lightswitch::detail::flip {

/// Weights of a one-dimensional filter at -radius ... radius pixels.
using Weights = std::vector<float>;

/// All filters for one display (Andersson et al. 2020). Each two-dimensional filter is a product of two of these, one
/// across and one down, or a sum of two products.
struct Filters {
    Weights luminance, red_green;                  ///< contrast sensitivity of Y and Cx
    Weights blue_yellow_narrow, blue_yellow_wide;  ///< of Cz: a sum of two Gaussians
    Weights blur, edge, point;                     ///< a Gaussian, its first and its second derivative
    int radius = 0;                                ///< of the largest

    /// `pixels_per_degree` of visual angle must be at least 1.
    explicit Filters(double pixels_per_degree) {
        // Contrast sensitivities are sums of a sqrt(pi / b) exp(-pi^2 x^2 / b), with x in degrees.
        constexpr double pi_d = 3.14159265358979323846, widest = 0.04;
        const int sensitivity = reach(std::sqrt(widest / 2) / pi_d * pixels_per_degree);
        const auto gaussian = [&](double a, double b) {
            return sampled(sensitivity, [&](double x) {
                const double degrees = x / pixels_per_degree;
                return std::sqrt(a * std::sqrt(pi_d / b)) * std::exp(-pi_d * pi_d * degrees * degrees / b);
            });
        };
        luminance = balanced(gaussian(1, 0.0047));
        red_green = balanced(gaussian(1, 0.0053));
        auto narrow = gaussian(34.1, widest), wide = gaussian(13.5, 0.025);
        const double sum = std::hypot(total(narrow), total(wide));  // of the products: the weights in two dimensions
        blue_yellow_narrow = scaled(narrow, 1 / sum);
        blue_yellow_wide = scaled(wide, 1 / sum);

        const double deviation = 0.5 * 0.082 * pixels_per_degree;  // a feature is 0.082 degrees wide
        const int feature = reach(deviation);
        const auto bell = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
        blur = balanced(sampled(feature, bell));
        edge = balanced(sampled(feature, [&](double x) { return -x * bell(x); }));
        point = balanced(sampled(feature, [&](double x) { return (x * x / (deviation * deviation) - 1) * bell(x); }));
        radius = std::max(sensitivity, feature);
    }

private:
    static int reach(double deviation) { return static_cast<int>(std::ceil(3 * deviation)); }

    static std::vector<double> sampled(int radius, const auto& function) {
        std::vector<double> values;
        for (int x = -radius; x <= radius; ++x) values.push_back(function(static_cast<double>(x)));
        return values;
    }
    static double total(const std::vector<double>& values) {
        double sum = 0;
        for (const double value : values) sum += value;
        return sum;
    }
    static Weights scaled(const std::vector<double>& values, double factor) {
        Weights weights;
        for (const double value : values) weights.push_back(static_cast<float>(value * factor));
        return weights;
    }
    /// Makes the positive weights sum to 1 and the negative ones to -1.
    static Weights balanced(std::vector<double> values) {
        double positive = 0, negative = 0;
        for (const double value : values) (value > 0 ? positive : negative) += value;
        for (double& value : values) value /= value > 0 ? positive : negative < 0 ? -negative : 1;
        return scaled(values, 1);
    }
};

/// Rows of one picture, filtered: across when made, down when asked. Pixels beyond a border are those at the border.
class FilteredRows {
public:
    /// Numbers per pixel: the filtered colour as Y, Cx, Cz, and the derivatives of Y.
    enum Result : std::size_t { y, cx, cz, edge_across, point_across, edge_down, point_down, results };

    /// Enough of a picture of `width` x `height` to have rows [first, last) filtered. `color(x, y)` is a pixel in
    /// YCxCz. Keeps a reference to `filters`.
    FilteredRows(int width, int height, int first, int last, const Filters& filters, const auto& color)
        : filters_(filters),
          width_(static_cast<std::size_t>(width)),
          first_(std::max(first - filters.radius, 0)),
          last_(std::min(last + filters.radius, height)),
          across_(static_cast<std::size_t>(last_ - first_) * planes * width_) {
        const auto margin = static_cast<std::size_t>(filters.radius);
        std::array<std::vector<float>, 3> channels;
        for (auto& channel : channels) channel.resize(width_ + 2 * margin);
        const std::array<Step, planes> steps{{{0, 0, filters.luminance},
                                              {1, 1, filters.red_green},
                                              {2, 2, filters.blue_yellow_narrow},
                                              {2, 3, filters.blue_yellow_wide},
                                              {0, 4, filters.edge},
                                              {0, 5, filters.point},
                                              {0, 6, filters.blur}}};
        for (int row = first_; row < last_; ++row) {
            for (int x = 0; x < width; ++x) {
                const Vec3 value = color(x, row);
                for (int c = 0; c < 3; ++c)
                    channels[static_cast<std::size_t>(c)][margin + static_cast<std::size_t>(x)] = value[c];
            }
            for (auto& channel : channels) {
                std::fill_n(channel.begin(), margin, channel[margin]);
                std::fill_n(channel.end() - filters.radius, margin, channel[margin + width_ - 1]);
            }
            for (const Step& step : steps)
                for (std::size_t i = 0; i < step.weights.size(); ++i)
                    add(plane(row, step.to), &channels[step.from][margin - step.weights.size() / 2 + i],
                        step.weights[i]);
        }
    }

    /// All results for row `row` in [first, last): those of one kind side by side, at kind * width + x.
    void filter_down(int row, std::vector<float>& out) const {
        out.assign(results * width_, 0.0f);
        const std::array<Step, 8> steps{{{0, y, filters_.luminance},
                                         {1, cx, filters_.red_green},
                                         {2, cz, filters_.blue_yellow_narrow},
                                         {3, cz, filters_.blue_yellow_wide},
                                         {4, edge_across, filters_.blur},
                                         {5, point_across, filters_.blur},
                                         {6, edge_down, filters_.edge},
                                         {6, point_down, filters_.point}}};
        for (const Step& step : steps) {
            const int reach = static_cast<int>(step.weights.size() / 2);
            for (int i = -reach; i <= reach; ++i)
                add(&out[step.to * width_], plane(std::clamp(row + i, first_, last_ - 1), step.from),
                    step.weights[static_cast<std::size_t>(i + reach)]);
        }
    }

private:
    static constexpr std::size_t planes = 7;  ///< of a row that is filtered across

    struct Step {
        std::size_t from, to;
        const Weights& weights;
    };

    void add(float* sum, const float* values, float weight) const {
        for (std::size_t x = 0; x < width_; ++x) sum[x] += weight * values[x];
    }
    const float* plane(int row, std::size_t index) const {
        return &across_[(static_cast<std::size_t>(row - first_) * planes + index) * width_];
    }
    float* plane(int row, std::size_t index) { return const_cast<float*>(std::as_const(*this).plane(row, index)); }

    const Filters& filters_;
    std::size_t width_;
    int first_, last_;  // rows that are kept: at a border of the picture these stop there
    std::vector<float> across_;
};

}  // namespace lightswitch::detail::flip
