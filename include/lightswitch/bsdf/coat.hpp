#pragma once

// A clear coat over any surface model: what it reflects, and what it does to directions and light on their way through.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/rough_coat.hpp>

#include <cmath>

namespace lightswitch {

/// A clear, perhaps tinted coat. Mitsuba 0.6's `coating` and, where it is rough, `roughcoating` (after Weidlich and
/// Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007, section 4).
///
/// It reflects like a dielectric. What enters is refracted by Snell's law, meets what is below once, and is refracted
/// when it leaves: with T the transmittance of the boundary, A what is absorbed on the two ways and f the model below,
///
///     T(wo) T(wi) A f(wo', wi') / eta^2.
///
/// Light that the boundary keeps inside is lost: of a white diffuse base that is much, for which there is `Plastic`.
/// As in Mitsuba, a coat is on both sides of what it lies over, and light gets through where the model below lets it.
struct Coat {
    float eta = 1.5046f / 1.000277f;  ///< index of refraction of the coat over that outside: BK7 in air
    Rgb specular_reflectance{1};      ///< factor on light that the coat reflects, 0 to 1
    float thickness = 1;              ///< in the inverse unit of `sigma_a`: only their product counts
    Rgb sigma_a{0};                   ///< what a unit of the way through the coat absorbs
    float alpha = 0;                  ///< roughness of the boundary, 0 to 1: with 0 it is smooth; see `RoughCoat`
    Facets distribution = Facets::beckmann;

    bool smooth() const { return alpha == 0; }
    std::string problem() const;
};

template <>
inline constexpr auto parameters_of<Coat> =
    std::tuple{Parameter{"eta", &Coat::eta, as_relative_index, false},
               Parameter{"specular_reflectance", &Coat::specular_reflectance},
               Parameter{"thickness", &Coat::thickness, ParameterRange{.least = 0, .most = 1e18f}},
               Parameter{"sigma_a", &Coat::sigma_a, ParameterRange{.least = 0, .most = 1e18f}},
               Parameter{"alpha", &Coat::alpha, as_fraction, false}};

inline std::string Coat::problem() const { return parameter_problem(*this); }

namespace detail {

/// A direction outside a coat, and what becomes of its light.
struct CoatEntry {
    Vec3 inside{0};                        ///< unit, on the same side; 0 where nothing gets in
    float transmittance = 0;               ///< of the boundary
    float compression = 0;                 ///< the solid angle inside over that outside
    float coat_probability = 0;            ///< of sampling what the coat reflects, and
    float base_probability = 0;            ///< what is below; both 0 where nothing comes back
    float reflected_over_probability = 0;  ///< the boundary's reflectance over `coat_probability`
};

/// A `Coat` as scenes keep it, with what follows from its parameters. A rough one makes its table, which takes time.
class CoatOptics {
public:
    explicit CoatOptics(const Coat& coat)
        : eta_(coat.eta),
          specular_reflectance_(coat.specular_reflectance),
          absorption_(coat.thickness * coat.sigma_a),
          alpha_(coat.alpha),
          distribution_(coat.distribution),
          specular_mean_(mean(coat.specular_reflectance)),
          straight_through_(mean(glm::exp(-2.0f * absorption_))),
          table_(coat.smooth() ? nullptr : &rough_coat(coat.distribution, coat.alpha, coat.eta)) {}

    bool smooth() const { return table_ == nullptr; }

    /// `outside` is a unit vector on either side.
    [[gnu::noinline]] CoatEntry enter(const Vec3& outside) const {
        const float c = std::abs(outside.z);
        const float q_squared = (eta_ - 1) * (eta_ + 1) + c * c;  // see `fresnel_dielectric`
        float reflectance = 1;
        CoatEntry entry;
        if (c > 0 && eta_ == 1) {
            entry = {.inside = outside, .transmittance = 1, .compression = 1};
            reflectance = 0;
        } else if (c > 0 && q_squared > 0) {
            const float q = std::sqrt(q_squared), inverse = 1 / eta_;
            // What a thinner medium magnifies are rounding errors, too.
            entry.inside =
                normalize(Vec3(outside.x * inverse, outside.y * inverse, std::copysign(q * inverse, outside.z)));
            entry.compression = c / (eta_ * q);
            entry.transmittance = smooth() ? fresnel_dielectric_transmittance(c, eta_) : table_->transmittance(c);
            reflectance = smooth() ? fresnel_dielectric(c, eta_).reflectance : 1 - entry.transmittance;
        }
        // Each by itself: their sum is 1 anyway, and the smaller one keeps its digits.
        const float coat = reflectance * specular_mean_, base = entry.transmittance * straight_through_;
        if (!(coat + base > 0)) return entry;
        entry.coat_probability = coat / (coat + base);
        entry.base_probability = base / (coat + base);
        if (coat > 0) entry.reflected_over_probability = (coat + base) / specular_mean_;
        return entry;
    }

