#include "support/errors.hpp"
#include "support/folder.hpp"
#include "support/relative.hpp"

#include <lightswitch/film/image_io.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#endif

using namespace lightswitch;
using lightswitch::test::Folder;
using lightswitch::test::message_of;
using test::relative;
namespace fs = std::filesystem;

namespace {

/// A xorshift generator (Marsaglia 2003): the same cases on every machine.
struct Random {
    std::uint64_t state;
    std::size_t operator()(std::size_t below) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        return static_cast<std::size_t>(state % below);
    }
};

/// Values over 40 decades, both signs, and with `special` also what is not finite.
Image test_image(int width, int height, bool special) {
    Image image(width, height);
    Random random{42};
    for (Rgb& p : image.pixels())
        for (int c = 0; c < 3; ++c) {
            const float mantissa = static_cast<float>(random(1 << 24)) - (1 << 23);
            p[c] = std::ldexp(mantissa, static_cast<int>(random(120)) - 80);
        }
    if (special) {
        image(0, 0) = Rgb(std::numeric_limits<float>::quiet_NaN(), infinity, -infinity);
        image(width - 1, 0) = Rgb(-0.0f, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max());
        image(0, height - 1).x = std::bit_cast<float>(0xffc12345u);  // a NaN with a payload
    }
    return image;
}

bool same_bits(const Image& a, const Image& b) {
    if (a.width() != b.width() || a.height() != b.height()) return false;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (std::bit_cast<std::uint32_t>(a.pixels()[i][c]) != std::bit_cast<std::uint32_t>(b.pixels()[i][c]))
                return false;
    return true;
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

std::string bytes_of(std::string_view hex) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return bytes;
}

[[maybe_unused]] std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Decodes `count` damaged copies of `bytes`; each must give an image or an `Error`, and soon.
template <class Decode>
void check_survives_damage(const std::string& bytes, int count, std::uint64_t seed, Decode decode) {
    Random random{seed};
    int refused = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
        std::string damaged = bytes;
        for (std::size_t k = 1 + random(8); k > 0 && !damaged.empty(); --k) {
            const std::size_t at = random(random(2) == 0 ? damaged.size() : std::min<std::size_t>(damaged.size(), 300));
            switch (random(5)) {
                case 0: damaged[at] = static_cast<char>(random(256)); break;
                case 1: damaged[at] = static_cast<char>(damaged[at] ^ (1 << random(8))); break;
                case 2: damaged.resize(at); break;
                case 3: damaged.erase(at, 1 + random(16)); break;
                default: damaged.insert(at, 1 + random(4), static_cast<char>(random(256)));
            }
        }
        try {
            decode(damaged);
        } catch (const Error&) {
            ++refused;
        }
    }
    CHECK(refused > count / 2);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

// A 4 x 3 image of half floats, (x + y/4, y - 1.5, x y / 8) in column x and row y, PIZ compressed and uncompressed,
// written by OpenEXR 3.
constexpr std::string_view half_piz =
    "762f3101020000006368616e6e656c730063686c69737400370000004200010000000000000001000000010000004700010000000000"
    "0000010000000100000052000100000000000000010000000100000000636f6d7072657373696f6e00636f6d7072657373696f6e0001"
    "000000046461746157696e646f7700626f783269001000000000000000000000000300000002000000646973706c617957696e646f77"
    "00626f7832690010000000000000000000000003000000020000006c696e654f72646572006c696e654f726465720001000000007069"
    "78656c417370656374526174696f00666c6f617400040000000000803f73637265656e57696e646f7743656e74657200763266000800"
    "0000000000000000000073637265656e57696e646f77576964746800666c6f617400040000000000803f7479706500737472696e6700"
    "0d0000007363616e6c696e65696d616765005e010000000000000000000048000000000000000000000000be00be00be00be0000003c"
    "00400042000000300034003600b800b800b800b80034003d80408042000000340038003a00380038003800380038003e00410043";
