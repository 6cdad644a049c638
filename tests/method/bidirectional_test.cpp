// Methods that start paths at the lights see the same image as those that start at the camera. Here few samples, so
// that it is quick; more of them, and all path lengths, in bidirectional_long_test.cpp.

#include "bidirectional.hpp"

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 in each test case.

TEST_CASE("bidirectional: agrees with path tracing wherever both can see") {
    const auto cases = transport_cases();
    for (const TransportCase& c : cases) check_against_path_nee(c, {-1}, 8, 1e-3, static_cast<int>(cases.size()));
}

TEST_CASE("bidirectional: each limit of the path length") {
    const TransportCase box{"cornell-box", scenes::on_small_film(stock::describe_cornell_box())};
    check_against_path_nee(box, {1, 2, 3, 4, 5}, 8, 1e-3, 2);
    const TransportCase all{"stage under all", scenes::stage_under_all()};
    check_against_path_nee(all, {1, 2, 3, 4, 5}, 8, 1e-3, 2);
}

// Densities that are wrong where a tree chooses lights are the same in all methods: the truth is of the scene without.
TEST_CASE("bidirectional: each limit of the path length where a tree chooses among many lamps") {
    const TransportCase c{"scattered lamps", scenes::scattered_lamps()};
    const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
    REQUIRE(scene.statistics().tree_lights == 300);
    const FullScene table = build_scene<AllBsdfs, AllLights>(c.description, {.tree_from = 1000});
    REQUIRE(table.statistics().tree_lights == 0);
    constexpr int depths[] = {1, 2, 3, 4, -1}, share = 2 * static_cast<int>(std::size(depths));
    for (const int depth : depths) {
        const auto truth = replicate_finite(table, PathTracerNee{.max_depth = depth}, 8, 8, 128, 1);
        check_bidirectional(c, scene, truth, depth, 8, 1e-3, share);
        const auto nee = replicate_finite(scene, PathTracerNee{.max_depth = depth}, 8, 8, 64, 401);
        const Comparison comparison = compare(nee, truth, 1e-3, share);
        CHECK_MESSAGE(comparison.agree(), "path-nee, depth ", depth, ": ", comparison);
    }
}

TEST_CASE("bidirectional: nothing at depth 0, emission alone at depth 1") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    const auto check = [&](auto method) {
        method.max_depth = 0;
        CHECK(render(scene, method, {.samples = 1}).mean() == DVec3(0));
        method.max_depth = 1;
        // The camera's rays are those of path tracing.
        CHECK(identical(render(scene, method, {.samples = 2}),
                        render(scene, PathTracerNee{.max_depth = 1}, {.samples = 2})));
    };
    check(Bdpt{});
    check(Vcm{});
    check(LightTracer{});
}

TEST_CASE("bidirectional: furnaces are geometric series") {
    constexpr float albedos[] = {0.2f, 0.5f, 0.8f};
    for (const float albedo : albedos)
        for (const int depth : {3, -1}) {
            const double a = double(albedo), expected = depth < 0 ? 1 / (1 - a) : (1 - std::pow(a, depth)) / (1 - a);
            const TileEstimates truth = known_tiles(2, 2, 8, expected);
            TransportCase box{"furnace " + std::to_string(albedo),
                              scenes::on_small_film(stock::describe_furnace(albedo))};
            box.samples = 8;
            check_bidirectional(box, build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box.description), truth, depth,
                                12, 1e-3, 12);
            TransportCase ball{"sphere " + std::to_string(albedo), scenes::furnace_sphere(albedo)};
            ball.samples = 8;
            check_bidirectional(ball, build_scene<Bsdfs<Lambert>, Lights<SphereLight>>(ball.description), truth, depth,
                                12, 1e-3, 12);
        }
}

TEST_CASE("bidirectional: a white sphere vanishes before a white sky") {
    const TransportCase c{"white sphere", scenes::white_sphere_in_white()};
    const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
    check_bidirectional(c, scene, known_tiles(2, 2, 8, 1), -1, 32, 1e-3, 1);
}

TEST_CASE("bidirectional: roulette from the first bounce on changes nothing") {
    for (const auto& [name, description] : {std::pair{"lamp in sphere", scenes::lamp_in_sphere()},
                                            std::pair{"smooth normals", scenes::smooth_normals()}}) {
        const TransportCase c{name, description};
        const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
        check_bidirectional(c, scene, replicate_finite(scene, PathTracerNee{}, 8, 16, 32), -1, 16, 1e-3, 2, 1);
    }
}

// A connection close to the light has no large value: its weight is small where next event estimation would be better.
// Converged, the brightest pixel is no brighter; the weights let single paths exceed it by a factor that is small too.
TEST_CASE("bidirectional: a point light in a closed box makes no fireflies") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::point_in_box());
    const auto brightest = [&](const auto& method) {
        float result = 0;
        const Image image = render(scene, method, {.samples = 32});
        for (const Rgb& p : image.pixels()) result = std::max(result, max_component(p));
        return result;
    };
    const float expected = brightest(PathTracerNee{});
    CHECK(brightest(Bdpt{}) < 1.3f * expected);
    CHECK(brightest(connections_only(-1)) < 1.3f * expected);
    CHECK(brightest(Vcm{}) < 1.3f * expected);
}

TEST_CASE("bidirectional: counts") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    const auto counts = [&](const auto& method) {
        Session<FullScene, std::remove_cvref_t<decltype(method)>> session(scene, method);
        session.run({.samples = 3});
        return session.statistics().counts;
    };
    // One light path for every pixel. Of its vertices, one at depth 2, at most two at depth 3, most are not on the
    // film.
    const RenderCounts one = counts(LightTracer{.max_depth = 2}), two = counts(LightTracer{.max_depth = 3});
    CHECK(one.paths == 3 * 256);
    CHECK(one.splats > 40);
    CHECK(one.splats < 3 * 256);
    CHECK(two.paths == 3 * 256);
    CHECK(two.splats > one.splats);
    CHECK(two.splats < 2 * 3 * 256);
    // The camera's rays, the light paths' first segments, and their visibility from the camera.
    CHECK(one.rays == 2 * 3 * 256 + one.shadow_rays);
    CHECK(one.shadow_rays >= one.splats / 2);
    CHECK(one.shadow_rays <= 3 * 256);
    const RenderCounts bdpt = counts(Bdpt{.max_depth = 3});
    CHECK(bdpt.paths == 0);  // its light paths belong to pixels
    CHECK(bdpt.splats > 40);
    CHECK(bdpt.splats < 2 * 3 * 256);
    CHECK(counts(connections_only(3)).paths == 3 * 256);
}
