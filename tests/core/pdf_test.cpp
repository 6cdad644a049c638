#include <lightswitch/core/pdf.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <type_traits>

using namespace lightswitch;
using test::relative;

TEST_CASE("pdf: changes of measure") {
    // A square of side 2 seen head-on from distance 100: its solid angle is 4 / 100^2, to 1e-4.
    const AreaPdf uniform{1.0f / 4};
    CHECK(to_solid_angle(uniform, 1e4f, 1).value == relative(1e4 / 4, 1e-5));
    CHECK(to_solid_angle(uniform, 1e4f, 0.5f).value == relative(1e4 / 2, 1e-5));
    for (const float distance2 : {1e-6f, 0.3f, 7e5f})
        for (const float cosine : {1e-4f, 0.3f, 1.0f}) {
            CHECK(to_area(to_solid_angle(uniform, distance2, cosine), distance2, cosine).value == relative(0.25, 1e-6));
        }
    CHECK(to_solid_angle(uniform, 1, 0).value == infinity);
    CHECK(to_area({infinity}, 1, 0.5f).value == infinity);
    CHECK(to_area({0.3f}, 2, 0).value == 0);
}

TEST_CASE("pdf: arithmetic within a measure") {
    CHECK((SolidAnglePdf{2} * 0.25f).value == 0.5f);
    CHECK((AreaPdf{2} * 0.25f).value == 0.5f);
    CHECK(SolidAnglePdf{1} < SolidAnglePdf{2});
    CHECK(AreaPdf{2} == AreaPdf{2});
    CHECK(SolidAnglePdf{}.value == 0);
    CHECK(is_positive(EmissionPdf{1e-30f}));
    CHECK_FALSE(is_positive(SolidAnglePdf{}));
    CHECK_FALSE(is_positive(AreaPdf{std::numeric_limits<float>::quiet_NaN()}));
    CHECK(SolidAnglePdf{1e30f} / SolidAnglePdf{1e-30f} == relative(1e60, 1e-6));  // beyond float
    CHECK(3.0f / AreaPdf{2} == 1.5f);
    static_assert(std::is_same_v<decltype(1.0 / SolidAnglePdf{2}), double>);
    CHECK(Rgb(3, 2, 1) / EmissionPdf{2} == Rgb(1.5f, 1, 0.5f));
}

TEST_CASE("pdf: what a density counts by the heuristic") {
    CHECK(heuristic(3.0) == 9);
    CHECK(heuristic(SolidAnglePdf{1e-30f}) == relative(1e-60, 1e-6));
    CHECK(heuristic(AreaPdf{0.5f}) == 0.25);
    CHECK(heuristic_per_area({2}, 4, 0.5) == 0.0625);
    CHECK(heuristic_per_area({2}, 4, 0) == 0);
}

TEST_CASE("pdf: the power heuristic and its limits") {
    CHECK(power_heuristic({1}, {1}) == 0.5f);
    CHECK(power_heuristic({3}, {1}) == relative(0.9, 1e-5));
    CHECK(power_heuristic({1}, {3}) == relative(0.1, 1e-5));
    CHECK(power_heuristic({1}, {0}) == 1);
    CHECK(power_heuristic({0}, {1}) == 0);
    CHECK(power_heuristic({0}, {0}) == 0);
    CHECK(power_heuristic({infinity}, {5}) == 1);
    CHECK(power_heuristic({5}, {infinity}) == 0);
    CHECK(power_heuristic({0}, {infinity}) == 0);
    CHECK(power_heuristic({infinity}, {0}) == 1);
    // As the contract says, whatever the other is.
    CHECK(power_heuristic({infinity}, {infinity}) == 1);
    // Squares that would overflow or vanish.
    CHECK(power_heuristic({1e30f}, {1e30f}) == 0.5f);
    CHECK(power_heuristic({1e-30f}, {1e-30f}) == 0.5f);
    CHECK(power_heuristic({1e-30f}, {1e30f}) == 0);
    CHECK(power_heuristic({1e30f}, {1e-30f}) == 1);
    // Both strategies together count everything once.
    for (const float a : {1e-20f, 1e-3f, 0.7f, 1.0f, 13.0f, 1e10f})
        for (const float b : {1e-20f, 1e-3f, 0.7f, 1.0f, 13.0f, 1e10f})
            CHECK(power_heuristic({a}, {b}) + power_heuristic({b}, {a}) == relative(1, 1e-6));
}
