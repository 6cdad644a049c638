// A camera and a sky for scenes that have none.

#include <lightswitch/scene/framing.hpp>

#include "../support/errors.hpp"
#include "../support/scenes.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// Where the camera sees a point: from -1 to 1 across the film to the left and up. By the camera's definition.
DVec2 on_film(const GreyDescription& scene, const DVec3& p) {
    const CameraDescription& camera = scene.camera;
    REQUIRE(camera.fov_axis == CameraDescription::FovAxis::larger);
    const DVec3 from = p - DVec3(camera.to_world[3]);
    const auto along = [&](int axis) { return glm::dot(from, DVec3(camera.to_world[axis])); };
    REQUIRE(along(2) > 0);
    const double half = std::tan(glm::radians(camera.fov / 2)), aspect = scene.film.aspect();
    return DVec2(along(0) / std::min(aspect, 1.0), along(1) * std::max(aspect, 1.0)) / (along(2) * half);
}

std::vector<DVec3> corners(const detail::Bounds& box) {
    std::vector<DVec3> result;
    for (int i = 0; i < 8; ++i)
        result.push_back(
            {i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y, i & 4 ? box.upper.z : box.lower.z});
    return result;
}

/// Frames the scene; all corners of the box around it must be on the film, and fill it in one direction.
void check_framing(GreyDescription& scene, const std::string& what) {
    frame_scene(scene);
    CHECK(scene.camera.fov == 40);
    CHECK_NOTHROW(detail::check(scene.camera));
    DVec2 least(1e9), most(-1e9);
    for (const DVec3& corner : corners(detail::find_bounds(scene))) {
        least = glm::min(least, on_film(scene, corner));
        most = glm::max(most, on_film(scene, corner));
    }
    CHECK_MESSAGE(std::max({-least.x, -least.y, most.x, most.y}) < 1, what);
    CHECK_MESSAGE(std::max(most.x - least.x, most.y - least.y) > 1.7, what);  // of 2
}

GreyDescription with(std::variant<Mesh, Sphere> geometry, int width = 32, int height = 32) {
    GreyDescription scene = grey_description();
    scene.film.width = width;
    scene.film.height = height;
    scene.add(std::move(geometry), 0);
    return scene;
}

DMat4 scaled(const DVec3& scale, const DVec3& shift = DVec3(0)) {
    DMat4 result(1);
    for (int i = 0; i < 3; ++i) result[i][i] = scale[i];
    result[3] = glm::dvec4(shift, 1);
    return result;
}

/// Twice the area on the film of a triangle.
double seen_area(const GreyDescription& scene, const Mesh& triangle) {
    const DVec2 a = on_film(scene, triangle.positions[0]), u = on_film(scene, triangle.positions[1]) - a,
                v = on_film(scene, triangle.positions[2]) - a;
    return std::abs(u.x * v.y - u.y * v.x);
}

}  // namespace

TEST_CASE("a framed scene is on the film and fills it, whatever its size and place") {
    for (const double size : {1.0, 1e-12, 1e12, 1e-90, 1e90})
        for (const DVec3& shape : {DVec3(1), DVec3(1, 0.01, 1), DVec3(0.001, 1, 0.001), DVec3(20, 1, 3)})
            for (const DVec3& place : {DVec3(0), DVec3(3, -200, 1), DVec3(-1e9, 1e9, 2e9)}) {
                GreyDescription scene = with(cube(scaled(shape * size, place * size)));
                check_framing(scene, number_text(size));
            }
    GreyDescription ball = with(Sphere{{5, 6, 7}, 0.25});
    check_framing(ball, "ball");
}

TEST_CASE("a framed scene fits films of any form, and crops count as parts of the whole") {
    for (const auto& [width, height] : {std::pair(640, 360), {360, 640}, {1000, 1}, {1, 1000}}) {
        GreyDescription scene = with(cube(), width, height);
        check_framing(scene, std::to_string(width));
        CHECK(scene.film.width == width);
        CHECK(scene.film.height == height);
    }
    GreyDescription part = with(cube(), 10, 10);
    part.film.crop_x = 20;
    part.film.full_width = 400;
    part.film.full_height = 100;
    check_framing(part, "part");
}

