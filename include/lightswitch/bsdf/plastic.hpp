#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/parameter.hpp>
#include <lightswitch/core/warp.hpp>

namespace lightswitch {

/// Smooth plastic, front side only: a diffuse base under a clear coat that reflects like a `Dielectric`. Mitsuba's
/// `plastic`.
///
/// What enters the coat meets the base and the inside of the coat in turn until it gets out again. With R the
/// reflectance of the base, T that of the coat to diffuse light from outside and T / eta^2 from inside, the geometric
/// series sums up to
///
///     (1 - F(wo)) (1 - F(wi)) R / (pi (eta^2 (1 - R) + R T))
///
/// in which nothing cancels. By default R counts as 1 in the denominator, so that colours keep their hues: `nonlinear`
/// is the exact sum. T is exact (`diffuse_transmittance`); Mitsuba's fit of it is off by 0.1 % for an index below 2.
struct Plastic {
    static constexpr std::string_view name = "plastic";
    static constexpr bool specular = false;
    static constexpr bool partly_specular = true;

    float eta = 1.49f / 1.000277f;  ///< index of refraction of the coat over that outside: polypropylene in air
    Rgb diffuse_reflectance{0.5f};  ///< of the base, 0 to 1
    Rgb specular_reflectance{1};    ///< factor on light that the coat reflects, 0 to 1
    bool nonlinear = false;         ///< whether colours shift by internal scattering

    /// Follows from `eta` and is not to be given; whoever changes `eta` later must set it again.
    float coat_transmittance = diffuse_transmittance(eta);

    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        const Lobes lobes = lobes_of(wo);
        return {lobes.base * (transmittance_ratio(wi) * inv_pi), cosine_hemisphere_pdf(wi.z) * lobes.base_probability};
    }

    /// Takes the coat or, by `u.z`, the base with the probability of its part of the albedo.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport) const {
        if (!(wo.z > 0)) return {};
        const Lobes lobes = lobes_of(wo);
        if (u.z < lobes.coat_probability)
            return BsdfSample{.wi = {-wo.x, -wo.y, wo.z},
                              .weight = specular_reflectance * (lobes.reflected / lobes.coat_probability),
                              .specular = true};
        if (!(lobes.base_probability > 0)) return {};
        const Vec3 wi = cosine_hemisphere(Vec2(u));
        return BsdfSample{.wi = wi,
                          .weight = lobes.base * (transmittance_ratio(wi) / lobes.base_probability),
                          .pdf = cosine_hemisphere_pdf(wi.z) * lobes.base_probability};
    }

    std::string problem() const;

    /// Of the base, whose colour one sees.
    Rgb albedo() const { return diffuse_reflectance; }

    /// The base, and a highlight stronger than the few percent that the coat reflects.
    PhongTerms phong() const {
        return {.diffuse = diffuse_reflectance, .specular = 0.5f * specular_reflectance, .shininess = 500};
    }

private:
    struct Lobes {
        float reflected;  // by the coat, a fraction
        Rgb base;         // albedo of the smooth lobe
        float coat_probability, base_probability;
    };

    Lobes lobes_of(const Vec3& wo) const {
        const float reflected = fresnel_dielectric(wo.z, eta).reflectance;
        const Rgb again = nonlinear ? diffuse_reflectance : Rgb(1);
        const Rgb base = fresnel_dielectric_transmittance(wo.z, eta) * coat_transmittance * diffuse_reflectance /
                         (eta * eta * (Rgb(1) - again) + again * coat_transmittance);
        const float coat_sum = reflected * (specular_reflectance.x + specular_reflectance.y + specular_reflectance.z);
        const float base_sum = base.x + base.y + base.z, both = coat_sum + base_sum;
        if (!(both > 0)) return {reflected, base, 0, 0};
        // Each by itself: their sum is 1 anyway, and the smaller one keeps its digits.
        return {reflected, base, coat_sum / both, base_sum / both};
    }

    /// How much more light enters or leaves the coat there than on average.
    float transmittance_ratio(const Vec3& wi) const {
        return fresnel_dielectric_transmittance(wi.z, eta) / coat_transmittance;
    }
};

template <>
inline constexpr auto parameters_of<Plastic> =
    std::tuple{Parameter{"eta", &Plastic::eta, as_relative_index, false},
               Parameter{"diffuse_reflectance", &Plastic::diffuse_reflectance},
               Parameter{"specular_reflectance", &Plastic::specular_reflectance}};

inline std::string Plastic::problem() const {
    const std::string text = parameter_problem(*this);
    if (!text.empty() || coat_transmittance == diffuse_transmittance(eta)) return text;
    return "coat_transmittance is not that of eta, which was changed after the model was made";
}

}  // namespace lightswitch
