#pragma once

// Scenes from files of meshes: OBJ with its materials, and what has none.

#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/obj_material.hpp>
#include <lightswitch/load/ply.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/load/stl.hpp>
#include <lightswitch/scene/framing.hpp>

namespace lightswitch {

namespace detail {

/// Adds what a scene cannot do without.
inline void complete(LibraryDescription& scene, const Origin& origin, Notices* notices) {
    at_place(origin, [&] { frame_scene(scene); });
    const bool dark = !has_light(scene);
    if (dark) add_default_sky(scene);
    if (notices == nullptr) return;
    notices->push_back(origin.prefix() + "has no camera: one that sees everything is added");
    if (dark) notices->push_back(origin.prefix() + "has no light: a soft sky is added");
}

/// Triangles of a mesh, from `begin` to before `end`.
struct TriangleRun {
    std::size_t begin, end;
};

/// Cuts a mesh into the meshes of some of its triangles each.
class MeshSplitter {
public:
    explicit MeshSplitter(Mesh mesh) : mesh_(std::move(mesh)), numbers_(mesh_.positions.size(), none) {}

    Mesh part(const std::vector<TriangleRun>& runs) {
        if (runs.size() == 1 && runs[0].end - runs[0].begin == mesh_.triangles.size()) return std::move(mesh_);
        Mesh result;
        std::vector<std::uint32_t> used;
        for (const TriangleRun& run : runs)
            for (std::size_t t = run.begin; t < run.end; ++t) {
                auto corners = mesh_.triangles[t];
                for (std::uint32_t& corner : corners) {
                    std::uint32_t& number = numbers_[corner];
                    if (number == none) {
                        number = static_cast<std::uint32_t>(used.size());
                        used.push_back(corner);
                    }
                    corner = number;
                }
                result.triangles.push_back(corners);
            }
        const auto gather = [&](const auto& values, auto& values_of_part) {
            if (values.empty()) return;
            values_of_part.reserve(used.size());
            for (const std::uint32_t corner : used) values_of_part.push_back(values[corner]);
        };
        gather(mesh_.positions, result.positions);
        gather(mesh_.normals, result.normals);
        gather(mesh_.uvs, result.uvs);
        for (const std::uint32_t corner : used) numbers_[corner] = none;
        return result;
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    Mesh mesh_;
    std::vector<std::uint32_t> numbers_;  ///< in the part that is being made
};

class ObjSceneReader {
public:
    ObjSceneReader(const std::filesystem::path& path, Notices* notices) : path_(path), notices_(notices) {}

    LibraryDescription read() {
        ObjContents contents = ObjReader(path_, FileNormals::use, true).read(notices_);
        scene_.name = path_.stem().string();
        scene_.files.push_back(path_.string());
        for (const ObjContents::Name& library : contents.libraries) read_library(library);
        add_shapes(contents);
        mtl_notices_.report(notices_);
        complete(scene_, file_origin(path_), notices_);
        return std::move(scene_);
    }

private:
    Origin place(int line) const { return {path_.string(), line, {}}; }

    /// A statement `mtllib` names one file, perhaps with spaces in its name, or several.
    void read_library(const ObjContents::Name& library) {
        const auto find = [&](std::string_view name) {
            // Each may go through whole folders.
            if (++searches_ > 1000) fail(place(library.line), "asks for more than 1000 searches for material files");
            return find_loosely(name, {path_.parent_path()});
        };
        if (const auto file = find(library.text)) return read_file(*file);
        std::string_view rest = library.text;
        for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest))
            if (const auto file = find(name)) read_file(*file);
            else mtl_notices_.add(place(library.line), "there is no material file " + quote(name));
    }

    void read_file(const std::filesystem::path& file) {
        if (!read_.insert(file.string()).second) return;
        MtlReader(file).read(materials_, mtl_notices_);
        scene_.files.push_back(file.string());
        if (std::find(folders_.begin(), folders_.end(), file.parent_path()) == folders_.end())
            folders_.push_back(file.parent_path());
    }

    void add_shapes(ObjContents& contents) {
        // The last list is of triangles before the first `usemtl`.
        std::vector<std::vector<TriangleRun>> runs(contents.materials.size() + 1);
        std::size_t begin = 0, material = contents.materials.size();
        const auto add_run = [&](std::size_t end) {
            if (end > begin) runs[material].push_back({begin, end});
            begin = end;
        };
        for (const ObjContents::Use& use : contents.uses) {
            add_run(use.first_triangle);
            material = use.material;
        }
        add_run(contents.mesh.triangles.size());

        folders_.insert(folders_.begin(), path_.parent_path());
        ObjMaterials made(folders_, scene_, mtl_notices_);
        const bool has_uvs = !contents.mesh.uvs.empty();
        MeshSplitter splitter(std::move(contents.mesh));
        for (std::size_t i = 0; i < runs.size(); ++i) {
            if (runs[i].empty()) continue;
            if (i == contents.materials.size()) {
                scene_.add(splitter.part(runs[i]), made.grey(), {}, place(0));
                continue;
            }
            const ObjContents::Name& name = contents.materials[i];
            const auto found = materials_.find(name.text);
            ObjMaterials::Made surface;
            if (found != materials_.end()) {
                surface = made.make(found->second);
            } else {
                mtl_notices_.add(place(name.line), "there is no material " + quote(name.text) + ": it is grey");
                surface = {.material = made.grey(), .emission = {}, .emission_texture = {}};
            }
            Origin origin = place(name.line);
            origin.element = "material " + quote(name.text);
            scene_.shapes.push_back({.geometry = splitter.part(runs[i]),
                                     .material = surface.material,
                                     .emission = surface.emission,
                                     .origin = std::move(origin),
                                     .emission_texture = std::move(surface.emission_texture)});
        }
        if (!has_uvs && !made.images().empty())
            mtl_notices_.add(place(0), "has no texture coordinates, but materials with images");
        scene_.files.insert(scene_.files.end(), made.images().begin(), made.images().end());
    }

    std::filesystem::path path_;
    Notices* notices_;
    FileNotices mtl_notices_;
    LibraryDescription scene_;
    MtlReader::Materials materials_;
    std::set<std::string> read_;
    int searches_ = 0;
    std::vector<std::filesystem::path> folders_;
};

}  // namespace detail

template <class Description>
Description load_obj_scene(const std::filesystem::path& path, Notices* notices) {
    return detail::ObjSceneReader(path, notices).read();
}

template <class Description>
Description load_mesh_scene(const std::filesystem::path& path, Notices* notices) {
    const std::string ending = detail::lower_case(path.extension().string());
    const Origin origin = detail::file_origin(path);
    if (ending == ".obj") return load_obj_scene<Description>(path, notices);
    if (ending != ".ply" && ending != ".stl") fail(origin, "is not called .obj, .ply or .stl");
    Description scene;
    scene.name = path.stem().string();
    scene.files.push_back(path.string());
    const std::size_t grey = scene.add(TwoSided{Lambert{.reflectance = Rgb(0.5f)}});
    scene.add(ending == ".ply" ? load_ply(path, FileNormals::use, notices) : load_stl(path, FileNormals::use, notices),
              grey, {}, origin);
    detail::complete(scene, origin, notices);
    return scene;
}

}  // namespace lightswitch
