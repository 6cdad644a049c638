#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Perfectly smooth boundary between two transparent media: reflection and refraction after Fresnel.
struct Dielectric {
    static constexpr std::string_view name = "dielectric";
    static constexpr bool specular = true;
    static constexpr bool transmits = true;

    float eta = 1.5f;      ///< index of refraction behind the surface over that in front of it
    Rgb reflectance{1};    ///< factor on reflected light, 0 to 1
    Rgb transmittance{1};  ///< factor on refracted light, 0 to 1

    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }

    /// Reflects with the probability of Fresnel's reflectance, for which `u.x` is drawn, so that the reflectance
    /// cancels from the weight. Refracted radiance is scaled by 1 / eta^2, as the same power fills another solid angle;
    /// importance is not (Veach 1997, section 5.2).
    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (wo.z == 0) return {};
        const FresnelDielectric fresnel = fresnel_dielectric(wo.z, eta);
        if (u.x < fresnel.reflectance)
            return BsdfSample{.wi = {-wo.x, -wo.y, wo.z}, .weight = reflectance, .specular = true};
        if (fresnel.cos_t == 0) return {};
        const float inverse = 1 / fresnel.eta;
        const float scale = transport == Transport::radiance ? inverse * inverse : 1;
        // Refraction into a thinner medium enlarges the rounding of `wo`, hence the normalisation.
        return BsdfSample{.wi = normalize(Vec3(-wo.x * inverse, -wo.y * inverse, fresnel.cos_t)),
                          .weight = transmittance * scale,
                          .specular = true,
                          .eta = fresnel.eta};
    }

    std::string problem() const;

    /// Phong's model cannot refract: a faint diffuse term keeps the shape visible, and the highlight is shown stronger
    /// than the few percent that glass reflects.
    PhongTerms phong() const {
        return {.diffuse = 0.1f * transmittance, .specular = 0.5f * reflectance, .shininess = 500};
    }
};

template <>
inline constexpr auto parameters_of<Dielectric> =
    std::tuple{Parameter{"eta", &Dielectric::eta, as_relative_index, false},
               Parameter{"specular_reflectance", &Dielectric::reflectance},
               Parameter{"specular_transmittance", &Dielectric::transmittance}};

inline std::string Dielectric::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
