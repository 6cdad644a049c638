#pragma once

// What cameras with a flat film have in common.

#include <lightswitch/camera/camera.hpp>
#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/core/warp.hpp>
#include <lightswitch/film/film_description.hpp>
#include <lightswitch/geometry/render_space.hpp>

namespace lightswitch::detail {

/// Where a camera stands in render space, and its lens. Lengths along the optical axis.
struct CameraBody {
    /// How far away it may be, and how large its lens, as multiples of `radius`. From there a ray was seen to pass
    /// 2.5e-4 of the radius beside where it should, in double; four times as far away that eats up the margin by which
    /// rays begin outside of the scene.
    static constexpr double farthest = 0x1p42;

    DVec3 position, left, up, forward;
    double lens_radius, focus, near, far;
    double far_away_radius;
    bool far_away;  ///< rays start at the scene's bounding sphere

    CameraBody(const CameraDescription& description, const RenderSpace& space, double radius)
        : position(space.point(DVec3(description.to_world[3]))),
          left(glm::normalize(DVec3(description.to_world[0]))),
          up(glm::normalize(DVec3(description.to_world[1]))),
          forward(glm::normalize(DVec3(description.to_world[2]))),
          lens_radius(space.length(description.aperture_radius)),
          focus(space.length(description.focus_distance)),
          near(space.length(description.near_clip)),
          far(space.length(description.far_clip)),
          far_away_radius(radius * 1.001),
          far_away(glm::length(position) > 4 * radius) {
        if (!(radius > 0)) return;  // there is nothing to see
        const auto check = [&](double length, double unit, const std::string& what) {
            if (!(length <= farthest * unit))
                fail(description.origin,
                     what + " (" + number_text(length / unit) + " times; at most " + number_text(farthest) + ")");
        };
        check(glm::length(position), radius, "the camera is too far away beside the size of the scene");
        check(lens_radius, radius, "the camera's aperture is too large beside the size of the scene");
        check(lens_radius, focus, "the camera's aperture is too large beside its focus distance");
    }

    /// The place of the lens that `u` in [0,1)^2 selects, from its centre.
    DVec3 lens_shift(const Vec2& u) const {
        const Vec2 on_lens = concentric_disk(u);
        return lens_radius * (double(on_lens.x) * left + double(on_lens.y) * up);
    }

    bool has_lens() const { return lens_radius > 0; }

    /// How far from the lens, along a ray of this camera, the ray begins.
    double start(const Ray& ray) const {
        return glm::dot(DVec3(ray.origin) - position, forward) / glm::dot(DVec3(ray.direction), forward);
    }

    /// The ray through a place of the lens whose companion through its centre leaves `origin` along `along`, which is 1
    /// long along the axis.
    Ray ray(DVec3 origin, DVec3 along, const Vec2& lens) const {
        if (has_lens()) {
            const DVec3 shift = lens_shift(lens);
            origin += shift;
            along -= shift / focus;
        }
        const double per_axis = glm::length(along);
        const DVec3 direction = along / per_axis;
        double begin = near * per_axis;
        const double end = far * per_axis;
        const double to_center = glm::length(origin);
        if (far_away) begin = std::max(begin, to_center - far_away_radius);
        begin = std::min(begin, to_center + far_away_radius);  // beyond it there is nothing
        const double length = end - begin;
        return {.origin = Vec3(origin + begin * direction),
                .direction = Vec3(direction),
                .near = 0,
                .far = length > 0 ? static_cast<float>(length) : 0.0f};
    }
};

/// The film as a rectangle in a plane across the optical axis.
struct FilmPlane {
    DVec3 corner, step_x, step_y;  ///< top left corner of the image, and what a pixel is to the right and downwards
    double pixel_area;
    int width, height;

    /// Around `center`, before it is cropped `2 * half_width` wide.
    FilmPlane(const CameraBody& body, const DVec3& center, double half_width, const CameraDescription& description,
              const FilmDescription& film)
        : width(film.width), height(film.height) {
        const double half_height = half_width / film.aspect();
        const auto [full_width, full_height] = film.full_size();
        corner = center + half_width * body.left + half_height * body.up;
        step_x = body.left * (-2 * half_width / full_width);
        step_y = body.up * (-2 * half_height / full_height);
        pixel_area = glm::length(step_x) * glm::length(step_y);
        const DVec2 shift =
            DVec2(film.crop_x, film.crop_y) - description.principal_point_offset * DVec2(full_width, full_height);
        corner += shift.x * step_x + shift.y * step_y;
    }

    DVec3 point(const Vec2& pixel) const { return corner + double(pixel.x) * step_x + double(pixel.y) * step_y; }
    /// The pixel of a point of the plane.
    Vec2 pixel(const DVec3& point) const {
        const DVec3 in_plane = point - corner;
        return Vec2(DVec2(glm::dot(in_plane, step_x) / glm::dot(step_x, step_x),
                          glm::dot(in_plane, step_y) / glm::dot(step_y, step_y)));
    }
};

}  // namespace lightswitch::detail
