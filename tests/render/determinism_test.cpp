// A render is a pure function of scene, method, seed and number of iterations.

#include "support/light_tracer.hpp"
#include "support/random_scenes.hpp"
#include "support/renders.hpp"
#include "support/statistics.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>
#include <lightswitch/method/photon_mapping.hpp>
#include <lightswitch/method/vcm.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

bool identical_films(const Film& a, const Film& b) {
    return a.iterations() == b.iterations() && identical(a.image(), b.image()) && identical(a.variance(), b.variance());
}

/// All that must not change the result, for one method.
template <class SceneType, class M>
void check_determinism(const SceneType& scene, const M& method) {
    for (const Sampling sampling : {Sampling::sobol, Sampling::independent}) {
        const Settings settings{.seed = 5, .sampling = sampling};
        Session<SceneType, M, SerialExecutor> serial(scene, method, settings, {});
        serial.run({.samples = 8});
        REQUIRE(serial.film().iterations() == 8);

        for (const int threads : {1, 2, 8}) {
            Session<SceneType, M> parallel(scene, method, {.seed = 5, .threads = threads, .sampling = sampling});
            parallel.run({.samples = 8});
            CHECK(parallel.statistics().threads == threads);
            CHECK(identical_films(parallel.film(), serial.film()));
            CHECK(parallel.statistics().counts.rays == serial.statistics().counts.rays);
            CHECK(parallel.statistics().counts.splats == serial.statistics().counts.splats);
        }

        Session<SceneType, M> continued(scene, method, settings);
        for (const int samples : {3, 3, 8}) {
            continued.run({.samples = samples});
            CHECK(continued.film().iterations() == std::uint64_t(samples));
        }
        CHECK(identical_films(continued.film(), serial.film()));

        const Image once = render(scene, method, {.samples = 8}, settings);
        CHECK(identical(once, render(scene, method, {.samples = 8}, settings)));
        CHECK(identical(once, serial.film().image()));
        CHECK_FALSE(identical(once, render(scene, method, {.samples = 8}, {.seed = 6, .sampling = sampling})));
    }
}

}  // namespace

TEST_CASE("path tracing is the same for any threads, and when continued") {
    // Sides that are no multiples of a tile, and more than one tile.
    LibraryDescription description = random_scene(3);
    description.film.width = 53;
    description.film.height = 37;
    check_determinism(build_scene<AllBsdfs, AllLights>(description), PathTracerNee{});
    const LibraryDescription box = small_box(40, 24);
    check_determinism(build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box), PathTracerNee{});
}

TEST_CASE("Phong is the same for any threads, and when continued") {
    const LibraryDescription box = small_box(40, 24);
    check_determinism(build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box), Phong{});
}

TEST_CASE("splats are the same for any threads, and when continued") {
    const LibraryDescription box = small_box();
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box);
    test::PlainLightTracer method = light_tracer_for(box, scene);
    method.bounces = 3;
    method.paths = 10000;  // several work units, the last one not full
    check_determinism(scene, method);
}

namespace {

LibraryDescription light_scene() {
    LibraryDescription description = random_scene(2);
    description.film.width = 53;
    description.film.height = 37;
    return description;
}

}  // namespace

TEST_CASE("light tracing is the same for any threads, and when continued") {
    check_determinism(build_scene<AllBsdfs, AllLights>(light_scene()), lightswitch::LightTracer{});
}

TEST_CASE("bidirectional path tracing is the same for any threads, and when continued") {
    check_determinism(build_scene<AllBsdfs, AllLights>(light_scene()), Bdpt{});
}

TEST_CASE("photon mapping is the same for any threads, and when continued") {
    check_determinism(build_scene<AllBsdfs, AllLights>(light_scene()), PhotonMapping{.paths_per_pixel = 1.7});
    check_determinism(build_scene<AllBsdfs, AllLights>(light_scene()), PhotonMapping{.final_gather = true});
}

TEST_CASE("vertex connection and merging is the same for any threads, and when continued") {
    check_determinism(build_scene<AllBsdfs, AllLights>(light_scene()), Vcm{});
}

TEST_CASE("every scale by a power of two gives the same bits with paths from the lights") {
    for (LibraryDescription description : {random_scene(2), small_box(24, 24)}) {
        description.camera.near_clip = 0.01;
        const auto at_scale = [&](int k) { return build_scene<AllBsdfs, AllLights>(scaled(description, k)); };
        const FullScene original = at_scale(0);
        for (const int k : {-40, -3, 40}) {
            CAPTURE(k);
            const FullScene other = at_scale(k);
            const auto check = [&](const auto& method) {
                const Image image = render(original, method, {.samples = 3});
                CHECK(image.mean().y > 0);
                CHECK_MESSAGE(identical(image, render(other, method, {.samples = 3})), method.name);
            };
            check(lightswitch::LightTracer{});
            check(Bdpt{});
            check(PhotonMapping{});
            check(PhotonMapping{.final_gather = true});
            check(Vcm{});
        }
    }
}

