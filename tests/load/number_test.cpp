#include <lightswitch/load/number.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cstdio>
#include <random>

using namespace lightswitch;
using namespace lightswitch::detail;

namespace {

/// Both readers must agree: to the last bit, and in what is no number.
bool agree(std::string_view word) {
    const auto exact = parse_number(word), fast = parse_number_fast(word);
    if (exact.has_value() != fast.has_value()) return false;
    return !exact || std::bit_cast<std::uint64_t>(*exact) == std::bit_cast<std::uint64_t>(*fast);
}

}  // namespace

TEST_CASE("numbers are read fast and to the last bit") {
    for (const char* word : {"0",
                             "-0",
                             "1.",
                             ".5",
                             "-.5e1",
                             "123456789012345678901234567890",
                             "0.1234567890123456789012",
                             "9007199254740991",
                             "9007199254740993",
                             "9007199254740993e1",
                             "1e22",
                             "1e23",
                             "1e-22",
                             "1e-23",
                             "1E+2",
                             "5e-324",
                             "1e308",
                             "1e309",
                             "0e999",
                             "00000000000000000000001.5",
                             "8.5e00010",
                             "18446744073709551617",
                             "99999999999999999999",
                             "0.000000000000000000001"})
        CHECK_MESSAGE(agree(word), word);
    for (const char* word :
         {"",     "-",     "+",         ".",       "-.", "e5", "1e",  "1e+", "1e-", "--1",
          "1..2", "1.2.3", "1-",        "0x10",    "1 ", " 1", "1,5", "nan", "inf", "1e99999999999999999999",
          "\xff", "1\xff", "12345678/", "1234567:"})
        CHECK_MESSAGE(agree(word), word);
}

TEST_CASE("numbers at random are read to the last bit, wherever they stand") {
    std::mt19937_64 random(1);
    const auto below = [&](std::uint64_t n) { return random() % n; };
    int wrong = 0;
    for (int i = 0; i < 300000; ++i) {
        char text[64];
        const double any = std::bit_cast<double>(random());
        const double usual = static_cast<double>(static_cast<std::int64_t>(random())) / 1e15;
        const double value = below(4) == 0 ? any : usual;
        const auto digits = static_cast<int>(below(20));
        static constexpr const char* formats[] = {"%.*g", "%.*e", "%.*f"};
        const char* const format = formats[below(std::abs(value) < 1e20 ? 3 : 2)];
        std::snprintf(text, sizeof text, format, digits, value);
        std::string word = text;
        if (below(8) == 0 && !word.empty()) word[below(word.size())] = static_cast<char>(below(256));
        // What follows the word must not be looked at, even if it is more of a number.
        const std::string line = word + "12345678";
        wrong += !agree(std::string_view(line).substr(0, word.size()));
    }
    CHECK(wrong == 0);
}

TEST_CASE("integers are read up to 18 digits") {
    const auto read = [](std::string_view text) -> std::pair<std::uint64_t, std::ptrdiff_t> {
        std::uint64_t value = 0;
        const char* const end = read_simple_integer(text.data(), text.data() + text.size(), value);
        if (end == nullptr) return {0, -1};
        return {value, end - text.data()};
    };
    using Result = std::pair<std::uint64_t, std::ptrdiff_t>;
    CHECK(read("") == Result{0, -1});
    CHECK(read("x") == Result{0, -1});
    CHECK(read("-1") == Result{0, -1});
    CHECK(read("0 1") == Result{0, 1});
    CHECK(read("12345678") == Result{12345678, 8});
    CHECK(read("123456789/2") == Result{123456789, 9});
    CHECK(read(std::string_view("1234567890").substr(0, 2)) == Result{12, 2});
    CHECK(read(std::string_view("1234567890").substr(0, 9)) == Result{123456789, 9});
    CHECK(read("999999999999999999") == Result{999999999999999999u, 18});
    CHECK(read("1000000000000000000") == Result{0, -1});
    CHECK(read("18446744073709551617") == Result{0, -1});
    for (std::uint64_t i = 0, value = 1; i < 18; ++i, value = value * 10 + i % 10)
        CHECK(read(std::to_string(value)) == Result{value, static_cast<std::ptrdiff_t>(i + 1)});
}
