#include "support/errors.hpp"
#include "support/relative.hpp"

#include <lightswitch/compare/flip.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

using namespace lightswitch;
using lightswitch::test::message_of;
using test::relative;

namespace {

// The patterns of tests/data/flip/make_values.py. All values are integers over a power of two, and so exact in float.

struct Pair {
    Image image, reference;
};

Image make(int width, int height, const auto& pattern) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image(x, y)[c] = pattern(x, y, c);
    return image;
}

Pair pair(int width, int height, const auto& image, const auto& reference) {
    return {make(width, height, image), make(width, height, reference)};
}

/// Coloured squares against the same with a border moved by a pixel and wrong colours. Taller than a band.
const Pair& tiles() {
    static constexpr int inks[4][3] = {{16, 2, 0}, {1, 10, 15}, {13, 13, 2}, {6, 6, 6}};
    static const Pair result = pair(
        40, 72,
        [](int x, int y, int c) {
            const int moved = x >= 20 ? x - 1 : x, swapped = y >= 48 && x < 20 ? 1 : 0;
            return static_cast<float>(inks[((moved / 8 + y / 8) % 4) ^ swapped][c]) / 16;
        },
        [](int x, int y, int c) { return static_cast<float>(inks[(x / 8 + y / 8) % 4][c]) / 16; });
    return result;
}

/// A dim ground with spots up to 900: one moved, one missing, one too many.
const Pair& spots() {
    const auto ground = [](int x, int y, int c) { return static_cast<float>(4 + x + 2 * y + 8 * c) / 256; };
    const auto in_disc = [](int x, int y, int centre) { return (x - centre) * (x - centre) + (y - 9) * (y - 9) <= 4; };
    static const Pair result = pair(
        48, 32, [=](int x, int y, int c) { return in_disc(x, y, 11)   ? 60
                                                  : x == 40 && y == 5 ? 300
                                                                      : ground(x, y, c); },
        [=](int x, int y, int c) { return in_disc(x, y, 10)    ? 60
                                          : x == 30 && y == 20 ? 900
                                                               : ground(x, y, c); });
    return result;
}

/// A smooth image above 1 with noise of four samples, some of them bright.
const Pair& noise() {
    const auto smooth = [](int x, int y, int c) {
        return static_cast<float>(20 + x * (43 - x) + y * (35 - y) * (c + 1)) / 256;
    };
    const auto sample = [](int x, int y, int c, int s) {
        auto n = static_cast<std::uint32_t>(x + 97 * y + 8191 * c + 65537 * s) * 2654435761u;
        n = (n ^ (n >> 15)) * 2246822519u;
        return static_cast<int>(n >> 24);
    };
    static const Pair result = pair(
        44, 36,
        [=](int x, int y, int c) {
            int sum = 0;
            for (int s = 0; s < 4; ++s) {
                const int value = sample(x, y, c, s);
                sum += value < 6 ? 2048 : value;
            }
            return smooth(x, y, c) * static_cast<float>(sum) / 1024;
        },
        smooth);
    return result;
}

struct Expected {
    const Pair& (*images)();
    bool hdr;
    double pixels_per_degree, mean;
    FlipExposures exposures;
    struct Pixel {
        int x, y;
        double value;
    };
    std::vector<Pixel> pixels;
};

