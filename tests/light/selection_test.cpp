// Lights are chosen half in proportion to the flux that they bring, and half evenly among what was described as one
// light.

#include "../support/relative.hpp"
#include "../support/scenes.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr double pi_d = 3.14159265358979323846;

/// One light of each kind, three of them surfaces with 4 triangles and 2 spheres.
GreyDescription all_lights() {
    GreyDescription scene = grey_description();
    stretch_to_unit_box(scene);
    scene.add(rectangle(DMat4({0.2, 0, 0, 0}, {0, 0.1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0.5, 1})), 0, Rgb(3, 2, 1));
    scene.add(Source(PointSource{{0.5, 0.5, 0.5}, Rgb(0.1f)}));
    scene.add(Sphere{{-0.5, 0, 0}, 0.1, false}, 0, Rgb(5));
    scene.add(Source(EnvironmentSource{Rgb(0.02f, 0.03f, 0.04f)}));
    scene.add(Source(DirectionalSource{{0, 0, -2}, Rgb(0.1f, 0.2f, 0.3f)}));
    scene.add(Mesh{.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.3, 0}, {0, 0, 0.2}},
                   .normals = {},
                   .triangles = {{0, 1, 2}, {0, 2, 3}}},
              0, Rgb(2));
    scene.add(Sphere{{-0.5, 0.5, 0}, 0.2, true}, 0, Rgb(1, 0, 0));
    return scene;
}

/// Probabilities that follow from the luminous flux into the scene, in light numbers: by kind in the order of
/// `AllLights`, then as described.
std::vector<double> probabilities() {
    const double radius2 = 3 * 0.9999 * 0.9999;  // of the sphere around the box
    const std::vector<double> flux{luminance(DVec3(0.02, 0.03, 0.04)) * pi_d * pi_d * radius2,
                                   luminance(DVec3(0.1, 0.2, 0.3)) * pi_d * radius2,
                                   0.1 * 4 * pi_d,
                                   5 * pi_d * 4 * pi_d * 0.01,
                                   luminance(DVec3(1, 0, 0)) * pi_d * 4 * pi_d * 0.04,
                                   luminance(DVec3(3, 2, 1)) * pi_d * 0.04,
                                   luminance(DVec3(3, 2, 1)) * pi_d * 0.04,
                                   2 * pi_d * 0.015,
                                   2 * pi_d * 0.03};
    // Of the seven lights that were described, the last two have two triangles each.
    const double share[] = {1, 1, 1, 1, 1, 0.5, 0.5, 1.0 / 3, 2.0 / 3};
    const double total = std::accumulate(flux.begin(), flux.end(), 0.0);
    std::vector<double> result;
    for (std::size_t i = 0; i < flux.size(); ++i) result.push_back(0.5 * flux[i] / total + 0.5 * share[i] / 7);
    return result;
}

}  // namespace

TEST_CASE("light selection: by flux and evenly, and the probabilities are those with which samples are made") {
    const GreyScene scene = build_grey(all_lights());
    const std::vector<double> expected = probabilities();
    REQUIRE(scene.light_count() == expected.size());
    CHECK(scene.statistics().lights == expected.size());

    // Numbers at equal steps choose as often as the probabilities say, to a few steps.
    constexpr int steps = 100000;
    const SurfacePoint from = free_point(scene, {0.05, 0.05, 0.05}, {0, 0, 1});
    int dirac = 0;
    for (int i = 0; i < steps; ++i)
        dirac += scene.sample_light(from, (static_cast<float>(i) + 0.5f) / steps, {0.3f, 0.6f}).dirac;
    CHECK(dirac / double(steps) == relative(expected[1] + expected[2], 1e-3));

    std::size_t number = 0;
    for (std::size_t kind = 0; kind < 7; ++kind) {
        const std::size_t of_kind[] = {1, 0, 1, 1, 0, 2, 4};
        for (std::size_t position = 0; position < of_kind[kind]; ++position, ++number)
            CHECK(scene.light_number(TypedIndex(kind, position)) == number);
    }
    // The point light's density is its probability of being chosen, the environment's contains it.
    const Vec3 up(0, 0, 1);
    CHECK(double(scene.environment_pdf(up, up).value) == relative(expected[0] / pi_d, 1e-5));
    bool point_seen = false;
    for (int i = 0; i < steps; ++i) {
        const LightSample s = scene.sample_light(from, (static_cast<float>(i) + 0.5f) / steps, {0.3f, 0.6f});
        if (!s.dirac || s.wi.z > 0.999f) continue;
        point_seen = true;
        CHECK(double(s.pdf.value) == relative(expected[2], 1e-5));
        break;
    }
    CHECK(point_seen);
}

