// Numbers with many digits, rounded, and pieces of large text files.

#include "load/files.hpp"

#include <lightswitch/load/number.hpp>
#include <lightswitch/load/text_file.hpp>

#include <bit>
#include <optional>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// What `read_simple_number` makes of all of the text, if it does.
std::optional<double> quick(const std::string& text) {
    double value = 0;
    const char* const last = text.data() + text.size();
    if (detail::read_simple_number(text.data(), last, value) != last) return {};
    return value;
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

TEST_CASE("numbers that are read fast are those that the standard library reads, to the bit") {
    std::minstd_rand random(1);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random()) % n; };
    const auto digits = [&](unsigned count, bool zeros) {
        std::string text;
        for (unsigned i = 0; i < count; ++i) text += zeros && 2 * i < count ? '0' : static_cast<char>('0' + below(10));
        return text;
    };
    int read = 0;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
        std::string text = below(3) == 0 ? "-" : "";
        text += digits(below(below(2) ? 3 : 20), false);
        if (below(4)) text += "." + digits(below(22), below(4) == 0);
        if (below(4) == 0) text += (below(2) ? "e" : "E-") + std::to_string(below(30));
        const auto number = quick(text);
        if (!number) continue;
        ++read;
        const auto exact = detail::parse_number(text);
        REQUIRE_MESSAGE(exact, text);
        REQUIRE_MESSAGE(same(*number, *exact), text);
    }
    CHECK(read > count / 2);
}

TEST_CASE("numbers halfway between two doubles, or nearly, are rounded as they must be") {
    int read = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const std::uint64_t integer = (std::uint64_t(1) << 53) + 2 * i * i * 1234567 + 1;
        for (const char* rest : {"", ".0", ".1", ".001", "e0", "0e-1"}) {
            const std::string text = std::to_string(integer) + rest;
            if (const auto number = quick(text)) {
                ++read;
                REQUIRE_MESSAGE(same(*number, *detail::parse_number(text)), text);
            }
        }
    }
    CHECK(read > 11000);
    CHECK(*quick("9007199254740993") == 9007199254740992);  // 2^53 + 1: to the even one
    CHECK(*quick("9007199254740993.1") == 9007199254740994);
    CHECK(same(*quick("-0"), -0.0));
}

TEST_CASE("what is no number, or one with too many digits, is left to others") {
    for (const char* text : {"", "+", "-", ".", "-.", "e5", "1e", "1e+", "+-1", "--1", "nan", "inf", "0x10",
                             "12345678901234567890", "1e999", "1e99999999999", "1e-400"})
        CHECK_MESSAGE(!quick(text), text);
    CHECK(*quick("00000000000000000000000000012.5") == 12.5);
    CHECK(*quick("1.") == 1);
    CHECK(*quick(".5e1") == 5);
}

TEST_CASE("pieces of a text file are whole statements, and all of it") {
    const Folder folder;
    const std::string texts[] = {"",
                                 "\n",
                                 "v 1\nv 2\n",
                                 "a\r\nb\r\n\r\nc",
                                 "a\rb\r\rc\r",
                                 "v \\\n 1 \\\r\n 2 \\ \t\n 3\nv 4",
                                 "\\\r\r\\\r\n\n\\\n",
                                 std::string(300, 'x') + "\n" + std::string(5, '\n') + "y",
                                 "\r\n\n\r\r\n\\\r\n\r\n",
                                 std::string("a\0b\nc", 5)};
    for (const std::string& text : texts)
        for (std::size_t piece = 1; piece < 40; ++piece) {
            const auto path = folder.write("text", text);
            detail::TextFile file(path, 1000, piece);
            std::string all;
            for (std::string_view part = file.next(); !part.empty(); part = file.next()) {
                all += part;
                if (all.size() == text.size()) {
                    CHECK(part.data()[part.size()] == '\0');
                    continue;
                }
                REQUIRE(detail::is_line_end(all.back()));
                CHECK(!(all.back() == '\r' && text[all.size()] == '\n'));
                // One end of a line, then blanks, then no backslash.
                std::string_view line = all;
                line.remove_suffix(line.ends_with("\r\n") ? 2 : 1);
                line = line.substr(0, line.find_last_not_of(" \t") + 1);
                CHECK(!line.ends_with('\\'));
            }
            CHECK(all == text);
        }
    CHECK(contains(message_of([&] { detail::TextFile(folder.write("text", "12345"), 4); }), "at most 4 are read"));
}
