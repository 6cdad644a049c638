// Photon mapping and vertex merging: right where theory knows the image, close to it elsewhere.

#include "../support/relative.hpp"
#include "nearly.hpp"

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// The relative bias of the whole image, green channel, with all the noise of both sides: 99.9 % confidence.
template <class SceneType, class M>
BiasInterval bias(const SceneType& scene, const M& method, const Estimate& truth, int replicas, int samples) {
    return {replicate_finite(scene, method, 8, replicas, samples).whole[1], truth, 0.999};
}

}  // namespace

// On a sphere the surface within a chord r has the area pi r^2 exactly. What is lost are photons that arrive from below
// the horizon of the place where they are gathered: less than (1 - cos(r)) / 2 of them, 0.4 % for the radius of 0.12 of
// here. Noise: intervals of 99.9 %, 1e-3 for each of 20.
TEST_CASE("photons: a furnace sphere is a geometric series, for every limit of the path length") {
    constexpr float albedo = 0.6f;
    const auto scene = build_scene<Bsdfs<Lambert>, Lights<SphereLight>>(scenes::furnace_sphere(albedo));
    const double a = double(albedo);
    for (const int depth : {1, 2, 3, -1}) {
        const Estimate truth{depth < 0 ? 1 / (1 - a) : (1 - std::pow(a, depth)) / (1 - a), 0};
        const auto check = [&](const std::string& what, const auto& method) {
            const BiasInterval b = bias(scene, method, truth, 8, 32);
            CHECK_MESSAGE(b.within(0.02), what, ", depth ", depth, ": ", b);
        };
        check("photon", PhotonMapping{.max_depth = depth});
        check("photon, final gathering", PhotonMapping{.max_depth = depth, .rr_depth = 1, .final_gather = true});
        check("photon, more of them",
              PhotonMapping{.max_depth = depth, .paths_per_pixel = 2.5, .radius = {.pixels = 1, .alpha = 0.9f}});
        check("vcm", Vcm{.max_depth = depth});
        check("vcm, wide", Vcm{.max_depth = depth, .rr_depth = 1, .radius = {.pixels = 2}});
    }
}

// As above: on the outside the same.
TEST_CASE("photons: a white sphere vanishes before a white sky") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::white_sphere_in_white());
    const BiasInterval photon = bias(scene, PhotonMapping{}, {1, 0}, 8, 1024);
    CHECK_MESSAGE(photon.within(0.015), photon);
    const BiasInterval gather = bias(scene, PhotonMapping{.final_gather = true}, {1, 0}, 8, 32);
    CHECK_MESSAGE(gather.within(0.005), gather);
    const BiasInterval vcm = bias(scene, Vcm{}, {1, 0}, 8, 64);
    CHECK_MESSAGE(vcm.within(0.005), vcm);
}

// False alarm: 1e-3.
TEST_CASE("photons: close to bidirectional path tracing") {
    const TransportCase cases[] = {{"cornell-spheres", scenes::on_small_film(stock::describe_cornell_spheres()), false},
                                   {"stage under all", scenes::stage_under_all()},
                                   {"light in mirror", scenes::light_in_mirror()}};
    for (const TransportCase& c : cases) check_nearly_bdpt(c, 3, 6, 96, 1e-3, static_cast<int>(std::size(cases)));
}

