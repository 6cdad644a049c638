#pragma once

#include <lightswitch/light/light.hpp>

namespace lightswitch {

/// One triangle of an emitting mesh; it emits the same radiance in all directions from its front. Sampled by area.
struct TriangleLight {
    static constexpr bool infinite = false;

    Vec3 corner, edge1, edge2;
    Vec3 normal;  ///< unit, on the emitting side
    Rgb emission;
    AreaPdf density;  ///< one over the area
    float offset;     ///< as in `SurfacePoint`

    double power() const { return double(luminance(emission)) * double(pi) / double(density.value); }
    /// Around the centroid.
    LightBounds bounds() const {
        const Vec3 middle = (edge1 + edge2) * (1.0f / 3);
        const float farthest2 =
            std::max({length_squared(middle), length_squared(edge1 - middle), length_squared(edge2 - middle)});
        return {.center = corner + middle,
                .radius = std::sqrt(farthest2),
                .axis = normal,
                .cos_normals = 1,
                .cos_emission = 0,
                .intensity = power() / double(pi)};
    }

    Rgb emitted(const SurfacePoint& at, const Vec3& direction) const {
        return dot(at.normal, direction) > 0 ? emission : Rgb(0);
    }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        const Vec2 b = uniform_triangle(u);
        const Vec3 position = corner + b.x * edge1 + b.y * edge2;
        const Vec3 to_light = position - from.position;
        const float distance2 = length_squared(to_light);
        const Vec3 wi = to_light * (1 / std::sqrt(distance2));
        const float cosine = -dot(wi, normal);
        if (!(cosine > 0)) return {};
        return {.wi = wi,
                .radiance = emission,
                .pdf = to_solid_angle(density, distance2, cosine),
                .dirac = false,
                .visibility = from.segment_to(position, normal, offset),
                .spread = pi * distance2 / cosine};
    }

    [[gnu::always_inline]] SolidAnglePdf pdf(const Vec3& from, const Vec3& wi, const SurfacePoint& hit) const {
        const float distance2 = length_squared(hit.position - from);
        return to_solid_angle(density, distance2, std::abs(dot(wi, hit.normal)));
    }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        const Vec2 b = uniform_triangle(place);
        const Vec3 local = cosine_hemisphere(direction);
        return {.ray = {.origin = corner + b.x * edge1 + b.y * edge2 + offset * normal,
                        .direction = Basis(normal).to_world(local)},
                .weight = emission * (pi / density.value),
                .pdf = density * cosine_hemisphere_pdf(local.z),
                .cosine = local.z};
    }
    EmissionPdf emission_pdf(const SurfacePoint& at, const Vec3& direction) const {
        return density * cosine_hemisphere_pdf(dot(direction, at.normal));
    }
    float spread(const SurfacePoint& at, const Vec3& wi, const Vec3& place) const {
        return pi * length_squared(place - at.position) / std::abs(dot(wi, normal));
    }
};

}  // namespace lightswitch
