#pragma once

// The rows of `extremes` about surfaces, skies, cameras and films.

#include "extremes_rows.hpp"

#include <memory>

namespace extremes {

/// A ball of one material in a white furnace, which must show 1 where nothing is lost.
inline Row& add_furnace(Rows& rows, const char* what, double at, const ls::AnyMaterial& material) {
    const auto scene = [=] {
        LibraryDescription furnace = under_sky({0, 1, 4}, 28);
        furnace.add(ls::Sphere{}, furnace.add(material));
        return furnace;
    };
    return rows.add(what, at, scene, 1).within(1e-3).without("light photon");
}

/// All walls of a closed box shine with 1 - albedo, so that each shows 1, after 1 / (1 - albedo) bounces on average.
inline LibraryDescription shining_box(double albedo) {
    LibraryDescription scene = under_sky({0, 0, 0.5}, 60);
    scene.sources.clear();
    scene.add(ls::cube().flipped(), scene.add(ls::Lambert{Rgb(float(albedo))}), Rgb(1 - float(albedo)));
    return scene;
}

inline void add_surfaces(Rows& rows) {
    for (const float albedo : {0.0f, 1.0f})
        rows.add(
                "albedo of a box in a white sky", double(albedo),
                [=] {
                    LibraryDescription scene = under_sky({3, 4, 5}, 8);
                    scene.add(ls::cube(), scene.add(ls::Lambert{Rgb(albedo)}));
                    return scene;
                },
                double(albedo))
            .without("light photon");
    for (const double albedo : {0.9, 0.99, 0.999})
        rows.add(
                "albedo of a closed box that shines with the rest", albedo, [=] { return shining_box(albedo); }, 1)
            .within(1e-3)
            .without(albedo > 0.99 ? "bdpt photon vcm mlt" : "");
    const auto mirrors = [] {
        LibraryDescription scene = under_sky({0.5, 0.2, 0.9}, 40);
        const std::size_t mirror = scene.add(ls::TwoSided<ls::Conductor>{});
        for (const double z : {-1., 1.}) scene.add(ls::quad({-3, -3, z}, {3, -3, z}, {3, 3, z}, {-3, 3, z}), mirror);
        return scene;
    };
    rows.add("white mirrors that face each other in a white sky", "2", mirrors, 1).without("light");
    using ls::Facets, ls::RoughConductor, ls::RoughDielectric, ls::Dielectric;
    for (const float alpha : {1e-6f, 1e-4f, 1e-2f}) {
        add_furnace(rows, "roughness of white metal", double(alpha),
                    RoughConductor{.distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha})
            .between(0.995, 1);
        add_furnace(rows, "roughness of glass", double(alpha),
                    RoughDielectric{.distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha})
            .between(0.99, 1);
    }
    // What such facets lose to each other is in the table of docs/conventions.md.
    add_furnace(rows, "roughness of white metal", 1,
                RoughConductor{.distribution = Facets::beckmann, .alpha_u = 1, .alpha_v = 1})
        .between(0.6, 1);
    add_furnace(rows, "roughness of white metal in one direction, 1e-4 in the other", 1,
                RoughConductor{.distribution = Facets::ggx, .alpha_u = 1e-4f, .alpha_v = 1})
        .between(0.6, 1);
    for (const float eta : {1.0f, 1.5f, 100.0f})
        add_furnace(rows, "index of glass", double(eta), Dielectric{.eta = eta});
    for (const float more : {1e-6f, -1e-6f})
        add_furnace(rows, "index of glass, less 1", double(more), Dielectric{.eta = 1 + more});
    for (const double angle : {1e-2, 1e-4, 1e-6})
        for (const bool glass : {false, true})
            rows.add(
                    glass ? "a pane seen at that angle" : "a grey floor seen at that angle, in radians", angle,
                    [=] {
                        LibraryDescription scene = under_sky({0, angle, 1}, 0.1 * glm::degrees(angle));
                        const ls::AnyMaterial pane = ls::ThinDielectric{}, grey = ls::Lambert{Rgb(0.5f)};
                        scene.add(floor_of(2), scene.add(glass ? pane : grey));
                        return scene;
                    },
                    glass ? 1 : 0.5)
                .without("light photon");
    for (const int needles : {1000, 1000000})
        rows.add(
                "a grey floor of needles, length by width", needles,
                [=] {
                    // 1000 of them side by side where the camera looks, and what is left in two large pieces.
                    LibraryDescription scene = under_sky({0, 0.5, 0.1}, 20);
                    ls::Mesh mesh;
                    const auto add = [&](double from, double to) {
                        ls::stock::detail::add_quad(mesh, {from, 0, 1}, {to, 0, 1}, {to, 0, -1}, {from, 0, -1});
                    };
                    const double width = 2.0 / needles;
                    add(-1, -500 * width);
                    for (int i = -500; i < 500; ++i) add(i * width, (i + 1) * width);
                    add(500 * width, 1);
                    scene.add(mesh, add_grey(scene));
                    return scene;
                },
                0.5)
            .without("light photon");
    for (const bool turned : {false, true})
        rows.add(
                "a grey floor twice in the same place", turned ? "other diagonal" : "same corners",
                [=] {
                    LibraryDescription scene = under_sky({0, 2, 1}, 20);
                    const std::size_t grey = add_grey(scene);
                    scene.add(floor_of(1), grey);
                    if (turned) scene.add(ls::quad({1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {-1, 0, 1}), grey);
                    else scene.add(floor_of(1), grey);
                    return scene;
                },
                0.5)
            .without("light");
}

/// One bright texel of a sky that is black otherwise.
struct Texel {
    const char* what;
    int width, height, column, row;
    float value = 1;

    MakeScene over_floor() const {
        return [texel = *this] {
            std::vector<Rgb> texels(std::size_t(texel.width) * std::size_t(texel.height), Rgb(0));
            texels[std::size_t(texel.row) * std::size_t(texel.width) + std::size_t(texel.column)] = Rgb(texel.value);
            LibraryDescription scene = floor_alone();
            scene.add(ls::Source(ls::EnvironmentMapSource{
                std::make_shared<const ls::EnvironmentMap>(std::move(texels), texel.width, texel.height)}));
            return scene;
        };
    }
    /// Between rows and columns values are linear in the angles, so that a texel is a tent of two cells each way.
    double mean() const {
        constexpr int steps = 4000;
        const double row_angle = std::numbers::pi / (height - 1);
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double at = row - 1 + 2 * (i + 0.5) / steps, theta = at * row_angle;
            if (theta > 0 && theta < std::numbers::pi / 2)
                sum += (1 - std::abs(at - row)) * std::sin(theta) * std::cos(theta) * 2 / steps;
        }
        return 0.5 * double(value) * sum * row_angle * 2 / width;
    }
};

inline void add_skies(Rows& rows) {
    for (const Texel& texel : {Texel{"somewhere", 64, 33, 20, 9}, Texel{"at the seam", 64, 33, 0, 9},
                               Texel{"beyond the seam, of 1e10", 64, 33, 63, 9, 1e10f},
                               Texel{"of 1e10, the sky 32768 wide", 32768, 17, 12345, 5, 1e10f},
                               Texel{"of 1e10, the sky 16385 high", 17, 16385, 3, 4000, 1e10f}})
        rows.add("one texel of a sky over a floor", texel.what, texel.over_floor(), texel.mean())
            .within(1e-3)
            .without("path light");
    rows.add("one texel of a sky over a floor", "of a sky of 1 x 1", Texel{"", 1, 1, 0, 0}.over_floor(), 0.5)
        .without("light");
    rows.add("a black sky over a floor", "64 x 33", Texel{"", 64, 33, 0, 0, 0}.over_floor(), 0);
}

/// Grey as far as one sees.
inline LibraryDescription plain(double fov, double height) {
    LibraryDescription scene = under_sky({0, height, 0.001 * height}, fov);
    scene.add(floor_of(1e4), add_grey(scene));
    return scene;
}

inline void add_cameras(Rows& rows) {
    const char* starved = "light photon";
    for (const double fov : {1e-3, 0.1, 90., 170.})
        rows.add(
                "field of view down to a grey plain, degrees", fov, [=] { return plain(fov, 1); }, 0.5)
            .within(1e-3)
            .without(starved);
    const auto white = [] {
        LibraryDescription scene = under_sky({0, 0, 5}, 179.9);
        scene.add(ls::Sphere{}, scene.add(ls::Lambert{Rgb(1)}));
        return scene;
    };
    rows.add("field of view of a white sky and ball, degrees", 179.9, white, 1).without(starved);
    for (const double height : {1e-6, 1e-3})
        rows.add(
                "height of a camera over a grey plain, 2e4 wide", height, [=] { return plain(40, height); }, 0.5)
            .within(1e-3)
            .without(starved);
    for (const double half : {1e-6, 1e-3, 0.5})
        rows.add(
                "half width of an orthographic camera over the plain", half,
                [=] {
                    LibraryDescription scene = plain(40, 1);
                    scene.camera.projection = ls::CameraDescription::Projection::orthographic;
                    scene.camera.half_width = half;
                    return scene;
                },
                0.5)
            .within(1e-3)
            .without(starved);
    for (const double far : {1e3, 1e6, 1e9})
        rows.add(
                "distance of a camera from a grey ball", far,
                [=] {
                    LibraryDescription scene = under_sky({0, 0, far}, glm::degrees(1 / far));
                    scene.add(ls::Sphere{}, add_grey(scene));
                    return scene;
                },
                0.5)
            .within(1e-3)
            .without(starved);
    // The camera sees next to nothing but the middle of the floor.
    const DVec3 lamp(0.2, 1.5, 0);
    const double middle = 0.5 * 0.25 / glm::dot(lamp, lamp) * lamp.y / glm::length(lamp);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 8192), std::pair(8192, 1)})
        rows.add(
                "film over a lit floor", short_text(width) + " x " + short_text(height),
                [=, width = width, height = height] {
                    LibraryDescription scene = LampBall{lamp, 0.5}.over_floor()();
                    scene.camera.fov_axis = ls::CameraDescription::FovAxis::larger;
                    scene.camera.fov = 0.5;
                    scene.film.width = width;
                    scene.film.height = height;
                    return scene;
                },
                middle)
            .within(1e-3)
            .without(starved);
}

}  // namespace extremes
