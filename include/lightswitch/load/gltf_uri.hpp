#pragma once

// The two kinds of URI in glTF files.

#include <lightswitch/load/text.hpp>

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lightswitch::detail {

/// The bytes that a URI which begins with `data:` holds in base 64, or nothing when it is malformed.
inline std::optional<std::string> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) return {};
    std::string_view text = uri.substr(comma + 1);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    static const auto digits = [] {
        constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::array<unsigned char, 256> values;
        values.fill(64);
        for (std::size_t i = 0; i < alphabet.size(); ++i)
            values[static_cast<unsigned char>(alphabet[i])] = static_cast<unsigned char>(i);
        return values;
    }();
    std::string bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t pending = 0;
    int bits = 0;
    for (const char c : text) {
        const std::uint32_t digit = digits[static_cast<unsigned char>(c)];
        if (digit == 64) return {};
        pending = (pending << 6 | digit) & 0xffff;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<char>(pending >> bits & 0xff));
    }
    if (bits == 6) return {};  // a lone digit is no byte
    return bytes;
}

/// A URI without its %XX.
inline std::string decode_percent(std::string_view uri) {
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(uri.data() + i + 1, uri.data() + i + 3, value, 16).ptr == uri.data() + i + 3) {
            result.push_back(static_cast<char>(value));
            i += 2;
        } else {
            result.push_back(uri[i]);
        }
    }
    return result;
}

}  // namespace lightswitch::detail
