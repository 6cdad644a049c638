#include <lightswitch/core/angle.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;

namespace {

constexpr double two_pi = 6.28318530717958647692;

}  // namespace

TEST_CASE("angle: turns are those of the arc tangent, all around and at all lengths") {
    double worst = 0;
    for (int i = 0; i < 1000000; ++i) {
        const double angle = (i + 0.5) / 1e6 * two_pi, length = std::ldexp(1.0, i % 81 - 40);
        const auto x = static_cast<float>(length * std::cos(angle)), y = static_cast<float>(length * std::sin(angle));
        worst = std::max(worst, std::abs(double(turns(y, x)) - std::atan2(double(y), double(x)) / two_pi));
    }
    CHECK(worst < 0x1p-24);
    CHECK(turns(0, 1) == 0);
    CHECK(turns(1, 0) == 0.25f);
    CHECK(turns(0, -1) == 0.5f);
    CHECK(turns(-1, 0) == -0.25f);
    CHECK(turns(0, 0) == 0);
    // Small angles keep their digits.
    CHECK(std::abs(double(turns(1e-20f, 1)) * two_pi / 1e-20 - 1) < 1e-6);
}

TEST_CASE("angle: cosine and sine of turns") {
    double worst = 0;
    for (int i = 0; i < 1500000; ++i) {
        const double angle = i / 1e6;
        const auto [c, s] = cos_sin_turns(angle);
        worst = std::max(
            {worst, std::abs(double(c) - std::cos(angle * two_pi)), std::abs(double(s) - std::sin(angle * two_pi))});
    }
    CHECK(worst < 0x1p-22);
}
