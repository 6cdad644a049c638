// What Mitsuba gives was taken from version 3.9.1, variant scalar_rgb: a `bitmap` texture that reads the same bytes.

#include "support/relative.hpp"
#include "texture/files.hpp"

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/texture/load_bitmap.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

Bitmap loaded(const std::string& bytes, const BitmapOptions& options = {}, const std::string& name = "picture") {
    const Folder folder;
    return load_bitmap(folder.write(name, bytes), options);
}

/// Why the file is refused, without the folder's name.
std::string refused(const std::string& bytes) {
    const Folder folder;
    const auto path = folder.write("picture", bytes);
    const std::string message = message_of([&] { load_bitmap(path); });
    CHECK_MESSAGE((message == "no error" || message.starts_with(path.string() + ": ")), message);
    return message;
}

void check_rgb(const Rgb& value, std::initializer_list<double> expected, double tolerance = 1e-6) {
    int c = 0;
    for (const double x : expected) CHECK(value[c++] == relative(x, tolerance));
}

}  // namespace

TEST_CASE("files of 8 bits stay so, and mean what they mean in Mitsuba") {
    for (const auto& [bytes, channels] :
         {std::pair(sample_png(8, 2), 3), std::pair(sample_png(8, 6), 3), std::pair(sample_png(8, 0), 1),
          std::pair(sample_png(8, 4), 1), std::pair(sample_bmp(), 3), std::pair(sample_tga(true), 3),
          std::pair(sample_tga(false), 3)}) {
        const Bitmap bitmap = loaded(bytes);
        CHECK(bitmap.width() == 4);
        CHECK(bitmap.height() == 3);
        CHECK(bitmap.channels() == channels);
        CHECK(bitmap.bytes() == static_cast<std::size_t>(12 * channels));
        const Bitmap raw = loaded(bytes, {.raw = true});
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x)
                for (int c = 0; c < channels; ++c) {
                    const int byte = sample_rgb(x, y)[static_cast<std::size_t>(c)];
                    CHECK(raw.texel(x, y)[c] == static_cast<float>(byte) / 255);
                    CHECK(bitmap.texel(x, y)[c] == srgb(byte, 0, 0).x);
                }
        if (channels == 3) {
            check_rgb(loaded(bytes, {.filter = TextureFilter::nearest}).at({0.1f, 0.9f}),
                      {0.3762621283531189, 0.11443546414375305, 0});
            check_rgb(bitmap.at({0.4f, 0.7f}), {0.35766875743865967, 0.16797806322574615, 0.1073511466383934});
            check_rgb(bitmap.at({-0.3f, 1.4f}), {0.1702178418636322, 0.34653958678245544, 0.5074828267097473});
            check_rgb(raw.at({0.4f, 0.7f}), {0.6078431606292725, 0.4117647707462311, 0.345098078250885});
            CHECK(luminance(bitmap.mean()) ==
                  relative(0.34346938133239746, 1e-4));  // Mitsuba's weights differ a little
        } else {
            check_rgb(bitmap.at({0.4f, 0.7f}), {0.35766875743865967, 0.35766875743865967, 0.35766875743865967});
            CHECK(bitmap.mean().x == relative(0.25296029448509216, 1e-6));
        }
    }
}

TEST_CASE("PNG of 16 bits is kept as 16-bit floats, decoded once, as in Mitsuba") {
    for (const int kind : {2, 6}) {
        const Bitmap bitmap = loaded(sample_png(16, kind));
        CHECK(bitmap.bytes() == 72);
        check_rgb(bitmap.texel(0, 0), {0.0016031265258789062, 0.99365234375, 9.09566879272461e-05}, 1e-3);
        check_rgb(bitmap.texel(3, 0), {0.052947998046875, 0.54296875, 0.8662109375}, 1e-3);
        check_rgb(bitmap.at({0.4f, 0.7f}), {0.3559911847114563, 0.16746950149536133, 0.10716553032398224}, 1e-3);
        check_rgb(loaded(sample_png(16, kind), {.raw = true}).at({0.4f, 0.7f}),
                  {0.6065429449081421, 0.4112793207168579, 0.3449462950229645}, 1e-3);
    }
    const Bitmap grey = loaded(sample_png(16, 0));
    CHECK(grey.bytes() == 24);
    CHECK(grey.texel(3, 0).z == relative(0.052947998046875, 1e-3));
}