namespace {

/// Draws numbers in several passes of one iteration and keeps them: `order` says which passes, p for pixels and l for
/// paths.
struct Passes {
    static constexpr std::string_view name = "passes";
    static constexpr Kind kind = Kind::heuristic;
    std::string order;
    std::vector<std::vector<std::vector<Vec2>>>* drawn;  // by pass, index and iteration

    int start(auto&) const { return 0; }
    void iterate(auto& frame, int&) const {
        const std::size_t n = std::size_t(frame.width()) * std::size_t(frame.height());
        drawn->resize(order.size(), std::vector<std::vector<Vec2>>(n));
        for (std::size_t pass = 0; pass < order.size(); ++pass) {
            auto& mine = (*drawn)[pass];
            if (order[pass] == 'p')
                frame.pixels([&](const Ray&, auto& sampler, const PixelContext& pixel) {
                    mine[pixel.index].push_back(sampler.next_2d());
                    return Rgb(0);
                });
            else frame.paths(n, [&](std::uint64_t i, auto& sampler, auto&) { mine[i].push_back(sampler.next_2d()); });
        }
    }
};

std::vector<std::vector<std::vector<Vec2>>> draw_passes(const std::string& order, int iterations, Sampling sampling) {
    static const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(small_box(4, 2));
    std::vector<std::vector<std::vector<Vec2>>> drawn;
    render(scene, Passes{order, &drawn}, {.samples = iterations}, {.seed = 21, .sampling = sampling});
    return drawn;
}

}  // namespace

// 2 samplings * 10 pairs of passes * 8 indices * 2 correlations of 4096 products: at 6 standard errors, 6e-7 in all.
TEST_CASE("every pass over pixels or paths of an iteration has numbers of its own") {
    for (const Sampling sampling : {Sampling::sobol, Sampling::independent}) {
        const auto drawn = draw_passes("plplp", 4096, sampling);
        REQUIRE(drawn.size() == 5);
        for (std::size_t a = 0; a < drawn.size(); ++a)
            for (std::size_t b = a + 1; b < drawn.size(); ++b)
                for (std::size_t i = 0; i < 8; ++i) {
                    UniformCorrelation same, crossed;
                    int equal = 0;
                    for (std::size_t n = 0; n < 4096; ++n) {
                        const Vec2 p = drawn[a][i][n], q = drawn[b][i][n];
                        same.add(double(p.x), double(q.x));
                        crossed.add(double(p.x), double(q.y));
                        equal += p.x == q.x;
                    }
                    CHECK(std::abs(same.sigmas()) < 6);
                    CHECK(std::abs(crossed.sigmas()) < 6);
                    CHECK(equal < 4);
                }
        // The first pass over pixels is the same whatever comes before it: all methods see the same camera rays.
        CHECK(draw_passes("p", 16, sampling)[0] == draw_passes("llp", 16, sampling)[2]);
        CHECK(draw_passes("p", 16, sampling)[0] == draw_passes("pp", 16, sampling)[0]);
        CHECK(draw_passes("lp", 16, sampling)[0] == draw_passes("pl", 16, sampling)[1]);
        CHECK(draw_passes("pp", 16, sampling)[0] != draw_passes("pp", 16, sampling)[1]);
    }
}

TEST_CASE("sampling methods differ, and say so in the image") {
    const LibraryDescription box = small_box();
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box);
    const Image sobol = render(scene, PathTracerNee{}, {.samples = 2}, {.seed = 3});
    const Image independent =
        render(scene, PathTracerNee{}, {.samples = 2}, {.seed = 3, .sampling = Sampling::independent});
    CHECK_FALSE(identical(sobol, independent));
    CHECK(sobol.metadata.at("method") == "path-nee");
    CHECK(sobol.metadata.at("kind") == "unbiased");
    CHECK(sobol.metadata.at("scene") == "cornell-box");
    CHECK(sobol.metadata.at("samples") == "2");
    CHECK(sobol.metadata.at("seed") == "3");
    CHECK(sobol.metadata.at("sampling") == "sobol");
    CHECK(independent.metadata.at("sampling") == "independent");
}
