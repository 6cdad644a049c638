#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/microfacets.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Rough metal, front side only.
///
/// Single scattering with separable Smith masking, G = G1(wo) G1(wi), as Mitsuba's `roughconductor`: light that would
/// leave after several bounces between facets is lost, so rough metals are somewhat too dark.
struct RoughConductor {
    static constexpr std::string_view name = "rough conductor";
    static constexpr bool specular = false;

    Facets distribution = Facets::beckmann;
    float alpha_u = 0.1f;  ///< roughness along dp/du, above 0 and at most 1; below 1e-4 it acts as 1e-4
    float alpha_v = 0.1f;  ///< roughness across
    Rgb eta{0};            ///< real part of the index of refraction
    Rgb k{1};              ///< imaginary part
    Rgb reflectance{1};    ///< factor on the Fresnel reflectance, 0 to 1

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        const Vec3 half = wo + wi;
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {};  // both at the horizon, closer than floats can tell
        const Microfacets facets(distribution, alpha_u, alpha_v);
        const float density = facets.distribution(half) / facets.smith_denominator(wo);
        const float cos_half = std::min(0.5f * std::sqrt(squared), 1.0f);
        return {reflectance * fresnel_conductor(cos_half, eta, k) * (density / facets.smith_denominator(wi)),
                {0.5f * density}};
    }

    /// Reflects at a visible normal. D and G1(wo) cancel: the weight is Fresnel's reflectance times G1(wi).
    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport) const {
        if (!(wo.z > 0)) return {};
        const Microfacets facets(distribution, alpha_u, alpha_v);
        const Vec3 m = facets.sample_visible_normal(wo, Vec2(u));
        const float cosine = dot(wo, m);
        const float projection = cosine / length_squared(m);
        const Vec3 wi = 2 * projection * m - wo;
        if (!(cosine > 0 && wi.z > 0)) return {};
        const float cos_half = std::min(std::sqrt(cosine * projection), 1.0f);
        const float masking = 2 * wi.z / facets.smith_denominator(wi);
        return BsdfSample{.wi = wi,
                          .weight = reflectance * fresnel_conductor(cos_half, eta, k) * masking,
                          .pdf = {0.5f * facets.distribution(m) / facets.smith_denominator(wo)}};
    }

    bool isotropic() const { return alpha_u == alpha_v; }
    std::string problem() const;

    /// No diffuse term.
    PhongTerms phong() const {
        return {.diffuse = Rgb(0),
                .specular = reflectance * fresnel_conductor(1, eta, k),
                .shininess = phong_shininess(alpha_u, alpha_v)};
    }
};

template <>
inline constexpr auto parameters_of<RoughConductor> = std::tuple_cat(
    stretched_roughness<RoughConductor>, std::tuple{Parameter{"eta", &RoughConductor::eta, as_metal_index},
                                                    Parameter{"k", &RoughConductor::k, as_metal_index},
                                                    Parameter{"specular_reflectance", &RoughConductor::reflectance}});

inline std::string RoughConductor::problem() const {
    const std::string text = parameter_problem(*this);
    return text.empty() ? conductor_problem(eta, k) : text;
}

}  // namespace lightswitch
