// Guided path tracing: the density of what it learns is that of its samples, it sees the image of path tracing, and
// what it has learnt before an iteration follows from the iteration alone.

#include "method/bidirectional.hpp"
#include "support/chi_square.hpp"
#include "support/relative.hpp"
#include "support/renders.hpp"
#include "support/statistics.hpp"

#include <lightswitch/method/path_guided.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// Radiance from a narrow cone, and a little from everywhere.
float narrow_light(const Vec3& w) { return dot(w, normalize(Vec3(0.3f, -0.5f, 0.8f))) > 0.95f ? 20.0f : 0.2f; }

/// A guide that has learnt `radiance` in some passes, from directions chosen by itself.
template <class Radiance>
DirectionTree learnt(const Radiance& radiance, int passes, int samples) {
    DirectionTree tree;
    DirectionSums sums;
    Random random(5);
    for (int pass = 0; pass < passes; ++pass) {
        for (int i = 0; i < samples; ++i) {
            const GuidingMixture mixture{&tree, 0.5f};
            const Vec3 w = random.next() < 0.5f ? uniform_sphere(random.next_2d()) : mixture.sample(random.next_2d());
            const double pdf = double(mixture.density(uniform_sphere_pdf(), mixture.guide(w)).value);
            sums.add(octahedron::to_square(w), double(radiance(w)) / pdf, double(uniform_sphere_pdf().value) / pdf);
        }
        tree = sums.tree();
        sums.refit(tree, 0.5);
    }
    return tree;
}

/// Guides from the first iteration on, whether that pays or not.
PathGuided guided(int depth = -1) {
    return {.max_depth = depth, .first_training = 32, .training = 1, .always_guide = true};
}

double statistic(const RenderStatistics& statistics, std::string_view name) {
    for (const auto& [key, value] : statistics.of_method)
        if (key == name) return value;
    FAIL("no statistic of the name ", name);
    return 0;
}

}  // namespace

TEST_CASE("octahedron: places and directions belong together") {
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const Vec2 place = random.next_2d();
        const Vec3 w = octahedron::to_direction(place);
        CHECK(std::abs(length_squared(w) - 1) < 1e-6f);
        const Vec2 back = octahedron::to_square(w);
        CHECK(std::abs(back.x - place.x) < 1e-6f);
        CHECK(std::abs(back.y - place.y) < 1e-6f);
    }
    for (const float z : {-1.0f, 1.0f}) {
        const Vec3 pole = octahedron::to_direction(octahedron::to_square(Vec3(0, 0, z)));
        CHECK(std::abs(pole.z - z) < 1e-6f);
    }
}

// False alarm: 1e-4 each.
TEST_CASE("what a guide samples has the density that it says, and that integrates to 1") {
    for (const int passes : {0, 1, 4}) {
        const DirectionTree tree = learnt(narrow_light, passes, 20000);
        const GuidingMixture mixture{&tree, 0};
        const auto test = chi_square_sphere([&](const Vec3& u) { return std::optional(mixture.sample(Vec2(u))); },
                                            [&](const Vec3& w) { return double(mixture.guide(w).value); },
                                            {.axis = {0, 0, 1}}, 200000, 7);
        CHECK(std::abs(test.integral - 1) < 2e-3);
        CHECK_MESSAGE(test.chi_square.p_value > 1e-4, passes, " passes: ", test.chi_square);
    }
}

TEST_CASE("a guide is learnt: directions from which more comes are chosen more often") {
    const DirectionTree tree = learnt(narrow_light, 4, 20000);
    const GuidingMixture mixture{&tree, 0};
    Random random(3);
    int found = 0;
    for (int i = 0; i < 10000; ++i) found += narrow_light(mixture.sample(random.next_2d())) > 1;
    // The cone holds 1/40 of the sphere and 0.72 of the light.
    CHECK(found > 5500);
    CHECK(tree.nodes() <= DirectionTree::max_nodes);
    // Light of another strength is the same.
    const DirectionTree strong = learnt([](const Vec3& w) { return 0x1p80f * narrow_light(w); }, 4, 20000);
    const DirectionTree weak = learnt([](const Vec3& w) { return 0x1p-80f * narrow_light(w); }, 4, 20000);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 place = random.next_2d();
        CHECK(strong.density(place) == tree.density(place));
        CHECK(weak.density(place) == tree.density(place));
    }
    // Nothing at all, and one sample that outshines all others, teach next to nothing.
    const DirectionTree dark = learnt([](const Vec3&) { return 0.0f; }, 2, 20000);
    const double there = double(GuidingMixture{&dark, 0}.guide(Vec3(0, 0.6f, 0.8f)).value);
    CHECK(there * 4 * double(pi) == relative(1, 0.4));
    DirectionSums sums;
    for (int i = 0; i < 4096; ++i) sums.add(random.next_2d(), i == 0 ? 1e30 : 1, 1);
    const DirectionTree outlier = sums.tree();
    double sum = 0;
    for (int i = 0; i < 1000; ++i) sum += double(outlier.density(random.next_2d())) / 1000;
    CHECK(sum > 0.6);
}

// False alarm: 1e-3 in each test case that compares means.

