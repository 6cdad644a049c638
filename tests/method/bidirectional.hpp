#pragma once

// Scenes that bidirectional methods can get wrong, and the comparison of those methods with path tracing on them.

#include "support/random_scenes.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/vcm.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace lightswitch::test {

/// Vertex connection alone, which must be bidirectional path tracing by another road.
inline Vcm connections_only(int max_depth, int rr_depth = 5) {
    return {.max_depth = max_depth, .rr_depth = rr_depth, .radius = {.pixels = 0}};
}

/// A scene on a film of 16 x 16 pixels, and what can be asked on it.
struct TransportCase {
    std::string name;
    LibraryDescription description;
    bool light_tracer =
        true;          ///< every path that carries light leaves a surface towards the camera that is not specular
    int samples = 16;  ///< of each replica
};

namespace scenes {

inline LibraryDescription on_small_film(LibraryDescription scene) {
    scene.film.width = scene.film.height = 16;
    return scene;
}

inline void look(LibraryDescription& scene, const DVec3& eye, const DVec3& target, double fov) {
    scene.camera.to_world = CameraDescription::look_at(eye, target, {0, 1, 0});
    scene.camera.fov = fov;
}

/// The camera is in a sphere that shines and reflects: every pixel is a geometric series, as in a furnace.
inline LibraryDescription furnace_sphere(float albedo) {
    LibraryDescription scene;
    scene.add(Sphere{.inward = true}, scene.add(Lambert{Rgb(albedo)}), Rgb(1));
    look(scene, {0.3, 0.2, 0.5}, {0, 0, -1}, 50);
    return on_small_film(scene);
}

/// A diffuse sphere around everything, so that the geometry between two of its points never exceeds a bound (between
/// walls that touch it has no variance), without any light.
inline LibraryDescription hollow_sphere() {
    LibraryDescription scene;
    scene.add(Sphere{.inward = true}, scene.add(Lambert{{0.8f, 0.6f, 0.4f}}));
    look(scene, {0.1, -0.3, 0.6}, {0, 0.1, -1}, 80);
    return on_small_film(scene);
}

/// With a luminous rectangle under the top that reflects, too, and a smaller one at the side.
inline LibraryDescription lamp_in_sphere() {
    LibraryDescription scene = hollow_sphere();
    scene.add(quad({-0.6, -0.2, 0.2}, {-0.6, -0.2, -0.2}, {-0.6, 0.2, -0.2}, {-0.6, 0.2, 0.2}),
              scene.add(Lambert{Rgb(0.5f)}), Rgb(9, 6, 3));
    scene.add(quad({-0.4, 0.6, -0.5}, {0.4, 0.6, -0.5}, {0.4, 0.7, 0.1}, {-0.4, 0.7, 0.1}),
              scene.add(Lambert{Rgb(0.5f)}), Rgb(5, 6, 7));
    return scene;
}

inline LibraryDescription point_in_sphere() {
    LibraryDescription scene = hollow_sphere();
    scene.add(PointSource{{-0.2, 0.3, -0.1}, Rgb(1, 2, 3)});
    return scene;
}

inline LibraryDescription point_in_box() {
    LibraryDescription scene;
    scene.add(cube().flipped(), scene.add(Lambert{{0.7f, 0.5f, 0.3f}}));
    scene.add(PointSource{{0.2, 0.5, -0.4}, Rgb(1)});
    look(scene, {-0.2, 0, 0.9}, {0.1, 0, -1}, 70);
    return on_small_film(scene);
}

/// A sphere of reflectance 1 before a sky of radiance 1: nothing can be seen.
inline LibraryDescription white_sphere_in_white() {
    LibraryDescription scene;
    scene.add(Sphere{}, scene.add(Lambert{Rgb(1)}));
    scene.add(EnvironmentSource{});
    look(scene, {0, 0, 4}, {0, 0, 0}, 34);
    return on_small_film(scene);
}

/// A floor and a few things that do not touch, from above and aside.
inline LibraryDescription stage() {
    LibraryDescription scene;
    scene.add(quad({-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}), scene.add(Lambert{{0.5f, 0.6f, 0.7f}}));
    scene.add(Sphere{{0.7, 0, 0.2}, 0.6}, scene.add(Lambert{{0.8f, 0.6f, 0.5f}}));
    scene.add(cube(DMat4({0.4, 0, 0.2, 0}, {0, 0.5, 0, 0}, {-0.2, 0, 0.4, 0}, {-0.9, -0.2, -0.3, 1})),
              scene.add(Lambert{{0.4f, 0.7f, 0.4f}}));
    look(scene, {0.5, 1.5, 4}, {0, -0.3, 0}, 45);
    return on_small_film(scene);
}

inline LibraryDescription stage_under_sky() {
    LibraryDescription scene = stage();
    scene.add(EnvironmentSource{{0.6f, 0.8f, 1}});
    return scene;
}

inline LibraryDescription stage_under_sun() {
    LibraryDescription scene = stage();
    scene.add(DirectionalSource{{-1, -2, -0.5}, Rgb(2)});
    return scene;
}

/// Lamps of every kind at once, of very different power.
inline LibraryDescription stage_under_all() {
    LibraryDescription scene = stage();
    scene.add(EnvironmentSource{Rgb(0.8f)});
    scene.add(DirectionalSource{{1, -2, -0.5}, {1, 0.5f, 0.5f}});
    scene.add(PointSource{{-0.5, 1.6, 1.2}, {0.5f, 1, 2}});
    scene.add(Sphere{{1.6, 1.6, -0.5}, 0.4}, scene.add(Lambert{Rgb(0.2f)}), Rgb(3));
    scene.add(quad({-2, 1.5, -1}, {-1, 1.5, -1}, {-1, 1.6, 0}, {-2, 1.6, 0}), scene.add(Lambert{Rgb(0)}), Rgb(4, 3, 2));
    return scene;
}

/// 200 small lamps, the strongest a thousand times as bright as the weakest.
inline LibraryDescription many_lights() {
    LibraryDescription scene = stage();
    const std::size_t grey = scene.add(Lambert{Rgb(0.3f)});
    Random random(17);
    for (int i = 0; i < 200; ++i) {
        const double x = -3 + 0.3 * (i % 20), z = -3 + 0.6 * (i / 20), s = 0.05;
        const float strength = 10 * std::pow(10.0f, 3 * random.next() - 2);
        if (i % 2 == 0)
            scene.add(quad({x, 2, z}, {x + s, 2, z}, {x + s, 2, z + s}, {x, 2, z + s}), grey,
                      Rgb(strength, 10, 10 - strength * 0.09f));
        else scene.add(Sphere{{x, 2, z}, s / 2}, grey, Rgb(strength));
    }
    return scene;
}

/// 240 lamps of every kind, scattered in a room without a ceiling under a sky, with a floor of rough metal and a ball
/// of rough glass.
inline LibraryDescription scattered_lamps() {
    LibraryDescription scene;
    const std::size_t grey = scene.add(TwoSided<Lambert>{{{0.6f, 0.5f, 0.4f}}}), black = scene.add(Lambert{Rgb(0)});
    const RoughConductor metal{.alpha_u = 0.3f, .alpha_v = 0.3f};
    scene.add(quad({-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}), scene.add(TwoSided<RoughConductor>{metal}));
    scene.add(quad({-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}), grey);
    scene.add(quad({-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}), grey);
    scene.add(Sphere{{0.3, -0.6, -0.2}, 0.3}, scene.add(RoughDielectric{.alpha_u = 0.4f, .alpha_v = 0.4f}));
    scene.add(EnvironmentSource{Rgb(0.05f, 0.1f, 0.2f)});
    Random random(23);
    for (int i = 0; i < 240; ++i) {
        const DVec3 at(1.4 * double(random.next()) - 0.7, 0.1 + 0.7 * double(random.next()),
                       1.4 * double(random.next()) - 0.7);
        const DVec3 axis(uniform_sphere(random.next_2d()));
        const float strength = std::pow(10.0f, 2 * random.next() - 1);
        const DVec3 u = 0.03 * glm::normalize(glm::cross(axis, DVec3(0.3, 0.5, 0.8))), v = glm::cross(axis, u);
        if (i % 4 == 0) scene.add(quad(at - u - v, at + u - v, at + u + v, at - u + v), black, Rgb(strength));
        if (i % 4 == 1) scene.add(Sphere{at, 0.02}, black, Rgb(strength, 1, 1));
        if (i % 4 == 2) scene.add(PointSource{at, Rgb(0.002f, 0.002f, 0.002f * strength)});
        if (i % 4 == 3)
            scene.add(
                SpotSource{.position = at, .direction = axis, .intensity = Rgb(0.005f * strength), .cutoff_angle = 40});
    }
    look(scene, {0.3, 0, 3.4}, {0, -0.25, 0}, 38);
    return on_small_film(scene);
}

/// Interpolated normals far from the true ones under light that grazes: a coarse tube and a ball of 80 triangles.
inline LibraryDescription smooth_normals() {
    LibraryDescription scene;
    const std::size_t white = scene.add(Lambert{Rgb(0.8f)});
    scene.add(stock::torus_knot(40, 5, 0.25)
                  .transformed(DMat4({0.9, 0, 0, 0}, {0, 0.9, 0, 0}, {0, 0, 0.9, 0}, {-0.9, 0, 0, 1})),
              white);
    Mesh ball;
    constexpr int around = 8, rings = 5;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / around;
            const DVec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            ball.positions.push_back(DVec3(1.4, 0, 0) + 0.9 * n);
            ball.normals.push_back(n);
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const std::uint32_t a = i * around + j, b = i * around + (j + 1) % around;
            if (i > 0) ball.triangles.push_back({a, b, b + around});
            if (i + 1 < rings) ball.triangles.push_back({a, b + around, a + around});
        }
    scene.add(ball, white);
    scene.add(quad({-4, -1.3, 3}, {4, -1.3, 3}, {4, -1.3, -3}, {-4, -1.3, -3}), white);
    // Light from the side: much of what is lit is lit at grazing angles.
    scene.add(quad({-5, -1, -1.5}, {-5, 1, -1.5}, {-5, 1, 1.5}, {-5, -1, 1.5}), white, Rgb(8));
    look(scene, {0.3, 0.8, 5}, {0.2, -0.2, 0}, 45);
    return on_small_film(scene);
}

