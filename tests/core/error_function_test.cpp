#include <lightswitch/core/error_function.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;

TEST_CASE("inverse_erfc undoes erfc to a few units of roundoff, over all tails that floats tell apart") {
    double worst = 0, worst_near_zero = 0;
    const auto look = [&](float tail) {
        // The error of x is that of the tail over the slope of erfc, which is accurate in double.
        const double x = double(inverse_erfc(tail));
        const double slope = 2 / std::sqrt(std::acos(-1.0)) * std::exp(-x * x);
        const double error = std::abs(std::erfc(x) - double(tail)) / slope;
        if (std::abs(x) > 0.01) worst = std::max(worst, error / std::abs(x));
        else worst_near_zero = std::max(worst_near_zero, error);
    };
    for (int i = 0; i <= 100000; ++i) {
        const double share = i / 1e5;
        look(float(4e-9 * std::pow(2.4e8, share)));  // to 0.96
        look(float(0.9 + 0.2 * share));
        look(float(2 - 0x1p-23 * std::pow(1e6, share)));
    }
    CHECK(worst < 6e-7);
    CHECK(worst_near_zero < 1e-8);
    CHECK(inverse_erfc(1) == 0);
}
