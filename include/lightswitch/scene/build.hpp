#pragma once

// From a description to a scene: every check, then render space, records, lights and Embree.

#include <lightswitch/scene/all_lights.hpp>
#include <lightswitch/scene/build_lights.hpp>
#include <lightswitch/scene/build_materials.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/description.hpp>
#include <lightswitch/scene/near_view.hpp>
#include <lightswitch/scene/rounding.hpp>
#include <lightswitch/scene/scene.hpp>

#include <chrono>

namespace lightswitch {

/// How a scene is built.
struct BuildOptions {
    std::string embree_config = {};  ///< Embree's device string, for example "threads=2"
    /// Embree's watertight test in any case (slower); or else where a mesh has needles, or `is_near_view`.
    bool robust = false;
    std::size_t tree_from = 16;  ///< so many lights with bounds (`BoundedLight`), or more, are chosen by a `LightTree`
};

namespace detail {

template <class BsdfList, class LightList, class CameraList>
class SceneAssembly;

template <class... B, class... L, class CameraList>
class SceneAssembly<Bsdfs<B...>, Lights<L...>, CameraList> {
public:
    using BuiltScene = Scene<Bsdfs<B...>, Lights<L...>, CameraList>;

    explicit SceneAssembly(const BuildOptions& options)
        : device_(std::make_shared<const embree::Device>(options.embree_config)), tree_from_(options.tree_from) {
        data_.statistics.robust = options.robust;
    }

    template <class Material>
    BuiltScene build(const SceneDescription<Material>& description) {
        const auto start = std::chrono::steady_clock::now();
        check(description);
        const std::vector<Bounds> parts = bounds_of_parts(description);
        const Bounds bounds = bounds_around(parts, description.camera);
        data_.name = description.name;
        data_.space = choose_render_space(parts, bounds);
        data_.radius = bounds.radius(data_.space);
        materials_ = detail::MaterialAssembly<typename BuiltScene::Data>(description, data_).indices();
        for (const auto& source : description.sources) add(source.source, source.origin);
        detail::GroupRecord in_place = begin_group(data_.space, bounds);
        for (const auto& shape : description.shapes) add(shape);
        for (const auto& instance : description.instances) add_lights(description.groups[instance.group], instance);
        detail::choose_lights(data_, pending_, tree_from_);
        detail::refuse_dim(data_.emitters, data_.name);
        embree::Accelerator accelerator = end_group(in_place);
        make_robust_if_near(accelerator, in_place.mesh_count, description.camera, data_);
        SceneStatistics& statistics = data_.statistics;
        detail::Placement placement = description.instances.empty()
                                          ? detail::Placement{std::move(accelerator), {}}
                                          : place_instances(description, std::move(in_place), std::move(accelerator));
        statistics.spheres = data_.spheres.size();
        statistics.embree_bytes = device_->memory();
        const auto bytes = [](const auto& list) { return std::int64_t(list.size() * sizeof(list[0])); };
        statistics.scene_bytes = bytes(data_.meshes) + bytes(data_.spheres) + bytes(data_.shading_normals) +
                                 bytes(data_.uvs) + (bytes(std::get<std::vector<L>>(data_.lights)) + ... + 0);
        statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return {std::move(data_), std::move(placement), description.camera, description.film};
    }

private:
    // --- groups

    /// Shapes that are added from now on belong to a group in that space.
    detail::GroupRecord begin_group(const RenderSpace& space, const Bounds& bounds) {
        space_ = space;
        radius_ = bounds.radius(space);
        spheres_.clear();
        accelerator_.emplace(device_);
        return {.first_mesh = static_cast<std::uint32_t>(data_.meshes.size()),
                .mesh_count = 0,
                .first_sphere = static_cast<std::uint32_t>(data_.spheres.size()),
                .space = space,
                .bounds = bounds,
                .accelerator = {}};
    }
    embree::Accelerator end_group(detail::GroupRecord& group) {
        group.mesh_count = static_cast<std::uint32_t>(data_.meshes.size()) - group.first_mesh;
        if (!spheres_.empty()) accelerator_->add(spheres_);
        accelerator_->commit(data_.statistics.robust);
        data_.statistics.embree_build_seconds += accelerator_->build_seconds();
        embree::Accelerator result = std::move(*accelerator_);
        accelerator_.reset();
        return result;
    }

    /// The shapes that belong to no group become one, too, so that only instances are placed.
    detail::Placement place_instances(const auto& description, detail::GroupRecord in_place,
                                      embree::Accelerator accelerator) {
        in_place.accelerator = std::make_shared<const embree::Accelerator>(std::move(accelerator));
        data_.groups.push_back(std::move(in_place));
        std::vector<detail::InstanceRecord> instances{{.in_place = true}};
        std::vector<std::size_t> numbers(description.groups.size());  // 0: not built yet
        for (const auto& instance : description.instances) {
            const auto& group = description.groups[instance.group];
            if (numbers[instance.group] == 0) {
                numbers[instance.group] = data_.groups.size();
                data_.groups.push_back(build_group(group));
            }
            const std::size_t number = numbers[instance.group];
            instances.push_back(detail::InstanceRecord::make(number, data_.groups[number], data_.space,
                                                             instance.to_world, instance.origin));
            instances.back().luminous = std::any_of(group.shapes.begin(), group.shapes.end(),
                                                    [](const auto& shape) { return shape.emission.has_value(); });
        }
        data_.statistics.instances = description.instances.size();
        return detail::Placement::make(data_.groups, std::move(instances));
    }

