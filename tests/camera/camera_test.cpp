#include <lightswitch/camera/perspective_camera.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace lightswitch;
using test::Random;
using test::relative;

namespace {

using Axis = CameraDescription::FovAxis;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A ray in scene units: where it begins and ends, and its unit direction.
struct Segment {
    DVec3 origin, direction;
    double length = 0;
};

/// Render space of a scene between the corners of a cube.
struct Spot {
    DVec3 center{0};
    double half = 8;

    RenderSpace space() const { return RenderSpace(center - half, center + half); }
    /// The camera's ray in scene units, with what the ray's `near` says already gone.
    Segment ray(const CameraDescription& description, const FilmDescription& film, const Vec2& pixel,
                const Vec2& lens = {0.5f, 0.5f}) const {
        const RenderSpace space = this->space();
        const PerspectiveCamera camera(description, film, space, std::sqrt(3.0) * space.length(half));
        const Ray ray = camera.ray(pixel, lens);
        const DVec3 direction(ray.direction), origin = DVec3(ray.origin) + double(ray.near) * direction;
        return {origin / space.scale() + space.center(), glm::normalize(direction),
                (double(ray.far) - double(ray.near)) * glm::length(direction) / space.scale()};
    }
};

FilmDescription film(int width, int height) {
    FilmDescription result;
    result.width = width;
    result.height = height;
    return result;
}

/// What Mitsuba 3.9 answers for a camera at (1, 2, 3) that looks at (0.5, -1, 0.2) with (0, 0.2, 1) upwards, mirrored
/// in x when `reflected`, and with focus at 2.5: `sensor.sample_ray` of the variant scalar_rgb.
struct Pin {
    Axis axis;
    double fov;
    int width, height;
    double aperture, near, far;
    bool reflected;
    Vec2 pixel, lens;
    DVec3 origin, direction;
    double length;
};

const Pin pins[] = {
    {Axis::x,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {0.99572134, 1.99246454, 2.99407339},
     {-0.40755561, -0.717777908, -0.564529061},
     10498.2686},
    {Axis::x,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {24.375f, 12.5f},
     {0.8f, 0.35f},
     {0.995553076, 1.99179327, 2.99482274},
     {-0.41661942, -0.768870115, -0.485043228},
     10673.7852},
    {Axis::y,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {0.994698346, 1.99237168, 2.99435568},
     {-0.487733185, -0.701770723, -0.519262969},
     10870.0381},
    {Axis::y,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {24.375f, 12.5f},
     {0.8f, 0.35f},
     {0.996362448, 1.99203074, 2.99442387},
     {-0.350290507, -0.767429948, -0.536980212},
     10384.3799},
    {Axis::diagonal,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {0, 0},
     {0.5f, 0.5f},
     {1.00198054, 1.99015343, 2.9954319},
     {0.179497585, -0.892397702, -0.414013088},
     11033.7686},
    {Axis::diagonal,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {0.996335208, 1.99252033, 2.99390411},
     {-0.355059087, -0.724662006, -0.590590954},
     10321.6602},
    {Axis::diagonal,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {0, 0},
     {0.5f, 0.5f},
     {1.00091374, 1.98972678, 2.99607944},
     {0.0828172639, -0.93107152, -0.355312526},
     11033.7686},
    {Axis::diagonal,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {24.375f, 12.5f},
     {0.8f, 0.35f},
     {0.996848047, 1.99217319, 2.99418449},
     {-0.30757609, -0.763764799, -0.567503393},
     10247.6611},
    {Axis::smaller,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {0.994698346, 1.99237168, 2.99435568},
     {-0.487733185, -0.701770723, -0.519262969},
     10870.0381},
    {Axis::smaller,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {24.375f, 12.5f},
     {0.8f, 0.35f},
     {0.995553076, 1.99179327, 2.99482274},
     {-0.41661942, -0.768870115, -0.485043228},
     10673.7852},
    {Axis::larger,
     50,
     40,
     30,
     0,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {0.99572134, 1.99246454, 2.99407339},
     {-0.40755561, -0.717777908, -0.564529061},
     10498.2686},
    {Axis::larger,
     50,
     30,
     40,
     0,
     0.01,
     10000,
     false,
     {24.375f, 12.5f},
     {0.8f, 0.35f},
     {0.996362448, 1.99203074, 2.99442387},
     {-0.350290507, -0.767429948, -0.536980212},
     10384.3799},
    {Axis::larger,
     90,
     64,
     64,
     0,
     0.01,
     10000,
     false,
     {0, 0},
     {0.5f, 0.5f},
     {1.0069294, 1.98415589, 3.00097418},
     {0.400066823, -0.914758623, 0.0562406182},
     17320.4922},
    {Axis::larger,
     90,
     64,
     64,
     0,
     0.01,
     10000,
     false,
     {52, 20},
     {0.8f, 0.35f},
     {0.992054045, 1.99152875, 2.99573088},
     {-0.642130494, -0.684579134, -0.344991952},
     12374.3574},
    {Axis::x,
     120,
     200,
     100,
     0,
     0.5,
     4,
     false,
     {0, 0},
     {0.5f, 0.5f},
     {1.7158047, 1.17846322, 3.01418066},
     {0.656867325, -0.753893733, 0.0130129578},
     7.62807417},
    {Axis::x,
     120,
     200,
     100,
     0,
     0.5,
     4,
     false,
     {162.5f, 31.25f},
     {0.8f, 0.35f},
     {0.382917702, 1.63885772, 2.75891638},
     {-0.817822099, -0.478623599, -0.319509387},
     5.28180408},
    {Axis::y,
     5,
     100,
     200,
     0,
     0.01,
     10000,
     true,
     {0, 0},
     {0.5f, 0.5f},
     {-0.998932183, 1.99241197, 2.9935565},
     {0.106654987, -0.757899642, -0.64359355},
     10011.8965},
    {Axis::y,
     5,
     100,
     200,
     0,
     0.01,
     10000,
     true,
     {81.25f, 62.5f},
     {0.8f, 0.35f},
     {-0.998629928, 1.99266279, 2.99334168},
     {0.136973545, -0.733560622, -0.665677845},
     10002.2598},
    {Axis::x,
     35,
     40,
     30,
     0.25,
     0.01,
     10000,
     false,
     {0, 0},
     {0.5f, 0.5f},
     {1.00148678, 1.99055433, 2.99509048},
     {0.138317317, -0.878775537, -0.456751168},
     10748.6328},
    {Axis::x,
     35,
     40,
     30,
     0.25,
     0.01,
     10000,
     false,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {1.14125609, 2.002496, 2.95733714},
     {-0.372582704, -0.721524, -0.583596647},
     10374.0752},
    {Axis::larger,
     35,
     40,
     30,
     0.25,
     0.7,
     5,
     true,
     {0, 0},
     {0.5f, 0.5f},
     {-1.10407066, 1.33880484, 2.65633821},
     {-0.138317317, -0.878775537, -0.456751168},
     4.62191677},
    {Axis::larger,
     35,
     40,
     30,
     0.25,
     0.7,
     5,
     true,
     {32.5f, 9.375f},
     {0.8f, 0.35f},
     {-0.874557018, 1.48602057, 2.53959155},
     {0.372582704, -0.721524, -0.583596647},
     4.46085691},
};

CameraDescription describe(const Pin& pin) {
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({1, 2, 3}, {0.5, -1, 0.2}, {0, 0.2, 1});
    if (pin.reflected)
        camera.to_world = DMat4({-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}) * camera.to_world;
    camera.fov = pin.fov;
    camera.fov_axis = pin.axis;
    camera.aperture_radius = pin.aperture;
    camera.focus_distance = 2.5;
    camera.near_clip = pin.near;
    camera.far_clip = pin.far;
    return camera;
}

}  // namespace