constexpr std::string_view half_plain =
    "762f3101020000006368616e6e656c730063686c69737400370000004200010000000000000001000000010000004700010000000000"
    "0000010000000100000052000100000000000000010000000100000000636f6d7072657373696f6e00636f6d7072657373696f6e0001"
    "000000006461746157696e646f7700626f783269001000000000000000000000000300000002000000646973706c617957696e646f77"
    "00626f7832690010000000000000000000000003000000020000006c696e654f72646572006c696e654f726465720001000000007069"
    "78656c417370656374526174696f00666c6f617400040000000000803f73637265656e57696e646f7743656e74657200763266000800"
    "0000000000000000000073637265656e57696e646f77576964746800666c6f617400040000000000803f7479706500737472696e6700"
    "0d0000007363616e6c696e65696d616765006e010000000000008e01000000000000ae01000000000000000000001800000000000000"
    "0000000000be00be00be00be0000003c004000420100000018000000000000300034003600b800b800b800b80034003d804080420200"
    "000018000000000000340038003a00380038003800380038003e00410043";

}  // namespace

TEST_CASE("tone mapping: the sRGB curve, exposure, clamping and NaN") {
    // IEC 61966-2-1.
    CHECK(srgb_encode(0) == 0);
    CHECK(srgb_encode(1) == relative(1, 1e-6));
    CHECK(srgb_encode(0.18f) == relative(0.4613561, 1e-6));
    CHECK(srgb_encode(0.5f) == relative(0.7353570, 1e-6));
    CHECK(srgb_encode(0.001f) == relative(0.01292, 1e-6));
    for (int value = 0; value < 256; ++value) {
        const auto bytes = to_srgb8(srgb(value, 255 - value, 7));
        CHECK(int{bytes[0]} == value);
        CHECK(int{bytes[1]} == 255 - value);
        CHECK(int{bytes[2]} == 7);
    }
    CHECK(expose(Rgb(0.25f, -3, 9), 1) == Rgb(0.5f, 0, 1));
    CHECK(expose(Rgb(infinity, -infinity, 0), -100) == Rgb(1, 0, 0));
    CHECK(expose(Rgb(0, std::numeric_limits<float>::quiet_NaN(), 0), 3) == Rgb(1, 0, 1));

    Image image(2, 1);
    image(0, 0) = Rgb(0.18f, 0, 1);
    image(1, 0) = Rgb(std::numeric_limits<float>::quiet_NaN());
    CHECK(tone_map(image, 0) == std::string("\x76\x00\xff\xff\x00\xff", 6));
}

TEST_CASE("pfm: bit-exact, bottom row first") {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {300, 2}}) {
        const Image image = test_image(width, height, true);
        CHECK(same_bits(detail::decode_pfm(detail::encode_pfm(image), "x.pfm"), image));
    }
    Image image(1, 2);
    image(0, 0) = Rgb(1);
    image(0, 1) = Rgb(2, -1, 0.5f);
    CHECK(detail::encode_pfm(image) == bytes_of("50460a3120320a2d312e300a"
                                                "00000040000080bf0000003f"
                                                "0000803f0000803f0000803f"));
}

TEST_CASE("pfm: big endian, grey, scaled") {
    const Image big = detail::decode_pfm("PF\n1 1\n1.0\n" + bytes_of("3f8000004000000040400000"), "x.pfm");
    CHECK(big(0, 0) == Rgb(1, 2, 3));
    const Image grey = detail::decode_pfm("Pf 2 1 -2.5 " + bytes_of("0000803f00000040"), "x.pfm");
    CHECK(grey(0, 0) == Rgb(2.5f));
    CHECK(grey(1, 0) == Rgb(5));
}

