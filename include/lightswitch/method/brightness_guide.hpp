#pragma once

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <vector>

namespace lightswitch {

/// A rough idea of how bright the parts of an image are, by tiles. Chains that divide by it visit dark parts as often
/// as bright ones, so that noise is in proportion to the image and not to its brightest parts (Veach 1997, section
/// 11.3.2). Any guide is right; a good one is quiet.
class BrightnessGuide {
public:
    /// For a film of `width` x `height` pixels; even until it learns.
    BrightnessGuide(int width = 1, int height = 1)
        : columns_((width + tile - 1) / tile),
          rows_((height + tile - 1) / tile),
          tiles_(std::size_t(columns_ * rows_), 1.0f) {}

    /// From `samples`, of which each has brightness `target` at `pixel`, drawn evenly over the film.
    void learn(const auto& samples) {
        double mean = 0;
        for (const auto& s : samples) mean += s.target / double(samples.size());
        if (!(mean > 0)) return;
        std::vector<double> sums(tiles_.size(), 0.0);
        // A few samples outshine all others and say little about their tile.
        for (const auto& s : samples) sums[index(s.pixel)] += std::min(s.target / mean, brightest);
        const double share = double(tiles_.size()) / double(samples.size());
        for (std::size_t i = 0; i < tiles_.size(); ++i)
            tiles_[i] = static_cast<float>(floor + share * smoothed(sums, i));
    }

    /// What to divide by at a pixel: around 1 on the average, and never near 0.
    float operator()(const Vec2& pixel) const { return tiles_[index(pixel)]; }

private:
    static constexpr int tile = 16;
    static constexpr double brightest = 30, floor = 0.1;

    std::size_t index(const Vec2& pixel) const {
        const int x = std::clamp(static_cast<int>(pixel.x) / tile, 0, columns_ - 1);
        const int y = std::clamp(static_cast<int>(pixel.y) / tile, 0, rows_ - 1);
        return static_cast<std::size_t>(y * columns_ + x);
    }

    /// The mean over a tile and those around it.
    double smoothed(const std::vector<double>& sums, std::size_t i) const {
        const int x = static_cast<int>(i) % columns_, y = static_cast<int>(i) / columns_;
        double sum = 0;
        int n = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, rows_ - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, columns_ - 1); ++u, ++n)
                sum += sums[static_cast<std::size_t>(v * columns_ + u)];
        return sum / n;
    }

    int columns_, rows_;
    std::vector<float> tiles_;
};

}  // namespace lightswitch