// A floor under glass, lit by a point above the glass and seen from there: no connection is possible, so that merging
// has all the weight, and both methods gather the same photons within the same radius. False alarm: 1e-3.
TEST_CASE("photons: where nothing can be connected, vcm is photon mapping") {
    LibraryDescription description;
    description.add(quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}), description.add(Lambert{{0.5f, 0.6f, 0.7f}}));
    description.add(cube(DMat4({3, 0, 0, 0}, {0, 0.1, 0, 0}, {0, 0, 3, 0}, {0, 0.3, 0, 1})),
                    description.add(Dielectric{.eta = 1.5f}));
    description.add(PointSource{{0.1, 1.2, 0.2}, Rgb(1)});
    description.camera.to_world = CameraDescription::look_at({0, 3, 0.5}, {0, 0, 0}, {0, 0, -1});
    description.camera.fov = 35;
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(description));
    for (const int depth : {6, -1}) {
        const MergeRadius radius{.pixels = 1.5f};
        const auto vcm = replicate_finite(scene, Vcm{.max_depth = depth, .radius = radius}, 8, 8, 192, 1);
        const auto photon = replicate_finite(scene, PhotonMapping{.max_depth = depth, .radius = radius}, 8, 8, 192, 11);
        const Comparison comparison = compare(vcm, photon, 1e-3, 2);
        CHECK_MESSAGE(comparison.agree(), "depth ", depth, ": ", comparison);
        CHECK(photon.whole[1].mean > 0.01);
        // Were it not, connections would see it.
        CHECK(render(scene, connections_only(depth), {.samples = 16}).mean() == DVec3(0));
    }
}

TEST_CASE("photons: the radius shrinks by the law of Knaus and Zwicker, and starts as wide as a pixel") {
    const MergeRadius radius{.pixels = 3, .alpha = 0.75f};
    CHECK(double(radius.at(0, 0.5)) == relative(1.5, 1e-5));
    for (const std::uint64_t n : {2u, 16u, 1000u})
        CHECK(std::pow(double(radius.at(n - 1, 0.5)) / 1.5, 2) == relative(std::pow(double(n), -0.25), 1e-5));

    // A wall across the view at distance 2, where the middle of the pixels is 2 * 2 tan(30 degrees) / 16 wide, in scene
    // units. Across the ray they are smaller by the root of the cosine, which is 0.91 at the median distance from the
    // axis.
    LibraryDescription description;
    description.add(quad({-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}), description.add(Lambert{}), Rgb(1));
    scenes::look(description, {0, 0, 0}, {0, 0, -1}, 60);
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(description));
    const double width = 4 * std::tan(std::numbers::pi / 6) / 16;
    CHECK(pixel_footprint(scene) == relative(std::sqrt(0.908) * double(scene.length(width)), 2e-3));
    LibraryDescription empty;
    CHECK(pixel_footprint(build_scene<AllBsdfs, AllLights>(scenes::on_small_film(empty))) > 0);
}

TEST_CASE("photons: counts and statistics") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    const PhotonMapping photon{.max_depth = 3, .paths_per_pixel = 4};
    Session<FullScene, PhotonMapping> session(scene, photon);
    session.run({.samples = 8});
    const RenderStatistics& statistics = session.statistics();
    CHECK(statistics.counts.paths == 8 * 4 * 256);
    CHECK(statistics.counts.splats == 0);
    const auto of = [](const RenderStatistics& s, std::string_view name) {
        for (const auto& [key, value] : s.of_method)
            if (key == name) return value;
        return -1.0;
    };
    // The sphere is closed, so that every path leaves one photon where it meets it for the second time.
    CHECK(of(statistics, "photons") == 4 * 256);
    CHECK(of(statistics, "photon_map_bytes") > 4 * 256 * 12);
    CHECK(of(statistics, "radius_pixels") == relative(4 * std::pow(8.0, -1.0 / 6), 1e-4));

    const Vcm vcm{.max_depth = 3};
    Session<FullScene, Vcm> merging(scene, vcm);
    merging.run({.samples = 2});
    CHECK(merging.statistics().counts.paths == 2 * 256);
    CHECK(merging.statistics().counts.splats > 2 * 32);
    CHECK(of(merging.statistics(), "light_vertices") > 256);
    CHECK(of(merging.statistics(), "light_vertices") <= 2 * 256);
    CHECK(of(merging.statistics(), "radius_pixels") == relative(std::pow(2.0, -1.0 / 6), 1e-4));
}