TEST_CASE("camera: rays are those of Mitsuba") {
    for (const Pin& pin : pins) {
        const Segment ray = Spot{}.ray(describe(pin), film(pin.width, pin.height), pin.pixel, pin.lens);
        CAPTURE(&pin - pins);
        CHECK(glm::length(ray.direction - pin.direction) < 1e-5);
        CHECK(glm::length(ray.origin - pin.origin) < 1e-5);
        CHECK(ray.length == relative(pin.length, 1e-5));
    }
}

TEST_CASE("camera: what is far from the scene sees it like what is near") {
    // A scene of size 1 at distance 1e7, as a tiny field of view shows it: rays meet a plane through the scene where
    // those of the same camera in double precision do. One step of float at that distance is 1.
    const double distance = 1e7;
    for (const DVec3& center : {DVec3(0), DVec3(3e5, -7e6, 2e4)}) {
        const Spot place{center, 0.5};
        const DVec3 view = glm::normalize(DVec3(0.3, -0.5, 0.8)), eye = center - view * distance;
        CameraDescription camera;
        camera.to_world = CameraDescription::look_at(eye, center, {0, 1, 0});
        camera.fov = glm::degrees(2 * std::atan(0.5 / distance));
        const DVec3 left(camera.to_world[0]), up(camera.to_world[1]), forward(camera.to_world[2]);
        double worst = 0;
        Random random(1);
        for (int i = 0; i < 10000; ++i) {
            const Vec2 pixel = random.next_2d() * 100.0f;
            const Segment ray = place.ray(camera, film(100, 100), pixel);
            const DVec3 expected = center + left * (0.5 - double(pixel.x) / 100) + up * (0.5 - double(pixel.y) / 100);
            const double t = glm::dot(center - ray.origin, forward) / glm::dot(ray.direction, forward);
            // The digits of the place itself: doubles have steps of 1e-9 there.
            worst = std::max(worst, glm::length(ray.origin + t * ray.direction - expected));
            REQUIRE(t > 0);
            REQUIRE(ray.length == infinite);
        }
        CHECK(worst < 1e-6);
    }
}

