#pragma once

#include <lightswitch/light/source.hpp>

namespace lightswitch {

/// A point that sends the same intensity in all directions.
struct PointLight {
    static constexpr bool infinite = false;

    Vec3 position;
    Rgb intensity;  ///< W/sr, times the square of the render space's scale

    double power() const { return double(luminance(intensity)) * 4 * double(pi); }
    LightBounds bounds() const { return {.center = position, .intensity = double(luminance(intensity))}; }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2&) const {
        const Vec3 to_light = position - from.position;
        const float distance2 = length_squared(to_light);
        if (!(distance2 > 0)) return {};
        return {.wi = to_light * (1 / std::sqrt(distance2)),
                .radiance = intensity / distance2,
                .pdf = {1},
                .dirac = true,
                .visibility = from.segment_to(position),
                .spread = 4 * pi * distance2};
    }

    LightEmission emit(const Vec2&, const Vec2& u) const {
        return {.ray = {.origin = position, .direction = uniform_sphere(u)},
                .weight = intensity * (4 * pi),
                .pdf = {uniform_sphere_pdf().value},
                .dirac = true};
    }
    float spread(const SurfacePoint& at, const Vec3&, const Vec3&) const {
        return 4 * pi * length_squared(position - at.position);
    }
};

/// A light at a point: `intensity` in W/sr.
struct PointSource {
    DVec3 position{0};
    Rgb intensity{1};

    std::string problem() const {
        const std::string problem = detail::position_problem(position, "the light's position");
        return problem.empty() ? detail::radiance_problem(intensity, "the light's intensity") : problem;
    }
    PointLight light(const RenderSpace& space, double) const {
        return {detail::light_position(position, space), detail::light_intensity(intensity, space)};
    }
    Emitter emitter(const PointLight& light) const {
        return {.kind = Emitter::Kind::point, .strength = light.intensity, .position = light.position};
    }
};

}  // namespace lightswitch