TEST_CASE("one channel of a file, whichever it has") {
    const auto channel = [](int depth, int kind, detail::ImageChannels part) {
        return detail::decode_stb(sample_png(depth, kind), "a", TexelEncoding::linear, {}, part);
    };
    using enum detail::ImageChannels;
    for (const int depth : {8, 16})
        for (const int kind : {0, 2, 4, 6})
            for (const auto part : {red, green, blue, alpha}) {
                const Bitmap bitmap = channel(depth, kind, part);
                REQUIRE(bitmap.channels() == 1);
                const auto value = [&](int x, int y) {
                    if (part == alpha) return (kind & 4) == 0 ? 255 : x + y == 0 ? 0 : 100;
                    const auto index = (kind & 2) == 0 ? std::size_t{0} : static_cast<std::size_t>(part) - 1;
                    return sample_rgb(x, y)[index];
                };
                for (int y = 0; y < 3; ++y)
                    for (int x = 0; x < 4; ++x) {
                        const int expected = value(x, y);
                        const bool missing = part == alpha && (kind & 4) == 0;
                        const double stored =
                            depth == 8 || missing ? expected / 255.0 : (256.0 * expected + 77) / 65535;
                        CHECK(std::abs(double(bitmap.texel(x, y).x) - stored) < 3e-4);
                    }
            }
}

TEST_CASE("a JPEG is read as in Mitsuba, but for the rounding of its decoder") {
    const Bitmap bitmap = loaded(sample_jpeg(), {.raw = true});
    CHECK(bitmap.bytes() == 20 * 12 * 3);
    constexpr int columns[]{0, 10, 19, 7}, rows[]{0, 5, 11, 2};
    constexpr int pixels[4][4][3]{{{47, 215, 66}, {123, 218, 98}, {188, 220, 119}, {100, 217, 87}},
                                  {{43, 174, 78}, {117, 176, 110}, {185, 177, 138}, {95, 176, 100}},
                                  {{38, 124, 95}, {115, 127, 127}, {181, 128, 158}, {93, 126, 117}},
                                  {{41, 201, 65}, {118, 204, 97}, {184, 206, 124}, {96, 203, 87}}};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            for (int c = 0; c < 3; ++c)
                CHECK(bitmap.texel(columns[i], rows[j])[c] * 255 == relative(pixels[j][i][c], 0).or_absolute(2.5));
}

TEST_CASE("linear files: rows are not turned over, precision is that of the file") {
    Image image(3, 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) image(x, y) = Rgb(x, y, 0.25f * static_cast<float>(x));
    image(1, 1) = Rgb(8, 0.001f, -1);
    const auto same = [&](const Bitmap& bitmap) {
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) CHECK(bitmap.texel(x, y) == image(x, y));
    };
    const std::string pfm = detail::encode_pfm(image);
    same(loaded(pfm));
    CHECK(loaded(pfm).bytes() == 72);
    CHECK(loaded(pfm, {.half = true}).bytes() == 36);
    CHECK(loaded(pfm, {.half = true}).texel(1, 1).y == relative(0.001, 5e-4));
    CHECK(loaded(pfm, {.raw = true}).texel(1, 1) == image(1, 1));
    CHECK(loaded(detail::encode_pfm(Image(5, 4))).bytes() == 80);  // grey
    CHECK(loaded(detail::encode_rgbe(image)).texel(1, 1).x == 8);
    CHECK(loaded(detail::encode_rgbe(image)).texel(2, 0) == image(2, 0));
    image(0, 0) = Rgb(1e6f, 0, 1);
    const Folder folder;
    const auto path = folder.write("bright.pfm", detail::encode_pfm(image));
    CHECK(contains(message_of([&] { load_bitmap(path, {.half = true}); }), "bright.pfm: has a value of 1e+06"));

    if (detail::has_exr) {
        save(folder.path() / "a.exr", image);
        same(load_bitmap(folder.path() / "a.exr"));
        CHECK(load_bitmap(folder.path() / "a.exr").bytes() == 72);
    }
}

#if LIGHTSWITCH_HAS_EXR
TEST_CASE("EXR of 16 bits is kept in 16 bits") {
    const Bitmap bitmap = loaded(half_exr());
    CHECK(bitmap.bytes() == 2 * 2 * 3 * 2);
    CHECK(bitmap.texel(0, 0) == Rgb(2, 1, 0));
    CHECK(bitmap.texel(1, 1) == Rgb(2.75f, 1.75f, 0.75f));
}
#endif

TEST_CASE("what a file is shows in its bytes, not in its name") {
    CHECK(loaded(sample_png(8, 2), {}, "picture.jpg").bytes() == 36);
    CHECK(loaded(sample_jpeg(), {}, "picture.png").width() == 20);
    CHECK(loaded(detail::encode_pfm(Image(3, 3)), {}, "picture.tga").width() == 3);
}

