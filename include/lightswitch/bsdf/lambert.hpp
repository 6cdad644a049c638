#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/parameter.hpp>
#include <lightswitch/core/warp.hpp>

namespace lightswitch {

/// Ideal diffuse reflection on the front side; the back side is black (Lambert 1760; pbrt-v4, section 9.2).
struct Lambert {
    static constexpr std::string_view name = "diffuse";
    static constexpr bool specular = false;

    Rgb reflectance{0.5f};  ///< fraction of the light that is reflected, each component 0 to 1

    [[gnu::always_inline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        return {reflectance * inv_pi, cosine_hemisphere_pdf(wi.z)};
    }

    [[gnu::always_inline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport) const {
        if (!(wo.z > 0)) return {};
        const Vec3 wi = cosine_hemisphere(Vec2(u));
        return BsdfSample{.wi = wi, .weight = reflectance, .pdf = cosine_hemisphere_pdf(wi.z)};
    }

    std::string problem() const;
    PhongTerms phong() const { return {.diffuse = reflectance}; }
};

template <>
inline constexpr auto parameters_of<Lambert> = std::tuple{Parameter{"reflectance", &Lambert::reflectance}};

inline std::string Lambert::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
