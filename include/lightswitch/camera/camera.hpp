#pragma once

// What a camera is: the concepts that every one meets.

#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/core/maybe.hpp>
#include <lightswitch/geometry/surface_point.hpp>

#include <concepts>
#include <variant>

namespace lightswitch {

/// Where on the film a point is seen.
struct CameraView {
    Vec2 pixel;          ///< columns and rows from the top left corner; may be off the film
    Vec3 wi;             ///< unit, from the point to the lens
    double density = 0;  ///< as of `ConnectableCamera`
    Ray visibility;      ///< the ray that must be free
};

/// A camera in render space. Safe to use from several threads.
///
/// - `ray(pixel, lens)`: the ray (of unit direction) through a point of the film, columns and rows from the top left
/// corner,
///   with the centres of pixels at halves, and through the place of the lens that `lens` in [0,1)^2 selects;
/// - `has_lens()`: whether `lens` makes a difference;
/// - `width()`, `height()`: of the film in pixels.
///
/// A pixel's value is the mean of the radiance along its rays.
///
/// Optionally `double start(const Ray& ray) const` says how far from the lens (or, where rays are parallel, from the
/// plane of the camera) a ray of its own begins, for those that do not begin there.
template <class C>
concept Camera = requires(const C camera, const Vec2 u) {
    { camera.ray(u, u) } -> std::same_as<Ray>;
    { camera.has_lens() } -> std::same_as<bool>;
    { camera.width() } -> std::same_as<int>;
    { camera.height() } -> std::same_as<int>;
};

/// A camera that says where it sees a point, for methods that connect light paths to it.
///
/// - `view(point, lens)`: how it sees the point through that place of the lens, or nothing when it does not. The
/// radiance that
///   leaves the point towards the lens, times the cosine there, times `CameraView::density`, is the integrand over the
///   area
///   of the film in pixels;
/// - `density(position, direction)`: pixels per area across the ray: how much of the film a small surface at `position`
///   fills that is seen along `direction` (unit, either sense) and faces it. Also the density, per such area, of the
///   points
///   that the rays of one pixel meet there.
template <class C>
concept ConnectableCamera = Camera<C> &&
    requires(const C camera, const SurfacePoint point, const Vec3 v, const Vec2 u) {
    { camera.view(point, u) } -> std::same_as<Maybe<CameraView>>;
    { camera.density(v, v) } -> std::same_as<double>;
};

/// The camera itself; the compiler says what is missing when it is none that methods can connect to.
template <Camera C>
const C& connectable_camera(const C& camera) {
    static_assert(
        ConnectableCamera<C>,
        "methods that connect light paths to the camera, or measure pixels where it sees the scene, need one with "
        "`view` and `density` (ConnectableCamera)");
    return camera;
}

/// The kinds of camera that a scene can have.
template <Camera... C>
struct Cameras {};

/// One of several kinds of camera, chosen when the scene is built.
template <Camera... C>
class AnyCamera {
public:
    template <class One>
    requires is_one_of<One, C...> AnyCamera(One camera) : camera_(std::move(camera)) {}

    Ray ray(const Vec2& pixel, const Vec2& lens) const {
        return with([&](const auto& camera) { return camera.ray(pixel, lens); });
    }
    double start(const Ray& ray) const requires requires(const C&... camera) { (camera.start(ray), ...); }
    {
        return with([&](const auto& camera) { return camera.start(ray); });
    }
    bool has_lens() const {
        return with([](const auto& camera) { return camera.has_lens(); });
    }
    int width() const {
        return with([](const auto& camera) { return camera.width(); });
    }
    int height() const {
        return with([](const auto& camera) { return camera.height(); });
    }
    Maybe<CameraView> view(const SurfacePoint& point, const Vec2& lens) const requires(ConnectableCamera<C>&&...) {
        return with([&](const auto& camera) { return camera.view(point, lens); });
    }
    double density(const Vec3& position, const Vec3& direction) const requires(ConnectableCamera<C>&&...) {
        return with([&](const auto& camera) { return camera.density(position, direction); });
    }

private:
    template <class F>
    [[gnu::always_inline]] auto with(const F& f) const {
        return dispatch<sizeof...(C)>(
            camera_.index(), [&](auto kind) __attribute__((always_inline)) { return f(*std::get_if<kind>(&camera_)); });
    }

    std::variant<C...> camera_;
};

namespace detail {

template <class CameraList>
struct CameraOf;
template <class C>
struct CameraOf<Cameras<C>> {
    using type = C;
};
template <class First, class Second, class... More>
struct CameraOf<Cameras<First, Second, More...>> {
    using type = AnyCamera<First, Second, More...>;
};

}  // namespace detail

}  // namespace lightswitch
