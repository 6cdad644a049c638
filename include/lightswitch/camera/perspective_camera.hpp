#pragma once

#include <lightswitch/camera/film_plane.hpp>

namespace lightswitch {

/// A perspective camera, with a thin lens if it has an aperture, in render space. Immutable.
///
/// When the camera is far from the scene its rays start at the scene's bounding sphere, a point found in double
/// precision: a float has too few digits for an origin far away.
class PerspectiveCamera {
public:
    static constexpr double farthest = detail::CameraBody::farthest;
    static bool serves(const CameraDescription& d) {
        return d.projection == CameraDescription::Projection::perspective;
    }

    /// `radius` bounds the geometry around the origin of render space. Throws `Error` when that cannot be seen from
    /// where the camera is.
    PerspectiveCamera(const CameraDescription& description, const FilmDescription& film, const RenderSpace& space,
                      double radius)
        : body_(description, space, radius),
          plane_(body_, body_.forward, half_width(description, film), description, film),
          origin_(body_.position),
          corner_(plane_.corner),
          step_x_(plane_.step_x),
          step_y_(plane_.step_y) {}

    Ray ray(const Vec2& pixel, const Vec2& lens) const {
        if (body_.far_away || has_lens()) return body_.ray(body_.position, plane_.point(pixel), lens);
        const Vec3 along = corner_ + pixel.x * step_x_ + pixel.y * step_y_;
        const float per_axis = std::sqrt(length_squared(along));
        return {.origin = origin_,
                .direction = along * (1 / per_axis),
                .near = per_axis * static_cast<float>(body_.near),
                .far = per_axis * static_cast<float>(body_.far)};
    }

    Maybe<CameraView> view(const SurfacePoint& point, const Vec2& lens) const {
        DVec3 origin = body_.position, shift(0);
        if (has_lens()) {
            shift = body_.lens_shift(lens);
            origin += shift;
        }
        const DVec3 from_lens = DVec3(point.position) - origin;
        const double depth = glm::dot(from_lens, body_.forward);
        if (!(depth > 0 && depth >= body_.near && depth <= body_.far)) return {};
        DVec3 along = from_lens / depth;
        const double per_axis = glm::length(along);
        const Vec3 wi(-along / per_axis);
        if (has_lens()) along += shift / body_.focus;
        return CameraView{.pixel = plane_.pixel(along),
                          .wi = wi,
                          .density = density(point.position, wi),
                          .visibility = point.spawn(wi, static_cast<float>((depth - body_.near) * per_axis))};
    }

    double density(const Vec3& position, const Vec3& direction) const {
        const double cosine = std::abs(glm::dot(DVec3(direction), body_.forward));
        const double depth = glm::dot(DVec3(position) - body_.position, body_.forward);
        // The film at distance 1 is tilted against the ray by one cosine, and two make it 1 / cosine away.
        return 1 / (plane_.pixel_area * cosine * depth * depth);
    }

    double start(const Ray& ray) const { return body_.start(ray); }
    bool has_lens() const { return body_.has_lens(); }
    int width() const { return plane_.width; }
    int height() const { return plane_.height; }

private:
    /// Of the film at distance 1.
    static double half_width(const CameraDescription& description, const FilmDescription& film) {
        const double aspect = film.aspect(), tangent = std::tan(glm::radians(description.fov) / 2);
        using Axis = CameraDescription::FovAxis;
        if (description.fov_axis == Axis::diagonal) return tangent / std::sqrt(1 + 1 / (aspect * aspect));
        const bool along_x = description.fov_axis == Axis::x || (description.fov_axis == Axis::larger && aspect > 1) ||
                             (description.fov_axis == Axis::smaller && aspect <= 1);
        return along_x ? tangent : tangent * aspect;
    }

    detail::CameraBody body_;
    detail::FilmPlane plane_;
    Vec3 origin_, corner_, step_x_, step_y_;  // of the former, as floats
};

}  // namespace lightswitch
