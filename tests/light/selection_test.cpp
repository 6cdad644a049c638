// Lights are chosen half in proportion to the flux that they bring, and half evenly among what was described as one
// light; of many, by what they may bring to the point.

#include "../support/relative.hpp"
#include "../support/scenes.hpp"

#include <lightswitch/light/build_light_tree.hpp>

#include <doctest/doctest.h>

#include <tbb/global_control.h>

#include <set>

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

// --- trees

LightBounds random_bounds(Random& random) {
    const Vec3 at = random.next_3d();
    return {.center = 2.0f * at - 1.0f,
            .radius = random.next() < 0.5f ? 0 : 0.1f * random.next(),
            .axis = uniform_sphere(random.next_2d()),
            .cos_normals = random.next() < 0.5f ? 1 : 2 * random.next() - 1,
            .cos_emission = random.next() < 0.5f ? 0 : random.next(),
            .intensity = std::pow(10.0, 4 * double(random.next()) - 2)};
}

/// With numbers that are multiples of 3, and steps by chance.
std::vector<LightToChoose> random_lights(std::size_t count, std::uint32_t seed, std::uint32_t most_steps = 200) {
    Random random(seed);
    std::vector<LightToChoose> lights;
    for (std::uint32_t i = 0; i < count; ++i)
        lights.push_back(
            {random_bounds(random), 3 * i, 1 + static_cast<std::uint32_t>(random.next() * float(most_steps))});
    return lights;
}

LightTree tree_of(const std::vector<LightToChoose>& lights) {
    return LightTreeBuilder::build(lights, 3 * lights.size());
}

struct Receiver {
    Vec3 position, normal;
};

Receiver random_receiver(Random& random) {
    const Vec3 at = random.next_3d(), normal = uniform_sphere(random.next_2d());
    return {2.4f * at - 1.2f, random.next() < 0.2f ? Vec3(0) : normal};
}

/// Nothing is lost: the steps of all lights add up, none has less than is reserved for it, and each is chosen by as
/// many numbers as it has steps.
void check_exact(const LightTree& tree, const std::vector<LightToChoose>& lights, const Receiver& at) {
    std::uint32_t all = 0, few = 0, sum = 0, wrong = 0;
    std::vector<std::uint32_t> counted(3 * lights.size());
    for (const LightToChoose& light : lights) all += light.steps;
    REQUIRE(tree.steps() == all);
    for (std::uint32_t step = 0; step < all; ++step) ++counted[tree.choose(at.position, at.normal, step).light];
    for (const LightToChoose& light : lights) {
        const std::uint32_t steps = tree.steps_of(light.number, at.position, at.normal);
        sum += steps;
        few += steps < std::max(light.steps / 8, 1u);
        wrong += steps != counted[light.number];
    }
    CHECK(sum == all);
    CHECK(few == 0);
    CHECK(wrong == 0);
}

/// 200 lamps of every kind that has bounds, and beside them a sky and a sun.
GreyDescription many_lamps() {
    GreyDescription scene = grey_description();
    stretch_to_unit_box(scene);
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        const DVec3 at(1.6 * DVec3(random.next_3d()) - 0.8);
        const Vec3 axis = uniform_sphere(random.next_2d());
        const Rgb strength(std::pow(10.0f, 2 * random.next() - 1));
        if (i % 4 == 0) scene.add(random_triangle(random, at, 0.05), 0, strength);
        if (i % 4 == 1) scene.add(Sphere{at, 0.03, i % 8 == 1}, 0, strength);
        if (i % 4 == 2) scene.add(PointSource{at, 0.005f * strength});
        if (i % 4 == 3) scene.add(SpotSource{.position = at, .direction = DVec3(axis), .intensity = 0.01f * strength});
    }
    scene.add(EnvironmentSource{Rgb(0.02f)});
    scene.add(DirectionalSource{{0, 0, -1}, Rgb(0.05f)});
    return scene;
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
    CHECK(double(scene.light_pdf(from, -down, down, *hit).value) == relative(expected[5] * 0.25 * 0.25 / 0.04, 1e-4));
    // The sphere, seen from distance 0.5 of its centre.
    const Vec3 at(Vec3(scene.space().point({-0.5, 0, 0.5})));
    const auto ball = scene.intersect(Ray{.origin = at, .direction = down});
    REQUIRE(ball);
    CHECK(double(scene.light_pdf(at, -down, down, *ball).value) ==
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
    CHECK(black.light_pdf(from.position, {0, 0, 1}, {0, 0, -1}, *hit).value == 0);

    description.add(Source(PointSource{{0, 0, 0.2}, Rgb(1)}));
    const GreyScene lit = build_grey(description);
    int others = 0;
    for (int i = 0; i < 1000; ++i) others += !lit.sample_light(from, static_cast<float>(i) / 1000, {0.5f, 0.5f}).dirac;
    CHECK(others == 0);
}

