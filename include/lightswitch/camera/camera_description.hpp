#pragma once

// A camera as data: what a file or a program says.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// A camera, with a thin lens when `aperture_radius` is above 0: perspective, or orthographic, whose rays are all
/// parallel.
///
/// In camera space it looks along +z, with +y up in the image and +x to the left (the convention of Mitsuba).
struct CameraDescription {
    enum class Projection { perspective, orthographic };
    enum class FovAxis { x, y, diagonal, smaller, larger };

    Projection projection = Projection::perspective;

    DMat4 to_world{1};     ///< rigid, reflections allowed
    double fov = 39.3077;  ///< full angle in degrees, strictly between 0 and 180
    FovAxis fov_axis = FovAxis::x;
    double half_width = 1;  ///< of an orthographic camera: half the width that the image shows, in scene units
    /// How far the centre of projection lies from the centre of the image to the right and downwards, as fractions of
    /// the image's width and height.
    DVec2 principal_point_offset{0};
    double aperture_radius = 0;  ///< in scene units
    double focus_distance = 1;   ///< along the optical axis, in scene units
    double near_clip = 0;        ///< along the optical axis, in scene units
    double far_clip = std::numeric_limits<double>::infinity();
    Origin origin;

    /// `to_world` of a camera at `eye` that looks at `target` with `up` upwards in the image: its columns are left, up,
    /// forward and `eye`. Throws `Error` when `target` is at `eye`, or `up` has no part across the view.
    static DMat4 look_at(const DVec3& eye, const DVec3& target, const DVec3& up);
};

inline DMat4 CameraDescription::look_at(const DVec3& eye, const DVec3& target, const DVec3& up) {
    const DVec3 view = target - eye;
    if (!(glm::length(view) > 0)) throw Error("the camera looks at its own position: move the target or the eye");
    const DVec3 forward = glm::normalize(view);
    const DVec3 across = glm::cross(up, forward);
    // Below this the direction would be made of rounding errors.
    if (!(glm::length(across) > 1e-12 * glm::length(up)))
        throw Error("the camera's up vector is parallel to its view: give another one");
    const DVec3 left = glm::normalize(across);
    return {glm::dvec4(left, 0), glm::dvec4(glm::cross(forward, left), 0), glm::dvec4(forward, 0), glm::dvec4(eye, 1)};
}

}  // namespace lightswitch
