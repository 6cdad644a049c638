#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/parameter.hpp>
#include <lightswitch/bsdf/principled_lobes.hpp>

namespace lightswitch {

/// Disney's model for sheets that let light through and are too thin to bend it, the same from both sides: leaves,
/// paper, panes (Burley, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering", 2015),
/// with the meaning of Mitsuba 3.9.1's `principledthin`. Diffuse reflection and transmission, sheen, and reflection and
/// transmission by GGX facets, where what is transmitted is reflected and then mirrored to the other side.
///
/// Made to be handled by artists, lobes do not know of each other: bright rough surfaces gain energy, with sheen or
/// saturated tints more of it (tests/bsdf/principled_thin_test.cpp says how much).
struct PrincipledThin {
    static constexpr std::string_view name = "thin principled";
    static constexpr bool specular = false;
    static constexpr bool transmits = true;

    Rgb base_color{0.5f};
    float roughness = 0.5f;  ///< square root of GGX's alpha, which is at least 0.001
    float anisotropic = 0;   ///< stretches highlights along x
    float spec_trans = 0;    ///< mixes diffuse with specular reflection and transmission
    float eta = 1.5f;        ///< index of refraction of the sheet; also blurs what is seen through it
    float spec_tint = 0;     ///< tints specular reflection
    float sheen = 0;         ///< strength of the sheen of cloth
    float sheen_tint = 0;    ///< tints it
    float flatness = 0;      ///< mixes diffuse reflection with an imitation of subsurface scattering
    float diff_trans = 0;    ///< from diffuse reflection, 0, to diffuse transmission, 2

    /// Reciprocal but for one thing: Mitsuba drops specular transmission when the direction where the path goes is in
    /// front of the facet, as it may be when it grazes the sheet. For importance the other direction is asked, so that
    /// paths from both ends see the same surface.
    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const float sides = wo.z * wi.z;
        if (!(sides > 0 || sides < 0)) return {};
        const Vec3 o = wo.z > 0 ? wo : -wo;
        const bool reflects = sides > 0;
        const Vec3 i = {wo.z > 0 ? Vec2(wi) : -Vec2(wi), std::abs(wi.z)};
        const Lobes lobes = lobes_of(o.z);
        BsdfValue v;
        const Vec3 half = o + i;
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {};  // both at the horizon, closer than floats can tell
        const float cos_half = std::min(0.5f * std::sqrt(squared), 1.0f);
        if (spec_trans > 0) {
            const Specular s = specular_at(cos_half);
            const Microfacets ggx = reflects ? reflecting() : transmitting();
            const float density = ggx.distribution(half) / ggx.smith_denominator(o);
            const Vec3& leaving = transport == Transport::radiance ? i : o;
            if (reflects || leaving.z * half.z > leaving.x * half.x + leaving.y * half.y)
                v.value = (reflects ? s.reflected : s.transmitted) * (density / ggx.smith_denominator(i));
            v.pdf.value = 0.5f * density * (reflects ? lobes.reflected : lobes.transmitted);
        }
        if (spec_trans < 1) {
            if (reflects) {
                const float share = (1 - spec_trans) * (1 - 0.5f * diff_trans);
                if (share > 0) {
                    v.value +=
                        share * inv_pi * principled_diffuse(o.z, i.z, cos_half, roughness, flatness) * base_color;
                    if (sheen > 0)
                        v.value += share * schlick_weight(cos_half) * sheen_color(base_color, sheen, sheen_tint);
                }
            } else {
                v.value += (1 - spec_trans) * 0.5f * diff_trans * inv_pi * base_color;
            }
            v.pdf.value += cosine_hemisphere_pdf(i.z).value * (reflects ? lobes.diffuse : lobes.diffuse_transmitted);
        }
        return v;
    }

