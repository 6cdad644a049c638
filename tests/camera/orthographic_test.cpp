#include <lightswitch/camera/orthographic_camera.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/stock.hpp>

#include <doctest/doctest.h>

#include "support/chi_square.hpp"
#include "support/relative.hpp"

using namespace lightswitch;
using test::relative;

namespace {

CameraDescription orthographic(double half_width = 0.8) {
    CameraDescription camera;
    camera.projection = CameraDescription::Projection::orthographic;
    camera.half_width = half_width;
    camera.to_world = CameraDescription::look_at({1, 2, 4}, {0, 0.2, 0}, {0, 1, 0});
    return camera;
}
FilmDescription film(int width, int height) {
    FilmDescription result;
    result.width = width;
    result.height = height;
    return result;
}

SurfacePoint point_at(const Vec3& position, const Vec3& normal) {
    SurfacePoint point;
    point.position = position;
    point.normal = point.shading_normal = normal;
    return point;
}

}  // namespace

TEST_CASE("orthographic camera: parallel rays through a grid of squares; with a lens they meet at the focus") {
    const RenderSpace space(DVec3(-1), DVec3(1));  // a scale of one half
    CameraDescription description = orthographic();
    const OrthographicCamera camera(description, film(40, 20), space, 0.9);
    const Ray first = camera.ray({0, 0}, {0.5f, 0.5f}), last = camera.ray({40, 20}, {0.5f, 0.5f});
    CHECK(first.direction == last.direction);
    const Vec3 diagonal = last.origin - first.origin;
    CHECK(double(dot(diagonal, Vec3(glm::normalize(DVec3(description.to_world[0]))))) == relative(-0.8, 1e-5));
    CHECK(double(dot(diagonal, Vec3(glm::normalize(DVec3(description.to_world[1]))))) == relative(-0.4, 1e-5));

    description.aperture_radius = 0.3;
    description.focus_distance = 3;
    const OrthographicCamera with_lens(description, film(40, 20), space, 0.9);
    const auto at_focus = [&](const Vec2& lens) {
        const Ray ray = with_lens.ray({13, 7}, lens);
        const DVec3 forward = glm::normalize(DVec3(description.to_world[2]));
        const DVec3 from = DVec3(ray.origin) - space.point(DVec3(description.to_world[3]));
        const double left = space.length(3) - glm::dot(from, forward);
        return DVec3(ray.origin) + DVec3(ray.direction) * (left / glm::dot(DVec3(ray.direction), forward));
    };
    CHECK(with_lens.ray({13, 7}, {0.1f, 0.2f}).direction != with_lens.ray({13, 7}, {0.9f, 0.6f}).direction);
    CHECK(glm::length(at_focus({0.1f, 0.2f}) - at_focus({0.9f, 0.6f})) < 1e-6);
}

TEST_CASE("orthographic camera: what it sees is where its rays go, and its density is that of their area") {
    const RenderSpace space(DVec3(-1), DVec3(1));
    for (const double aperture : {0.0, 0.2}) {
        CameraDescription description = orthographic();
        description.aperture_radius = aperture;
        description.focus_distance = 3;
        description.principal_point_offset = {0.1, -0.2};
        FilmDescription cropped = film(30, 25);
        cropped.full_width = 64, cropped.full_height = 48, cropped.crop_x = 5, cropped.crop_y = 11;
        const OrthographicCamera camera(description, cropped, space, 0.9);
        test::Random random(3);
        for (int i = 0; i < 200; ++i) {
            const Vec2 pixel = 1.0f + random.next_2d() * Vec2(28, 23), lens = random.next_2d();
            const Ray ray = camera.ray(pixel, lens);
            const float distance = 1 + 2 * random.next();
            const auto point = point_at(ray.origin + distance * ray.direction, -ray.direction);
            const auto view = camera.view(point, lens);
            REQUIRE(view);
            CHECK(double(view->pixel.x) == relative(double(pixel.x), 1e-3));
            CHECK(double(view->pixel.y) == relative(double(pixel.y), 1e-3));
            CHECK(dot(view->wi, ray.direction) < -0.99999f);
            // A small square across the ray, by finite differences.
            const Basis across(ray.direction);
            const float h = 1e-3f;
            const auto moved = [&](const Vec3& by) {
                return DVec2(camera.view(point_at(point.position + h * by, -ray.direction), lens)->pixel);
            };
            const DVec2 a = (moved(across.tangent) - moved(-across.tangent)) / (2.0 * double(h)),
                        b = (moved(across.bitangent) - moved(-across.bitangent)) / (2.0 * double(h));
            CHECK(view->density == relative(std::abs(a.x * b.y - a.y * b.x), 0.02));
            CHECK(view->density == relative(camera.density(point.position, ray.direction), 1e-4));
        }
    }
}

