#include <lightswitch/geometry/render_space.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace lightswitch;
using test::relative;

TEST_CASE("render space: geometry lies between -1 and 1, and fills more than half of it") {
    for (const double extent : {1e-300, 1e-20, 0.3, 0.5, 1.0, 1.5, 1e7, 1e99})
        for (const double at : {0.0, 1.0, -17.0}) {
            const DVec3 lower = DVec3(at, 2 * at, 3 * at) * extent,
                        upper = lower + DVec3(extent, extent / 3, extent / 7);
            const RenderSpace space(lower, upper);
            const DVec3 a = space.point(lower), b = space.point(upper);
            CAPTURE(extent);
            CHECK(std::max(std::abs(a.x), std::abs(b.x)) <= 1);
            CHECK(std::max(std::abs(a.x), std::abs(b.x)) >= 0.5 - 1e-12);
            CHECK(glm::length(a + b) < 1e-13);
            CHECK(space.length(extent) == relative(b.x - a.x, 1e-5));
            int exponent = 0;
            CHECK(std::frexp(space.scale(), &exponent) == 0.5);  // a power of two
        }
}

TEST_CASE("render space: scaling by a power of two and moving exactly change no digit") {
    const DVec3 lower(-1.25, 0.1, 3), upper(4.7, 9.3, 5), point(0.3, 7.7, 4.1);
    const RenderSpace space(lower, upper);
    for (const int k : {-300, -40, -1, 1, 40, 300}) {
        const double s = std::ldexp(1.0, k);
        const RenderSpace scaled(lower * s, upper * s);
        CHECK(scaled.point(point * s) == space.point(point));
        CHECK(scaled.length(0.7 * s) == space.length(0.7));
    }
    const DVec3 low(-1.25, 0.5, 3), high(4.75, 9.25, 5), p(0.25, 7.75, 4.125), far(1 << 20, -(1 << 20), 1 << 10);
    CHECK(RenderSpace(low + far, high + far).point(p + far) == RenderSpace(low, high).point(p));
}

TEST_CASE("render space: there and back") {
    const DVec3 p(0.3, 7.7, 4.1);
    for (const double shift : {0.0, 1e6})
        for (const int k : {-300, 0, 20}) {
            const double s = std::ldexp(1.0, k);
            const RenderSpace space(DVec3(-1 + shift, 0, 3) * s, DVec3(5 + shift, 9, 5) * s);
            const DVec3 there = (p + DVec3(shift, 0, 0)) * s;
            CHECK(glm::length(space.scene_point(space.point(there)) - there) <= 2e-16 * glm::length(there));
            CHECK(space.scene_length(space.length(0.7)) == 0.7);
        }
}

TEST_CASE("render space: extremes") {
    // One point, or nothing: scale 1, recentred.
    const RenderSpace one(DVec3(5, 6, 7), DVec3(5, 6, 7));
    CHECK(one.scale() == 1);
    CHECK(one.point({5, 6, 7}) == DVec3(0));
    CHECK(RenderSpace().point({1, 2, 3}) == DVec3(1, 2, 3));
    // What cannot be made of size 1 stays finite.
    for (const double extent : {std::numeric_limits<double>::denorm_min(), 1e-308, 1e100}) {
        const RenderSpace space(DVec3(0), DVec3(extent));
        CHECK(std::isfinite(space.scale()));
        CHECK(space.scale() > 0);
        CHECK(std::abs(space.point(DVec3(extent)).x) <= 1);
    }
}
