#pragma once

// Independent images of one method: their mean, and how uncertain it is, pixel by pixel.

#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/film/image.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightswitch::detail {

inline double sum_of(const DVec3& x) { return x.x + x.y + x.z; }

/// Sums of independent images of one size and one expectation.
class ImageMoments {
public:
    void add(const Image& image) {
        if (sum_.empty()) {
            width_ = image.width(), height_ = image.height();
            sum_.resize(image.pixels().size(), DVec3(0));
            squares_.resize(sum_.size(), DVec3(0));
        }
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            const DVec3 x(image.pixels()[i]);
            sum_[i] += x;
            squares_[i] += x * x;
        }
        means_.push_back(sum_of(image.mean()) / 3);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t count() const { return means_.size(); }
    std::size_t size() const { return sum_.size(); }

    DVec3 mean(std::size_t i) const { return sum_[i] / double(count()); }
    /// Of one image; 0 for fewer than two.
    DVec3 variance(std::size_t i) const {
        if (count() < 2) return DVec3(0);
        const double n = double(count());
        return glm::max(squares_[i] - sum_[i] * sum_[i] / n, DVec3(0)) / (n - 1);
    }
    Image mean() const {
        Image result(width_, height_);
        for (std::size_t i = 0; i < size(); ++i) result.pixels()[i] = Rgb(mean(i));
        return result;
    }

    /// The mean of the images over all pixels and channels, from the spread of the images.
    Estimate level() const { return Estimate::of(means_); }

    /// The mean of the variance of one image over pixels and channels.
    double mean_variance() const {
        double sum = 0;
        for (std::size_t i = 0; i < size(); ++i) sum += sum_of(variance(i));
        return sum / (3 * double(size()));
    }

    /// What the variance of one image adds to its relMSE against an image without noise.
    double relative_variance(const Image& reference) const {
        double sum = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            const DVec3 r(reference.pixels()[i]);
            sum += sum_of(variance(i) / (r * r + metric_offset));
        }
        return sum / (3 * double(size()));
    }

private:
    int width_ = 0, height_ = 0;
    std::vector<DVec3> sum_, squares_;
    std::vector<double> means_;
};

/// The mean over squares of 7 by 7 pixels, as far as they lie in the image: what the brightness is near a pixel, when
/// one pixel is too noisy to tell.
inline Image blurred(const Image& image) {
    constexpr int radius = 3;
    const auto along = [&](const Image& from, int dx, int dy) {
        Image to(from.width(), from.height());
        for (int y = 0; y < from.height(); ++y)
            for (int x = 0; x < from.width(); ++x) {
                DVec3 sum(0);
                int count = 0;
                for (int k = -radius; k <= radius; ++k) {
                    const int u = x + k * dx, v = y + k * dy;
                    if (u < 0 || v < 0 || u >= from.width() || v >= from.height()) continue;
                    sum += DVec3(from(u, v));
                    ++count;
                }
                to(x, y) = Rgb(sum / double(count));
            }
        return to;
    };
    return along(along(image, 1, 0), 0, 1);
}

/// Sum over a tile (column `tx`, row `ty` of `n` by `n`) of what `term(i)` says of each pixel (row * width + column).
double over_tile(int width, int height, int n, int tx, int ty, const auto& term) {
    double sum = 0;
    for (int y = ty * height / n; y < (ty + 1) * height / n; ++y)
        for (int x = tx * width / n; x < (tx + 1) * width / n; ++x)
            sum += term(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return sum;
}

/// The sum of a tile and its standard deviation, from the spread of the images in every pixel. The channels of a pixel
/// err together: their deviations add up.
struct TileSum {
    double sum = 0, variance = 0;

    TileSum(const ImageMoments& m, int n, int tx, int ty)
        : sum(over_tile(m.width(), m.height(), n, tx, ty, [&](std::size_t i) { return sum_of(m.mean(i)); })),
          variance(over_tile(m.width(), m.height(), n, tx, ty, [&](std::size_t i) {
              const double s = sum_of(glm::sqrt(m.variance(i)));
              return s * s / double(m.count());
          })) {}
};

/// By how many standard deviations the first exceeds the second; 0 when neither has any.
inline double deviations(const TileSum& a, const TileSum& b) {
    const double variance = a.variance + b.variance;
    return variance > 0 ? (a.sum - b.sum) / std::sqrt(variance) : 0;
}

/// What becomes of the tiles of an `n` by `n` grid by `f(tx, ty)`, the largest.
double largest_of_tiles(int n, const auto& f) {
    double largest = 0;
    for (int i = 0; i < n * n; ++i) largest = std::max(largest, f(i % n, i / n));
    return largest;
}

}  // namespace lightswitch::detail
