#pragma once

#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// The coordinates in which rays are traced: scene coordinates, recentred and scaled by a power of two so that the
/// geometry just fits between -1 and 1.
///
/// Positions go from double to float only after this change, and a power of two changes no digits: so a scene at scale
/// 2^k, or far from the origin, renders like the one at scale 1 around 0, and to the same bits where doubles can tell
/// its points apart.
class RenderSpace {
public:
    RenderSpace() = default;
    /// For geometry between the corners `lower` and `upper` (scene units), around their middle.
    RenderSpace(const DVec3& lower, const DVec3& upper) : RenderSpace(lower, upper, lower + (upper - lower) * 0.5) {}
    /// The same around another point between them: floats are densest there.
    RenderSpace(const DVec3& lower, const DVec3& upper, const DVec3& center) : center_(center) {
        const DVec3 half = glm::max(upper - center, center - lower);
        const double extent = std::max(half.x, std::max(half.y, half.z));
        int exponent = 0;
        if (extent > 0) std::frexp(extent, &exponent);
        // Beyond this range the inverse would leave the range of double.
        scale_ = std::ldexp(1.0, -std::clamp(exponent, -1000, 1000));
    }

    DVec3 point(const DVec3& p) const { return (p - center_) * scale_; }
    double length(double scene_units) const { return scene_units * scale_; }
    /// The inverse of `point`: where a point of render space lies in the scene.
    DVec3 scene_point(const DVec3& p) const { return p / scale_ + center_; }
    /// The inverse of `length`.
    double scene_length(double render_units) const { return render_units / scale_; }
    /// Render units per scene unit, a power of two.
    double scale() const { return scale_; }
    const DVec3& center() const { return center_; }

private:
    DVec3 center_{0};
    double scale_ = 1;
};

}  // namespace lightswitch
