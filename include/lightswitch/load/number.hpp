#pragma once

// Decimal numbers, read many times as fast as `std::from_chars` does, and to the same last bit.

#include <lightswitch/load/decimal.hpp>
#include <lightswitch/load/text.hpp>

#include <bit>
#include <cfloat>
#include <cstring>

namespace lightswitch::detail {

/// Reads a number as most files write it, from `at` on: digits with perhaps a minus, a point and an exponent. Returns
/// where it ends, or null, when there is none or only `parse_number` can round it: with more than 19 digits that count,
/// or far from 1 (`nearest_double`).
const char* read_simple_number(const char* at, const char* end, double& value);
/// The same for an integer of at most 18 digits without a sign.
const char* read_simple_integer(const char* at, const char* end, std::uint64_t& value);
/// What `parse_number` returns, sooner.
std::optional<double> parse_number_fast(std::string_view word);

/// Eight characters, the first in the lowest byte; zeros past the end.
inline std::uint64_t load_eight(const char* at, const char* end) {
    std::uint64_t result = 0;
    if constexpr (std::endian::native == std::endian::little) {
        if (end - at >= 8) std::memcpy(&result, at, 8);
        else std::memcpy(&result, at, static_cast<std::size_t>(end - at));
    } else {
        for (int i = 0; i < 8 && at + i < end; ++i)
            result |= std::uint64_t(static_cast<unsigned char>(at[i])) << (8 * i);
    }
    return result;
}

/// Appends the digits from `at` on to `value`, modulo 2^64, and returns where they end. Takes eight at a time, without
/// a branch on how many there are.
inline const char* append_digits(const char* at, const char* end, std::uint64_t& value) {
    static constexpr std::array<std::uint64_t, 9> powers{1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    for (;;) {
        std::uint64_t digits = load_eight(at, end) ^ 0x3030303030303030u;
        // The sum has its highest bit set for 10 and more; what it carries over cannot reach a byte before that one.
        const std::uint64_t others = ((digits + 0x7676767676767676u) | digits) & 0x8080808080808080u;
        const auto count = static_cast<std::size_t>(std::countr_zero(others)) / 8;
        if (count == 0) return at;
        digits <<= 64 - 8 * count;  // zeros before them
        digits = (digits * 10 + (digits >> 8)) & 0x00ff00ff00ff00ffu;
        digits = (digits * 100 + (digits >> 16)) & 0x0000ffff0000ffffu;
        digits = (digits * 10000 + (digits >> 32)) & 0x00000000ffffffffu;
        value = value * powers[count] + digits;
        at += count;
        if (count < 8) return at;
    }
}

inline const char* read_simple_number(const char* at, const char* end, double& value) {
    if (FLT_EVAL_METHOD != 0) return nullptr;  // would round twice
    const bool negative = at < end && *at == '-';
    if (negative) ++at;
    std::uint64_t digits = 0;
    const char* const first = at;
    at = append_digits(at, end, digits);
    std::ptrdiff_t count = at - first, exponent = 0;
    if (at < end && *at == '.') {
        const char* const point = at + 1;
        at = append_digits(point, end, digits);
        exponent = point - at;
        count -= exponent;
    }
    if (count == 0) return nullptr;
    if (count > 19) {
        for (const char* c = first; c < at && (*c == '0' || *c == '.'); ++c) count -= *c == '0';
        if (count > 19) return nullptr;
    }
    if (at < end && (*at == 'e' || *at == 'E')) {
        ++at;
        const bool small = at < end && *at == '-';
        if (at < end && (*at == '-' || *at == '+')) ++at;
        std::uint64_t power = 0;
        const char* const begin = at;
        at = append_digits(at, end, power);
        if (at == begin || at - begin > 4) return nullptr;
        exponent += small ? -static_cast<std::ptrdiff_t>(power) : static_cast<std::ptrdiff_t>(power);
    }
    if (exponent < -9999 || exponent > 9999) return nullptr;
    const double size = nearest_double(digits, static_cast<int>(exponent));
    if (!(size >= 0)) return nullptr;
    value = negative ? -size : size;
    return at;
}

inline const char* read_simple_integer(const char* at, const char* end, std::uint64_t& value) {
    value = 0;
    const char* const last = append_digits(at, end, value);
    return last == at || last - at > 18 ? nullptr : last;
}

inline std::optional<double> parse_number_fast(std::string_view word) {
    double value = 0;
    const char* const end = word.data() + word.size();
    if (!word.empty() && read_simple_number(word.data(), end, value) == end) return value;
    return parse_number(word);
}

}  // namespace lightswitch::detail
