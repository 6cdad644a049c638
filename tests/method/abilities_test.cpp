// What the methods say that they cannot make (`PathClasses`): a scene for each class, and for what all can make; all
// methods in each. And the tables of README and docs/methods.md say the same.

#include "support/paths.hpp"

#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/stock.hpp>

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

using namespace lightswitch;

namespace {

/// A glass sphere above a white floor, lit from above.
LibraryDescription describe_glass_sphere() {
    LibraryDescription scene;
    scene.add(quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}), scene.add(Lambert{Rgb(0.8f)}));
    scene.add(Sphere{{0, 1, 0}, 0.5}, scene.add(Dielectric{.eta = 1.5f}));
    scene.add(PointSource{{0, 3, 0}, Rgb(10)});
    scene.camera.fov = 6;
    scene.film.width = scene.film.height = 16;
    return scene;
}

/// Looking at `target` from `eye`.
void look(LibraryDescription& scene, const DVec3& eye, const DVec3& target) {
    scene.camera.to_world = CameraDescription::look_at(eye, target, {0, 1, 0});
}

/// From above, beside the sphere.
void look_at_floor(LibraryDescription& scene) {
    look(scene, {1.8, 2, 0}, {1.8, 0, 0.1});
    scene.camera.fov = 50;
}

/// The image's mean by every method that shows light, over that of `reference`. Fixed seeds: the same numbers on every
/// run.
std::map<std::string_view, double> shares(const LibraryDescription& description, std::string_view reference,
                                          int samples) {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(description);
    std::map<std::string_view, double> means;
    for_each_method([&](auto method) {
        if (method.kind == Kind::heuristic) return;
        Session session(scene, method);
        session.run({.samples = samples});
        CHECK(session.statistics().counts.non_finite == 0);
        const DVec3 mean = session.image().mean();
        means[method.name] = mean.x + mean.y + mean.z;
    });
    REQUIRE(means[reference] > 0);
    const double whole = means[reference];
    for (auto& [name, mean] : means) mean /= whole;
    return means;
}

/// Those that make the paths of `member` (what a scene shows; null: what all methods make) show it all, within
/// `tolerance`; the others hardly any of it.
void check_who_shows(const std::map<std::string_view, double>& shares, bool PathClasses::*member, double tolerance) {
    REQUIRE(shares.size() == 8);
    for_each_method([&]<class M>(const M&) {
        if (M::kind == Kind::heuristic) return;
        CAPTURE(M::name);
        const double share = shares.at(M::name);
        if (member && cannot_make<M>().*member)
            CHECK(share < 0.3);  // what comes by other ways than the one that is asked for
        else CHECK(std::abs(share - 1) < tolerance);
    });
}

}  // namespace

TEST_CASE("abilities: the caustic of a point light on a diffuse surface") {
    LibraryDescription scene = describe_glass_sphere();
    look(scene, {2, 0.35, 0}, {0, 0, 0});  // below the sphere, where no light comes but through it
    check_who_shows(shares(scene, "vcm", 256), &PathClasses::dirac_caustic, 0.1);
}

TEST_CASE("abilities: the caustic of a point light, seen in a mirror") {
    LibraryDescription scene = describe_glass_sphere();
    scene.add(quad({2, 0, -1}, {2, 0, 1}, {2, 1, 1}, {2, 1, -1}), scene.add(TwoSided<Conductor>{}));
    look(scene, {1, 0.35, 0}, {4, 0, 0});  // the mirror image of the place below the sphere
    check_who_shows(shares(scene, "vcm", 256), &PathClasses::mirrored_dirac_caustic, 0.1);
}

TEST_CASE("abilities: a diffuse surface under a point light") {
    LibraryDescription scene = describe_glass_sphere();
    look_at_floor(scene);
    check_who_shows(shares(scene, "path-nee", 512), &PathClasses::dirac_light, 0.04);
}

TEST_CASE("abilities: a diffuse surface under a sky") {
    LibraryDescription scene = describe_glass_sphere();
    scene.sources.clear();
    scene.add(EnvironmentSource{Rgb(1)});
    look_at_floor(scene);
    check_who_shows(shares(scene, "path-nee", 512), nullptr, 0.04);
}

TEST_CASE("abilities: a lamp's reflection in rough metal") {
    LibraryDescription scene;
    scene.add(quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}),
              scene.add(RoughConductor{.distribution = Facets::ggx, .alpha_u = 0.15f, .alpha_v = 0.15f}));
    scene.add(quad({-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}), scene.add(Lambert{Rgb(0)}),
              Rgb(10));
    scene.camera.fov = 20;
    scene.film.width = scene.film.height = 16;
    look(scene, {1.5, 2, 0}, {0.75, 0, 0});
    check_who_shows(shares(scene, "path-nee", 128), nullptr, 0.05);
}

TEST_CASE("abilities: a diffuse surface seen in a mirror") {
    LibraryDescription scene;
    scene.add(quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}), scene.add(Lambert{Rgb(0.8f)}));
    scene.add(quad({2, 0, -1}, {2, 0, 1}, {2, 1, 1}, {2, 1, -1}), scene.add(TwoSided<Conductor>{}));
    scene.add(quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}), scene.add(Lambert{Rgb(0)}), Rgb(1));
    scene.camera.fov = 6;
    scene.film.width = scene.film.height = 16;
    look(scene, {1, 0.6, 0}, {4, 0, 0});
    check_who_shows(shares(scene, "path-nee", 512), &PathClasses::mirrored, 0.05);
}

TEST_CASE("abilities: the table in the docs says what the methods say") {
    std::ifstream file(test::folder() + "/../docs/methods.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    REQUIRE(
        text.find("| method | caustic | caustic in a mirror | point light | sky | rough metal | seen in a mirror |") !=
        std::string::npos);
    for_each_method([&]<class M>(const M&) {
        if (M::kind == Kind::heuristic) return;
        const PathClasses no = cannot_make<M>();
        std::string row = "\n| `" + std::string(M::name) + "` |";
        for (const bool cannot :
             {no.dirac_caustic, no.mirrored_dirac_caustic, no.dirac_light, false, false, no.mirrored})
            row += cannot ? " no |" : " yes |";
        CHECK_MESSAGE(text.find(row + "\n") != std::string::npos, row);
    });
}
