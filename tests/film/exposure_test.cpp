#include <lightswitch/film/tonemap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace lightswitch;

namespace {

/// A hundred pixels in a row, all alike.
Image grey(float value) {
    Image image(100, 1);
    for (Rgb& pixel : image.pixels()) pixel = Rgb(value);
    return image;
}

}  // namespace

TEST_CASE("the automatic exposure makes the middle brightness a middle grey") {
    CHECK(auto_exposure(grey(0.18f)) == 0);
    CHECK(auto_exposure(grey(0.18f * 8)) == -3);
    CHECK(auto_exposure(grey(0.18f / 4)) == 2);
    CHECK(auto_exposure(grey(0.2f)) == -0.2f);  // -0.152, to a tenth of a stop
    // The geometric mean of 1 and 16 is 4.
    Image halves = grey(0.18f);
    for (int x = 0; x < 50; ++x) halves(x, 0) *= 16;
    CHECK(auto_exposure(halves) == -2);
    // Luminance counts, not a channel.
    Image green(1, 1);
    green(0, 0) = Rgb(0, 1, 0);
    CHECK(std::abs(auto_exposure(green) - std::log2(0.18f / luminance(Rgb(0, 1, 0)))) <= 0.05f);
}

TEST_CASE("what says nothing about brightness does not change the automatic exposure") {
    Image image = grey(0.18f);
    for (int x = 0; x < 60; ++x) image(x, 0) = Rgb(0);  // a black background
    CHECK(auto_exposure(image) == 0);
    image(60, 0) = Rgb(std::numeric_limits<float>::infinity());
    image(61, 0) = Rgb(std::numeric_limits<float>::quiet_NaN());
    image(62, 0) = Rgb(-1);
    CHECK(auto_exposure(image) == 0);
    for (const float outlier : {1e30f, 1e-30f}) {
        Image firefly = grey(0.18f);
        firefly(0, 0) = Rgb(outlier);
        CHECK(auto_exposure(firefly) == 0);
    }
    for (const float none : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()})
        CHECK(auto_exposure(grey(none)) == 0);
    CHECK(auto_exposure(Image()) == 0);
    CHECK(auto_exposure(grey(std::numeric_limits<float>::denorm_min())) > 140);
    CHECK(std::isfinite(auto_exposure(grey(std::numeric_limits<float>::max()))));
}
