#pragma once

// Triangle meshes as the user describes them: double precision, world space.

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace lightswitch {

/// A triangle mesh. Seen from its front, a triangle's corners run counter-clockwise.
struct Mesh {
    std::vector<DVec3> positions;  ///< in scene units
    std::vector<DVec3> normals;    ///< one per position, any length but 0; empty for flat triangles
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `positions`
    std::vector<Vec2> uvs{};  ///< texture coordinates by position; those that lack are (0, 0)

    /// The mesh under an affine, invertible `matrix`; normals follow the inverse transpose, and a reflection leaves the
    /// front where the transformed normals point (it also swaps the winding, so that front and normals stay together).
    Mesh transformed(const DMat4& matrix) const&;
    Mesh transformed(const DMat4& matrix) &&;  ///< without a copy
    /// The mesh with front and back exchanged.
    Mesh flipped() const&;
    Mesh flipped() &&;  ///< without a copy
    /// Replaces the normals by angle-weighted averages over the triangles around each position (Thuermer and Wuethrich,
    /// "Computing Vertex Normals from Polygonal Facets", JGT 1998), as Mitsuba does. Triangles without area do not
    /// count; a position without any other triangle gets (1, 0, 0).
    void smooth();
    /// Gives triangles that meet at more than `degrees` positions of their own, so that `smooth` leaves a crease
    /// between them. Around a point its first triangle takes all with it whose normals are within the angle of its own,
    /// then the first one that is left, and so on (`maxSmoothAngle` of Mitsuba 0.6). Positions that are equal, and have
    /// equal texture coordinates, become one; normals go.
    void split_creases(double degrees);
    /// Turns each triangle whose normals on the whole point to its back, so that the normals decide which side is the
    /// front.
    void face_along_normals();

private:
    void transform(const DMat4& matrix);
    void flip();
    /// Normal of a triangle by its winding, not normalized: its length is twice the area.
    DVec3 area_normal(const std::array<std::uint32_t, 3>& t) const;
};

/// Determinant of the linear part of an affine matrix: negative for a reflection.
double linear_determinant(const DMat4& matrix);

inline double linear_determinant(const DMat4& matrix) {
    return glm::dot(DVec3(matrix[0]), glm::cross(DVec3(matrix[1]), DVec3(matrix[2])));
}

inline Mesh Mesh::transformed(const DMat4& matrix) const& {
    Mesh result = *this;
    result.transform(matrix);
    return result;
}

inline Mesh Mesh::transformed(const DMat4& matrix) && {
    transform(matrix);
    return std::move(*this);
}

inline void Mesh::transform(const DMat4& matrix) {
    for (DVec3& p : positions) p = DVec3(matrix * glm::dvec4(p, 1.0));

    // The inverse transpose up to a positive factor, by columns. The scale is taken out first, against underflow.
    const double scale = largest_entry(DMat3(matrix));
    const DVec3 x = DVec3(matrix[0]) / scale, y = DVec3(matrix[1]) / scale, z = DVec3(matrix[2]) / scale;
    const bool reflection = glm::dot(x, glm::cross(y, z)) < 0;
    const double sign = reflection ? -1 : 1;
    const DVec3 nx = sign * glm::cross(y, z), ny = sign * glm::cross(z, x), nz = sign * glm::cross(x, y);
    for (DVec3& n : normals) {
        const DVec3 turned = n.x * nx + n.y * ny + n.z * nz;
        n = turned / glm::length(turned);
    }

    if (reflection)
        for (auto& t : triangles) std::swap(t[1], t[2]);
}

inline Mesh Mesh::flipped() const& {
    Mesh result = *this;
    result.flip();
    return result;
}

inline Mesh Mesh::flipped() && {
    flip();
    return std::move(*this);
}

inline void Mesh::flip() {
    for (DVec3& n : normals) n = -n;
    for (auto& t : triangles) std::swap(t[1], t[2]);
}

inline DVec3 Mesh::area_normal(const std::array<std::uint32_t, 3>& t) const {
    return glm::cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
}

inline void Mesh::smooth() {
    normals.assign(positions.size(), DVec3(0));
    for (const auto& [first, second, third] : triangles) {
        const DVec3 &a = positions[first], &b = positions[second], &c = positions[third];
        const DVec3 ab = b - a, ac = c - a, bc = c - b;
        const DVec3 normal = glm::cross(ab, ac);
        const double length = glm::length(normal);
        if (!(length > 0)) continue;
        const DVec3 unit = normal / length;
        // The length of the cross product is the same at all three corners; atan2 is exact for thin triangles too.
        normals[first] += unit * std::atan2(length, glm::dot(ab, ac));
        normals[second] += unit * std::atan2(length, -glm::dot(bc, ab));
        normals[third] += unit * std::atan2(length, glm::dot(ac, bc));
    }
    for (DVec3& n : normals) {
        const double length = glm::length(n);
        n = length > 0 ? n / length : DVec3(1, 0, 0);
    }
}

inline void Mesh::split_creases(double degrees) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    constexpr int most = 1000;  // directions around one point, so that no file costs the square of its size
    struct Corner {
        std::size_t triangle, which;
    };
    std::vector<DVec3> units;
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const DVec3 normal = area_normal(triangles[i]);
        const double length = glm::length(normal);
        units.push_back(length > 0 ? normal / length : DVec3(0));
        for (std::size_t c = 0; c < 3; ++c) corners.push_back({i, c});
    }
    const auto key = [&](const Corner& corner) {
        const std::uint32_t at = triangles[corner.triangle][corner.which];
        const Vec2 uv = at < uvs.size() ? uvs[at] : Vec2(0);
        return std::tuple(positions[at].x, positions[at].y, positions[at].z, uv.x, uv.y);
    };
    std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
        return std::tuple(key(a), a.triangle, a.which) < std::tuple(key(b), b.triangle, b.which);
    });

    Mesh split;
    split.triangles.assign(triangles.size(), {none, none, none});
    const auto place = [&](const Corner& corner) -> std::uint32_t& {
        return split.triangles[corner.triangle][corner.which];
    };
    const double least = std::cos(glm::radians(degrees));
    for (auto group = corners.begin(); group != corners.end();) {
        const auto end =
            std::find_if(group, corners.end(), [&](const auto& other) { return key(other) != key(*group); });
        for (int directions = 0; group != end; ++group) {
            if (place(*group) != none) continue;
            const std::uint32_t from = triangles[group->triangle][group->which];
            const auto number = static_cast<std::uint32_t>(split.positions.size());
            split.positions.push_back(positions[from]);
            if (!uvs.empty()) split.uvs.push_back(from < uvs.size() ? uvs[from] : Vec2(0));
            const DVec3 first = units[group->triangle];
            const auto last = ++directions < most ? end : std::next(group);
            for (auto other = group; other != last; ++other) {
                const DVec3& unit = units[other->triangle];
                if (place(*other) == none && (unit == first || glm::dot(unit, first) > least)) place(*other) = number;
            }
        }
    }
    *this = std::move(split);
}

inline void Mesh::face_along_normals() {
    if (normals.empty()) return;
    for (auto& t : triangles)
        if (glm::dot(area_normal(t), normals[t[0]] + normals[t[1]] + normals[t[2]]) < 0) std::swap(t[1], t[2]);
}

}  // namespace lightswitch
