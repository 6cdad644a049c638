#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/vcm.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/verify/verify.hpp>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace lightswitch;
using test::relative;

namespace {

/// What a ray from `origin` along `direction` (scene units) meets has these texture coordinates.
Vec2 uv_of(std::variant<Mesh, Sphere> shape, const DVec3& origin, const DVec3& direction) {
    LibraryDescription description;
    // Coordinates are found where the material asks for them.
    const auto pattern = Textured<Lambert>().set("reflectance", Texture(Checkerboard{}));
    description.add(std::move(shape), description.add(pattern));
    const auto scene = build_scene<TexturedBsdfs, AllLights>(description);
    const auto hit = scene.intersect({.origin = Vec3(scene.space().point(origin)), .direction = Vec3(direction)});
    REQUIRE(hit);
    return hit->uv;
}

void check_uv(const Vec2& uv, double u, double v, double tolerance = 1e-4) {
    CHECK(double(uv.x) == relative(u, tolerance));
    CHECK(double(uv.y) == relative(v, tolerance));
}

/// A disk is a fan of triangles: angles are right to half of one.
void check_disk(const Vec2& uv, double radius, double angle) {
    CHECK(double(uv.x) == relative(radius, 1e-3));
    CHECK(std::abs(double(uv.y) - angle) < 1 / 512.0);
}

/// A texture that counts the places that are asked for.
struct Counting {
    static inline thread_local int calls = 0;
    Lambert at(const Place& place) const {
        ++calls;
        return {Rgb(place.uv.x)};
    }
    std::string problem() const { return {}; }
};
static_assert(PlacedMaterial<Counting> && !PlacedMaterial<Lambert>);

/// A floor under a lamp, with that material.
template <class M>
SceneDescription<M> floor_with(const M& material) {
    SceneDescription<M> description;
    description.add(quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}), description.add(material));
    description.add(quad({-0.3, 1.5, -0.3}, {0.3, 1.5, -0.3}, {0.3, 1.5, 0.3}, {-0.3, 1.5, 0.3}), 0, Rgb(8));
    description.camera.to_world = CameraDescription::look_at({0, 2, 2.5}, {0, 0, 0}, {0, 1, 0});
    description.film.width = description.film.height = 16;
    return description;
}

LibraryDescription checkered(const Checkerboard& pattern) {
    return floor_with<AnyMaterial>(Textured<Lambert>().set("reflectance", Texture(pattern, {{3, 0, 0}, {0, 2, 0.1f}})));
}

}  // namespace

TEST_CASE("texture coordinates of shapes are those of Mitsuba 3.9.1") {
    // Its answers for rays onto its default shapes.
    const DVec3 down(0, 0, -1);
    check_uv(uv_of(rectangle(), {0.3, 0.2, 5}, down), 0.65, 0.6);
    check_uv(uv_of(rectangle(), {-0.3, -0.6, 5}, down), 0.35, 0.2);
    check_disk(uv_of(disk(), {0.3, 0.2, 5}, down), 0.360555, 0.0935835);
    check_disk(uv_of(disk(), {-0.3, 0.2, 5}, down), 0.360555, 0.406416);
    check_disk(uv_of(disk(), {-0.3, -0.6, 5}, down), 0.67082, 0.676208);
    check_uv(uv_of(Sphere{}, {0.3, 0.2, 5}, down), 0.0935835, 0.117413, 1e-3);
    check_uv(uv_of(Sphere{}, {-0.3, -0.6, 5}, down), 0.676208, 0.234058, 1e-3);
    check_uv(uv_of(Sphere{}, {0.1, 5, 0.5}, {0, -1, 0}), 0.231581, 0.333333, 1e-3);
    check_uv(uv_of(Sphere{}, {0.1, 0.2, -5}, {0, 0, 1}), 0.176208, 0.928217, 1e-3);
    // Its cube has a corner of every face at (0, 0) and the next one at (0, 1), against the clock.
    check_uv(uv_of(cube(), {0.5, -5, 0.2}, {0, 1, 0}), 0.6, 0.75);
    check_uv(uv_of(cube(), {0.5, 5, 0.2}, {0, -1, 0}), 0.25, 0.4);
    check_uv(uv_of(cube(), {5, 0.5, 0.2}, {-1, 0, 0}), 0.75, 0.4);
    check_uv(uv_of(cube(), {-5, 0.5, 0.2}, {1, 0, 0}), 0.75, 0.6);
    check_uv(uv_of(cube(), {0.5, 0.2, 5}, down), 0.6, 0.75);
    check_uv(uv_of(cube(), {0.5, 0.2, -5}, {0, 0, 1}), 0.4, 0.75);
    // Without coordinates: the barycentric ones.
    check_uv(uv_of(Mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}}},
                   {0.3, 0.2, 5}, down),
             0.3, 0.2);
}

