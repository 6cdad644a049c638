#pragma once

// From what Embree says of a hit to the point on the surface.

#include <lightswitch/core/maybe.hpp>
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

/// The same for what an instance has placed: `hit` gets the numbers of the scene's own records.
[[gnu::noinline]] inline void locate_on_instance(const auto& data, const InstanceRecord& instance, const Ray& ray,
                                                 embree::Hit& hit, SurfacePoint& point) {
    const GroupRecord& group = data.groups[instance.group];
    const bool on_sphere = hit.geometry >= group.mesh_count;
    hit.geometry = on_sphere ? static_cast<std::uint32_t>(data.meshes.size()) : hit.geometry + group.first_mesh;
    if (on_sphere) hit.primitive += group.first_sphere;
    const AffineMap &in = instance.to_group, &out = instance.to_scene;
    const Ray local = instance.in_place ? ray
                                        : Ray{.origin = in.point(ray.origin),
                                              .direction = in.linear * ray.direction,
                                              .near = ray.near,
                                              .far = ray.far};
    if (on_sphere) locate_on_sphere(data, local, hit, point);
    else locate_on_triangle(data, local, hit, point);
    if (instance.in_place) return;

    // How far Embree's idea of the ray in the group is from the true one, across the surface: rounding of what is added
    // up, and of the matrix, which acts on the vector from the group's centre to the point, at most about 1 there.
    const Vec3 sum = glm::abs(ray.origin) + glm::abs(out.shift) + glm::abs(hit.distance * ray.direction);
    const float across = point.offset + instance.rounding +
                         gamma_bound(6) * dot(glm::abs(point.normal), AffineMap::absolute(in.linear) * sum);
    // A distance along a normal n in the group is 1 / |A n| of it in the scene, where A takes normals there.
    const Mat3 normals = glm::transpose(in.linear);
    const Vec3 normal = normals * point.normal;
    const float stretch = 1 / std::sqrt(length_squared(normal));
    const Vec3 local_position = point.position;
    point.position = out.point(local_position);
    point.normal = normal * stretch;
    point.shading_normal = normalize(normals * point.shading_normal);
    point.offset = across * stretch + gamma_bound(6) * dot(glm::abs(point.normal), out.largest(local_position));
    point.wo = -ray.direction;
}

/// Fills in the point of any hit; in scenes with instances `hit` gets the numbers of the scene's own records.
[[gnu::always_inline]] inline void locate(const auto& data, const Placement& placement, const Ray& ray,
                                          embree::Hit& hit, SurfacePoint& point) {
    if (hit.instance != embree::Hit::no_instance) [[unlikely]]
        locate_on_instance(data, placement.instances[hit.instance], ray, hit, point);
    else if (hit.geometry < data.meshes.size()) [[likely]] locate_on_triangle(data, ray, hit, point);
    else locate_on_sphere(data, ray, hit, point);
}

/// The numbers of the scene's own records for what a ray meets, wherever an instance places it.
[[gnu::noinline]] inline Maybe<embree::Hit> identify(const auto& data, const Placement& placement, const Ray& ray) {
    embree::Hit hit;
    if (!placement.accelerator.intersect(ray, hit)) return {};
    SurfacePoint point;
    locate(data, placement, ray, hit, point);
    return hit;
}

}  // namespace lightswitch::detail
