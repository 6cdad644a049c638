#pragma once

// Decimal numbers rounded to the nearest double.

#include <lightswitch/core/floating_point.hpp>

#include <array>
#include <bit>
#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lightswitch::detail {

/// The double nearest to digits * 10^exponent (of two, the even one), where that is quickly told; NaN elsewhere.
///
/// What is exact in double takes one division that rounds once (Clinger, "How to read floating point numbers
/// accurately", 1990). Otherwise the quotient is made in integers, with its remainder as a last bit that tells how to
/// round.
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

}  // namespace lightswitch::detail
