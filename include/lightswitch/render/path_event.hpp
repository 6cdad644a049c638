#pragma once

// What happened on the way to a sample.

#include <lightswitch/core/math.hpp>

#include <cstdint>
#include <string_view>

namespace lightswitch {

/// How a contribution to a pixel was found.
enum class Finding {
    light_met,        ///< the path has met a light
    environment_met,  ///< it has left the scene
    light_sampled,    ///< a point of a light was chosen (next event estimation)
    connected,        ///< a vertex of a path from the camera and one of a path from a light see each other
    seen,             ///< the camera sees a vertex of a path from a light: a splat
    merged,           ///< photons near the vertex
    ambient,          ///< light that is taken to be everywhere (Phong)
    other,            ///< the method does not tell, or it is a flat colour
};

constexpr std::string_view name(Finding how) {
    switch (how) {
        case Finding::light_met: return "light met";
        case Finding::environment_met: return "environment met";
        case Finding::light_sampled: return "light sampled";
        case Finding::connected: return "connected";
        case Finding::seen: return "seen by camera";
        case Finding::merged: return "photons merged";
        case Finding::ambient: return "ambient light";
        default: return "not told";
    }
}

/// One thing that happened, in the order in which it did. Positions are in scene units, directions along the scene's
/// axes. Which members mean something depends on the kind.
struct PathEvent {
    enum class Kind {
        camera,        ///< a path leaves the camera: `from`, `direction`, `film`
        light,         ///< a path leaves a light: `from`, `direction`, `throughput`, `light`
        surface,       ///< the path meets a surface: `from`, `position`, `normal`, `direction` and what it is
        escape,        ///< it meets nothing; `position` is where it is far outside of the scene
        scatter,       ///< it leaves the vertex: `direction`, `pdf`, `throughput`, `survival`
        shadow,        ///< do two points see each other? `from`, `position` (of the blocker, if any), `blocked`
        contribution,  ///< added to the pixel's sample: `value`, `weight`, `how`
        splat,         ///< added to the pixels around `film`: likewise; `here` if ours is one, and then what it got
        sample,        ///< the pixel's function has returned: `value` is the sum of the contributions before
    };
    Kind kind = Kind::camera;
    bool of_light = false;   ///< of a path from a light
    int vertex = 0;          ///< where the path is: segments from its begin
    std::uint64_t path = 0;  ///< of a splat: the number of the light path, or the pixel whose path it was

    DVec3 from{0}, position{0};
    DVec3 normal{0};     ///< geometric, unit, on the front side
    DVec3 direction{0};  ///< unit
    std::string_view surface = {},
                     light = {};  ///< surface model, and kind of light if it is one; empty: not known, or none
    std::uint64_t shape = 0, primitive = 0;  ///< numbers from 1, as of `ShapeNumber`; 0: not known

    double pdf = 0;         ///< of the direction, per solid angle; 0 of a Dirac lobe
    bool specular = false;  ///< by a Dirac lobe
    Rgb throughput{0};      ///< what the path carries; before roulette
    float survival = 1;     ///< of roulette: the probability of going on, by which what the path carries is divided
    bool survived = true;
    bool blocked = false;

    Finding how = Finding::other;
    int light_vertices = 0, camera_vertices = 0;  ///< of the whole path: Veach's s and t; 0: not told
    /// By multiple importance sampling, which is in `value` already. Photons have one each: then it is 1.
    float weight = 1;
    Rgb value{0};
    DVec2 film{0};     ///< columns and rows from the top left corner
    bool here = true;  ///< whether the value arrives at the pixel in question
};

constexpr std::string_view name(PathEvent::Kind kind) {
    switch (kind) {
        case PathEvent::Kind::camera: return "camera";
        case PathEvent::Kind::light: return "light";
        case PathEvent::Kind::surface: return "surface";
        case PathEvent::Kind::escape: return "escape";
        case PathEvent::Kind::scatter: return "scatter";
        case PathEvent::Kind::shadow: return "shadow";
        case PathEvent::Kind::contribution: return "contribution";
        case PathEvent::Kind::splat: return "splat";
        default: return "sample";
    }
}

}  // namespace lightswitch
