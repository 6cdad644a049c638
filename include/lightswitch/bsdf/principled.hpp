#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/parameter.hpp>
#include <lightswitch/bsdf/principled_lobes.hpp>

namespace lightswitch {

/// Disney's model for most surfaces (Burley, "Physically Based Shading at Disney", 2012, and "Extending the Disney BRDF
/// to a BSDF with Integrated Subsurface Scattering", 2015), with the meaning of Mitsuba 3.9.1's `principled`: diffuse
/// reflection with an imitation of subsurface scattering, sheen, GGX reflection and refraction, and a clear coat. From
/// behind there is only the refracting part: nothing of it, and the surface is black.
///
/// Made to be handled by artists, lobes do not know of each other: bright diffuse colours gain energy from the
/// highlight, from sheen and the clear coat, saturated ones more from tints (tests/bsdf/principled_test.cpp says how
/// much). Rough facets lose some.
///
/// With `spec_trans` it lets light through and can have no `TwoSided` around it; without it can.
struct Principled {
    static constexpr std::string_view name = "principled";
    static constexpr bool specular = false;
    static constexpr bool transmits = true;

    Rgb base_color{0.5f};
    float roughness = 0.5f;     ///< square root of GGX's alpha, which is at least 0.001
    float anisotropic = 0;      ///< stretches highlights along x
    float metallic = 0;         ///< mixes with a metal whose reflectance is `base_color`
    float spec_trans = 0;       ///< mixes what is no metal with glass
    float eta = 1.5f;           ///< index of refraction behind the surface over that in front of it
    float spec_tint = 0;        ///< tints reflection of what is no metal
    float sheen = 0;            ///< strength of the sheen of cloth
    float sheen_tint = 0;       ///< tints it
    float flatness = 0;         ///< mixes diffuse reflection with an imitation of subsurface scattering
    float clearcoat = 0;        ///< strength of the clear coat
    float clearcoat_gloss = 0;  ///< from dull to glossy

    /// The index of refraction that Mitsuba gives to the parameter `specular`, 0 to 1, for 0 to 8 % of reflection at
    /// normal incidence. `may_transmit` is whether `spec_trans` is given, and not as 0: then 0 acts as 0.001.
    static float eta_from_specular(float specular_parameter, bool may_transmit) {
        const float s = may_transmit && specular_parameter == 0 ? 1e-3f : specular_parameter;
        return 2 / (1 - std::sqrt(0.08f * s)) - 1;
    }

    /// The index of refraction that Mitsuba takes for the parameter `eta`: refraction by an index of 1 would need no
    /// facets, and acts as 1.001.
    static float eta_from_eta(float eta_parameter, bool may_transmit) {
        return may_transmit && eta_parameter == 1 ? 1.001f : eta_parameter;
    }

    /// The value is reciprocal: f(wo, wi) = f(wi, wo) for reflection, and for refraction but for the factor 1 / eta^2
    /// that radiance gets and importance does not.
    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const float sides = wo.z * wi.z;
        if (wo.z < 0 && !(refracting() > 0)) return {};
        if (sides > 0) return wo.z > 0 ? front(wo, wi) : back(wo, wi);
        if (sides < 0 && refracting() > 0) return refraction(wo, wi, transport);
        return {};
    }

