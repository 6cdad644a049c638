#pragma once

// The bytes of a film's sums, and a checksum.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/film/bytes.hpp>
#include <lightswitch/film/film.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::detail {

/// A checksum of 64-bit words. Every step is a bijection of the sum and of the word, so that a change within one word
/// is always found; another damage is not with a probability of 2^-64.
class Checksum {
public:
    void mix(std::uint64_t word) { sum_ = mix64(sum_ * 0x9e3779b97f4a7c15u + word); }
    std::uint64_t value() const { return sum_; }

    static std::uint64_t of(std::string_view bytes) {
        Checksum sum;
        std::size_t i = 0;
        for (; i + 8 <= bytes.size(); i += 8) sum.mix(get_little_endian<std::uint64_t>(bytes.data() + i));
        std::uint64_t last = bytes.size();
        for (; i < bytes.size(); ++i) last = last << 8 | static_cast<unsigned char>(bytes[i]);
        sum.mix(last);
        return sum.value();
    }

private:
    std::uint64_t sum_ = 0x6c73776c73776c73u;
};

/// Pixels of which the numbers are packed together: as differences from the first one, in as many bytes as the largest
/// of them needs.
inline constexpr std::size_t packed_together = 1024;

/// At most that many numbers.
inline void pack(std::string& out, const auto& number, std::size_t count) {
    const auto first = static_cast<std::uint64_t>(number(0));
    std::array<std::uint64_t, packed_together> differences;
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t d = static_cast<std::uint64_t>(number(i)) - first;
        differences[i] =
            d << 1 ^ (d >> 63 ? ~std::uint64_t{0} : 0);  // the sign last, so that small ones of either are small
        all |= differences[i];
    }
    const auto bytes = static_cast<std::size_t>(std::bit_width(all) + 7) / 8;
    put_little_endian(out, first);
    out += static_cast<char>(bytes);
    // All eight bytes of each, of which the next one covers what is too much: one store.
    const std::size_t size = out.size();
    out.resize(size + count * bytes + 8);
    char* to = out.data() + size;
    for (std::size_t i = 0; i < count; ++i, to += bytes)
        for (std::size_t k = 0; k < 8; ++k) to[k] = static_cast<char>(differences[i] >> 8 * k & 0xff);
    out.resize(size + count * bytes);
}

inline void unpack(ByteReader& in, const auto& set, std::size_t count) {
    const auto first = in.number<std::uint64_t>();
    const std::size_t bytes = in.number<std::uint8_t>();
    if (bytes > 8) fail(in.where(), "is damaged");
    const std::string_view packed = in.take(bytes * count);
    std::array<char, 8 * packed_together + 8> copy{};  // may be read beyond the last number
    std::memcpy(copy.data(), packed.data(), packed.size());
    const std::uint64_t mask = bytes == 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << 8 * bytes) - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t d = get_little_endian<std::uint64_t>(copy.data() + i * bytes) & mask;
        set(i, static_cast<std::int64_t>(first + (d >> 1 ^ (d & 1 ? ~std::uint64_t{0} : 0))));
    }
}

/// Calls `f(begin, count)` for all pixels, so many at a time that they stay in the cache.
inline void for_each_packed(const Film& film, const auto& f) {
    for (std::size_t begin = 0; begin < film.area(); begin += packed_together)
        f(begin, std::min(packed_together, film.area() - begin));
}

inline void pack_film(std::string& out, const Film& film) {
    for_each_packed(film, [&](std::size_t begin, std::size_t count) {
        for (std::size_t bin = 0; bin < PixelSums::bins; ++bin)
            pack(
                out, [&](std::size_t i) { return film.sums()[begin + i].bin(bin); }, count);
        for (std::size_t k = 0; k < 2; ++k)
            pack(
                out, [&](std::size_t i) { return std::int64_t{film.windows()[begin + i].of[k]}; }, count);
    });
}

inline void unpack_film(ByteReader& in, Film& film, std::uint64_t iterations) {
    std::vector<PixelSums> sums(film.area());
    std::vector<PixelSums::Windows> windows(film.area());
    for_each_packed(film, [&](std::size_t begin, std::size_t count) {
        for (std::size_t bin = 0; bin < PixelSums::bins; ++bin)
            unpack(
                in, [&](std::size_t i, std::int64_t digits) { sums[begin + i].bin(bin) = digits; }, count);
        for (std::size_t k = 0; k < 2; ++k)
            unpack(
                in,
                [&](std::size_t i, std::int64_t window) {
                    const bool possible = window == PixelSums::infinite_window ||
                                          (window >= PixelSums::lowest_window && window <= PixelSums::highest_window);
                    if (!possible) fail(in.where(), "is damaged");
                    windows[begin + i].of[k] = static_cast<std::int8_t>(window);
                },
                count);
    });
    if (in.remaining() > 0) fail(in.where(), "is damaged");
    film.restore(iterations, std::move(sums), std::move(windows));
}

}  // namespace lightswitch::detail