    /// Where light from inside leaves the coat; 0 where it is kept.
    [[gnu::noinline]] Vec3 leave(const Vec3& inside) const {
        if (eta_ == 1) return inside;
        const float inverse = 1 / eta_;
        const float q_squared = (inverse - 1) * (inverse + 1) + inside.z * inside.z;
        if (!(inside.z != 0 && q_squared > 0)) return Vec3(0);
        return normalize(Vec3(eta_ * inside.x, eta_ * inside.y, std::copysign(eta_ * std::sqrt(q_squared), inside.z)));
    }

    /// What of the light arrives that takes these two ways through the coat: both boundaries, and absorption.
    [[gnu::noinline]] Rgb passage(const CoatEntry& a, const CoatEntry& b) const {
        const float both = a.transmittance * b.transmittance;
        if (!(both > 0) || is_black(absorption_)) return Rgb(both);
        return both * glm::exp(-(absorption_ / std::abs(a.inside.z) + absorption_ / std::abs(b.inside.z)));
    }

    /// The model below and the coat, for `base`, which is the former between the two directions inside.
    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi, const CoatEntry& a, const CoatEntry& b,
                                      const BsdfValue& base) const {
        BsdfValue result{base.value * passage(a, b) / (eta_ * eta_), base.pdf * (b.compression * a.base_probability)};
        if (smooth()) return result;
        const BsdfValue coat = reflection(wo, wi);
        result.value += coat.value;
        result.pdf.value += coat.pdf.value * a.coat_probability;
        return result;
    }

    /// What a smooth coat reflects.
    BsdfSample mirrored(const Vec3& wo, const CoatEntry& a) const {
        return {.wi = {-wo.x, -wo.y, wo.z},
                .weight = specular_reflectance_ * a.reflected_over_probability,
                .specular = true};
    }

    /// A direction to which a facet of a rough one reflects; 0 where another stands in its way.
    [[gnu::noinline]] Vec3 reflected(const Vec3& wo, const Vec2& u) const {
        const Vec3 up = on_front(wo);
        if (!(up.z > 0)) return Vec3(0);
        const Vec3 m = Microfacets(distribution_, alpha_, alpha_).sample_visible_normal(up, u);
        const Vec3 wi = 2 * dot(up, m) / length_squared(m) * m - up;
        return wi.z > 0 ? Vec3(wi.x, wi.y, std::copysign(wi.z, wo.z)) : Vec3(0);
    }

    /// Makes the model's sample of a sample of what is below; false where the light is kept inside.
    [[gnu::noinline]] bool leave(const Vec3& wo, const CoatEntry& a, BsdfSample& sample) const {
        const Vec3 wi = leave(sample.wi);
        if (wi.z == 0) return false;
        const CoatEntry b = enter(wi);
        if (!(b.base_probability > 0)) return false;
        sample.wi = wi;
        const Rgb base = sample.weight * passage(a, b);
        if (sample.specular) {
            sample.weight = base / a.base_probability;
            sample.reversal *= b.base_probability / a.base_probability;
            return true;
        }
        const float density = sample.pdf.value * b.compression;
        sample.pdf.value = density * a.base_probability;
        sample.weight = base / a.base_probability;
        if (smooth()) return sample.pdf.value > 0;
        const BsdfValue coat = reflection(wo, wi);
        sample.pdf.value += coat.pdf.value * a.coat_probability;
        if (!(sample.pdf.value > 0)) return false;
        sample.weight = (base * density + coat.value * std::abs(wi.z)) / sample.pdf.value;
        return true;
    }

private:
    static Vec3 on_front(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }
    static float mean(const Rgb& color) { return (color.x + color.y + color.z) / 3; }

    /// What a rough boundary reflects, and the density of `reflected`.
    BsdfValue reflection(const Vec3& wo, const Vec3& wi) const {
        if (!(wo.z * wi.z > 0)) return {};
        const Vec3 half(wo.x + wi.x, wo.y + wi.y, std::abs(wo.z + wi.z));
        const float squared = length_squared(half);
        if (!(squared > 1e-30f)) return {};  // both at the horizon, closer than floats can tell
        const Microfacets facets(distribution_, alpha_, alpha_);
        const float density = facets.distribution(half) / facets.smith_denominator(on_front(wo));
        const float cos_half = std::min(0.5f * std::sqrt(squared), 1.0f);
        const float reflected = fresnel_dielectric(cos_half, eta_).reflectance;
        return {specular_reflectance_ * (reflected * density / facets.smith_denominator(on_front(wi))),
                {0.5f * density}};
    }

    float eta_;
    Rgb specular_reflectance_, absorption_;
    float alpha_;
    Facets distribution_;
    float specular_mean_, straight_through_;
    const RoughCoat* table_;
};

}  // namespace detail

}  // namespace lightswitch
