// What Mitsuba gives was taken from version 3.9.1, variant scalar_rgb: a `bitmap` texture made from an array, evaluated
// at a surface interaction with that uv.

#include "support/errors.hpp"
#include "support/relative.hpp"

#include <lightswitch/texture/bitmap.hpp>

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace lightswitch;
using test::message_of;
using test::relative;

namespace {

constexpr std::array filters{TextureFilter::bilinear, TextureFilter::nearest};
constexpr std::array wraps{TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp};
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// 4 x 3 texels (10 y + x + 1, x, y) in column x and row y.
Bitmap numbered(TextureFilter filter, TextureWrap wrap) {
    std::vector<float> texels;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (const int value : {10 * y + x + 1, x, y}) texels.push_back(static_cast<float>(value));
    return {4, 3, std::move(texels), TexelEncoding::linear, {filter, wrap}};
}

Bitmap grey_row(std::vector<std::uint8_t> texels, TexelEncoding encoding, TextureLookup lookup = {}) {
    const int width = static_cast<int>(texels.size());
    return {width, 1, std::move(texels), encoding, lookup};
}

}  // namespace

TEST_CASE("a bitmap is looked up as in Mitsuba, with every filter and wrap") {
    constexpr std::array<Vec2, 13> uv{
        Vec2(0, 0),           Vec2(0.125f, 1 / 6.0f), Vec2(0.3f, 0.4f),      Vec2(0.5f, 0.5f), Vec2(1, 1),
        Vec2(0x1.fffffep-1f), Vec2(-0.1f, -0.2f),     Vec2(-1.1f, -1.2f),    Vec2(1.1f, 1.3f), Vec2(2.1f, 2.3f),
        Vec2(-7.3f, 5.55f),   Vec2(-1e-6f, -1e-6f),   Vec2(1000.3f, -777.2f)};
    struct Case {
        TextureFilter filter;
        TextureWrap wrap;
        std::array<double, 13> red;
    };
    using enum TextureFilter;
    using enum TextureWrap;
    const Case cases[] = {
        {nearest, repeat, {1, 1, 12, 13, 1, 24, 24, 24, 1, 1, 13, 24, 22}},
        {nearest, mirror, {1, 1, 12, 13, 24, 24, 1, 24, 24, 1, 13, 1, 22}},
        {nearest, clamp, {1, 1, 12, 13, 24, 24, 1, 1, 24, 24, 21, 1, 4}},
        {bilinear,
         repeat,
         {12.5, 1, 8.700001, 12.5, 12.5, 12.50001, 22.7, 22.7, 5.299998, 5.299997, 14.80001, 12.50007, 20.69897}},
        {bilinear, mirror, {1, 1, 8.700001, 12.5, 24, 24, 2, 23, 20, 4.999996, 11.79998, 1, 20.69897}},
        {bilinear, clamp, {1, 1, 8.700001, 12.5, 24, 24, 1, 1, 24, 24, 21, 1, 4}},
    };
    for (const Case& expected : cases) {
        const Bitmap bitmap = numbered(expected.filter, expected.wrap);
        CAPTURE(static_cast<int>(expected.filter));
        CAPTURE(static_cast<int>(expected.wrap));
        for (std::size_t i = 0; i < uv.size(); ++i) {
            CAPTURE(i);
            const Rgb value = bitmap.at(uv[i]);
            CHECK(value.x == relative(expected.red[i], 2e-6));
            // The three channels are one linear function of each other, so red = 10 blue + green + 1 holds of blends.
            CHECK(value.x == relative(10 * value.z + value.y + 1, 1e-6));
        }
    }
}

