#include "support/errors.hpp"

#include <lightswitch/compare/difference.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace lightswitch;
using lightswitch::test::message_of;

TEST_CASE("difference: signed and absolute, per channel and pixel") {
    Image a(2, 1), b(2, 1);
    a(0, 0) = Rgb(1, 2, 3);
    b(0, 0) = Rgb(3, 2, 1);
    b(1, 0) = Rgb(-1, infinity, 0.5f);
    CHECK(difference(a, b)(0, 0) == Rgb(-2, 0, 2));
    CHECK(difference(a, b)(1, 0) == Rgb(1, -infinity, -0.5f));
    CHECK(absolute_difference(a, b)(0, 0) == Rgb(2, 0, 2));
    CHECK(absolute_difference(a, b)(1, 0) == Rgb(1, infinity, 0.5f));
}

TEST_CASE("difference: keeps the metadata that both share") {
    Image a(1, 1), b(1, 1);
    a.metadata = {{"scene", "room"}, {"method", "pt"}, {"seed", "1"}};
    b.metadata = {{"scene", "room"}, {"method", "bdpt"}};
    CHECK(difference(a, b).metadata == Image::Metadata{{"scene", "room"}});
}

TEST_CASE("difference: refuses images that do not show the same thing, and says why") {
    const Image a(4, 3);
    CHECK(message_of([&] { difference(a, Image(3, 4)); }) ==
          "images of different size cannot be compared: 4 x 3 and 3 x 4 pixels");
    CHECK(message_of([&] { absolute_difference(a, Image()); }) ==
          "images of different size cannot be compared: 4 x 3 and 0 x 0 pixels");
    CHECK(message_of([&] { difference(Image(), Image()); }) == "images without pixels cannot be compared");

    for (const std::string key : {"scene", "camera", "size"}) {
        Image left(4, 3), right(4, 3);
        left.metadata[key] = "one";
        CHECK_NOTHROW(refuse_unless_comparable(left, right));  // only one of them says
        right.metadata[key] = "one";
        CHECK_NOTHROW(refuse_unless_comparable(left, right));
        right.metadata[key] = "two";
        const std::string expected = "images with a different " + key + " cannot be compared: 'one' and 'two'";
        CHECK(message_of([&] { refuse_unless_comparable(left, right); }) == expected);
        CHECK(message_of([&] { difference(left, right); }) == expected);
        CHECK(message_of([&] { absolute_difference(left, right); }) == expected);
    }
    Image left(4, 3), right(4, 3);
    left.metadata["method"] = "pt";
    right.metadata["method"] = "bdpt";
    CHECK_NOTHROW(refuse_unless_comparable(left, right));
}
