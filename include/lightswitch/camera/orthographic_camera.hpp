#pragma once

#include <lightswitch/camera/film_plane.hpp>

namespace lightswitch {

/// A camera whose rays are parallel, or, with a lens, meet at the focus distance. In render space. Immutable.
class OrthographicCamera {
public:
    static bool serves(const CameraDescription& d) {
        return d.projection == CameraDescription::Projection::orthographic;
    }

    /// As of `PerspectiveCamera`.
    OrthographicCamera(const CameraDescription& description, const FilmDescription& film, const RenderSpace& space,
                       double radius)
        : body_(description, space, radius),
          plane_(body_, body_.position, space.length(description.half_width), description, film) {}

    Ray ray(const Vec2& pixel, const Vec2& lens) const { return body_.ray(plane_.point(pixel), body_.forward, lens); }

    Maybe<CameraView> view(const SurfacePoint& point, const Vec2& lens) const {
        const double depth = glm::dot(DVec3(point.position) - body_.position, body_.forward);
        if (!(depth >= 0 && depth >= body_.near && depth <= body_.far)) return {};
        DVec3 along = body_.forward, shift(0);
        if (has_lens()) {
            shift = body_.lens_shift(lens);
            along -= shift / body_.focus;
        }
        const double per_axis = glm::length(along);
        const Vec3 wi(-along / per_axis);
        return CameraView{.pixel = plane_.pixel(DVec3(point.position) - depth * along - shift),
                          .wi = wi,
                          .density = density(point.position, wi),
                          .visibility = point.spawn(wi, static_cast<float>((depth - body_.near) * per_axis))};
    }

    double density(const Vec3&, const Vec3& direction) const {
        return 1 / (plane_.pixel_area * std::abs(glm::dot(DVec3(direction), body_.forward)));
    }

    double start(const Ray& ray) const { return body_.start(ray); }
    bool has_lens() const { return body_.has_lens(); }
    int width() const { return plane_.width; }
    int height() const { return plane_.height; }

private:
    detail::CameraBody body_;
    detail::FilmPlane plane_;
};

}  // namespace lightswitch
