#pragma once

// What a built scene keeps, by surface model and light.

#include <lightswitch/bsdf/material.hpp>
#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/embree/accelerator.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/light/source.hpp>
#include <lightswitch/scene/description.hpp>
#include <lightswitch/scene/instance.hpp>
#include <lightswitch/scene/light_choice.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

namespace lightswitch {

/// The kinds of light of a scene.
template <Light... L>
struct Lights {};

/// What a scene is made of, in numbers.
struct SceneStatistics {
    std::size_t triangles = 0, spheres = 0, lights = 0, degenerate_triangles = 0;  ///< each once, however often placed
    std::size_t instances = 0;
    std::int64_t embree_bytes = 0, scene_bytes = 0;
    double embree_build_seconds = 0, build_seconds = 0;
    std::size_t tree_lights = 0;  ///< how many lights are chosen by a tree (`LightTree`); 0 where there is none
    std::int64_t light_tree_bytes = 0;
    double light_tree_build_seconds = 0;
    bool robust = false;  ///< whether Embree uses its watertight intersection test
};

namespace detail {

/// What a hit on a triangle mesh needs beyond what Embree says. There is one per mesh and nothing per triangle, so that
/// a hit costs no memory access that is not in a cache already.
struct MeshRecord {
    MaterialIndex material;
    TypedIndex first_light;         ///< of the mesh's triangles, in their order; empty when it does not shine
    float intersection_error;       ///< see `intersection_error`
    std::uint32_t shading_normals;  ///< where its triples of normals begin, or `flat`
    static constexpr std::uint32_t flat = 0xffffffffu;
};

struct SphereRecord {
    Vec3 center;
    float radius;
    float offset;
    float side;  ///< +1 when the front is outside, -1 when inside
    MaterialIndex material;
    TypedIndex light;
};

/// A layer as a scene keeps it. Materials of the kind after the last surface model stand for layers, by their position.
struct LayerRecord {
    enum class Kind { blend, mask, bump_map, normal_map, both_sides, coat };

    Kind kind;
    std::array<MaterialIndex, 2> inner;
    Texture texture{Rgb(0)};
    float scale = 1;  ///< of a bump map in render space, of a normal map across the normal
    bool flips = false, shadows = false, against_v = false;
    bool certain = true;   ///< whether all choices below lead to a model that is not specular
    std::size_t coat = 0;  ///< which one, of a coat
};

/// The point that rays find in a scene of such materials.
template <class... M>
using PointOf = typename std::conditional_t<(PlacedMaterial<M> || ...), std::type_identity<PlacedPoint<M...>>,
                                            std::type_identity<SurfacePoint>>::type;

template <class B, class L>
struct SceneData;

template <class... B, class... L>
struct SceneData<Bsdfs<B...>, Lights<L...>> {
    static constexpr std::array<bool, sizeof...(B)> is_specular{model_of<B>::specular...};  ///< by the kind of material

    std::string name;
    RenderSpace space;
    double radius = 1;                ///< of a sphere around the origin of render space that holds the scene
    std::vector<MeshRecord> meshes;   ///< by Embree's geometry number; the spheres come after them
    std::vector<GroupRecord> groups;  ///< where there are instances; the first one are the shapes that belong to none
    std::vector<std::array<Vec3, 3>> shading_normals;
    std::vector<SphereRecord> spheres;
    // Where materials differ from place to place: texture coordinates, per triangle; where those of each mesh begin, or
    // `flat` for one without; and the axes of the spheres.
    std::vector<std::array<Vec2, 3>> uvs;
    std::vector<std::uint32_t> first_uvs;
    std::vector<Mat3> sphere_axes;
    std::vector<LayerRecord> layers;
    std::vector<CoatOptics> coats;
    bool masked = false;  ///< whether rays can go through a surface because of a `Mask`
    std::tuple<std::vector<B>...> bsdfs;
    std::tuple<std::vector<L>...> lights;
    LightChoice light_choice;  ///< over light numbers, see `Scene::light_number`
    std::vector<Emitter> emitters;
    SceneStatistics statistics;
};

/// Whether a material or a coat has a lobe that is a Dirac distribution.
bool any_dirac_lobe(const auto& data) {
    const auto found = [](const auto& bsdf) { return has_dirac_lobe(bsdf); };
    return std::ranges::any_of(data.coats, &CoatOptics::smooth) ||
           std::apply([&](const auto&... lists) { return (std::ranges::any_of(lists, found) || ...); }, data.bsdfs);
}

/// What scenes with different cameras and instances in other places share.
template <class BsdfList, class LightList>
struct SceneContents;

template <class BsdfList, class... L>
struct SceneContents<BsdfList, Lights<L...>> {
    SceneData<BsdfList, Lights<L...>> data;
    std::array<std::size_t, sizeof...(L) + 1> first_light{};  ///< number of the first light of each kind

    explicit SceneContents(SceneData<BsdfList, Lights<L...>> d) : data(std::move(d)) {
        [[maybe_unused]] std::size_t kind = 0;
        ((first_light[kind + 1] = first_light[kind] + std::get<std::vector<L>>(data.lights).size(), ++kind), ...);
    }
};

}  // namespace detail

}  // namespace lightswitch