// Printed by tests/data/flip/make_values.py.
const std::array<Expected, 10> table{{
    {tiles,
     false,
     67.0206433,
     0.26603847,
     {},
     {{0, 0, 0.000000}, {39, 71, 0.055694}, {19, 5, 0.100097}, {30, 20, 0.242910}, {20, 68, 0.592531}}},
    {tiles,
     false,
     30,
     0.28293530,
     {},
     {{0, 0, 0.000000}, {39, 71, 0.000000}, {19, 5, 0.003749}, {30, 20, 0.268266}, {20, 68, 0.756989}}},
    {tiles,
     true,
     67.0206433,
     0.23022277,
     {1.473802, 2.498335, 2},
     {{0, 0, 0.000000}, {39, 71, 0.080055}, {19, 5, 0.070290}, {30, 20, 0.184516}, {20, 68, 0.450234}}},
    {tiles,
     true,
     30,
     0.25400450,
     {1.473802, 2.498335, 2},
     {{0, 0, 0.000000}, {39, 71, 0.000000}, {19, 5, 0.002508}, {30, 20, 0.210648}, {20, 68, 0.529841}}},
    {spots,
     false,
     67.0206433,
     0.02031921,
     {},
     {{0, 0, 0.000050}, {8, 9, 0.544396}, {13, 9, 0.529578}, {30, 20, 0.313250}, {40, 5, 0.363423}}},
    {spots,
     true,
     67.0206433,
     0.04309183,
     {-8.730484, 3.041599, 12},
     {{0, 0, 0.000079}, {8, 9, 0.653449}, {13, 9, 0.651756}, {30, 20, 0.858662}, {40, 5, 0.851534}}},
    {noise,
     false,
     67.0206433,
     0.30257390,
     {},
     {{0, 0, 0.448173}, {43, 35, 0.559177}, {19, 5, 0.104579}, {12, 30, 0.268180}, {22, 32, 0.154690}}},
    {noise,
     false,
     200,
     0.32930266,
     {},
     {{0, 0, 0.448269}, {43, 35, 0.464718}, {19, 5, 0.249568}, {12, 30, 0.326481}, {22, 32, 0.267936}}},
    {noise,
     true,
     67.0206433,
     0.41052516,
     {-0.954301, -0.382568, 2},
     {{0, 0, 0.388149}, {43, 35, 0.541586}, {19, 5, 0.329786}, {12, 30, 0.380154}, {22, 32, 0.336512}}},
    {noise,
     true,
     200,
     0.38469177,
     {-0.954301, -0.382568, 2},
     {{0, 0, 0.483678}, {43, 35, 0.476586}, {19, 5, 0.314503}, {12, 30, 0.353421}, {22, 32, 0.367255}}},
}};

Image constant(float value, int width = 5, int height = 4) {
    return make(width, height, [value](int, int, int) { return value; });
}

}  // namespace

TEST_CASE("FLIP: agrees with the implementation of its authors") {
    for (const Expected& expected : table) {
        const auto& [image, reference] = expected.images();
        FlipOptions options;
        options.pixels_per_degree = expected.pixels_per_degree;
        const Image map = expected.hdr ? hdr_flip(image, reference, options) : ldr_flip(image, reference, options);
        CAPTURE(expected.hdr);
        CAPTURE(expected.mean);
        CHECK(std::abs(map.mean().x - expected.mean) < 2e-6);
        for (const auto& pixel : expected.pixels) {
            CAPTURE(pixel.x);
            CAPTURE(pixel.y);
            // Where all is flat, both see rounding errors, and the square root of a feature makes them larger.
            CHECK(std::abs(static_cast<double>(map(pixel.x, pixel.y).x) - pixel.value) < 1e-4);
        }
        if (!expected.hdr) continue;
        const FlipExposures exposures = flip_exposures(image, reference);
        CHECK(std::abs(exposures.start - expected.exposures.start) < 1e-5);
        CHECK(std::abs(exposures.stop - expected.exposures.stop) < 1e-5);
        CHECK(exposures.count == expected.exposures.count);
    }
}

TEST_CASE("FLIP: the default display and the means") {
    const auto& [image, reference] = tiles();
    CHECK(mean_ldr_flip(image, reference) == relative(0.26603847, 1e-5));
    CHECK(mean_hdr_flip(image, reference) == relative(0.23022277, 1e-5));
    // Known without filters: black and white are 100 apart in lightness; 0.967388 is the authors' value.
    CHECK(mean_ldr_flip(constant(1), constant(0)) == relative(0.967388, 1e-5));
}

