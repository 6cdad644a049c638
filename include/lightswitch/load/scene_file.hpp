#pragma once

// Readers of scene files: what they are called with. mitsuba.hpp, gltf.hpp and obj_scene.hpp hold them. They are
// templates only so that a program of several files can leave them to one of these (compiled.hpp).

#include <lightswitch/load/problems.hpp>
#include <lightswitch/scene/library.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lightswitch {

/// How a scene file is read.
struct MitsubaOptions {
    std::map<std::string, std::string> defines{};  ///< values of `$name`, before any `<default>`
    Strictness strictness = Strictness::strict;
    std::vector<std::filesystem::path> search_paths{};  ///< where files are that are not beside the scene file
    std::string sensor{};          ///< the id of a `<sensor>`, or its number from 0; empty: the first one
    Notices* notices = nullptr;    ///< gets what was skipped, guessed or upgraded without another image in mind
    Problems* problems = nullptr;  ///< gets what the file asks for and does not get
};

/// Reads a scene file of Mitsuba 3, 2 or 0.x, as the RGB variants of Mitsuba 3 see it; `docs/scene-files.md` lists what
/// is supported. What a file leaves out has Mitsuba's default, but for the clipping planes, which are then at 0 and
/// infinity.
///
/// Throws `UnsupportedScene`, an `Error` whose message is the first problem, with file, line and element, when there is
/// anything that cannot be honoured. A lenient reading goes on with the nearest known thing or none, and throws `Error`
/// only for what is no scene at all: no such file, malformed XML, a sensor that is not there. Thread safe.
template <class Description = LibraryDescription>
Description load_mitsuba(const std::filesystem::path& file, const MitsubaOptions& options);
/// The same, strictly.
template <class Description = LibraryDescription>
Description load_mitsuba(const std::filesystem::path& file, const std::map<std::string, std::string>& defines = {},
                         Notices* notices = nullptr);

/// Reads the scene of a glTF 2.0 file, `.gltf` or `.glb`: that which the file names, or its first; with the files that
/// it names beside it. What of the format means what, docs/scene-files.md says.
///
/// A mesh that several nodes use becomes a group with instances. Where the file has no camera, one that sees all is
/// added, and where nothing shines a sky; `notices` tells, and what is ignored.
///
/// Throws `Error` with file and element (such as "accessors[3]") for anything malformed, for extensions that are
/// required and not known, and when there are no triangles. Memory is in proportion to the files. Thread safe.
template <class Description = LibraryDescription>
Description load_gltf(const std::filesystem::path& file, Notices* notices = nullptr);

/// Reads a Wavefront OBJ file with its materials as a scene: a shape for each material in use, in the order in which
/// the file names them. docs/scene-files.md says what becomes of the statements of material files. Where a name leads
/// to no material, surfaces are grey. Surfaces are the same from both sides, but for glass and for light, which leaves
/// the front only. A camera that sees everything is added, and a soft sky when nothing shines, and `notices` tells.
///
/// Throws `Error` with file and line as `load_obj` does, and for malformed numbers in material files; missing and
/// damaged images and missing material files are only noticed. Thread safe.
template <class Description = LibraryDescription>
Description load_obj_scene(const std::filesystem::path& path, Notices* notices = nullptr);

/// Reads a file of a mesh as a scene by the ending of its name: `load_obj_scene` for `.obj`; from `.ply` and `.stl` a
/// grey object, the same from both sides, with a camera that sees all of it under a soft sky. Throws `Error` for other
/// names and what the readers of the mesh refuse. Thread safe.
template <class Description = LibraryDescription>
Description load_mesh_scene(const std::filesystem::path& path, Notices* notices = nullptr);

}  // namespace lightswitch
