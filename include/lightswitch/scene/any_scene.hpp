#pragma once

// A scene whose type is chosen at run time: the smallest of a few that holds what a description needs.

#include <lightswitch/scene/build.hpp>
#include <lightswitch/scene/library.hpp>

#include <string_view>
#include <variant>

namespace lightswitch {

using DiffuseBsdfs = Bsdfs<Lambert, TwoSided<Lambert>>;
using AllBsdfs = Bsdfs<Lambert, TwoSided<Lambert>, Conductor, TwoSided<Conductor>, RoughConductor,
                       TwoSided<RoughConductor>, Dielectric>;

/// Diffuse surfaces, luminous triangles.
using DiffuseScene = Scene<DiffuseBsdfs, Lights<TriangleLight>>;
/// The same under an environment.
using DiffuseSkyScene = Scene<DiffuseBsdfs, Lights<ConstantEnvironment, TriangleLight>>;
/// Everything that the library has.
using FullScene = Scene<AllBsdfs, AllLights>;

/// The scene types that a file can become. One `std::visit` per render chooses among them.
using AnyScene = std::variant<DiffuseScene, DiffuseSkyScene, FullScene>;

/// What the program prints for each alternative of `AnyScene`.
inline std::string_view scene_type_name(const AnyScene& scene) {
    constexpr std::string_view names[] = {"diffuse: Scene<Bsdfs<Lambert, TwoSided<Lambert>>, Lights<TriangleLight>>",
                                          "diffuse-sky: Scene<Bsdfs<Lambert, TwoSided<Lambert>>, "
                                          "Lights<ConstantEnvironment, TriangleLight>>",
                                          "full: Scene<AllBsdfs, AllLights>"};
    static_assert(std::size(names) == std::variant_size_v<AnyScene>);
    return names[scene.index()];
}

namespace detail {

template <class BsdfList, class LightList>
struct Capacity;

template <class... B, class... L>
struct Capacity<Bsdfs<B...>, Lights<L...>> {
    static bool holds(const LibraryDescription& scene) {
        for (const auto& material : scene.materials)
            if (!std::visit([](const auto& bsdf) { return contains<std::remove_cvref_t<decltype(bsdf)>, B...>; },
                            material.bsdf))
                return false;
        for (const auto& placed : scene.sources) {
            if (std::holds_alternative<PointSource>(placed.source) && !contains<PointLight, L...>) return false;
            if (std::holds_alternative<DirectionalSource>(placed.source) && !contains<DirectionalLight, L...>)
                return false;
            if (std::holds_alternative<EnvironmentSource>(placed.source) && !contains<ConstantEnvironment, L...>)
                return false;
        }
        for (const auto& shape : scene.shapes) {
            if (!shape.emission) continue;
            const bool sphere = std::holds_alternative<Sphere>(shape.geometry);
            if (sphere ? !contains<SphereLight, L...> : !contains<TriangleLight, L...>) return false;
        }
        return true;
    }
};

}  // namespace detail

/// Builds the smallest of the alternatives of `AnyScene` that can hold the description. Throws like `build_scene`.
inline AnyScene build_any(const LibraryDescription& description, const BuildOptions& options = {}) {
    if (detail::Capacity<DiffuseBsdfs, Lights<TriangleLight>>::holds(description))
        return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description, options);
    if (detail::Capacity<DiffuseBsdfs, Lights<ConstantEnvironment, TriangleLight>>::holds(description))
        return build_scene<DiffuseBsdfs, Lights<ConstantEnvironment, TriangleLight>>(description, options);
    return build_scene<AllBsdfs, AllLights>(description, options);
}

}  // namespace lightswitch
