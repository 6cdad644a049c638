// As bidirectional_test.cpp, with more samples, every limit of the path length, and random scenes.

#include "bidirectional.hpp"

#include <lightswitch/verify/verify.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 in each test case.

TEST_CASE("bidirectional: agrees with path tracing for every path length") {
    auto cases = transport_cases();
    for (TransportCase& c : cases) {
        c.samples *= 2;
        check_against_path_nee(c, {1, 2, 3, 4, 5, -1}, 16, 1e-3, static_cast<int>(cases.size()));
    }
}

TEST_CASE("bidirectional: agrees with path tracing on random scenes") {
    constexpr int scenes = 6, depths[] = {1, 2, 3, 4, 5, -1};
    constexpr int comparisons = 2 * scenes * static_cast<int>(std::size(depths));
    for (std::uint32_t number = 1; number <= scenes; ++number) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(random_scene(number));
        for (const int depth : depths) {
            // Nothing is shared with path tracing that meets light by chance only.
            const auto path =
                replicate_finite(scene, PathTracer{.max_depth = depth}, 8, 16, 256, 1001, Sampling::independent);
            const auto check = [&](const auto& method) {
                const auto ours = replicate_finite(scene, method, 8, 16, 64, 1);
                const Comparison comparison = compare(ours, path, 1e-3, comparisons);
                CHECK_MESSAGE(comparison.agree(), "scene ", number, ", ", method.name, ", depth ", depth, ": ",
                              comparison);
            };
            check(Bdpt{.max_depth = depth, .rr_depth = 1});
            check(connections_only(depth));
        }
    }
}

// `verify` is wrong with a probability of 1e-3 for each of two methods.
TEST_CASE("bidirectional: verified against path tracing") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 64;
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    const auto check = [&](const auto& method) {
        const Verdict verdict = verify(scene, method, PathTracerNee{}, {.seconds = 60, .tolerance = 0.02});
        CHECK_MESSAGE(verdict.agrees(), verdict);
    };
    check(Bdpt{});
    check(LightTracer{});
}
