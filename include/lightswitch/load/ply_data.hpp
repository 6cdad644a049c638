#pragma once

// The values of a PLY file.

#include <lightswitch/core/error.hpp>
#include <lightswitch/load/ply_header.hpp>
#include <lightswitch/load/text.hpp>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lightswitch::detail {

/// The values after the header, in the order in which they stand.
class PlyData {
public:
    PlyData(std::string_view bytes, const PlyHeader& header, std::string file)
        : rest_(bytes.substr(header.bytes)),
          format_(header.format),
          line_end_(header.line_end),
          line_(header.lines + 1),
          file_(std::move(file)) {}

    /// Names the element that is read next, for errors.
    void begin(const PlyElement& element, std::size_t index) {
        element_ = &element;
        index_ = index;
    }

    /// The next value, which is finite and fits its type.
    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word_as(type) : next_binary(type); }
    /// The length of the list that is next.
    double next_length(PlyType type) {
        const double length = next(type);
        if (length < 0 || length != std::floor(length)) error("a list cannot have the length " + shown(length));
        return length;
    }
    /// Passes over the next value, whatever it is.
    void skip(PlyType type) {
        if (format_ == PlyHeader::Format::ascii) next_word_of_file();
        else take(type);
    }

    /// Refuses a count that the rest of the file cannot hold, before memory is spent on it.
    void check_count(const PlyElement& element) {
        const bool ascii = format_ == PlyHeader::Format::ascii;
        std::size_t least = 0;
        for (const PlyProperty& p : element.properties)
            least += ascii ? 2 : ply_type_bytes[static_cast<std::size_t>(p.count_type.value_or(p.type))];
        // One more byte: the last word of an ASCII file needs no separator after it.
        if (least > 0 && element.count > (rest_.size() + 1) / least)
            fail({file_, element.line, {}}, std::to_string(element.count) + " of the element " + quote(element.name) +
                                                " cannot be in the " + std::to_string(rest_.size()) +
                                                " bytes that follow");
    }

    void check_end() {
        element_ = nullptr;
        if (format_ == PlyHeader::Format::ascii && word().empty()) return;
        if (format_ != PlyHeader::Format::ascii && rest_.empty()) return;
        error("the file goes on after its last element");
    }

    // For those who read ahead: what is left, and going over some of it, which ends so many lines.
    std::string_view rest() const { return rest_; }
    PlyHeader::Format format() const { return format_; }
    char line_end() const { return line_end_; }
    void pass(std::size_t bytes, int lines) {
        rest_.remove_prefix(bytes);
        line_ += lines;
    }

    /// The element that is being read.
    Origin place() const {
        const bool ascii = format_ == PlyHeader::Format::ascii;
        return {file_, ascii ? line_ : 0, element_ == nullptr ? "" : element_->name + " " + std::to_string(index_)};
    }
    [[noreturn]] void error(const std::string& what) const { fail(place(), what); }

private:
    std::string_view word() {
        const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
        line_ +=
            static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(begin), line_end_));
        return next_word(rest_);
    }

    std::string_view next_word_of_file() {
        const std::string_view text = word();
        if (text.empty()) error("the file ends too early");
        return text;
    }

    double next_word_as(PlyType type) {
        static constexpr std::array<std::array<double, 2>, 6> ranges{
            {{-128, 127}, {0, 255}, {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647.0}, {0, 4294967295.0}}};
        const std::string_view text = next_word_of_file();
        if (type >= PlyType::float32) {
            const auto number = parse_number(text);
            if (!number) error(quote(text) + " is not a finite number");
            return *number;
        }
        const auto integer = parse_integer(text);
        if (!integer) error(quote(text) + " is not an integer");
        const auto number = static_cast<double>(*integer);
        const auto& [lowest, highest] = ranges[static_cast<std::size_t>(type)];
        if (number < lowest || number > highest) error(quote(text) + " does not fit the type that the header gives");
        return number;
    }

    /// The bytes of the next value as a number, the most significant first.
    std::uint64_t take(PlyType type) {
        const std::size_t size = ply_type_bytes[static_cast<std::size_t>(type)];
        if (rest_.size() < size) error("the file ends too early");
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t at = format_ == PlyHeader::Format::little_endian ? size - 1 - i : i;
            bits = bits << 8 | static_cast<unsigned char>(rest_[at]);
        }
        rest_.remove_prefix(size);
        return bits;
    }

    double next_binary(PlyType type) {
        const std::uint64_t bits = take(type);
        switch (type) {
            case PlyType::int8: return static_cast<std::int8_t>(bits);
            case PlyType::int16: return static_cast<std::int16_t>(bits);
            case PlyType::int32: return static_cast<std::int32_t>(bits);
            case PlyType::uint8:
            case PlyType::uint16:
            case PlyType::uint32: return static_cast<double>(bits);
            case PlyType::float32: {
                const float value = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
                if (!lightswitch::is_finite(value)) error("a number is not finite");
                return value;
            }
            case PlyType::float64: break;
        }
        const double value = std::bit_cast<double>(bits);
        if (!is_finite(value)) error("a number is not finite");
        return value;
    }

    std::string_view rest_;
    PlyHeader::Format format_;
    char line_end_;
    int line_;
    std::string file_;
    const PlyElement* element_ = nullptr;
    std::size_t index_ = 0;
};

}  // namespace lightswitch::detail
