#pragma once

// A camera that hands move, and its text.

#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/film/film_description.hpp>

#include <string>

namespace lightswitch::program {

/// A camera that turns around a pivot in front of it. It always has a rigid `to_world`, and keeps what it does not
/// move: lens, clipping, projection. Lengths are in scene units.
class CameraControl {
public:
    CameraControl() = default;
    /// The pivot is on the optical axis, at that distance, which is above 0.
    CameraControl(const CameraDescription& start, double pivot_distance);

    const CameraDescription& description() const { return camera_; }
    /// How many times something was moved: what has seen that number has seen this camera.
    std::uint64_t changes() const { return changes_; }

    /// Around the pivot by angles in radians: the camera goes to the left and up. It stops short of the poles.
    void orbit(double left, double up);
    /// What is seen moves to the right and down; a step of 1 is the width that the image shows at the pivot.
    void pan(double right, double down);
    /// Multiplies the distance to the pivot, or what an orthographic camera shows.
    void dolly(double factor);
    /// Moves camera and pivot along its axes: to the right, up, forward, as multiples of the distance to the pivot.
    void fly(double right, double up, double forward);
    /// Multiplies the tangent of half the field of view, which stays between 1 and 170 degrees.
    void widen(double factor);
    /// Back to the start.
    void reset();

private:
    DVec3 pivot() const;
    double width_at_pivot() const;
    void turn_to(const DVec3& forward, const DVec3& pivot);

    CameraDescription start_, camera_;
    double start_distance_ = 1, distance_ = 1;
    DVec3 upwards_{0, 1, 0};  // the world's axis that is up in the image at first
    std::uint64_t changes_ = 0;
};

/// A `<sensor>` of Mitsuba's files, with its film. Reading it again gives the same camera, bit for bit, but for the
/// turn of an orthographic one, which has a scale in it.
std::string camera_xml(const CameraDescription& camera, const FilmDescription& film);
/// The description as an initialiser in C++.
std::string camera_code(const CameraDescription& camera, const FilmDescription& film);

}  // namespace lightswitch::program
