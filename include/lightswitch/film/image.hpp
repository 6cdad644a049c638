#pragma once

// An image in memory: linear RGB and what is known about how it was made.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// A rectangle of linear RGB values, `width` x `height`, row by row from the top, left to right.
///
/// Values are radiance (or what the method calls it); they may be negative in a difference image. Copyable; reading
/// from several threads is safe.
class Image {
public:
    /// What the image says about itself: method, scene, samples, seed, ... Written to EXR headers and read back.
    using Metadata = std::map<std::string, std::string>;

    Image() = default;
    /// A black image. Throws `Error` when a side is below 1 or above 65536, or the area above 2^26 pixels.
    Image(int width, int height) : width_(width), height_(height) {
        check_size(width, height);
        pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Rgb(0));
    }

    int width() const { return width_; }
    int height() const { return height_; }
    bool empty() const { return pixels_.empty(); }

    /// Pixel in column `x` (from the left) and row `y` (from the top); unchecked.
    const Rgb& operator()(int x, int y) const { return pixels_[index(x, y)]; }
    Rgb& operator()(int x, int y) { return pixels_[index(x, y)]; }

    /// All pixels, row by row from the top.
    const std::vector<Rgb>& pixels() const& { return pixels_; }
    std::vector<Rgb>& pixels() & { return pixels_; }
    std::vector<Rgb> pixels() && { return std::move(pixels_); }

    /// Mean of all pixels, summed in double.
    DVec3 mean() const {
        DVec3 sum(0);
        for (const Rgb& p : pixels_) sum += DVec3(p);
        return pixels_.empty() ? sum : sum / static_cast<double>(pixels_.size());
    }

    /// Column and row of the first pixel, row by row from the top, that is not finite; nothing when all are.
    std::optional<std::pair<int, int>> first_not_finite() const {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                if (!is_finite((*this)(x, y))) return std::pair(x, y);
        return std::nullopt;
    }

    /// Throws `Error` unless an image of that size is allowed.
    static void check_size(long long width, long long height) {
        if (width < 1 || height < 1 || width > max_side || height > max_side || width * height > max_area)
            throw Error("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels is not possible: each side must be between 1 and " + std::to_string(max_side) +
                        ", and the area at most " + std::to_string(max_area) + " pixels");
    }

    static constexpr long long max_side = 65536;
    static constexpr long long max_area = 1LL << 26;

    Metadata metadata;

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_ = 0, height_ = 0;
    std::vector<Rgb> pixels_;
};

}  // namespace lightswitch
