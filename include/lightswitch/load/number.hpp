#pragma once

// Numbers read fast and exactly from text that something ends.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lightswitch::detail {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_blank(char c) { return c == ' ' || c == '\t'; }
inline bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// The double nearest to digits * 10^exponent (of two, the even one), where that is quickly told; NaN elsewhere.
///
/// What is exact in double takes one division that rounds once (Clinger, "How to read floating point numbers
/// accurately", 1990). Otherwise the quotient is made in integers, with its remainder as the bit that tells how to round.
inline double nearest_double(std::uint64_t digits, int exponent) {
    static constexpr auto powers = [] {
        std::array<double, 23> result{1};
        for (std::size_t i = 1; i < result.size(); ++i) result[i] = 10 * result[i - 1];
        return result;
    }();
    static constexpr auto integer_powers = [] {
        std::array<std::uint64_t, 20> result{1};
        for (std::size_t i = 1; i < result.size(); ++i) result[i] = 10 * result[i - 1];
        return result;
    }();
    if (digits <= std::uint64_t(1) << 53 && exponent >= -22 && exponent <= 22) {
        const auto number = static_cast<double>(digits);
        return exponent < 0 ? number / powers[static_cast<std::size_t>(-exponent)]
                            : number * powers[static_cast<std::size_t>(exponent)];
    }
    if (digits == 0 || exponent > 0 || exponent < -19) return std::numeric_limits<double>::quiet_NaN();
    __extension__ using Wide = unsigned __int128;
    const std::uint64_t divisor = integer_powers[static_cast<std::size_t>(-exponent)];
    // Both with their highest bit set: then the quotient has 63 or 64 bits.
    const int up = std::countl_zero(digits), divisor_up = std::countl_zero(divisor);
    const std::uint64_t scaled = divisor << divisor_up;
    const Wide dividend = Wide(digits << up) << 63;
    const auto quotient = static_cast<std::uint64_t>(dividend / scaled);
    const bool is_exact = static_cast<std::uint64_t>(dividend) == quotient * scaled;
    const auto power_of_two = static_cast<std::uint64_t>(1023 - 63 + divisor_up - up);
    return static_cast<double>(quotient | (is_exact ? 0u : 1u)) * std::bit_cast<double>(power_of_two << 52);
}

/// Reads a number in decimal or scientific notation, with at most 19 digits that count. Returns where it ends, or null
/// where there is none, or one for which this is not enough: `parse_number` may know more. Some character that is no
/// part of a number must end the text.
inline const char* read_number(const char* text, double& value) {
    const bool negative = *text == '-';
    if (negative || *text == '+') ++text;
    std::uint64_t digits = 0;
    const auto take_digits = [&] {
        while (is_digit(*text)) digits = 10 * digits + static_cast<std::uint64_t>(*text++ - '0');
    };
    const char* const begin = text;
    take_digits();
    std::ptrdiff_t count = text - begin, exponent = 0;
    if (*text == '.') {
        const char* const point = ++text;
        take_digits();
        exponent = point - text;
        count -= exponent;
    }
    if (count == 0) return nullptr;
    if (count > 19) {
        for (const char* c = begin; *c == '0' || *c == '.'; ++c) count -= *c == '0';
        if (count > 19) return nullptr;
    }
    if (*text == 'e' || *text == 'E') {
        ++text;
        const bool small = *text == '-';
        if (small || *text == '+') ++text;
        const char* const first = text;
        int power = 0;
        while (is_digit(*text) && text - first < 5) power = 10 * power + (*text++ - '0');
        if (text == first || is_digit(*text)) return nullptr;
        exponent += small ? -power : power;
    }
    if (exponent < -1000 || exponent > 1000) return nullptr;
    const double number = nearest_double(digits, static_cast<int>(exponent));
    if (!(number >= 0)) return nullptr;
    value = negative ? -number : number;
    return text;
}

}  // namespace lightswitch::detail
