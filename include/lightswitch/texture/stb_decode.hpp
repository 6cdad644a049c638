#pragma once

// PNG, JPEG, BMP and TGA as bitmaps. Decoded by stb_image, after checks of what it takes on trust.

#include <lightswitch/film/bytes.hpp>
#include <lightswitch/film/tonemap.hpp>
#include <lightswitch/texture/bitmap.hpp>
#include <lightswitch/texture/half.hpp>
#include <lightswitch/texture/stb_image.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightswitch::detail {

/// Hands bytes to stb_image and knows when it asks for more than there are, which it takes for zeros.
struct StbSource {
    std::string_view bytes;
    std::size_t position = 0;
    bool exhausted = false;

    static stb_read::stbi_io_callbacks callbacks() {
        stb_read::stbi_io_callbacks result{};
        result.read = [](void* source, char* to, int size) {
            auto& self = *static_cast<StbSource*>(source);
            const std::size_t n = std::min(static_cast<std::size_t>(size), self.bytes.size() - self.position);
            std::copy_n(self.bytes.data() + self.position, n, to);
            self.position += n;
            self.exhausted = self.exhausted || n == 0;
            return static_cast<int>(n);
        };
        result.skip = [](void* source, int size) {
            auto& self = *static_cast<StbSource*>(source);
            const std::size_t rest = self.bytes.size() - self.position;
            self.position += std::min(static_cast<std::size_t>(std::max(size, 0)), rest);
        };
        result.eof = [](void* source) {
            const auto& self = *static_cast<StbSource*>(source);
            return self.position == self.bytes.size() ? 1 : 0;
        };
        return result;
    }
};

/// Throws unless the chunks of a PNG file are whole and their checksums right, which stb_image does not look at.
inline void check_png(std::string_view bytes, const std::string& file) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> remainders{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            remainders[i] = i;
            for (int bit = 0; bit < 8; ++bit)
                remainders[i] = (remainders[i] >> 1) ^ ((remainders[i] & 1) != 0 ? 0xedb88320u : 0u);
        }
        return remainders;
    }();
    ByteReader reader(bytes, file);
    const auto big_endian = [&] {
        std::uint32_t value = 0;
        for (const char c : reader.take(4)) value = value << 8 | static_cast<unsigned char>(c);
        return value;
    };
    reader.take(8);
    for (std::string_view type; type != "IEND";) {
        const std::size_t length = big_endian();
        const std::string_view chunk = reader.take(4 + length);
        type = chunk.substr(0, 4);
        std::uint32_t sum = 0xffffffffu;
        for (const char c : chunk) sum = table[(sum ^ static_cast<unsigned char>(c)) & 0xff] ^ (sum >> 8);
        if (big_endian() != ~sum) fail(reader.where(), "is a damaged PNG file: a checksum is wrong");
    }
}

/// Throws when the code table of a JPEG file behind its marker has more codes than bytes have values: before
/// version 2.28 stb_image writes them past the end of an array.
inline void check_jpeg_codes(ByteReader reader) {
    const auto byte = [&] { return static_cast<int>(reader.number<std::uint8_t>()); };
    int rest = byte() * 256;
    rest += byte() - 2;
    while (rest > 0) {
        byte();
        int codes = 0;
        for (int length = 0; length < 16; ++length) codes += byte();
        if (codes > 256) fail(reader.where(), "is a damaged JPEG file: a table has too many codes");
        rest -= 17 + codes;
        if (rest >= 0) reader.take(static_cast<std::size_t>(codes));
    }
}

/// Throws unless all tables of codes in a JPEG file are possible. Markers are followed up to the first scan, or the
/// first byte that is none; from there on every marker of a table counts: the decoder may look for them anywhere.
inline void check_jpeg(std::string_view bytes, const std::string& file) {
    constexpr unsigned char codes = 0xc4, scan = 0xda;
    ByteReader reader(bytes, file);
    reader.take(2);
    for (unsigned char marker = 0; marker != scan && reader.number<std::uint8_t>() == 0xff;) {
        do marker = reader.number<std::uint8_t>();
        while (marker == 0xff);
        if (marker == codes) check_jpeg_codes(reader);
        const std::size_t high = reader.number<std::uint8_t>();
        const std::size_t length = high << 8 | reader.number<std::uint8_t>();
        reader.take(length - std::min<std::size_t>(length, 2));
    }
    constexpr std::string_view table("\xff\xc4");
    for (std::size_t at = reader.position(); (at = bytes.find(table, at)) != std::string_view::npos;) {
        at += table.size();
        reader.seek(at);
        check_jpeg_codes(reader);
    }
}

