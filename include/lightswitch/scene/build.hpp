#pragma once

// From a description to a scene: every check, then render space, records, lights and Embree.

#include <lightswitch/light/sphere_light.hpp>
#include <lightswitch/light/triangle_light.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/description.hpp>
#include <lightswitch/scene/rounding.hpp>
#include <lightswitch/scene/scene.hpp>

#include <chrono>
#include <numeric>

namespace lightswitch {

/// Every kind of light that a description can ask for.
using AllLights =
    Lights<ConstantEnvironment, MappedEnvironment, DirectionalLight, PointLight, SpotLight, SphereLight, TriangleLight>;

/// How a scene is built.
struct BuildOptions {
    std::string embree_config;  ///< Embree's device string, for example "threads=2"
    bool robust = false;        ///< Embree's watertight test in any case (slower); otherwise only if a mesh has needles
};

namespace detail {

template <class BsdfList, class LightList, class CameraList>
class SceneAssembly;

template <class... B, class... L, class CameraList>
class SceneAssembly<Bsdfs<B...>, Lights<L...>, CameraList> {
public:
    using BuiltScene = Scene<Bsdfs<B...>, Lights<L...>, CameraList>;

    explicit SceneAssembly(const BuildOptions& options) : accelerator_(options.embree_config) {
        data_.statistics.robust = options.robust;
    }

    template <class Material>
    BuiltScene build(const SceneDescription<Material>& description) {
        const auto start = std::chrono::steady_clock::now();
        check(description);
        const Bounds bounds = find_bounds(description);
        data_.name = description.name;
        data_.space = RenderSpace(bounds.lower, bounds.upper);
        data_.radius = glm::length(data_.space.point(bounds.upper));
        for (const auto& material : description.materials) add(material.bsdf, material.two_sided, material.origin);
        for (const auto& source : description.sources) add(source.source, source.origin);
        for (const auto& shape : description.shapes)
            std::visit([&](const auto& geometry) { add(geometry, shape); }, shape.geometry);
        finish_lights();
        if (!spheres_.empty()) accelerator_.add(spheres_);
        accelerator_.commit(data_.statistics.robust);
        auto& statistics = data_.statistics;
        statistics.spheres = data_.spheres.size();
        statistics.embree_bytes = accelerator_.memory();
        statistics.embree_build_seconds = accelerator_.build_seconds();
        statistics.scene_bytes = static_cast<std::int64_t>(
            data_.meshes.size() * sizeof(MeshRecord) + data_.spheres.size() * sizeof(SphereRecord) +
            data_.shading_normals.size() * sizeof(data_.shading_normals[0]) + data_.uvs.size() * sizeof(data_.uvs[0]) +
            ((std::get<std::vector<L>>(data_.lights).size() * sizeof(L)) + ... + 0));
        statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return {std::move(data_), std::move(accelerator_), description.camera, description.film};
    }

private:
    // --- materials

    template <class... M>
    void add(const std::variant<M...>& material, bool two_sided, const Origin& origin) {
        std::visit([&](const auto& bsdf) { add(bsdf, two_sided, origin); }, material);
    }
    template <Material M>
    void add(const M& material, bool two_sided, const Origin& origin) {
        constexpr std::size_t itself = index_of<M, B...>();
        // Or what can be made of it, such as `Textured<M>`.
        constexpr std::size_t kind =
            itself < sizeof...(B) ? itself : first_of<std::is_constructible_v<B, const M&>...>();
        if constexpr (kind == sizeof...(B)) {
            fail(origin, "this scene type has no place for that surface model; add it to the scene's Bsdfs<...>");
        } else {
            auto& list = std::get<kind>(data_.bsdfs);
            check_count(list.size(), MaterialIndex::max_position, origin, "surface models");
            materials_.emplace_back(kind, list.size(), two_sided);
            list.emplace_back(material);
        }
    }

    // --- lights

    template <class NewLight>
    TypedIndex add_light(const NewLight& light, const Origin& origin) {
        constexpr std::size_t kind = index_of<NewLight, L...>();
        if constexpr (kind == sizeof...(L)) {
            no_place_for_light(origin);
        } else {
            auto& list = std::get<kind>(data_.lights);
            check_count(list.size(), TypedIndex::max_position, origin, "lights");
            const TypedIndex index(kind, list.size());
            list.push_back(light);
            return index;
        }
    }

