#pragma once

// From what Embree says of a hit to the point on the surface.

#include <lightswitch/embree/accelerator.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/scene/scene_data.hpp>

namespace lightswitch::detail {

/// Fills in the point of a triangle mesh that a ray has hit.
[[gnu::always_inline]] inline void locate_on_triangle(const auto& data, const Ray& ray, const embree::Hit& hit,
                                                      SurfacePoint& point) {
    const MeshRecord& mesh = data.meshes[hit.geometry];
    const Vec3 step = hit.distance * ray.direction;
    point.position = ray.origin + step;
    // Twice the area long, at most 12: scaled so that its square neither overflows nor vanishes for the smallest
    // triangles.
    point.normal = normalize(hit.normal * 0x1p59f);
    point.shading_normal = point.normal;
    // Rounding of the sum above and of the distance, both across the surface, grows with what was added up.
    const Vec3 n = glm::abs(point.normal);
    point.offset =
        mesh.intersection_error + gamma_bound(6) * (dot(n, glm::abs(ray.origin)) + max_component(glm::abs(step)));
    point.wo = -ray.direction;
    point.distance = hit.distance;
    point.material = mesh.material;
    point.light = mesh.first_light ? mesh.first_light.next(hit.primitive) : TypedIndex();
    if (mesh.shading_normals != MeshRecord::flat) {
        const auto& normals = data.shading_normals[mesh.shading_normals + hit.primitive];
        const Vec3 sum = (1 - hit.u - hit.v) * normals[0] + hit.u * normals[1] + hit.v * normals[2];
        const float length2 = length_squared(sum);
        if (length2 > 0) point.shading_normal = sum * (1 / std::sqrt(length2));
    }
}

/// The same for a sphere.
[[gnu::always_inline]] inline void locate_on_sphere(const auto& data, const Ray& ray, const embree::Hit& hit,
                                                    SurfacePoint& point) {
    const SphereRecord& s = data.spheres[hit.primitive];
    // Projected back onto the sphere, where the error no longer depends on how far the ray came.
    const Vec3 outward = normalize(ray.origin + hit.distance * ray.direction - s.center);
    point.position = s.center + s.radius * outward;
    point.normal = s.side * outward;
    point.shading_normal = point.normal;
    point.offset = s.offset;
    point.wo = -ray.direction;
    point.distance = hit.distance;
    point.material = s.material;
    point.light = s.light;
}

/// The texture coordinates of a hit on a triangle mesh; without any in the description the barycentric weights of the
/// second and third corner.
inline Vec2 uv_on_triangle(const auto& data, const embree::Hit& hit) {
    const std::uint32_t first = data.first_uvs[hit.geometry];
    if (first == MeshRecord::flat) return {hit.u, hit.v};
    const auto& corners = data.uvs[first + hit.primitive];
    return (1 - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2];
}

/// The same on a sphere: u goes around its z axis, from x over y, v from the top to the bottom.
inline Vec2 uv_on_sphere(const auto& data, const embree::Hit& hit, const SurfacePoint& point) {
    const Vec3 local = data.sphere_axes[hit.primitive] * (data.spheres[hit.primitive].side * point.normal);
    const float around = std::atan2(local.y, local.x) * (0.5f * inv_pi);
    return {around < 0 ? around + 1 : around, std::acos(std::clamp(local.z, -1.0f, 1.0f)) * inv_pi};
}

}  // namespace lightswitch::detail
