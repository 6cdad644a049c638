#pragma once

// Simple shapes: a sphere, and meshes of common forms.

#include <lightswitch/scene/mesh.hpp>

#include <numbers>

namespace lightswitch {

/// A sphere; the front is the outside unless `inward`.
struct Sphere {
    DVec3 center{0};
    double radius = 1;  ///< in scene units
    bool inward = false;
};

/// The square from (-1, -1, 0) to (1, 1, 0) whose front looks along +z, under `to_world`.
Mesh rectangle(const DMat4& to_world = DMat4(1));
/// The cube from -1 to 1 in each axis, fronts outward, under `to_world`.
Mesh cube(const DMat4& to_world = DMat4(1));
/// The unit disk in z = 0 whose front looks along +z, under `to_world`: a fan of 256 triangles with the area of the
/// disk.
Mesh disk(const DMat4& to_world = DMat4(1));
/// A flat four-sided polygon with corners counter-clockwise as seen from the front.
Mesh quad(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d);

inline Mesh quad(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    return {.positions = {a, b, c, d}, .normals = {}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

inline Mesh rectangle(const DMat4& to_world) {
    return quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).transformed(to_world);
}

inline Mesh cube(const DMat4& to_world) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.push_back(DVec3(i & 1, (i >> 1) & 1, i >> 2) * 2.0 - 1.0);
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh.transformed(to_world);
}

inline Mesh disk(const DMat4& to_world) {
    constexpr std::uint32_t sides = 256;
    constexpr double step = 2 * std::numbers::pi / sides;
    // A polygon of circumradius r has the area sides / 2 * r^2 * sin(step).
    const double radius = std::sqrt(step / std::sin(step));
    Mesh mesh{.positions = {DVec3(0)}, .normals = {}, .triangles = {}};
    for (std::uint32_t i = 0; i < sides; ++i) {
        mesh.positions.push_back(radius * DVec3(std::cos(i * step), std::sin(i * step), 0));
        mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    return mesh.transformed(to_world);
}

}  // namespace lightswitch