TEST_CASE("pfm: refuses what is malformed, without taking memory for it") {
    const auto refusal = [](const std::string& bytes) {
        return message_of([&] { detail::decode_pfm(bytes, "broken.pfm"); });
    };
    const std::string pixels(12, '\0');
    CHECK(refusal("PF\n1 1\n-1.0\n" + pixels) == "(no error)");
    CHECK(contains(refusal(""), "broken.pfm: is not a float map"));
    CHECK(contains(refusal("P6\n1 1\n255\n"), "is not a float map"));
    CHECK(contains(refusal("PF\n1000000000 1000000000\n-1.0\n" + pixels), "1000000000 x 1000000000"));
    CHECK(contains(refusal("PF\n65536 65536\n-1.0\n" + pixels), "not possible"));
    CHECK(contains(refusal("PF\n8192 8192\n-1.0\n" + pixels), "holds 12 bytes"));
    CHECK(contains(refusal("PF\n-1 1\n-1.0\n" + pixels), "not possible"));
    CHECK(contains(refusal("PF\n99999999999999999999 1\n-1.0\n" + pixels), "no valid width"));
    CHECK(contains(refusal("PF\n1 x\n-1.0\n" + pixels), "no valid height"));
    CHECK(contains(refusal("PF\n1 1\nnan\n" + pixels), "scale"));
    CHECK(contains(refusal("PF\n1 1\n0\n" + pixels), "scale"));
    CHECK(contains(refusal("PF\n1 1\n-1.0\n" + pixels + "x"), "holds 13 bytes"));
    CHECK(contains(refusal("PF\n" + std::string(1000, '1')), "no valid width"));
    const std::string whole = detail::encode_pfm(test_image(3, 2, true));
    for (std::size_t n = 0; n < whole.size(); ++n) CHECK(refusal(whole.substr(0, n)) != "(no error)");
}

TEST_CASE("rgbe: rounds to the nearest value of its precision") {
    CHECK(detail::to_rgbe(Rgb(1, 0.5f, 0)) == detail::Rgbe{128, 64, 0, 129});
    CHECK(detail::to_rgbe(Rgb(255.6f, 0, 0)) == detail::Rgbe{128, 0, 0, 137});  // rounds up into the next exponent
    CHECK(detail::to_rgbe(Rgb(-1, std::numeric_limits<float>::quiet_NaN(), 1)) == detail::Rgbe{0, 0, 128, 129});
    CHECK(detail::to_rgbe(Rgb(infinity, 0, -infinity)) == detail::Rgbe{255, 0, 0, 255});
    CHECK(detail::to_rgbe(Rgb(std::numeric_limits<float>::max())) == detail::Rgbe{255, 255, 255, 255});
    CHECK(detail::to_rgbe(Rgb(1e-40f)) == detail::Rgbe{0, 0, 0, 0});
    const Image image = test_image(64, 64, false);
    for (const Rgb& p : image.pixels()) {
        const Rgb positive = glm::abs(p);
        const Rgb back = detail::from_rgbe(detail::to_rgbe(positive));
        // The largest channel has a mantissa of at least 128, so half a step is at most 1/256 of it.
        for (int c = 0; c < 3; ++c) CHECK(std::abs(back[c] - positive[c]) <= max_component(positive) / 256);
    }
}

TEST_CASE("hdr: what was written reads back within RGBE precision, at every width and with long runs") {
    for (const int width : {1, 7, 8, 9, 127, 128, 129, 600}) {
        Image image = test_image(width, 3, false);
        for (int x = 0; x < width; ++x) image(x, 1) = x < width / 2 ? Rgb(0.5f) : Rgb(static_cast<float>(x / 5));
        image.metadata = {{"method", "path tracer"}, {"note", "a=b\nc"}};
        const Image back = detail::decode_rgbe(detail::encode_rgbe(image), "x.hdr");
        REQUIRE(back.width() == width);
        REQUIRE(back.height() == 3);
        int wrong = 0;
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            wrong += back.pixels()[i] != detail::from_rgbe(detail::to_rgbe(image.pixels()[i]));
        CHECK(wrong == 0);
        CHECK(back.metadata == Image::Metadata{{"method", "path tracer"}, {"note", "a=b c"}});
    }
}

