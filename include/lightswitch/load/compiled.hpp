#pragma once

// For programs of several files: the readers of scene files, compiled in one place, as compiled.hpp one folder up is
// about scenes and methods. That place includes this header and says `LIGHTSWITCH_COMPILE_LOADERS`; all other files
// include scene_file.hpp alone.

#include <lightswitch/load/gltf.hpp>
#include <lightswitch/load/mitsuba.hpp>
#include <lightswitch/load/obj_scene.hpp>

/// Compiles the readers of scene files here.
#define LIGHTSWITCH_COMPILE_LOADERS                                                                                    \
    namespace lightswitch {                                                                                            \
    template LibraryDescription load_mitsuba<LibraryDescription>(const std::filesystem::path&, const MitsubaOptions&); \
    template LibraryDescription load_mitsuba<LibraryDescription>(const std::filesystem::path&,                         \
                                                                 const std::map<std::string, std::string>&, Notices*); \
    template LibraryDescription load_gltf<LibraryDescription>(const std::filesystem::path&, Notices*);                 \
    template LibraryDescription load_obj_scene<LibraryDescription>(const std::filesystem::path&, Notices*);            \
    template LibraryDescription load_mesh_scene<LibraryDescription>(const std::filesystem::path&, Notices*);           \
    }
