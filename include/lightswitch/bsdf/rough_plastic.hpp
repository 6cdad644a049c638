#pragma once

#include <lightswitch/bsdf/lobe_sample.hpp>
#include <lightswitch/bsdf/rough_coat.hpp>

namespace lightswitch {

/// Rough plastic, front side only: a diffuse base under a clear coat with microfacets. Mitsuba's `roughplastic`.
///
/// The coat reflects as a `RoughConductor` does, with Fresnel's equations for a dielectric. What enters meets the base
/// and the inside of the coat in turn until it gets out: see `Plastic`, whose smooth coat is here a `RoughCoat`.
struct RoughPlastic {
    static constexpr std::string_view name = "rough plastic";
    static constexpr bool specular = false;

    Facets distribution = Facets::beckmann;
    float alpha = 0.1f;             ///< roughness of the coat, above 0 and at most 1; below 1e-4 it acts as 1e-4
    float eta = 1.49f / 1.000277f;  ///< index of refraction of the coat over that outside: polypropylene in air
    Rgb diffuse_reflectance{0.5f};  ///< of the base, 0 to 1
    Rgb specular_reflectance{1};    ///< factor on light that the coat reflects, 0 to 1
    bool nonlinear = false;         ///< whether colours shift by internal scattering

    /// Follows from the distribution, `alpha` and `eta` and is not to be given; whoever changes these later must set it
    /// again.
    const RoughCoat* coat = &rough_coat(distribution, alpha, eta);

    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        const float entering = coat->transmittance(wo.z);
        const float coat_probability = probability_of_coat(entering);
        const Rgb again = (nonlinear ? diffuse_reflectance : Rgb(1)) * coat->inside_reflectance();
        const Rgb base =
            diffuse_reflectance * (inv_pi * entering * coat->transmittance(wi.z)) / (eta * eta * (Rgb(1) - again));
        const SolidAnglePdf base_pdf = cosine_hemisphere_pdf(wi.z) * (1 - coat_probability);

        const Vec3 half = wo + wi;
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {base, base_pdf};  // both at the horizon, closer than floats can tell
        const Microfacets facets(distribution, alpha, alpha);
        const float density = facets.distribution(half) / facets.smith_denominator(wo);
        const float cos_half = std::min(0.5f * std::sqrt(squared), 1.0f);
        const float reflected = fresnel_dielectric(cos_half, eta).reflectance * density / facets.smith_denominator(wi);
        return {base + specular_reflectance * reflected, {base_pdf.value + 0.5f * density * coat_probability}};
    }

    /// Chooses the coat or the base by `u.z`, as Mitsuba does: what the coat keeps out counts as reflected.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (!(wo.z > 0)) return {};
        if (!(u.z < probability_of_coat(coat->transmittance(wo.z))))
            return detail::sample_of_all_lobes(*this, wo, cosine_hemisphere(Vec2(u)), transport);
        const Vec3 m = Microfacets(distribution, alpha, alpha).sample_visible_normal(wo, Vec2(u));
        return detail::sample_of_all_lobes(*this, wo, 2 * dot(wo, m) / length_squared(m) * m - wo, transport);
    }

    std::string problem() const;

    /// Of the base, whose colour one sees.
    Rgb albedo() const { return diffuse_reflectance; }

    /// The base, and a highlight stronger than the few percent that the coat reflects.
    PhongTerms phong() const {
        return {.diffuse = diffuse_reflectance,
                .specular = 0.5f * specular_reflectance,
                .shininess = phong_shininess(alpha, alpha)};
    }

private:
    float probability_of_coat(float entering) const {
        return detail::lobe_probability((1 - entering) * specular_reflectance, entering * diffuse_reflectance);
    }
};

template <>
inline constexpr auto parameters_of<RoughPlastic> =
    std::tuple{Parameter{"alpha", &RoughPlastic::alpha, as_roughness, false},
               Parameter{"eta", &RoughPlastic::eta, as_relative_index, false},
               Parameter{"diffuse_reflectance", &RoughPlastic::diffuse_reflectance},
               Parameter{"specular_reflectance", &RoughPlastic::specular_reflectance}};

inline std::string RoughPlastic::problem() const {
    const std::string text = parameter_problem(*this);
    if (!text.empty() || coat == &rough_coat(distribution, alpha, eta)) return text;
    return "coat is not that of distribution, alpha and eta, which were changed after the model was made";
}

}  // namespace lightswitch