TEST_CASE("what is missing, empty or no image is refused with its name") {
    const Folder folder;
    CHECK(contains(message_of([&] { load_bitmap(folder.path() / "none.png"); }), "none.png: no such file"));
    CHECK(contains(message_of([&] { load_bitmap(folder.path()); }), "directory"));
    CHECK(contains(refused(""), "is empty"));
    CHECK(contains(refused("This is a text, and none that could be taken for an image by anybody."), "no image"));
    CHECK(contains(refused("GIF89a and what follows, which is enough to be looked at as a header"), "no image"));
    CHECK(contains(refused(std::string(1000, '\0')), "no image"));
}

TEST_CASE("cut off at any length, files are refused") {
    const std::string whole[] = {sample_png(8, 2), sample_png(16, 6), sample_jpeg(),
                                 sample_bmp(),     sample_tga(true),  sample_tga(false)};
    for (const std::string& bytes : whole)
        for (std::size_t length = 0; length < bytes.size(); length += length + 7 < bytes.size() ? 7u : 1u) {
            CAPTURE(bytes.size());
            CAPTURE(length);
            CHECK(refused(bytes.substr(0, length)) != "no error");
        }
    // Rows of 128 bytes are as long as stb_image's buffer.
    std::string wide = sample_tga(true).substr(0, 18) + std::string(3 * 128, 'x');
    wide[2] = 3;
    wide[12] = static_cast<char>(128);
    wide[16] = 8;
    CHECK(loaded(wide).width() == 128);
    CHECK(contains(refused(wide.substr(0, wide.size() - 1)), "ends too early"));
}

TEST_CASE("changed at random, files load or are refused, and soon") {
    const std::string whole[] = {sample_png(8, 2), sample_png(16, 6), sample_jpeg(),
                                 sample_bmp(),     sample_tga(true),  sample_tga(false)};
    const auto start = std::chrono::steady_clock::now();
    const Folder folder;
    int refusals = 0;
    for (const std::string& bytes : whole) {
        const auto attempt = [&](const std::string& changed) {
            try {
                const Bitmap bitmap = load_bitmap(folder.write("a", changed));
                REQUIRE(is_finite(bitmap.mean()));
            } catch (const Error&) {
                ++refusals;
            }
        };
        for (std::size_t i = 0; i < bytes.size(); ++i)
            for (const int change : {1, 0x80, 0xff}) {
                std::string changed = bytes;
                changed[i] = static_cast<char>(changed[i] ^ change);
                attempt(changed);
            }
        for (std::uint32_t seed = 0; seed < 400; ++seed) attempt(mutated(bytes, seed));
    }
    CHECK(refusals > 500);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
}

TEST_CASE("damage to a PNG file is noticed wherever it is") {
    const std::string bytes = sample_png(8, 2);
    for (std::size_t i = 8; i < bytes.size(); ++i) {
        std::string changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ 4);
        CHECK_MESSAGE(refused(changed) != "no error", i);
    }
}

TEST_CASE("a JPEG's table of codes may not exceed the values of a byte") {
    std::string bytes = sample_jpeg();
    const std::size_t table = bytes.find("\xff\xc4");
    REQUIRE(table != std::string::npos);
    for (const std::size_t length : {0u, 7u, 15u}) {
        std::string changed = bytes;
        changed[table + 5 + length] = '\xff';
        changed[table + 5 + length / 2] = '\x40';
        CHECK(contains(refused(changed), "too many codes") == (length > 0));
        // Behind the first scan, too, and after bytes that are no marker.
        CHECK(contains(refused(bytes + changed.substr(table, 40)), "too many codes") == (length > 0));
        CHECK(contains(refused(bytes.substr(0, 2) + "x" + changed.substr(table)), "too many codes") == (length > 0));
        // Found by tests/fuzz: before the first marker there may be more.
        CHECK(contains(refused("\xff\xff" + changed), "too many codes") == (length > 0));
    }
}

TEST_CASE("sizes that are claimed are looked at before memory is taken") {
    const std::string rows(100, '\0');
    CHECK(contains(refused(png_file(60000, 1000, 8, 2, rows)), "ends too early"));
    CHECK(contains(refused(png_file(65536, 1025, 8, 2, rows)), "65536 x 1025 pixels is not possible"));
    CHECK(refused(png_file(2000000, 1, 8, 2, rows)) != "no error");
    CHECK(refused(png_file(0, 1, 8, 2, rows)) != "no error");
    std::string tga = sample_tga(true);
    tga[13] = tga[15] = '\x7f';
    CHECK(refused(tga) != "no error");
    std::string bmp = sample_bmp();
    bmp[20] = bmp[24] = 1;
    CHECK(refused(bmp) != "no error");
    // 40 MB of zeros behind a picture of one pixel.
    CHECK(contains(refused(png_file(1, 1, 8, 2, std::string(40'000'000, '\0'))), "outofmem"));
}