TEST_CASE("FLIP: is 0 for equal images, at most 1, grey, and symmetric when it is LDR") {
    for (const auto& [image, reference] : {tiles(), spots(), noise()}) {
        CHECK(mean_ldr_flip(reference, reference) == 0);
        CHECK(mean_hdr_flip(reference, reference) == 0);
        const Image map = ldr_flip(image, reference), swapped = ldr_flip(reference, image);
        CHECK(map.pixels() == swapped.pixels());
        for (const Image& result : {map, hdr_flip(image, reference)})
            for (const Rgb& p : result.pixels()) {
                REQUIRE(p.x >= 0);
                REQUIRE(p.x <= 1);
                REQUIRE(p == Rgb(p.x));
            }
    }
    // The colours of a display that are farthest apart, and the largest contrast: a diagonal edge, seen without blur.
    const Image green = make(3, 3, [](int, int, int c) { return c == 1 ? 1.0f : 0.0f; });
    const Image blue = make(3, 3, [](int, int, int c) { return c == 2 ? 1.0f : 0.0f; });
    const Image diagonal = make(9, 9, [](int x, int y, int) { return x > y ? 1.0f : 0.0f; });
    for (const double pixels_per_degree : {1.0, 10.0, 67.0, 500.0}) {
        FlipOptions options;
        options.pixels_per_degree = pixels_per_degree;
        const Image farthest = ldr_flip(green, blue, options), edge = ldr_flip(diagonal, constant(0, 9, 9), options);
        CHECK(farthest.mean().x == relative(1, 1e-5));
        for (const Image& map : {farthest, edge})
            for (const Rgb& p : map.pixels()) REQUIRE(p.x <= 1);
    }
}

TEST_CASE("FLIP: the number of threads does not change the result") {
    const auto wavy = [](int factor) {
        return make(30, 300,
                    [factor](int x, int y, int c) { return static_cast<float>((x * factor + y * 7 + c) % 64) / 32; });
    };
    FlipOptions one, three;
    one.threads = 1;
    three.threads = 3;
    CHECK(ldr_flip(wavy(3), wavy(5), one).pixels() == ldr_flip(wavy(3), wavy(5), three).pixels());
    CHECK(hdr_flip(wavy(3), wavy(5), one).pixels() == hdr_flip(wavy(3), wavy(5), three).pixels());
}

TEST_CASE("FLIP: bands of rows meet without a seam") {
    // Every row is the same, so every row of the map is, too: in several bands and in a single one.
    const auto rows = [](int factor, int height) {
        return make(30, height, [factor](int x, int, int c) { return static_cast<float>((x * factor + c) % 16) / 16; });
    };
    const Image map = ldr_flip(rows(3, 150), rows(5, 150)), single = ldr_flip(rows(3, 1), rows(5, 1));
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) REQUIRE(std::abs(map(x, y).x - single(x, 0).x) < 1e-5f);
}

