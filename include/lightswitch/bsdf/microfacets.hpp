#pragma once

// Rough surfaces as heights of tiny facets: how their normals are distributed, which of them a direction sees, and how
// much of them hides behind others. In forms that do not divide by the cosines that vanish.

#include <lightswitch/core/error_function.hpp>
#include <lightswitch/core/warp.hpp>

namespace lightswitch {

/// How the slopes of facets are distributed: Beckmann's are Gaussian; those of GGX (Trowbridge and Reitz) have long
/// tails.
enum class Facets { beckmann, ggx };

/// Microfacet normals with the masking of Smith (Walter et al., "Microfacet Models for Refraction through Rough
/// Surfaces", 2007), stretched along x and y (Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014).
/// Directions are local and unit; of those from which facets are seen, z > 0.
///
/// All is exact but for rounding, so that sampling, density and value belong together: Beckmann's masking contains
/// the error function itself. Mitsuba 3 has a rational fit in its place, which is off by up to 0.35 %.
class Microfacets {
public:
    /// Roughness along x and y in (0, 1]; values below 1e-4 act as 1e-4, under which floats cannot resolve the lobe.
    Microfacets(Facets facets, float alpha_x, float alpha_y)
        : facets_(facets),
          alpha_x_(std::max(alpha_x, 1e-4f)),
          alpha_y_(std::max(alpha_y, 1e-4f)),
          alpha_product_(alpha_x_ * alpha_y_) {}

    /// Density D of normals per solid angle and unit of macroscopic area. `m` may have any length but 0.
    float distribution(const Vec3& m) const {
        float slopes = m.x * m.x + m.y * m.y;
        if (alpha_x_ != alpha_y_) slopes = m.x * m.x * (alpha_y_ / alpha_x_) + m.y * m.y * (alpha_x_ / alpha_y_);
        if (facets_ == Facets::ggx) {
            const float spread = (slopes + alpha_product_ * m.z * m.z) / length_squared(m);
            return alpha_product_ * inv_pi / (spread * spread);
        }
        // From 88 on the exponential is below all floats, whatever the cosine to the fourth power does.
        const float scaled = alpha_product_ * m.z * m.z;
        if (!(slopes < 88 * scaled)) return 0;
        const float inverse_cos_squared = length_squared(m) / (m.z * m.z);
        return std::exp(-slopes / scaled) * square(inverse_cos_squared) * inv_pi / alpha_product_;
    }

    /// 2 v.z / G1 for Smith's masking G1(v), the visible fraction of the facets that face `v`. It is v.z and something
    /// that is not negative, and above 0.
    float smith_denominator(const Vec3& v) const {
        if (facets_ == Facets::ggx) {
            // z^2 + (alpha_x x)^2 + (alpha_y y)^2 as a sum of what the smaller roughness does in all directions, and
            // what the larger one adds in its own.
            const float smaller = std::min(alpha_x_, alpha_y_), smaller_squared = smaller * smaller;
            float squared = smaller_squared + (1 - smaller_squared) * v.z * v.z;
            if (alpha_x_ != alpha_y_)
                squared +=
                    std::abs(alpha_x_ - alpha_y_) * (alpha_x_ + alpha_y_) * square(alpha_x_ > alpha_y_ ? v.x : v.y);
            return v.z + std::sqrt(squared);
        }
        const float reach = std::sqrt(square(alpha_x_ * v.x) + square(alpha_y_ * v.y));
        return beckmann_denominator(v.z, reach);
    }

    /// Smith's masking G1(v), 0 to 1.
    float masking(const Vec3& v) const { return 2 * v.z / smith_denominator(v); }

    /// A normal, not of unit length, with density D G1 dot(wo, m) / wo.z: those that are visible from `wo`.
    Vec3 sample_visible_normal(const Vec3& wo, const Vec2& u) const {
        // Where roughness is stretched to 1, facets look the same from the stretched direction.
        const Vec3 w = normalize(Vec3(alpha_x_ * wo.x, alpha_y_ * wo.y, wo.z));
        const Vec3 m = facets_ == Facets::ggx ? ggx_visible_normal(w, u) : beckmann_visible_normal(w, u);
        return {alpha_x_ * m.x, alpha_y_ * m.y, m.z};
    }

