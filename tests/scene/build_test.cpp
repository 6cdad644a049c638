#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/core/parallel.hpp>

#include "../support/errors.hpp"
#include "../support/relative.hpp"
#include "../support/scenes.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double nan_d = std::numeric_limits<double>::quiet_NaN();
constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();

const Origin here{"room.xml", 12, "<shape type=\"obj\">"};

/// Everything that a description can hold, and nothing wrong with it.
GreyDescription good() {
    GreyDescription scene = grey_description();
    scene.materials[0].origin = here;
    scene.add(rectangle(), 0, {}, here);
    scene.add(Sphere{{0, 0, 1}, 0.5, false}, 0, Rgb(1), here);
    scene.add(Source(PointSource{}), here);
    scene.add(Source(DirectionalSource{}), here);
    scene.add(Source(EnvironmentSource{}), here);
    scene.camera.origin = scene.film.origin = here;
    return scene;
}

Mesh& mesh(GreyDescription& scene) { return std::get<Mesh>(scene.shapes[0].geometry); }
Sphere& sphere(GreyDescription& scene) { return std::get<Sphere>(scene.shapes[1].geometry); }
template <class T>
T& source(GreyDescription& scene) {
    for (auto& placed : scene.sources)
        if (auto* found = placed.source.get<T>()) return *found;
    throw std::logic_error("no such source");
}

