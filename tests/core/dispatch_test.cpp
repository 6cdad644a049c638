#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/core/maybe.hpp>

#include <doctest/doctest.h>

#include <string>
#include <utility>

using namespace lightswitch;

TEST_CASE("dispatch: the alternative is that of the index, and its result comes back as it is") {
    const auto chosen = [](std::size_t index) {
        return dispatch<12>(index, [](auto i) { return static_cast<std::size_t>(i); });
    };
    for (std::size_t index = 0; index < 12; ++index) CHECK(chosen(index) == index);
    CHECK(dispatch<1>(0, [](auto i) { return static_cast<std::size_t>(i); }) == 0);

    int values[3] = {0, 0, 0};
    int& second = dispatch<3>(1, [&](auto i) -> int& { return values[i]; });
    second = 7;
    CHECK(values[1] == 7);

    int calls = 0;
    dispatch<5>(4, [&](auto) { ++calls; });
    CHECK(calls == 1);
    // The index is a constant expression for the callee.
    CHECK(dispatch<3>(2, [](auto i) { return std::string(i + 1, 'x'); }) == "xxx");
}

TEST_CASE("dispatch: positions of types in a list") {
    static_assert(index_of<int, int, float>() == 0);
    static_assert(index_of<float, int, float>() == 1);
    static_assert(index_of<char, int, float>() == 2);
    static_assert(index_of<int>() == 0);
    static_assert(is_one_of<float, int, float> && !is_one_of<char, int, float> && !is_one_of<int>);
    static_assert(!is_one_of<const int, int>);
}

TEST_CASE("typed index: the limits, and empty") {
    CHECK_FALSE(static_cast<bool>(TypedIndex{}));
    for (const std::size_t kind : {std::size_t{0}, std::size_t{1}, std::size_t{17}, TypedIndex::max_kind})
        for (const std::size_t position :
             {std::size_t{0}, std::size_t{1}, std::size_t{99999}, TypedIndex::max_position}) {
            const TypedIndex index(kind, position);
            CHECK(static_cast<bool>(index));
            CHECK(index.kind() == kind);
            CHECK(index.position() == position);
        }
    static_assert(sizeof(TypedIndex) == 4);
}

TEST_CASE("maybe: a value or nothing") {
    Maybe<int> nothing;
    CHECK_FALSE(nothing.has_value());
    CHECK_FALSE(static_cast<bool>(nothing));
    CHECK(*nothing == 0);
    nothing.emplace() = 3;
    CHECK(nothing.has_value());
    CHECK(*nothing == 3);
    const Maybe<std::string> text = std::string("light");
    CHECK(text->size() == 5);
    const Maybe<int> from_braces = [] { return Maybe<int>{}; }();
    CHECK_FALSE(from_braces.has_value());
}
