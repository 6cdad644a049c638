#pragma once

#include <lightswitch/core/warp.hpp>
#include <lightswitch/light/light.hpp>

namespace lightswitch {

/// The same radiance from all directions beyond the scene. Sampled uniformly over the sphere.
struct ConstantEnvironment {
    static constexpr bool infinite = true;

    Rgb value;
    float scene_radius;  ///< of the sphere that the light must fill

    double power() const { return double(luminance(value)) * double(pi * pi) * double(square(scene_radius)); }

    Rgb radiance(const Vec3&) const { return value; }

    LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        const Vec3 wi = uniform_sphere(u);
        return {.wi = wi, .radiance = value, .pdf = uniform_sphere_pdf(), .dirac = false, .visibility = from.spawn(wi)};
    }

    SolidAnglePdf pdf(const Vec3&) const { return uniform_sphere_pdf(); }
};

}  // namespace lightswitch