TEST_CASE("with_camera: the same as a scene that was built so, but for what is shared; and its own id") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 24;
    const auto scene = build_scene<AllBsdfs, AllLights>(description);
    CameraDescription camera = orthographic();
    const auto other = scene.with_camera(camera);
    CHECK(other.camera_id() != scene.camera_id());
    CHECK(&other.emitters() == &scene.emitters());
    CHECK(other.accelerator().handle() == scene.accelerator().handle());
    description.camera = camera;
    const auto built = build_scene<AllBsdfs, AllLights>(description);
    CHECK(built.camera_id() == other.camera_id());
    const Image a = render(other, PathTracerNee{}, {.samples = 4}), b = render(built, PathTracerNee{}, {.samples = 4});
    CHECK(a.pixels() == b.pixels());

    camera.half_width = -1;
    CHECK_THROWS_AS(scene.with_camera(camera), Error);
    camera.half_width = 0.8;
    FilmDescription cropped = film(10, 10);
    cropped.full_width = 12;
    cropped.crop_x = 3;
    CHECK_THROWS_AS(scene.with_camera(camera, cropped), Error);
    // A scene type without that kind.
    const auto perspective =
        build_scene<AllBsdfs, AllLights, Cameras<PerspectiveCamera>>(stock::describe_cornell_box());
    CHECK_THROWS_AS(perspective.with_camera(camera), Error);
}

TEST_CASE("cropping: the rays of the part are those of the whole") {
    const RenderSpace space(DVec3(-1), DVec3(1));
    for (const auto projection :
         {CameraDescription::Projection::perspective, CameraDescription::Projection::orthographic}) {
        CameraDescription description = orthographic();
        description.projection = projection;
        FilmDescription part = film(10, 8);
        part.full_width = 40, part.full_height = 30, part.crop_x = 12, part.crop_y = 9;
        const AnyCamera<PerspectiveCamera, OrthographicCamera> whole =
            projection == CameraDescription::Projection::perspective
                ? AnyCamera<PerspectiveCamera, OrthographicCamera>(
                      PerspectiveCamera(description, film(40, 30), space, 0.9))
                : OrthographicCamera(description, film(40, 30), space, 0.9);
        const AnyCamera<PerspectiveCamera, OrthographicCamera> cropped =
            projection == CameraDescription::Projection::perspective
                ? AnyCamera<PerspectiveCamera, OrthographicCamera>(PerspectiveCamera(description, part, space, 0.9))
                : OrthographicCamera(description, part, space, 0.9);
        CHECK(cropped.width() == 10);
        for (const Vec2 pixel : {Vec2(0, 0), Vec2(3.5f, 7.25f), Vec2(10, 8)}) {
            const Ray a = whole.ray(pixel + Vec2(12, 9), {0.5f, 0.5f}), b = cropped.ray(pixel, {0.5f, 0.5f});
            CHECK(std::sqrt(length_squared(a.origin - b.origin)) < 1e-6f);
            CHECK(std::sqrt(length_squared(a.direction - b.direction)) < 1e-6f);
        }
    }
}
