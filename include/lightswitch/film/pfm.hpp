#pragma once

// Portable float maps: 32-bit floats behind a three-line header (Debevec, "PFM Portable FloatMap Image Format").

#include <lightswitch/film/bytes.hpp>

#include <bit>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

namespace lightswitch::detail {

/// The image as an RGB float map, little endian, bottom row first. Bit-exact; carries no metadata.
inline std::string encode_pfm(const Image& image) {
    std::string out = "PF\n" + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
    out.reserve(out.size() + image.pixels().size() * 12);
    for (int y = image.height() - 1; y >= 0; --y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) put_little_endian(out, std::bit_cast<std::uint32_t>(image(x, y)[c]));
    return out;
}

inline bool pfm_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Reads the number that the next blank ends; the blank is skipped.
template <class T>
T pfm_number(ByteReader& reader, const char* what) {
    std::string token;
    while (token.size() <= 40) {
        const char c = reader.take(1)[0];
        if (!pfm_blank(c)) token += c;
        else if (!token.empty()) break;
    }
    T value{};
    std::istringstream text(token);
    text.imbue(std::locale::classic());
    if (!(text >> value) || text.peek() != std::istringstream::traits_type::eof())
        fail(reader.where(), std::string("the header of this float map has no valid ") + what);
    return value;
}

/// Reads colour (PF) and grey (Pf) maps of either byte order. The magnitude of the scale multiplies the values;
/// values that are not finite are kept. Throws `Error` unless the file holds exactly the pixels that it announces.
inline Image decode_pfm(std::string_view bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    const std::string_view magic = bytes.substr(0, 3);
    if (magic.size() < 3 || magic[0] != 'P' || (magic[1] != 'F' && magic[1] != 'f') || !pfm_blank(magic[2]))
        fail(reader.where(), "is not a float map: it does not begin with 'PF' or 'Pf'");
    const int channels = magic[1] == 'F' ? 3 : 1;
    reader.take(3);
    const auto width = pfm_number<long long>(reader, "width");
    const auto height = pfm_number<long long>(reader, "height");
    const auto scale = pfm_number<float>(reader, "scale");
    check_size(reader.where(), width, height);
    if (!is_finite(scale) || scale == 0)
        fail(reader.where(), "the scale in the header of this float map must be finite and not 0");

    const auto expected = static_cast<std::size_t>(width * height * channels) * 4;
    if (reader.remaining() != expected)
        fail(reader.where(), "holds " + std::to_string(reader.remaining()) + " bytes of pixels, not the " +
                                 std::to_string(expected) + " that its header announces: cut off or damaged");
    Image image(static_cast<int>(width), static_cast<int>(height));
    const char* at = reader.take(expected).data();
    const float factor = std::abs(scale);
    for (int y = image.height() - 1; y >= 0; --y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                auto bits = get_little_endian<std::uint32_t>(at);
                if (scale > 0) bits = bits >> 24 | (bits >> 8 & 0xff00u) | (bits << 8 & 0xff0000u) | bits << 24;
                const float value = std::bit_cast<float>(bits);
                image(x, y)[c] = factor == 1 ? value : value * factor;  // not multiplied: keeps the bits of a NaN
                if (channels == 3 || c == 2) at += 4;
            }
    return image;
}

}  // namespace lightswitch::detail
