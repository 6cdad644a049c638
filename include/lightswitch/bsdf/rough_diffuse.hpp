#pragma once

#include <lightswitch/bsdf/lobe_sample.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Rough diffuse surface, front side only, such as plaster or clay: grooves of ideal diffuse facets, with shadowing,
/// masking and light that meets two facets (Oren and Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH
/// 1994). As Mitsuba 0.6's `roughdiffuse`, for which the deviation of slopes is alpha / sqrt(2).
///
/// Up to a reflectance of 0.95 it never gives back more light than it gets. The fits of the paper give a white surface
/// of alpha 0.4 an albedo of 1.05 at grazing angles; the mean over directions is at most 1.0003.
struct RoughDiffuse {
    static constexpr std::string_view name = "rough diffuse";
    static constexpr bool specular = false;

    float alpha = 0.2f;            ///< roughness, 0 to 1; with none it is `Lambert`
    Rgb reflectance{0.5f};         ///< of the facets, 0 to 1
    bool use_fast_approx = false;  ///< the paper's qualitative model: without light that meets two facets

    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        const float sin_o = std::sqrt(wo.x * wo.x + wo.y * wo.y), sin_i = std::sqrt(wi.x * wi.x + wi.y * wi.y);
        // `a` is the direction closer to the horizon, `b` the other one.
        const float cos_a = std::min(wo.z, wi.z), cos_b = std::max(wo.z, wi.z);
        const float sin_a = std::max(sin_o, sin_i), sin_b = std::min(sin_o, sin_i);
        const float sines = sin_o * sin_i;
        const float azimuth = sines > 0 ? std::clamp((wo.x * wi.x + wo.y * wi.y) / sines, -1.0f, 1.0f) : 0;
        constexpr float least = std::numeric_limits<float>::min();  // keeps quotients finite
        const float tan_b = sin_b / std::max(cos_b, least);

        const float variance = 0.5f * alpha * alpha;
        const float c1 = 1 - 0.5f * variance / (variance + 0.33f), share = variance / (variance + 0.09f);
        const SolidAnglePdf pdf = cosine_hemisphere_pdf(wi.z);
        if (use_fast_approx)
            return {reflectance * (inv_pi * (c1 + 0.45f * share * std::max(azimuth, 0.0f) * sin_a * tan_b)), pdf};

        // Heights above the horizon as fractions of a right angle.
        const float height_a = 2 * inv_pi * std::asin(std::min(cos_a, 1.0f)),
                    height_b = 2 * inv_pi * std::asin(std::min(cos_b, 1.0f));
        const float angle_a = 1 - height_a, angle_b = 1 - height_b;
        // sin_a, or sin_a - angle_b^3, of which grazing directions would leave no digits.
        const float lean =
            azimuth >= 0 ? sin_a : height_b * (3 - 3 * height_b + height_b * height_b) - cos_a * cos_a / (1 + sin_a);
        const float c3 = 0.125f * share * square(angle_a * angle_b);
        const float tan_half = (sin_a + sin_b) / std::max(cos_a + cos_b, least);
        const float once = c1 + 0.45f * share * azimuth * lean * tan_b + (1 - std::abs(azimuth)) * c3 * tan_half;
        const float twice = 0.17f * variance / (variance + 0.13f) * (1 - azimuth * square(angle_b));
        return {reflectance * (inv_pi * (Rgb(once) + twice * reflectance)), pdf};
    }

    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (!(wo.z > 0)) return {};
        return detail::sample_of_all_lobes(*this, wo, cosine_hemisphere(Vec2(u)), transport);
    }

    std::string problem() const;
    PhongTerms phong() const { return {.diffuse = reflectance}; }
};

template <>
inline constexpr auto parameters_of<RoughDiffuse> =
    std::tuple{Parameter{"alpha", &RoughDiffuse::alpha}, Parameter{"reflectance", &RoughDiffuse::reflectance}};

inline std::string RoughDiffuse::problem() const { return parameter_problem(*this); }

}  // namespace lightswitch