TEST_CASE("light selection: the density of a hit contains the probability of its light") {
    const GreyScene scene = build_grey(all_lights());
    const std::vector<double> expected = probabilities();
    // The rectangle at z = 0.5, seen from the front at distance 0.25: two triangles of area 0.04.
    const Vec3 down(0, 0, -1), from(Vec3(scene.space().point({0.05, 0.02, 0.75})));
    const auto hit = scene.intersect(Ray{.origin = from, .direction = down});
    REQUIRE(hit);
    CHECK(double(scene.light_pdf(from, down, *hit).value) == relative(expected[5] * 0.25 * 0.25 / 0.04, 1e-4));
    // The sphere, seen from distance 0.5 of its centre.
    const Vec3 at(Vec3(scene.space().point({-0.5, 0, 0.5})));
    const auto ball = scene.intersect(Ray{.origin = at, .direction = down});
    REQUIRE(ball);
    CHECK(double(scene.light_pdf(at, down, *ball).value) ==
          relative(expected[3] / (2 * pi_d * (1 - std::sqrt(1 - 0.04))), 1e-4));
}

TEST_CASE("light selection: emitters sum up what was described, in the order of sources and shapes") {
    const GreyScene scene = build_grey(all_lights());
    const auto& emitters = scene.emitters();
    REQUIRE(emitters.size() == 7);
    const auto of = [&](Emitter::Kind kind, std::size_t which = 0) {
        for (const Emitter& e : emitters)
            if (e.kind == kind && which-- == 0) return e;
        FAIL("no such emitter");
        return Emitter{};
    };
    const Emitter quad = of(Emitter::Kind::surface, 0);
    CHECK(quad.strength == Rgb(3, 2, 1));
    CHECK(quad.area == relative(0.08, 1e-5));
    CHECK(quad.vector_area.z == relative(0.08, 1e-5));
    CHECK(glm::length(quad.position - Vec3(0, 0, 0.5f)) < 1e-6f);
    CHECK(quad.first_light == 5);
    CHECK(quad.light_count == 2);
    const Emitter ball = of(Emitter::Kind::surface, 1);
    CHECK(ball.area == relative(4 * pi_d * 0.01, 1e-5));
    CHECK(ball.first_light == 3);
    CHECK(ball.light_count == 1);
    const Emitter wings = of(Emitter::Kind::surface, 2);
    CHECK(wings.area == relative(0.045, 1e-5));
    CHECK(wings.vector_area.z == relative(0.015, 1e-5));
    CHECK(wings.vector_area.x == relative(0.03, 1e-5));
    CHECK(wings.first_light == 7);
    CHECK(of(Emitter::Kind::surface, 3).first_light == 4);
    CHECK(of(Emitter::Kind::environment).first_light == 0);
    CHECK(of(Emitter::Kind::environment).strength == Rgb(0.02f, 0.03f, 0.04f));
    const Emitter sun = of(Emitter::Kind::directional);
    CHECK(sun.first_light == 1);
    CHECK(sun.direction == Vec3(0, 0, 1));
    const Emitter lamp = of(Emitter::Kind::point);
    CHECK(lamp.first_light == 2);
    CHECK(glm::length(lamp.position - Vec3(0.5f)) < 1e-6f);
    CHECK(lamp.strength.x == relative(0.1, 1e-5));
}

TEST_CASE("light selection: a light without strength is never chosen, and a scene without light stays black") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    const GreyScene dark = build_grey(description);
    const SurfacePoint from = free_point(dark, {0, 0, 0});
    CHECK(dark.light_count() == 0);
    CHECK(dark.sample_light(from, 0.5f, {0.5f, 0.5f}).pdf.value == 0);
    CHECK(is_black(dark.environment({0, 0, 1})));
    CHECK(dark.environment_pdf({0, 0, 1}, {0, 0, 1}).value == 0);

    // Black lights are lights by type only.
    description.add(Source(EnvironmentSource{Rgb(0)}));
    description.add(Sphere{{0, 0, 0.5}, 0.1, false}, 0, Rgb(0));
    description.add(rectangle(DMat4({0.1, 0, 0, 0}, {0, 0.1, 0, 0}, {0, 0, 1, 0}, {0, 0, -0.5, 1})), 0, Rgb(0));
    const GreyScene black = build_grey(description);
    CHECK(black.light_count() == 4);
    CHECK(black.sample_light(from, 0.5f, {0.5f, 0.5f}).pdf.value == 0);
    CHECK(black.environment_pdf({0, 0, 1}, {0, 0, 1}).value == 0);
    const auto hit = black.intersect(Ray{.origin = from.position, .direction = {0, 0, -1}});
    REQUIRE(hit);
    CHECK(is_black(black.emitted(*hit, {0, 0, 1})));
    CHECK(black.light_pdf(from.position, {0, 0, -1}, *hit).value == 0);

    description.add(Source(PointSource{{0, 0, 0.2}, Rgb(1)}));
    const GreyScene lit = build_grey(description);
    int others = 0;
    for (int i = 0; i < 1000; ++i) others += !lit.sample_light(from, static_cast<float>(i) / 1000, {0.5f, 0.5f}).dirac;
    CHECK(others == 0);
}
