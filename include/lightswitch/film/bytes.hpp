#pragma once

// Taking binary formats apart without ever reading past their end.

#include <lightswitch/core/file.hpp>
#include <lightswitch/film/image.hpp>

#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace lightswitch::detail {

/// Appends the bytes of `value`, least significant first, whatever the machine's own order.
template <std::unsigned_integral T>
void put_little_endian(std::string& out, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
}

/// The number in the first bytes of `bytes`, least significant first; unchecked.
template <std::unsigned_integral T>
T get_little_endian(const char* bytes) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        value = static_cast<T>(value | static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[i])) << (8 * i)));
    return value;
}

/// A position in bytes that came from a file. Whatever would leave them throws an `Error` with the file's name.
class ByteReader {
public:
    ByteReader(std::string_view bytes, const std::string& file) : bytes_(bytes), where_(file_origin(file)) {}

    const Origin& where() const { return where_; }
    std::size_t position() const { return position_; }
    std::size_t remaining() const { return bytes_.size() - position_; }

    void seek(std::uint64_t position) {
        if (position > bytes_.size()) truncated();
        position_ = static_cast<std::size_t>(position);
    }

    /// The next `count` bytes.
    std::string_view take(std::size_t count) {
        if (count > remaining()) truncated();
        position_ += count;
        return bytes_.substr(position_ - count, count);
    }

    template <std::unsigned_integral T>
    T number() {
        return get_little_endian<T>(take(sizeof(T)).data());
    }

    std::int32_t int32() { return std::bit_cast<std::int32_t>(number<std::uint32_t>()); }

    /// The text before the next `end`, which is skipped. At most `max_length` characters.
    std::string_view until(char end, std::size_t max_length) {
        const std::size_t at = bytes_.substr(position_, max_length + 1).find(end);
        if (at == std::string_view::npos) {
            if (remaining() <= max_length) truncated();
            fail(where_, "has a damaged header: a name or line in it is too long");
        }
        const std::string_view text = take(at);
        ++position_;
        return text;
    }

    [[noreturn]] void truncated() const {
        fail(where_, "ends too early (" + std::to_string(bytes_.size()) + " bytes): cut off or damaged");
    }

private:
    std::string_view bytes_;
    Origin where_;
    std::size_t position_ = 0;
};

/// `Image::check_size` with the file's name in front of the message.
inline void check_size(const Origin& where, long long width, long long height) {
    try {
        Image::check_size(width, height);
    } catch (const Error& error) {
        fail(where, error.what());
    }
}

}  // namespace lightswitch::detail
