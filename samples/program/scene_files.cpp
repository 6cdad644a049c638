#include "scene_files.hpp"

#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/load/text.hpp>

#include <algorithm>
#include <array>

namespace lightswitch::program {
namespace {

enum class Format { none, mitsuba, gltf, mesh };

struct Ending {
    std::string_view text;
    Format format;
};
constexpr std::array<Ending, 6> endings{{{".xml", Format::mitsuba},
                                         {".gltf", Format::gltf},
                                         {".glb", Format::gltf},
                                         {".obj", Format::mesh},
                                         {".ply", Format::mesh},
                                         {".stl", Format::mesh}}};

Format format_of(std::string_view path) {
    const std::string name = detail::lower_case(path);
    const auto found =
        std::find_if(endings.begin(), endings.end(), [&](const Ending& ending) { return name.ends_with(ending.text); });
    return found == endings.end() ? Format::none : found->format;
}

}  // namespace

std::string scene_endings() {
    std::string words;
    for (const Ending& ending : endings) {
        if (&ending == &endings.back()) words += " or ";
        else if (&ending != &endings.front()) words += ", ";
        words += ending.text;
        if (ending.format == Format::mitsuba) words += " (Mitsuba)";
    }
    return words;
}

bool is_mitsuba_file(std::string_view path) { return format_of(path) == Format::mitsuba; }

bool is_scene_file(std::string_view path) { return format_of(path) != Format::none; }

LibraryDescription load_other_file(const std::string& path, Notices& notices) {
    return format_of(path) == Format::gltf ? load_gltf(path, &notices) : load_mesh_scene(path, &notices);
}

}  // namespace lightswitch::program