TEST_CASE("path-guided: agrees with path tracing") {
    const auto cases = transport_cases();
    for (const TransportCase& c : cases) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
        const TileEstimates truth = replicate_finite(scene, PathTracerNee{}, 8, 16, 2 * c.samples, 1);
        const TileEstimates ours = replicate_finite(scene, guided(), 8, 16, c.samples, 401);
        const Comparison comparison = compare(ours, truth, 1e-3, static_cast<int>(cases.size()));
        CHECK_MESSAGE(comparison.agree(), c.name, ": ", comparison);
    }
}

TEST_CASE("path-guided: each limit of the path length") {
    const TransportCase cases[] = {{"cornell-box", scenes::on_small_film(stock::describe_cornell_box())},
                                   {"ajar-door", scenes::on_small_film(stock::describe_ajar_door())},
                                   {"stage under all", scenes::stage_under_all()},
                                   {"rough metals", scenes::rough_metals()}};
    for (const TransportCase& c : cases) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
        for (const int depth : {2, 3, 4}) {
            const TileEstimates truth = replicate_finite(scene, PathTracerNee{.max_depth = depth}, 8, 16, 128, 1);
            const TileEstimates ours = replicate_finite(scene, guided(depth), 8, 16, 64, 401);
            const Comparison comparison = compare(ours, truth, 1e-3, 12);
            CHECK_MESSAGE(comparison.agree(), c.name, ", depth ", depth, ": ", comparison);
        }
    }
}

TEST_CASE("path-guided: nothing at depth 0, emission alone at depth 1, path-nee before anything is learnt") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    CHECK(render(scene, guided(0), {.samples = 1}).mean() == DVec3(0));
    for (const int depth : {1, -1}) {
        PathGuided method{.max_depth = depth, .first_training = 0, .training = 0, .always_guide = true};
        CHECK(identical(render(scene, method, {.samples = 2}),
                        render(scene, PathTracerNee{.max_depth = depth}, {.samples = 2})));
    }
    const FullScene dark = build_scene<AllBsdfs, AllLights>(scenes::hollow_sphere());
    CHECK(render(dark, guided(), {.samples = 2}).mean() == DVec3(0));
}

TEST_CASE("path-guided: the same bits for any threads, for any parts, and in whatever order") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(stock::describe_ajar_door()));
    const PathGuided method = guided();
    Session whole(scene, method, {.seed = 3, .threads = 1});
    whole.run({.samples = 40});
    CHECK(statistic(whole.statistics(), "guided_share") > 0.1);
    CHECK(statistic(whole.statistics(), "guiding_bytes") > 0);
    CHECK(statistic(whole.statistics(), "training_paths") > 32 * 256);
    const Image image = whole.image();
    CHECK_FALSE(identical(image, render(scene, PathTracerNee{}, {.samples = 40}, {.seed = 3})));

    Session parts(scene, method, {.seed = 3, .threads = 2});
    for (const int samples : {7, 8, 23, 40}) parts.run({.samples = samples});
    CHECK(identical(parts.image(), image));
    // What a session has learnt does not show: an iteration is the same in one that begins with it.
    const Film alone = parts.film_of(33), early = parts.film_of(2);
    Session later(scene, method, {.seed = 3, .threads = 1, .first_iteration = 33});
    later.run({.samples = 1});
    CHECK(identical(later.image(), alone.image()));
    CHECK(identical(later.film_of(2).image(), early.image()));
}

TEST_CASE("path-guided: light of any strength, and scenes of any size, have the same bits") {
    const LibraryDescription description = scenes::on_small_film(stock::describe_ajar_door());
    const Image image = render(build_scene<AllBsdfs, AllLights>(description), guided(), {.samples = 4}, {.threads = 1});
    for (const int k : {-30, 30})
        CHECK(identical(render(build_scene<AllBsdfs, AllLights>(scaled(description, k)), guided(), {.samples = 4}),
                        image));
    for (const int k : {-90, 90}) {
        LibraryDescription strong = description;
        for (auto& shape : strong.shapes)
            if (shape.emission) *shape.emission *= std::ldexp(1.0f, k);
        Image scaled_back = render(build_scene<AllBsdfs, AllLights>(strong), guided(), {.samples = 4}, {.threads = 1});
        for (Rgb& pixel : scaled_back.pixels()) pixel *= std::ldexp(1.0f, -k);
        CHECK(identical(scaled_back, image));
    }
}

// With these seeds the first ratio was 0.61; it is 1 where nothing is learnt.
TEST_CASE("path-guided: less noise where light comes through a gap, and path-nee's image where it does not pay") {
    LibraryDescription door = stock::describe_ajar_door();
    door.film.width = door.film.height = 48;
    const FullScene scene = build_scene<AllBsdfs, AllLights>(door);
    const auto variance = [&](const auto& method) {
        Session session(scene, method, {.seed = 1});
        session.run({.samples = 64});
        double sum = 0;
        for (const Rgb& pixel : session.film().variance().pixels()) sum += std::sqrt(double(luminance(pixel)));
        return sum * sum;
    };
    PathGuided method = guided();
    method.first_training = 256;
    const double ratio = variance(method) / variance(PathTracerNee{});
    CAPTURE(ratio);
    CHECK(ratio < 0.8);

    LibraryDescription box = stock::describe_cornell_box();
    box.film.width = box.film.height = 32;
    const FullScene plain = build_scene<AllBsdfs, AllLights>(box);
    CHECK(identical(render(plain, PathGuided{}, {.samples = 4}), render(plain, PathTracerNee{}, {.samples = 4})));
}
