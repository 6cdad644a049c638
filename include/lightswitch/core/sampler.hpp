#pragma once

// Random and quasi-random numbers as pure functions of (seed, iteration, stream, index, dimension): no state is shared, so
// results do not depend on threads or on the order of work.

#include <lightswitch/core/math.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace lightswitch {

/// How sample points are chosen.
enum class Sampling {
    sobol,        ///< Owen-scrambled Sobol' points: less noise at the same cost (the default)
    independent,  ///< independent random numbers: samples of one pixel have no structure at all
};

namespace detail {

/// A bijection of 64-bit words whose output bits all depend on all input bits (the variant 13 finaliser of Stafford's
/// "Better Bit Mixing", 2011, as in SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// Owen's nested uniform scrambling of a fraction whose bits are given in reversed order; different seeds give independent
/// scramblings. The hash is the one of Laine and Karras (2011) with the constants that Vegdahl found ("Building a Better
/// LK Hash", 2021); it works because multiplication and addition carry only towards higher bits.
constexpr std::uint32_t owen_scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Second dimension of the Sobol' sequence (direction numbers from the polynomial x + 1).
constexpr std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
        if (index & 1u) result ^= v;
    return result;
}

/// The 24 leading bits as a float in [0, 1).
inline float to_unit_float(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace detail

/// The part of the sample points that all pixels of one iteration share.
///
/// Dimensions come in pairs, each an independently shuffled (0,2)-sequence; every stream then scrambles its own copy. The
/// samples that a pixel gets over 2^k iterations are therefore stratified in each pair, while two pixels share nothing (after
/// Burley, "Practical Hash-based Owen Scrambling", JCGT 2020, with the shuffle moved out of the pixel).
class IterationPoints {
public:
    static constexpr std::uint32_t sobol_pairs = 64;  ///< beyond this many pairs points are independent

    IterationPoints(Sampling sampling, std::uint64_t seed, std::uint64_t iteration)
        : seed_(detail::mix64(seed + 0x632be59bd9b4e019u)), iteration_(detail::mix64(seed_ ^ (iteration + 1))),
          pairs_(sampling == Sampling::sobol ? sobol_pairs : 0) {
        const auto index = static_cast<std::uint32_t>(iteration);
        // Sequences repeat after 2^32 iterations; the high word then selects another scrambling.
        seed_ ^= detail::mix64(iteration >> 32);
        for (std::uint32_t pair = 0; pair < pairs_; ++pair) {
            const auto shuffle = static_cast<std::uint32_t>(detail::mix64(seed_ + pair));
            const std::uint32_t shuffled =
                detail::reverse_bits(detail::owen_scramble_reversed(detail::reverse_bits(index), shuffle));
            reversed_[2 * pair] = shuffled;  // the radical inverse is the index with its bits reversed
            reversed_[2 * pair + 1] = detail::reverse_bits(detail::sobol_second(shuffled));
        }
    }

private:
    friend class Sampler;
    std::uint64_t seed_, iteration_;
    std::uint32_t pairs_;
    std::array<std::uint32_t, 2 * sobol_pairs> reversed_;
};

/// The numbers of one pixel sample or one light path. Cheap to make; refers to its `IterationPoints`, which must outlive it.
/// Each call advances to the next dimension, so the same sequence of calls gives the same numbers.
class Sampler {
public:
    /// `stream` tells apart independent uses within an iteration (pixels, light paths), `index` the pixel or path.
    Sampler(const IterationPoints& points, std::uint32_t stream, std::uint64_t index)
        : points_(&points),
          key_(detail::mix64((points.pairs_ ? points.seed_ : points.iteration_) ^
                             ((index + 1) * 0x9e3779b97f4a7c15u + (std::uint64_t{stream} << 56)))) {}

    /// A number in [0, 1).
    float next_1d() { return next_2d().x; }

    /// A point in [0, 1)^2.
    Vec2 next_2d() {
        const std::uint32_t pair = pair_++;
        const std::uint64_t bits = detail::mix64(key_ + pair * 0xd1342543de82ef95u);
        auto a = static_cast<std::uint32_t>(bits);
        auto b = static_cast<std::uint32_t>(bits >> 32);
        if (pair < points_->pairs_) [[likely]] {
            a = detail::reverse_bits(detail::owen_scramble_reversed(points_->reversed_[2 * pair], a));
            b = detail::reverse_bits(detail::owen_scramble_reversed(points_->reversed_[2 * pair + 1], b));
        } else if (points_->pairs_ != 0) {
            const std::uint64_t fresh = detail::mix64(bits ^ points_->iteration_);
            a = static_cast<std::uint32_t>(fresh);
            b = static_cast<std::uint32_t>(fresh >> 32);
        }
        return {detail::to_unit_float(a), detail::to_unit_float(b)};
    }

private:
    const IterationPoints* points_;
    std::uint64_t key_;
    std::uint32_t pair_ = 0;
};

inline std::string_view name(Sampling sampling) { return sampling == Sampling::sobol ? "sobol" : "independent"; }

}  // namespace lightswitch