/// The same where a sun grazes.
inline LibraryDescription smooth_normals_in_sun() {
    LibraryDescription scene = smooth_normals();
    scene.shapes.pop_back();
    scene.add(DirectionalSource{{1, -0.15, -0.3}, Rgb(2)});
    return scene;
}

/// A single luminous triangle that also reflects, alone.
inline LibraryDescription luminous_triangle() {
    LibraryDescription scene;
    scene.add(Mesh{.positions = {{-1, -1, 0}, {1, -0.8, 0.1}, {0.2, 1, -0.2}}, .normals = {}, .triangles = {{0, 1, 2}}},
              scene.add(Lambert{Rgb(0.7f)}), Rgb(1, 2, 3));
    look(scene, {0.3, 0.2, 3}, {0, 0, 0}, 45);
    return on_small_film(scene);
}

inline LibraryDescription triangle_under_sky() {
    LibraryDescription scene = luminous_triangle();
    scene.shapes[0].emission.reset();
    scene.add(EnvironmentSource{Rgb(1, 2, 3)});
    return scene;
}

/// A lamp whose front only a mirror sees: the floor is lit by the mirror alone. The camera sees neither of the two.
inline LibraryDescription light_in_mirror() {
    LibraryDescription scene;
    scene.add(quad({-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}), scene.add(Lambert{{0.7f, 0.6f, 0.5f}}));
    scene.add(quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}), scene.add(Conductor{.reflectance = Rgb(0.9f)}));
    scene.add(quad({-0.7, 2, 0.7}, {0.7, 2, 0.7}, {0.7, 2, -0.7}, {-0.7, 2, -0.7}), scene.add(Lambert{Rgb(0)}), Rgb(5));
    look(scene, {0, 1, 4}, {0, -1, 0}, 40);
    return on_small_film(scene);
}

