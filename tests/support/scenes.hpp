#pragma once

// Small scenes for tests of single parts.

#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/core/warp.hpp>
#include <lightswitch/scene/build.hpp>
#include <lightswitch/scene/shapes.hpp>

#include "chi_square.hpp"

#include <utility>

namespace lightswitch::test {

/// Grey surfaces and any light.
using GreyScene = Scene<Bsdfs<Lambert>, AllLights>;
using GreyDescription = SceneDescription<Lambert>;

/// A description that holds one grey material, number 0, and a small film.
inline GreyDescription grey_description() {
    GreyDescription scene;
    scene.add(Lambert{Rgb(0.5f)});
    scene.film.width = scene.film.height = 8;
    return scene;
}

inline GreyScene build_grey(const GreyDescription& description, std::size_t tree_from = BuildOptions{}.tree_from) {
    return build_scene<Bsdfs<Lambert>, AllLights>(description, {.embree_config = "threads=1", .tree_from = tree_from});
}

/// A triangle of `size` at `center` with a random orientation and shape.
inline Mesh random_triangle(Random& random, const DVec3& center, double size) {
    const auto corner = [&] { return center + size * DVec3(uniform_sphere(random.next_2d())); };
    const DVec3 a = corner(), b = corner(), c = corner();
    return {.positions = {a, b, c}, .normals = {}, .triangles = {{0, 1, 2}}};
}

/// Two tiny triangles that stretch a scene to the box from -1 to 1, or nearly so: then render space is scene space.
inline void stretch_to_unit_box(GreyDescription& scene) {
    for (const double s : {-0.9999, 0.9999})
        scene.add(
            Mesh{
                .positions = {DVec3(s), {s, s, s * 0.999}, {s, s * 0.999, s}}, .normals = {}, .triangles = {{0, 1, 2}}},
            0);
}

/// A point in free space, as if on a surface with that normal (scene units).
inline SurfacePoint free_point(const GreyScene& scene, const DVec3& position, const Vec3& normal = {0, 0, 1}) {
    SurfacePoint point;
    point.position = Vec3(scene.space().point(position));
    point.normal = point.shading_normal = point.wo = normal;
    return point;
}

}  // namespace lightswitch::test
