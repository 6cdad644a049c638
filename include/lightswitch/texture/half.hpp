#pragma once

// Numbers of 16 bits (IEEE 754 binary16), which images store; arithmetic is done in float.

#include <lightswitch/core/math.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace lightswitch {

/// A number of 16 bits: 11 significant bits, largest 65504, smallest above 0 about 6e-8. Holds infinities and NaN.
class Half {
public:
    Half() = default;
    /// The nearest number of 16 bits, ties to even; infinity for what rounds beyond 65504.
    explicit Half(float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        const std::uint32_t magnitude = bits & 0x7fffffffu;
        std::uint32_t half = 0;
        if (magnitude > 0x7f800000u) half = 0x7e00u;
        else if (magnitude >= 0x477ff000u) half = 0x7c00u;
        else if (magnitude < 0x38800000u)  // below 2^-14 the unit is 2^-24
            half = static_cast<std::uint32_t>(std::lrint(std::bit_cast<float>(magnitude) * 0x1p24f));
        else half = (magnitude - 0x38000000u + 0x0fffu + ((magnitude >> 13) & 1u)) >> 13;
        bits_ = static_cast<std::uint16_t>(half | ((bits >> 16) & 0x8000u));
    }

    /// The same number as a float, also where denormal floats are flushed to zero.
    explicit operator float() const {
        const std::uint32_t sign = (bits_ & 0x8000u) << 16, rest = bits_ & 0x7fffu;
        if (rest < 0x0400u)
            return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(static_cast<float>(rest) * 0x1p-24f));
        return std::bit_cast<float>(sign | ((rest << 13) + (rest < 0x7c00u ? 0x38000000u : 0x70000000u)));
    }

private:
    std::uint16_t bits_ = 0;
};

}  // namespace lightswitch
