#pragma once

#include <lightswitch/light/light.hpp>

namespace lightswitch {

/// The same radiance from all directions beyond the scene. Sampled by the cosine over the hemisphere that the
/// surface sees, which is exact for a diffuse surface that nothing shadows.
struct ConstantEnvironment {
    static constexpr bool infinite = true;

    Rgb value;
    float scene_radius;  ///< of the sphere that the light must fill

    double power() const { return double(luminance(value)) * double(pi * pi) * double(square(scene_radius)); }

    Rgb radiance(const Vec3&) const { return value; }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        const Vec3 local = cosine_hemisphere(u);
        const Vec3 wi = Basis(from.facing_normal()).to_world(local);
        return {.wi = wi,
                .radiance = value,
                .pdf = cosine_hemisphere_pdf(local.z),
                .dirac = false,
                .visibility = from.spawn(wi),
                .spread = cosine_hemisphere_pdf(local.z).value / emission_pdf().value};
    }

    [[gnu::always_inline]] SolidAnglePdf pdf(const Vec3& normal, const Vec3& wi) const {
        return cosine_hemisphere_pdf(dot(normal, wi));
    }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        return {.ray = ray_into_scene(uniform_sphere(direction), place, scene_radius),
                .weight = value / emission_pdf().value,
                .pdf = emission_pdf()};
    }
    EmissionPdf emission_pdf() const { return uniform_disk_pdf(scene_radius) * uniform_sphere_pdf(); }
    float spread(const SurfacePoint& at, const Vec3& wi, const Vec3&) const {
        return pdf(at.facing_normal(), wi).value / emission_pdf().value;
    }
};

}  // namespace lightswitch
