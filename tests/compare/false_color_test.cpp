#include "support/relative.hpp"

#include <lightswitch/compare/false_color.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <utility>
#include <vector>

using namespace lightswitch;

namespace {

Image single(const Rgb& value) {
    Image image(1, 1);
    image(0, 0) = value;
    return image;
}

/// The colour that `value` gets on a scale that ends at 1.
Rgb color_of(float value, FalseColorOptions::Map map, bool black_zero = false) {
    return false_color(single(Rgb(value)), {.map = map, .scale = 1, .black_zero = black_zero, .legend = false})(0, 0);
}

constexpr auto diverging = FalseColorOptions::Map::diverging;
constexpr auto sequential = FalseColorOptions::Map::sequential;

}  // namespace

TEST_CASE("false colour: sign chooses the hue, magnitude the strength") {
    const Rgb positive = color_of(1, diverging), negative = color_of(-1, diverging);
    CHECK(positive.x > 3 * positive.z);  // red
    CHECK(negative.z > 3 * negative.x);  // blue
    const Rgb zero = color_of(0, diverging);
    CHECK(zero.x > 0.9f);
    CHECK(max_component(glm::abs(zero - Rgb(zero.x))) < 1e-3f);
    CHECK(is_black(color_of(0, diverging, true)));
    // Equal magnitudes of either sign look equally strong.
    CHECK(std::abs(std::cbrt(luminance(positive)) - std::cbrt(luminance(negative))) < 0.1f);
    for (const float step : {0.25f, 0.5f, 0.75f, 1.0f}) {
        CAPTURE(step);
        for (const float sign : {-1.0f, 1.0f}) {
            CHECK(luminance(color_of(sign * step, diverging)) < luminance(color_of(sign * (step - 0.25f), diverging)));
            CHECK(luminance(color_of(sign * step, diverging, true)) >
                  luminance(color_of(sign * (step - 0.25f), diverging, true)));
        }
        CHECK(luminance(color_of(step, sequential)) > luminance(color_of(step - 0.25f, sequential)));
    }
    CHECK(color_of(-0.5f, sequential) == color_of(0.5f, sequential));
}

TEST_CASE("false colour: the channel of largest magnitude counts, and what is not finite shows") {
    const FalseColorOptions options{.scale = 1, .legend = false};
    CHECK(false_color(single(Rgb(0.1f, -0.5f, 0.4f)), options)(0, 0) == color_of(-0.5f, diverging));
    CHECK(false_color(single(Rgb(0, -infinity, 1)), options)(0, 0) == color_of(-1, diverging));
    for (int c = 0; c < 3; ++c) {
        Rgb value(infinity, 1, infinity);
        value[c] = std::numeric_limits<float>::quiet_NaN();
        CHECK(false_color(single(value), options)(0, 0) == Rgb(1, 0, 1));
    }
    CHECK(color_of(7, diverging) == color_of(1, diverging));
}

TEST_CASE("false colour: the scale is a percentile of the finite magnitudes") {
    Image image(101, 1);
    for (int x = 0; x <= 100; ++x) image(x, 0) = Rgb(static_cast<float>(x % 2 == 0 ? x : -x));
    CHECK(detail::magnitude_percentile(image, 100) == 100);
    CHECK(detail::magnitude_percentile(image, 90) == 90);
    const Image colors = false_color(image, {.percentile = 50, .legend = false});
    CHECK(colors(50, 0) == color_of(1, diverging));
    CHECK(colors(24, 0) == color_of(0.48f, diverging));
    image(100, 0) = Rgb(infinity);
    CHECK(detail::magnitude_percentile(image, 100) == 99);

    Image sparse(200, 1);
    sparse(7, 0) = Rgb(0, 3, 0);
    CHECK(detail::magnitude_percentile(sparse, 99) == 3);  // the percentile itself is 0
    CHECK(detail::magnitude_percentile(Image(3, 3), 99) == 1);
}

