// As "planted bugs are found" of verify_test.cpp, for mistakes about surfaces.

#include <lightswitch/verify/verify.hpp>

#include "verify/planted/catalogue.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;

// Every bug must be found, within a fixed number of samples; false alarms are not asked for here.
TEST_CASE("planted bugs about surfaces are found, at the right path length") {
    for (const auto& bug : test::surface_bugs()) {
        const auto [wrong, right] = bug.make();
        const Verdict verdict = verify(wrong, right, {.seconds = 0, .tolerance = 0, .images = 1500, .samples = 8});
        INFO(bug.name, ": ", verdict);
        CHECK(verdict.disagrees());
        CHECK(verdict.first_wrong_length == bug.first_length);
    }
}
