#include <lightswitch/scene/stock.hpp>

#include <doctest/doctest.h>

#include <map>

using namespace lightswitch;

TEST_CASE("stock scenes: every name is described, built, and seen by its camera") {
    for (const std::string_view name : stock::names) {
        CAPTURE(name);
        const auto description = stock::describe(name);
        REQUIRE(description);
        CHECK(description->name == name);
        const AnyScene any = build_any(*description, {.embree_config = "threads=1"});
        std::visit(
            [&](const auto& scene) {
                CHECK(scene.statistics().degenerate_triangles == 0);
                CHECK(scene.light_count() > 0);
                int hits = 0, lights = 0;
                for (int y = 0; y < 16; ++y)
                    for (int x = 0; x < 16; ++x) {
                        const float step = static_cast<float>(scene.film().width) / 16;
                        const auto hit = scene.intersect(scene.camera().ray(
                            {(static_cast<float>(x) + 0.5f) * step, (static_cast<float>(y) + 0.5f) * step},
                            {0.5f, 0.5f}));
                        hits += hit.has_value();
                        lights += hit && hit->light;
                    }
                CHECK(hits > 128);
                CHECK(lights > 0);
            },
            any);
    }
    CHECK_FALSE(stock::describe("cornell"));
    CHECK_FALSE(stock::describe(""));
}

TEST_CASE("stock scenes: built ones are the described ones") {
    CHECK(stock::cornell_box().name() == "cornell-box");
    CHECK(stock::cornell_box().statistics().triangles == 36);
    CHECK(stock::cornell_spheres().statistics().spheres == 2);
    CHECK(stock::cornell_sculpture().statistics().triangles == 12812);
    CHECK(stock::furnace().statistics().lights == 12);
}

TEST_CASE(
    "stock scenes: the room of the Cornell box is closed but for the side of the camera, and fronts look inwards") {
    const auto scene = stock::cornell_box();
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)}) {
        const auto hit =
            scene.intersect(Ray{.origin = Vec3(scene.space().point({0.04, 0.5, 0.01})), .direction = direction});
        REQUIRE(hit);
        CHECK(dot(hit->normal, direction) == doctest::Approx(-1));
    }
    CHECK_FALSE(scene.intersect(Ray{.origin = Vec3(scene.space().point({0, 0.5, 0})), .direction = {0, 0, 1}}));
    // The lamp shines down.
    const auto lamp =
        scene.intersect(Ray{.origin = Vec3(scene.space().point({0.04, 0.5, 0.01})), .direction = {0, 1, 0}});
    CHECK(lamp->light);
    CHECK(scene.emitted(*lamp, {0, -1, 0}).x == doctest::Approx(18.387));
}

TEST_CASE("stock scenes: the torus knot is closed, and its normals look outwards") {
    const Mesh knot = stock::torus_knot(60, 10);
    // Closed and oriented: every edge is used once in each direction.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : knot.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    int unmatched = 0;
    for (const auto& [edge, count] : edges) unmatched += count != 1 || !edges.count({edge.second, edge.first});
    CHECK(unmatched == 0);
    double volume = 0;
    int inverted = 0;
    for (const auto& t : knot.triangles) {
        const DVec3 a = knot.positions[t[0]], b = knot.positions[t[1]], c = knot.positions[t[2]];
        volume += glm::dot(a, glm::cross(b, c)) / 6;
        inverted +=
            glm::dot(glm::cross(b - a, c - a), knot.normals[t[0]] + knot.normals[t[1]] + knot.normals[t[2]]) <= 0;
    }
    CHECK(volume > 0);
    CHECK(inverted == 0);
}
