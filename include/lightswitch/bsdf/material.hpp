#pragma once

// What a scene stores of a surface: a model, or something that gives one at every place.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/geometry/place.hpp>

#include <variant>

namespace lightswitch {

/// Gives a surface model at a place: `at(place)`, called once where a ray meets the surface. `problem()` as of `Bsdf`.
/// Implementations must be usable from several threads at once.
template <class M>
concept PlacedMaterial = !Bsdf<M> && requires(const M material, const Place place) {
    requires Bsdf<std::remove_cvref_t<decltype(material.at(place))>>;
    { material.problem() } -> std::convertible_to<std::string>;
};

/// What a scene can store: one surface model everywhere, or one at every place.
template <class M>
concept Material = Bsdf<M> || PlacedMaterial<M>;

namespace detail {

template <class M>
struct ModelOf {
    using type = M;
};
template <PlacedMaterial M>
struct ModelOf<M> {
    using type = std::remove_cvref_t<decltype(std::declval<const M&>().at(std::declval<const Place&>()))>;
};

/// Named for every type that is to be a material, so that the compiler says which one is none and what it lacks.
template <class M>
struct RequireMaterial {
    static constexpr bool value = [] {
        if constexpr (PlacedMaterial<M>) return true;
        else return RequireBsdf<M>::value;
    }();
};

/// Nothing for a plain model, which the scene has anyway.
template <class M>
using KeptModel = std::conditional_t<PlacedMaterial<M>, typename ModelOf<M>::type, std::monostate>;

}  // namespace detail

/// The surface model of a material.
template <Material M>
using model_of = typename detail::ModelOf<M>::type;

template <PlacedMaterial M>
inline constexpr bool transmits<M> = transmits<model_of<M>>;

/// A point on a surface of a scene in which materials differ from place to place, with the model that was found there.
template <class... M>
struct PlacedPoint : SurfacePoint {
    Vec2 uv{0};
    std::variant<detail::KeptModel<M>...> model;  ///< by the kind of the material
};

namespace detail {

/// The model of a point whose material is of that kind.
template <std::size_t kind>
[[gnu::always_inline]] inline const auto& model_at(const auto& point) {
    return *std::get_if<kind>(&point.model);
}

}  // namespace detail

}  // namespace lightswitch
