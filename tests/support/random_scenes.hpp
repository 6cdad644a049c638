#pragma once

// Small random scenes that hold everything a scene can hold.

#include "support/chi_square.hpp"

#include <lightswitch/scene/stock.hpp>

namespace lightswitch::test {

/// A floor and a few objects of random materials under random lights, all of them so large that a path tracer finds
/// them. The camera is anywhere, also inside of things. 16 x 16 pixels.
inline LibraryDescription random_scene(std::uint32_t seed) {
    Random random(seed);
    const auto number = [&](double low, double high) { return low + (high - low) * double(random.next()); };
    const auto below = [&](int n) { return static_cast<int>(random.next() * static_cast<float>(n)); };
    const auto color = [&](double low, double high) {
        return Rgb(DVec3(number(low, high), number(low, high), number(low, high)));
    };
    const auto rough = [&] {
        const auto alpha = float(number(0.15, 0.6));
        return RoughConductor{.distribution = Facets::ggx,
                              .alpha_u = alpha,
                              .alpha_v = alpha,
                              .eta = color(0.1, 2),
                              .k = color(1, 4),
                              .reflectance = color(0.5, 1)};
    };

    LibraryDescription scene;
    scene.name = "random-" + std::to_string(seed);
    const auto material = [&]() -> std::size_t {
        switch (below(8)) {
            case 0: return scene.add(Dielectric{.eta = float(number(1.2, 1.8))});
            case 1: return scene.add(Conductor{.reflectance = color(0.5, 1)});
            case 2: return scene.add(TwoSided<Conductor>{{.eta = color(0.1, 2), .k = color(1, 4)}});
            case 3: return scene.add(rough());
            case 4: return scene.add(TwoSided<RoughConductor>{rough()});
            case 5: return scene.add(Lambert{color(0.1, 0.9)});
            default: return scene.add(TwoSided<Lambert>{{color(0.1, 0.9)}});
        }
    };

    scene.add(quad({-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}), scene.add(Lambert{color(0.3, 0.8)}));
    const auto place = [&](double size) {
        // Any linear map with a positive determinant, and a translation.
        DMat4 m(1);
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) m[c][r] = size * ((c == r ? 1 : 0) + number(-0.4, 0.4));
        m[3] = glm::dvec4(number(-1.5, 1.5), number(-0.6, 0.8), number(-1.5, 1.5), 1);
        return m;
    };
    for (int i = 0; i < 3; ++i) {
        const std::size_t bsdf = material();
        switch (below(3)) {
            case 0:
                scene.add(Sphere{{number(-1.5, 1.5), number(-0.6, 0.6), number(-1.5, 1.5)}, number(0.3, 0.8)}, bsdf);
                break;
            case 1: scene.add(cube(place(0.5)), bsdf); break;
            default: scene.add(stock::torus_knot(60, 8, 0.2).transformed(place(0.7)), bsdf); break;  // smooth normals
        }
    }

    const int kinds = 1 + below(7);  // bits: environment, sphere, rectangle
    if (kinds & 1) scene.add(EnvironmentSource{color(0.3, 1)});
    if (kinds & 2)
        scene.add(Sphere{{number(-2, 2), number(1.2, 2), number(-2, 2)}, number(0.5, 0.9)},
                  scene.add(Lambert{color(0, 0.8)}), color(1, 5));
    if (kinds & 4)
        scene.add(quad({-1.5, 2.5, -1.5}, {1.5, 2.5, -1.5}, {1.5, number(2, 2.5), 1.5}, {-1.5, 2.5, 1.5}),
                  scene.add(TwoSided<Lambert>{{color(0, 0.8)}}), color(1, 5));

    const double angle = number(0, 6.28), distance = below(4) == 0 ? 0.3 : number(2.5, 4);
    scene.camera.to_world = CameraDescription::look_at(
        {distance * std::cos(angle), number(-0.2, 1.5), distance * std::sin(angle)}, {0, -0.2, 0}, {0, 1, 0});
    scene.camera.fov = number(35, 70);
    if (below(4) == 0) {
        scene.camera.aperture_radius = 0.1;
        scene.camera.focus_distance = distance;
    }
    const Filter filters[] = {Filter::box(), Filter::tent(), Filter::gaussian()};
    scene.film.filter = filters[below(3)];
    scene.film.width = scene.film.height = 16;
    return scene;
}

}  // namespace lightswitch::test