TEST_CASE("blends are what weights worked out by hand say") {
    using enum TextureWrap;
    const auto at = [](TextureFilter filter, TextureWrap wrap, float u) {
        return grey_row({0, 51, 255}, TexelEncoding::linear, {filter, wrap}).at({u, 0.5f}).x;
    };
    // Centres at 1/6, 1/2 and 5/6 hold 0, 0.2 and 1.
    const auto bilinear = [&](TextureWrap wrap, float u) { return at(TextureFilter::bilinear, wrap, u); };
    const auto nearest = [&](TextureWrap wrap, float u) { return at(TextureFilter::nearest, wrap, u); };
    for (const TextureWrap wrap : wraps) {
        CHECK(bilinear(wrap, 0.5f) == relative(0.2, 1e-6));
        CHECK(bilinear(wrap, 0.25f) == relative(0.05, 1e-6));  // a quarter of the way
        CHECK(bilinear(wrap, 0.75f) == relative(0.8, 1e-6));   // three quarters
        CHECK(nearest(wrap, 0.33f) == 0);
        CHECK(nearest(wrap, 0.34f) == relative(0.2, 1e-6));
        CHECK(nearest(wrap, 0.99f) == 1);
    }
    CHECK(bilinear(repeat, 0) == relative(0.5, 1e-6));  // between the last and the first
    CHECK(bilinear(mirror, 0) == 0);
    CHECK(bilinear(clamp, 0) == 0);
    CHECK(bilinear(repeat, -0.25f) == relative(0.8, 1e-6));   // as at 0.75
    CHECK(bilinear(mirror, -0.25f) == relative(0.05, 1e-6));  // as at 0.25
    CHECK(bilinear(clamp, -0.25f) == 0);
    CHECK(bilinear(repeat, 1.25f) == relative(0.05, 1e-6));
    CHECK(bilinear(mirror, 1.25f) == relative(0.8, 1e-6));
    CHECK(bilinear(clamp, 1.25f) == 1);
    CHECK(nearest(repeat, 1) == 0);
    CHECK(nearest(mirror, 1) == 1);
    CHECK(nearest(clamp, 1) == 1);
    CHECK(nearest(repeat, -1e-6f) == 1);
    CHECK(nearest(mirror, -1e-6f) == 0);
    CHECK(nearest(mirror, 2.1f) == 0);
    CHECK(nearest(mirror, -0.99f) == 1);
    CHECK(nearest(mirror, -1.99f) == 0);
}

TEST_CASE("sRGB is decoded once, texel by texel, and before blending") {
    // Mitsuba gives 0.2158604 for a byte of 128, 0.0030353 for 10, 0.9911021 for 254.
    const Bitmap bitmap(2, 2, std::vector<std::uint8_t>{0, 10, 11, 128, 188, 255, 1, 2, 3, 64, 200, 254},
                        TexelEncoding::srgb);
    const Rgb corner = bitmap.at({0.75f, 0.25f});
    CHECK(corner.x == relative(0.21586041152477264, 1e-6));
    CHECK(corner.y == relative(0.5028866529464722, 1e-6));
    CHECK(corner.z == 1);
    CHECK(bitmap.at({0.25f, 0.25f}).y == relative(0.0030352699104696512, 1e-6));
    CHECK(bitmap.at({0.75f, 0.75f}).z == relative(0.9911021590232849, 1e-6));
    const Rgb middle = bitmap.at({0.5f, 0.5f});
    CHECK(middle.x == relative(0.06685834378004074, 1e-6));
    CHECK(middle.y == relative(0.27102744579315186, 1e-6));
    CHECK(middle.z == relative(0.4988398551940918, 1e-6));
    const Rgb between = bitmap.at({0.4f, 0.7f});
    CHECK(between.x == relative(0.020509785041213036, 1e-5));
    CHECK(between.y == relative(0.17162832617759705, 1e-5));
    CHECK(between.z == relative(0.2984055280685425, 1e-5));

    for (int byte = 0; byte < 256; ++byte) {
        const double encoded = byte / 255.0;
        const double decoded = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        const auto value = static_cast<std::uint8_t>(byte);
        CHECK(grey_row({value}, TexelEncoding::srgb).at({0.3f, 0.3f}).x == relative(decoded, 1e-6));
        CHECK(grey_row({value}, TexelEncoding::linear).at({0.3f, 0.3f}).x == relative(encoded, 1e-7));
    }
}

