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

namespace lightswitch {

/// The sums of up to 2^32 - 1 triples of doubles and of their squares, each term rounded to a multiple of a power of
/// two that the largest of all magnitudes alone decides. Whatever the order of `add` and `merge`, the bits are the
/// same: they are a function of the set of terms. (Binned summation as of Demmel and Nguyen, "Parallel Reproducible
/// Summation", 2015, with two bins, and integers for bins.)
///
/// Let u(w) = 2^(32 w). The window w of a sum is the least for which all magnitudes are below u(w) 2^31, or
/// `lowest_window`. `coarse` is the sum of the terms rounded to multiples of u(w), in that unit, and `fine` that of
/// what rounding to multiples of u(w - 1) gives beyond, in that one; together they are the sum of the terms rounded to
/// u(w - 1). As one magnitude is at least u(w) / 2, each term errs by at most 2^-32 of the largest, to both sides
/// alike. When w grows by one, `coarse` becomes `fine`, and all that there is would be rounded to 0 in the new unit.
///
/// Multiplying by powers of two is exact, so that it makes no difference whether a compiler fuses products into sums.
/// What is not finite makes the sum infinite for good.
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

    friend bool operator==(const PixelSums&, const PixelSums&) = default;

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
        std::int64_t c[6], f[6];
        for (std::size_t i = 0; i < 6; ++i) {
            const double x = terms[i] * scales[i], whole = x + round;
            const double rest = (x - (whole - round)) * 0x1p32 + round;
            c[i] = std::bit_cast<std::int64_t>(whole) - rounded;
            f[i] = std::bit_cast<std::int64_t>(rest) - rounded;
        }
        for (std::size_t i = 0; i < 6; ++i) coarse[i] += c[i];
        for (std::size_t i = 0; i < 6; ++i) fine[i] += f[i];
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
        const int window = windows.of[k];
        if (window == infinite_window) return DVec3(std::numeric_limits<double>::infinity());
        const double u = power(digit * window), v = power(digit * (window - 1));
        const auto sum = [&](std::size_t i) { return double(coarse[i]) * u + double(fine[i]) * v; };
        return {sum(3 * k), sum(3 * k + 1), sum(3 * k + 2)};
    }

    void move_up(Windows& windows, std::size_t k, std::int8_t to) {
        if (to == windows.of[k]) return;
        for (std::size_t i = 3 * k; i < 3 * k + 3; ++i) {
            fine[i] = to == windows.of[k] + 1 ? coarse[i] : 0;
            coarse[i] = 0;
        }
        windows.of[k] = to;
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
