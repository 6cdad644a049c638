#pragma once

// From a description to the camera of a scene type.

#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/core/error.hpp>
#include <lightswitch/film/film_description.hpp>
#include <lightswitch/geometry/render_space.hpp>

namespace lightswitch::detail {

/// The first of the kinds that serves the description. Throws `Error` when none does.
template <class CameraType, class First, class... More>
CameraType make_camera(const CameraDescription& description, const FilmDescription& film, const RenderSpace& space,
                       double radius) {
    if constexpr (requires { First::serves(description); })
        if (First::serves(description)) return First(description, film, space, radius);
    if constexpr (sizeof...(More) > 0) return make_camera<CameraType, More...>(description, film, space, radius);
    else
        fail(description.origin,
             "this scene type has no place for that kind of camera; add it to the scene's Cameras<...>");
}

}  // namespace lightswitch::detail
