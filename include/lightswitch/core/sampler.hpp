#pragma once

// Random and quasi-random numbers as pure functions of (seed, iteration, stream, index, dimension): no state is shared,
// so results do not depend on threads or on the order of work.

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

/// One step of the generator wyrand (Wang Yi, 2019): the two halves of a product, folded. One multiplication for 64
/// bits that pass the usual batteries of tests.
constexpr std::uint64_t fold_multiply(std::uint64_t x) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(x) * (x ^ 0xe7037ed1a0b428dbu);
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// Owen's nested uniform scrambling of a fraction whose bits are given in reversed order; different seeds give
/// independent scramblings. The hash is the one of Laine and Karras (2011) with the constants that Vegdahl found
/// ("Building a Better LK Hash", 2021); it works because multiplication and addition carry only towards higher bits.
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

/// The 24 leading bits as a float in [0, 1): the one way to make such a float. A double in [0, 1) would round up to 1.
inline float to_unit_float(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace detail

/// The part of the sample points that all streams of one iteration share.
///
/// Dimensions come in pairs. Each pair is a (0,2)-sequence of its own: Sobol' points, shuffled and Owen-scrambled with
/// the seed and the number of the pair (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020). Every stream then
/// moves them by a random digital shift of its own (an exclusive or, per dimension). The numbers of one pixel are so
/// stratified over 2^k iterations, in each pair; single numbers are uniform and different pixels uncorrelated, because
/// the shifts are independent.
class IterationPoints {
public:
    static constexpr std::uint32_t sobol_pairs = 64;  ///< beyond this many pairs points are independent

    IterationPoints(Sampling sampling, std::uint64_t seed, std::uint64_t iteration)
        : pairs_(sampling == Sampling::sobol ? sobol_pairs : 0) {
        // Sequences repeat after 2^32 iterations; the high word then selects other ones.
        seed_ = detail::mix64(detail::mix64(seed + 0x632be59bd9b4e019u) ^ (iteration >> 32));
        iteration_ = detail::mix64(seed_ ^ (iteration + 1));
        const auto reversed = detail::reverse_bits(static_cast<std::uint32_t>(iteration));
        for (std::uint32_t pair = 0; pair < pairs_; ++pair) {
            const std::uint64_t bits = detail::mix64(seed_ + 2 * pair), more = detail::mix64(seed_ + 2 * pair + 1);
            const std::uint32_t shuffled =
                detail::reverse_bits(detail::owen_scramble_reversed(reversed, static_cast<std::uint32_t>(bits >> 32)));
            const auto scrambled = [](std::uint32_t fraction_reversed, std::uint64_t seed_bits) {
                return detail::reverse_bits(
                    detail::owen_scramble_reversed(fraction_reversed, static_cast<std::uint32_t>(seed_bits)));
            };
            // The radical inverse of an index is the index with its bits reversed.
            points_[pair] = {scrambled(shuffled, more),
                             scrambled(detail::reverse_bits(detail::sobol_second(shuffled)), more >> 32)};
        }
    }

private:
    friend class Sampler;
    struct Point {
        std::uint32_t x, y;
    };
    std::uint64_t seed_, iteration_;
    std::uint32_t pairs_;
    std::array<Point, sobol_pairs> points_{};
};

/// The numbers of one pixel sample or one light path. Cheap to make; refers to its `IterationPoints`, which must
/// outlive it. Each call advances by one pair of dimensions, so the same sequence of calls gives the same numbers.
class Sampler {
public:
    /// `stream` tells apart independent uses within an iteration (pixels, light paths), `index` the pixel or path.
    Sampler(const IterationPoints& points, std::uint32_t stream, std::uint64_t index)
        : points_(&points),
          sobol_end_(points.pairs_),
          key_(detail::mix64((points.pairs_ ? points.seed_ : points.iteration_) ^
                             ((index + 1) * 0x9e3779b97f4a7c15u + (std::uint64_t{stream} << 56)))) {}

    /// A second sampler, whose numbers are independent of this one's however many are drawn from either: it takes the
    /// second half of the Sobol' pairs that are left. For a method that draws two paths of unknown length for one
    /// sample.
    Sampler split() {
        Sampler other = *this;
        other.key_ = detail::mix64(detail::fold_multiply(key_ + pair_++ * 0xa0761d6478bd642fu) ^ 0x8bb84b93962eacc9u);
        const std::uint32_t half = std::max(pair_, (pair_ + sobol_end_) / 2);
        other.pair_ = half;
        sobol_end_ = std::min(sobol_end_, half);
        return other;
    }

    /// A number in [0, 1).
    [[gnu::always_inline]] float next_1d() { return next_2d().x; }

    /// A point in [0, 1)^2.
    [[gnu::always_inline]] Vec2 next_2d() {
        const std::uint32_t pair = pair_++;
        std::uint64_t bits = detail::fold_multiply(key_ + pair * 0xa0761d6478bd642fu);
        IterationPoints::Point base{0, 0};
        if (pair < sobol_end_) [[likely]]
            base = points_->points_[pair];
        else if (points_->pairs_ != 0) bits = detail::mix64(bits ^ points_->iteration_);
        return {detail::to_unit_float(base.x ^ static_cast<std::uint32_t>(bits)),
                detail::to_unit_float(base.y ^ static_cast<std::uint32_t>(bits >> 32))};
    }

private:
    const IterationPoints* points_;
    std::uint32_t sobol_end_;  // beyond this pair numbers are independent
    std::uint32_t pair_ = 0;
    std::uint64_t key_;
};

/// Random numbers one after the other, as many as one likes: for decisions that are not worth a dimension of a
/// `Sampler`.
class RandomSequence {
public:
    /// A function of the seed alone.
    explicit RandomSequence(std::uint64_t seed = 0) : state_(detail::mix64(seed)) {}
    /// Another for every pair of numbers of a sampler.
    explicit RandomSequence(const Vec2& u)
        : RandomSequence(static_cast<std::uint64_t>(u.x * 0x1p24f) << 24 | static_cast<std::uint64_t>(u.y * 0x1p24f)) {}

    /// Uniform in [0, 1), in steps of 2^-53.
    [[gnu::always_inline]] double next() { return double(next_bits() >> 11) * 0x1p-53; }
    /// The same as a float, in steps of 2^-24.
    [[gnu::always_inline]] float next_float() {
        return detail::to_unit_float(static_cast<std::uint32_t>(next_bits() >> 32));
    }

    /// For who writes and reads it (render/archive.hpp).
    void keep(auto& archive) { archive(state_); }

private:
    [[gnu::always_inline]] std::uint64_t next_bits() {
        state_ += 0xa0761d6478bd642fu;
        return detail::fold_multiply(state_);
    }

    std::uint64_t state_;
};

inline std::string_view name(Sampling sampling) { return sampling == Sampling::sobol ? "sobol" : "independent"; }

}  // namespace lightswitch