TEST_CASE("flat things and single triangles are not seen from their edge") {
    for (int axis = 0; axis < 3; ++axis) {
        DVec3 flat(1);
        flat[axis] = 0;
        GreyDescription scene = with(cube(scaled(flat)));
        check_framing(scene, "flat");
    }
    // In planes through the view, among others.
    Random random(3);
    GreyDescription first = with(Sphere{});
    frame_scene(first);
    const DVec3 view(first.camera.to_world[2]);
    for (int i = 0; i < 2000; ++i) {
        Mesh triangle = random_triangle(random, DVec3(0), 1);
        if (i % 2 == 0) triangle.positions[2] = triangle.positions[0] + view * 0.9;
        const DVec3 normal =
            glm::cross(triangle.positions[1] - triangle.positions[0], triangle.positions[2] - triangle.positions[0]);
        if (glm::length(normal) < 0.3) continue;  // narrow from all sides
        GreyDescription scene = with(triangle);
        check_framing(scene, "triangle");
        CHECK(seen_area(scene, triangle) > 0.05);

        // The same as an instance that is not all of the scene.
        GreyDescription placed = grey_description();
        placed.groups.push_back({.shapes = scene.shapes, .origin = {}});
        placed.instances.push_back({.group = 0, .to_world = scaled(DVec3(2, 2, 2), {1, 2, 3}), .origin = {}});
        check_framing(placed, "instance");
        CHECK(glm::length(DVec3(placed.camera.to_world[2]) - DVec3(scene.camera.to_world[2])) < 1e-9);
    }
}

TEST_CASE("scenes of one point, and of nothing, can be framed") {
    for (const DVec3& place : {DVec3(0), DVec3(1e-12, 0, 0), DVec3(1e12, 2, 3)}) {
        GreyDescription point = with(Mesh{.positions = {place, place, place}, .normals = {}, .triangles = {{0, 1, 2}}});
        frame_scene(point);
        CHECK_NOTHROW(detail::check(point.camera));
        CHECK(glm::length(on_film(point, place)) < 0.5);
    }
    GreyDescription nothing = grey_description();
    frame_scene(nothing);
    CHECK_NOTHROW(detail::check(nothing.camera));
}

TEST_CASE("the view is from the right, the front and above") {
    GreyDescription scene = with(cube());
    frame_scene(scene);
    const DVec3 eye(scene.camera.to_world[3]);
    CHECK((eye.x > 1 && eye.y > 1 && eye.z > eye.x));
    CHECK(scene.camera.to_world[1].y > 0.8);
}

TEST_CASE("shapes that cannot be built cannot be framed") {
    GreyDescription scene = with(Mesh{.positions = {DVec3(0)}, .normals = {}, .triangles = {{0, 1, 2}}});
    CHECK(message_of([&] { frame_scene(scene); }) == "triangle 0 uses vertex 1, but there are 1 (counted from 0)");
    scene = with(cube());
    scene.instances.push_back({.group = 3, .to_world = DMat4(1), .origin = {}});
    CHECK(message_of([&] { frame_scene(scene); }) == "the instance's group does not exist");
}

TEST_CASE("light is a source, or a shape that shines where it is seen") {
    GreyDescription scene = with(cube());
    CHECK(!has_light(scene));
    scene.shapes[0].emission = Rgb(0);
    CHECK(!has_light(scene));
    scene.shapes[0].emission = Rgb(0, 0, 1);
    CHECK(has_light(scene));
    scene.shapes[0].emission_texture = Texture(Rgb(1));
    CHECK(!has_light(scene));
    scene.shapes[0].emission = Rgb(0, 0, 1.5f);
    CHECK(has_light(scene));
    scene.shapes[0].emission_texture.reset();
    scene.groups.push_back({.shapes = std::exchange(scene.shapes, {}), .origin = {}});
    CHECK(!has_light(scene));
    scene.instances.push_back({.group = 0, .to_world = DMat4(1), .origin = {}});
    CHECK(has_light(scene));
    scene.instances.clear();
    scene.add(Source(EnvironmentSource{}));
    CHECK(has_light(scene));
}

TEST_CASE("the default sky is bright above, makes paper white and can be built") {
    GreyDescription scene = with(cube());
    frame_scene(scene);
    add_default_sky(scene);
    CHECK(has_light(scene));
    CHECK_NOTHROW(build_grey(scene));
    const auto* source = scene.sources[0].source.get<EnvironmentMapSource>();
    REQUIRE(source);
    const auto mean = [&](const DVec3& normal) {  // of what a white surface sends back
        Random random(1);
        DVec3 sum(0);
        constexpr int count = 20000;
        for (int i = 0; i < count; ++i)
            sum += DVec3(source->map->radiance(Basis(Vec3(normal)).to_world(cosine_hemisphere(random.next_2d()))));
        return luminance(sum / double(count));
    };
    const double up = mean({0, 1, 0}), left = mean({-1, 0, 0}), right = mean({1, 0, 0}), front = mean({0, 0, 1}),
                 down = mean({0, -1, 0});
    CHECK((up > 0.8 && up < 1.3));
    // The three sides that are seen differ, and none is dark.
    CHECK((up > 1.3 * front && front > 1.3 * right && right > 0.25));
    CHECK((left > right && down < right && down > 0.1));
}
