#pragma once

// For programs of several files: the library's own scene types and methods, compiled in one place. All files that use
// them include this header, and one says
//
//     #include <lightswitch/compiled.hpp>
//     LIGHTSWITCH_COMPILE_SCENES
//     LIGHTSWITCH_COMPILE_METHOD(PathTracerNee)
//
// with a line for each method below, or some do so for some of them each. What is missing is an error of the linker;
// scenes and methods of one's own are compiled where they are used, as ever. In CMake, the target lightswitch::compiled
// is such a place, where this project is a part of another (add_subdirectory, FetchContent).

#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

#define LIGHTSWITCH_SCENES_(HOW)                                                                                       \
    namespace lightswitch {                                                                                            \
    HOW DiffuseScene build_scene<DiffuseBsdfs, Lights<TriangleLight>>(const LibraryDescription&, const BuildOptions&); \
    HOW FullScene build_scene<AllBsdfs, AllLights>(const LibraryDescription&, const BuildOptions&);                    \
    HOW TexturedScene build_scene<TexturedBsdfs, AllLights>(const LibraryDescription&, const BuildOptions&);           \
    }

#define LIGHTSWITCH_METHOD_(HOW, METHOD)      \
    namespace lightswitch {                   \
    HOW class Session<DiffuseScene, METHOD>;  \
    HOW class Session<FullScene, METHOD>;     \
    HOW class Session<TexturedScene, METHOD>; \
    }

/// Compiles the building of `DiffuseScene`, `FullScene` and `TexturedScene` here.
#define LIGHTSWITCH_COMPILE_SCENES LIGHTSWITCH_SCENES_(template)
/// Compiles that method of `AnyMethod`, on those scenes, here.
#define LIGHTSWITCH_COMPILE_METHOD(METHOD) LIGHTSWITCH_METHOD_(template, METHOD)

LIGHTSWITCH_SCENES_(extern template)
LIGHTSWITCH_METHOD_(extern template, Silhouette)
LIGHTSWITCH_METHOD_(extern template, Phong)
LIGHTSWITCH_METHOD_(extern template, PathTracer)
LIGHTSWITCH_METHOD_(extern template, PathTracerNee)
LIGHTSWITCH_METHOD_(extern template, LightTracer)
LIGHTSWITCH_METHOD_(extern template, Bdpt)
LIGHTSWITCH_METHOD_(extern template, PhotonMapping)
LIGHTSWITCH_METHOD_(extern template, Vcm)
LIGHTSWITCH_METHOD_(extern template, Mlt)
LIGHTSWITCH_METHOD_(extern template, PathGuided)
