#pragma once

// The camera of a built scene.

#include <lightswitch/core/maybe.hpp>
#include <lightswitch/core/warp.hpp>
#include <lightswitch/geometry/ray.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/scene/description.hpp>

namespace lightswitch {

/// A perspective camera, with a thin lens if it has an aperture, in render space. Immutable.
///
/// When the camera is far from the scene its rays start at the scene's bounding sphere, a point found in double
/// precision: a float has too few digits for an origin far away.
class Camera {
public:
    /// How far away it may be, and how large its lens, as multiples of `radius`. From there a ray was seen to pass
    /// 2.5e-4 of the radius beside where it should, in double; four times as far away that eats up the margin by which
    /// rays begin outside of the scene.
    static constexpr double farthest = 0x1p42;

    /// `radius` bounds the geometry around the origin of render space. Throws `Error` when that cannot be seen from
    /// where the camera is.
    Camera(const CameraDescription& description, const FilmDescription& film, const RenderSpace& space, double radius)
        : far_away_radius_(radius * 1.001),
          space_(space),
          lens_radius_(space.length(description.aperture_radius)),
          focus_(space.length(description.focus_distance)),
          near_(space.length(description.near_clip)),
          far_(space.length(description.far_clip)) {
        const auto& m = description.to_world;
        left_ = glm::normalize(DVec3(m[0]));
        up_ = glm::normalize(DVec3(m[1]));
        forward_ = glm::normalize(DVec3(m[2]));
        position_ = space.point(DVec3(m[3]));
        const double distance = glm::length(position_);
        exact_ = distance > 4 * radius;
        check(description.origin, radius, distance);
        set_film(description, film);
    }

    /// The ray through `pixel` (columns and rows from the top left corner; centres at halves). `lens` in [0,1)^2 is
    /// used only by a camera with an aperture.
    Ray ray(const Vec2& pixel, const Vec2& lens) const {
        if (exact_ || lens_radius_ > 0) return general_ray(pixel, lens);
        const Vec3 along = corner_ + pixel.x * step_x_ + pixel.y * step_y_;
        const float per_axis = std::sqrt(length_squared(along));
        return {.origin = origin_,
                .direction = along * (1 / per_axis),
                .near = per_axis * static_cast<float>(near_),
                .far = per_axis * static_cast<float>(far_)};
    }

    /// Where on the film a point is seen.
    struct View {
        Vec2 pixel;          ///< columns and rows from the top left corner; may be off the film
        Vec3 wi;             ///< unit, from the point to the lens
        double density = 0;  ///< see `density`
        Ray visibility;      ///< the ray that must be free
    };

    /// How the camera sees `point` through the place of the lens that `lens` in [0,1)^2 selects (see `ray`), or nothing
    /// when that is behind the camera or outside its clipping planes. The radiance that leaves the point towards the
    /// lens, times the cosine there, times `View::density`, is the integrand over the area of the film in pixels.
    Maybe<View> view(const SurfacePoint& point, const Vec2& lens) const {
        DVec3 origin = position_, shift(0);
        if (lens_radius_ > 0) {
            const Vec2 on_lens = concentric_disk(lens);
            shift = lens_radius_ * (double(on_lens.x) * left_ + double(on_lens.y) * up_);
            origin += shift;
        }
        const DVec3 from_lens = DVec3(point.position) - origin;
        const double depth = glm::dot(from_lens, forward_);
        if (!(depth > 0 && depth >= near_ && depth <= far_)) return {};
        DVec3 along = from_lens / depth;
        const double per_axis = glm::length(along);
        const Vec3 wi(-along / per_axis);
        if (lens_radius_ > 0) along += shift / focus_;
        const DVec3 in_plane = along - corner_exact_;
        return View{.pixel = Vec2(DVec2(glm::dot(in_plane, step_x_exact_) / glm::dot(step_x_exact_, step_x_exact_),
                                        glm::dot(in_plane, step_y_exact_) / glm::dot(step_y_exact_, step_y_exact_))),
                    .wi = wi,
                    .density = density(point.position, wi),
                    .visibility = point.spawn(wi, static_cast<float>((depth - near_) * per_axis))};
    }