TEST_CASE("any coordinate gives a texel") {
    std::vector<float> numbers{0.0f,  -0.0f, 0x1.fffffep-1f, 1.0f,    -1.0f,    1e-45f,   -1e-45f,   3e9f,
                               -3e9f, 1e30f, -1e30f,         3.4e38f, -3.4e38f, infinity, -infinity, not_a_number};
    for (int power = 20; power < 40; ++power)
        for (const float offset : {-0.5f, 0.0f, 0.5f}) {
            numbers.push_back(std::ldexp(1.0f, power) + offset);
            numbers.push_back(-std::ldexp(1.0f, power) + offset);
        }
    for (const TextureFilter filter : filters)
        for (const TextureWrap wrap : wraps)
            for (const int width : {1, 2, 3, 1021}) {
                std::vector<std::uint8_t> texels(static_cast<std::size_t>(width), 100);
                texels.back() = 200;
                const Bitmap bitmap = grey_row(std::move(texels), TexelEncoding::linear, {filter, wrap});
                for (const float u : numbers)
                    for (const float v : numbers) {
                        const float value = bitmap.at({u, v}).x * 255;
                        REQUIRE_MESSAGE((value > 99.99f && value < 200.01f), u, " ", v, " ", value);
                    }
            }
}

TEST_CASE("a uniform bitmap has one value everywhere") {
    for (const TextureWrap wrap : wraps) {
        const Bitmap bitmap(3, 2, std::vector<float>(6, 0.1f), TexelEncoding::linear, {TextureFilter::bilinear, wrap});
        for (float u = -3; u < 3; u += 0.0371f) CHECK(bitmap.at({u, 0.7f * u}).y == 0.1f);
    }
}

TEST_CASE("memory, channels, mean and range are those of the texels") {
    const Bitmap rgb(2, 1, std::vector<std::uint8_t>{0, 255, 128, 255, 255, 0}, TexelEncoding::srgb);
    CHECK(rgb.bytes() == 6);
    CHECK(rgb.channels() == 3);
    CHECK(rgb.width() == 2);
    CHECK(rgb.height() == 1);
    CHECK(rgb.mean().x == 0.5f);
    CHECK(rgb.mean().y == 1);
    CHECK(rgb.mean().z == relative(0.21586 / 2, 1e-4));
    CHECK(rgb.least() == Rgb(0, 1, 0));
    CHECK(rgb.most().x == 1);
    CHECK(rgb.most().z == relative(0.21586, 1e-4));
    CHECK(rgb.texel(1, 0) == Rgb(1, 1, 0));
    CHECK(grey_row({1, 2, 3}, TexelEncoding::srgb).bytes() == 3);
    CHECK(Bitmap(1, 3, std::vector<Half>(3, Half(0.5f)), TexelEncoding::linear).bytes() == 6);

    Image image(2, 2);
    image(1, 0) = Rgb(0.5f);
    CHECK(make_bitmap(image).bytes() == 16);  // grey: one channel
    CHECK(make_bitmap(image, TexelPrecision::half).bytes() == 8);
    image(1, 1) = Rgb(-1, 0, 7);
    const Bitmap color = make_bitmap(image, TexelPrecision::half);
    CHECK(color.bytes() == 24);
    CHECK(color.texel(1, 1) == Rgb(-1, 0, 7));
    CHECK(color.texel(1, 0) == Rgb(0.5f));
    CHECK(color.least() == Rgb(-1, 0, 0));
    CHECK(color.most() == Rgb(0.5f, 0.5f, 7));
}

