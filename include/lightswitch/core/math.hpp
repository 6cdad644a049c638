#pragma once

// Vectors, matrices, colours and directions. The only file that includes GLM.

#include <lightswitch/core/floating_point.hpp>

// Unless its functions are inlined, GLM passes every vector through memory.
#ifndef GLM_FORCE_INLINE
#define GLM_FORCE_INLINE
#endif
#include <glm/glm.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lightswitch {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
/// Linear RGB: radiance, reflectance or throughput, with the primaries of ITU-R BT.709.
using Rgb = glm::vec3;
using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;
using Mat3 = glm::mat3;
using DMat3 = glm::dmat3;
using DMat4 = glm::dmat4;

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inv_pi = 0.31830988618379067154f;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
/// Half the distance from 1 to the next float: the relative error of one rounded operation.
inline constexpr float unit_roundoff = 0x1p-24f;

/// Bound on the relative error of `n` rounded operations in a row (Higham 2002, section 3.1).
constexpr float gamma_bound(int n) {
    const float e = static_cast<float>(n) * unit_roundoff;
    return e / (1 - e);
}

[[gnu::always_inline]] inline float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[gnu::always_inline]] inline float length_squared(const Vec3& v) { return dot(v, v); }
[[gnu::always_inline]] inline Vec3 normalize(const Vec3& v) { return v * (1.0f / std::sqrt(length_squared(v))); }
[[gnu::always_inline]] inline float max_component(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline float min_component(const Vec3& v) { return std::min(v.x, std::min(v.y, v.z)); }
inline float square(float x) { return x * x; }
inline float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.0f)); }
[[gnu::always_inline]] inline bool is_black(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

/// Luminance of linear RGB (BT.709 weights).
template <class T>
constexpr T luminance(const glm::vec<3, T>& c) {
    return T(0.2126) * c.x + T(0.7152) * c.y + T(0.0722) * c.z;
}

/// True when `x` is neither infinite nor NaN. Reads the bits, which no option of the compiler changes.
inline bool is_finite(float x) { return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u; }
inline bool is_finite(double x) {
    constexpr std::uint64_t exponent = 0x7ff0000000000000u;
    return (std::bit_cast<std::uint64_t>(x) & exponent) != exponent;
}
template <class T>
bool is_finite(const glm::vec<3, T>& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

/// An orthonormal basis whose `normal` is the local z axis.
///
/// Built without branches or square roots (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
struct Basis {
    Vec3 tangent, bitangent, normal;

    [[gnu::always_inline]] explicit Basis(const Vec3& unit_normal) : normal(unit_normal) {
        const float sign = std::copysign(1.0f, normal.z);
        const float a = -1.0f / (sign + normal.z);
        const float b = normal.x * normal.y * a;
        tangent = Vec3(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
        bitangent = Vec3(b, sign + normal.y * normal.y * a, -normal.y);
    }

    /// Whose tangent is `along`, as far as it lies across the normal; any tangent where `along` has no such part.
    Basis(const Vec3& unit_normal, const Vec3& along) : Basis(unit_normal) {
        const Vec3 across = along - dot(along, normal) * normal;
        const float squared = length_squared(across);
        if (!(squared > 1e-10f * length_squared(along) && squared > 0)) return;
        tangent = across * (1 / std::sqrt(squared));
        bitangent = cross(normal, tangent);
    }

    [[gnu::always_inline]] Vec3 to_local(const Vec3& v) const {
        return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
    }
    [[gnu::always_inline]] Vec3 to_world(const Vec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
};

/// The size of the largest entry; infinite when one is not a number.
inline double largest_entry(const DMat3& m) {
    double largest = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            largest =
                std::isnan(m[c][r]) ? std::numeric_limits<double>::infinity() : std::max(largest, std::abs(m[c][r]));
    return largest;
}

/// Whether the columns are unit vectors at right angles, to that tolerance of their products: a rotation, perhaps
/// mirrored.
inline bool is_orthonormal(const DMat3& m, double tolerance) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            if (!(std::abs(glm::dot(m[i], m[j]) - (i == j ? 1 : 0)) < tolerance)) return false;
    return true;
}

}  // namespace lightswitch
