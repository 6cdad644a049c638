#pragma once

#include <lightswitch/light/source.hpp>

namespace lightswitch {

/// Parallel light from infinitely far away.
struct DirectionalLight {
    static constexpr bool infinite = true;

    Vec3 towards;        ///< unit, from the scene to the light
    Rgb irradiance;      ///< on a surface that faces the light, W/m^2
    float scene_radius;  ///< of the sphere that the light must fill

    double power() const { return double(luminance(irradiance)) * double(pi) * double(square(scene_radius)); }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2&) const {
        return {.wi = towards,
                .radiance = irradiance,
                .pdf = {1},
                .dirac = true,
                .visibility = from.spawn(towards),
                .spread = pi * square(scene_radius)};
    }

    LightEmission emit(const Vec2& u, const Vec2&) const {
        return {.ray = ray_into_scene(towards, u, scene_radius),
                .weight = irradiance * (pi * square(scene_radius)),
                .pdf = {uniform_disk_pdf(scene_radius).value},
                .dirac = true};
    }
    float spread(const SurfacePoint&, const Vec3&, const Vec3&) const { return pi * square(scene_radius); }
};

/// A light from infinitely far away: light travels along `direction` (any length but 0) and brings `irradiance` (W/m^2)
/// to a surface that faces it.
struct DirectionalSource {
    DVec3 direction{0, 0, -1};
    Rgb irradiance{1};

    std::string problem() const {
        const std::string problem = detail::direction_problem(direction, "the light's direction");
        return problem.empty() ? detail::radiance_problem(irradiance, "the light's irradiance") : problem;
    }
    DirectionalLight light(const RenderSpace&, double radius) const {
        return {Vec3(-glm::normalize(direction)), irradiance, float(radius)};
    }
    Emitter emitter(const DirectionalLight& light) const {
        return {.kind = Emitter::Kind::directional, .strength = light.irradiance, .direction = light.towards};
    }
};

}  // namespace lightswitch
