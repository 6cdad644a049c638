#pragma once

// A scene as data: what a file or a program says, before anything is checked, scaled or built.

#include <lightswitch/bsdf/material.hpp>
#include <lightswitch/bsdf/two_sided.hpp>
#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/film/film_description.hpp>
#include <lightswitch/light/constant_environment.hpp>
#include <lightswitch/light/directional_light.hpp>
#include <lightswitch/light/environment_map.hpp>
#include <lightswitch/light/point_light.hpp>
#include <lightswitch/light/spot_light.hpp>
#include <lightswitch/scene/material_layer.hpp>
#include <lightswitch/scene/shapes.hpp>

#include <concepts>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lightswitch {

/// A scene whose surfaces are described by `Material`: `AnyMaterial` (see `LibraryDescription`), one BSDF type, or a
/// `std::variant` of several.
template <class Material>
struct SceneDescription {
    struct Shape {
        std::variant<Mesh, Sphere> geometry;
        std::size_t material = 0;     ///< index into `materials`
        std::optional<Rgb> emission;  ///< radiance that the front emits, W/(m^2 sr)
        Origin origin;
        std::optional<Texture> emission_texture{};  ///< of a mesh: what `emission` is multiplied by, by place
    };
    struct NamedMaterial {
        Material bsdf;
        Origin origin;
        bool two_sided = false;                ///< the back looks like the front
        std::optional<MaterialLayer> layer{};  ///< stands in the place of `bsdf`
    };
    /// Shapes in coordinates of their own, which are seen where instances place them, any number of times.
    struct Group {
        std::vector<Shape> shapes;
        Origin origin;
    };
    struct Instance {
        std::size_t group = 0;  ///< index into `groups`
        DMat4 to_world{1};      ///< affine, with an inverse
        Origin origin;
    };
    struct PlacedSource {
        Source source;
        Origin origin;
    };

    std::string name = "scene";
    std::vector<NamedMaterial> materials;
    std::vector<Shape> shapes;
    std::vector<Group> groups;
    std::vector<Instance> instances;
    std::vector<PlacedSource> sources;
    CameraDescription camera;
    FilmDescription film;
    std::optional<int> max_depth;  ///< what the file asks of a method, if it does
    std::optional<int> rr_depth;
    std::optional<int> samples;      ///< samples per pixel that the file asks for
    std::optional<float> exposure;   ///< stops, of pictures, that the file asks for
    std::vector<std::string> files;  ///< what was read: the scene's file and those of its meshes

    [[gnu::noinline]] std::size_t add(Material bsdf, Origin origin = {}) {
        materials.emplace_back(std::move(bsdf), std::move(origin));
        return materials.size() - 1;
    }
    template <class Bsdf>
    [[gnu::noinline]] std::size_t add(TwoSided<Bsdf> both, Origin origin = {}) {
        materials.emplace_back(std::move(both.inner), std::move(origin), true);
        return materials.size() - 1;
    }
    [[gnu::noinline]] std::size_t add(MaterialLayer layer, Origin origin = {}) {
        materials.emplace_back(Material(), std::move(origin), false, std::move(layer));
        return materials.size() - 1;
    }
    void add(std::variant<Mesh, Sphere> geometry, std::size_t material, std::optional<Rgb> emission = {},
             Origin origin = {}) {
        shapes.push_back({std::move(geometry), material, emission, std::move(origin)});
    }
    /// What is neither a material nor anything else that a scene has: says what a surface model lacks.
    template <class M>
    requires(!std::convertible_to<M, Material> && !std::convertible_to<M, MaterialLayer> &&
             !std::convertible_to<M, std::variant<Mesh, Sphere>> && !Light<M> && !LightSource<M>) std::size_t
        add(const M&, Origin = {}) {
        static_assert(detail::RequireMaterial<M>::value);
        static_assert(!lightswitch::Material<M>, "the materials of this description are of other types");
        return 0;
    }
    /// A light that is no source: says what it lacks.
    template <Light L>
    requires(!LightSource<L>) void add(const L&, Origin = {}) {
        static_assert(LightSource<L>,
                      "a light in a description also needs `light(const RenderSpace& space, double radius) const`, "
                      "which gives the light in render space (LightSource): positions there are space.point(...)");
    }
    void add(Source source, Origin origin = {}) { sources.push_back({source, std::move(origin)}); }
};

}  // namespace lightswitch
