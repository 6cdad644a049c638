// The strategies of bidirectional path tracing one by one: each finds by itself all the light of its path length, and
// weighed they add up to the image.

#include "../support/relative.hpp"
#include "bidirectional.hpp"

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// Light that has come by exactly `edges` segments: the same random numbers with and without those paths.
template <class SceneType>
TileEstimates of_length(const SceneType& scene, int edges, int replicas, int samples) {
    Replicas result(8);
    for (int i = 0; i < replicas; ++i) {
        const Settings settings{.seed = 1000 + static_cast<std::uint64_t>(i)};
        Image image = render(scene, PathTracerNee{.max_depth = edges}, {.samples = samples}, settings);
        const Image shorter = render(scene, PathTracerNee{.max_depth = edges - 1}, {.samples = samples}, settings);
        for (std::size_t p = 0; p < image.pixels().size(); ++p) image.pixels()[p] -= shorter.pixels()[p];
        result.add(image);
    }
    return result.estimates();
}

/// Every strategy with `s` light vertices and paths of 1 to `longest` segments, against path tracing.
void check_strategies(const LibraryDescription& description, int least_light_vertices, int longest, int samples,
                      int share) {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(description);
    int comparisons = 0;
    for (int edges = 1; edges <= longest; ++edges) comparisons += edges + 1;
    for (int edges = std::max(1, least_light_vertices + 1); edges <= longest; ++edges) {
        const TileEstimates truth = of_length(scene, edges, 8, 4 * samples);
        // With one vertex on the lens there must be two at the light: the light itself is seen by s = 0 only.
        for (int s = least_light_vertices; s <= edges; ++s) {
            const int t = edges + 1 - s;
            if (s == 1 && t == 1) continue;
            const Bdpt method{.max_depth = edges, .only = Strategy{s, t, false}};
            const Comparison comparison =
                compare(replicate_finite(scene, method, 8, 16, samples, 1), truth, 1e-3, share * comparisons);
            CHECK_MESSAGE(comparison.agree(), "s = ", s, ", t = ", t, ": ", comparison);
            CHECK(comparison.ours > 0);
        }
    }
}

}  // namespace

// False alarm: 1e-3 in each test case.

TEST_CASE("strategies: each is unbiased for light from a surface") {
    check_strategies(scenes::lamp_in_sphere(), 0, 4, 24, 1);
}

TEST_CASE("strategies: each is unbiased for light from the environment") {
    check_strategies(scenes::stage_under_sky(), 0, 3, 24, 1);
}

TEST_CASE("strategies: each is unbiased for light from a point and from a direction") {
    check_strategies(scenes::point_in_sphere(), 1, 4, 24, 2);
    check_strategies(scenes::stage_under_sun(), 1, 3, 24, 2);
}

TEST_CASE("strategies: each is unbiased with rough metal") {
    LibraryDescription metal = scenes::hollow_sphere();
    metal.materials[0].bsdf = RoughConductor{.distribution = Facets::ggx,
                                             .alpha_u = 0.6f,
                                             .alpha_v = 0.6f,
                                             .eta = Rgb(0.2f, 0.9f, 1.1f),
                                             .k = Rgb(3.9f, 2.5f, 2.2f)};
    metal.add(quad({-0.4, 0.6, -0.5}, {0.4, 0.6, -0.5}, {0.4, 0.7, 0.1}, {-0.4, 0.7, 0.1}),
              metal.add(Lambert{Rgb(0.5f)}), Rgb(6));
    check_strategies(metal, 0, 3, 24, 1);
}

TEST_CASE("strategies: their weighed images add up to the image") {
    for (const LibraryDescription& description : {scenes::on_small_film(stock::describe_cornell_spheres()),
                                                  scenes::stage_under_all(), random_scene(2), random_scene(3)}) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(description);
        constexpr int max_depth = 4;
        const Image whole = render(scene, Bdpt{.max_depth = max_depth}, {.samples = 4}, {.seed = 9});
        Image sum(whole.width(), whole.height());
        for (int t = 1; t <= max_depth + 1; ++t)
            for (int s = 0; s + t <= max_depth + 1; ++s) {
                if (s + t < 2) continue;
                const Bdpt one{.max_depth = max_depth, .only = Strategy{s, t, true}};
                const Image image = render(scene, one, {.samples = 4}, {.seed = 9});
                if (s == 1 && t == 1) CHECK(image.mean() == DVec3(0));
                for (std::size_t p = 0; p < image.pixels().size(); ++p) sum.pixels()[p] += image.pixels()[p];
            }
        CHECK(whole.mean().y > 0);
        for (std::size_t p = 0; p < sum.pixels().size(); ++p)
            for (int c = 0; c < 3; ++c) CHECK(sum.pixels()[p][c] == relative(double(whole.pixels()[p][c]), 1e-5));
    }
}
