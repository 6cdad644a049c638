#pragma once

// From a description to the camera of a scene type.

#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/camera/orthographic_camera.hpp>
#include <lightswitch/camera/perspective_camera.hpp>
#include <lightswitch/core/error.hpp>
#include <lightswitch/film/film_description.hpp>
#include <lightswitch/geometry/render_space.hpp>

namespace lightswitch {

/// Every kind of camera that a description can ask for.
using AllCameras = Cameras<PerspectiveCamera, OrthographicCamera>;

namespace detail {

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

}  // namespace detail

}  // namespace lightswitch
