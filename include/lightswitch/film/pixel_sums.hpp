#pragma once

// Sums that do not depend on the order of their terms, nor on how these are split into sums of their own.

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace lightswitch {

/// The sums of up to 2^32 - 1 triples of doubles and of their squares, each term rounded to a multiple of a power of
/// two that the largest of all magnitudes alone decides. Whatever the order of `add` and `merge`, the bits are the
/// same: they are a function of the set of terms. (Binned summation as of Demmel and Nguyen, "Parallel Reproducible
/// Summation", 2015, with three bins for the values and two for the squares, and integers for bins.)
///
/// Let u(w) = 2^(32 w). The window w of a sum is the least for which all magnitudes are below u(w) 2^31, or
/// `lowest_window`. `coarse` is the sum of the terms rounded to multiples of u(w), in that unit, and `fine` that of
/// what rounding to multiples of u(w - 1) gives beyond, in that one, and `finest` the same of u(w - 2); together they
/// are the sum of the terms rounded to the last of these. As one magnitude is at least u(w) / 2, each value errs by at
/// most 2^-64 of the largest and each square by 2^-32, to both sides alike. When w grows by one, `coarse` becomes
/// `fine`, and `fine` `finest`, and all that there is would be rounded to 0 in the new unit.
///
/// So floats down to 2^-40 of the largest are added without any error, and their sum is rounded once: multiplied by a
/// power of two they have the same digits. Multiplying by powers of two is exact, so that it makes no difference
/// whether a compiler fuses products into sums. What is not finite makes the sum infinite for good.
struct PixelSums {
    static constexpr std::uint64_t most_terms = std::numeric_limits<std::uint32_t>::max();
    /// The greatest has room for squares of sums of 2^32 floats.
    static constexpr int lowest_window = -11, highest_window = 10;
    /// Of a sum that is not finite. Its limit is so low that whatever is added is looked at.
    static constexpr int infinite_window = -31;

    /// Of the values, and of the squares. Kept apart from the rest, which then needs no padding.
    struct Windows {
        std::array<std::int8_t, 2> of{lowest_window, lowest_window};
        friend bool operator==(const Windows&, const Windows&) = default;
    };

    std::array<std::int64_t, 6> coarse{}, fine{};  ///< three for the values and three for the squares
    std::array<std::int64_t, 3> finest{};          ///< for the values

    friend bool operator==(const PixelSums&, const PixelSums&) = default;

    /// All bins, for who writes and reads them.
    static constexpr std::size_t bins = 15;
    std::int64_t& bin(std::size_t i) { return i < 6 ? coarse[i] : i < 12 ? fine[i - 6] : finest[i - 12]; }
    std::int64_t bin(std::size_t i) const { return i < 6 ? coarse[i] : i < 12 ? fine[i - 6] : finest[i - 12]; }

    [[gnu::always_inline]] void add(Windows& windows, const DVec3& value) {
        const double terms[6] = {value.x, value.y, value.z, value.x * value.x, value.y * value.y, value.z * value.z};
        const double most = power(31 + digit * windows.of[0]), most_square = power(31 + digit * windows.of[1]);
        if (!(std::abs(terms[0]) < most && std::abs(terms[1]) < most && std::abs(terms[2]) < most &&
              terms[3] < most_square && terms[4] < most_square && terms[5] < most_square)) [[unlikely]] {
            make_room(windows, value);
            if (windows.of[0] == infinite_window) return;
        }
        constexpr double round = 0x1.8p52;  // to integers: what is added to it has no place for a fraction
        constexpr auto rounded = std::bit_cast<std::int64_t>(round);
        const double a = power(-digit * windows.of[0]), b = power(-digit * windows.of[1]);
        const double scales[6] = {a, a, a, b, b, b};
        std::int64_t c[6], f[6], l[3];
        double rest[6];
        for (std::size_t i = 0; i < 6; ++i) {
            const double x = terms[i] * scales[i], whole = x + round;
            rest[i] = (x - (whole - round)) * 0x1p32;
            c[i] = std::bit_cast<std::int64_t>(whole) - rounded;
        }
        for (std::size_t i = 0; i < 6; ++i) {
            const double part = rest[i] + round;
            f[i] = std::bit_cast<std::int64_t>(part) - rounded;
            rest[i] = (rest[i] - (part - round)) * 0x1p32;
        }
        for (std::size_t i = 0; i < 3; ++i) l[i] = std::bit_cast<std::int64_t>(rest[i] + round) - rounded;
        for (std::size_t i = 0; i < 6; ++i) coarse[i] += c[i];
        for (std::size_t i = 0; i < 6; ++i) fine[i] += f[i];
        for (std::size_t i = 0; i < 3; ++i) finest[i] += l[i];
    }

    /// Adds all terms of other sums.
    void merge(Windows& windows, PixelSums other, Windows other_windows) {
        if (windows.of[0] == infinite_window || other_windows.of[0] == infinite_window) return become_infinite(windows);
        for (std::size_t k = 0; k < 2; ++k) {
            const std::int8_t to = std::max(windows.of[k], other_windows.of[k]);
            other.move_up(other_windows, k, to);
            move_up(windows, k, to);
        }
        for (std::size_t i = 0; i < 6; ++i) {
            coarse[i] += other.coarse[i];
            fine[i] += other.fine[i];
        }
        for (std::size_t i = 0; i < 3; ++i) finest[i] += other.finest[i];
    }

    DVec3 values(const Windows& windows) const { return total(windows, 0); }
    DVec3 squares(const Windows& windows) const { return total(windows, 1); }

private:
    static constexpr int digit = 32;

    /// 2^n, of normal numbers.
    [[gnu::always_inline]] static double power(int n) {
        return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n) << 52);
    }

    DVec3 total(const Windows& windows, std::size_t k) const {
        __extension__ using Wide = __int128;
        const int window = windows.of[k];
        if (window == infinite_window) return DVec3(std::numeric_limits<double>::infinity());
        const double unit = power(digit * (window - 2));
        const auto sum = [&](std::size_t i) {
            // Less than 2^127, and rounded once.
            const Wide whole = ((Wide(coarse[i]) * (Wide(1) << digit)) + fine[i]) * (Wide(1) << digit);
            return double(whole + (k == 0 ? finest[i] : 0)) * unit;
        };
        return {sum(3 * k), sum(3 * k + 1), sum(3 * k + 2)};
    }

    void move_up(Windows& windows, std::size_t k, std::int8_t to) {
        for (; windows.of[k] < to; ++windows.of[k])
            for (std::size_t i = 3 * k; i < 3 * k + 3; ++i) {
                if (k == 0) finest[i] = fine[i];
                fine[i] = std::exchange(coarse[i], 0);
            }
    }

    void become_infinite(Windows& windows) {
        *this = {};
        windows.of = {infinite_window, infinite_window};
    }

    [[gnu::noinline]] void make_room(Windows& windows, const DVec3& value) {
        const DVec3 size = glm::abs(value);
        constexpr double most = 0x1p170;  // whose square is below the limit of the highest window
        if (windows.of[0] == infinite_window || !(size.x < most && size.y < most && size.z < most))
            return become_infinite(windows);
        const double largest = std::max({size.x, size.y, size.z});
        const double sizes[2] = {largest, largest * largest};
        for (std::size_t k = 0; k < 2; ++k) {
            std::int8_t to = windows.of[k];
            while (!(sizes[k] < power(31 + digit * to))) ++to;
            move_up(windows, k, to);
        }
    }
};

}  // namespace lightswitch
