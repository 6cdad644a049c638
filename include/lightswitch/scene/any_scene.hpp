#pragma once

// A scene whose type is chosen at run time: the smallest of a few that holds what a description needs.

#include <lightswitch/scene/build.hpp>
#include <lightswitch/scene/library.hpp>

#include <algorithm>
#include <optional>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <variant>

namespace lightswitch {

using DiffuseBsdfs = Bsdfs<Lambert>;

/// Diffuse surfaces, luminous triangles.
using DiffuseScene = Scene<DiffuseBsdfs, Lights<TriangleLight>>;
/// Everything that the library has, but textures.
using FullScene = Scene<AllBsdfs, AllLights>;
/// Everything that the library has.
using TexturedScene = Scene<TexturedBsdfs, AllLights>;

/// The scene types that a file can become. One `std::visit` per render chooses among them. Each costs a compilation of
/// every method, so only types that make renders more than 5 % faster are here (`bench/dispatch`).
using AnyScene = std::variant<DiffuseScene, FullScene, TexturedScene>;

/// What the program prints for each alternative of `AnyScene`.
inline std::string_view scene_type_name(const AnyScene& scene) {
    constexpr std::string_view names[] = {"diffuse: Scene<Bsdfs<Lambert>, Lights<TriangleLight>>",
                                          "full: Scene<AllBsdfs, AllLights>",
                                          "textured: Scene<TexturedBsdfs, AllLights>"};
    static_assert(std::size(names) == std::variant_size_v<AnyScene>);
    return names[scene.index()];
}

namespace detail {

template <class SceneType>
class Capacity;

template <class... B, class... L, class... C>
class Capacity<Scene<Bsdfs<B...>, Lights<L...>, Cameras<C...>>> {
public:
    static bool holds(const LibraryDescription& scene) {
        for (const auto& material : scene.materials)
            if (material.layer ? !takes_layers : !holds_model(material.bsdf)) return false;
        for (const auto& placed : scene.sources)
            if (!((placed.source.light_type() == typeid(L)) || ...)) return false;
        if (!(C::serves(scene.camera) || ...)) return false;
        const auto holds_shape = [](const auto& shape) {
            if (!shape.emission) return true;
            if (shape.emission_texture) return is_one_of<TexturedTriangleLight, L...>;
            const bool sphere = std::holds_alternative<Sphere>(shape.geometry);
            return sphere ? is_one_of<SphereLight, L...> : is_one_of<TriangleLight, L...>;
        };
        const auto holds_group = [&](const auto& group) {
            return std::all_of(group.shapes.begin(), group.shapes.end(), holds_shape);
        };
        return std::all_of(scene.shapes.begin(), scene.shapes.end(), holds_shape) &&
               std::all_of(scene.groups.begin(), scene.groups.end(), holds_group);
    }

private:
    static constexpr bool takes_layers = (PlacedMaterial<B> || ...);

    static bool holds_model(const AnyMaterial& material) {
        if constexpr (takes_layers) return (material.get<B>() || ...) || (material.get<model_of<B>>() || ...);
        else return material.isotropic() && (material.get<B>() || ...);
    }
};

template <class SceneType>
struct BuildAs;

template <class BsdfList, class LightList, class CameraList>
struct BuildAs<Scene<BsdfList, LightList, CameraList>> {
    static auto build(const auto& description, const BuildOptions& options) {
        return build_scene<BsdfList, LightList, CameraList>(description, options);
    }
};

}  // namespace detail

/// `build_scene` by the name of the scene's type: `build_as<FullScene>(description)`.
template <class SceneType, class Material>
SceneType build_as(const SceneDescription<Material>& description, const BuildOptions& options = {}) {
    return detail::BuildAs<SceneType>::build(description, options);
}

/// Builds the first of the alternatives, all of which are scenes, that can hold the description, or else the last.
/// Throws like `build_scene`.
template <class Variant = AnyScene>
Variant build_any(const LibraryDescription& description, const BuildOptions& options = {}) {
    std::optional<Variant> scene;
    const auto try_as = [&]<class SceneType>(std::type_identity<SceneType>, bool is_last) {
        if (is_last || detail::Capacity<SceneType>::holds(description))
            scene.emplace(build_as<SceneType>(description, options));
        return scene.has_value();
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (try_as(std::type_identity<std::variant_alternative_t<I, Variant>>(), I + 1 == sizeof...(I)) || ...);
    }
    (std::make_index_sequence<std::variant_size_v<Variant>>());
    return std::move(*scene);
}

}  // namespace lightswitch
