#pragma once

// Squares of two colours.

#include <lightswitch/core/math.hpp>

#include <cmath>

namespace lightswitch {

/// Two colours in a pattern of squares, two by two in the unit square and repeated in all directions, as in Mitsuba 3:
/// `color0` where u and v are in the same half of their unit interval, `color1` elsewhere. A half ends with and
/// includes 0.5, the next begins with the integers. Infinite and NaN coordinates count as the first half.
struct Checkerboard {
    Rgb color0{0.4f}, color1{0.2f};

    Rgb at(const Vec2& uv) const {
        const auto second_half = [](float x) { return x - std::floor(x) > 0.5f; };
        return second_half(uv.x) == second_half(uv.y) ? color0 : color1;
    }

    /// Over the unit square.
    Rgb mean() const { return 0.5f * (color0 + color1); }
    /// Least and greatest value of each channel.
    Rgb least() const { return glm::min(color0, color1); }
    Rgb most() const { return glm::max(color0, color1); }
};

}  // namespace lightswitch