    detail::GroupRecord build_group(const auto& group) {
        Bounds bounds;
        for (const auto& shape : group.shapes) bounds.include(shape.geometry);
        detail::GroupRecord record = begin_group(RenderSpace(bounds.lower, bounds.upper), bounds);
        for (const auto& shape : group.shapes)
            if (!shape.emission) add(shape);
        record.accelerator = std::make_shared<const embree::Accelerator>(end_group(record));
        return record;
    }

    /// What shines is a light of its own in each place, and so a shape of its own.
    void add_lights(const auto& group, const auto& instance) {
        for (auto shape : group.shapes) {
            if (!shape.emission) continue;
            if (auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
                *mesh = mesh->transformed(instance.to_world);
            } else {
                const auto sphere = std::get<Sphere>(shape.geometry).transformed(instance.to_world);
                if (!sphere)
                    fail(instance.origin, "a luminous sphere must stay one: only the same scale in all directions");
                shape.geometry = *sphere;
            }
            add(shape);
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

    // --- shapes

    void add(const auto& shape) {
        std::visit([&](const auto& geometry) { add(geometry, shape); }, shape.geometry);
    }

    template <class Shape>
    void add(const Mesh& mesh, const Shape& shape) {
        std::vector<Vec3> positions(mesh.positions.size());
        std::transform(mesh.positions.begin(), mesh.positions.end(), positions.begin(),
                       [&](const DVec3& p) { return Vec3(space_.point(p)); });
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
        std::shared_ptr<const Texture> emission_texture;
        if (shape.emission_texture) emission_texture = std::make_shared<const Texture>(*shape.emission_texture);
        Rgb mean_emission(0);
        DVec3 centroid(0);
        double mesh_area = 0, needle_area = 0;
        bool lost = false;
        for (const auto& corners : mesh.triangles) {
            const DVec3 a = positions[corners[0]], b = positions[corners[1]], c = positions[corners[2]];
            const DVec3 cross = glm::cross(b - a, c - a);
            const double twice_area = glm::length(cross);
            if (!(twice_area >= smallest_shape * smallest_shape)) {  // nothing can hit it, and it has no normal
                ++data_.statistics.degenerate_triangles;
                lost = lost || has_area(space_, mesh, corners);
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
                const TriangleLight even{
                    .corner = Vec3(a),
                    .edge1 = Vec3(b - a),
                    .edge2 = Vec3(c - a),
                    .normal = normal,
                    .emission = *shape.emission,
                    .density = {static_cast<float>(1 / area)},
                    .offset = intersection_error(a, b, c, twice_area) + position_error(a, b, c, normal)};
                TypedIndex light;
                if (emission_texture) {
                    const TexturedTriangleLight textured(even, {uv(corners[0]), uv(corners[1]), uv(corners[2])},
                                                         emission_texture);
                    light = add_light(textured, shape.origin);
                    mean_emission += textured.mean() * float(area);
                } else {
                    light = add_light(even, shape.origin);
                }
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
            if (emission_texture) emitter.strength = mean_emission / emitter.area;
            pending_.push_back({record.first_light, emitter.light_count});
            data_.emitters.push_back(emitter);
        }
        if (triangles.empty()) return;
        data_.statistics.robust |= needle_area > 0.01 * mesh_area;
        data_.statistics.triangles += triangles.size();
        accelerator_->add(positions, triangles);
        data_.meshes.push_back(record);
        if (placed) data_.first_uvs.push_back(keep_uvs ? first_uvs : MeshRecord::flat);
    }

    template <class Shape>
    void add(const Sphere& sphere, const Shape& shape) {
        const DVec3 center = space_.point(sphere.center);
        const double radius = space_.length(sphere.radius);
        SphereRecord record{.center = Vec3(center),
                            .radius = float(radius),
                            .offset = sphere_offset(center, radius),
                            .side = sphere.inward ? -1.0f : 1.0f,
                            .material = materials_[shape.material],
                            .light = {}};
        if (!(record.radius >= smallest_shape))
            fail(shape.origin, "the sphere is too small to be seen beside the rest of the scene");
        if (!(glm::length(center) + radius <= 1.001 * radius_))
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

    typename BuiltScene::Data data_;
    std::shared_ptr<const embree::Device> device_;
    std::size_t tree_from_;
    std::vector<MaterialIndex> materials_;
    std::vector<detail::PendingEmitter> pending_;
    std::vector<embree::Accelerator::SphereData> spheres_;
    RenderSpace space_;  // of the group that shapes are being added to, as what follows
    double radius_ = 0;
    std::optional<embree::Accelerator> accelerator_;
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
