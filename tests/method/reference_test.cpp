// Against converged images of another renderer. False alarm: 1e-3 for each line. The bounds of the bias are those that
// a short render can prove; the long test has 0.2 % for all.

#include "method/reference.hpp"

using namespace lightswitch::test;
using enum lightswitch::Sampling;

TEST_CASE("path tracing with next event estimation agrees with the reference on the Cornell box") {
    const auto reference = cornell_box();
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = sobol, .bias = 0.002});
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = independent, .bias = 0.002});
}

TEST_CASE("path tracing with next event estimation agrees with the reference on glass and mirror") {
    const auto reference = cornell_spheres();
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = sobol, .bias = 0.005});
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = independent, .bias = 0.005});
}

TEST_CASE("path tracing with next event estimation agrees with the reference on rough plates") {
    const auto reference = veach_mis();
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = sobol, .bias = 0.015});
    check_reference(reference, lightswitch::PathTracerNee{}, {.sampling = independent, .bias = 0.02});
}

TEST_CASE("path tracing agrees with the reference on the Cornell boxes") {
    check_reference(cornell_box(), lightswitch::PathTracer{}, {.bias = 0.015, .join = 2});
    check_reference(cornell_spheres(), lightswitch::PathTracer{}, {.bias = 0.015, .join = 2});
}
