#pragma once

// What a surface model is: the concept that every one meets, and the values that they exchange.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/maybe.hpp>
#include <lightswitch/core/pdf.hpp>

#include <concepts>
#include <string>
#include <string_view>

namespace lightswitch {

/// What travels along a path: radiance (paths from the camera) or importance (paths from a light). They differ where
/// light is refracted (Veach 1997, section 5.2).
enum class Transport { radiance, importance };

/// What travels the other way along the same path.
constexpr Transport reversed(Transport transport) {
    return transport == Transport::radiance ? Transport::importance : Transport::radiance;
}

/// A BSDF evaluated for one pair of directions.
struct BsdfValue {
    Rgb value{0};         ///< the BSDF in 1/sr, without the cosine
    SolidAnglePdf pdf{};  ///< density with which `sample` chooses that incident direction
};

/// A sampled direction.
struct BsdfSample {
    Vec3 wi{0, 0, 1};       ///< unit, local, away from the surface
    Rgb weight{0};          ///< BSDF * |cosine| / density; for a specular lobe the ratio of the two Dirac distributions
    SolidAnglePdf pdf{};    ///< density of `wi`; 0 for a specular lobe, which has none
    bool specular = false;  ///< true when `wi` comes from a Dirac distribution
    float eta = 1;  ///< relative index of refraction crossed from the side of `wo` to that of `wi`; 1 for reflection
    float reversal =
        1;  ///< of a specular lobe: the probability of choosing it the other way round over that of this way
};

/// The three terms of Phong's model by which the `phong` method shows a surface.
struct PhongTerms {
    Rgb diffuse{0.5f};
    Rgb specular{0};
    float shininess = 32;
};

/// A surface model. Directions are unit vectors in the shading frame (z is the normal), pointing away from the surface;
/// `wo` is where the path comes from and `wi` where it goes. `u` is uniform in the unit cube: by custom x and y choose
/// the direction and z the lobe. Implementations must be usable from several threads at once (no mutable state).
///
/// - `specular`: true when all lobes are Dirac distributions, so that `evaluate` is always zero;
/// - `evaluate(wo, wi, transport)`: BSDF and density for a given pair;
/// - `sample(wo, u, transport)`: a direction, or nothing when light is absorbed;
/// - `problem()`: why the parameters are impossible, in words, or an empty string.
///
/// Optionally
/// - `static constexpr std::string_view name` says what it is called in lists;
/// - `phong()` returns the `PhongTerms` that represent the model;
/// - `albedo()` an `Rgb`, the surface's colour whatever the directions, 0 to 1 (without it that of `phong()`);
/// - `static constexpr bool transmits = true` says that light gets through the surface;
/// - `static constexpr bool partly_specular = true` says that beside smooth lobes there are Dirac distributions: those
///   come from `sample` alone, with a weight that is divided by the probability of the lobe; `evaluate` knows the
///   smooth lobes, and its density integrates to their probability;
/// - `has_dirac_lobe()` says the same of the parameters at hand;
/// - `transmits_light()` is false where light does not get through with the parameters at hand;
/// - `isotropic()` is false when turning the surface around its normal changes something.
template <class B>
concept Bsdf = requires(const B bsdf, const Vec3 direction, const Vec3 u, const Transport transport) {
    { B::specular } -> std::convertible_to<bool>;
    { bsdf.evaluate(direction, direction, transport) } -> std::same_as<BsdfValue>;
    { bsdf.sample(direction, u, transport) } -> std::same_as<Maybe<BsdfSample>>;
    { bsdf.problem() } -> std::convertible_to<std::string>;
};

/// Whether the model says that light gets through the surface.
template <class B>
inline constexpr bool transmits = [] {
    if constexpr (requires { B::transmits; }) return B::transmits;
    else return false;
}();

/// Whether light gets through a surface of this model with its parameters; `transmits` says it of all parameters.
template <class B>
bool transmits_light(const B& bsdf) {
    if constexpr (requires { bsdf.transmits_light(); }) return bsdf.transmits_light();
    else return transmits<B>;
}

/// Whether turning the surface around its normal changes nothing. For others scenes find out where u grows.
template <class B>
bool is_isotropic(const B& bsdf) {
    if constexpr (requires { bsdf.isotropic(); }) return bsdf.isotropic();
    else return true;
}

/// Whether the model has smooth lobes and Dirac distributions.
template <class B>
inline constexpr bool partly_specular = [] {
    if constexpr (requires { B::partly_specular; }) return B::partly_specular;
    else return false;
}();

/// Whether some lobe of this model is a Dirac distribution, with its parameters.
template <class B>
bool has_dirac_lobe(const B& bsdf) {
    if constexpr (requires { bsdf.has_dirac_lobe(); }) return bsdf.has_dirac_lobe();
    else return B::specular || partly_specular<B>;
}

namespace detail {

/// Named for every type that is to be a surface model, so that the compiler says which one is none and what it lacks.
template <class B>
struct RequireBsdf {
    static_assert(
        Bsdf<B>,
        "a surface model needs `static constexpr bool specular`, "
        "`BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport) const`, "
        "`Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport) const` and `std::string problem() const`");
    static constexpr bool value = true;
};

}  // namespace detail

/// Explains a reflectance that is not a fraction, or returns an empty string.
inline std::string reflectance_problem(const char* name, const Rgb& value) {
    for (int c = 0; c < 3; ++c)
        if (!(value[c] >= 0 && value[c] <= 1))
            return std::string(name) + " has a component of " + std::to_string(value[c]) + ", which is outside 0 to 1";
    return {};
}

}  // namespace lightswitch
