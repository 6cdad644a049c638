#pragma once

// The only file that includes Embree. Versions 3.13 and 4.x look the same behind it.

#include <lightswitch/core/floating_point.hpp>

#ifndef LIGHTSWITCH_EMBREE_MAJOR
#if __has_include(<embree4/rtcore.h>)
#define LIGHTSWITCH_EMBREE_MAJOR 4
#else
#define LIGHTSWITCH_EMBREE_MAJOR 3
#endif
#endif

#if LIGHTSWITCH_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lightswitch::embree {

/// Closest hit of `ray_hit.ray`, written to `ray_hit`.
[[gnu::always_inline]] inline void intersect(RTCScene scene, RTCRayHit& ray_hit) {
#if LIGHTSWITCH_EMBREE_MAJOR >= 4
    rtcIntersect1(scene, &ray_hit, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray_hit);
#endif
}

/// Sets `ray.tfar` to minus infinity when anything is hit.
[[gnu::always_inline]] inline void occluded(RTCScene scene, RTCRay& ray) {
#if LIGHTSWITCH_EMBREE_MAJOR >= 4
    rtcOccluded1(scene, &ray, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace lightswitch::embree
