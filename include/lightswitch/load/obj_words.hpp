#pragma once

// Words in OBJ files as nearly all are written, read fast. The text must end with an end of a line, or be followed by
// something that ends a word.

#include <lightswitch/load/number.hpp>

#include <array>
#include <cstdint>

namespace lightswitch::detail {

/// Where the next line begins, for a pointer to the end of one.
inline const char* after_line_end(const char* text) { return text + (text[0] == '\r' && text[1] == '\n' ? 2 : 1); }

/// Reads the numbers of a line, of which the first three make `result`. Returns where the next line begins, or null
/// when there is something else, or another number of them.
inline const char* read_usual_vector(const char* text, const char* end, int fewest, int most, DVec3& result) {
    std::array<double, 7> numbers{};
    for (int count = 0;; ++count) {
        while (is_blank(*text)) ++text;
        if (is_line_end(*text)) {
            if (count < fewest) return nullptr;
            result = {numbers[0], numbers[1], numbers[2]};
            return after_line_end(text);
        }
        if (count == most) return nullptr;
        text = read_simple_number(text, end, numbers[static_cast<std::size_t>(count)]);
        if (text == nullptr || !(is_blank(*text) || is_line_end(*text))) return nullptr;
    }
}

/// Reads an index from 1, or backwards from -1, into a list of that size, as one from 0. Returns where it ends, or null
/// when there is none, or nothing there.
inline const char* read_usual_index(const char* text, std::size_t size, std::uint32_t& result) {
    const bool backwards = *text == '-';
    if (backwards) ++text;
    std::size_t number = 0;
    const char* const begin = text;
    for (; *text >= '0' && *text <= '9' && text - begin < 10; ++text)
        number = 10 * number + static_cast<std::size_t>(*text - '0');
    if (number == 0 || number > size) return nullptr;
    result = static_cast<std::uint32_t>(backwards ? size - number : number - 1);
    return text;
}

}  // namespace lightswitch::detail
