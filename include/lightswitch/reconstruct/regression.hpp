#pragma once

// The library's own reconstructor: radiance as a linear function of the guides, fitted place by place.

#include <lightswitch/reconstruct/starlet.hpp>

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace lightswitch {

/// Weighted linear regression on position, albedo and normal in a window around every third pixel of every third row;
/// pixels count as much as their surroundings look like those of the window's centre, beyond what noise explains. Each
/// window says what all of its pixels are, and a pixel becomes the weighted mean of what is said of it (Bitterli et al.
/// 2016, "Nonlinearly Weighted First-Order Regression for Denoising Monte Carlo Renderings", without its choice among
/// bandwidths; the weights after Rousselle et al. 2012, "Adaptive Rendering with Non-Local Means Filtering", but
/// between smoothed images and not patches). Without guides it is regression on position.
struct Regression {
    static constexpr std::string_view name = "own";

    int radius = 9;       ///< of the windows, in pixels
    double strength = 2;  ///< difference, in standard deviations of the smoothed images, that lowers a weight to 1/e

    Image reconstruct(const NoisyImage& noisy, const Executor auto& executor) const;
};

namespace detail {

/// Isolated bright pixels cut down to twice the second brightest around them: one such sample would bend every window
/// that it is in.
inline Plane<Rgb> without_spikes(const Plane<Rgb>& in, const Executor auto& executor) {
    Plane<Rgb> out = in;
    for_each_row(in.height, executor, [&](int y) {
        for (int x = 0; x < in.width; ++x) {
            float first = 0, second = 0;
            int others = 0;
            for (int j = std::max(y - 2, 0); j <= std::min(y + 2, in.height - 1); ++j)
                for (int i = std::max(x - 2, 0); i <= std::min(x + 2, in.width - 1); ++i) {
                    if (i == x && j == y) continue;
                    ++others;
                    const float other = max_component(in.row(j)[i]);
                    second = std::max(second, std::min(first, other));
                    first = std::max(first, other);
                }
            const float own = max_component(in.row(y)[x]);
            if (others > 1 && own > 2 * second) out.row(y)[x] *= 2 * second / own;
        }
    });
    return out;
}

/// The least of the means of the four squares of 5 x 5 pixels that lie two pixels away from a pixel, across its
/// corners: what is so on its own side of an edge, also where smoothing has carried the edge as far as that pixel.
inline Plane<Rgb> least_mean(const Plane<Rgb>& in, const Executor auto& executor) {
    Plane<Rgb> out(in.width, in.height);
    for_each_row(in.height, executor, [&](int y) {
        for (int x = 0; x < in.width; ++x) {
            Rgb least(infinity);
            for (const int dx : {-6, 2})
                for (const int dy : {-6, 2}) {
                    Rgb sum(0);
                    for (int j = y + dy; j <= y + dy + 4; ++j)
                        for (int i = x + dx; i <= x + dx + 4; ++i)
                            sum += in.row(std::clamp(j, 0, in.height - 1))[std::clamp(i, 0, in.width - 1)];
                    least = min(least, sum / 25.0f);
                }
            out.row(y)[x] = least;
        }
    });
    return out;
}

/// What pixels are a linear function of: 1, position in the window, albedo, normal.
inline constexpr std::size_t regression_terms = 9;
using RegressionTerms = std::array<float, regression_terms>;

/// Sums for one window, and their solution.
class NormalEquations {
public:
    void add(const RegressionTerms& terms, const Rgb& value, float weight) {
        for (std::size_t i = 0; i < regression_terms; ++i) {
            const float weighted = weight * terms[i];
            for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weighted * terms[j];
            right_[i] += weighted * value;
        }
    }

    /// Coefficients, each kept small as if there were some more pixels that say 0 of it (but of the constant). By
    /// Cholesky's decomposition.
    std::array<Rgb, regression_terms> solve(float noise) {
        const float ridge = 1e-3f * matrix_[0][0] + noise;
        for (std::size_t i = 1; i < regression_terms; ++i) matrix_[i][i] += ridge;
        for (std::size_t i = 0; i < regression_terms; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                float sum = matrix_[i][j];
                for (std::size_t k = 0; k < j; ++k) sum -= matrix_[i][k] * matrix_[j][k];
                if (i == j) matrix_[i][i] = std::sqrt(std::max(sum, 0.5f * ridge));
                else matrix_[i][j] = sum / matrix_[j][j];
            }
        }
        std::array<Rgb, regression_terms> solution = right_;
        for (std::size_t i = 0; i < regression_terms; ++i) {
            for (std::size_t k = 0; k < i; ++k) solution[i] -= matrix_[i][k] * solution[k];
            solution[i] /= matrix_[i][i];
        }
        for (std::size_t i = regression_terms; i-- > 0;) {
            for (std::size_t k = i + 1; k < regression_terms; ++k) solution[i] -= matrix_[k][i] * solution[k];
            solution[i] /= matrix_[i][i];
        }
        return solution;
    }

private:
    std::array<RegressionTerms, regression_terms> matrix_{};
    std::array<Rgb, regression_terms> right_{};
};

/// The windows whose centres lie in some rows, and what they say.
class RegressionBand {
public:
    static constexpr int stride = 3, rows = 24;  // a multiple of the stride

    struct Input {
        const Plane<Rgb>&colour, &smoothed, &variance;  // the last is of the smoothed
        const Guides& guides;
        int radius;
        float strength;
    };

    RegressionBand(const Input& in, int band)
        : in_(in),
          top_(std::max(band * rows - in.radius, 0)),
          bottom_(std::min(band * rows + rows + in.radius, in.colour.height)),
          said_(in.colour.width, bottom_ - top_),
          weight_(in.colour.width, bottom_ - top_) {
        const int first = std::min(stride / 2, in.colour.width - 1);
        const int first_row = std::min(band * rows + stride / 2, in.colour.height - 1);
        for (int y = first_row; y < std::min(band * rows + rows, in.colour.height); y += stride)
            for (int x = first; x < in.colour.width; x += stride) add_window(x, y);
    }

    void add_to(Plane<Rgb>& said, Plane<float>& weight) const {
        const std::size_t offset = std::size_t(top_) * std::size_t(said.width);
        for (std::size_t i = 0; i < said_.values.size(); ++i) {
            said.values[offset + i] += said_.values[i];
            weight.values[offset + i] += weight_.values[i];
        }
    }

private:
    /// Squared difference of the surroundings of two pixels, in units of what noise makes of it, less that.
    float distance(int x, int y, int other_x, int other_y) const {
        constexpr std::array<std::array<int, 2>, 5> places{{{0, 0}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
        const int width = in_.colour.width, height = in_.colour.height;
        float sum = 0;
        for (const auto& [dx, dy] : places) {
            const int x1 = std::clamp(x + dx, 0, width - 1), y1 = std::clamp(y + dy, 0, height - 1);
            const int x2 = std::clamp(other_x + dx, 0, width - 1), y2 = std::clamp(other_y + dy, 0, height - 1);
            const Rgb v1 = in_.variance.row(y1)[x1], v2 = in_.variance.row(y2)[x2];
            const Rgb difference = in_.smoothed.row(y1)[x1] - in_.smoothed.row(y2)[x2];
            const Rgb excess = difference * difference - (v1 + min(v1, v2));
            const Rgb unit = in_.strength * in_.strength * (v1 + v2) + Rgb(1e-6f);
            for (int c = 0; c < 3; ++c) sum += excess[c] / unit[c];
        }
        return std::max(sum / (3 * static_cast<float>(places.size())), 0.0f);
    }

    RegressionTerms terms(int x, int y, int centre_x, int centre_y) const {
        RegressionTerms result{1, static_cast<float>(x - centre_x) / static_cast<float>(in_.radius),
                               static_cast<float>(y - centre_y) / static_cast<float>(in_.radius)};
        for (int c = 0; c < 3; ++c) {
            const auto i = static_cast<std::size_t>(c);
            if (!in_.guides.albedo.empty())
                result[3 + i] = in_.guides.albedo(x, y)[c] - in_.guides.albedo(centre_x, centre_y)[c];
            if (!in_.guides.normal.empty())
                result[6 + i] = in_.guides.normal(x, y)[c] - in_.guides.normal(centre_x, centre_y)[c];
        }
        return result;
    }

    void add_window(int x, int y) {
        const int left = std::max(x - in_.radius, 0), right = std::min(x + in_.radius, in_.colour.width - 1);
        const int top = std::max(y - in_.radius, 0), bottom = std::min(y + in_.radius, in_.colour.height - 1);
        NormalEquations equations;
        Rgb highest(0);
        weights_.clear();
        for (int j = top; j <= bottom; ++j)
            for (int i = left; i <= right; ++i) {
                const float weight = std::exp(-std::min(distance(x, y, i, j), 80.0f));
                weights_.push_back(weight);
                if (weight <= 1e-4f) continue;
                equations.add(terms(i, j, x, y), in_.colour.row(j)[i], weight);
                highest = max(highest, in_.colour.row(j)[i]);
            }
        const float level = max_component(in_.smoothed.row(y)[x]) + 0.1f;
        const Rgb v = in_.variance.row(y)[x];
        const auto coefficients = equations.solve((v.x + v.y + v.z) / (3 * 0.0748f * level * level));
        std::size_t k = 0;
        for (int j = top; j <= bottom; ++j)
            for (int i = left; i <= right; ++i) {
                const float weight = weights_[k++];
                if (weight <= 1e-4f) continue;
                const RegressionTerms t = terms(i, j, x, y);
                Rgb value(0);
                for (std::size_t n = 0; n < regression_terms; ++n) value += t[n] * coefficients[n];
                said_.row(j - top_)[i] += weight * glm::clamp(value, Rgb(0), highest);
                weight_.row(j - top_)[i] += weight;
            }
    }

    const Input& in_;
    int top_, bottom_;
    Plane<Rgb> said_;
    Plane<float> weight_;
    std::vector<float> weights_;
};

}  // namespace detail

inline Image Regression::reconstruct(const NoisyImage& noisy, const Executor auto& executor) const {
    using detail::Plane;
    detail::check(noisy);
    const int width = noisy.image.width(), height = noisy.image.height();
    const double scale = detail::unit_scale(noisy.image);
    Plane<Rgb> colour(width, height);
    const std::size_t area = colour.values.size();
    for (std::size_t i = 0; i < area; ++i) colour.values[i] = Rgb(scale * DVec3(noisy.image.pixels()[i]));
    colour = detail::without_spikes(colour, executor);

    Plane<Rgb> between(width, height), smoothed(width, height), variance(width, height);
    smooth(colour, 1, between, smoothed, executor);
    for (std::size_t i = 0; i < area; ++i) {
        if (noisy.variance.empty()) {
            const Rgb rough = colour.values[i] - smoothed.values[i];
            variance.values[i] = rough * rough / 0.793f;  // what smoothing leaves of white noise's variance
        } else {
            variance.values[i] = Rgb(glm::min(scale * scale * DVec3(noisy.variance.pixels()[i]), DVec3(1e18)));
        }
    }
    variance = detail::least_mean(variance, executor);
    smooth(variance, 1, executor);
    for (Rgb& v : variance.values) v *= 0.0748f;  // (35/128)^2: the sum of the squared weights that smoothed the image

    const detail::RegressionBand::Input in{.colour = colour,
                                           .smoothed = smoothed,
                                           .variance = variance,
                                           .guides = noisy.guides,
                                           .radius = radius,
                                           .strength = static_cast<float>(strength)};
    const int bands = (height + detail::RegressionBand::rows - 1) / detail::RegressionBand::rows;
    std::vector<std::optional<detail::RegressionBand>> said(static_cast<std::size_t>(bands));
    executor.for_each(said.size(), [&](std::size_t band) { said[band].emplace(in, static_cast<int>(band)); });
    Plane<Rgb> sum(width, height);
    Plane<float> weight(width, height);
    for (const auto& band : said) band->add_to(sum, weight);

    Image result(width, height);
    for (std::size_t i = 0; i < area; ++i) {
        const Rgb value = weight.values[i] > 0 ? sum.values[i] / weight.values[i] : colour.values[i];
        result.pixels()[i] = Rgb(DVec3(glm::max(value, Rgb(0))) / scale);
    }
    return result;
}

}  // namespace lightswitch
