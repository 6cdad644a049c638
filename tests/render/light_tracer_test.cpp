// The two kinds of contribution agree: what a camera path gathers in a slot, a light path splats.

#include "support/light_tracer.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

// False alarm: 1e-3 in each of the three comparisons.
TEST_CASE("a light tracer agrees with path tracing") {
    const LibraryDescription box = small_box(48, 32);
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box);
    for (int bounces = 1; bounces <= 3; ++bounces) {
        PlainLightTracer method = light_tracer_for(box, scene);
        method.bounces = bounces;
        method.paths = 20000;
        const auto light = replicate(scene, method, 8, 16, 8);
        const auto camera = replicate(scene, PathTracerNee{.max_depth = bounces + 1}, 8, 16, 32);
        const Comparison comparison = compare(light, camera, 1e-3);
        CHECK_MESSAGE(comparison.agree(), bounces, " bounces: ", comparison);
    }
}

TEST_CASE("light paths are counted") {
    const LibraryDescription box = small_box();
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box);
    PlainLightTracer method = light_tracer_for(box, scene);
    method.paths = 3000;
    Session<DiffuseScene, PlainLightTracer> session(scene, method);
    session.run({.samples = 2});
    const RenderCounts& counts = session.statistics().counts;
    CHECK(counts.paths == 6000);
    CHECK(counts.splats > 1000);
    CHECK(counts.splats <= 6000);
    CHECK(counts.rays == 2 * 48 * 32 + 6000 + counts.shadow_rays);  // camera rays, light rays, connections
    CHECK(counts.shadow_rays >= counts.splats);
}
