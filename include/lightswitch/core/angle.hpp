#pragma once

// Angles as fractions of a full circle ("turns"). As in warp.hpp, nothing here calls the maths library: results are the
// same bits everywhere.

#include <lightswitch/core/warp.hpp>

namespace lightswitch {

/// The angle from the x axis to (x, y), towards the y axis, in turns: in [-0.5, 0.5], within 2^-24. That of (0, 0) is 0
/// or half a turn. A polynomial for the arc tangent in the first eighth of the circle (interpolated at Chebyshev's
/// nodes), reflected.
inline float turns(float y, float x) {
    const float abs_x = std::abs(x), abs_y = std::abs(y);
    const float t = std::min(abs_x, abs_y) / std::max(std::max(abs_x, abs_y), std::numeric_limits<float>::min());
    const float s = t * t;
    float p = 0x1.cda776p-12f;
    for (const float c : {-0x1.482a7p-9f, 0x1.b782e8p-8f, -0x1.84e39cp-7f, 0x1.14e252p-6f, -0x1.723894p-6f,
                          0x1.04a74ap-5f, -0x1.b29862p-5f, 0x1.45f306p-3f})
        p = p * s + c;
    float angle = p * t;
    if (abs_y > abs_x) angle = 0.25f - angle;
    if (x < 0) angle = 0.5f - angle;
    return std::copysign(angle, y);
}

/// Cosine and sine of an angle of so many turns, at least 0, each within 2^-22.
inline detail::CosSin cos_sin_turns(double angle) {
    const double quarters = 4 * angle;
    const auto nearest = static_cast<std::int64_t>(quarters + 0.5);
    const auto [c, s] = detail::cos_sin_quarter_pi(static_cast<float>(2 * (quarters - static_cast<double>(nearest))));
    switch (nearest & 3) {
        case 0: return {c, s};
        case 1: return {-s, c};
        case 2: return {-c, -s};
        default: return {s, -c};
    }
}

}  // namespace lightswitch