    /// Diffuse reflection and sheen by cosine, the clear coat by its normals, GGX by the visible ones, of which Fresnel
    /// reflects or refracts.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (wo.z == 0 || (wo.z < 0 && !(refracting() > 0))) return {};
        const Lobes lobes = lobes_of(wo.z);
        if (!(lobes.diffuse + lobes.clearcoat + lobes.specular > 0)) return {};
        Vec3 wi;
        float crossed = 1;
        bool refracts = false;
        if (u.z < lobes.diffuse) {
            wi = cosine_hemisphere(Vec2(u));
        } else if (u.z < lobes.diffuse + lobes.clearcoat) {
            wi = reflected(wo, Gtr1(clearcoat_gloss).sample(Vec2(u)));
        } else {
            const Vec3 m = normalize(facets().sample_visible_normal(wo.z > 0 ? wo : -wo, Vec2(u)));
            const float cosine = dot(wo, m);
            const FresnelDielectric fresnel = fresnel_dielectric(cosine, index());
            const float rest = (u.z - lobes.diffuse - lobes.clearcoat) / lobes.specular;
            const float reflection = specular_at(fresnel, cosine).reflection_probability;
            refracts = rest >= reflection && reflection < 1;
            if (!refracts) {
                wi = 2 * cosine * m - wo;
            } else {
                const float inverse = 1 / fresnel.eta;
                wi = normalize((cosine * inverse + fresnel.cos_t) * m - inverse * wo);
                crossed = fresnel.eta;
            }
        }
        if (!(refracts ? wi.z * wo.z < 0 : wi.z * wo.z > 0)) return {};
        const BsdfValue v = evaluate(wo, wi, transport);
        if (!(v.pdf.value > 0)) return {};
        return BsdfSample{.wi = wi, .weight = v.value * (std::abs(wi.z) / v.pdf.value), .pdf = v.pdf, .eta = crossed};
    }

    /// Also where `metallic` 1 leaves nothing of it: a texture may say so of some places only.
    bool transmits_light() const { return spec_trans > 0; }
    bool isotropic() const { return anisotropic == 0; }
    std::string problem() const;

    /// Metal has no diffuse term; the shape of glass is kept visible as for `Dielectric`. The highlight has Blinn's
    /// exponent for the same roughness, 2 / alpha^2 - 2, kept within 1 to 1000.
    PhongTerms phong() const {
        const float alpha = roughness * roughness;
        const Specular s = specular_at(fresnel_dielectric(1, index()), 1);
        return {.diffuse = diffusing() * base_color + 0.1f * refracting() * base_color,
                .specular = min(s.reflected + 0.25f * clearcoat * Rgb(0.04f) + 0.3f * refracting(), Rgb(1)),
                .shininess = std::clamp(2 / std::max(alpha * alpha, 1e-6f) - 2, 1.0f, 1000.0f)};
    }