    /// Diffuse light by cosine, specular light by the visible normals.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (wo.z == 0) return {};
        const Vec3 o = wo.z > 0 ? wo : -wo;
        const Lobes lobes = lobes_of(o.z);
        const float diffuse = lobes.diffuse + lobes.diffuse_transmitted;
        if (!(diffuse + lobes.reflected + lobes.transmitted > 0)) return {};
        Vec3 wi;
        bool transmitted;
        if (u.z < diffuse) {
            transmitted = u.z >= lobes.diffuse;
            wi = cosine_hemisphere(Vec2(u));
        } else {
            transmitted = u.z >= diffuse + lobes.reflected;
            wi = reflected(o, (transmitted ? transmitting() : reflecting()).sample_visible_normal(o, Vec2(u)));
        }
        if (!(wi.z > 0)) return {};
        if (transmitted) wi.z = -wi.z;
        if (wo.z < 0) wi = -wi;
        const BsdfValue v = evaluate(wo, wi, transport);
        if (!(v.pdf.value > 0)) return {};
        return BsdfSample{.wi = wi, .weight = v.value * (std::abs(wi.z) / v.pdf.value), .pdf = v.pdf};
    }

    bool isotropic() const { return anisotropic == 0; }
    std::string problem() const;

    /// Light that is let through counts as diffuse; the highlight has Blinn's exponent for the same roughness,
    /// 2 / alpha^2 - 2, kept within 1 to 1000.
    PhongTerms phong() const {
        const float alpha = roughness * roughness;
        return {.diffuse = (1 - spec_trans) * base_color + 0.1f * spec_trans * base_color,
                .specular = min(specular_at(1).reflected + Rgb(0.3f * spec_trans), Rgb(1)),
                .shininess = std::clamp(2 / std::max(alpha * alpha, 1e-6f) - 2, 1.0f, 1000.0f)};
    }

private:
    /// The probabilities of the lobes, as seen from `wo`.
    struct Lobes {
        float diffuse, diffuse_transmitted, reflected, transmitted;
    };

    /// What facets do at one angle.
    struct Specular {
        Rgb reflected, transmitted;
    };

    Microfacets reflecting() const { return principled_microfacets(roughness, anisotropic); }

    /// Burley 2015, figure 15: the roughness that looks like that of a real pane. From an index of 16 on, when there is
    /// nothing left to see, it does not grow any more.
    Microfacets transmitting() const {
        return principled_microfacets(std::min(std::abs(0.65f * eta - 0.35f) * roughness, 10.0f), anisotropic);
    }

    Specular specular_at(float cosine) const {
        const FresnelDielectric fresnel = fresnel_dielectric(cosine, eta);
        Rgb reflectance((1 - spec_tint) * fresnel.reflectance);
        if (spec_tint > 0)
            reflectance += spec_tint * schlick(square((eta - 1) / (eta + 1)) * tint_of(base_color),
                                               schlick_weight(fresnel, cosine));
        return {spec_trans * reflectance, spec_trans * (1 - fresnel.reflectance) * base_color};
    }

    /// By what each lobe would reflect or transmit if facets lay flat, or a little more. The least shares bound the
    /// weights of samples where facets at another angle do much more.
    Lobes lobes_of(float cos_o) const {
        Lobes lobes{};
        const float base = max_component(base_color);
        if (spec_trans < 1) {
            const float through = 0.5f * diff_trans;
            const float cloth = sheen > 0 ? 0.3f * max_component(sheen_color(base_color, sheen, sheen_tint)) : 0;
            lobes.diffuse = (1 - spec_trans) * (1 - through) * (base + cloth);
            lobes.diffuse_transmitted = (1 - spec_trans) * through * base;
        }
        if (spec_trans > 0) {
            const Specular s = specular_at(cos_o);
            lobes.reflected = std::max(max_component(s.reflected), 0.1f * spec_trans);
            if (base > 0) lobes.transmitted = std::max(max_component(s.transmitted), 0.1f * spec_trans * base);
        }
        const float sum = lobes.diffuse + lobes.diffuse_transmitted + lobes.reflected + lobes.transmitted;
        const float scale = sum > 0 ? 1 / sum : 0;
        return {lobes.diffuse * scale, lobes.diffuse_transmitted * scale, lobes.reflected * scale,
                lobes.transmitted * scale};
    }
};

template <>
inline constexpr auto parameters_of<PrincipledThin> =
    std::tuple{Parameter{"base_color", &PrincipledThin::base_color},
               Parameter{"roughness", &PrincipledThin::roughness},
               Parameter{"anisotropic", &PrincipledThin::anisotropic},
               Parameter{"spec_trans", &PrincipledThin::spec_trans},
               Parameter{"eta", &PrincipledThin::eta, as_relative_index},
               Parameter{"spec_tint", &PrincipledThin::spec_tint},
               Parameter{"sheen", &PrincipledThin::sheen},
               Parameter{"sheen_tint", &PrincipledThin::sheen_tint},
               Parameter{"flatness", &PrincipledThin::flatness},
               Parameter{"diff_trans", &PrincipledThin::diff_trans, ParameterRange{.least = 0, .most = 2}}};

inline std::string PrincipledThin::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
