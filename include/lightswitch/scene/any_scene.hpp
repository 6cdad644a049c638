#pragma once

// A scene whose type is chosen at run time: the smallest of a few that holds what a description needs.

#include <lightswitch/scene/build.hpp>
#include <lightswitch/scene/library.hpp>

#include <string_view>
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
    /// Of scene types without placed materials.
    static bool holds(const LibraryDescription& scene) {
        for (const auto& material : scene.materials)
            if (material.layer || !std::visit([](const auto& bsdf) { return holds_model(bsdf); }, material.bsdf))
                return false;
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
    template <class Model>
    static bool holds_model(const Model& model) {
        if constexpr (!is_one_of<Model, B...>) return false;
        else if constexpr (Bsdf<Model>) return is_isotropic(model);
        else return true;
    }
};

}  // namespace detail

/// Builds the smallest of the alternatives of `AnyScene` that can hold the description. Throws like `build_scene`.
inline AnyScene build_any(const LibraryDescription& description, const BuildOptions& options = {}) {
    if (detail::Capacity<DiffuseScene>::holds(description))
        return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description, options);
    if (detail::Capacity<FullScene>::holds(description)) return build_scene<AllBsdfs, AllLights>(description, options);
    return build_scene<TexturedBsdfs, AllLights>(description, options);
}

}  // namespace lightswitch