TEST_CASE("false colour: a scale that is chosen is round, and so are its half and quarters") {
    for (const auto& [value, round] : std::vector<std::pair<float, float>>{{1, 1},
                                                                           {1.01f, 1.5f},
                                                                           {0.0837f, 0.1f},
                                                                           {0.0237f, 0.03f},
                                                                           {700, 800},
                                                                           {99, 100},
                                                                           {5e-7f, 5e-7f},
                                                                           {6.1e20f, 8e20f}})
        CHECK(double(detail::round_up(value)) == lightswitch::test::relative(double(round), 1e-6));
    Image image(2, 1);
    image(0, 0) = Rgb(0.0837f);
    image(1, 0) = Rgb(-0.05f);
    const Image colors = false_color(image, {.percentile = 100, .legend = false});
    CHECK(max_component(glm::abs(colors(0, 0) - color_of(0.837f, diverging))) < 1e-6f);
    CHECK(max_component(glm::abs(colors(1, 0) - color_of(-0.5f, diverging))) < 1e-6f);
}

TEST_CASE("false colour: a colour bar by itself is the legend of a picture with that scale") {
    const FalseColorOptions options{.scale = 2, .caption = "what", .letter_size = 2};
    const Image bar = color_bar(300, options), with = false_color(Image(300, 5), options);
    REQUIRE(bar.width() == with.width());
    REQUIRE(bar.height() == with.height() - 5);
    bool same = true;
    for (int y = 0; y < bar.height(); ++y)
        for (int x = 0; x < bar.width(); ++x) same = same && bar(x, y) == with(x, y + 5);
    CHECK(same);
    CHECK(color_bar(1, {.scale = 1}).width() > 30);  // room for the numbers
    CHECK_THROWS_WITH_AS(color_bar(100, {}), "a colour bar by itself needs a scale", Error);
    CHECK_THROWS_AS(color_bar(0, {.scale = 1}), Error);
    CHECK_THROWS_AS(color_bar(100, {.scale = 1, .letter_size = 65}), Error);
}

TEST_CASE("false colour: the legend shows the map, has its numbers, and leaves the picture alone") {
    Image image(64, 20);
    image(10, 5) = Rgb(2);
    const Image bare = false_color(image, {.scale = 2, .legend = false});
    const Image with = false_color(image, {.scale = 2});
    REQUIRE(bare.width() == 64);
    REQUIRE(bare.height() == 20);
    CHECK(with.height() > 40);
    const int left = (with.width() - 64) / 2;
    int wrong = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 64; ++x) wrong += with(left + x, y) != bare(x, y);
    CHECK(wrong == 0);

    // A row through the bar: from one end of the map over its middle to the other.
    const int bar = 20 + 6 + 5;
    int first = 0, last = with.width() - 1;
    const Rgb paper = with(0, bar);
    while (with(first, bar) == paper) ++first;
    while (with(last, bar) == paper) --last;
    CHECK(with(first + 1, bar) == color_of(-1, diverging));  // inside of the frame
    CHECK(with(last - 1, bar) == color_of(1, diverging));
    // The labels: some ink below the bar, none in a picture without a legend.
    int ink = 0;
    for (int y = bar + 10; y < with.height(); ++y)
        for (int x = 0; x < with.width(); ++x) ink += with(x, y) != paper;
    CHECK(ink > 30);
    CHECK(false_color(image, {.caption = "what it is"}).height() > with.height());
    CHECK_NOTHROW(false_color(Image(1, 1)));
}

TEST_CASE("false colour: refuses options that make no sense") {
    const Image image(2, 2);
    CHECK_THROWS_AS(false_color(Image()), Error);
    CHECK_THROWS_AS(false_color(image, {.scale = -1}), Error);
    CHECK_THROWS_AS(false_color(image, {.scale = infinity}), Error);
    CHECK_THROWS_AS(false_color(image, {.percentile = 0}), Error);
    CHECK_THROWS_AS(false_color(image, {.percentile = 101}), Error);
    CHECK_THROWS_AS(false_color(image, {.percentile = std::numeric_limits<float>::quiet_NaN()}), Error);
}
