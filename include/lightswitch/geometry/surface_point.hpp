#pragma once

#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/geometry/ray.hpp>

namespace lightswitch {

/// A point on a surface, in render space. Made by `Scene::intersect`.
///
/// `offset` bounds how far the computed `position` (and Embree's idea of the surface near it) can be from the exact
/// surface, measured along the normal. Rays start and end that far away, so that they neither hit the surface that they
/// leave nor skip a neighbour; no length is assumed anywhere (pbrt-v4, section 6.8).
struct SurfacePoint {
    Vec3 position;
    Vec3 normal;             ///< geometric, unit, on the front side
    Vec3 shading_normal;     ///< unit; equal to `normal` on flat surfaces
    Vec3 wo;                 ///< where the ray that found the point came from: minus its direction
    float offset = 0;        ///< see above
    float distance = 0;      ///< from the origin of the ray that found the point, in multiples of its direction
    MaterialIndex material;  ///< which BSDF
    TypedIndex light;        ///< which light of the scene this surface is, if it is one

    /// The shading normal on the side that was seen.
    [[gnu::always_inline]] Vec3 facing_normal() const {
        return dot(shading_normal, wo) < 0 ? -shading_normal : shading_normal;
    }

    /// On which side light matters here: the facing normal, or 0 where both sides count.
    [[gnu::always_inline]] Vec3 lit_normal() const { return material.lit_through() ? Vec3(0) : facing_normal(); }

    /// The frame in which the surface model is asked: of a two-sided surface that is seen from the back mirrored, so
    /// that the model sees its front.
    [[gnu::always_inline]] Basis shading_frame() const {
        Basis frame(shading_normal);
        turn_to_viewer(frame);
        return frame;
    }
    [[gnu::always_inline]] void turn_to_viewer(Basis& frame) const {
        if (material.two_sided()) frame.normal *= std::copysign(1.0f, dot(wo, shading_normal));
    }

    /// The position moved off the surface to the side of `direction`.
    [[gnu::always_inline]] Vec3 position_towards(const Vec3& direction) const {
        return position + std::copysign(offset, dot(direction, normal)) * normal;
    }

    /// A ray that leaves the surface along `direction` (unit).
    [[gnu::always_inline]] Ray spawn(const Vec3& direction, float far = infinity) const {
        return {.origin = position_towards(direction), .direction = direction, .near = 0, .far = far};
    }

    /// The segment to `target`, which must already stand off its own surface: the ray to test for visibility.
    [[gnu::always_inline]] Ray segment_to(const Vec3& target) const {
        const Vec3 origin = position_towards(target - position);
        return {.origin = origin, .direction = target - origin, .near = 0, .far = 1};
    }

    /// The same to the point `target` of another surface with that normal (on either side) and offset: it ends off that
    /// surface, on the side that it comes from.
    [[gnu::always_inline]] Ray segment_to(const Vec3& target, const Vec3& target_normal, float target_offset) const {
        const Vec3 to_target = target - position;
        // Seen from here, the other surface is also uncertain by the rounding of the ray and of Embree's test, which
        // grow with the distance, however small that surface's own coordinates are.
        const float clearance = target_offset + gamma_bound(10) * std::sqrt(length_squared(to_target));
        return segment_to(target - std::copysign(clearance, dot(to_target, target_normal)) * target_normal);
    }
};

}  // namespace lightswitch