TEST_CASE("hdr: flat rows, repeated pixels and EXPOSURE") {
    const std::string header = "#?RGBE\nEXPOSURE=2\nEXPOSURE=0.25\nFORMAT=32-bit_rle_rgbe\n\n";
    const Image flat = detail::decode_rgbe(header + "-Y 1 +X 2\n" +
                                               bytes_of("80402081"
                                                        "40404081"),
                                           "x.hdr");
    CHECK(flat(0, 0) == Rgb(2, 1, 0.5f));
    CHECK(flat(1, 0) == Rgb(1));
    // 1 + 2 + 1 * 256 pixels of (128, 0, 0, 129)
    const std::string runs = bytes_of(
        "80000081"
        "01010102"
        "01010101");
    const Image old = detail::decode_rgbe(header + "-Y 1 +X 259\n" + runs, "x.hdr");
    CHECK(old(0, 0) == Rgb(2, 0, 0));
    CHECK(old(258, 0) == Rgb(2, 0, 0));
}

TEST_CASE("hdr: refuses what is malformed, without taking memory for it") {
    const auto refusal = [](const std::string& bytes) {
        return message_of([&] { detail::decode_rgbe(bytes, "broken.hdr"); });
    };
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    CHECK(refusal(head + "-Y 1 +X 1\n" + bytes_of("80808081")) == "(no error)");
    CHECK(contains(refusal("GIF89a"), "is not a Radiance picture"));
    CHECK(contains(refusal("#?RADIANCE\n"), "ends too early"));
    CHECK(contains(refusal("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n"), "another format"));
    CHECK(contains(refusal("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n"), "EXPOSURE"));
    CHECK(contains(refusal(head + "+Y 1 +X 1\n"), "orientations"));
    CHECK(contains(refusal(head + "-Y 1000000000 +X 1000000000\n"), "not possible"));
    CHECK(contains(refusal(head + "-Y -5 +X 5\n"), "not possible"));
    CHECK(contains(refusal(head + "-Y 8192 +X 8192\n" + std::string(4000, '\1')), "ends too early"));
    CHECK(contains(refusal(head + "-Y 1 +X 8\n" + bytes_of("02020009")), "length is not the width"));
    CHECK(contains(refusal(head + "-Y 1 +X 8\n" +
                           bytes_of("02020008"
                                    "8901")),
                   "damaged run"));
    CHECK(contains(refusal(head + "-Y 1 +X 8\n" +
                           bytes_of("02020008"
                                    "0001")),
                   "damaged run"));
    CHECK(contains(refusal(head + "-Y 1 +X 8\n" + bytes_of("01010105")), "damaged run"));  // repeats no pixel
    const std::string whole = detail::encode_rgbe(test_image(20, 2, false));
    for (std::size_t n = 0; n < whole.size(); ++n) CHECK(refusal(whole.substr(0, n)) != "(no error)");
}

#if LIGHTSWITCH_HAS_EXR

TEST_CASE("exr: bit-exact, with metadata") {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {65, 40}}) {
        Image image = test_image(width, height, true);
        image.metadata = {{"scene", "room.xml"}, {"empty", ""}, {std::string(80, 'k'), "long\nand \xc3\xa4"}};
        const Image back = detail::decode_exr(detail::encode_exr(image, "x.exr"), "x.exr");
        CHECK(same_bits(back, image));
        CHECK(back.metadata == image.metadata);
    }
    Image image(1, 1);
    image.metadata = {{std::string(300, 'k'), ""}};
    CHECK(contains(message_of([&] { detail::encode_exr(image, "x.exr"); }), "x.exr: the metadata key 'kkk"));
}

TEST_CASE("exr: 16-bit files of another writer, and rows stored from the bottom") {
    const std::string plain = bytes_of(half_plain);
    std::string upwards = plain;  // the three entries of its table in the other order
    const std::size_t table = plain.size() - 3 * (8 + 24) - 3 * 8;
    std::swap_ranges(upwards.begin() + static_cast<std::ptrdiff_t>(table),
                     upwards.begin() + static_cast<std::ptrdiff_t>(table + 8),
                     upwards.begin() + static_cast<std::ptrdiff_t>(table + 16));
    REQUIRE(upwards != plain);
    for (const std::string& bytes : {bytes_of(half_piz), plain, upwards}) {
        const Image image = detail::decode_exr(bytes, "x.exr");
        REQUIRE(image.width() == 4);
        REQUIRE(image.height() == 3);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x) {
                const auto column = static_cast<float>(x), row = static_cast<float>(y);
                CHECK(image(x, y) == Rgb(column + row / 4, row - 1.5f, 0.125f * column * row));
            }
    }
}