    /// Density per solid angle with which `sample_visible_normal` chooses the direction of `m`, here of unit length.
    float visible_pdf(const Vec3& wo, const Vec3& m) const {
        return 2 * distribution(m) * std::max(dot(wo, m), 0.0f) / smith_denominator(wo);
    }

private:
    /// `smith_denominator` for a height z and the length of the rest, each in units of its roughness.
    static float beckmann_denominator(float z, float reach) {
        constexpr float inv_sqrt_pi = 0.56418958354775628695f;
        const float a = z / reach;  // infinite along the normal
        return z * (1 + std::erf(a)) + reach * inv_sqrt_pi * std::exp(-a * a);
    }

    /// For roughness 1: visible normals are halfway between `w` and a uniform direction of a spherical cap (Heitz, JCGT
    /// 2018, by way of Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023).
    ///
    /// The cap is reached through the concentric disk, and its height above the lower rim is a product, so the normal's
    /// z keeps its digits and stays above 0.
    static Vec3 ggx_visible_normal(const Vec3& w, const Vec2& u) {
        const auto [p, rim_distance] = detail::concentric(u);
        const float cap_height = 1 + w.z;
        const float scale = safe_sqrt(cap_height * (2 - cap_height * (1 - rim_distance)));
        return {w.x + p.x * scale, w.y + p.y * scale, cap_height * std::max(rim_distance, 0x1p-24f)};
    }

    /// For roughness 1: the slopes of facets are Gaussian across the plane of `w`; along it, a slope x has the density
    /// (c - x s) exp(-x^2) up to c / s, for the cosine c and sine s of `w` (Heitz and d'Eon, "Importance Sampling
    /// Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014).
    ///
    /// Its integral is inverted by Newton's method in t = erfc(-x), as Jakob's "An Improved Visible Normal Sampling
    /// Routine for the Beckmann Distribution" (2014) does in erf(x): the integral is c t + s exp(-x^2) / sqrt(pi) over
    /// its value at c / s, the denominator of Smith's masking. It is concave in t, so from the left of the root every
    /// step ends between where it began and the root. At grazing angles, where x = -sqrt(-log u), the start is the
    /// root; elsewhere it is to the left of it.
    static Vec3 beckmann_visible_normal(const Vec3& w, const Vec2& u) {
        constexpr float inv_sqrt_pi = 0.56418958354775628695f;
        constexpr float least = 0x1p-25f;  // half a step of the numbers that samplers give
        const float s = std::sqrt(w.x * w.x + w.y * w.y), c = w.z;
        const float target = std::max(u.x, least) * beckmann_denominator(c, s);
        float x = -std::sqrt(-std::log(std::max(u.x, least)));
        float t = std::erfc(-x);
        // Two to four steps reach the limit of floats; rarely, where the density ends, rounding goes on from there.
        for (int step = 0; step < 8; ++step) {
            const float excess = c * t + s * inv_sqrt_pi * std::exp(-x * x) - target;
            if (!(excess < -unit_roundoff * target && s * x < c)) break;
            t = std::min(t - excess / (c - s * x), 2 - 0x1p-23f);
            x = -inverse_erfc(t);
        }
        const float y = inverse_erfc(2 * std::max(u.y, least));
        const Vec2 along = s > 0 ? Vec2(w.x, w.y) / s : Vec2(1, 0);
        // A normal of the slopes x and y leans away from them.
        return {y * along.y - x * along.x, -y * along.x - x * along.y, 1};
    }

    Facets facets_;
    float alpha_x_, alpha_y_, alpha_product_;
};

/// The exponent of Blinn's highlight for the same roughness, 2 / alpha^2 - 2, kept within 1 to 1000.
inline float phong_shininess(float alpha_u, float alpha_v) {
    return std::clamp(2 / (alpha_u * alpha_v) - 2, 1.0f, 1000.0f);
}

}  // namespace lightswitch
