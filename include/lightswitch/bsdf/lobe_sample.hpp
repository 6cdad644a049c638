#pragma once

#include <lightswitch/bsdf/bsdf.hpp>

namespace lightswitch::detail {

/// The sample `wi` of a model that draws from one of its smooth lobes and evaluates all of them; nothing where the model
/// is black or its density 0.
template <class B>
Maybe<BsdfSample> sample_of_all_lobes(const B& bsdf, const Vec3& wo, const Vec3& wi, Transport transport) {
    const BsdfValue v = bsdf.evaluate(wo, wi, transport);
    if (!(v.pdf.value > 0)) return {};
    return BsdfSample{.wi = wi, .weight = v.value * (std::abs(wi.z) / v.pdf.value), .pdf = v.pdf};
}

/// The probability of the first of two lobes whose weights are `first` and `second`: by the mean of the colours. 0 when
/// both are black.
inline float lobe_probability(const Rgb& first, const Rgb& second) {
    const float sum = first.x + first.y + first.z, both = sum + second.x + second.y + second.z;
    return both > 0 ? sum / both : 0;
}

}  // namespace lightswitch::detail