TEST_CASE("exr: refuses what is malformed or not an RGB image") {
    const auto refusal = [](const std::string& bytes) {
        return message_of([&] { detail::decode_exr(bytes, "broken.exr"); });
    };
    const std::string plain = bytes_of(half_plain), piz = bytes_of(half_piz);
    const auto window = [&](std::string_view box) {
        const std::string name("box2i\0\x10\0\0\0", 10);
        return refusal(replaced(plain, name + bytes_of("00000000000000000300000002000000"), name + bytes_of(box)));
    };
    CHECK(contains(refusal(""), "broken.exr: is not an OpenEXR file"));
    CHECK(contains(refusal(replaced(plain, bytes_of("0200000063"), bytes_of("0202000063"))), "tiled"));
    CHECK(contains(refusal(replaced(plain, bytes_of("0200000063"), bytes_of("0210000063"))), "multi-part"));
    CHECK(contains(refusal(replaced(plain, std::string("R\0\1", 3), std::string("Q\0\1", 3))), "(it has: B, G, Q)"));
    CHECK(contains(refusal(replaced(plain, std::string("R\0\1", 3), std::string("R\0\0", 3))), "integer"));
    CHECK(contains(refusal(replaced(plain, std::string("compression\0\1\0\0\0\0", 17),
                                    std::string("compression\0\1\0\0\0\x8", 17))),
                   "DWAA"));
    CHECK(contains(window("0000000000000000ffc99a3bffc99a3b"), "1000000000 x 1000000000"));
    CHECK(contains(window("000000000000000000000080ffffff7f"), "not possible"));
    CHECK(contains(window("0000000000000000ff1f0000ff1f0000"), "broken.exr: "));  // 8192 x 8192 in 462 bytes
    // 1 x 512 pixels declared to be 65536 x 512: every piece is there, but none can hold 12 MB.
    std::string wide = detail::encode_exr(Image(1, 512), "x.exr");
    for (int k = 0; k < 2; ++k)  // data window and display window
        wide = replaced(wide,
                        bytes_of("0000000000000000"
                                 "00000000ff010000"),
                        bytes_of("0000000000000000"
                                 "ffff0000ff010000"));
    CHECK(contains(refusal(wide), "a piece of the image has an impossible size"));
    for (const std::string& whole : {plain, piz})
        for (std::size_t n = 0; n < whole.size(); ++n) CHECK(refusal(whole.substr(0, n)) != "(no error)");
}

TEST_CASE("exr: damaged files give an image or an error") {
    const auto decode = [](const std::string& bytes) { detail::decode_exr(bytes, "x.exr"); };
    Image image = test_image(24, 40, false);
    image.metadata = {{"scene", "room.xml"}};
    check_survives_damage(detail::encode_exr(image, "x.exr"), 1000, 1, decode);
    check_survives_damage(bytes_of(half_piz), 1000, 2, decode);
    check_survives_damage(bytes_of(half_plain), 1000, 3, decode);
}

