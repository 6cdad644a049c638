// All surface models, layers over them, and instances, against Mitsuba 3.9.1: tests/data/surfaces; and methods against
// each other on random scenes of them.

#include "method/surfaces.hpp"
#include "method/reference.hpp"
#include "support/paths.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/photon_mapping.hpp>
#include <lightswitch/method/vcm.hpp>
#include <lightswitch/scene/any_scene.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/scene_file.hpp>

// False alarm: 1e-3 for the tiles of each comparison. Where Mitsuba is not exact (its fits of Beckmann's masking and of
// what plastic reflects inside, up to 0.4 % of a tile), the tiles are compared at the noise of fewer samples.

namespace {

constexpr int mitsuba_samples = 8192;

auto surfaces(const std::string& name) {
    return reference(
        build_scene<TexturedBsdfs, AllLights>(load_mitsuba(test::folder() + "/data/surfaces/" + name + ".xml")),
        mitsuba_samples, "surfaces");
}

void check_both(const std::string& name, int depth, const Effort& effort) {
    const auto scene = surfaces(name);
    check_reference(scene, PathTracerNee{.max_depth = depth, .rr_depth = 100}, effort);
    check_reference(scene, Bdpt{.max_depth = depth, .rr_depth = 100}, effort);
}

}  // namespace

TEST_CASE("surfaces: metals look as in Mitsuba") { check_both("metals", 8, {.samples = 16, .bias = 0.01}); }
TEST_CASE("surfaces: plastics look as in Mitsuba") { check_both("plastics", 8, {.samples = 16, .bias = 0.005}); }
TEST_CASE("surfaces: smooth, rough and thin glass look as in Mitsuba") {
    check_both("glass", 8, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: principled models look as in Mitsuba") {
    check_both("principled", 8, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: blends, masks, bump and normal maps, two sides look as in Mitsuba") {
    check_both("layers", 50, {.samples = 16, .bias = 0.01});
}
TEST_CASE("surfaces: instances and a textured lamp look as in Mitsuba") {
    check_both("instances", 6, {.samples = 16, .bias = 0.01});
}

#endif

TEST_CASE("surfaces: methods agree on random ones, for every path length") {
    const SurfacesCase few{.first_seed = 1,
                           .scenes = 4,
                           .depths = {2, 3, 5},
                           .methods = 2,
                           .rr_depth = 1,
                           .nee_samples = 64,
                           .sampling = Sampling::independent};
    check_on_random_surfaces(few, [](int depth, const auto& check) {
        check(PathTracer{.max_depth = depth}, 128);
        check(Bdpt{.max_depth = depth, .rr_depth = 1}, 32);
    });
}

// Photons are left, and gathered, where layers are by chance. Two floors that fill the image, so that nothing is
// blurred but by the corners that are out of view; bounds of 1 %. False alarm: 1e-3 in all.
TEST_CASE("surfaces: photons see layers that decide by chance, and coats, as paths do") {
    const auto make = [](const auto& material) {
        LibraryDescription scene;
        scene.add(quad({-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}), material(scene));
        scene.add(quad({-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}), scene.add(Lambert{{0.6f, 0.5f, 0.3f}}));
        scene.add(Sphere{{0, 6, 0}, 1.5}, scene.add(Lambert{Rgb(0)}), Rgb(9, 8, 7));
        scene.camera.to_world = CameraDescription::look_at({0, 3, 0.5}, {0, 0, 0}, {0, 0, -1});
        scene.camera.fov = 40;
        scene.film.width = scene.film.height = 16;
        return build_scene<TexturedBsdfs, AllLights>(scene);
    };
    const auto two_sided = [](LibraryDescription& scene, const Rgb& reflectance) {
        return scene.add(TwoSided<Lambert>{{reflectance}});
    };
    const std::pair<const char*, TexturedScene> scenes[] = {
        {"mask", make([&](auto& s) {
             return s.add(Mask{two_sided(s, Rgb(0.8f)), Texture(Rgb(0.4f))});
         })},
        {"blend with a mirror", make([&](auto& s) {
             return s.add(Blend{two_sided(s, Rgb(0.8f)), s.add(Conductor{}), Texture(Rgb(0.5f))});
         })},
        {"mask in a blend", make([&](auto& s) {
             const std::size_t mask = s.add(Mask{two_sided(s, Rgb(0.2f)), Texture(Rgb(0.5f))});
             return s.add(Blend{two_sided(s, Rgb(0.8f)), mask, Texture(Rgb(0.7f))});
         })},
        {"plastic", make([&](auto& s) { return s.add(Plastic{.eta = 2}); })},
        {"coat", make([&](auto& s) {
             return s.add(Coating{s.add(Lambert{Rgb(0.8f)}), {.eta = 2, .sigma_a = {0, 0.1f, 0.2f}}});
         })},
        {"rough coat", make([&](auto& s) {
             return s.add(Coating{s.add(Lambert{Rgb(0.8f)}), {.sigma_a = {0, 0.1f, 0.2f}, .alpha = 0.4f}});
         })}};
    constexpr int comparisons = 4 * static_cast<int>(std::size(scenes));
    for (const auto& [name, scene] : scenes) {
        const Estimate truth = replicate(scene, PathTracerNee{.max_depth = 4}, 8, 8, 256).whole[1];
        const auto check = [&](const std::string& what, const auto& method, int samples) {
            const Estimate ours = replicate(scene, method, 8, 8, samples, Sampling::sobol, 7001).whole[1];
            const double p = welch_p(ours, truth, 0.01 * truth.mean);
            CHECK_MESSAGE(p > sidak(1e-3, comparisons), std::string(name), ", ", what, ": p ", p, ", ",
                          BiasInterval(ours, truth));
        };
        const MergeRadius radius{.pixels = 0.5f};
        check("photon", PhotonMapping{.max_depth = 4, .paths_per_pixel = 16, .radius = radius}, 128);
        check("gathering", PhotonMapping{.max_depth = 4, .paths_per_pixel = 4, .radius = radius, .final_gather = true},
              64);
        check("vcm", Vcm{.max_depth = 4, .radius = radius}, 96);
        if (!scene.has_specular()) check("light", LightTracer{.max_depth = 4}, 96);
    }
}
