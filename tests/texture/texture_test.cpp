// What Mitsuba gives was taken from version 3.9.1, variant scalar_rgb, by evaluating the textures at given uv.

#include "support/errors.hpp"
#include "support/relative.hpp"

#include <lightswitch/texture/texture.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

using namespace lightswitch;
using test::message_of;
using test::relative;

TEST_CASE("a checkerboard is Mitsuba's") {
    const Checkerboard board{Rgb(0.1f, 0.2f, 0.3f), Rgb(0.5f, 0.6f, 0.7f)};
    for (const Vec2 uv : {Vec2(0, 0), Vec2(0.25f, 0.25f), Vec2(0.75f, 0.75f), Vec2(0.5f, 0.25f), Vec2(0.5f, 0.5f),
                          Vec2(1, 0.25f), Vec2(1, 1), Vec2(-0.25f, -0.25f), Vec2(-0.75f, 0.25f), Vec2(7.25f, 3.3f)})
        CHECK_MESSAGE(board.at(uv) == board.color0, uv.x, " ", uv.y);
    for (const Vec2 uv : {Vec2(0.75f, 0.25f), Vec2(0.25f, 0.75f), Vec2(0.50001f, 0.25f), Vec2(-0.25f, 0.25f)})
        CHECK_MESSAGE(board.at(uv) == board.color1, uv.x, " ", uv.y);
    for (const float any : {infinity, -infinity, 1e30f, std::numeric_limits<float>::quiet_NaN()})
        CHECK(board.at({any, 0.25f}) == board.color0);
    CHECK(board.mean().x == relative(0.3, 1e-6));
    CHECK(Checkerboard().color0 == Rgb(0.4f));
    CHECK(Checkerboard().color1 == Rgb(0.2f));
}

TEST_CASE("to_uv is the matrix applied to (u, v, 1), as in Mitsuba") {
    std::vector<float> texels;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (const int value : {10 * y + x + 1, x, y}) texels.push_back(static_cast<float>(value));
    const auto bitmap = std::make_shared<const Bitmap>(4, 3, std::move(texels), TexelEncoding::linear);
    const auto check = [&](const UvTransform& to_uv, double first, double second) {
        const Texture texture(bitmap, to_uv);
        CHECK(texture({0.1f, 0.1f}).x == relative(first, 2e-6));
        CHECK(texture({0.3f, 0.2f}).x == relative(second, 2e-6));
    };
    check({{2, 0, 0.25f}, {0, 3, 0}}, 6.3, 16.9);                               // scaled, then moved
    check({{2, 0, 0.5f}, {0, 3, 0}}, 7.3, 14.3);                                // moved, then scaled
    check({{0.866025f, -0.5f, 0}, {0.5f, 0.866025f, 0}}, 3.8646169, 5.835383);  // turned by 30 degrees
    CHECK(UvTransform{}({0.3f, -7}) == Vec2(0.3f, -7));

    const Texture board(Checkerboard{Rgb(0), Rgb(1)}, UvTransform{{2, 0, 0}, {0, 1, 0.5f}});
    CHECK(board({0.1f, 0.1f}) == Rgb(1));
    CHECK(board({0.3f, 0.1f}) == Rgb(0));
}

TEST_CASE("a factor multiplies what a texture returns, its mean, range and slope") {
    const auto bitmap = std::make_shared<const Bitmap>(2, 1, std::vector<float>{0.1f, 0.2f, 0.3f, 0.5f, 0.8f, 0.1f},
                                                       TexelEncoding::linear);
    const Texture plain(bitmap), half = plain.scaled(Rgb(0.5f, 1, -2)), quarter = half.scaled(Rgb(0.5f));
    for (const Vec2 uv : {Vec2(0.25f, 0.5f), Vec2(0.4f, 0), Vec2(3, -2)}) {
        CHECK(half(uv) == plain(uv) * Rgb(0.5f, 1, -2));
        CHECK(quarter(uv) == plain(uv) * Rgb(0.25f, 0.5f, -1));
    }
    CHECK(half.mean().z == relative(-0.4, 1e-6));
    CHECK(half.least() == Rgb(0.05f, 0.2f, -0.6f));
    CHECK(half.most() == Rgb(0.25f, 0.8f, -0.2f));
    // Between the centres of the texels, half of the unit square.
    CHECK(quarter.gradient({0.5f, 0.5f}).x == relative(2 * (0.2126 * 0.1 + 0.7152 * 0.3 + 0.0722 * 0.2), 1e-5));
    CHECK(plain.scaled(Rgb(1, infinity, 1)).problem() == "the texture's factor is not finite");
}

TEST_CASE("a texture tells its mean, its range and what is wrong with it") {
    const Texture board(Checkerboard{Rgb(0.1f, 0.9f, 0.5f), Rgb(0.3f, 0.1f, 2)});
    CHECK(board.problem().empty());
    CHECK(board.least() == Rgb(0.1f, 0.1f, 0.5f));
    CHECK(board.most() == Rgb(0.3f, 0.9f, 2));
    CHECK(board.mean().y == relative(0.5, 1e-6));
    CHECK(Texture(Checkerboard{Rgb(0), Rgb(0, infinity, 0)}).problem() ==
          "the checkerboard has a colour that is not finite");
    CHECK(Texture(Checkerboard(), UvTransform{{1, 0, 0}, {0, infinity, 0}}).problem() ==
          "the texture's to_uv has a value that is not finite");

    const Texture picture(Bitmap(1, 2, std::vector<std::uint8_t>{51, 255}, TexelEncoding::linear));
    CHECK(picture.problem().empty());
    CHECK(picture.least().x == relative(0.2, 1e-6));
    CHECK(picture.most() == Rgb(1));
    CHECK(picture.mean().x == relative(0.6, 1e-6));
    const Texture copy = picture;
    CHECK(copy({0.5f, 0.75f}) == Rgb(1));
    CHECK(Texture(Bitmap(1, 1, std::vector<float>{infinity}, TexelEncoding::linear)).problem().find("column 0") !=
          std::string::npos);
    CHECK(message_of([] { Texture(std::shared_ptr<const Bitmap>()); }).find("needs a bitmap") != std::string::npos);
}