TEST_CASE("light tree: probabilities at a point add up to one, and are how often lights are chosen") {
    Random random(7);
    for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 9u, 13u, 30u, 100u, 300u}) {
        CAPTURE(count);
        const auto lights = random_lights(count, static_cast<std::uint32_t>(count));
        const LightTree tree = tree_of(lights);
        for (int i = 0; i < 20; ++i) check_exact(tree, lights, random_receiver(random));
    }
    // So many numbers that single precision no longer holds all of their sums with a half, and one child that is not
    // there.
    const auto lights = random_lights(3, 5, 5000000);
    check_exact(tree_of(lights), lights, {Vec3(0.1f), Vec3(0)});
}

TEST_CASE("light tree: exact where nothing is ordinary") {
    const Receiver at{Vec3(0), Vec3(0, 0, 1)};
    const auto check = [&](const char* name, auto&& change) {
        CAPTURE(name);
        auto lights = random_lights(50, 3);
        for (std::size_t i = 0; i < lights.size(); ++i) change(lights[i].bounds, i);
        const LightTree tree = tree_of(lights);
        check_exact(tree, lights, at);
        check_exact(tree, lights, {lights[0].bounds.center, at.normal});
    };
    check("all at one place", [](LightBounds& b, std::size_t) { b.center = Vec3(0); });
    check("points at one place", [](LightBounds& b, std::size_t) { b.center = Vec3(0), b.radius = 0; });
    check("on a line", [](LightBounds& b, std::size_t i) { b.center = Vec3(float(i), 0, 0); });
    check("at powers of two", [](LightBounds& b, std::size_t i) { b.center = Vec3(std::exp2(-2.0f * float(i))); });
    check("one 1e12 times as bright", [](LightBounds& b, std::size_t i) { b.intensity = i == 17 ? 1e12 : 1; });
    check("dark", [](LightBounds& b, std::size_t) { b.intensity = 0; });
    check("1e30", [](LightBounds& b, std::size_t) { b.intensity = 1e30; });
    check("below the horizon", [](LightBounds& b, std::size_t) { b.center.z = -5, b.radius = 0; });
    check("far away", [](LightBounds& b, std::size_t) { b.center *= 1e18f; });
    check("wide", [](LightBounds& b, std::size_t) { b.radius = 1e18f; });
    check("no axis", [](LightBounds& b, std::size_t) { b.axis = Vec3(0); });
    check("beyond what single precision squares", [](LightBounds& b, std::size_t) { b.center *= 1e30f; });
    check("opposite directions", [](LightBounds& b, std::size_t i) {
        b.axis = Vec3(0, 0, i % 2 == 0 ? 1 : -1), b.cos_normals = 1, b.center = Vec3(0.5f), b.intensity = 1;
    });
    CHECK_FALSE(LightBounds{.center = Vec3(std::nanf(""))}.usable());
    CHECK_FALSE(LightBounds{.radius = -1}.usable());
    CHECK_FALSE(LightBounds{.intensity = double(infinity)}.usable());
}

TEST_CASE("light tree: the same for any number of threads") {
    const auto lights = random_lights(20000, 9);
    const LightTree parallel = tree_of(lights);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const LightTree serial = tree_of(lights);
    Random random(2);
    int differ = 0;
    for (int i = 0; i < 2000; ++i) {
        const Receiver at = random_receiver(random);
        const auto step = static_cast<std::uint32_t>(double(random.next()) * parallel.steps());
        const auto a = parallel.choose(at.position, at.normal, step), b = serial.choose(at.position, at.normal, step);
        differ += a.light != b.light || a.steps != b.steps;
    }
    CHECK(differ == 0);
    CHECK(parallel.bytes() == serial.bytes());
    CHECK(parallel.bytes() < 120 * lights.size());
}

// What makes it worth its time: the variance of the choice alone, that of the table over that of the tree.
TEST_CASE("light tree: chooses lights by what they bring to the point") {
    Random random(4);
    constexpr std::size_t count = 1000;
    std::vector<LightToChoose> lights;
    for (std::uint32_t i = 0; i < count; ++i) {
        LightBounds bounds = random_bounds(random);
        bounds.radius = 0;
        bounds.cos_normals = 1;
        bounds.cos_emission = 0;
        bounds.intensity = 1;
        lights.push_back({bounds, i, 16777});
    }
    const LightTree tree = LightTreeBuilder::build(lights, count);
    double by_table = 0, by_tree = 0;
    for (int i = 0; i < 100; ++i) {
        const Receiver at = random_receiver(random);
        if (at.normal == Vec3(0)) continue;
        double sum = 0, table = 0, chosen = 0;
        for (const LightToChoose& light : lights) {
            const DVec3 to_light(light.bounds.center - at.position);
            const double distance = glm::length(to_light);
            const double brings = std::max(glm::dot(to_light, DVec3(at.normal)), 0.0) *
                                  std::max(-glm::dot(to_light, DVec3(light.bounds.axis)), 0.0) / std::pow(distance, 4);
            sum += brings;
            table += brings * brings * count;
            chosen += brings * brings * tree.steps() / tree.steps_of(light.number, at.position, at.normal);
        }
        if (!(sum > 0)) continue;
        by_table += table / (sum * sum) - 1;
        by_tree += chosen / (sum * sum) - 1;
    }
    CAPTURE(by_tree);
    CHECK(by_table > 10 * by_tree);
}

