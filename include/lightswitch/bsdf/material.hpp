#pragma once

// What a scene stores of a surface: a model, or something that gives one at every place.

#include <lightswitch/bsdf/mapped.hpp>
#include <lightswitch/geometry/place.hpp>

#include <variant>
#include <vector>

namespace lightswitch {

/// Gives a surface model at a place: `at(place)`, called once where a ray meets the surface. `problem()` as of `Bsdf`.
/// Implementations must be usable from several threads at once. Optionally `constant()` points to the model (within the
/// material, as `Mapped`) where it is the same everywhere: then nothing is copied.
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

}  // namespace detail

/// The materials of a scene: surface models, or what gives one at every place.
template <class... B>
requires(detail::RequireMaterial<B>::value&&...) struct Bsdfs {
};

/// The surface model of a material.
template <Material M>
using model_of = typename detail::ModelOf<M>::type;

template <PlacedMaterial M>
inline constexpr bool transmits<M> = transmits<model_of<M>>;
/// Of any place, where the material says nothing of it.
template <PlacedMaterial M>
bool has_dirac_lobe(const M& material) {
    if constexpr (requires { material.has_dirac_lobe(); }) return material.has_dirac_lobe();
    else return model_of<M>::specular || partly_specular<model_of<M>>;
}

/// A point on a surface of a scene in which materials differ from place to place, with the model that was found there.
template <class... M>
struct PlacedPoint : SurfacePoint {
    Vec2 uv{0};
    Vec3 tangent{0};                             ///< where u grows, any length; 0 where nothing asks for it
    MaterialIndex outermost;                     ///< the material that the surface has, over all layers
    bool behind = false;                         ///< whether its front is not what the ray met
    std::variant<Mapped<model_of<M>>...> model;  ///< by the kind of the material

    [[gnu::always_inline]] Basis shading_frame() const {
        Basis frame = tangent == Vec3(0) ? Basis(shading_normal) : Basis(shading_normal, tangent);
        turn_to_viewer(frame);
        return frame;
    }
};

namespace detail {

/// The model of a material if it is the same everywhere and the material says so, or else a null pointer.
template <PlacedMaterial M>
[[gnu::always_inline]] inline const Mapped<model_of<M>>* constant_model(const M& material) {
    if constexpr (requires { material.constant(); }) return material.constant();
    else return nullptr;
}

/// The model at a point of a scene with placed materials, whose material is of that kind and is kept in `list`.
template <std::size_t kind, class M>
[[gnu::always_inline]] inline const auto& model_at(const auto& point, const std::vector<M>& list) {
    if constexpr (requires(const M material) { material.constant(); })
        return point.material.varies() ? *std::get_if<kind>(&point.model) : *list[point.material.position()].constant();
    else return *std::get_if<kind>(&point.model);
}

}  // namespace detail

}  // namespace lightswitch
