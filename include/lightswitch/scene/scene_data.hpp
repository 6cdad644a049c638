#pragma once

// What a built scene keeps, by surface model and light.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/core/table.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/scene/description.hpp>

#include <array>
#include <string>
#include <tuple>
#include <vector>

namespace lightswitch {

/// The surface models of a scene.
template <class... B>
requires(detail::RequireBsdf<B>::value&&...) struct Bsdfs {
};
/// The kinds of light of a scene.
template <Light... L>
struct Lights {};

/// One luminous shape or source, summed up for methods that treat it as one light.
struct Emitter {
    enum class Kind { environment, directional, point, surface };

    Kind kind = Kind::surface;
    Rgb strength{0};      ///< radiance; of a point its intensity (render space), of a directional source its irradiance
    Vec3 position{0};     ///< point, or centroid of a surface (render space)
    Vec3 direction{0};    ///< unit, towards a directional source
    Vec3 vector_area{0};  ///< of a surface: sum of normal * area (render space)
    float area = 0;       ///< of a surface
    std::size_t first_light = 0, light_count = 0;  ///< numbers of the lights that belong to it

    /// Whether no ray can meet it by chance.
    bool dirac() const { return kind == Kind::directional || kind == Kind::point; }
};

/// What a scene is made of, in numbers.
struct SceneStatistics {
    std::size_t triangles = 0, spheres = 0, lights = 0, degenerate_triangles = 0;
    std::int64_t embree_bytes = 0, scene_bytes = 0;
    double embree_build_seconds = 0, build_seconds = 0;
    bool robust = false;  ///< whether Embree uses its watertight intersection test
};

namespace detail {

/// What a hit on a triangle mesh needs beyond what Embree says. There is one per mesh and nothing per triangle, so that
/// a hit costs no memory access that is not in a cache already.
struct MeshRecord {
    TypedIndex material;
    TypedIndex first_light;         ///< of the mesh's triangles, in their order; empty when it does not shine
    float intersection_error;       ///< see `SceneAssembly::intersection_error`
    std::uint32_t shading_normals;  ///< where its triples of normals begin, or `flat`
    static constexpr std::uint32_t flat = 0xffffffffu;
};

struct SphereRecord {
    Vec3 center;
    float radius;
    float offset;
    float side;  ///< +1 when the front is outside, -1 when inside
    TypedIndex material;
    TypedIndex light;
};

template <class B, class L>
struct SceneData;

template <class... B, class... L>
struct SceneData<Bsdfs<B...>, Lights<L...>> {
    std::string name;
    std::string camera_id;
    RenderSpace space;
    FilmDescription film;
    std::vector<MeshRecord> meshes;  ///< by Embree's geometry number; the spheres come after them
    std::vector<std::array<Vec3, 3>> shading_normals;
    std::vector<SphereRecord> spheres;
    std::tuple<std::vector<B>...> bsdfs;
    std::tuple<std::vector<L>...> lights;
    DiscreteDistribution light_choice;  ///< over light numbers, see `Scene::light_number`
    std::vector<Emitter> emitters;
    SceneStatistics statistics;
};

}  // namespace detail

}  // namespace lightswitch
