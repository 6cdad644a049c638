#include <lightswitch/compare/montage.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace lightswitch;

namespace {

int set_dots(const Image& image) {
    int count = 0;
    for (const Rgb& p : image.pixels()) count += !is_black(p);
    return count;
}

}  // namespace

TEST_CASE("text: glyphs are drawn dot by dot, scaled, and cut off at the border") {
    Image image(6, 8);
    draw_text(image, 0, 0, "A", Rgb(1));
    const std::vector<std::string> expected{".###..", "#...#.", "#...#.", "#####.",
                                            "#...#.", "#...#.", "#...#.", "......"};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 6; ++x)
            CHECK((image(x, y).x > 0) == (expected[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#'));

    Image large(40, 40);
    draw_text(large, 5, 5, "A", Rgb(1), 3);
    CHECK(set_dots(large) == 9 * set_dots(image));
    Image cut(3, 3);
    draw_text(cut, -2, -3, "A", Rgb(1));  // the crossbar's right end and what is below it
    CHECK(cut(0, 0) == Rgb(1));
    CHECK(set_dots(cut) == 5);
    CHECK_NOTHROW(draw_text(cut, 1000000, -1000000, "A", Rgb(1)));
    CHECK(text_width("") == 0);
    CHECK(text_width("ab", 2) == 22);
}

TEST_CASE("text: every printable character has a glyph of its own, others a question mark") {
    std::vector<Image> glyphs;
    for (char c = ' '; c <= '~'; ++c) {
        Image glyph(5, 7);
        draw_text(glyph, 0, 0, std::string(1, c), Rgb(1));
        CHECK((set_dots(glyph) > 0) == (c != ' '));
        for (const Image& other : glyphs) CHECK(other.pixels() != glyph.pixels());
        glyphs.push_back(std::move(glyph));
    }
    Image other(5, 7);
    draw_text(other, 0, 0, "\x7f", Rgb(1));
    CHECK(other.pixels() == glyphs['?' - ' '].pixels());
}

TEST_CASE("montage: tiles in reading order, each at its own exposure, captions below") {
    Image dark(20, 10), bright(10, 10);
    for (Rgb& p : dark.pixels()) p = Rgb(0.125f);
    for (Rgb& p : bright.pixels()) p = Rgb(0.5f, 8, 0);
    bright(9, 9) = Rgb(std::numeric_limits<float>::quiet_NaN());
    const std::vector<Tile> tiles{{"a", dark, 1}, {"b", bright}, {"", dark}};
    const Image sheet = montage(tiles, {.columns = 2, .gap = 4});
    REQUIRE(sheet.width() == 4 + 2 * (20 + 4));
    REQUIRE(sheet.height() == 4 + 2 * (10 + 11 + 4));
    CHECK(sheet(0, 0) == Rgb(1));
    CHECK(sheet(4, 4) == Rgb(0.25f));
    CHECK(sheet(23, 13) == Rgb(0.25f));
    CHECK(sheet(24, 13) == Rgb(1));
    CHECK(sheet(28 + 5, 4) == Rgb(0.5f, 1, 0));  // centred in its cell
    CHECK(sheet(28 + 14, 13) == Rgb(1, 0, 1));   // NaN
    CHECK(sheet(4, 4 + 25) == Rgb(0.125f));      // second row
    const auto ink = [&](int left, int top) {
        int count = 0;
        for (int y = top; y < top + 11; ++y)
            for (int x = left; x < left + 20; ++x) count += sheet(x, y) != Rgb(1);
        return count;
    };
    CHECK(ink(4, 14) == 14);   // the dots of an 'a'
    CHECK(ink(28, 14) == 16);  // and of a 'b'
    CHECK(ink(4, 39) == 0);    // no label
}

TEST_CASE("montage: chooses columns, shortens captions, refuses what cannot be") {
    std::vector<Tile> tiles(4, Tile{"a caption that is much wider than its cell", Image(40, 40)});
    const Image sheet = montage(tiles, {.gap = 2});
    CHECK(sheet.width() == 2 + 2 * 42);
    for (int y = 0; y < sheet.height(); ++y) CHECK(sheet(0, y) == Rgb(1));  // no caption runs into the margin
    CHECK_THROWS_AS(montage({}), Error);
    CHECK_THROWS_AS(montage(tiles, {.columns = -1}), Error);
    CHECK_THROWS_AS(montage(tiles, {.gap = -1}), Error);
    CHECK_THROWS_AS(montage(tiles, {.letter_size = 100}), Error);
    tiles[1].image = Image();
    CHECK_THROWS_AS(montage(tiles), Error);
    tiles.assign(2, Tile{"", Image(1, 65536)});
    CHECK_THROWS_AS(montage(tiles, {.columns = 1}), Error);
}