TEST_CASE("light tree: beside lights without bounds, all in the table's share") {
    Random random(6);
    constexpr std::size_t count = 60;
    std::vector<double> weights(count);
    for (double& weight : weights) weight = double(random.next());
    weights[5] = weights[40] = 0;
    const DiscreteDistribution table(weights);
    std::vector<LightToChoose> bounded;
    for (std::uint32_t i = 0; i < count; ++i)
        if (i % 3 != 0 && weights[i] > 0)
            bounded.push_back({random_bounds(random), i, static_cast<std::uint32_t>(table.probability(i) * 0x1p24f)});
    const detail::LightChoice choice(table, LightTreeBuilder::build(bounded, count));

    SurfacePoint from;
    from.position = Vec3(0.2f, -0.3f, 0.1f);
    from.normal = from.shading_normal = from.wo = Vec3(0, 0, 1);
    std::vector<std::uint32_t> counted(count);
    std::set<std::pair<std::size_t, float>> said;
    for (std::uint32_t u = 0; u < 1u << 24; ++u) {
        const auto chosen = choice.at(from, static_cast<float>(u) * 0x1p-24f);
        ++counted[chosen.number];
        if (u % 1024 == 0) said.insert({chosen.number, chosen.probability});
    }
    for (const auto& [number, probability] : said) CHECK(probability == static_cast<float>(counted[number]) * 0x1p-24f);
    for (std::size_t i = 0; i < count; ++i) {
        CAPTURE(i);
        const float probability = choice.probability_at(from.position, from.lit_normal(), i);
        CHECK(probability == static_cast<float>(counted[i]) * 0x1p-24f);
        if (i % 3 == 0) CHECK(probability == table.probability(i));
        CHECK(choice.start_probability(i) == table.probability(i));
        if (probability > 0) CHECK(choice.over_start(from, i) == probability / table.probability(i));
    }
}

TEST_CASE("light tree: a scene's densities of what it samples and what is met, and of light paths") {
    const GreyScene scene = build_grey(many_lamps()), table = build_grey(many_lamps(), 1000);
    CHECK(scene.statistics().tree_lights == 200);
    CHECK(scene.statistics().light_tree_bytes > 0);
    CHECK(table.statistics().tree_lights == 0);
    const Vec3 up(0, 0, 1);
    CHECK(scene.environment_pdf(up, up).value == table.environment_pdf(up, up).value);

    Random random(3);
    int met = 0, other = 0;
    for (int i = 0; i < 20000; ++i) {
        SurfacePoint from = free_point(scene, 1.8 * DVec3(random.next_3d()) - 0.9, uniform_sphere(random.next_2d()));
        if (i % 5 == 0) from.material = MaterialIndex(0, 0, MaterialIndex::through);
        const LightSample s = scene.sample_light(from, random.next(), random.next_2d());
        if (!(s.pdf.value > 0) || s.dirac || scene.occluded(s.visibility)) continue;
        const auto hit = scene.intersect(Ray{.origin = from.position, .direction = s.wi});
        if (!hit || !hit->light || std::abs(dot(hit->normal, s.wi)) < 0.05f || hit->distance < 0.01f) continue;
        ++met;
        const double density = double(scene.light_pdf(from.position, from.lit_normal(), s.wi, *hit).value);
        CHECK(density == relative(double(s.pdf.value), 1e-3));
        CHECK(double(scene.spread(hit->light, from, s.wi, hit->position)) == relative(double(s.spread), 2e-3));
        // The spread holds the probabilities of choosing the light by both roads.
        scene.with_light(hit->light, [&]<class L>(const L& light) {
            if constexpr (AreaLight<L>) {
                const double here = density / double(light.pdf(from.position, s.wi, *hit).value);
                const double start =
                    double(scene.emission_pdf(*hit, -s.wi).value) / double(light.emission_pdf(*hit, -s.wi).value);
                CHECK(double(s.spread) ==
                      relative(double(light.spread(from, s.wi, hit->position)) * here / start, 2e-3));
                other += std::abs(here / start - 1) > 0.5;
            }
        });
    }
    CHECK(met > 2000);
    CHECK(other > 1000);
}