TEST_CASE("exr: layers, beside the image") {
    const Folder scratch;
    const fs::path path = scratch.path() / "a.exr";
    Image image = test_image(9, 20, true);
    image.metadata = {{"scene", "room.xml"}};
    Image other(9, 20), third(9, 20);
    for (std::size_t i = 0; i < other.pixels().size(); ++i) {
        other.pixels()[i] = Rgb(static_cast<float>(i), -0.1f, 1e30f);
        third.pixels()[i] = Rgb(0.3f * static_cast<float>(i), 7, 8);
    }
    const std::string longest(200, 'n');
    const std::vector<Layer> layers{
        {"normal", "XYZ", other}, {"Albedo", "RGB", third}, {"depth", "Z", third}, {longest, "I", other}};
    save_layers(path, image, layers);
    const Image back = load_image(path);
    CHECK(same_bits(back, image));
    CHECK(back.metadata == image.metadata);
    CHECK(same_bits(load_layer(path, "normal"), other));
    CHECK(same_bits(load_layer(path, "Albedo"), third));
    for (Rgb& p : third.pixels()) p = Rgb(p.x);
    CHECK(same_bits(load_layer(path, "depth"), third));
    for (Rgb& p : other.pixels()) p = Rgb(p.x);
    CHECK(same_bits(load_layer(path, longest), other));
    // Without layers it is the file that `save` writes.
    save_layers(path, image, {});
    CHECK(read_file(path, 1 << 20) == detail::encode_exr(image, "x.exr"));
}

TEST_CASE("exr: layers that do not fit, and files that have none") {
    const Folder scratch;
    const Image image(4, 3);
    const auto refusal = [&](const std::vector<Layer>& layers) {
        return message_of([&] { save_layers(scratch.path() / "a.exr", image, layers); });
    };
    CHECK(contains(refusal({{"", "RGB", image}}), "a.exr: the layer '' needs another name"));
    CHECK(contains(refusal({{std::string(201, 'n'), "I", image}}), "needs another name"));
    CHECK(contains(refusal({{"depth", "", image}}), "the layer 'depth' must have one to three channels"));
    CHECK(contains(refusal({{"depth", "RGBA", image}}), "one to three channels"));
    CHECK(contains(refusal({{"depth", "Z", Image(3, 4)}}), "the layer 'depth' has not the size of the image"));
    CHECK(contains(refusal({{"a", "Z", image}, {"a", "YZ", image}}), "the channel a.Z twice"));
    CHECK(scratch.files().size() == 0);
    save(scratch.path() / "b.exr", image);
    CHECK(contains(message_of([&] { load_layer(scratch.path() / "b.exr", "depth"); }),
                   "b.exr: has no layer 'depth' (it has: B, G, R)"));
    CHECK(contains(message_of([&] { load_layer(scratch.path() / "b.exr", ""); }), "has no name"));
}

#else

TEST_CASE("exr: a build without it says so before the work begins") {
    const Folder scratch;
    const fs::path path = scratch.path() / "a.exr";
    CHECK(contains(message_of([&] { check_writable(path); }), "a.exr: this program was built without OpenEXR"));
    CHECK(contains(message_of([&] { save(path, Image(1, 1)); }), "built without OpenEXR"));
    CHECK(scratch.files().size() == 0);
}

#endif

TEST_CASE("pfm and hdr: damaged files give an image or an error") {
    check_survives_damage(detail::encode_pfm(test_image(5, 4, true)), 1000, 4,
                          [](const std::string& bytes) { detail::decode_pfm(bytes, "x.pfm"); });
    check_survives_damage(detail::encode_rgbe(test_image(20, 4, false)), 1000, 5,
                          [](const std::string& bytes) { detail::decode_rgbe(bytes, "x.hdr"); });
}

TEST_CASE("layers are for .exr files alone") {
    const Folder scratch;
    const Image image(2, 2);
    CHECK(can_hold_layers("a.EXR"));
    CHECK_FALSE(can_hold_layers("a.pfm"));
    CHECK(
        contains(message_of([&] { save_layers(scratch.path() / "a.pfm", image, {}); }), "only .exr files hold layers"));
    CHECK(contains(message_of([&] { load_layer(scratch.path() / "a.pfm", "depth"); }), "only .exr files hold layers"));
    CHECK(scratch.files().size() == 0);
}