TEST_CASE("a scene without materials that differ from place to place has the point that it had") {
    static_assert(!FullScene::placed && std::same_as<FullScene::Point, SurfacePoint> && sizeof(SurfacePoint) == 64);
    static_assert(TexturedScene::placed);
    const auto description = floor_with<std::variant<Lambert, Counting>>(Counting{});
    const auto scene = build_scene<Bsdfs<Lambert, Counting>, AllLights>(description);
    Counting::calls = 0;
    const auto hit = scene.intersect({.origin = Vec3(scene.space().point({0.5, 1, 0.2})), .direction = {0, -1, 0}});
    REQUIRE(hit);
    CHECK(Counting::calls == 1);
    for (int i = 0; i < 3; ++i)
        CHECK(scene.with_bsdf(*hit, [](const auto& bsdf) { return bsdf.reflectance; }).x == hit->uv.x);
    CHECK(Counting::calls == 1);  // once per vertex
}

TEST_CASE("a texture of one colour is that colour, to the bit, for all methods") {
    const Rgb color(0.25f, 0.5f, 0.75f);
    const auto plain = build_scene<AllBsdfs, AllLights>(floor_with<AnyMaterial>(Lambert{color}));
    const auto textured = build_scene<TexturedBsdfs, AllLights>(checkered({color, color}));
    const auto check = [&](const auto& method) {
        CHECK(render(plain, method, {.samples = 4}).pixels() == render(textured, method, {.samples = 4}).pixels());
    };
    check(PathTracerNee{});
    check(Bdpt{});
    check(Vcm{});
}

TEST_CASE("methods agree about textures, and a texture that is turned over is found") {
    // At most one false alarm in 1000 runs.
    const auto scene = build_scene<TexturedBsdfs, AllLights>(checkered({Rgb(0.9f, 0.1f, 0.2f), Rgb(0.1f, 0.2f, 0.8f)}));
    const VerifyOptions options{.seconds = 0, .tolerance = 0, .seed = 5, .images = 24, .samples = 32};
    CHECK_FALSE(verify(scene, Bdpt{}, PathTracerNee{}, options).disagrees());
    const auto turned =
        build_scene<TexturedBsdfs, AllLights>(checkered({Rgb(0.1f, 0.2f, 0.8f), Rgb(0.9f, 0.1f, 0.2f)}));
    CHECK(verify(estimator(turned, PathTracerNee{}), estimator(scene, PathTracerNee{}), options).disagrees());
}

TEST_CASE("textured materials: a name that stands for two parameters gives both") {
    const Texture rough(Checkerboard{Rgb(0.5f), Rgb(0.5f)});
    const RoughConductor constants{.alpha_u = 0.2f, .alpha_v = 0.3f};
    const SurfacePoint point{};
    const auto with = [&](const char* name) {
        const RoughConductor metal = Textured<RoughConductor>(constants).set(name, rough).at({Vec2(0.5f), point});
        return Vec2(metal.alpha_u, metal.alpha_v);
    };
    CHECK(with("alpha") == Vec2(0.5f, 0.5f));
    CHECK(with("alpha_u") == Vec2(0.5f, 0.3f));
    CHECK(with("alpha_v") == Vec2(0.2f, 0.5f));
}

TEST_CASE("textured materials: what is impossible is said by the model") {
    const auto refusal = [](const AnyMaterial& material) -> std::string {
        try {
            build_any(floor_with<AnyMaterial>(material));
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    };
    CHECK(refusal(Textured<Lambert>().set("reflectance", Texture(Checkerboard{Rgb(0.5f), Rgb(1.5f)})))
              .find("reflectance has a component of 1.5") != std::string::npos);
    CHECK(refusal(Textured<RoughConductor>().set("alpha", Texture(Checkerboard{Rgb(0.5f), Rgb(-0.5f)}))) != "");
    CHECK(refusal(Textured<Lambert>().set("reflectance", Texture(Checkerboard{Rgb(0.5f), Rgb(0.25f)}))) == "");
    CHECK_THROWS_AS(Textured<Lambert>().set("alpha", Texture(Checkerboard{})), Error);
    LibraryDescription bad = floor_with<AnyMaterial>(Lambert{});
    std::get<Mesh>(bad.shapes[0].geometry).uvs.resize(5);
    CHECK_THROWS_WITH_AS(build_any(bad), doctest::Contains("4 vertices but 5 texture coordinates"), Error);
}