/// Throws when an uncompressed TGA file is shorter than it says, which stb_image does not find out.
inline void check_tga(std::string_view bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    const std::string_view header = reader.take(18);
    const auto at = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(header[i])); };
    const auto pair_at = [&](std::size_t i) { return at(i) | at(i + 1) << 8; };
    if (at(2) > 3) return;
    reader.take(at(0));
    if (at(1) != 0) reader.take(pair_at(3) + pair_at(5) * ((at(7) + 7) / 8));
    reader.take(pair_at(12) * pair_at(14) * ((at(16) + 7) / 8));
}

/// What of an image file becomes a bitmap: its colours, or one channel. Of grey ones all three colours are the same,
/// and where there is no alpha it is 1 everywhere.
enum class ImageChannels { color, red, green, blue, alpha };

/// The texels of a file, of its colours without alpha unless another part is asked for. 16 bits become `Half` here,
/// decoded unless they are linear.
///
/// Takes memory in proportion to the file: a size that so few bytes cannot fill is refused before any is taken, and no
/// block exceeds 16 bytes per texel by much.
inline Bitmap decode_stb(std::string_view bytes, const std::string& file, TexelEncoding encoding, TextureLookup lookup,
                         ImageChannels part = ImageChannels::color) {
    const Origin where = file_origin(file);
    const stb_read::stbi_io_callbacks callbacks = StbSource::callbacks();
    const auto refuse = [&](const StbSource& source) {
        const char* reason = stb_read::lightswitch_stbi_failure_reason();
        if (source.exhausted) ByteReader(bytes, file).truncated();
        fail(where, std::string("is damaged, or no image that is read (PNG, JPEG, BMP, TGA, EXR, HDR, PFM): ") +
                        (reason ? reason : "unknown error"));
    };
    const bool png = bytes.starts_with("\x89PNG\r\n\x1a\n");
    // Its first marker may be filled up in front.
    const std::size_t filled = std::min(bytes.find_first_not_of('\xff'), bytes.size());
    const bool jpeg = filled > 0 && bytes.substr(filled).starts_with('\xd8');
    if (png) check_png(bytes, file);
    if (jpeg) check_jpeg(bytes.substr(filled - 1), file);

    stb_largest_block = 1 << 16;  // the header takes no more
    int width = 0, height = 0, channels = 0;
    StbSource header{bytes};
    if (!stb_read::lightswitch_stbi_info_from_callbacks(&callbacks, &header, &width, &height, &channels))
        refuse(header);
    check_size(where, width, height);
    // A byte of deflated data gives at most 1032 bytes, each of 8 texels; other formats are less dense.
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) / (1032 * 8) > bytes.size())
        ByteReader(bytes, file).truncated();
    if (!png && !jpeg && !bytes.starts_with("BM")) check_tga(bytes, file);
    // Twice the largest texel, and what JPEG adds to fill its blocks.
    stb_largest_block =
        16 * (static_cast<std::size_t>(width) + 64) * (static_cast<std::size_t>(height) + 64) + (1 << 16);

    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    // Called after decoding, which may find alpha that the header did not tell of.
    const auto taken_from = [&](const auto* values, const auto& convert) {
        using Value = std::remove_cvref_t<decltype(*values)>;
        const auto stored = static_cast<std::size_t>(channels), colors = std::size_t{stored < 3 ? 1u : 3u};
        std::size_t first = 0, taken = 1;
        if (part == ImageChannels::color) taken = colors;
        else if (part == ImageChannels::alpha) first = colors;
        else if (colors == 3) first = static_cast<std::size_t>(part) - static_cast<std::size_t>(ImageChannels::red);
        if (first == stored) return std::vector(count, convert(std::numeric_limits<Value>::max()));  // opaque
        std::vector<decltype(convert(*values))> result(count * taken);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < taken; ++c) result[i * taken + c] = convert(values[i * stored + first + c]);
        return result;
    };
    StbSource test{bytes}, source{bytes};
    if (stb_read::lightswitch_stbi_is_16_bit_from_callbacks(&callbacks, &test)) {
        const std::unique_ptr<stb_read::stbi_us, decltype(&std::free)> values(
            stb_read::lightswitch_stbi_load_16_from_callbacks(&callbacks, &source, &width, &height, &channels, 0),
            &std::free);
        if (!values || source.exhausted) refuse(source);
        std::vector<Half> table(65536);
        for (std::size_t i = 0; i < table.size(); ++i) {
            const float value = static_cast<float>(i) / 65535;
            table[i] = Half(encoding == TexelEncoding::srgb ? srgb_decode(value) : value);
        }
        return Bitmap(width, height, taken_from(values.get(), [&](std::uint16_t value) { return table[value]; }),
                      TexelEncoding::linear, lookup);
    }
    const std::unique_ptr<stb_read::stbi_uc, decltype(&std::free)> values(
        stb_read::lightswitch_stbi_load_from_callbacks(&callbacks, &source, &width, &height, &channels, 0), &std::free);
    if (!values || source.exhausted) refuse(source);
    return Bitmap(width, height, taken_from(values.get(), [](std::uint8_t value) { return value; }), encoding, lookup);
}

}  // namespace lightswitch::detail
