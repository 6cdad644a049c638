#pragma once

#include <lightswitch/bsdf/lobe_sample.hpp>
#include <lightswitch/bsdf/parameter.hpp>

namespace lightswitch {

/// Diffuse reflection and a lobe around the mirror direction, front side only (Lafortune and Willems, "Using the
/// Modified Phong Reflectance Model for Physically Based Rendering", 1994). As Mitsuba 0.6's `phong`.
///
/// The lobe is normalised at normal incidence; elsewhere it reflects less: a narrow one in proportion to the cosine.
struct ModifiedPhong {
    static constexpr std::string_view name = "Phong";
    static constexpr bool specular = false;

    float exponent = 30;             ///< of the cosine to the mirror direction, 0 to 1e6
    Rgb diffuse_reflectance{0.5f};   ///< 0 to 1, together with the other
    Rgb specular_reflectance{0.2f};  ///< of the lobe at normal incidence

    [[gnu::noinline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        // 1 - cosine to the mirror direction, with all digits however large the exponent is.
        const float lift = 0.5f * length_squared(wi - mirrored(wo));
        const float lobe = lift < 1 ? 0.5f * inv_pi * std::exp(exponent * std::log1p(-lift)) : 0;
        const float probability = detail::lobe_probability(specular_reflectance, diffuse_reflectance);
        return {diffuse_reflectance * inv_pi + specular_reflectance * ((exponent + 2) * lobe),
                {(1 - probability) * cosine_hemisphere_pdf(wi.z).value + probability * (exponent + 1) * lobe}};
    }

    /// Chooses the lobe by `u.z`.
    [[gnu::noinline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (!(wo.z > 0)) return {};
        if (!(u.z < detail::lobe_probability(specular_reflectance, diffuse_reflectance)))
            return detail::sample_of_all_lobes(*this, wo, cosine_hemisphere(Vec2(u)), transport);
        const auto [direction, number] = detail::polar_sample(Vec2(u));
        const float lift = -std::expm1(std::log(number) / (exponent + 1));
        const float sine = std::sqrt(lift * (2 - lift));
        const Vec3 wi = Basis(mirrored(wo)).to_world({direction.x * sine, direction.y * sine, 1 - lift});
        return detail::sample_of_all_lobes(*this, wo, wi, transport);
    }

    std::string problem() const;

    PhongTerms phong() const {
        return {.diffuse = diffuse_reflectance,
                .specular = specular_reflectance,
                .shininess = std::clamp(exponent, 1.0f, 1000.0f)};
    }

private:
    static Vec3 mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }
};

template <>
inline constexpr auto parameters_of<ModifiedPhong> =
    std::tuple{Parameter{"exponent", &ModifiedPhong::exponent, ParameterRange{.least = 0, .most = 1e6f}},
               Parameter{"diffuse_reflectance", &ModifiedPhong::diffuse_reflectance},
               Parameter{"specular_reflectance", &ModifiedPhong::specular_reflectance}};

inline std::string ModifiedPhong::problem() const {
    const std::string text = parameter_problem(*this);
    return text.empty() ? detail::sum_problem(diffuse_reflectance, specular_reflectance) : text;
}

}  // namespace lightswitch
