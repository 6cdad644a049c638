#pragma once

// Simple shapes: a sphere, and meshes of common forms.

#include <lightswitch/scene/mesh.hpp>

#include <numbers>
#include <optional>

namespace lightswitch {

/// A sphere; the front is the outside unless `inward`.
struct Sphere {
    DVec3 center{0};
    double radius = 1;  ///< in scene units
    bool inward = false;
    DMat3 axes{1};  ///< orthonormal columns: its own x, y and z axes, for texture coordinates

    /// The sphere under an affine `matrix`; nothing when it would not be one any more. As in Mitsuba 3.9, a reflection
    /// turns it inside out.
    std::optional<Sphere> transformed(const DMat4& matrix) const;
};

// Texture coordinates are those of Mitsuba 3.9's shapes.

/// The square from (-1, -1, 0) to (1, 1, 0) whose front looks along +z, under `to_world`.
Mesh rectangle(const DMat4& to_world = DMat4(1));
/// The cube from -1 to 1 in each axis, fronts outward, under `to_world`.
Mesh cube(const DMat4& to_world = DMat4(1));
/// The unit disk in z = 0 whose front looks along +z, under `to_world`: a fan of 256 triangles with the area of the
/// disk. Texture coordinates are the distance from its centre and the angle, to 1/512 of a turn.
Mesh disk(const DMat4& to_world = DMat4(1));
/// The side, outwards, of the cylinder of radius 1 around z from 0 to 1, under `to_world`: 256 flat sides with the area
/// of the round one and its normals. Texture coordinates are the angle and the height.
Mesh cylinder(const DMat4& to_world = DMat4(1));
/// A flat four-sided polygon with corners counter-clockwise as seen from the front, and texture coordinates from (0, 0)
/// at the first one to (1, 1) at the third.
Mesh quad(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d);

inline std::optional<Sphere> Sphere::transformed(const DMat4& matrix) const {
    const double scale = std::cbrt(linear_determinant(matrix));
    const DMat3 turned = DMat3(matrix) / scale;
    if (!is_orthonormal(turned, 1e-6)) return {};
    return Sphere{.center = DVec3(matrix * glm::dvec4(center, 1)),
                  .radius = radius * std::abs(scale),
                  .inward = inward != (scale < 0),
                  .axes = turned * axes};
}

inline Mesh quad(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    return {.positions = {a, b, c, d},
            .normals = {},
            .triangles = {{0, 1, 2}, {0, 2, 3}},
            .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
}

inline Mesh rectangle(const DMat4& to_world) {
    return quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).transformed(to_world);
}

inline Mesh cube(const DMat4& to_world) {
    constexpr std::uint32_t corners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Mesh mesh;
    for (std::uint32_t t = 0; t < 12; ++t) {
        for (const std::uint32_t i : corners[t]) {
            const Vec3 to_one(i & 1, (i >> 1) & 1, i >> 2);  // from 0 to 1
            const Vec3 down = Vec3(1) - to_one;
            const Vec2 on_face[6] = {{down.y, to_one.x}, {to_one.y, to_one.x}, {to_one.z, to_one.x},
                                     {down.x, down.z},   {to_one.y, to_one.z}, {to_one.y, down.z}};
            mesh.positions.push_back(DVec3(to_one) * 2.0 - 1.0);
            mesh.uvs.push_back(on_face[t / 2]);
        }
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh.transformed(to_world);
}

inline Mesh disk(const DMat4& to_world) {
    constexpr std::uint32_t sides = 256;
    constexpr double step = 2 * std::numbers::pi / sides;
    // A polygon of circumradius r has the area sides / 2 * r^2 * sin(step).
    const double radius = std::sqrt(step / std::sin(step));
    const auto rim = [&](std::uint32_t i) { return radius * DVec3(std::cos(i * step), std::sin(i * step), 0); };
    Mesh mesh;
    for (std::uint32_t i = 0; i < sides; ++i) {
        mesh.positions.insert(mesh.positions.end(), {DVec3(0), rim(i), rim((i + 1) % sides)});
        const float v = static_cast<float>(i) / sides, next = static_cast<float>(i + 1) / sides;
        mesh.uvs.insert(mesh.uvs.end(), {{0, (v + next) / 2}, {1, v}, {1, next}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh.transformed(to_world);
}

inline Mesh cylinder(const DMat4& to_world) {
    constexpr std::uint32_t sides = 256;
    constexpr double step = 2 * std::numbers::pi / sides;
    // A prism of circumradius r has the girth 2 * sides * r * sin(step / 2).
    const double radius = step / 2 / std::sin(step / 2);
    Mesh mesh;
    for (std::uint32_t i = 0; i <= sides; ++i) {
        const DVec3 outward(std::cos(i * step), std::sin(i * step), 0);
        for (const double height : {0.0, 1.0}) {
            mesh.positions.push_back(radius * outward + DVec3(0, 0, height));
            mesh.normals.push_back(outward);
            mesh.uvs.emplace_back(static_cast<float>(i) / sides, static_cast<float>(height));
        }
        if (i == sides) break;
        const std::uint32_t low = 2 * i, high = low + 1, next_low = low + 2, next_high = low + 3;
        mesh.triangles.push_back({low, next_low, next_high});
        mesh.triangles.push_back({low, next_high, high});
    }
    return mesh.transformed(to_world);
}

}  // namespace lightswitch