/// A ball in a larger one of glass, with the camera between the two, which sees nothing else: light is refracted once
/// on its way to what it sees, and so gains what radiance gains in glass.
inline LibraryDescription camera_in_glass() {
    LibraryDescription scene;
    scene.add(Sphere{{0, 0, 0}, 2}, scene.add(Dielectric{.eta = 1.5f}));
    scene.add(Sphere{{0, 0, -0.5}, 0.7}, scene.add(Lambert{Rgb(0.8f)}));
    scene.add(Sphere{{0, 1, 5}, 2}, scene.add(Lambert{Rgb(0)}), Rgb(5));
    look(scene, {0, 0, 1.4}, {0, 0, -0.5}, 24);
    return on_small_film(scene);
}

/// Rough metal, and rough metal seen in rough metal.
inline LibraryDescription rough_metals() {
    LibraryDescription scene = stage();
    scene.materials[1].bsdf = RoughConductor{.distribution = Facets::ggx,
                                             .alpha_u = 0.3f,
                                             .alpha_v = 0.3f,
                                             .eta = Rgb(0.2f, 0.9f, 1.1f),
                                             .k = Rgb(3.9f, 2.5f, 2.2f)};
    scene.materials[2].bsdf = RoughConductor{.distribution = Facets::ggx, .alpha_u = 0.5f, .alpha_v = 0.5f};
    scene.add(quad({-1.5, 2, -1}, {1.5, 2, -1}, {1.5, 2, 1}, {-1.5, 2, 1}), scene.add(Lambert{Rgb(0.3f)}), Rgb(4));
    return scene;
}

inline LibraryDescription lens() {
    LibraryDescription scene = on_small_film(stock::describe_cornell_box());
    scene.camera.aperture_radius = 0.3;
    scene.camera.focus_distance = 3.2;
    return scene;
}

