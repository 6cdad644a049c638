#pragma once

// What every loader needs: numbers, words, line numbers, and quotes of text that may be hostile.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lightswitch::detail {

/// The finite number that `word` spells, from its first to its last character, or nothing. Decimal or scientific
/// notation whatever the locale; a leading plus is allowed.
std::optional<double> parse_number(std::string_view word);
/// The same where there must be one: throws `Error`, of that place, for anything else.
double finite_number(std::string_view word, const Origin& where);
/// What `parse_number` does for an integer that fits in 64 bits.
std::optional<std::int64_t> parse_integer(std::string_view word);

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }
inline bool is_line_end(char c) { return c == '\n' || c == '\r'; }
inline bool is_space(char c) { return is_blank(c) || is_line_end(c); }

/// Cuts the first word off `text`; empty at the end. Words are separated by any of `separators`.
std::string_view next_word(std::string_view& text, std::string_view separators = " \t\r\n");

/// Cuts the first line off `text`; its end (LF, CRLF or CR) is not part of it.
std::string_view next_line(std::string_view& text);

/// `text` without blanks and ends of lines at both ends.
std::string_view trimmed(std::string_view text);

/// `text` without the mark that some programs begin UTF-8 with.
std::string_view without_byte_order_mark(std::string_view text);

/// `text` with A to Z replaced by a to z.
std::string lower_case(std::string_view text);

/// `text` fit for an error message: one line of printable ASCII, shortened when it is long.
std::string shown(std::string_view text);
/// `number` with as few digits as tell it from any other.
std::string shown(double number);
/// The same in double quotes.
std::string quote(std::string_view text);

/// Finds the line of a byte offset in a text.
class LineIndex {
public:
    explicit LineIndex(std::string_view text);
    /// 1-based line of `offset`.
    int line(std::size_t offset) const;

private:
    std::vector<std::size_t> newlines_;
};

inline std::optional<double> parse_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return {};
    if (!is_finite(value)) return {};
    return value;
}

inline double finite_number(std::string_view word, const Origin& where) {
    const auto number = parse_number(word);
    if (!number) fail(where, quote(word) + " is not a finite number");
    return *number;
}

inline std::optional<std::int64_t> parse_integer(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return {};
    return value;
}

inline std::string_view next_word(std::string_view& text, std::string_view separators) {
    const std::size_t begin = std::min(text.find_first_not_of(separators), text.size());
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

inline std::string_view next_line(std::string_view& text) {
    const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
    const auto end = static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_end) - text.begin());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
    return line;
}

inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

inline std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return text.substr(text.starts_with(mark) ? mark.size() : 0);
}

inline std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

inline std::string shown(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string result(text.substr(0, longest));
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return text.size() > longest ? result + "..." : result;
}

inline std::string shown(double number) {
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

inline std::string quote(std::string_view text) { return "\"" + shown(text) + "\""; }

inline LineIndex::LineIndex(std::string_view text) {
    for (std::size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1))
        newlines_.push_back(i);
}

inline int LineIndex::line(std::size_t offset) const {
    const auto before = std::lower_bound(newlines_.begin(), newlines_.end(), offset);
    return 1 + static_cast<int>(before - newlines_.begin());
}

}  // namespace lightswitch::detail
