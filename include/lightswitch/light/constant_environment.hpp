#pragma once

#include <lightswitch/light/source.hpp>

namespace lightswitch {

/// The same radiance from all directions beyond the scene. Sampled by the cosine over the hemisphere that the
/// surface sees, which is exact for a diffuse surface that nothing shadows; evenly over the sphere for one that light
/// gets through.
struct ConstantEnvironment {
    static constexpr bool infinite = true;

    Rgb value;
    float scene_radius;  ///< of the sphere that the light must fill

    double power() const { return double(luminance(value)) * double(pi * pi) * double(square(scene_radius)); }

    Rgb radiance(const Vec3&) const { return value; }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        if (from.material.lit_through()) [[unlikely]]
            return towards(from, uniform_sphere(u), uniform_sphere_pdf());
        const Vec3 local = cosine_hemisphere(u);
        return towards(from, Basis(from.facing_normal()).to_world(local), cosine_hemisphere_pdf(local.z));
    }

    [[gnu::always_inline]] SolidAnglePdf pdf(const Vec3& normal, const Vec3& wi) const {
        return normal == Vec3(0) ? uniform_sphere_pdf() : cosine_hemisphere_pdf(dot(normal, wi));
    }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        const Vec3 wi = uniform_sphere(direction);
        return {.ray = ray_into_scene(wi, place, scene_radius),
                .weight = value / emission_pdf(wi).value,
                .pdf = emission_pdf(wi)};
    }
    EmissionPdf emission_pdf(const Vec3&) const { return uniform_disk_pdf(scene_radius) * uniform_sphere_pdf(); }
    float spread(const SurfacePoint& at, const Vec3& wi, const Vec3&) const {
        return pdf(at.lit_normal(), wi).value / emission_pdf(wi).value;
    }

private:
    [[gnu::always_inline]] LightSample towards(const SurfacePoint& from, const Vec3& wi, SolidAnglePdf pdf) const {
        return {.wi = wi,
                .radiance = value,
                .pdf = pdf,
                .dirac = false,
                .visibility = from.spawn(wi),
                .spread = pdf.value / emission_pdf(wi).value};
    }
};

/// The same radiance (W/(m^2 sr)) from every direction beyond the scene.
struct EnvironmentSource {
    Rgb radiance{1};

    std::string problem() const { return detail::radiance_problem(radiance, "the environment's radiance"); }
    ConstantEnvironment light(const RenderSpace&, double radius) const { return {radiance, float(radius)}; }
    Emitter emitter(const ConstantEnvironment& light) const {
        return {.kind = Emitter::Kind::environment, .strength = light.value};
    }
};

}  // namespace lightswitch
