#pragma once

// What surface models of several smooth lobes have in common.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/warp.hpp>

namespace lightswitch::detail {

/// The sample `wi` of a model that draws from one of its smooth lobes and evaluates all of them; nothing where its
/// density is 0.
template <class B>
Maybe<BsdfSample> sample_of_all_lobes(const B& bsdf, const Vec3& wo, const Vec3& wi, Transport transport) {
    const BsdfValue v = bsdf.evaluate(wo, wi, transport);
    if (!(v.pdf.value > 0)) return {};
    return BsdfSample{.wi = wi, .weight = v.value * (std::abs(wi.z) / v.pdf.value), .pdf = v.pdf};
}

/// The probability of the first of two lobes that reflect `first` and `second`: by the mean of the colours. 0 when both
/// are black.
inline float lobe_probability(const Rgb& first, const Rgb& second) {
    const float sum = first.x + first.y + first.z, both = sum + second.x + second.y + second.z;
    return both > 0 ? sum / both : 0;
}

/// Explains why two lobes together reflect more than there is, or returns an empty string.
inline std::string sum_problem(const Rgb& diffuse, const Rgb& specular) {
    // Decimal fractions that add up to 1 need not do so when they are rounded.
    constexpr float most = 1 + 4 * unit_roundoff;
    if (max_component(diffuse + specular) <= most) return {};
    return "diffuse_reflectance and specular_reflectance add up to " +
           std::to_string(max_component(diffuse + specular)) + " in one component, which is above 1";
}

/// A uniform direction in the plane and, independent of it, a uniform number in (0, 1]: the radius of the concentric
/// disk turned inside out, so that stratified numbers stay stratified.
struct PolarSample {
    Vec2 direction;
    float number;
};
inline PolarSample polar_sample(const Vec2& u) {
    const auto [p, number] = concentric(u);
    const float radius = std::sqrt(p.x * p.x + p.y * p.y);
    return {radius > 0 ? p / radius : Vec2(1, 0), std::max(number, 0x1p-24f)};
}

}  // namespace lightswitch::detail
