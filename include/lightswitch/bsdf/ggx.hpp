#pragma once

// The isotropic GGX distribution of microfacet normals, in forms that do not divide by the cosines that vanish.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/warp.hpp>

namespace lightswitch {

/// Microfacet normals after Trowbridge and Reitz with the masking of Smith (Walter et al., "Microfacet Models for
/// Refraction through Rough Surfaces", 2007; there called GGX). Directions are unit, local, with z > 0.
class Ggx {
public:
    /// `alpha` in (0, 1]; values below 1e-4 act as 1e-4, under which floats cannot resolve the lobe.
    explicit Ggx(float alpha) : alpha_(std::max(alpha, 1e-4f)), alpha_squared_(alpha_ * alpha_) {}

    /// Density D of normals per solid angle and unit of macroscopic area. `m` may have any length but 0.
    float distribution(const Vec3& m) const {
        const float spread = (m.x * m.x + m.y * m.y + alpha_squared_ * m.z * m.z) / length_squared(m);
        return alpha_squared_ * inv_pi / (spread * spread);
    }

    /// z + sqrt(z^2 + alpha^2 (1 - z^2)) for the cosine z of a direction: Smith's masking is G1 = 2 z /
    /// smith_denominator(z).
    float smith_denominator(float z) const { return z + std::sqrt(alpha_squared_ + (1 - alpha_squared_) * z * z); }

    /// A normal, not of unit length, with density D G1 dot(wo, m) / wo.z: those that are visible from `wo` (Heitz, JCGT
    /// 2018, by way of Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023).
    ///
    /// On the hemisphere of alpha 1 the visible normals are halfway between `wo` and a uniform direction of a spherical
    /// cap. The cap is reached through the concentric disk, and its height above the lower rim is a product, so the
    /// normal's z keeps its digits and stays above 0.
    Vec3 sample_visible_normal(const Vec3& wo, const Vec2& u) const {
        const Vec3 w = normalize(Vec3(alpha_ * wo.x, alpha_ * wo.y, wo.z));
        const auto [p, rim_distance] = detail::concentric(u);
        const float cap_height = 1 + w.z;
        const float scale = safe_sqrt(cap_height * (2 - cap_height * (1 - rim_distance)));
        return {alpha_ * (w.x + p.x * scale), alpha_ * (w.y + p.y * scale),
                cap_height * std::max(rim_distance, 0x1p-24f)};
    }

private:
    float alpha_, alpha_squared_;
};

}  // namespace lightswitch
