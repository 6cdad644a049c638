#include "verify_lamps.hpp"

#include "verify/planted/scenes.hpp"

#include <lightswitch/lightswitch.hpp>

#include <string>

namespace lightswitch::test {

namespace {

Mesh wall(const DVec3& corner, const DVec3& along, double height) {
    return quad(corner, corner + along, corner + along + DVec3(0, height, 0), corner + DVec3(0, height, 0));
}

/// A grey floor of 1.6 x 1.6 seen from above; nothing shines yet.
LibraryDescription floor_from_above() {
    auto scene = empty_view<AnyMaterial>("floor-from-above", {0, 2, 0.01}, {0, 0, 0}, 45);
    scene.add(level({0, 0, 0}, 0.8, 0.8), scene.add(Lambert{Rgb(0.5f)}));
    return scene;
}

/// A point lamp close above the floor, off the middle: a spot as small as its height.
LibraryDescription lamp_above_floor(double height) {
    auto scene = floor_from_above();
    scene.add(PointSource{{0.013, height, 0.007}, Rgb(1)});
    return scene;
}

/// A point lamp in the corner of three walls, that far from each.
LibraryDescription lamp_in_corner(double distance) {
    auto scene = empty_view<AnyMaterial>("lamp-in-corner", {1.6, 1.4, 1.6}, {0.2, 0.2, 0.2}, 45);
    const std::size_t grey = scene.add(TwoSided<Lambert>{{Rgb(0.5f)}});
    scene.add(level({0.5, 0, 0.5}, 0.5, 0.5), grey);
    scene.add(wall({0, 0, 0}, {1, 0, 0}, 1), grey);
    scene.add(wall({0, 0, 0}, {0, 0, 1}, 1), grey);
    scene.add(PointSource{DVec3(distance), Rgb(1)});
    return scene;
}

/// Glass on a floor, or around the lamp.
LibraryDescription with_glass(LibraryDescription scene, const DVec3& center, double radius) {
    scene.add(Sphere{center, radius}, scene.add(Dielectric{}));
    return scene;
}

LibraryDescription sun_through_glass() {
    auto scene = with_glass(floor_from_above(), {0.1, 0.4, 0}, 0.25);
    scene.add(DirectionalSource{{-0.3, -1, 0.1}, Rgb(2)});
    return scene;
}

LibraryDescription with_mirror(LibraryDescription scene) {
    scene.add(wall({-0.8, 0, -0.5}, {1.6, 0, 0}, 0.6), scene.add(TwoSided<Conductor>{{.reflectance = Rgb(0.9f)}}));
    return scene;
}

/// A lamp of a millionth of the scene's size, as powerful as a point of intensity 1.
LibraryDescription tiny_lamp(bool round, double height) {
    auto scene = floor_from_above();
    constexpr double half = 1e-6;
    const std::size_t black = scene.add(Lambert{Rgb(0)});
    if (round)
        scene.add(Sphere{{0.013, height, 0.007}, half}, black, Rgb(static_cast<float>(1 / (3.14159 * half * half))));
    else
        scene.add(level({0.013, height, 0.007}, half, half, false), black,
                  Rgb(static_cast<float>(1 / (4 * half * half))));
    return scene;
}

template <class M>
void add(std::vector<CorrectPair>& pairs, std::string_view scene, const std::function<LibraryDescription()>& describe,
         M method) {
    pairs.push_back({M::name, scene, [=] {
                         const auto built =
                             std::make_shared<const FullScene>(build_scene<AllBsdfs, AllLights>(describe()));
                         return std::pair(estimator(built, method), estimator(built, Bdpt{}));
                     }});
}

}  // namespace

std::vector<CorrectPair> lamp_pairs() {
    std::vector<CorrectPair> pairs;
    const auto all = [&](std::string_view scene, const std::function<LibraryDescription()>& describe) {
        add(pairs, scene, describe, PathTracerNee{});
        add(pairs, scene, describe, LightTracer{});
        add(pairs, scene, describe, PhotonMapping{});
        add(pairs, scene, describe, Vcm{});
        add(pairs, scene, describe, Mlt{.bootstrap = 2048});
    };
    all("point lamp 1 above a floor", [] { return lamp_above_floor(1); });
    all("point lamp 0.1 above a floor", [] { return lamp_above_floor(0.1); });
    all("point lamp 0.01 above a floor", [] { return lamp_above_floor(0.01); });
    all("point lamp 1e-3 above a floor", [] { return lamp_above_floor(1e-3); });
    all("point lamp 1e-4 above a floor", [] { return lamp_above_floor(1e-4); });
    all("point lamp 0.2 from a corner", [] { return lamp_in_corner(0.2); });
    all("point lamp 0.01 from a corner", [] { return lamp_in_corner(0.01); });
    all("point lamp 1e-4 from a corner", [] { return lamp_in_corner(1e-4); });
    all("point lamp in a glass ball", [] { return with_glass(lamp_above_floor(0.4), {0, 0.4, 0}, 0.2); });
    all("point lamp above a glass ball", [] { return with_glass(lamp_above_floor(0.9), {0, 0.3, 0}, 0.2); });
    all("sun through a glass ball", sun_through_glass);
    all("point lamp before a mirror", [] { return with_mirror(lamp_above_floor(0.1)); });
    all("lamp of 1e-6", [] { return tiny_lamp(false, 0.5); });
    all("round lamp of 1e-6", [] { return tiny_lamp(true, 0.5); });
    all("lamp of 1e-6, 1e-3 above a floor", [] { return tiny_lamp(false, 1e-3); });
    all("lamp of 1e-6 before a mirror", [] { return with_mirror(tiny_lamp(false, 0.5)); });
    all("cornell-box", small_box);
    all("glass and mirror in a box", [] {
        LibraryDescription scene = stock::describe_cornell_spheres();
        scene.film.width = scene.film.height = 16;
        return scene;
    });
    return pairs;
}

}  // namespace lightswitch::test