    [[noreturn]] static void no_place_for_light(const Origin& origin) {
        fail(origin, "this scene type has no place for that kind of light; add it to the scene's Lights<...>");
    }

    void add(const Source& source, const Origin& origin) {
        const auto take = [&](const void* light, const Emitter& emitter) {
            const bool known = ((source.light_type() == typeid(L) &&
                                 (pending_.push_back({add_light(*static_cast<const L*>(light), origin), 1}), true)) ||
                                ...);
            if (!known) no_place_for_light(origin);
            data_.emitters.push_back(emitter);
        };
        source.make(data_.space, data_.radius, origin, take);
    }

    /// Numbers the lights and decides how often each is chosen: half by power, half evenly among the emitters, because
    /// a dim light may be the one that matters where it is near. Within an emitter its lights are chosen by power.
    void finish_lights() {
        std::vector<double> powers;
        (append_powers(std::get<std::vector<L>>(data_.lights), powers), ...);
        data_.statistics.lights = powers.size();
        const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
        if (!(total > 0)) return;
        const std::size_t counts[] = {std::get<std::vector<L>>(data_.lights).size()..., 0};
        std::vector<double> weights(powers.size());
        for (std::size_t i = 0; i < pending_.size(); ++i) {
            std::size_t first = pending_[i].light.position();
            for (std::size_t kind = 0; kind < pending_[i].light.kind(); ++kind) first += counts[kind];
            Emitter& emitter = data_.emitters[i];
            emitter.first_light = first;
            emitter.light_count = pending_[i].count;
            const auto begin = powers.begin() + std::ptrdiff_t(first);
            const double power = std::accumulate(begin, begin + std::ptrdiff_t(emitter.light_count), 0.0);
            for (std::size_t light = first; light < first + emitter.light_count; ++light)
                if (power > 0) weights[light] = powers[light] * (1 / total + 1 / (power * double(pending_.size())));
        }
        data_.light_choice = DiscreteDistribution(weights);
    }
    template <class OneLight>
    static void append_powers(const std::vector<OneLight>& lights, std::vector<double>& powers) {
        for (const OneLight& light : lights) powers.push_back(light.power());
    }

    // --- shapes

    template <class Shape>
    void add(const Mesh& mesh, const Shape& shape) {
        std::vector<Vec3> positions(mesh.positions.size());
        std::transform(mesh.positions.begin(), mesh.positions.end(), positions.begin(),
                       [&](const DVec3& p) { return Vec3(data_.space.point(p)); });
        std::vector<std::array<std::uint32_t, 3>> triangles;
        triangles.reserve(mesh.triangles.size());
        MeshRecord record{.material = materials_[shape.material],
                          .first_light = {},
                          .intersection_error = 0,
                          .shading_normals = MeshRecord::flat};
        constexpr bool placed = BuiltScene::placed;
        const bool keep_uvs = placed && !mesh.uvs.empty();
        const auto first_uvs = static_cast<std::uint32_t>(data_.uvs.size());
        if (!mesh.normals.empty()) record.shading_normals = static_cast<std::uint32_t>(data_.shading_normals.size());
        Emitter emitter{.strength = shape.emission.value_or(Rgb(0))};
        DVec3 centroid(0);
        double mesh_area = 0, needle_area = 0;
        bool lost = false;
        for (const auto& corners : mesh.triangles) {
            const DVec3 a = positions[corners[0]], b = positions[corners[1]], c = positions[corners[2]];
            const DVec3 cross = glm::cross(b - a, c - a);
            const double twice_area = glm::length(cross);
            if (!(twice_area >= smallest_shape * smallest_shape)) {  // nothing can hit it, and it has no normal
                ++data_.statistics.degenerate_triangles;
                lost = lost || has_area(mesh, corners);
                continue;
            }
            triangles.push_back(corners);
            mesh_area += twice_area;
            if (slenderness(a, b, c, twice_area) > needle_slenderness) needle_area += twice_area;
            record.intersection_error = std::max(record.intersection_error, intersection_error(a, b, c, twice_area));
            if (!mesh.normals.empty())
                data_.shading_normals.push_back({Vec3(glm::normalize(mesh.normals[corners[0]])),
                                                 Vec3(glm::normalize(mesh.normals[corners[1]])),
                                                 Vec3(glm::normalize(mesh.normals[corners[2]]))});
            const auto uv = [&](std::uint32_t i) { return i < mesh.uvs.size() ? mesh.uvs[i] : Vec2(0); };
            if (keep_uvs) data_.uvs.push_back({uv(corners[0]), uv(corners[1]), uv(corners[2])});
            if (shape.emission) {
                const double area = twice_area / 2;
                const Vec3 normal(cross / twice_area);
                const TypedIndex light = add_light(
                    TriangleLight{.corner = Vec3(a),
                                  .edge1 = Vec3(b - a),
                                  .edge2 = Vec3(c - a),
                                  .normal = normal,
                                  .emission = *shape.emission,
                                  .density = {static_cast<float>(1 / area)},
                                  .offset = intersection_error(a, b, c, twice_area) + position_error(a, b, c, normal)},
                    shape.origin);
                if (emitter.light_count++ == 0) record.first_light = light;
                centroid += (a + b + c) * (area / 3);
                emitter.vector_area += normal * float(area);
                emitter.area += float(area);
            }
        }
        if (triangles.empty() && lost)
            fail(shape.origin, "the mesh is too small to be seen beside the rest of the scene");
        if (shape.emission) {
            if (!(emitter.area > 0)) fail(shape.origin, "the light has no area");
            emitter.position = Vec3(centroid / double(emitter.area));
            pending_.push_back({record.first_light, emitter.light_count});
            data_.emitters.push_back(emitter);
        }
        if (triangles.empty()) return;
        data_.statistics.robust |= needle_area > 0.01 * mesh_area;
        data_.statistics.triangles += triangles.size();
        accelerator_.add(positions, triangles);
        data_.meshes.push_back(record);
        if (placed) data_.first_uvs.push_back(keep_uvs ? first_uvs : MeshRecord::flat);
    }

