#pragma once

// glTF 2.0 scenes, where the build has tinygltf (LIGHTSWITCH_HAS_GLTF is 1 and it is linked).

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/gltf_material.hpp>
#include <lightswitch/load/gltf_mesh.hpp>
#include <lightswitch/load/gltf_view.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/scene/framing.hpp>
#include <lightswitch/scene/library.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace lightswitch {

#if LIGHTSWITCH_HAS_GLTF

namespace detail {

/// Reads one glTF file: its nodes, and what they place.
class GltfReader {
public:
    explicit GltfReader(const std::filesystem::path& path)
        : file_(path, notices_), meshes_(file_), materials_(file_, scene_) {
        scene_.name = path.stem().string();
    }

    LibraryDescription read(Notices* notices) {
        visit(roots());
        for (auto& [mesh, places] : places_) place(mesh, places);
        if (scene_.shapes.empty() && scene_.instances.empty()) fail(file_.origin(), "has no triangles in its scene");
        if (!has_camera_) {
            notices_.add(file_.origin(), "there is no camera: one that sees all is added");
            scene_.film = gltf_film(16.0 / 9, file_.origin());
            at_place(file_.origin(), [&] { frame_scene(scene_); });
        }
        if (!has_light(scene_)) {
            notices_.add(file_.origin(), "there is no light: a sky is added");
            add_default_sky(scene_);
        }
        scene_.files = file_.files();
        notices_.report(notices);
        return std::move(scene_);
    }

private:
    using Shape = LibraryDescription::Shape;

    struct Place {
        DMat4 to_world;
        Origin origin;
    };

