#include <lightswitch/compare/metrics.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::relative;

namespace {

/// 4 x 2 pixels whose n-th channel value is (scale (factor n mod modulus) + offset), all exact in float.
Image pattern(int factor, int modulus, float scale, float offset) {
    Image image(4, 2);
    int n = 0;
    for (Rgb& p : image.pixels())
        for (int c = 0; c < 3; ++c) p[c] = scale * static_cast<float>(n++ * factor % modulus) + offset;
    return image;
}

}  // namespace

TEST_CASE("metrics: agree with NumPy in double precision") {
    const Image x = pattern(7, 11, 0.125f, -0.25f), r = pattern(5, 13, 0.25f, 0);
    CHECK(mse(x, r) == relative(2.22330729167, 1e-6));
    CHECK(rmse(x, r) == relative(1.49107588394, 1e-6));
    CHECK(relmse(x, r) == relative(0.986411902715, 1e-6));
    CHECK(mape(x, r) == relative(2.26995545472, 1e-6));
    CHECK(smape(x, r) == relative(1.28351201606, 1e-6));
    CHECK(mean_ratio(x, r) == relative(0.237931034483, 1e-6));
}

TEST_CASE("metrics: equal images, black images, values that are not finite, other sizes") {
    const Image x = pattern(7, 11, 0.125f, 0);
    for (const auto metric : {mse, rmse, relmse, mape, smape}) CHECK(metric(x, x) == 0);
    CHECK(mean_ratio(x, x) == 1);
    CHECK(std::isnan(mean_ratio(Image(1, 1), Image(1, 1))));
    CHECK(smape(x, Image(4, 2)) <= 2);
    Image broken = x;
    broken(1, 1).y = std::numeric_limits<float>::quiet_NaN();
    for (const auto metric : {mse, rmse, relmse, mape, smape, mean_ratio}) {
        CHECK(std::isnan(metric(broken, x)));
        CHECK_THROWS_AS(metric(x, Image(2, 4)), Error);
    }
}
