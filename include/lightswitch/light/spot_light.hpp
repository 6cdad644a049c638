#pragma once

#include <lightswitch/core/angle.hpp>
#include <lightswitch/light/source.hpp>

namespace lightswitch {

/// A point that shines into a cone: with the same intensity up to the angle `beam` from the axis, from there falling
/// linearly with the angle to nothing at `cutoff`. Mitsuba 3's `spot`, whose axis is the local +z.
class SpotLight {
public:
    static constexpr bool infinite = false;

    /// `intensity` in W/sr, times the square of the render space's scale; `axis` a unit vector; the angles in radians,
    /// 0 < `cutoff` <= pi, and 0 <= `beam`: if it is not below `cutoff` the cone has a sharp edge.
    SpotLight(const Vec3& position, const Vec3& axis, const Rgb& intensity, double cutoff, double beam)
        : position_(position),
          axis_(axis),
          intensity_(intensity),
          one_minus_cos_cutoff_(static_cast<float>(2 * std::pow(std::sin(cutoff / 2), 2))),
          cutoff_(static_cast<float>(cutoff / (2 * pi_d))),
          penumbra_(static_cast<float>((cutoff - std::min(beam, cutoff)) / (2 * pi_d))),
          power_(double(luminance(intensity)) * 2 * pi_d * falloff_integral(cutoff, std::min(beam, cutoff))) {}

    double power() const { return power_; }
    LightBounds bounds() const {
        return {.center = position_,
                .axis = axis_,
                .cos_normals = 1,
                .cos_emission = 1 - one_minus_cos_cutoff_,
                .intensity = double(luminance(intensity_))};
    }

    LightSample sample(const SurfacePoint& from, const Vec2&) const {
        const Vec3 to_light = position_ - from.position;
        const float distance2 = length_squared(to_light);
        if (!(distance2 > 0)) return {};
        const Vec3 wi = to_light * (1 / std::sqrt(distance2));
        const float falloff = falloff_along(-wi);
        if (!(falloff > 0)) return {};
        return {.wi = wi,
                .radiance = falloff / distance2 * intensity_,
                .pdf = {1},
                .dirac = true,
                .visibility = from.segment_to(position_),
                .spread = distance2 / direction_pdf().value};
    }

    LightEmission emit(const Vec2&, const Vec2& u) const {
        const Vec3 direction = Basis(axis_).to_world(uniform_cone(u, one_minus_cos_cutoff_));
        return {.ray = {.origin = position_, .direction = direction},
                .weight = intensity_ * (falloff_along(direction) / direction_pdf().value),
                .pdf = {direction_pdf().value},
                .dirac = true};
    }
    /// For points in the cone: paths get to no others.
    float spread(const SurfacePoint& at, const Vec3&, const Vec3&) const {
        return length_squared(position_ - at.position) / direction_pdf().value;
    }

private:
    static constexpr double pi_d = 3.14159265358979323846;

    SolidAnglePdf direction_pdf() const { return uniform_cone_pdf(one_minus_cos_cutoff_); }

    /// The fraction of the intensity that leaves along the unit vector. The angle is taken from sine and cosine: the
    /// cosine alone would not tell the angles of a narrow beam apart.
    float falloff_along(const Vec3& direction) const {
        const float angle = turns(std::sqrt(length_squared(glm::cross(axis_, direction))), dot(axis_, direction));
        if (!(angle < cutoff_)) return 0;
        const float inside = cutoff_ - angle;
        return inside < penumbra_ ? inside / penumbra_ : 1;
    }

    /// Of the falloff over the sphere, by 2 pi: 1 - (sin(cutoff) - sin(beam)) / (cutoff - beam), written so that digits
    /// do not cancel, and for equal angles, too.
    static double falloff_integral(double cutoff, double beam) {
        const double middle = (cutoff + beam) / 2, half = (cutoff - beam) / 2;
        const double sinc = half > 0 ? std::sin(half) / half : 1;
        return 2 * std::pow(std::sin(middle / 2), 2) + std::cos(middle) * (1 - sinc);
    }

    Vec3 position_, axis_;
    Rgb intensity_;
    float one_minus_cos_cutoff_;
    float cutoff_, penumbra_;  // turns
    double power_;
};

/// What a description says of it: `intensity` in W/sr along the axis `direction` (any length but 0), angles in degrees.
struct SpotSource {
    DVec3 position{0};
    DVec3 direction{0, 0, 1};
    Rgb intensity{1};
    double cutoff_angle = 20;  ///< between the axis and the edge of the cone, above 0 and at most 180
    double beam_width = 15;    ///< between the axis and where the intensity begins to fall

    std::string problem() const {
        std::string problem = detail::position_problem(position, "the light's position");
        if (problem.empty()) problem = detail::direction_problem(direction, "the light's direction");
        if (problem.empty()) problem = detail::radiance_problem(intensity, "the light's intensity");
        if (!problem.empty()) return problem;
        if (!(cutoff_angle > 0 && cutoff_angle <= 180))
            return "the spot's cutoff angle is not above 0 and at most 180 degrees";
        return beam_width >= 0 ? "" : "the spot's beam width is negative";
    }
    SpotLight light(const RenderSpace& space, double) const {
        return {detail::light_position(position, space), Vec3(glm::normalize(direction)),
                detail::light_intensity(intensity, space), glm::radians(cutoff_angle), glm::radians(beam_width)};
    }
};

}  // namespace lightswitch
