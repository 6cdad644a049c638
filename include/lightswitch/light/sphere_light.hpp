#pragma once

#include <lightswitch/light/light.hpp>

namespace lightswitch {

/// An emitting sphere; its front (outside, or inside when `inward`) emits the same radiance in all directions.
///
/// A sphere that shines outwards is sampled uniformly over the solid angle that it covers (Shirley, Wang, Zimmerman,
/// "Monte Carlo Techniques for Direct Lighting Calculations", 1996); one that shines inwards by area, which also serves
/// points on the sphere itself, for which inside and outside are a matter of rounding.
struct SphereLight {
    static constexpr bool infinite = false;

    Vec3 center;
    float radius;
    bool inward;
    Rgb emission;
    float offset;  ///< as in `SurfacePoint`

    double power() const { return double(luminance(emission)) * 4 * double(pi * pi) * double(radius) * double(radius); }
    LightBounds bounds() const {
        return {.center = center,
                .radius = radius,
                .intensity = double(luminance(emission)) * double(pi) * double(radius) * double(radius)};
    }

    Rgb emitted(const SurfacePoint& at, const Vec3& direction) const {
        return dot(at.normal, direction) > 0 ? emission : Rgb(0);
    }

    [[gnu::always_inline]] LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        const Vec3 to_center = center - from.position;
        const float distance2 = length_squared(to_center);
        if (inward) return sample_by_area(from, u);
        if (!(distance2 > square(radius))) return {};
        const float one_minus_cosine = cone(distance2);
        const float distance = std::sqrt(distance2);
        const Vec3 local = uniform_cone(u, one_minus_cosine);
        const Basis basis(to_center / distance);
        const Vec3 wi = basis.to_world(local);
        // The near intersection of the direction with the sphere, from the angle alone and relative to the centre: no
        // digits cancel, however small and far the sphere is.
        const float sine2 = square(local.x) + square(local.y);
        const float half_chord = safe_sqrt(square(radius) - distance2 * sine2);
        const float reach = distance * local.z - half_chord;
        const Vec3 normal =
            normalize(basis.to_world({reach * local.x, reach * local.y, -(distance * sine2 + local.z * half_chord)}));
        return {.wi = wi,
                .radiance = emission,
                .pdf = uniform_cone_pdf(one_minus_cosine),
                .dirac = false,
                .visibility = from.segment_to(center + radius * normal, normal, offset),
                .spread = pi * uniform_cone_pdf(one_minus_cosine).value / area_pdf().value};
    }

    [[gnu::always_inline]] SolidAnglePdf pdf(const Vec3& from, const Vec3& wi, const SurfacePoint& hit) const {
        const float distance2 = length_squared(center - from);
        if (!inward) return distance2 > square(radius) ? uniform_cone_pdf(cone(distance2)) : SolidAnglePdf{};
        return to_solid_angle(area_pdf(), length_squared(hit.position - from), std::abs(dot(wi, hit.normal)));
    }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        const Vec3 outward = uniform_sphere(place), normal = inward ? -outward : outward;
        const Vec3 local = cosine_hemisphere(direction);
        return {
            .ray = {.origin = center + radius * outward + offset * normal, .direction = Basis(normal).to_world(local)},
            .weight = emission * (pi / area_pdf().value),
            .pdf = area_pdf() * cosine_hemisphere_pdf(local.z),
            .cosine = local.z};
    }
    EmissionPdf emission_pdf(const SurfacePoint& at, const Vec3& direction) const {
        return area_pdf() * cosine_hemisphere_pdf(dot(direction, at.normal));
    }
    float spread(const SurfacePoint& at, const Vec3& wi, const Vec3& place) const {
        if (inward) return pi * length_squared(place - at.position) * radius / std::abs(dot(wi, place - center));
        return pi * pdf(at.position, wi, at).value / area_pdf().value;
    }

private:
    AreaPdf area_pdf() const { return {1 / (4 * pi * square(radius))}; }

    /// 1 - cosine of half the angle that the sphere covers.
    float cone(float distance2) const {
        const float sine2 = square(radius) / distance2;
        return sine2 / (1 + safe_sqrt(1 - sine2));
    }

    LightSample sample_by_area(const SurfacePoint& from, const Vec2& u) const {
        const Vec3 outward = uniform_sphere(u);
        const Vec3 to_light = center + radius * outward - from.position;
        const float distance2 = length_squared(to_light);
        const Vec3 wi = to_light * (1 / std::sqrt(distance2));
        const float cosine = dot(wi, outward);
        if (!(cosine > 0)) return {};
        return {.wi = wi,
                .radiance = emission,
                .pdf = to_solid_angle(area_pdf(), distance2, cosine),
                .dirac = false,
                .visibility = from.segment_to(center + radius * outward, outward, offset),
                .spread = pi * distance2 / cosine};
    }
};

}  // namespace lightswitch