    std::vector<int> roots() {
        const tinygltf::Model& model = file_.model();
        if (!model.scenes.empty()) {
            const int number = model.defaultScene == -1 ? 0 : model.defaultScene;
            const auto& scene = file_.element(model.scenes, number, "scenes", file_.origin());
            if (model.scenes.size() > 1)
                notices_.add(file_.origin("scenes", static_cast<std::size_t>(number)),
                             "of the file's " + std::to_string(model.scenes.size()) + " scenes only this one is read");
            return scene.nodes;
        }
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const auto& node : model.nodes)
            for (const int child : node.children)
                if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                    is_child[static_cast<std::size_t>(child)] = true;
        std::vector<int> result;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) result.push_back(static_cast<int>(i));
        return result;
    }

    void visit(const std::vector<int>& roots) {
        constexpr int deepest = 1024;
        struct Visit {
            int node;
            DMat4 parent;
            int depth;
            Origin user;
        };
        std::vector<Visit> pending;
        const auto push = [&](const std::vector<int>& nodes, const DMat4& parent, int depth, const Origin& user) {
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
                pending.push_back({*node, parent, depth, user});
        };
        push(roots, DMat4(1), 1, file_.origin());
        std::vector<bool> seen(file_.model().nodes.size(), false);
        while (!pending.empty()) {
            const Visit next = std::move(pending.back());
            pending.pop_back();
            const auto& node = file_.element(file_.model().nodes, next.node, "nodes", next.user);
            const auto number = static_cast<std::size_t>(next.node);
            const Origin where = file_.origin("nodes", number);
            if (seen[number]) fail(where, "is below itself, or below two others: nodes must form trees");
            seen[number] = true;
            if (next.depth > deepest) fail(where, "is below more than " + std::to_string(deepest) + " others");
            const DMat4 to_world = next.parent * local_transform(node, where);
            for (int column = 0; column < 4; ++column)
                check_position(DVec3(to_world[column]), where, "the transform of the node");
            visit(node, to_world, where);
            push(node.children, to_world, next.depth + 1, where);
        }
    }

    void visit(const tinygltf::Node& node, const DMat4& to_world, const Origin& where) {
        if (node.mesh != -1) {
            file_.element(file_.model().meshes, node.mesh, "meshes", where);
            places_[node.mesh].push_back({to_world, where});
        }
        if (node.skin != -1) notices_.add(where, "a skin is ignored: the mesh is as it is without");
        if (node.camera != -1 && !std::exchange(has_camera_, true))
            read_gltf_camera(file_, node.camera, to_world, where, scene_);
        if (const auto* light = gltf_extension(node.extensions, "KHR_lights_punctual"))
            read_gltf_light(file_, gltf_index(*light, "light"), to_world, where, scene_);
    }

    static DMat4 local_transform(const tinygltf::Node& node, const Origin& where) {
        const auto wrong = [&](const std::vector<double>& values, std::size_t count) {
            return !values.empty() && values.size() != count;
        };
        if (wrong(node.matrix, 16) || wrong(node.translation, 3) || wrong(node.rotation, 4) || wrong(node.scale, 3))
            fail(where, "has a transform with the wrong count of numbers");
        DMat4 result(1);
        if (!node.matrix.empty()) {
            for (std::size_t i = 0; i < 16; ++i)
                result[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
            if (!is_affine(result)) fail(where, "has a matrix that is not affine");
            return result;
        }
        if (!node.rotation.empty()) {
            const DVec3 v(node.rotation[0], node.rotation[1], node.rotation[2]);
            const double w = node.rotation[3], squared = glm::dot(v, v) + w * w;
            if (!(squared > 0) || !is_finite(squared)) fail(where, "has a rotation that is none");
            const double s = 2 / squared;
            result[0] = {1 - s * (v.y * v.y + v.z * v.z), s * (v.x * v.y + w * v.z), s * (v.x * v.z - w * v.y), 0};
            result[1] = {s * (v.x * v.y - w * v.z), 1 - s * (v.x * v.x + v.z * v.z), s * (v.y * v.z + w * v.x), 0};
            result[2] = {s * (v.x * v.z + w * v.y), s * (v.y * v.z - w * v.x), 1 - s * (v.x * v.x + v.y * v.y), 0};
        }
        for (std::size_t i = 0; i < node.scale.size(); ++i) result[static_cast<int>(i)] *= node.scale[i];
        for (std::size_t i = 0; i < node.translation.size(); ++i) result[3][static_cast<int>(i)] = node.translation[i];
        return result;
    }

    /// Puts a mesh where nodes want it: as shapes of its own, or as a group where several do.
    void place(int mesh, std::vector<Place>& places) {
        constexpr double most = 1e12;      // beyond, normals would be rounding errors
        constexpr double instances = 100;  // what is squeezed more is not precise as an instance
        std::erase_if(places, [&](const Place& place) {
            const bool flat = !(squeeze(DMat3(place.to_world)) < most);
            if (flat) notices_.add(place.origin, "a mesh that is scaled to nothing is skipped");
            return flat;
        });
        if (places.empty()) return;
        std::vector<Shape> shapes = read_shapes(mesh);
        if (shapes.empty()) return;
        const auto group = scene_.groups.size();
        std::vector<LibraryDescription::Instance> placed;
        for (const Place& place : places) {
            if (places.size() > 1 && squeeze(DMat3(place.to_world)) <= instances) {
                placed.push_back({group, place.to_world, place.origin});
                continue;
            }
            for (Shape& shape : shapes) {
                Mesh& local = std::get<Mesh>(shape.geometry);
                if (places.size() > 1) meshes_.spend(3 * local.triangles.size(), place.origin);
                Mesh placed_mesh = places.size() > 1 ? local.transformed(place.to_world)
                                                     : std::move(local).transformed(place.to_world);
                scene_.shapes.push_back(
                    {std::move(placed_mesh), shape.material, shape.emission, shape.origin, shape.emission_texture});
            }
        }
        if (placed.empty()) return;
        scene_.groups.push_back({std::move(shapes), file_.origin("meshes", static_cast<std::size_t>(mesh))});
        std::move(placed.begin(), placed.end(), std::back_inserter(scene_.instances));
    }

    /// The primitives of a mesh, in its own coordinates.
    std::vector<Shape> read_shapes(int number) {
        const auto& mesh = file_.model().meshes[static_cast<std::size_t>(number)];
        const Origin where = file_.origin("meshes", static_cast<std::size_t>(number));
        std::vector<Shape> shapes;
        for (const auto& primitive : mesh.primitives) {
            auto geometry = meshes_.read(primitive, where);
            if (!geometry) continue;
            const GltfSurface& surface = materials_.of(primitive.material, where);
            if (surface.textured && geometry->uvs.empty()) geometry->uvs.push_back(Vec2(0));
            shapes.push_back(
                {std::move(*geometry), surface.material, surface.emission, where, surface.emission_texture});
        }
        return shapes;
    }

    FileNotices notices_;
    GltfFile file_;
    LibraryDescription scene_;
    GltfMeshes meshes_;
    GltfMaterials materials_;
    std::map<int, std::vector<Place>> places_;  ///< by mesh
    bool has_camera_ = false;
};

}  // namespace detail

#endif

template <class Description>
Description load_gltf(const std::filesystem::path& file, [[maybe_unused]] Notices* notices) {
#if LIGHTSWITCH_HAS_GLTF
    return detail::GltfReader(file).read(notices);
#else
    fail(detail::file_origin(file), "this program was built without tinygltf, which reads glTF");
#endif
}

}  // namespace lightswitch
