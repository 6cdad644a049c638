#pragma once

#include <lightswitch/bsdf/bsdf.hpp>

namespace lightswitch {

/// Gives a one-sided model the same appearance on the back. Not for models that transmit.
template <Bsdf Inner>
struct TwoSided {
    static constexpr bool specular = Inner::specular;

    Inner inner;

    [[gnu::always_inline]] BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const float side = std::copysign(1.0f, wo.z);
        return inner.evaluate(flip(wo, side), flip(wi, side), transport);
    }

    [[gnu::always_inline]] Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        const float side = std::copysign(1.0f, wo.z);
        auto result = inner.sample(flip(wo, side), u, transport);
        if (result) result->wi.z *= side;
        return result;
    }

    std::string problem() const { return inner.problem(); }
    PhongTerms phong() const requires requires(const Inner& i) { i.phong(); }
    { return inner.phong(); }

private:
    static Vec3 flip(const Vec3& w, float side) { return {w.x, w.y, w.z * side}; }
};

}  // namespace lightswitch
