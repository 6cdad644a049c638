#pragma once

// What the models of Disney, `Principled` and `PrincipledThin`, share: Burley, "Physically Based Shading at Disney"
// (SIGGRAPH 2012 course notes, section 5 and appendix B), and "Extending the Disney BRDF to a BSDF with Integrated
// Subsurface Scattering" (2015 course notes). Where the notes leave a choice, it is that of Mitsuba 3.9.1.

#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/microfacets.hpp>
#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// The facets of a `rough`ness: alpha is its square, larger along x and smaller along y by up to sqrt(10)
/// as `anisotropic` goes from 0 to 1 (Burley 2012, section 5.4), and not below 0.001.
inline Microfacets principled_microfacets(float rough, float anisotropic) {
    const float alpha = rough * rough;
    const float aspect = std::sqrt(1 - 0.9f * anisotropic);
    return Microfacets(Facets::ggx, std::max(alpha / aspect, 0.001f), std::max(alpha * aspect, 0.001f));
}

/// The fifth power of 1 - `cosine`, of which Schlick's approximation of Fresnel's reflectance is made.
[[gnu::always_inline]] inline float schlick_weight(float cosine) {
    const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
    return square(square(m)) * m;
}

/// The weight for a boundary that was met from the front: of the angle in the thinner medium, which is the refracted
/// one when the medium behind is the thinner one.
inline float schlick_weight(const FresnelDielectric& fresnel, float cosine) {
    return schlick_weight(fresnel.eta > 1 ? cosine : std::abs(fresnel.cos_t));
}

/// Schlick's reflectance, from `normal` at normal incidence to 1.
inline Rgb schlick(const Rgb& normal, float weight) { return normal + (Rgb(1) - normal) * weight; }

/// The hue and saturation of a colour: brought to luminance 1; white for black. In a saturated blue, the fourth digit
/// of the luminance's weights shows, hence Mitsuba's own.
inline Rgb tint_of(const Rgb& color) {
    const float y = dot(color, Rgb(0.212671f, 0.71516f, 0.072169f));
    return y > 0 ? color / y : Rgb(1);
}

/// Disney's diffuse reflection over Lambert's: darker at grazing angles when smooth, brighter towards the light when
/// rough (Burley 2012, section 5.3), and mixed by `flatness` with an imitation of subsurface scattering after Hanrahan
/// and Krueger (Burley 2015). Cosines are above 0, and so is their product;
/// `cos_half` is that of `wo` and the half vector.
inline float principled_diffuse(float cos_o, float cos_i, float cos_half, float rough, float flatness) {
    const float o = schlick_weight(cos_o), i = schlick_weight(cos_i);
    const float retro = 2 * rough * cos_half * cos_half;
    const float diffuse = (1 - 0.5f * o) * (1 - 0.5f * i) + retro * (o + i + o * i * (retro - 1));
    if (flatness == 0) return diffuse;
    const float grazing = 0.5f * retro - 1;
    const float shape = (1 + grazing * o) * (1 + grazing * i);
    const float flat = 1.25f * (shape * (1 / (cos_o + cos_i) - 0.5f) + 0.5f);
    return diffuse + flatness * (flat - diffuse);
}

/// The colour of sheen: white, or the tint of the base colour.
inline Rgb sheen_color(const Rgb& base_color, float sheen, float sheen_tint) {
    if (sheen_tint == 0) return Rgb(sheen);
    return sheen * (Rgb(1) + sheen_tint * (tint_of(base_color) - Rgb(1)));
}

/// The layer of clear coat: normals with the long tails of GTR1 (Burley 2012, appendix B.2) for an alpha from 0.1,
/// dull, to 0.001, glossy.
class Gtr1 {
public:
    explicit Gtr1(float gloss) : alpha_squared_(square(0.1f + gloss * (0.001f - 0.1f))) {}

    /// Density D of normals per solid angle and unit of macroscopic area. `m` may have any length but 0.
    float distribution(const Vec3& m) const {
        const float spread = (m.x * m.x + m.y * m.y + alpha_squared_ * m.z * m.z) / length_squared(m);
        return (alpha_squared_ - 1) * inv_pi / (std::log(alpha_squared_) * spread);
    }

    /// A unit normal with density D cos. Its sine comes without a difference that would cancel.
    Vec3 sample(const Vec2& u) const {
        const float sine_squared =
            std::min(alpha_squared_ * std::expm1(-u.y * std::log(alpha_squared_)) / (1 - alpha_squared_), 1.0f);
        const float sine = std::sqrt(sine_squared), phi = 2 * pi * u.x;
        // Uniform numbers never reach 1, but the rounded square may.
        return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(std::max(1 - sine_squared, 0x1p-24f))};
    }

private:
    float alpha_squared_;
};

/// `wo` reflected at `m`, of any length but 0.
inline Vec3 reflected(const Vec3& wo, const Vec3& m) { return 2 * (dot(wo, m) / length_squared(m)) * m - wo; }

}  // namespace lightswitch