    template <class Shape>
    void add(const Sphere& sphere, const Shape& shape) {
        const DVec3 center = data_.space.point(sphere.center);
        const double radius = data_.space.length(sphere.radius);
        SphereRecord record{.center = Vec3(center),
                            .radius = float(radius),
                            .offset = sphere_offset(center, radius),
                            .side = sphere.inward ? -1.0f : 1.0f,
                            .material = materials_[shape.material],
                            .light = {}};
        if (!(record.radius >= smallest_shape))
            fail(shape.origin, "the sphere is too small to be seen beside the rest of the scene");
        if (!(glm::length(center) + radius <= 1.001 * data_.radius))
            fail(shape.origin,
                 "the sphere is so far from the origin that its radius is lost in the rounding of its coordinates");
        if (shape.emission) {
            record.light = add_light(
                SphereLight{record.center, record.radius, sphere.inward, *shape.emission, record.offset}, shape.origin);
            pending_.push_back({record.light, 1});
            data_.emitters.push_back(
                {.strength = *shape.emission, .position = record.center, .area = 4 * pi * square(record.radius)});
        }
        data_.spheres.push_back(record);
        if (BuiltScene::placed) data_.sphere_axes.push_back(Mat3(glm::transpose(sphere.axes)));
        spheres_.push_back({record.center, record.radius});
    }

    /// Whether the triangle has an area before its corners become floats.
    bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) const {
        const auto corner = [&](std::size_t i) { return data_.space.point(mesh.positions[corners[i]]); };
        return glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) > 0;
    }

    struct PendingEmitter {
        TypedIndex light;
        std::size_t count;
    };

    typename BuiltScene::Data data_;
    std::vector<MaterialIndex> materials_;
    std::vector<PendingEmitter> pending_;
    std::vector<embree::Accelerator::SphereData> spheres_;
    embree::Accelerator accelerator_;
};

}  // namespace detail

/// Builds a scene of the given type, for example `build_scene<Bsdfs<Lambert>, Lights<TriangleLight>>(description)`.
///
/// Throws `Error`, naming the place in the file if there is one, when something in the description is impossible or
/// when the type has no room for it. Beside what Embree takes the scene keeps 36 bytes per triangle with interpolated
/// normals and 24 per triangle with texture coordinates in a scene type with materials that use them, and nothing per
/// flat one.
template <class BsdfList, class LightList = AllLights, class CameraList = AllCameras, class Material>
Scene<BsdfList, LightList, CameraList> build_scene(const SceneDescription<Material>& description,
                                                   const BuildOptions& options = {}) {
    return detail::SceneAssembly<BsdfList, LightList, CameraList>(options).build(description);
}

}  // namespace lightswitch