/// The message of the error with which a description is refused after `spoil`; empty when it is not refused.
std::string refusal(const std::function<void(GreyDescription&)>& spoil) {
    GreyDescription scene = good();
    spoil(scene);
    try {
        build_grey(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// Whether the description is refused with the place and these words, in one line.
bool refused(const std::function<void(GreyDescription&)>& spoil, const std::string& words) {
    const std::string text = refusal(spoil);
    const bool good_text = text.rfind("room.xml:12: <shape type=\"obj\">: ", 0) == 0 &&
                           text.find('\n') == std::string::npos && text.find(words) != std::string::npos;
    if (!good_text) MESSAGE("refused with: ", text, "; expected: ", words);
    return good_text;
}

}  // namespace

TEST_CASE("build: a good description is built, and counted") {
    const GreyScene scene = build_grey(good());
    CHECK(scene.statistics().triangles == 2);
    CHECK(scene.statistics().spheres == 1);
    CHECK(scene.statistics().lights == 4);
    CHECK(scene.statistics().degenerate_triangles == 0);
    CHECK(scene.statistics().embree_bytes > 0);
    CHECK(scene.statistics().scene_bytes > 0);
    CHECK(scene.statistics().build_seconds >= scene.statistics().embree_build_seconds);
    CHECK(scene.name() == "scene");
    CHECK(scene.camera_id().size() == 16);
}

TEST_CASE("build: impossible meshes are refused with place and reason") {
    CHECK(refused([](auto& s) { mesh(s).positions[2].y = nan_d; }, "vertex 2 is not a finite number"));
    CHECK(refused([](auto& s) { mesh(s).positions[0].x = infinite; }, "vertex 0 is not a finite number"));
    CHECK(refused([](auto& s) { mesh(s).positions[1].z = -1e101; }, "vertex 1 is beyond 1e100"));
    CHECK(refused([](auto& s) { mesh(s).triangles[1][2] = 4; }, "triangle 1 uses vertex 4, but there are 4"));
    CHECK(refused([](auto& s) { mesh(s).triangles[0][0] = 0xffffffffu; }, "uses vertex 4294967295"));
    CHECK(refused([](auto& s) { mesh(s).triangles.clear(); }, "no triangles"));
    CHECK(refused([](auto& s) { mesh(s) = Mesh{}; }, "no triangles"));
    CHECK(refused([](auto& s) { mesh(s).normals.assign(3, DVec3(0, 0, 1)); }, "4 vertices but 3 normals"));
    CHECK(refused(
        [](auto& s) {
            mesh(s).normals.assign(4, DVec3(0, 0, 1));
            mesh(s).normals[3] = DVec3(0);
        },
        "normal 3 is not a direction"));
    CHECK(refused([](auto& s) { mesh(s).normals.assign(4, DVec3(0, nan_d, 1)); }, "normal 0 is not a direction"));
    CHECK(refused([](auto& s) { s.shapes[0].material = 1; }, "material does not exist"));
}

TEST_CASE("build: impossible spheres, surface models and lights are refused with place and reason") {
    CHECK(refused([](auto& s) { sphere(s).radius = -1; }, "radius of -1"));
    CHECK(refused([](auto& s) { sphere(s).radius = 0; }, "radius of 0"));
    CHECK(refused([](auto& s) { sphere(s).radius = nan_d; }, "radius"));
    CHECK(refused([](auto& s) { sphere(s).radius = infinite; }, "radius"));
    CHECK(refused([](auto& s) { sphere(s).center.x = nan_d; }, "centre is not a finite number"));
    CHECK(refused([](auto& s) { sphere(s).radius = 1e-50; }, "too small"));
    CHECK(refused([](auto& s) { s.materials[0].bsdf.reflectance.y = 1.5f; }, "1.5"));
    CHECK(refused([](auto& s) { s.materials[0].bsdf.reflectance.x = -0.1f; }, "reflectance"));
    CHECK(refused([](auto& s) { s.materials[0].bsdf.reflectance.z = nan_f; }, "reflectance"));

    CHECK(refused([](auto& s) { s.shapes[1].emission = Rgb(-1, 0, 0); }, "the light's radiance is negative"));
    CHECK(refused([](auto& s) { s.shapes[1].emission = Rgb(0, infinity, 0); }, "the light's radiance is not a finite"));
    CHECK(refused([](auto& s) { s.shapes[1].emission = Rgb(0, 0, nan_f); }, "the light's radiance is not a finite"));
    CHECK(refused([](auto& s) { s.shapes[1].emission = Rgb(2e30f); }, "above 1e30"));
    CHECK(refused([](auto& s) { source<PointSource>(s).intensity.x = -1; }, "the light's intensity is negative"));
    CHECK(refused([](auto& s) { source<PointSource>(s).position.x = nan_d; }, "the light's position is not a finite"));
    CHECK(refused([](auto& s) { source<DirectionalSource>(s).irradiance.x = nan_f; }, "the light's irradiance"));
    CHECK(refused([](auto& s) { source<DirectionalSource>(s).direction = DVec3(0); }, "not a direction"));
    CHECK(refused([](auto& s) { source<DirectionalSource>(s).direction.x = infinite; }, "not a direction"));
    CHECK(refused([](auto& s) { source<EnvironmentSource>(s).radiance.y = infinity; }, "the environment's radiance"));
    CHECK(refused(
        [](auto& s) {
            s.shapes[0].emission = Rgb(1);
            for (auto& p : mesh(s).positions) p.y = 0;
        },
        "no area"));
}

TEST_CASE("build: impossible cameras and films are refused with place and reason") {
    for (const double fov : {0.0, -1.0, 180.0, nan_d, infinite})
        CHECK(refused([=](auto& s) { s.camera.fov = fov; }, "field of view"));
    CHECK(refused([](auto& s) { s.camera.to_world[0] *= 1.01; }, "scale"));
    CHECK(refused([](auto& s) { s.camera.to_world[0] = {0.8, 0.6, 0, 0}; }, "shear"));
    CHECK(refused([](auto& s) { s.camera.to_world[3].x = nan_d; }, "transform"));
    CHECK(refused([](auto& s) { s.camera.to_world[1].x = nan_d; }, "transform"));
    CHECK(refused([](auto& s) { s.camera.aperture_radius = -1; }, "aperture"));
    CHECK(refused([](auto& s) { s.camera.aperture_radius = nan_d; }, "aperture"));
    CHECK(refused([](auto& s) { s.camera.aperture_radius = infinite; }, "aperture"));
    CHECK(refused([](auto& s) { s.camera.focus_distance = 0; }, "focus"));
    CHECK(refused([](auto& s) { s.camera.focus_distance = nan_d; }, "focus"));
    CHECK(refused([](auto& s) { s.camera.near_clip = -1; }, "near_clip"));
    CHECK(refused([](auto& s) { s.camera.near_clip = nan_d; }, "near_clip"));
    CHECK(refused([](auto& s) { s.camera.near_clip = s.camera.far_clip = 1; }, "far_clip"));
    CHECK(refused([](auto& s) { s.camera.far_clip = nan_d; }, "far_clip"));
    CHECK(refused([](auto& s) { s.film.width = 0; }, "image of 0 x 8"));
    CHECK(refused([](auto& s) { s.film.height = -1; }, "image of 8 x -1"));
    CHECK(refused([](auto& s) { s.film.width = 1000000000; }, "image of 1000000000 x 8"));
    CHECK(refused([](auto& s) { s.film.width = s.film.height = 65536; }, "image of"));
    // A mirror image is no scale.
    CHECK(refusal([](auto& s) { s.camera.to_world[0] *= -1.0; }).empty());
}

TEST_CASE("build: a light that is too strong beside the size of the scene is refused, not rendered as infinite") {
    // Seen from scene units of 1e-30, an intensity of 1 is an irradiance of 1e60.
    CHECK(refused(
        [](auto& s) {
            s.shapes.pop_back();
            for (auto& p : mesh(s).positions) p *= 1e-30;
            source<PointSource>(s).position = DVec3(0, 0, 1e-30);
        },
        "the light's intensity is too high"));
    CHECK(refused([](auto& s) { source<PointSource>(s).position.z = 1e25; }, "the light is too far away"));
}

TEST_CASE("build: a scene type without room for something says so") {
    GreyDescription scene = good();
    CHECK_THROWS_WITH_AS((build_scene<Bsdfs<Lambert>, Lights<TriangleLight>>(scene)),
                         doctest::Contains("no place for that kind of light"), Error);
    SceneDescription<std::variant<Lambert, Conductor>> mirrors;
    mirrors.add(Conductor{}, here);
    CHECK_THROWS_WITH_AS((build_scene<Bsdfs<Lambert>>(mirrors)), doctest::Contains("room.xml:12"), Error);
    CHECK_THROWS_WITH_AS((build_scene<Bsdfs<Lambert>>(mirrors)), doctest::Contains("no place for that surface model"),
                         Error);
    CHECK_THROWS_AS(build_scene<Bsdfs<Lambert>>(grey_description(), {.embree_config = "threads=x"}), Error);
}

TEST_CASE("build: more materials or lights of one kind than can be numbered are refused") {
    const std::size_t most = (std::size_t{1} << 27) - 1, most_materials = (std::size_t{1} << 24) - 1;
    const TypedIndex last(30, most);
    CHECK(last);
    CHECK(last.kind() == 30);
    CHECK(last.position() == most);
    for (const bool both : {false, true}) {
        const std::size_t flags = both ? MaterialIndex::both_sides : MaterialIndex::varying;
        const MaterialIndex material(30, most_materials, flags);
        CHECK(material.kind() == 30);
        CHECK(material.position() == most_materials);
        CHECK(material.two_sided() == both);
        CHECK(material.varies() == !both);
        CHECK(!material.lit_through());
        CHECK(material.flags() == flags);
    }
    CHECK(TypedIndex::max_position == most);
    CHECK(MaterialIndex::max_position == most_materials);
    CHECK_NOTHROW(detail::check_count(most, most, here, "lights"));
    CHECK(message_of([&] { detail::check_count(most + 1, most, here, "lights"); }) ==
          here.prefix() + "the scene has more than 134217728 lights of one kind");
}

TEST_CASE("build: triangles without area are counted and dropped, and the others keep their properties") {
    GreyDescription scene = grey_description();
    Mesh grid;
    for (int i = 0; i < 4; ++i) grid.positions.push_back({i, 0, 0}), grid.positions.push_back({i, 1, 0});
    // Degenerate ones before, between and after: a repeated corner, corners on a line, corners that only doubles tell
    // apart.
    grid.positions.push_back({0, 1e-20, 0});
    grid.triangles = {{0, 0, 1}, {0, 2, 1}, {0, 2, 4}, {2, 4, 3}, {0, 8, 2}, {4, 6, 5}, {5, 5, 5}};
    for (const DVec3& p : grid.positions) grid.normals.push_back(glm::normalize(DVec3(0.1 * p.x, 0.1, 1)));
    scene.add(grid, 0, Rgb(1));
    const GreyScene built = build_grey(scene);
    CHECK(built.statistics().triangles == 3);
    CHECK(built.statistics().degenerate_triangles == 4);
    CHECK(built.light_count() == 3);
    for (const double x : {0.25, 1.25, 2.25}) {
        const auto hit =
            built.intersect(Ray{.origin = Vec3(built.space().point({x, 0.25, 1})), .direction = {0, 0, -1}});
        REQUIRE(hit);
        CHECK(glm::length(DVec3(hit->position) - built.space().point({x, 0.25, 0})) < 1e-6);
        CHECK(hit->normal == Vec3(0, 0, 1));
        CHECK(built.light_number(hit->light) == static_cast<std::size_t>(x));
        CHECK(built.emitted(*hit, {0, 0, 1}) == Rgb(1));
        // Normals are interpolated between those of the right corners.
        const double low = std::floor(x);
        const DVec3 n = 0.5 * glm::normalize(DVec3(0.1 * low, 0.1, 1)) +
                        0.25 * glm::normalize(DVec3(0.1 * (low + 1), 0.1, 1)) +
                        0.25 * glm::normalize(DVec3(0.1 * low, 0.1, 1));
        CHECK(glm::length(DVec3(hit->shading_normal) - glm::normalize(n)) < 1e-6);
    }

    GreyDescription nothing = grey_description();
    nothing.add(Mesh{.positions = {DVec3(1)}, .normals = {}, .triangles = {{0, 0, 0}}}, 0);
    const GreyScene point = build_grey(nothing);
    CHECK(point.statistics().triangles == 0);
    CHECK_FALSE(point.intersect(Ray{}));
}

TEST_CASE("build: shapes keep their own materials and lights, whatever order they come in") {
    SceneDescription<Lambert> scene = grey_description();
    for (int i = 1; i < 5; ++i) scene.add(Lambert{Rgb(0.1f * static_cast<float>(i))});
    for (int i = 0; i < 8; ++i) {
        const DVec3 at(i, 0, 0);
        const auto material = static_cast<std::size_t>(i % 5);
        const std::optional<Rgb> emission = i % 3 == 0 ? std::optional(Rgb(static_cast<float>(i + 1))) : std::nullopt;
        if (i % 2 == 0) scene.add(Sphere{at, 0.3, false}, material, emission);
        else
            scene.add(cube(DMat4({0.3, 0, 0, 0}, {0, 0.3, 0, 0}, {0, 0, 0.3, 0}, glm::dvec4(at, 1))), material,
                      emission);
    }
    const GreyScene built = build_grey(scene);
    for (int i = 0; i < 8; ++i) {
        const auto hit =
            built.intersect(Ray{.origin = Vec3(built.space().point({i + 0.05, 0.1, 1})), .direction = {0, 0, -1}});
        REQUIRE(hit);
        const Rgb reflectance = built.with_bsdf(*hit, [](const auto& bsdf) { return bsdf.reflectance; });
        CHECK(reflectance == (i % 5 == 0 ? Rgb(0.5f) : Rgb(0.1f * static_cast<float>(i % 5))));
        CHECK(built.emitted(*hit, {0, 0, 1}) == (i % 3 == 0 ? Rgb(static_cast<float>(i + 1)) : Rgb(0)));
        CHECK(glm::length(DVec3(hit->position) - built.space().point({i + 0.05, 0.1, 0.3})) < 0.05);
        CHECK(hit->wo == Vec3(0, 0, 1));
        CHECK(hit->facing_normal().z > 0);
    }
    CHECK(built.emitters().size() == 3);
}

TEST_CASE("build: the smallest triangles beside the largest have normals") {
    for (const double half : {1e-6, 1e-9, 1e-10, 1e-12}) {
        GreyDescription scene = grey_description();
        stretch_to_unit_box(scene);
        scene.add(rectangle(DMat4({half, 0, 0, 0}, {0, half, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1})), 0);
        const GreyScene built = build_grey(scene);
        const FlushDenormals as_in_a_render;
        const auto hit = built.intersect(
            Ray{.origin = Vec3(DVec3(0.2, 0.3, 1) * half), .direction = {0, 0, -1}, .near = 0, .far = 0.5f});
        CAPTURE(half);
        REQUIRE(hit);
        CHECK(hit->normal == Vec3(0, 0, 1));
    }
    // The largest that render space can hold, across it.
    GreyDescription scene = grey_description();
    scene.add(Mesh{.positions = {{-1, -1, -1}, {1, 1, -1}, {-1, 1, 1}}, .normals = {}, .triangles = {{0, 1, 2}}}, 0);
    const auto hit = build_grey(scene).intersect(Ray{.origin = {0, 0.3f, 0.9f}, .direction = {0, 0, -1}});
    REQUIRE(hit);
    CHECK(length_squared(hit->normal) == relative(1, 1e-5));
}

TEST_CASE("build: vertices that no triangle uses do not matter, wherever they are") {
    GreyDescription scene = grey_description();
    Mesh square = rectangle();
    square.positions.push_back({1e90, -1e90, 0});
    scene.add(square, 0);
    const GreyScene built = build_grey(scene);
    CHECK(built.space().scale() == 0.5);
    CHECK(built.intersect(Ray{.origin = {0.1f, 0.2f, 1}, .direction = {0, 0, -1}}));
    CHECK_FALSE(built.intersect(Ray{.origin = {0.9f, 0.2f, 1}, .direction = {0, 0, -1}}));
}

TEST_CASE("build: scenes without shapes, without lights, or with an environment only") {
    const GreyScene empty = build_grey(grey_description());
    CHECK_FALSE(empty.intersect(Ray{}));
    CHECK_FALSE(empty.occluded(Ray{}));
    CHECK(empty.light_count() == 0);
    CHECK(empty.emitters().empty());
    CHECK(is_black(empty.environment({0, 0, 1})));

    GreyDescription sky = grey_description();
    sky.add(Source(EnvironmentSource{Rgb(1, 2, 3)}));
    sky.camera.to_world[3] = {1e6, 2e6, 3e6, 1};
    const GreyScene only_sky = build_grey(sky);
    CHECK(only_sky.environment({0, 1, 0}) == Rgb(1, 2, 3));
    CHECK_FALSE(only_sky.intersect(only_sky.camera().ray({4, 4}, {0.5f, 0.5f})));
    CHECK(is_finite(only_sky.camera().ray({4, 4}, {0.5f, 0.5f}).origin));
    CHECK(std::isfinite(only_sky.environment_pdf({0, 0, 1}, {0, 0, 1}).value));

    GreyDescription room = grey_description();
    room.add(cube(), 0);
    const GreyScene dark = build_grey(room);
    CHECK(dark.light_count() == 0);
    CHECK(dark.intersect(Ray{}));
}

TEST_CASE("build: camera ids differ between cameras and are equal for equal ones") {
    const auto id = [](const std::function<void(GreyDescription&)>& change) {
        GreyDescription scene = good();
        change(scene);
        return build_grey(scene).camera_id();
    };
    const std::string same = id([](auto&) {});
    CHECK(id([](auto&) {}) == same);
    CHECK(id([](auto& s) { s.materials[0].bsdf.reflectance = Rgb(0.1f); }) == same);
    CHECK(id([](auto& s) { s.film.width = s.film.height = 16; }) == same);  // the same view at another resolution
    CHECK(id([](auto& s) { s.camera.to_world[3].x = 1e-9; }) != same);
    CHECK(id([](auto& s) { s.camera.fov = 40; }) != same);
    CHECK(id([](auto& s) { s.camera.fov_axis = CameraDescription::FovAxis::y; }) != same);
    CHECK(id([](auto& s) { s.camera.aperture_radius = 0.1; }) != same);
    CHECK(id([](auto& s) { s.camera.near_clip = 0.1; }) != same);
    CHECK(id([](auto& s) { s.film.width = 9; }) != same);
}
