#pragma once

// Which files are scenes, by the endings of their names, and those that are no Mitsuba scenes.

#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/scene/library.hpp>

#include <string>
#include <string_view>

namespace lightswitch::program {

/// The endings, in words: ".xml (Mitsuba), .gltf, .glb, .obj, .ply or .stl".
std::string scene_endings();

bool is_mitsuba_file(std::string_view path);
/// Whether the name ends like that of any scene file; capitals count as small letters.
bool is_scene_file(std::string_view path);
/// Reads one that is no Mitsuba scene.
LibraryDescription load_other_file(const std::string& path, Notices& notices);

}  // namespace lightswitch::program
