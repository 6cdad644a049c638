#pragma once

// Numbers and text as they stand in a report: pixels as compressed base64, strings as JSON and HTML.

#include <lightswitch/film/image.hpp>
#include <lightswitch/film/png.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::detail {

/// How many bits of a 32-bit float a report keeps: sign, exponent and the leading 15 or 11 bits of the mantissa, which
/// leaves a relative error of at most 2^-16 or 2^-12.
enum class KeptBits : int { all_digits = 24, fewer_digits = 20 };

/// The leading `bits` bits of `value`, rounded to the nearest; a finite value stays finite, and every NaN is one.
inline std::uint32_t leading_bits(float value, KeptBits bits) {
    constexpr std::uint32_t infinite = 0x7f800000u;
    const int dropped = 32 - static_cast<int>(bits);
    if (is_nan(value)) return 0x7fc00000u >> dropped;
    const std::uint32_t word = std::bit_cast<std::uint32_t>(value), magnitude = word & 0x7fffffffu;
    const std::uint32_t rounded = magnitude + (1u << (dropped - 1));
    const bool overflows = magnitude < infinite && rounded >= infinite;
    return ((overflows ? magnitude : rounded) | (word & 0x80000000u)) >> dropped;
}

inline std::string base64(std::string_view bytes) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
    }
    return text;
}

/// The bytes in the zlib format, by stb_image_write. Its lowest quality is nearly as small for noise and twice as fast.
inline std::string compress(std::string& bytes) {
    int size = 0;
    const auto release = [](unsigned char* memory) { std::free(memory); };
    const std::unique_ptr<unsigned char, decltype(release)> packed(
        stb::stbi_zlib_compress(reinterpret_cast<unsigned char*>(bytes.data()), static_cast<int>(bytes.size()), &size,
                                5),
        release);
    if (!packed) throw std::bad_alloc();  // its only way to fail
    return {reinterpret_cast<const char*>(packed.get()), static_cast<std::size_t>(size)};
}

/// Three lines of base64: the first byte of each value, the second byte, and the rest (two values to a byte when that
/// is 4 bits). The page undoes it.
///
/// The values are green, red - green and blue - green of all pixels (only red when there is `one_channel`), as integers
/// modulo 2^bits: what is grey becomes zeros. Differences to the pixel beside are not worth it for noise.
inline std::string encode_pixels(const Image& image, bool one_channel, KeptBits kept) {
    const int bits = static_cast<int>(kept), rest = bits - 16;
    const std::uint32_t mask = (1u << bits) - 1;
    const std::size_t channels = one_channel ? 1 : 3, count = image.pixels().size() * channels;
    std::array<std::string, 3> planes;
    for (std::string& plane : planes) plane.reserve(count);
    unsigned half_byte = 0;
    for (std::size_t channel = 0, i = 0; channel < channels; ++channel) {
        for (const Rgb& p : image.pixels()) {
            const std::uint32_t green = leading_bits(one_channel ? p.x : p.y, kept);
            const std::uint32_t value =
                channel == 0 ? green : (leading_bits(channel == 1 ? p.x : p.z, kept) - green) & mask;
            planes[0] += static_cast<char>(value >> (bits - 8));
            planes[1] += static_cast<char>(value >> rest & 0xffu);
            const unsigned low = value & ((1u << rest) - 1);
            const bool odd = i++ % 2 != 0;
            if (rest == 8) {
                planes[2] += static_cast<char>(low);
            } else if (odd) {
                planes[2] += static_cast<char>(half_byte | low << 4);
            } else {
                half_byte = low;
                if (i == count) planes[2] += static_cast<char>(low);
            }
        }
    }
    std::string lines;
    for (std::string& plane : planes) lines += base64(compress(plane)) + "\n";
    return lines;
}

/// The text with every byte that is no valid UTF-8 replaced by U+FFFD: a page that is not UTF-8 would show none of it
/// right.
inline std::string valid_utf8(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t at) {
            return static_cast<unsigned char>(at < text.size() ? text[at] : '\0');
        };
        const unsigned first = byte(i);
        std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
        for (std::size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80) length = 0;
        const unsigned second = byte(i + 1);  // overlong forms, surrogates and what is above U+10FFFF
        if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) || (first == 0xf0 && second < 0x90) ||
            (first == 0xf4 && second > 0x8f))
            length = 0;
        result += length > 0 ? text.substr(i, length) : std::string_view("\xef\xbf\xbd");
        i += length > 0 ? length : 1;
    }
    return result;
}

/// The text as HTML, in an element or between quotes in a tag. Control characters other than line breaks become U+FFFD.
inline std::string html_text(std::string_view text) {
    std::string result;
    for (const char c : valid_utf8(text)) switch (c) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '"': result += "&quot;"; break;
            case '\'': result += "&#39;"; break;
            default: {
                const bool control = (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
                if (control) result += "\xef\xbf\xbd";
                else result += c;
            }
        }
    return result;
}

/// The text as a JSON string that may stand in a script element: no '<' is left that could end it.
inline std::string json_text(std::string_view text) {
    static constexpr std::string_view hex = "0123456789abcdef";
    std::string result = "\"";
    for (const char c : valid_utf8(text)) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code == 0x7f || c == '<' || c == '>' || c == '&') {
            result += "\\u00";
            result += hex[code >> 4];
            result += hex[code & 15];
        } else {
            if (c == '"' || c == '\\') result += '\\';
            result += c;
        }
    }
    return result + "\"";
}

/// The shortest JSON number that reads back as `value`; null when it is not finite.
inline std::string json_number(double value) {
    if (!std::isfinite(value)) return "null";
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// A JSON array of what `write` makes of each item.
template <class Items, class Write>
std::string json_array(const Items& items, Write write) {
    std::string result = "[";
    for (const auto& item : items) {
        if (result.size() > 1) result += ",";
        result += write(item);
    }
    return result + "]";
}

}  // namespace lightswitch::detail
