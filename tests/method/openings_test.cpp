// Textures, environment maps, spots and cameras against Mitsuba 3.9.1: tests/data/openings.

#include "method/reference.hpp"
#include "support/paths.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/vcm.hpp>
#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/scene_file.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

LibraryDescription load(const std::string& name) {
    return load_mitsuba(test::folder() + "/data/openings/" + name + ".xml");
}

constexpr int mitsuba_samples = 8192;
constexpr Effort effort{.samples = 64, .bias = 0.005};

template <class M>
M limited(int depth) {
    M method;
    method.max_depth = depth;
    method.rr_depth = 100;
    return method;
}

}  // namespace

TEST_CASE("openings: textures on every shape, a principal point that is off and a cropped film look as in Mitsuba") {
    const auto textures =
        reference(build_scene<TexturedBsdfs, AllLights>(load("textures")), mitsuba_samples, "openings");
    check_reference(textures, limited<PathTracerNee>(5), effort);
    check_reference(textures, limited<Bdpt>(5), effort);
}

TEST_CASE("openings: a turned environment map looks as in Mitsuba") {
    const auto sky = reference(build_scene<AllBsdfs, AllLights>(load("sky")), mitsuba_samples, "openings");
    check_reference(sky, limited<PathTracerNee>(6), effort);
    check_reference(sky, limited<Bdpt>(6), effort);
}

TEST_CASE("openings: a spot seen by an orthographic camera looks as in Mitsuba") {
    const auto spot = reference(build_scene<AllBsdfs, AllLights>(load("spot")), mitsuba_samples, "openings");
    check_reference(spot, limited<PathTracerNee>(5), effort);
    check_reference(spot, limited<LightTracer>(5), effort);
    check_reference(spot, limited<Bdpt>(5), effort);
}

#endif
