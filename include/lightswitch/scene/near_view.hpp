#pragma once

// Cameras that are so near to a surface that rays would slip through its edges.

#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/embree/accelerator.hpp>

#include <cmath>
#include <cstdint>

namespace lightswitch::detail {

/// Whether a camera at `eye` is nearer to one of the triangles of the first `meshes` geometries than 1e-4 of its size:
/// Embree's fast test takes corners relative to the ray's origin in single precision, so that it misses about that part
/// of the rays by which the distance to an edge is smaller than 1e-7 of the edge's length (docs/numerics.md). Found by
/// 256 rays all around.
inline bool is_near_view(const embree::Accelerator& accelerator, std::uint32_t meshes, const Vec3& eye) {
    constexpr int rays = 256;
    const auto counted = ray_count;  // these belong to no render
    bool found = false;
    for (int i = 0; i < rays && !found; ++i) {
        const float z = 1 - (2 * float(i) + 1) / rays, r = std::sqrt(1 - z * z), phi = 2.3999632f * float(i);
        embree::Hit hit;
        if (!accelerator.intersect({.origin = eye, .direction = {r * std::cos(phi), r * std::sin(phi), z}}, hit))
            continue;
        if (hit.geometry >= meshes) continue;
        const float size = std::sqrt(std::sqrt(length_squared(hit.normal)));  // of twice the area
        found = hit.distance < 1e-4f * size;
    }
    ray_count = counted;
    return found;
}

/// Builds the accelerator anew for the camera of a scene that is being built, unless it is robust already.
inline void make_robust_if_near(embree::Accelerator& accelerator, std::uint32_t meshes, const CameraDescription& camera,
                                auto& data) {
    const Vec3 eye(data.space.point(DVec3(camera.to_world[3])));
    if (data.statistics.robust || !is_near_view(accelerator, meshes, eye)) return;
    data.statistics.robust = true;
    accelerator.commit(true);
}

}  // namespace lightswitch::detail
