#pragma once

// Large text files, read piece by piece.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/text.hpp>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace lightswitch::detail {

/// Gives a text file in pieces that end where a line does and the next one does not continue it (after a backslash), so
/// that little memory is taken, and it stays in the caches.
class TextFile {
public:
    /// Throws `Error` as `read_file` does.
    TextFile(const std::filesystem::path& path, std::uintmax_t max_bytes, std::size_t piece = std::size_t(1) << 18)
        : path_(path), buffer_(std::make_unique_for_overwrite<char[]>(piece + 1)), capacity_(piece) {
        file_ = open_file(path, max_bytes, unread_);
    }

    /// The next piece, which is good until the call after; empty at the end. An end of a line or a zero ends it.
    std::string_view next() {
        std::memmove(buffer_.get(), buffer_.get() + used_, size_ - used_);
        size_ -= used_;
        used_ = 0;
        while (used_ == 0) {
            if (size_ == capacity_) grow();
            const std::size_t wanted = std::min(capacity_ - size_, unread_);
            if (std::fread(buffer_.get() + size_, 1, wanted, file_.get()) != wanted)
                fail(file_origin(path_), "reading failed");
            size_ += wanted;
            unread_ -= wanted;
            if (unread_ == 0) break;
            used_ = end_of_statement();
        }
        if (used_ == 0) {
            used_ = size_;
            buffer_[size_] = '\0';
        }
        return {buffer_.get(), used_};
    }

    /// How many bytes are still to come.
    std::size_t rest() const { return unread_ + size_ - used_; }

private:
    void grow() {
        auto larger = std::make_unique_for_overwrite<char[]>(2 * capacity_ + 1);
        std::memcpy(larger.get(), buffer_.get(), size_);
        buffer_ = std::move(larger);
        capacity_ *= 2;
    }

    /// After the last line in the buffer that is known not to be continued; 0 when there is none.
    std::size_t end_of_statement() const {
        // What follows a line end must be known: it may be its second half.
        for (std::size_t end = size_ - 1; end > 0; --end) {
            const char last = buffer_[end - 1];
            if (!is_line_end(last) || (last == '\r' && buffer_[end] == '\n')) continue;
            std::size_t text = end - 1;
            if (last == '\n' && text > 0 && buffer_[text - 1] == '\r') --text;
            while (text > 0 && is_blank(buffer_[text - 1])) --text;
            if (text == 0 || buffer_[text - 1] != '\\') return end;
        }
        return 0;
    }

    std::filesystem::path path_;
    FileHandle file_;
    std::size_t unread_ = 0;
    std::unique_ptr<char[]> buffer_;
    std::size_t capacity_, size_ = 0, used_ = 0;
};

}  // namespace lightswitch::detail
