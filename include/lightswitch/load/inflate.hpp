#pragma once

// Data that zlib compressed, unpacked piece by piece where the build has zlib (LIGHTSWITCH_HAS_ZLIB is 1 and zlib is
// linked).

#if LIGHTSWITCH_HAS_ZLIB

#include <lightswitch/core/error.hpp>
#include <lightswitch/film/bytes.hpp>

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace lightswitch::detail {

/// Unpacks little-endian numbers, with memory for one piece of the data. Damage throws an `Error`.
class Inflate {
public:
    /// Reads the zlib stream at the beginning of `packed`, which must outlive this and is less than 4 GiB.
    Inflate(std::string_view packed, Origin where) : where_(std::move(where)) {
        // zlib's interface lacks the const, but only reads.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
        stream_.avail_in = static_cast<uInt>(packed.size());
        if (packed.size() > std::numeric_limits<uInt>::max()) fail(where_, "the compressed data is too long");
        if (inflateInit(&stream_) != Z_OK) fail(where_, "zlib cannot start");
    }
    Inflate(const Inflate&) = delete;
    Inflate& operator=(const Inflate&) = delete;
    ~Inflate() { inflateEnd(&stream_); }

    template <std::unsigned_integral T>
    T number() {
        if (end_ - begin_ < sizeof(T)) refill();
        if (end_ - begin_ < sizeof(T)) fail(where_, "the compressed data ends too early");
        begin_ += sizeof(T);
        return get_little_endian<T>(&piece_[begin_ - sizeof(T)]);
    }
    float float32() { return std::bit_cast<float>(number<std::uint32_t>()); }
    double float64() { return std::bit_cast<double>(number<std::uint64_t>()); }

    /// Whether nothing is left. Then zlib has found the checksum right.
    bool at_end() {
        if (begin_ == end_) refill();
        return begin_ == end_;
    }

private:
    /// Moves what is left to the front and fills the rest of the piece, if there is as much.
    void refill() {
        std::memmove(piece_.data(), &piece_[begin_], end_ - begin_);
        end_ -= std::exchange(begin_, 0);
        while (!finished_ && end_ < piece_.size()) {
            stream_.next_out = reinterpret_cast<Bytef*>(&piece_[end_]);
            stream_.avail_out = static_cast<uInt>(piece_.size() - end_);
            const int code = inflate(&stream_, Z_NO_FLUSH);
            end_ = piece_.size() - stream_.avail_out;
            finished_ = code == Z_STREAM_END;
            if (code == Z_BUF_ERROR || (code == Z_OK && stream_.avail_in == 0 && stream_.avail_out > 0))
                fail(where_, "the compressed data is cut off");
            if (code != Z_OK && code != Z_STREAM_END)
                fail(where_,
                     std::string("the compressed data is damaged: ") + (stream_.msg ? stream_.msg : "no reason given"));
        }
    }

    Origin where_;
    z_stream stream_{};
    bool finished_ = false;
    std::array<char, 1 << 15> piece_;
    std::size_t begin_ = 0, end_ = 0;
};

}  // namespace lightswitch::detail

#endif
