// Against converged images of another renderer, without next event estimation. False alarm: 1e-3 for each line.

#include "method/reference.hpp"

using namespace lightswitch::test;

TEST_CASE("path tracing agrees with the reference to 0.2 % on the Cornell box") {
    check_reference(cornell_box(), lightswitch::PathTracer{}, {.replicas = 32, .samples = 128});
}

TEST_CASE("path tracing agrees with the reference to 0.2 % on glass and mirror") {
    check_reference(cornell_spheres(), lightswitch::PathTracer{}, {.replicas = 32, .samples = 128});
}

// Here the lights are so small that single samples decide: a path that happens to meet one counts up to 900, and one in
// 10^4 does. Tiles of 64 x 64 pixels and 32 replicas of 256 samples gather some hundred of them in each value, close
// enough to normal; 0.2 % would take an hour.
TEST_CASE("path tracing agrees with the reference on rough plates as far as it gets") {
    check_reference(veach_mis(), lightswitch::PathTracer{}, {.replicas = 32, .samples = 256, .bias = 0.006, .join = 4});
}
