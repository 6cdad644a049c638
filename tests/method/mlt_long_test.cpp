// As mlt_test.cpp, with more scenes, seeds and samples, and every limit of the path length.

#include "mlt.hpp"

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 in each test case.

TEST_CASE("mlt: agrees with path tracing for every path length") {
    const auto cases = mlt_cases();
    for (const TransportCase& c : cases)
        check_mlt_against_path_nee(c, {2, 3, 4, -1}, 16, 1e-3, static_cast<int>(cases.size()));
}

TEST_CASE("mlt: agrees with path tracing on the scenes of the bidirectional methods") {
    auto cases = transport_cases();
    for (TransportCase& c : cases) {
        if (!c.light_tracer || c.name == "light in mirror") c.samples *= 4;  // specular surfaces focus light
        check_mlt_against_path_nee(c, {-1}, 16, 1e-3, static_cast<int>(cases.size()));
    }
}

TEST_CASE("mlt: furnaces are geometric series, to a part in a thousand") {
    for (const float albedo : {0.5f, 0.8f}) {
        const TileEstimates truth = known_tiles(2, 2, 8, 1 / (1 - double(albedo)));
        const auto check = [&](const LibraryDescription& description) {
            const FullScene scene = build_scene<AllBsdfs, AllLights>(description);
            const auto ours = replicate_finite(scene, Mlt{}, 8, 16, 1024);
            const Comparison comparison = compare(ours, truth, 1e-3, 4);
            CHECK_MESSAGE(comparison.agree(), description.name, " ", albedo, ": ", comparison);
            const BiasInterval bias(ours.whole[1], truth.whole[1], 0.9999);
            CHECK_MESSAGE(bias.within(0.004), bias);
        };
        check(scenes::on_small_film(stock::describe_furnace(albedo)));
        check(scenes::furnace_sphere(albedo));
    }
}

// Path tracing finds next to nothing here; bidirectional path tracing, which is compared with it elsewhere, finds
// enough.
TEST_CASE("mlt: light through the gap of a door") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(stock::describe_ajar_door()));
    const auto truth = replicate_finite(scene, Bdpt{}, 8, 16, 512);
    const auto ours = replicate_finite(scene, Mlt{}, 8, 16, 1024);
    const Comparison comparison = compare(ours, truth, 1e-3);
    CHECK_MESSAGE(comparison.agree(), comparison);
    // Not by being so noisy that everything agrees.
    const BiasInterval bias(ours.whole[1], truth.whole[1], 0.9999);
    CHECK_MESSAGE(bias.within(0.2), bias);
}

// As the quick test, which sees a bias of 1.5 %, with eight times as many seeds.
TEST_CASE("mlt: no bias from where chains start, to half a per cent") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::start_up());
    const TileEstimates truth = replicate_finite(scene, PathTracerNee{}, 2, 16, 8192, 1001);
    const TileEstimates ours = replicate_finite(scene, start_up_mlt(false), 2, 8192, 1, 1);
    const Comparison comparison = compare(ours, truth, 1e-3);
    CHECK_MESSAGE(comparison.agree(), comparison);
    const BiasInterval whole(ours.whole[1], truth.whole[1], 0.999);
    CHECK_MESSAGE(whole.within(0.01), whole);
    CHECK(whole.high - whole.low < 0.01);
}
