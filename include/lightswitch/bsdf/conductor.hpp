#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Perfectly smooth metal, front side only: an ideal mirror, or Fresnel's equations for `eta` and `k`.
struct Conductor {
    static constexpr std::string_view name = "conductor";
    static constexpr bool specular = true;

    Rgb eta{0};          ///< real part of the index of refraction
    Rgb k{1};            ///< imaginary part; eta 0 with k 1 reflects everything: the ideal mirror
    Rgb reflectance{1};  ///< factor on the Fresnel reflectance, 0 to 1

    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3&, Transport) const {
        if (!(wo.z > 0)) return {};
        return BsdfSample{
            .wi = {-wo.x, -wo.y, wo.z}, .weight = reflectance * fresnel_conductor(wo.z, eta, k), .specular = true};
    }

    std::string problem() const;

    /// No diffuse term; a sharp highlight with the colour of the metal at normal incidence.
    PhongTerms phong() const {
        return {.diffuse = Rgb(0), .specular = reflectance * fresnel_conductor(1, eta, k), .shininess = 500};
    }
};

template <>
inline constexpr auto parameters_of<Conductor> =
    std::tuple{Parameter{"eta", &Conductor::eta, as_metal_index}, Parameter{"k", &Conductor::k, as_metal_index},
               Parameter{"specular_reflectance", &Conductor::reflectance}};

inline std::string Conductor::problem() const {
    const std::string text = parameter_problem(*this);
    return text.empty() ? conductor_problem(eta, k) : text;
}

}  // namespace lightswitch
