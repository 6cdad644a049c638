#pragma once

// Numbers as bytes and back, the same on every machine.

#include <lightswitch/film/bytes.hpp>

#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// Something that lists what is to be kept of it: `keep(archive)` calls `archive(member, ...)`, which writes the
/// members or reads them.
template <class T, class Archive>
concept Kept = requires(T& value, Archive& archive) {
    value.keep(archive);
};

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;

template <class T>
using BitsOf =
    std::conditional_t<sizeof(T) == 1, std::uint8_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>;

class ArchiveWriter {
public:
    explicit ArchiveWriter(std::string& out) : out_(out) {}

    void operator()(const auto&... values) { (put(values), ...); }

private:
    template <class T>
    void put(const T& value) {
        if constexpr (std::same_as<T, bool>) {
            put_little_endian(out_, static_cast<std::uint8_t>(value));
        } else if constexpr (std::is_arithmetic_v<T>) {
            put_little_endian(out_, std::bit_cast<BitsOf<T>>(value));
        } else if constexpr (std::same_as<T, std::string>) {
            put(static_cast<std::uint64_t>(value.size()));
            out_ += value;
        } else if constexpr (is_vector<T>) {
            put(static_cast<std::uint64_t>(value.size()));
            for (const auto& element : value) put(element);
        } else {
            const_cast<T&>(value).keep(*this);  // which serves both directions, and changes nothing in this one
        }
    }

    std::string& out_;
};

/// Throws `Error` when the bytes end too early.
class ArchiveReader {
public:
    explicit ArchiveReader(ByteReader& in) : in_(in) {}

    void operator()(auto&... values) { (get(values), ...); }

private:
    template <class T>
    void get(T& value) {
        if constexpr (std::same_as<T, bool>) {
            value = in_.number<std::uint8_t>() != 0;
        } else if constexpr (std::is_arithmetic_v<T>) {
            value = std::bit_cast<T>(in_.number<BitsOf<T>>());
        } else if constexpr (std::same_as<T, std::string>) {
            value = in_.take(size());
        } else if constexpr (is_vector<T>) {
            value.clear();
            value.resize(size());  // as every element takes a byte at least
            for (auto& element : value) get(element);
        } else {
            value.keep(*this);
        }
    }

    std::size_t size() {
        const auto count = in_.number<std::uint64_t>();
        if (count > in_.remaining()) in_.truncated();
        return static_cast<std::size_t>(count);
    }

    ByteReader& in_;
};

}  // namespace lightswitch::detail