TEST_CASE("image files: the extension chooses the format, in either case") {
    const Folder scratch;
    const Image image = test_image(9, 4, true);
    save(scratch.path() / "a.PFM", image);
    CHECK(same_bits(load_image(scratch.path() / "a.PFM"), image));
    save(scratch.path() / "a.Hdr", image);
    CHECK(load_image(scratch.path() / "a.Hdr").width() == 9);
    save(scratch.path() / "a.png", image, {.exposure = -1});
    CHECK(read_file(scratch.path() / "a.png", 10000).starts_with("\x89PNG\r\n\x1a\n"));
    CHECK(scratch.files().size() == 3);
    CHECK(contains(message_of([&] { load_image(scratch.path() / "a.png"); }), "PNG is not read"));
    CHECK(contains(message_of([&] { save(scratch.path() / "a.tif", image); }),
                   "a.tif: has the extension '.tif'; an image is one of .exr, .hdr, .pfm, .png"));
    CHECK(contains(message_of([&] { save(scratch.path() / "a", image); }), "a: has no extension"));
    CHECK(contains(message_of([&] { save(scratch.path() / "b.png", Image()); }), "without pixels"));
    CHECK(contains(message_of([&] { save(scratch.path() / "b.png", image, {.exposure = infinity}); }), "exposure"));
    CHECK(contains(message_of([&] { load_image(scratch.path() / "c.pfm"); }), "c.pfm: no such file"));
    CHECK(scratch.files().size() == 3);
}

TEST_CASE("image files: a path that cannot be written is refused beforehand, and nothing is left behind") {
    const Folder scratch;
    fs::create_directory(scratch.path() / "dir.pfm");
    write_file_atomically(scratch.path() / "file", "text");
    const auto check = [&](const fs::path& path, std::string_view part) {
        CAPTURE(path);
        CHECK(contains(message_of([&] { check_writable(path); }), part));
        CHECK(contains(message_of([&] { save(path, Image(1, 1)); }), part));
    };
    check(scratch.path() / "missing" / "a.pfm", "does not exist; create it first");
    check(scratch.path() / "file" / "a.pfm", "is not a directory");
    check(scratch.path() / "dir.pfm", "is a directory; name a file in it");
    check(scratch.path() / "a.jpg", ".exr, .hdr, .pfm, .png");
    CHECK(contains(message_of([&] { check_file_writable(scratch.path() / ""); }), "names no file"));
    CHECK(message_of([&] { check_writable(scratch.path() / "a.pfm"); }) == "(no error)");
    CHECK(contains(message_of([&] { load_image(scratch.path() / "dir.pfm"); }), "is a directory, not a file"));
    CHECK(scratch.files().size() == 2);
}

TEST_CASE("atomic files: replaced as a whole, through links, with names of every length") {
    const Folder scratch;
    const fs::path path = scratch.path() / "a.json";
    write_file_atomically(path, "first, and longer");
    write_file_atomically(path, std::string_view("sec\0nd", 6));
    CHECK(read_file(path, 100) == std::string("sec\0nd", 6));
    CHECK(contains(message_of([&] { read_file(path, 5); }), "has 6 bytes; at most 5 are read"));
    write_file_atomically(scratch.path() / std::string(255, 'n'), "");
    CHECK(read_file(scratch.path() / std::string(255, 'n'), 0).empty());
    fs::create_symlink(path, scratch.path() / "link");
    write_file_atomically(scratch.path() / "link", "third");
    CHECK(fs::is_symlink(scratch.path() / "link"));
    CHECK(read_file(path, 100) == "third");
    CHECK(scratch.files().size() == 3);
    fs::create_symlink("new", scratch.path() / "to new");  // a link to what is not there yet
    write_file_atomically(scratch.path() / "to new", "fourth");
    CHECK(fs::is_symlink(scratch.path() / "to new"));
    CHECK(read_file(scratch.path() / "new", 100) == "fourth");
    fs::create_symlink("loop", scratch.path() / "loop");
    check_file_writable(scratch.path() / "loop");
}

