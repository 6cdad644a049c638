#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// A thin pane of a transparent medium, such as a window, as one surface: as Mitsuba's `thindielectric`. Light is
/// reflected, or goes straight on, displaced by nothing; the same from both sides.
///
/// All reflections between the faces are summed up (Stokes 1862, "On the Intensity of the Light Reflected from or
/// Transmitted through a Pile of Plates"): with R and T = 1 - R of one face, the pane reflects
/// R + T R T + T R^3 T + ... = 2 R / (1 + R).
struct ThinDielectric {
    static constexpr std::string_view name = "thin dielectric";
    static constexpr bool specular = true;
    static constexpr bool transmits = true;

    float eta = 1.5f;      ///< index of refraction of the pane over that around it
    Rgb reflectance{1};    ///< factor on reflected light, 0 to 1
    Rgb transmittance{1};  ///< factor on light that goes through, 0 to 1

    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }

    /// Reflects with the probability of the pane's reflectance, for which `u.x` is drawn. Behind the pane light is in
    /// the same medium as before it: nothing is scaled.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport) const {
        if (wo.z == 0) return {};
        const float face = fresnel_dielectric(std::abs(wo.z), eta).reflectance;
        if (u.x < 2 * face / (1 + face))
            return BsdfSample{.wi = {-wo.x, -wo.y, wo.z}, .weight = reflectance, .specular = true};
        return BsdfSample{.wi = -wo, .weight = transmittance, .specular = true};
    }

    std::string problem() const;

    /// As `Dielectric`.
    PhongTerms phong() const {
        return {.diffuse = 0.1f * transmittance, .specular = 0.5f * reflectance, .shininess = 500};
    }
};

template <>
inline constexpr auto parameters_of<ThinDielectric> =
    std::tuple{Parameter{"eta", &ThinDielectric::eta, as_relative_index, false},
               Parameter{"specular_reflectance", &ThinDielectric::reflectance},
               Parameter{"specular_transmittance", &ThinDielectric::transmittance}};

inline std::string ThinDielectric::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