/// So far that rays start at the scene's bounding sphere.
inline LibraryDescription far_camera() {
    LibraryDescription scene = stage_under_all();
    look(scene, {50, 150, 400}, {0, -0.3, 0}, 0.45);
    return scene;
}

/// Clipping planes cut through the blocks.
inline LibraryDescription clipped() {
    LibraryDescription scene = stage_under_all();
    scene.camera.near_clip = 4.0;
    scene.camera.far_clip = 5.2;
    return scene;
}

inline LibraryDescription clipped_lens() {
    LibraryDescription scene = clipped();
    scene.camera.aperture_radius = 0.2;
    scene.camera.focus_distance = 4.5;
    return scene;
}

/// Bright and dark side by side, and light that goes on beyond the edge of the film.
inline LibraryDescription filtered(const Filter& filter) {
    LibraryDescription scene = stage_under_all();
    scene.film.filter = filter;
    return scene;
}

}  // namespace scenes

/// All cases but those whose image is known.
inline std::vector<TransportCase> transport_cases() {
    using namespace scenes;
    return {{"cornell-box", on_small_film(stock::describe_cornell_box())},
            {"cornell-spheres", on_small_film(stock::describe_cornell_spheres()), false},
            {"veach-mis", on_small_film(describe_veach_mis()), false},
            {"lamp in sphere", lamp_in_sphere()},
            {"point in box", point_in_box()},
            {"point in sphere", point_in_sphere()},
            {"stage under sky", stage_under_sky()},
            {"stage under sun", stage_under_sun()},
            {"stage under all", stage_under_all()},
            {"many lights", many_lights()},
            {"smooth normals", smooth_normals(), true, 64},
            {"smooth normals in sun", smooth_normals_in_sun(), true, 32},
            {"luminous triangle", luminous_triangle()},
            {"triangle under sky", triangle_under_sky()},
            {"light in mirror", light_in_mirror()},
            {"camera in glass", camera_in_glass(), true, 96},
            {"rough metals", rough_metals()},
            {"lens", lens()},
            {"far camera", far_camera()},
            {"clipped", clipped()},
            {"clipped lens", clipped_lens()},
            {"tent", filtered(Filter::tent(1.5f))},
            {"gaussian", filtered(Filter::gaussian())}};
}

/// `replicate` that also sees to it that all is finite.
template <class SceneType, class M>
TileEstimates replicate_finite(const SceneType& scene, const M& method, int side, int replicas, int samples,
                               std::uint64_t seed = 1, Sampling sampling = Sampling::sobol) {
    Replicas result(side);
    for (int i = 0; i < replicas; ++i) {
        const Image image = render(scene, method, {.samples = samples},
                                   {.seed = seed + static_cast<std::uint64_t>(i), .sampling = sampling});
        CHECK_MESSAGE(!image.metadata.contains("non_finite"), M::name);
        result.add(image);
    }
    return result.estimates();
}

/// What is expected when all pixels are the same and known.
inline TileEstimates known_tiles(int columns, int rows, int side, double value) {
    TileEstimates result{.columns = columns, .rows = rows, .side = side, .tiles = {}, .whole = {}};
    const Estimate exact{value, 0};
    result.tiles.assign(static_cast<std::size_t>(3 * columns * rows), exact);
    std::fill(result.whole, result.whole + 3, exact);
    return result;
}

/// Compares `bdpt`, `vcm` without merging and, where it can, `light` with `truth`, for one limit of the path length.
/// False alarm of all comparisons: `false_alarm` / `share`.
template <class SceneType>
void check_bidirectional(const TransportCase& c, const SceneType& scene, const TileEstimates& truth, int depth,
                         int replicas, double false_alarm, int share, int rr_depth = 5) {
    const auto check = [&](const auto& method, std::uint64_t seed) {
        const auto estimates = replicate_finite(scene, method, truth.side, replicas, c.samples, seed);
        const Comparison comparison = compare(estimates, truth, false_alarm, 3 * share);
        CHECK_MESSAGE(comparison.agree(), c.name, ", ", method.name, ", depth ", depth, ": ", comparison);
    };
    check(Bdpt{.max_depth = depth, .rr_depth = rr_depth}, 101);
    check(connections_only(depth, rr_depth), 201);
    if (c.light_tracer) check(LightTracer{.max_depth = depth, .rr_depth = rr_depth}, 301);
}

/// The same against path tracing with next event estimation.
inline void check_against_path_nee(const TransportCase& c, std::initializer_list<int> depths, int replicas,
                                   double false_alarm, int share) {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(c.description);
    for (const int depth : depths)
        check_bidirectional(c, scene,
                            replicate_finite(scene, PathTracerNee{.max_depth = depth}, 8, replicas, 2 * c.samples, 1),
                            depth, replicas, false_alarm, share * static_cast<int>(depths.size()));
}

}  // namespace lightswitch::test
