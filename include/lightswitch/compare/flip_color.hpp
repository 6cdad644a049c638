#pragma once

// The colour spaces of the FLIP metric and its distance between two colours.

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <cmath>

namespace lightswitch::detail::flip {

/// Linear sRGB, YCxCz and CIELAB, all relative to the white D65, and the distance in [0,1] that is made of them
/// (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images": the colour pipeline).
class ColorSpaces {
public:
    /// YCxCz: linear in RGB, with the axes of CIELAB. Y is -16 for black and 100 for white; Cx goes from green to red
    /// and Cz from blue to yellow, both 0 for grey.
    Vec3 ycxcz(const Rgb& linear) const {
        const Vec3 xyz = to_xyz_ * linear;
        return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
    }

    /// Perceived distance of two filtered YCxCz colours, from 0 to 1 (blue and green, the farthest in sRGB).
    float difference(const Vec3& a, const Vec3& b) const {
        const float distance = std::pow(hyab(adapted_lab(displayed(a)), adapted_lab(displayed(b))), exponent);
        // Small distances use up most of the range: beyond the knee only 1 - knee_value of it is left.
        const float knee = knee_position * largest_;
        const float mapped = distance < knee ? distance * (knee_value / knee)
                                             : knee_value + (distance - knee) / (largest_ - knee) * (1 - knee_value);
        return std::min(mapped, 1.0f);
    }

private:
    static constexpr float exponent = 0.7f, knee_position = 0.4f, knee_value = 0.95f;

    static float hyab(const Vec3& a, const Vec3& b) {
        return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
    }

    /// The inverse of `ycxcz`, clamped to what a display shows.
    Rgb displayed(const Vec3& ycxcz) const {
        const float y = (ycxcz.x + 16) / 116;
        return glm::clamp(to_rgb_ * Vec3(y + ycxcz.y / 500, y, y - ycxcz.z / 200), 0.0f, 1.0f);
    }

    /// CIELAB with a and b in proportion to the lightness: colours look more vivid when brighter (Hunt effect).
    Vec3 adapted_lab(const Rgb& linear) const {
        const auto curve = [](float t) {
            constexpr float delta = 6.0f / 29;
            return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
        };
        const Vec3 xyz = to_xyz_ * linear;
        const float x = curve(xyz.x), y = curve(xyz.y), z = curve(xyz.z), lightness = 116 * y - 16;
        return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
    }

    /// CIE XYZ of linear sRGB with each row over its sum, so that white is (1, 1, 1).
    static glm::dmat3 relative_xyz() {
        return glm::transpose(glm::dmat3(DVec3(10135552, 8788810, 4435075) / 23359437.0,
                                         DVec3(2613072, 8788810, 887015) / 12288897.0,
                                         DVec3(1425312, 8788810, 70074185) / 80288307.0));
    }

    glm::mat3 to_xyz_{relative_xyz()}, to_rgb_{glm::inverse(relative_xyz())};
    float largest_ = std::pow(hyab(adapted_lab({0, 1, 0}), adapted_lab({0, 0, 1})), exponent);
};

/// The tone curve of ACES, from linear radiance, not negative, to linear light of a display in [0,1]: the fit of
/// Narkowicz (2016, "ACES Filmic Tone Mapping Curve") with the factor 0.6 that undoes its exposure.
inline float aces(float x) {
    x *= 0.6f;
    return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
}

/// The exposed radiance that `aces` turns into `value` in (0, 1).
inline double inverse_aces(double value) {
    const double a = 2.51 - 2.43 * value, b = 0.03 - 0.59 * value, c = -0.14 * value;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / 0.6;
}

}  // namespace lightswitch::detail::flip