TEST_CASE("the mean is that of look-ups over the unit square, with every filter and wrap") {
    for (const TextureFilter filter : filters)
        for (const TextureWrap wrap : wraps) {
            const Bitmap bitmap = numbered(filter, wrap);
            DVec3 sum(0);
            constexpr int side = 480;  // a multiple of the texels, so that midpoints integrate linear pieces
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) sum += DVec3(bitmap.at((Vec2(x, y) + 0.5f) / static_cast<float>(side)));
            for (int c = 0; c < 3; ++c) CHECK(sum[c] / (side * side) == relative(bitmap.mean()[c], 1e-5));
        }
}

TEST_CASE("texels that are not finite are named, and impossible bitmaps refused") {
    Image image(3, 2);
    CHECK(make_bitmap(image).problem().empty());
    for (const float bad : {infinity, -infinity, not_a_number})
        for (const TexelPrecision precision : {TexelPrecision::float32, TexelPrecision::half}) {
            image(2, 1) = Rgb(0, bad, 1);
            CHECK(make_bitmap(image, precision).problem() ==
                  "the texel in column 2 and row 1 of the texture is not a finite number");
        }
    image(2, 1) = Rgb(70000);
    CHECK(message_of([&] { make_bitmap(image, TexelPrecision::half); }).find("70000") != std::string::npos);
    CHECK(message_of([] { make_bitmap(Image()); }).find("0 x 0") != std::string::npos);
    const auto made = [](int width, int height, std::size_t count, TexelEncoding encoding) {
        return message_of([&] { Bitmap(width, height, std::vector<float>(count), encoding); });
    };
    CHECK(made(2, 2, 4, TexelEncoding::linear) == "(no error)");
    CHECK(made(2, 2, 8, TexelEncoding::linear).find("one or three values per texel, not 8") != std::string::npos);
    CHECK(made(0, 2, 0, TexelEncoding::linear).find("0 x 2") != std::string::npos);
    CHECK(made(-1, -1, 1, TexelEncoding::linear).find("-1 x -1") != std::string::npos);
    CHECK(made(2, 2, 4, TexelEncoding::srgb).find("8 bits") != std::string::npos);
}

TEST_CASE("numbers of 16 bits: all come back, and floats round to the nearest") {
    const auto value = [](std::uint16_t bits) {
        const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
        const double size = exponent == 0    ? std::ldexp(mantissa, -24)
                            : exponent == 31 ? (mantissa == 0 ? std::numeric_limits<double>::infinity() : NAN)
                                             : std::ldexp(1024 + mantissa, exponent - 25);
        return (bits & 0x8000) != 0 ? -size : size;
    };
    for (int i = 0; i < 65536; ++i) {
        const auto half = std::bit_cast<Half>(static_cast<std::uint16_t>(i));
        const double expected = value(static_cast<std::uint16_t>(i));
        const auto got = static_cast<float>(half);
        if (std::isnan(expected)) {
            REQUIRE(std::isnan(got));
            REQUIRE(std::isnan(static_cast<float>(Half(got))));
            continue;
        }
        REQUIRE(static_cast<double>(got) == expected);
        REQUIRE(std::bit_cast<std::uint16_t>(Half(got)) == i);
        if ((i & 0x7fff) >= 0x7bff) continue;
        // Between this number and the next: the nearer one, and at the middle the even one.
        const double next = value(static_cast<std::uint16_t>(i + 1)), middle = (expected + next) / 2;
        const auto rounded = [](double x) { return std::bit_cast<std::uint16_t>(Half(static_cast<float>(x))); };
        REQUIRE(rounded(middle) == (i % 2 == 0 ? i : i + 1));
        REQUIRE(rounded(0.75 * expected + 0.25 * next) == i);
        REQUIRE(rounded(0.25 * expected + 0.75 * next) == i + 1);
    }
    CHECK(static_cast<float>(Half(65519.0f)) == 65504);
    CHECK(static_cast<float>(Half(65520.0f)) == infinity);
    CHECK(static_cast<float>(Half(-1e30f)) == -infinity);
    CHECK(static_cast<float>(Half(1e-30f)) == 0);
}