TEST_CASE("two names of one file are told from two files, before and after it is written") {
    const Folder scratch;
    const fs::path a = scratch.path() / "a", b = scratch.path() / "b";
    fs::create_directory(scratch.path() / "folder");
    fs::create_directory_symlink("folder", scratch.path() / "other name");
    fs::create_symlink("a", scratch.path() / "link");
    fs::create_symlink(scratch.path() / "link", scratch.path() / "link to link");
    const auto check_all = [&] {
        CHECK(same_file(a, a));
        CHECK(same_file(a, scratch.path() / "folder" / ".." / "." / "a"));
        CHECK(same_file(a, fs::relative(a)));
        CHECK(same_file(a, scratch.path() / "link"));
        CHECK(same_file(scratch.path() / "link to link", a));
        CHECK(same_file(scratch.path() / "folder" / "a", scratch.path() / "other name" / "a"));
        CHECK_FALSE(same_file(a, b));
        CHECK_FALSE(same_file(a, scratch.path() / "folder" / "a"));
        CHECK_FALSE(same_file(b, scratch.path() / "link"));
    };
    check_all();
    write_file_atomically(a, "");
    check_all();
    CHECK_FALSE(same_file(a, scratch.path() / "hard"));
    fs::create_hard_link(a, scratch.path() / "hard");
    CHECK(same_file(a, scratch.path() / "hard"));
    write_file_atomically(b, "");
    write_file_atomically(scratch.path() / "folder" / "a", "");
    check_all();
}

#if defined(__unix__) || defined(__APPLE__)

TEST_CASE("atomic files: a write that fails leaves the old file and no other") {
    const Folder scratch;
    const fs::path path = scratch.path() / "a.pfm";
    save(path, Image(2, 2));
    // A file size limit stands in for a full disk: both show as a failed write.
    rlimit old_limit{};
    getrlimit(RLIMIT_FSIZE, &old_limit);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, old_limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string replacing = message_of([&] { save(path, Image(100, 100)); });
    const std::string creating = message_of([&] { save(scratch.path() / "b.pfm", Image(100, 100)); });
    setrlimit(RLIMIT_FSIZE, &old_limit);
    std::signal(SIGXFSZ, old_handler);
    CHECK(contains(replacing, "a.pfm: writing failed, nothing is left behind: "));
    CHECK(contains(creating, "b.pfm: writing failed"));
    CHECK(scratch.files().size() == 1);
    CHECK(load_image(path).width() == 2);
}

TEST_CASE("atomic files: no permission") {
    if (geteuid() == 0) return;  // permissions do not bind root
    const Folder scratch;
    const fs::path path = scratch.path() / "a.pfm";
    save(path, Image(2, 2));
    fs::permissions(path, fs::perms::owner_read);
    CHECK(contains(message_of([&] { check_writable(path); }), "exists and may not be written"));
    fs::permissions(scratch.path(), fs::perms::owner_read | fs::perms::owner_exec);
    CHECK(contains(message_of([&] { check_writable(scratch.path() / "b.pfm"); }), "cannot create a file"));
    fs::permissions(scratch.path(), fs::perms::owner_all);
}

TEST_CASE("image files: headers that promise much take neither time nor memory") {
    const auto peak = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
#if defined(__APPLE__)
        return usage.ru_maxrss / 1024;
#else
        return usage.ru_maxrss;
#endif
    };
    const auto start = std::chrono::steady_clock::now();
    const long before = peak();
    CHECK_THROWS_AS(detail::decode_pfm("PF\n8192 8192\n-1\n" + std::string(999, ' '), "x"), Error);
    CHECK_THROWS_AS(detail::decode_rgbe("#?RGBE\n\n-Y 8192 +X 8192\n" + std::string(9999, '\2'), "x"), Error);
#if LIGHTSWITCH_HAS_EXR
    const std::string_view size = "0300000002000000";  // of both windows, minus 1
    std::string huge(half_plain);
    for (std::size_t at; (at = huge.find(size)) != std::string::npos;) huge.replace(at, 16, "ff1f0000ff1f0000");
    CHECK_THROWS_AS(detail::decode_exr(bytes_of(huge), "x"), Error);
#endif
    CHECK(peak() - before < 50 * 1024);  // kB; an image of that size has 800 MB
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
}

#endif