    /// Pixels per area across the ray: how much of the film a small surface at `position` fills that is seen along
    /// `direction` (unit, either sense) and faces it. Also the density, per such area, of the points that the rays of
    /// one pixel meet there.
    double density(const Vec3& position, const Vec3& direction) const {
        const double cosine = std::abs(glm::dot(DVec3(direction), forward_));
        const double depth = glm::dot(DVec3(position) - position_, forward_);
        // The film at distance 1 is tilted against the ray by one cosine, and two make it 1 / cosine away.
        return 1 / (pixel_area_ * cosine * depth * depth);
    }

    bool has_lens() const { return lens_radius_ > 0; }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    void check(const Origin& origin, double radius, double distance) const {
        if (!(radius > 0)) return;  // there is nothing to see
        const auto check_ratio = [&](double length, double unit, const std::string& what) {
            if (!(length <= farthest * unit))
                fail(origin,
                     what + " (" + number_text(length / unit) + " times; at most " + number_text(farthest) + ")");
        };
        check_ratio(distance, radius, "the camera is too far away beside the size of the scene");
        check_ratio(lens_radius_, radius, "the camera's aperture is too large beside the size of the scene");
        check_ratio(lens_radius_, focus_, "the camera's aperture is too large beside its focus distance");
    }

    void set_film(const CameraDescription& description, const FilmDescription& film) {
        width_ = film.width;
        height_ = film.height;
        const double aspect = static_cast<double>(film.width) / film.height;
        const double tangent = std::tan(glm::radians(description.fov) / 2);
        using Axis = CameraDescription::FovAxis;
        const bool along_x = description.fov_axis == Axis::x || (description.fov_axis == Axis::larger && aspect > 1) ||
                             (description.fov_axis == Axis::smaller && aspect <= 1);
        double half_width = along_x ? tangent : tangent * aspect;
        if (description.fov_axis == Axis::diagonal) half_width = tangent / std::sqrt(1 + 1 / (aspect * aspect));
        const double half_height = half_width / aspect;
        corner_exact_ = forward_ + half_width * left_ + half_height * up_;
        step_x_exact_ = left_ * (-2 * half_width / film.width);
        step_y_exact_ = up_ * (-2 * half_height / film.height);
        pixel_area_ = glm::length(step_x_exact_) * glm::length(step_y_exact_);
        corner_ = Vec3(corner_exact_);
        step_x_ = Vec3(step_x_exact_);
        step_y_ = Vec3(step_y_exact_);
        origin_ = Vec3(position_);
    }

    Ray general_ray(const Vec2& pixel, const Vec2& lens) const {
        // Per unit along the optical axis.
        DVec3 along = corner_exact_ + double(pixel.x) * step_x_exact_ + double(pixel.y) * step_y_exact_;
        DVec3 origin = position_;
        if (lens_radius_ > 0) {
            const Vec2 on_lens = concentric_disk(lens);
            const DVec3 shift = lens_radius_ * (double(on_lens.x) * left_ + double(on_lens.y) * up_);
            origin += shift;
            along -= shift / focus_;
        }
        const double per_axis = glm::length(along);
        const DVec3 direction = along / per_axis;
        double near = near_ * per_axis;
        const double far = far_ * per_axis;
        const double to_center = glm::length(origin);
        if (exact_) near = std::max(near, to_center - far_away_radius_);
        near = std::min(near, to_center + far_away_radius_);  // beyond it there is nothing
        const double length = far - near;
        return {.origin = Vec3(origin + near * direction),
                .direction = Vec3(direction),
                .near = 0,
                .far = length > 0 ? static_cast<float>(length) : 0.0f};
    }

    Vec3 origin_, corner_, step_x_, step_y_;
    bool exact_ = false;
    int width_ = 0, height_ = 0;
    double far_away_radius_;
    RenderSpace space_;
    DVec3 position_, left_, up_, forward_, corner_exact_, step_x_exact_, step_y_exact_;
    double lens_radius_, focus_, near_, far_;
    double pixel_area_ = 0;  // of the film at distance 1
};

}  // namespace lightswitch
