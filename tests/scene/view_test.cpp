// Where the camera sees a point: the inverse of its rays.

#include <lightswitch/camera/perspective_camera.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::Random;
using test::relative;

namespace {

struct Setup {
    std::string name;
    CameraDescription camera;
    double distance = 4;  ///< of the points that are looked at, along the ray, in scene units
    double range = 0.1;   ///< how far they may be from there, as a fraction
};

constexpr int width = 40, height = 24;

std::vector<Setup> setups() {
    CameraDescription pinhole;
    pinhole.to_world = CameraDescription::look_at({1, 2, 3}, {0.5, -1, 0.2}, {0, 0.2, 1});
    pinhole.fov = 60;
    CameraDescription lens = pinhole;
    lens.aperture_radius = 0.4;
    lens.focus_distance = 2.5;
    CameraDescription clipped = pinhole;
    clipped.near_clip = 1;
    clipped.far_clip = 20;
    CameraDescription clipped_lens = clipped;
    clipped_lens.aperture_radius = 0.2;
    CameraDescription far = pinhole;
    far.to_world = CameraDescription::look_at({1000, 2000, 3000}, {0, 0, 0}, {0, 1, 0});
    far.fov = 0.05;
    CameraDescription far_lens = far;
    far_lens.aperture_radius = 5;
    far_lens.focus_distance = 3742;
    CameraDescription mirrored = pinhole;
    mirrored.to_world = mirrored.to_world * DMat4({-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
    mirrored.fov_axis = CameraDescription::FovAxis::diagonal;
    return {{"pinhole", pinhole},      {"lens", lens},
            {"clipped", clipped},      {"clipped lens", clipped_lens},
            {"far", far, 3741, 0.001}, {"far lens", far_lens, 3741, 0.001},
            {"mirrored", mirrored}};
}

/// With geometry in a cube of that half side.
struct Built {
    RenderSpace space;
    PerspectiveCamera camera;

    explicit Built(const CameraDescription& description, double half = 8)
        : space(DVec3(-half), DVec3(half)), camera(description, film(), space, std::sqrt(3.0) * space.length(half)) {}

    static FilmDescription film() {
        FilmDescription result;
        result.width = width;
        result.height = height;
        return result;
    }
};

SurfacePoint point_at(const DVec3& position, const Vec3& normal) {
    SurfacePoint point;
    point.position = Vec3(position);
    point.normal = point.shading_normal = normal;
    return point;
}

DVec3 position_of(const CameraDescription& camera, const RenderSpace& space) {
    return space.point(DVec3(camera.to_world[3]));
}

}  // namespace

TEST_CASE("view: finds the pixel that a ray came from") {
    for (const Setup& s : setups()) {
        CAPTURE(s.name);
        const Built built(s.camera);
        const DVec3 eye = position_of(s.camera, built.space), forward = glm::normalize(DVec3(s.camera.to_world[2]));
        // A float position is off by 2^-25, which so far away is more of a pixel.
        const double pixel = 2 * built.space.length(s.distance) * std::tan(glm::radians(s.camera.fov / 2)) / width;
        const double tolerance = 1e-4 + 1e-6 / pixel;
        CHECK(tolerance < 0.01);
        Random random(1);
        for (int i = 0; i < 2000; ++i) {
            // Also beyond the edges of the film.
            const Vec2 at(-5 + random.next() * (width + 10), -5 + random.next() * (height + 10)),
                lens = random.next_2d();
            const Ray ray = built.camera.ray(at, lens);
            const DVec3 origin(ray.origin), direction(ray.direction);
            const double along = built.space.length(s.distance * (1 + s.range * (2 * double(random.next()) - 1)));
            // The origin of a ray is anywhere on its line: counted from the camera.
            const DVec3 position = origin + direction * (along - glm::dot(origin - eye, direction));
            const auto view = built.camera.view(point_at(position, -ray.direction), lens);
            REQUIRE(view);
            CHECK(std::abs(double(view->pixel.x) - double(at.x)) < tolerance);
            CHECK(std::abs(double(view->pixel.y) - double(at.y)) < tolerance);
            CHECK(double(dot(view->wi, ray.direction)) == relative(-1, 1e-6));
            CHECK(view->density == relative(built.camera.density(Vec3(position), ray.direction), 1e-4));
            // The visibility ray goes towards the lens and ends at the near plane, on the lens when there is none.
            const Ray& visibility = view->visibility;
            CHECK(glm::length(DVec3(visibility.origin) - position) < 1e-6);
            CHECK(visibility.near == 0);
            const DVec3 end = DVec3(visibility.origin) + double(visibility.far) * DVec3(visibility.direction);
            const double scale = glm::length(end - position);
            CHECK(glm::dot(end - eye, forward) ==
                  relative(built.space.length(s.camera.near_clip), 1e-5).or_absolute(1e-5 * scale));
        }
    }
}

TEST_CASE("view: the density is how fast the pixel moves") {
    for (const Setup& s : setups()) {
        CAPTURE(s.name);
        const Built built(s.camera, 4096);  // large, so that no digits are lost to the distance
        const DVec3 eye = position_of(s.camera, built.space);
        Random random(2);
        for (int i = 0; i < 300; ++i) {
            const Vec2 at(random.next() * width, random.next() * height), lens = random.next_2d();
            const Ray ray = built.camera.ray(at, lens);
            const DVec3 origin(ray.origin), direction(ray.direction);
            const double along = built.space.length(s.distance);
            const DVec3 position = origin + direction * (along - glm::dot(origin - eye, direction));
            const Basis across(ray.direction);
            // Far enough for rounding to be nothing, and differences on both sides.
            const auto moved = [&](const Vec3& way) {
                const double h = 0.01 * along * std::tan(glm::radians(s.camera.fov / 2));
                const auto end = [&](double sign) {
                    const Vec3 p(position + sign * h * DVec3(way));
                    const auto view = built.camera.view(point_at(DVec3(p), -ray.direction), lens);
                    REQUIRE(view);
                    return std::pair(DVec2(view->pixel), DVec3(p));
                };
                const auto [a, from] = end(-1);
                const auto [b, to] = end(1);
                return (b - a) / glm::dot(to - from, DVec3(way));
            };
            const DVec2 x = moved(across.tangent), y = moved(across.bitangent);
            CHECK(built.camera.density(Vec3(position), ray.direction) ==
                  relative(std::abs(x.x * y.y - x.y * y.x), 5e-3));
        }
    }
}

TEST_CASE("view: nothing behind the camera or beyond its clipping planes") {
    for (Setup s : setups()) {
        CAPTURE(s.name);
        s.camera.near_clip = 0.5 * s.distance;
        s.camera.far_clip = 2 * s.distance;
        const Built built(s.camera);
        const DVec3 eye = position_of(s.camera, built.space), forward = glm::normalize(DVec3(s.camera.to_world[2]));
        const auto seen = [&](double depth) {
            const DVec3 aside = glm::normalize(DVec3(s.camera.to_world[0])) * (0.01 * depth);
            const DVec3 position = eye + (forward * depth + aside) * built.space.length(s.distance);
            return bool(built.camera.view(point_at(position, Vec3(-forward)), {0.3f, 0.7f}));
        };
        CHECK(seen(1));
        CHECK(seen(0.501));
        CHECK(seen(1.999));
        for (const double depth : {-1.0, -0.001, 0.0, 0.1, 0.499, 2.001, 1e6}) CHECK_FALSE(seen(depth));
    }
    CameraDescription open;
    const Built built(open);
    CHECK_FALSE(built.camera.view(point_at({0, 0, 0}, {0, 0, 1}), {0.5f, 0.5f}));
    CHECK_FALSE(built.camera.view(point_at({0.1, 0, 0}, {0, 0, 1}), {0.5f, 0.5f}));
    CHECK_FALSE(built.camera.view(point_at({0, 0, -0.1}, {0, 0, 1}), {0.5f, 0.5f}));
    CHECK(built.camera.view(point_at({0, 0, 1e-6}, {0, 0, 1}), {0.5f, 0.5f}));
}
