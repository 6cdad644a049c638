#pragma once

// Files that a test writes for a loader to read.

#include "support/folder.hpp"

#include <lightswitch/core/error.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace lightswitch::test {

/// The message of the `Error` that `function` throws; fails the test when it throws none.
template <class F>
std::string message_of(const F& function) {
    try {
        function();
    } catch (const Error& error) {
        const std::string message = error.what();
        CHECK_MESSAGE(message.find('\n') == std::string::npos, message);
        return message;
    }
    return "no error";
}

/// A message must contain this; doctest then shows both.
inline bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// Deterministic changes to a text: cuts, flipped bits, inserted and repeated pieces.
inline std::string mutated(std::string text, std::uint32_t seed) {
    std::minstd_rand random(seed + 1);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % std::max<std::size_t>(n, 1); };
    static constexpr std::string_view pieces[] = {
        "\"",           "<",   ">",    "/", "-1", "1e999", "nan", "$",   "&lol;", " ",   "\n",
        "999999999999", "<a>", "\xff", "0", "\\", "//",    "--",  "]]>", "<!--",  "ref", "end_header\n"};
    for (std::size_t change = 0, count = 1 + below(2); change < count && !text.empty(); ++change) {
        const std::size_t at = below(text.size());
        switch (below(12)) {
            case 0: text.resize(at); break;
            case 1:
            case 2: text[at] = static_cast<char>(text[at] ^ (1 << below(8))); break;
            case 3: text.insert(at, pieces[below(std::size(pieces))]); break;
            case 4: text.erase(at, below(20)); break;
            case 5: text.insert(at, text.substr(below(text.size()), below(60))); break;
            case 6: text[at] = static_cast<char>(below(256)); break;
            default: text[at] = static_cast<char>('0' + below(10)); break;
        }
    }
    return text;
}

}  // namespace lightswitch::test
