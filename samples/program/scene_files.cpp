#include "scene_files.hpp"

#include <lightswitch/load/scene_file.hpp>

#include <algorithm>
#include <array>

namespace lightswitch::program {
namespace {

bool ends_with(std::string_view path, std::string_view ending) {
    return path.size() >= ending.size() &&
           std::equal(ending.begin(), ending.end(), path.end() - std::ptrdiff_t(ending.size()),
                      [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

bool is_gltf(std::string_view path) { return ends_with(path, ".gltf") || ends_with(path, ".glb"); }

}  // namespace

bool is_mitsuba_file(std::string_view path) { return ends_with(path, ".xml"); }

bool is_scene_file(std::string_view path) {
    constexpr std::array<std::string_view, 3> meshes{".obj", ".ply", ".stl"};
    return is_mitsuba_file(path) || is_gltf(path) ||
           std::any_of(meshes.begin(), meshes.end(), [&](std::string_view ending) { return ends_with(path, ending); });
}

LibraryDescription load_other_file(const std::string& path, Notices& notices) {
    return is_gltf(path) ? load_gltf(path, &notices) : load_mesh_scene(path, &notices);
}

}  // namespace lightswitch::program