TEST_CASE("FLIP: images beyond the range of a display") {
    // LDR-FLIP sees what is clamped; negative radiance is black to both.
    CHECK(mean_ldr_flip(constant(1), constant(7)) == 0);
    CHECK(mean_ldr_flip(constant(-3), constant(0)) == 0);
    CHECK(mean_hdr_flip(constant(-3), constant(0)) == 0);

    // HDR-FLIP does not depend on the unit of radiance, even at the ends of a float.
    const Pair& pair = noise();
    const double expected = mean_hdr_flip(pair.image, pair.reference);
    for (const float scale : {0x1p-100f, 0x1p100f}) {
        Pair scaled = pair;
        for (Image* image : {&scaled.image, &scaled.reference})
            for (Rgb& p : image->pixels()) p *= scale;
        CHECK(mean_hdr_flip(scaled.image, scaled.reference) == relative(expected, 1e-4));
    }
    constexpr float largest = std::numeric_limits<float>::max();
    CHECK(mean_hdr_flip(constant(largest), constant(1)) > 0.2);
    CHECK(mean_hdr_flip(constant(1), constant(largest)) > 0.9);

    // The authors' implementation leaves the range of an integer when the median is 0.
    Image mostly_black(5, 4);
    mostly_black(1, 1) = Rgb(8);
    mostly_black(2, 2) = mostly_black(3, 3) = Rgb(2);
    const FlipExposures exposures = flip_exposures(constant(1), mostly_black);
    CHECK(exposures.stop - exposures.start == relative(2, 1e-5));  // 8 is the brightest, 2 the median of the rest
    CHECK(exposures.count == 2);
    Image negative = mostly_black;
    for (Rgb& p : negative.pixels()) p = p == Rgb(0) ? Rgb(-5) : Rgb(p.x, p.x, -p.x);
    for (Rgb& p : mostly_black.pixels()) p.z = 0;
    CHECK(flip_exposures(constant(1), negative).stop == flip_exposures(constant(1), mostly_black).stop);
    CHECK(mean_hdr_flip(constant(1), mostly_black) > 0.5);
    CHECK(flip_exposures(constant(4), constant(0)).start == flip_exposures(constant(4), constant(4)).start);
    CHECK(flip_exposures(constant(0), constant(0)).count == 1);
    CHECK(mean_hdr_flip(constant(4), constant(0)) > 0.5);
}

TEST_CASE("FLIP: given exposures") {
    const auto at = [](double start, double stop, int count) {
        FlipOptions options;
        options.exposures = FlipExposures{start, stop, count};
        return hdr_flip(noise().image, noise().reference, options);
    };
    const Image dark = at(-6, -6, 1), middle = at(-3, -3, 1), bright = at(0, 0, 1), all = at(-6, 0, 3);
    for (std::size_t i = 0; i < all.pixels().size(); ++i)
        REQUIRE(all.pixels()[i] == glm::max(glm::max(dark.pixels()[i], middle.pixels()[i]), bright.pixels()[i]));
    CHECK(dark.mean().x < middle.mean().x);

    for (const FlipExposures& bad : {FlipExposures{1, 0, 2}, FlipExposures{0, 1, 0}, FlipExposures{0, 1, 1001},
                                     FlipExposures{-1e9, 0, 2}, FlipExposures{0, std::nan(""), 2}}) {
        CHECK_THROWS_AS(at(bad.start, bad.stop, bad.count), Error);
    }
}

TEST_CASE("FLIP: refuses what it cannot compare") {
    const Image small = constant(1, 4, 5), image = constant(1);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image broken = image;
        broken(3, 2).y = broken(0, 3).x = bad;
        for (const auto flip : {mean_ldr_flip, mean_hdr_flip}) {
            CHECK(message_of([&] { flip(image, broken, {}); }).find("in the reference the pixel in column 3, row 2") !=
                  std::string::npos);
            CHECK(message_of([&] { flip(broken, image, {}); }).find("in the image the pixel in column 3, row 2") !=
                  std::string::npos);
        }
    }
    for (const auto flip : {mean_ldr_flip, mean_hdr_flip}) {
        CHECK_THROWS_AS(flip(image, small, {}), Error);
        CHECK_THROWS_AS(flip(Image(), Image(), {}), Error);
        Image other = image, one = image;
        one.metadata["scene"] = "a";
        other.metadata["scene"] = "b";
        CHECK_THROWS_AS(flip(one, other, {}), Error);
        for (const double pixels_per_degree : {0.0, -67.0, 0.5, 1e9, std::nan("")}) {
            FlipOptions options;
            options.pixels_per_degree = pixels_per_degree;
            CHECK_THROWS_AS(flip(image, image, options), Error);
        }
    }
    Image described = image;
    described.metadata["scene"] = "a";
    CHECK(ldr_flip(described, described).metadata == described.metadata);
}
