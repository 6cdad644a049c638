// A render is a pure function of scene, method, seed and number of iterations.

#include "support/light_tracer.hpp"
#include "support/random_scenes.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>

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
    LightTracer method = light_tracer_for(box, scene);
    method.bounces = 3;
    method.paths = 10000;  // several work units, the last one not full
    check_determinism(scene, method);
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
