// As surfaces_test.cpp, with more scenes, and the methods that connect and those that make Markov chains. Bounds for
// photons are in surfaces_test.cpp: they blur. Light tracing alone has outliers behind rough glass that no number of
// images here would show; bdpt holds its paths.

#include "method/bidirectional.hpp"
#include "method/surfaces.hpp"

#include <lightswitch/method/mlt.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

TEST_CASE("surfaces: bdpt, vcm and mlt agree with path tracing on random ones, for every path length") {
    const SurfacesCase many{.first_seed = 101,
                            .scenes = 12,
                            .depths = {2, 3, 4, 6},
                            .methods = 3,
                            .rr_depth = 3,
                            .nee_samples = 512,
                            .sampling = Sampling::sobol};
    check_on_random_surfaces(many, [](int depth, const auto& check) {
        check(Bdpt{.max_depth = depth, .rr_depth = 3}, 128);
        check(connections_only(depth, 3), 128);
        check(Mlt{.max_depth = depth}, 256);
    });
}
