#pragma once

// Surface models with one mistake.

#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/mapped.hpp>
#include <lightswitch/bsdf/rough_conductor.hpp>

namespace lightswitch::test {

enum class BsdfMistake {
    none,
    // of PlantedLambert
    cosine_doubled,         ///< in the weight of samples, whose density has it already
    inverse_pi_missing,     ///< in the value
    channels_swapped,       ///< red for blue
    value_half_percent_up,  ///< but not the weight of samples
    // of PlantedDielectric
    fresnel_in_weight,    ///< although the lobe was chosen by it
    radiance_unscaled,    ///< by the index of refraction, as if it were importance
    refraction_reversed,  ///< the index of refraction of the other side
    // of PlantedRoughConductor
    jacobian_missing,           ///< of the half vector, in the density
    jacobian_missing_in_value,  ///< the same where `evaluate` gives the density, not where `sample` does
    masking_one_sided,          ///< that of the direction of the light is missing
    // of PlantedCoat
    coat_spreads_nothing,    ///< light below keeps its radiance although it leaves through a larger solid angle
    coat_absorbs_one_way,    ///< only what comes in
    coat_density_of_inside,  ///< where `evaluate` gives it, not where `sample` does
    // of Coated
    lobe_shares_number,  ///< with the direction
};

/// `Lambert` with a mistake.
struct PlantedLambert {
    static constexpr bool specular = false;

    BsdfMistake mistake = BsdfMistake::none;
    Rgb reflectance{0.5f};

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        BsdfValue result = right().evaluate(wo, wi, transport);
        if (mistake == BsdfMistake::inverse_pi_missing) result.value *= pi;
        if (mistake == BsdfMistake::value_half_percent_up) result.value *= 1.005f;
        return result;
    }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        Maybe<BsdfSample> result = right().sample(wo, u, transport);
        if (mistake == BsdfMistake::cosine_doubled) result->weight *= result->wi.z;
        return result;
    }

    std::string problem() const { return right().problem(); }

private:
    Lambert right() const {
        return mistake == BsdfMistake::channels_swapped ? Lambert{{reflectance.z, reflectance.y, reflectance.x}}
                                                        : Lambert{reflectance};
    }
};

/// `Dielectric` with a mistake.
struct PlantedDielectric {
    static constexpr bool specular = true;

    BsdfMistake mistake = BsdfMistake::none;
    float eta = 1.5f;

    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (mistake == BsdfMistake::radiance_unscaled) transport = Transport::importance;
        const float used = mistake == BsdfMistake::refraction_reversed ? 1 / eta : eta;
        Maybe<BsdfSample> result = Dielectric{.eta = used}.sample(wo, u, transport);
        if (result && mistake == BsdfMistake::fresnel_in_weight) {
            const float reflectance = fresnel_dielectric(wo.z, used).reflectance;
            result->weight *= wo.z * result->wi.z > 0 ? reflectance : 1 - reflectance;
        }
        return result;
    }

    std::string problem() const { return Dielectric{.eta = eta}.problem(); }
};

/// `RoughConductor` of perfect mirrors as microfacets, with a mistake. The weight is written as it is defined: value
/// times cosine over density.
struct PlantedRoughConductor {
    static constexpr bool specular = false;

    BsdfMistake mistake = BsdfMistake::none;
    float alpha = 0.5f;

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        return value(wo, wi, transport, mistake == BsdfMistake::jacobian_missing_in_value);
    }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        Maybe<BsdfSample> result = right().sample(wo, u, transport);
        if (!result) return result;
        const BsdfValue here = value(wo, result->wi, transport, false);
        if (!(here.pdf.value > 0)) return {};
        result->pdf = here.pdf;
        result->weight = here.value * (result->wi.z / here.pdf.value);
        return result;
    }

    std::string problem() const { return right().problem(); }

private:
    RoughConductor right() const { return {.distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha}; }

    BsdfValue value(const Vec3& wo, const Vec3& wi, Transport transport, bool without_jacobian) const {
        BsdfValue result = right().evaluate(wo, wi, transport);
        // From half vectors to directions the density falls by 4 times the cosine between the two.
        if (without_jacobian || mistake == BsdfMistake::jacobian_missing)
            result.pdf.value *= 4 * dot(wo, normalize(wo + wi));
        if (mistake == BsdfMistake::masking_one_sided && wi.z > 0)
            result.value *= 1 / Microfacets(Facets::ggx, alpha, alpha).masking(wi);
        return result;
    }
};

/// `Lambert` under a `Coat`, with a mistake.
struct PlantedCoat {
    static constexpr bool specular = false;
    static constexpr bool partly_specular = true;
    static constexpr Lambert base{Rgb(0.7f)};
    static constexpr Coat coat{.eta = 1.5f, .sigma_a = {0.1f, 0.3f, 0.6f}};

    BsdfMistake mistake = BsdfMistake::none;

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        BsdfValue result = right().evaluate(wo, wi, transport);
        result.value *= factor(wo);
        if (mistake == BsdfMistake::coat_density_of_inside)
            result.pdf.value *= coat.eta * coat.eta * inside(wi) / std::abs(wi.z);
        return result;
    }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        Maybe<BsdfSample> result = right().sample(wo, u, transport);
        if (result && !result->specular) result->weight *= factor(wo);
        return result;
    }

    std::string problem() const { return coat.problem(); }

private:
    static Mapped<Lambert> right() {
        static const detail::CoatOptics optics(coat);
        return {base, {.active = true}, &optics};
    }
    /// The cosine below.
    static float inside(const Vec3& w) { return std::sqrt(coat.eta * coat.eta - (1 - w.z) * (1 + w.z)) / coat.eta; }
    Rgb factor(const Vec3& wo) const {
        if (mistake == BsdfMistake::coat_spreads_nothing) return Rgb(coat.eta * coat.eta);
        if (mistake == BsdfMistake::coat_absorbs_one_way) return glm::exp(coat.thickness * coat.sigma_a / inside(wo));
        return Rgb(1);
    }
};

/// A metal film that covers half of a diffuse ground: two lobes, of which one is chosen per sample.
struct Coated {
    static constexpr bool specular = false;

    BsdfMistake mistake = BsdfMistake::none;

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const BsdfValue a = ground.evaluate(wo, wi, transport), b = film.evaluate(wo, wi, transport);
        return {0.5f * (a.value + b.value), {0.5f * (a.pdf.value + b.pdf.value)}};
    }

    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        const float choice = mistake == BsdfMistake::lobe_shares_number ? u.x : u.z;
        Maybe<BsdfSample> result = choice < 0.5f ? ground.sample(wo, u, transport) : film.sample(wo, u, transport);
        if (!result) return result;
        const BsdfValue both = evaluate(wo, result->wi, transport);
        if (!(both.pdf.value > 0)) return {};
        result->pdf = both.pdf;
        result->weight = both.value * (result->wi.z / both.pdf.value);
        return result;
    }

    std::string problem() const { return {}; }

private:
    static constexpr Lambert ground{Rgb(0.7f)};
    static constexpr RoughConductor film{.distribution = Facets::ggx, .alpha_u = 0.3f, .alpha_v = 0.3f};
};

}  // namespace lightswitch::test
