#pragma once

// How small a shape may be in single precision, and bounds of rounding on it. All lengths are in render space.

#include <lightswitch/core/math.hpp>

namespace lightswitch::detail {

/// The radius, and edge, below which a shape in render space is no longer one: a density on it, times the square of
/// the distance to it, would leave the range of a float at angles that are not grazing.
inline constexpr double smallest_shape = 0x1p-50;

/// Bound on how far from a triangle's plane Embree may see it, for a ray that starts on the plane: the rounding of
/// the dot product of the normal with the edge from a corner to the origin. It grows with the size of the triangle,
/// and with how thin it is, because then the normal itself is a difference of large numbers. Term by term it vanishes
/// along the axes in which the triangle does not extend: floors that lie level have next to none, however large.
inline float intersection_error(const DVec3& a, const DVec3& b, const DVec3& c, double twice_area) {
    const DVec3 e1 = b - a, e2 = c - a, e3 = c - b;
    const double edge1 = glm::length(e1), edge2 = glm::length(e2);
    const double longest = std::max(edge1, std::max(edge2, glm::length(e3)));
    const double thinness = std::min(edge1 * edge2 / twice_area, 16.0);
    // The products whose differences are the normal, and the largest factors that they meet.
    const DVec3 p = glm::abs(e1), q = glm::abs(e2), extent = glm::max(glm::max(p, q), glm::abs(e3));
    const DVec3 products(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
    const double by_terms = 2 * glm::dot(products, extent) / twice_area;
    // Not 0, as Embree's watertight test also finds what is at the very beginning of a ray.
    return static_cast<float>(double(gamma_bound(4)) *
                              std::max(std::min(longest * thinness, by_terms), 1e-6 * longest));
}

/// The length of a triangle over its height. Beyond `needle_slenderness` Embree's fast test is too inexact to bound: of
/// the rays that leave such triangles, one in 1000 at 1:100 and one in 20 at 1:1000 was seen to hit them again, and one
/// in 10^5 with its watertight test. A mesh that owes more than a hundredth of its area to them makes the scene use
/// that test.
inline double slenderness(const DVec3& a, const DVec3& b, const DVec3& c, double twice_area) {
    const DVec3 ab = b - a, bc = c - b, ca = a - c;
    return std::max(glm::dot(ab, ab), std::max(glm::dot(bc, bc), glm::dot(ca, ca))) / twice_area;
}
inline constexpr double needle_slenderness = 100;

/// Bound on how far from the plane a point lies that is interpolated between the corners (pbrt-v4, section 6.8.4).
inline float position_error(const DVec3& a, const DVec3& b, const DVec3& c, const Vec3& normal) {
    const DVec3 largest = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    return static_cast<float>(double(gamma_bound(8)) * glm::dot(glm::abs(DVec3(normal)), largest));
}

/// The same for a sphere: rounding of the centre, of the projected point, and of Embree's discriminant.
inline float sphere_offset(const DVec3& center, double radius) {
    const DVec3 c = glm::abs(center);
    return static_cast<float>(double(gamma_bound(8)) * (std::max(c.x, std::max(c.y, c.z)) + radius));
}

}  // namespace lightswitch::detail