private:
    /// The probabilities of the lobes, as seen from `wo`.
    struct Lobes {
        float diffuse, clearcoat, specular;
    };

    /// What facets do at one angle: fractions of light, and the probability with which reflection is chosen.
    struct Specular {
        Rgb reflected, transmitted;
        float reflection_probability;
    };

    Microfacets facets() const { return principled_microfacets(roughness, anisotropic); }
    float diffusing() const { return (1 - metallic) * (1 - spec_trans); }
    float refracting() const { return (1 - metallic) * spec_trans; }

    /// Half vectors of refraction keep some digits only if the index is not too near to 1.
    float index() const {
        const float index = eta_from_eta(eta, refracting() > 0);
        return refracting() > 0 && std::abs(index - 1) < 1e-4f ? 1 + std::copysign(1e-4f, index - 1) : index;
    }

    /// For facets met under the signed `cosine`. In front, metal and tinted reflection are Schlick's, the rest is
    /// exact.
    Specular specular_at(const FresnelDielectric& fresnel, float cosine) const {
        const float exact = fresnel.reflectance;
        Specular s{Rgb(0), Rgb(0), 1};
        if (cosine < 0) {
            s.reflected = Rgb(refracting() * exact);
        } else if (exact > 0) {  // an index of 1 shows not even the metal
            s.reflected = Rgb((1 - metallic) * (1 - spec_tint) * exact);
            if (metallic > 0 || spec_tint > 0) {
                const float weight = schlick_weight(fresnel, cosine);
                if (metallic > 0) s.reflected += metallic * schlick(base_color, weight);
                if (spec_tint > 0) {
                    const float normal = square((fresnel.eta - 1) / (fresnel.eta + 1));
                    s.reflected += (1 - metallic) * spec_tint * schlick(normal * tint_of(base_color), weight);
                }
            }
        }
        if (refracting() > 0) {
            s.transmitted = refracting() * (1 - exact) * sqrt(base_color);
            const float r = max_component(s.reflected), t = max_component(s.transmitted);
            s.reflection_probability = t > 0 ? r / (r + t) : 1;
        }
        return s;
    }

    /// By what each lobe would reflect if facets lay flat. The least share is for rough facets, of which those that are
    /// grazed reflect much more.
    Lobes lobes_of(float cos_o) const {
        if (cos_o < 0) return {0, 0, 1};
        float facets_share = 0;
        if (index() != 1) {
            const Specular s = specular_at(fresnel_dielectric(cos_o, index()), cos_o);
            facets_share = std::max(max_component(s.reflected + s.transmitted), 0.1f);
        }
        float diffuse = diffusing() * max_component(base_color);
        if (sheen > 0) diffuse += 0.3f * (1 - metallic) * max_component(sheen_color(base_color, sheen, sheen_tint));
        const float coat = 0.05f * clearcoat;
        const float sum = diffuse + coat + facets_share;
        const float scale = sum > 0 ? 1 / sum : 0;
        return {diffuse * scale, coat * scale, facets_share * scale};
    }

    BsdfValue front(const Vec3& wo, const Vec3& wi) const {
        const Vec3 half = wo + wi;
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {};  // both at the horizon, closer than floats can tell
        const float cos_half = std::min(0.5f * std::sqrt(squared), 1.0f);
        const FresnelDielectric fresnel = fresnel_dielectric(cos_half, index());
        const Lobes lobes = lobes_of(wo.z);
        BsdfValue v;
        if (lobes.specular > 0) {
            const Specular s = specular_at(fresnel, cos_half);
            const Microfacets ggx = facets();
            const float density = ggx.distribution(half) / ggx.smith_denominator(wo);
            v.value = s.reflected * (density / ggx.smith_denominator(wi));
            v.pdf.value = 0.5f * lobes.specular * s.reflection_probability * density;
        }
        if (lobes.clearcoat > 0) {
            const float density = Gtr1(clearcoat_gloss).distribution(half);
            const Microfacets coat(Facets::ggx, 0.25f, 0.25f);
            const float weight = schlick_weight(fresnel, cos_half);
            v.value +=
                Rgb(0.25f * clearcoat * (0.04f + 0.96f * weight) * density * coat.masking(wo) * coat.masking(wi));
            v.pdf.value += lobes.clearcoat * density * (half.z / squared) * 0.5f;
        }
        if (lobes.diffuse > 0) {
            if (diffusing() > 0)
                v.value +=
                    diffusing() * inv_pi * principled_diffuse(wo.z, wi.z, cos_half, roughness, flatness) * base_color;
            // Mitsuba's scalar variants, not its others, have no sheen where `spec_trans` is exactly 1.
            if (sheen > 0)
                v.value += (1 - metallic) * schlick_weight(cos_half) * sheen_color(base_color, sheen, sheen_tint);
            v.pdf.value += lobes.diffuse * cosine_hemisphere_pdf(wi.z).value;
        }
        return v;
    }

    BsdfValue back(const Vec3& wo, const Vec3& wi) const {
        const Vec3 half = -(wo + wi);
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {};
        const float cosine = -std::min(0.5f * std::sqrt(squared), 1.0f);
        const Specular s = specular_at(fresnel_dielectric(cosine, index()), cosine);
        const Microfacets ggx = facets();
        const float density = ggx.distribution(half) / ggx.smith_denominator(-wo);
        return {s.reflected * (density / ggx.smith_denominator(-wi)), {0.5f * s.reflection_probability * density}};
    }

    /// Walter et al. 2007, section 4.2, with the half vector's length left in: it is the divisor of their equation 16.
    BsdfValue refraction(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const float relative = wo.z > 0 ? index() : 1 / index();
        Vec3 half = wo + relative * wi;
        if (half.z < 0) half = -half;
        const float squared = length_squared(half);
        const float side = std::copysign(1.0f, wo.z);
        const float o = side * dot(wo, half), i = -side * dot(wi, half);
        // Facets are seen from both sides of the surface only if these are the sides of the facets too.
        if (!(o > 0 && i > 0)) return {};
        const float length = std::sqrt(squared);
        const float cos_o = std::min(o / length, 1.0f), cos_i = std::min(i / length, 1.0f);
        // Seen from the thinner medium, where it cannot be total, reflection keeps its digits at grazing angles.
        const FresnelDielectric thinner =
            fresnel_dielectric(relative > 1 ? cos_o : cos_i, relative > 1 ? relative : 1 / relative);
        const Specular s = specular_at({thinner.reflectance, -side * cos_i, relative}, side * cos_o);
        const Microfacets ggx = facets();
        const float density = ggx.distribution(half) / ggx.smith_denominator(side * wo) * (o / squared) * (i / squared);
        const float compressed = square(relative) * density;
        const float scaled = transport == Transport::radiance ? density : compressed;
        return {s.transmitted * (4 * scaled / ggx.smith_denominator(-side * wi)),
                {2 * compressed * lobes_of(wo.z).specular * (1 - s.reflection_probability)}};
    }
};

template <>
inline constexpr auto parameters_of<Principled> = std::tuple{
    Parameter{"base_color", &Principled::base_color},   Parameter{"roughness", &Principled::roughness},
    Parameter{"anisotropic", &Principled::anisotropic}, Parameter{"metallic", &Principled::metallic},
    Parameter{"spec_trans", &Principled::spec_trans},   Parameter{"eta", &Principled::eta, as_relative_index, false},
    Parameter{"spec_tint", &Principled::spec_tint},     Parameter{"sheen", &Principled::sheen},
    Parameter{"sheen_tint", &Principled::sheen_tint},   Parameter{"flatness", &Principled::flatness},
    Parameter{"clearcoat", &Principled::clearcoat},     Parameter{"clearcoat_gloss", &Principled::clearcoat_gloss}};

inline std::string Principled::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
