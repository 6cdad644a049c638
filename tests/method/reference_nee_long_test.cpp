// Against converged images of another renderer, to 0.2 %. False alarm: 1e-3 for each line.

#include "method/reference.hpp"

using namespace lightswitch::test;
using enum lightswitch::Sampling;

TEST_CASE("path tracing with next event estimation agrees with the reference to 0.2 % on the Cornell box") {
    const auto reference = cornell_box();
    check_reference(reference, lightswitch::PathTracerNee{}, {.replicas = 32, .samples = 16, .sampling = sobol});
    check_reference(reference, lightswitch::PathTracerNee{}, {.replicas = 32, .samples = 16, .sampling = independent});
}

TEST_CASE("path tracing with next event estimation agrees with the reference to 0.2 % on glass and mirror") {
    const auto reference = cornell_spheres();
    check_reference(reference, lightswitch::PathTracerNee{}, {.replicas = 32, .samples = 32, .sampling = sobol});
    check_reference(reference, lightswitch::PathTracerNee{}, {.replicas = 32, .samples = 32, .sampling = independent});
}

TEST_CASE("path tracing with next event estimation agrees with the reference to 0.2 % on rough plates") {
    const auto reference = veach_mis();
    check_reference(reference, lightswitch::PathTracerNee{}, {.replicas = 64, .samples = 64, .sampling = sobol});
    // Independent samples would need four times as many for the same bound.
    check_reference(reference, lightswitch::PathTracerNee{},
                    {.replicas = 32, .samples = 32, .sampling = independent, .bias = 0.006});
}
