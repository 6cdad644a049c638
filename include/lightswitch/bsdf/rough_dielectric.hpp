#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/microfacets.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Rough boundary between two transparent media, such as ground glass: every microfacet is a `Dielectric` (Walter et
/// al., "Microfacet Models for Refraction through Rough Surfaces", 2007), as Mitsuba's `roughdielectric`.
///
/// Single scattering with separable masking, G = G1(wo) G1(wi): light that would leave after several bounces between
/// facets is lost. That holds for `eta` 1, too, where facets do nothing but mask: light goes straight on, less what is
/// masked, as for `eta` beside 1. Between, where |eta - 1| times the roughness is below 1e-6, samples are right, but
/// directions are too coarse for `evaluate` to say where in the lobe of refraction they are.
struct RoughDielectric {
    static constexpr std::string_view name = "rough dielectric";
    static constexpr bool specular = false;
    static constexpr bool transmits = true;

    Facets distribution = Facets::beckmann;
    float alpha_u = 0.1f;  ///< roughness along dp/du, above 0 and at most 1; below 1e-4 it acts as 1e-4
    float alpha_v = 0.1f;  ///< roughness across
    float eta = 1.5f;      ///< index of refraction behind the surface over that in front of it
    Rgb reflectance{1};    ///< factor on reflected light, 0 to 1
    Rgb transmittance{1};  ///< factor on refracted light, 0 to 1

    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        if (wo.z == 0 || wi.z == 0) return {};
        const Microfacets facets(distribution, alpha_u, alpha_v);
        const float relative = wo.z > 0 ? eta : 1 / eta;
        const Vec3 sum = wo + wi;
        const float sum_squared = length_squared(sum);
        if (wo.z * wi.z > 0) {
            if (!(sum_squared > 1e-30f)) return {};  // both at the horizon, closer than floats can tell
            const float cos_half = std::min(0.5f * std::sqrt(sum_squared), 1.0f);
            const float fresnel = fresnel_dielectric(cos_half, relative).reflectance;
            const float density = fresnel * facets.distribution(sum) / facets.smith_denominator(upward(wo));
            return {reflectance * (density / facets.smith_denominator(upward(wi))), {0.5f * density}};
        }
        // wo + relative * wi lies along the normal of the facet that refracts one into the other. The sum of the
        // directions is exact where they nearly cancel, and the cosines are sums of |relative - 1| and it.
        const float contrast = relative - 1, distance = std::abs(contrast), bend = 0.5f * sum_squared;
        const Vec3 normal = contrast > 0 ? -(sum + contrast * wi) : sum + contrast * wi;
        const float squared = length_squared(normal);
        const float o = contrast > 0 ? distance - relative * bend : distance + relative * bend;
        const float i = contrast > 0 ? distance + bend : distance - bend;
        if (!(o > 0 && i > 0 && normal.z * wo.z > 0)) return {};
        const float inverse_length = 1 / std::sqrt(squared);
        const float cos_o = std::min(o * inverse_length, 1.0f), cos_i = i * inverse_length;
        const float density = 4 * refracted(cos_o, relative * cos_i, relative) * facets.distribution(normal) * cos_o *
                              cos_i / (squared * facets.smith_denominator(upward(wo)));
        const float scale = transport == Transport::radiance ? 1 : relative * relative;
        return {transmittance * (scale * density / facets.smith_denominator(upward(wi))),
                {0.5f * relative * relative * density}};
    }

    /// Reflects or refracts at a visible normal, with the probability of Fresnel's reflectance there. That, D and
    /// G1(wo) cancel: the weight is G1(wi). Refracted radiance is scaled by 1 / eta^2, importance is not (as in
    /// `Dielectric`).
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (wo.z == 0) return {};
        const Microfacets facets(distribution, alpha_u, alpha_v);
        const Vec3 above = upward(wo);
        if (eta == 1) return BsdfSample{.wi = -wo, .weight = transmittance * facets.masking(above), .specular = true};
        const float side = wo.z > 0 ? 1.0f : -1.0f;
        const Vec3 m = facets.sample_visible_normal(above, Vec2(u));
        const float inverse_length = 1 / std::sqrt(length_squared(m));
        const float cos_o = std::min(dot(above, m) * inverse_length, 1.0f);
        if (!(cos_o > 0)) return {};
        const FresnelDielectric fresnel = fresnel_dielectric(cos_o, wo.z > 0 ? eta : 1 / eta);
        const float density = facets.distribution(m) / facets.smith_denominator(above);
        if (u.z < fresnel.reflectance) {
            const Vec3 wi = 2 * cos_o * inverse_length * m - above;
            if (!(wi.z > 0)) return {};
            return BsdfSample{.wi = {wi.x, wi.y, side * wi.z},
                              .weight = reflectance * facets.masking(wi),
                              .pdf = {0.5f * fresnel.reflectance * density}};
        }
        if (fresnel.cos_t == 0) return {};
        // q - cos_o, which the normal adds to wo, without cancellation.
        const float q = -fresnel.cos_t * fresnel.eta;
        const float step = (fresnel.eta - 1) * (fresnel.eta + 1) / (q + cos_o);
        const Vec3 wi = normalize(-(above + step * inverse_length * m));
        if (!(wi.z < 0)) return {};
        const float scale = transport == Transport::radiance ? 1 / square(fresnel.eta) : 1;
        return BsdfSample{.wi = {wi.x, wi.y, side * wi.z},
                          .weight = transmittance * (scale * facets.masking(upward(wi))),
                          .pdf = {2 * (1 - fresnel.reflectance) * density * cos_o * q * fresnel.eta / square(step)},
                          .eta = fresnel.eta};
    }

    /// Where nothing is refracted light goes straight on.
    bool has_dirac_lobe() const { return std::abs(eta - 1) < 1e-4f; }
    bool isotropic() const { return alpha_u == alpha_v; }
    std::string problem() const;

    /// As `Dielectric`, with a wider highlight.
    PhongTerms phong() const {
        return {.diffuse = 0.1f * transmittance,
                .specular = 0.5f * reflectance,
                .shininess = std::min(phong_shininess(alpha_u, alpha_v), 500.0f)};
    }

private:
    /// 1 - Fresnel's reflectance, without cancellation, for a cosine and q = eta times the cosine of refraction.
    static float refracted(float c, float q, float eta) {
        const float dense = eta * eta;
        return 2 * c * q * (1 / square(c + q) + dense / square(dense * c + q));
    }

    static Vec3 upward(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }
};

template <>
inline constexpr auto parameters_of<RoughDielectric> =
    std::tuple_cat(stretched_roughness<RoughDielectric>,
                   std::tuple{Parameter{"eta", &RoughDielectric::eta, as_relative_index, false},
                              Parameter{"specular_reflectance", &RoughDielectric::reflectance},
                              Parameter{"specular_transmittance", &RoughDielectric::transmittance}});

inline std::string RoughDielectric::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