TEST_CASE("camera: near and far clip along the optical axis, also of a camera that is far away") {
    for (const double distance : {2.0, 20.0, 1e6}) {
        const Spot place{{0, 0, 0}, 1};
        CameraDescription camera;
        camera.to_world = CameraDescription::look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0});
        camera.fov = glm::degrees(2 * std::atan(1 / distance));
        camera.near_clip = distance - 0.5;
        camera.far_clip = distance + 0.25;
        for (const Vec2& pixel : {Vec2(5, 5), Vec2(0, 0), Vec2(10, 3)}) {
            const Segment ray = place.ray(camera, film(10, 10), pixel);
            CAPTURE(distance);
            CHECK(ray.origin.z == relative(0.5, 2e-6));
            CHECK((ray.origin + ray.length * ray.direction).z == relative(-0.25, 4e-6));
        }
        // A lens changes the direction, not the planes.
        camera.aperture_radius = 0.1 * distance;
        camera.focus_distance = distance;
        const Segment ray = place.ray(camera, film(10, 10), {2, 3}, {0.9f, 0.2f});
        CHECK(ray.origin.z == relative(0.5, 1e-5));
        CHECK((ray.origin + ray.length * ray.direction).z == relative(-0.25, 2e-5));
    }
    // Nothing is left to see beyond the far plane.
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({0, 0, 100}, {0, 0, 0}, {0, 1, 0});
    camera.far_clip = 50;
    CHECK(Spot{}.ray(camera, film(10, 10), {5, 5}).length == 0);
}

TEST_CASE("camera: all rays through a point of the film meet on the plane in focus") {
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({1, 2, 5}, {0.5, -1, 0.2}, {0, 0.2, 1});
    camera.aperture_radius = 0.3;
    camera.focus_distance = 4;
    const DVec3 eye(1, 2, 5), forward(camera.to_world[2]);
    Random random(2);
    double worst = 0, widest = 0;
    DVec3 mean(0);
    for (int i = 0; i < 20000; ++i) {
        const Vec2 pixel(static_cast<float>(i % 5), 3);
        CameraDescription pinhole = camera;
        pinhole.aperture_radius = 0;
        const auto at_focus = [&](const Segment& ray) {
            return ray.origin + ray.direction * (glm::dot(eye + 4.0 * forward - ray.origin, forward) /
                                                 glm::dot(ray.direction, forward));
        };
        const Segment ray = Spot{}.ray(camera, film(8, 8), pixel, random.next_2d());
        worst = std::max(worst, glm::length(at_focus(ray) - at_focus(Spot{}.ray(pinhole, film(8, 8), pixel))));
        const DVec3 on_lens = ray.origin - eye;
        worst = std::max(worst, std::abs(glm::dot(on_lens, forward)));
        widest = std::max(widest, glm::length(on_lens));
        mean += on_lens / 20000.0;
    }
    CHECK(worst < 5e-6);
    CHECK(widest <= 0.3 * (1 + 1e-5));
    CHECK(widest > 0.299);
    // Uniform on the disk: the deviation per axis is 0.15, so this is 7 standard errors.
    CHECK(glm::length(mean) < 7.5e-3);
}

TEST_CASE("camera: rows go down, columns to the right, and pixels are square") {
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    camera.fov = 90;
    camera.fov_axis = Axis::y;
    const auto on_plane = [&](float x, float y) {
        const Segment ray = Spot{}.ray(camera, film(30, 20), {x, y});
        return ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
    };
    CHECK(glm::length(on_plane(15, 10)) < 1e-5);
    CHECK(glm::length(on_plane(0, 0) - DVec3(-6, 4, 0)) < 1e-5);
    CHECK(glm::length(on_plane(30, 20) - DVec3(6, -4, 0)) < 1e-5);
    CHECK(glm::length(on_plane(16, 10) - DVec3(0.4, 0, 0)) < 1e-5);
    CHECK(glm::length(on_plane(15, 11) - DVec3(0, -0.4, 0)) < 1e-5);
}

TEST_CASE("camera: a scene without shapes has a camera too") {
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({5, 6, 7}, {5, 6, 6}, {0, 1, 0});
    const PerspectiveCamera built(camera, film(10, 10), RenderSpace(DVec3(5, 6, 7), DVec3(5, 6, 7)), 0);
    const Ray ray = built.ray({5, 5}, {0.5f, 0.5f});
    CHECK(glm::length(ray.direction - Vec3(0, 0, -1)) < 1e-6f);
    CHECK(is_finite(ray.origin));
    CHECK(ray.far > 0);
    CHECK_FALSE(built.has_lens());
    CHECK(built.width() == 10);
}
