#pragma once

// From the words on the command line to a built scene.

#include "program.hpp"

#include <lightswitch/method/roulette.hpp>
#include <lightswitch/scene/any_scene.hpp>

namespace lightswitch::program {

/// What a scene was described with: all that the program wants to know of a description, whose meshes are not kept.
struct SceneSummary {
    CameraDescription camera;
    Size size;
    std::optional<int> max_depth, rr_depth, samples;
    std::size_t meshes = 0, luminous_meshes = 0, luminous_spheres = 0;
    std::size_t environments = 0, point_lights = 0, spot_lights = 0, directional_lights = 0;
    std::map<std::string, std::size_t> materials;  ///< by kind
    std::vector<std::filesystem::path> files;      ///< that were read
    std::optional<float> exposure;                 ///< stops that the scene asks for
    std::vector<std::string> stand_ins;            ///< what was not as the scene file says, a line each
};

struct LoadedScene {
    SceneSummary summary;
    AnyScene scene;
};

/// Whether there are warnings of stand-ins, or the summary alone tells of them.
enum class StandIns { warn, keep };

/// Reads and builds the scene, warns of stand-ins, and unless `quiet` of what its files hold that is skipped or
/// guessed. Throws `Error` for whatever is wrong with it; that of a strict reading says how to go on.
LoadedScene load_scene(const SceneOptions& options, bool quiet = false, StandIns tell = StandIns::warn);

/// How long paths may become: as the command line says, or else the scene, or else as usual.
PathLength path_length(const SceneSummary& summary, const std::optional<int>& max_depth,
                       const std::optional<int>& rr_depth);

/// Tells in the image's metadata what stood in for what the scene file says, so that a format which holds them does.
void keep_stand_ins(Image& image, const SceneSummary& summary);

/// A box in scene units.
struct Box {
    DVec3 lower, upper;
};
/// The box around all surfaces; nothing when there are none.
std::optional<Box> bounds(const AnyScene& scene);

}  // namespace lightswitch::program
