#pragma once

// Image files that the tests of textures read.

#include "load/files.hpp"

#include <lightswitch/film/bytes.hpp>
#include <lightswitch/film/png.hpp>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::test {

/// A 4 x 3 picture: what stands in column `x` and row `y`, from the upper left.
inline std::vector<int> sample_rgb(int x, int y) {
    const int grey = 20 * (4 * y + x);
    return {grey + 5, 255 - grey, 80 * x};
}

inline std::string big_endian(std::uint32_t value, int bytes) {
    std::string text;
    while (bytes-- > 0) text += static_cast<char>(value >> (8 * bytes));
    return text;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
    std::uint32_t sum = 0xffffffffu;
    for (const char c : type + data) {
        sum ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xedb88320u : 0u);
    }
    return big_endian(static_cast<std::uint32_t>(data.size()), 4) + type + data + big_endian(~sum, 4);
}

/// A PNG file of `rows`, each behind its filter byte. `kind` is 0 (grey), 2 (RGB), 4 (grey, alpha) or 6 (RGB, alpha).
inline std::string png_file(int width, int height, int depth, int kind, std::string rows) {
    int size = 0;
    const std::unique_ptr<unsigned char, decltype(&std::free)> packed(
        detail::stb::stbi_zlib_compress(reinterpret_cast<unsigned char*>(rows.data()), static_cast<int>(rows.size()),
                                        &size, 8),
        &std::free);
    const std::string data(reinterpret_cast<const char*>(packed.get()), static_cast<std::size_t>(size));
    const std::string header = big_endian(static_cast<std::uint32_t>(width), 4) +
                               big_endian(static_cast<std::uint32_t>(height), 4) + static_cast<char>(depth) +
                               static_cast<char>(kind) + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", data) + png_chunk("IEND", "");
}

/// The sample as PNG. With 16 bits, 77 is added to 256 times the value. Alpha is 0 in the first pixel, then 100.
inline std::string sample_png(int depth, int kind) {
    std::string rows;
    for (int y = 0; y < 3; ++y) {
        rows += '\0';
        for (int x = 0; x < 4; ++x) {
            std::vector<int> values = sample_rgb(x, y);
            if ((kind & 2) == 0) values.resize(1);
            if ((kind & 4) != 0) values.push_back(x + y == 0 ? 0 : 100);
            for (const int value : values)
                rows += big_endian(static_cast<std::uint32_t>(depth == 16 ? 256 * value + 77 : value), depth / 8);
        }
    }
    return png_file(4, 3, depth, kind, rows);
}

/// Pixels as BMP and TGA hold them: blue, green, red, from the lowest row or the highest.
inline std::string sample_bgr(bool upwards) {
    std::string bytes;
    for (int row = 0; row < 3; ++row)
        for (int x = 0; x < 4; ++x) {
            const std::vector<int> values = sample_rgb(x, upwards ? 2 - row : row);
            for (const int c : {2, 1, 0}) bytes += static_cast<char>(values[static_cast<std::size_t>(c)]);
        }
    return bytes;
}

inline std::string sample_bmp() {
    std::string file = "BM";
    for (const std::uint32_t word : {90u, 0u, 54u, 40u, 4u, 3u}) detail::put_little_endian(file, word);
    for (const std::uint16_t word : {std::uint16_t{1}, std::uint16_t{24}}) detail::put_little_endian(file, word);
    for (const std::uint32_t word : {0u, 36u, 0u, 0u, 0u, 0u}) detail::put_little_endian(file, word);
    return file + sample_bgr(true);
}

inline std::string sample_tga(bool upwards) {
    return std::string("\0\0\2\0\0\0\0\0\0\0\0\0\4\0\3\0\x18", 17) + (upwards ? '\0' : '\x20') + sample_bgr(upwards);
}

inline std::string from_hex(std::string_view hex) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return bytes;
}

/// 20 x 12 pixels, (40 + 8 x, 220 - 9 y, 60 + 3 x + 4 y) before compression; written by libjpeg, quality 90.
inline std::string sample_jpeg() {
    static constexpr std::string_view hex =
        "ffd8ffe000104a46494600010100000100010000ffdb0043000302020302020303030304030304050805050404050a070706080c0a0c0c"
        "0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ffdb00430103040405040509050509140d0b0d1414"
        "141414141414141414141414141414141414141414141414141414141414141414141414141414141414141414141414ffc0001108000c"
        "001403012200021101031101ffc4001f0000010501010101010100000000000000000102030405060708090a0bffc400b5100002010303"
        "020403050504040000017d01020300041105122131410613516107227114328191a1082342b1c11552d1f02433627282090a161718191a"
        "25262728292a3435363738393a434445464748494a535455565758595a636465666768696a737475767778797a838485868788898a9293"
        "9495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2"
        "f3f4f5f6f7f8f9faffc4001f0100030101010101010101010000000000000102030405060708090a0bffc400b511000201020404030407"
        "05040400010277000102031104052131061241510761711322328108144291a1b1c109233352f0156272d10a162434e125f11718191a26"
        "2728292a35363738393a434445464748494a535455565758595a636465666768696a737475767778797a82838485868788898a92939495"
        "969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae2e3e4e5e6e7e8e9eaf2f3f4f5f6"
        "f7f8f9faffda000c03010002110311003f00e8b46f167ddf9ff5aeeb46f167ddf9ff005af9bb46d467f97e7aeeb46d4a7f97e7af978f0d"
        "d13f3be1dc9a9fba7d116be2cfdc8f9e8af28b5d467f247cf456bfeadd1f23f6fa79353e447fffd9";
    return from_hex(hex);
}

/// 2 x 2 pixels of 16 bits, uncompressed: blue is x / 4 + y / 2, green 1 more, red 2 more.
inline std::string half_exr() {
    static constexpr std::string_view hex =
        "762f3101020000006368616e6e656c730063686c6973740037000000420001000000000000000100000001000000470001000000000000"
        "00010000000100000052000100000000000000010000000100000000636f6d7072657373696f6e00636f6d7072657373696f6e00010000"
        "00006461746157696e646f7700626f783269001000000000000000000000000100000001000000646973706c617957696e646f7700626f"
        "7832690010000000000000000000000001000000010000006c696e654f72646572006c696e654f72646572000100000000706978656c41"
        "7370656374526174696f00666c6f617400040000000000803f73637265656e57696e646f7743656e746572007632660008000000000000"
        "000000000073637265656e57696e646f77576964746800666c6f617400040000000000803f0049010000000000005d0100000000000000"
        "0000000c00000000000034003c003d00408040010000000c0000000038003a003e003f00418041";
    return from_hex(hex);
}

}  // namespace lightswitch::test
