#pragma once

// Maps from the unit square to the domains that rendering samples. All are continuous and spread their density evenly,
// so that stratified numbers stay stratified. None calls the maths library for more than a square root: results are the
// same bits wherever floats follow IEEE 754 and the compiler does not fuse products into sums (-ffp-contract=off), and
// the maps are cheap enough for the innermost loops.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/pdf.hpp>

namespace lightswitch {

namespace detail {

struct CosSin {
    float cos, sin;
};

/// Cosine and sine of pi/4 * `x` for |x| <= 1, each within 2 units in the last place: polynomials of least relative
/// error (Remez) whose coefficients were rounded to float one after the other.
inline CosSin cos_sin_quarter_pi(float x) {
    const float y = x * x;
    return {((-0x1.4e78bep-12f * y + 0x1.03b058p-6f) * y - 0x1.3bd39cp-2f) * y + 1,
            x * (((-0x1.33199p-15f * y + 0x1.4680a4p-9f) * y - 0x1.4abc24p-4f) * y + 0x1.921fb6p-1f)};
}

/// A point of the unit disk together with the square of 1 - radius^2, which is known more exactly than from the point.
struct DiskPoint {
    Vec2 point;
    float one_minus_radius_squared;
};

/// The work of `concentric_disk`. In each quarter of the square the larger coordinate is the radius and the ratio of
/// the two is the angle from the nearest axis; min, max and a mask take the place of the four cases.
[[gnu::always_inline]] inline DiskPoint concentric(const Vec2& u) {
    const float a = 2 * u.x - 1, b = 2 * u.y - 1;
    const float abs_a = std::abs(a), abs_b = std::abs(b);
    const float radius = std::max(abs_a, abs_b);
    // The centre has no angle: any positive divisor serves.
    const auto [c, s] =
        cos_sin_quarter_pi(std::min(abs_a, abs_b) / std::max(radius, std::numeric_limits<float>::min()));
    const std::uint32_t near_x = 0u - static_cast<std::uint32_t>(abs_a > abs_b);
    const std::uint32_t c_bits = std::bit_cast<std::uint32_t>(c), s_bits = std::bit_cast<std::uint32_t>(s);
    const std::uint32_t swap = (c_bits ^ s_bits) & ~near_x;
    const float x = std::bit_cast<float>(c_bits ^ swap), y = std::bit_cast<float>(s_bits ^ swap);
    return {{std::copysign(radius * x, a), std::copysign(radius * y, b)}, (1 - radius) * (1 + radius)};
}

}  // namespace detail

/// Uniform on the unit disk for uniform `u` in [0,1)^2 (Shirley and Chiu, "A Low Distortion Map Between Disk and
/// Square", JGT 1997). Density 1/pi.
inline Vec2 concentric_disk(const Vec2& u) { return detail::concentric(u).point; }

/// Uniform on the disk of that radius.
inline Vec2 uniform_disk(const Vec2& u, float radius = 1) { return radius * concentric_disk(u); }
inline AreaPdf uniform_disk_pdf(float radius = 1) { return {inv_pi / (radius * radius)}; }

/// Unit vector around +z with density cos/pi (Malley's method: the concentric disk lifted onto the hemisphere). z is
/// always above 0.
[[gnu::always_inline]] inline Vec3 cosine_hemisphere(const Vec2& u) {
    const auto [p, height_squared] = detail::concentric(u);
    // On the rim, which 24-bit numbers reach, z takes the smallest value that a neighbour off the rim has.
    return {p.x, p.y, std::sqrt(std::max(height_squared, 0x1p-23f))};
}
/// Density of `cosine_hemisphere`; 0 below the horizon.
inline SolidAnglePdf cosine_hemisphere_pdf(float cos_theta) { return {std::max(cos_theta, 0.0f) * inv_pi}; }

/// Uniform unit vector: the concentric disk wrapped around the sphere (Lambert's azimuthal equal-area projection).
[[gnu::always_inline]] inline Vec3 uniform_sphere(const Vec2& u) {
    const auto [p, height_squared] = detail::concentric(u);
    const float scale = 2 * safe_sqrt(height_squared);
    return {p.x * scale, p.y * scale, 2 * height_squared - 1};
}
inline SolidAnglePdf uniform_sphere_pdf() { return {0.25f * inv_pi}; }

/// Uniform unit vector in the cone around +z of half angle theta_max, given as 1 - cos(theta_max) in (0, 2], which
/// keeps its digits however narrow the cone is.
[[gnu::always_inline]] inline Vec3 uniform_cone(const Vec2& u, float one_minus_cos_theta_max) {
    const auto [p, height_squared] = detail::concentric(u);
    const float one_minus_z = one_minus_cos_theta_max * (1 - height_squared);
    const float scale = safe_sqrt(one_minus_cos_theta_max * (2 - one_minus_z));
    return {p.x * scale, p.y * scale, 1 - one_minus_z};
}
/// Density of `uniform_cone` inside the cone.
inline SolidAnglePdf uniform_cone_pdf(float one_minus_cos_theta_max) {
    return {0.5f * inv_pi / one_minus_cos_theta_max};
}

/// Uniform point of a triangle: the first two barycentric coordinates, each at least 0, with sum at most 1. Each half
/// of the square is sheared onto half of the triangle (Heitz, "A Low-Distortion Map Between Triangle and Square",
/// 2019).
[[gnu::always_inline]] inline Vec2 uniform_triangle(const Vec2& u) { return u - 0.5f * std::min(u.x, u.y); }

}  // namespace lightswitch
