#pragma once

// The film: one estimate of the whole image per iteration, and their running sums.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/film/pixel_sums.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lightswitch {

/// A contribution to any pixel.
struct Splat {
    std::uint32_t pixel;  ///< row * width + column
    Rgb value;
};

/// Accumulates iterations, each an estimate of the whole image made of slots (a pixel's own sample, written by one
/// worker) and splats (contributions that land anywhere). An iteration's estimate is in double, its splats in a fixed
/// order; the sums over iterations do not depend on their order (`PixelSums`): films of some iterations each, merged
/// in any way, are the film of all of them, bit for bit.
///
/// `slot` may be called from several threads for different pixels; everything else from one thread at a time.
class Film {
public:
    Film(int width, int height) : width_(width), height_(height) {
        Image::check_size(width, height);
        slots_.resize(area(), Rgb(0));
        sums_.resize(area());
        windows_.resize(area());
    }

    /// Without splats, which take another `DVec3`.
    static constexpr std::size_t bytes_per_pixel = sizeof(Rgb) + sizeof(PixelSums) + sizeof(PixelSums::Windows);

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t area() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
    /// Iterations accumulated so far.
    std::uint64_t iterations() const { return iterations_; }

    /// This iteration's sample of one pixel (row * width + column).
    Rgb& slot(std::size_t pixel) { return slots_[pixel]; }

    /// Adds splats to this iteration, in the order given.
    void add(std::span<const Splat> splats) {
        if (!splats.empty() && splatted_.empty()) splatted_.resize(area(), DVec3(0));
        for (const Splat& splat : splats) splatted_[splat.pixel] += DVec3(splat.value);
    }

    /// Ends an iteration: its estimate joins the sums. Throws `Error` after 2^32 - 1 of them.
    void commit(const Executor auto& executor) {
        check_room(1);
        for_each_row(executor, [&](std::size_t begin, std::size_t end) {
            if (splatted_.empty()) join(begin, end, [](std::size_t) { return DVec3(0); });
            else
                join(begin, end,
                     [splatted = splatted_.data()](std::size_t i) { return std::exchange(splatted[i], DVec3(0)); });
        });
        ++iterations_;
    }

    /// Adds the iterations of another film of this size.
    void merge(const Film& other) {
        if (other.width_ != width_ || other.height_ != height_) throw Error("films of different sizes do not merge");
        check_room(other.iterations_);
        for (std::size_t i = 0; i < area(); ++i) sums_[i].merge(windows_[i], other.sums_[i], other.windows_[i]);
        iterations_ += other.iterations_;
    }

    /// What is kept between iterations, of each pixel; `restore` brings it back.
    const std::vector<PixelSums>& sums() const { return sums_; }
    const std::vector<PixelSums::Windows>& windows() const { return windows_; }
    void restore(std::uint64_t iterations, std::vector<PixelSums> sums, std::vector<PixelSums::Windows> windows) {
        if (sums.size() != area() || windows.size() != area())
            throw Error("the sums are not those of a film this size");
        iterations_ = 0;
        check_room(iterations);
        iterations_ = iterations;
        sums_ = std::move(sums);
        windows_ = std::move(windows);
    }

    /// Forgets the iteration that is under way.
    void discard(const Executor auto& executor) {
        for_each_row(executor, [&](std::size_t begin, std::size_t end) {
            std::fill(slots_.begin() + std::ptrdiff_t(begin), slots_.begin() + std::ptrdiff_t(end), Rgb(0));
            if (!splatted_.empty())
                std::fill(splatted_.begin() + std::ptrdiff_t(begin), splatted_.begin() + std::ptrdiff_t(end), DVec3(0));
        });
    }

    /// Mean over the iterations; black before the first.
    Image image() const {
        Image result(width_, height_);
        if (iterations_ > 0)
            for (std::size_t i = 0; i < area(); ++i) result.pixels()[i] = Rgb(sum(i) / double(iterations_));
        return result;
    }

    /// Estimated variance of each pixel of `image()`, from the spread of its iterations; 0 before the second. With
    /// Sobol' points, whose samples repel each other, it is an upper estimate.
    Image variance() const {
        Image result(width_, height_);
        if (iterations_ > 1)
            for (std::size_t i = 0; i < area(); ++i) result.pixels()[i] = Rgb(variance_of_mean(i));
        return result;
    }

    /// Estimated root mean square error of the image, as a fraction of its mean: 0.01 means that a pixel is typically
    /// off by 1 % of the average pixel. Infinite, which is to say unknown, before the second iteration and while the
    /// image is black: that nothing was found yet says nothing about what is there.
    double relative_error() const {
        if (iterations_ < 2) return std::numeric_limits<double>::infinity();
        DVec3 mean(0), variance(0);
        for (std::size_t i = 0; i < area(); ++i) {
            mean += sum(i) / double(iterations_);
            variance += variance_of_mean(i);
        }
        const double mean_level = (mean.x + mean.y + mean.z) / (3 * double(area()));
        const double mean_square = (variance.x + variance.y + variance.z) / (3 * double(area()));
        return mean_level > 0 ? std::sqrt(mean_square) / mean_level : std::numeric_limits<double>::infinity();
    }

private:
    void check_room(std::uint64_t more) const {
        if (more > PixelSums::most_terms - iterations_)
            throw Error("a film holds at most " + std::to_string(PixelSums::most_terms) + " iterations");
    }

    void join(std::size_t begin, std::size_t end, const auto& take_splats) {
        Rgb* const slots = slots_.data();
        PixelSums* const sums = sums_.data();
        PixelSums::Windows* const windows = windows_.data();
        for (std::size_t i = begin; i < end; ++i)
            sums[i].add(windows[i], DVec3(std::exchange(slots[i], Rgb(0))) + take_splats(i));
    }

    DVec3 sum(std::size_t i) const { return sums_[i].values(windows_[i]); }

    DVec3 variance_of_mean(std::size_t i) const {
        const double n = double(iterations_);
        const DVec3 of_values = sum(i), of_squares = sums_[i].squares(windows_[i]);
        const DVec3 spread = of_squares - of_values * of_values / n;
        return glm::max(spread, DVec3(0)) / (n * (n - 1));
    }

    void for_each_row(const Executor auto& executor, const auto& work) {
        constexpr std::size_t rows = 16;
        const std::size_t width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
        executor.for_each((height + rows - 1) / rows, [&](std::size_t band) {
            work(band * rows * width, std::min((band + 1) * rows, height) * width);
        });
    }

    int width_, height_;
    std::uint64_t iterations_ = 0;
    std::vector<Rgb> slots_;
    std::vector<DVec3> splatted_;  // empty until the first splat: most methods have none
    std::vector<PixelSums> sums_;
    std::vector<PixelSums::Windows> windows_;
};

}  // namespace lightswitch
