#pragma once

// The scenes of the catalogue, 16 x 16 pixels each unless they say otherwise, and the library's methods on them.

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/verify/estimator.hpp>

namespace lightswitch::test {

/// `method` on the smallest of the library's scene types that holds the description.
template <class M>
Estimator on_library_scene(const LibraryDescription& description, const M& method) {
    return std::visit(
        [&]<class SceneType>(SceneType&& scene) {
            return estimator(std::make_shared<const SceneType>(std::move(scene)), method);
        },
        build_any(description));
}

// The library's own methods, compiled once for all.
Estimator library_path(const LibraryDescription& description, const PathTracer& method = {});
Estimator library_nee(const LibraryDescription& description, const PathTracerNee& method = {});

/// The image, of the size of the scene's film, that is `value` everywhere.
inline Estimator exactly_everywhere(const FilmDescription& film, float value) {
    Image image(film.width, film.height);
    std::fill(image.pixels().begin(), image.pixels().end(), Rgb(value));
    return exactly(std::move(image));
}

template <class Material>
SceneDescription<Material> empty_view(std::string name, const DVec3& eye, const DVec3& target, double fov) {
    SceneDescription<Material> scene;
    scene.name = std::move(name);
    scene.camera.to_world = CameraDescription::look_at(eye, target, {0, 1, 0});
    scene.camera.fov = fov;
    scene.film.width = scene.film.height = 16;
    return scene;
}

/// A horizontal rectangle around `center` that faces up, or down.
inline Mesh level(const DVec3& center, double half_width, double half_depth, bool up = true) {
    const Mesh mesh = quad(center + DVec3(-half_width, 0, half_depth), center + DVec3(half_width, 0, half_depth),
                           center + DVec3(half_width, 0, -half_depth), center + DVec3(-half_width, 0, -half_depth));
    return up ? mesh : mesh.flipped();
}

/// An octahedron, its faces cut in four, blown up to the unit sphere, with the normals of the sphere: 32 triangles.
inline Mesh faceted_ball(const DVec3& center, double radius) {
    Mesh mesh;
    const auto vertex = [&](const DVec3& p) {
        mesh.normals.push_back(glm::normalize(p));
        mesh.positions.push_back(center + radius * mesh.normals.back());
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    for (int octant = 0; octant < 8; ++octant) {
        const DVec3 x(octant & 1 ? -1 : 1, 0, 0), y(0, octant & 2 ? -1 : 1, 0), z(0, 0, octant & 4 ? -1 : 1);
        const std::uint32_t a = vertex(x), b = vertex(y), c = vertex(z), ab = vertex(x + y), bc = vertex(y + z),
                            ca = vertex(z + x);
        for (const auto& t :
             {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
            mesh.triangles.push_back(t);
    }
    mesh.face_along_normals();
    return mesh;
}

/// A floor under a square lamp, both in view.
template <class Material>
SceneDescription<Material> floor_and_lamp(const Material& surface, const Material& black, double eye_height = 0.6) {
    auto scene = empty_view<Material>("floor-and-lamp", {0, eye_height, 3}, {0, 0.45, 0}, 40);
    scene.add(level({0, 0, 0}, 1, 1), scene.add(surface));
    scene.add(level({0, 1, 0}, 0.4, 0.4, false), scene.add(black), Rgb(4));
    return scene;
}

inline LibraryDescription floor_and_lamp(double eye_height = 0.6) {
    return floor_and_lamp<AnyMaterial>(Lambert{Rgb(0.7f)}, Lambert{Rgb(0)}, eye_height);
}

/// A ceiling that fills the image, lit only by the floor, on which the lamp shines.
inline LibraryDescription indirect_ceiling() {
    auto scene = empty_view<AnyMaterial>("indirect-ceiling", {0, 1, 0.6}, {0, 1.4, 0}, 50);
    const std::size_t grey = scene.add(Lambert{Rgb(0.7f)});
    scene.add(level({0, 0, 0}, 2, 2), grey);
    scene.add(level({0, 1.4, 0}, 2, 2, false), grey);
    scene.add(level({0, 0.5, 0}, 0.4, 0.4, false), scene.add(Lambert{Rgb(0)}), Rgb(10));
    return scene;
}

/// A wide floor that fills the image, under a square lamp that is out of view.
template <class Material>
SceneDescription<Material> floor_alone(const Material& surface, const Material& black, double lamp_half_width,
                                       double lamp_height, float radiance) {
    auto scene = empty_view<Material>("floor-alone", {0, 0.55, 0.3}, {0, 0, 0}, 50);
    scene.add(level({0, 0, 0}, 3, 3), scene.add(surface));
    scene.add(level({0, lamp_height, 0}, lamp_half_width, lamp_half_width, false), scene.add(black), Rgb(radiance));
    return scene;
}

/// A lamp as a small part of what the floor sees: little noise with next event estimation.
template <class Material>
SceneDescription<Material> floor_under_far_lamp(const Material& surface, const Material& black) {
    return floor_alone(surface, black, 0.3, 2, 16);
}

/// A lamp that fills half of what the floor sees: there both strategies of multiple importance sampling matter.
template <class Material>
SceneDescription<Material> floor_under_panel(const Material& surface, const Material& black) {
    return floor_alone(surface, black, 0.8, 0.6, 1);
}

/// The same under a ceiling, which the lamp does not light.
inline LibraryDescription lamp_below_ceiling() {
    LibraryDescription scene = floor_and_lamp();
    scene.name = "lamp-below-ceiling";
    scene.add(level({0, 1.4, 0}, 1, 1, false), 0);
    return scene;
}

/// A floor close under four small lamps, each twice as strong as the one before.
inline LibraryDescription floor_and_four_lamps() {
    auto scene = empty_view<AnyMaterial>("floor-and-four-lamps", {0, 0.6, 3}, {0, 0.3, 0}, 40);
    scene.add(level({0, 0, 0}, 1, 1), scene.add(Lambert{Rgb(0.7f)}));
    const std::size_t black = scene.add(Lambert{Rgb(0)});
    for (int i = 0; i < 4; ++i)
        scene.add(level({-0.75 + 0.5 * i, 0.5, 0}, 0.15, 0.15, false), black, Rgb(static_cast<float>(2 << i)));
    return scene;
}

/// A floor close under 16 lamps in a square, 32 luminous triangles in all, some much brighter than others.
inline LibraryDescription floor_and_many_lamps() {
    auto scene = empty_view<AnyMaterial>("floor-and-many-lamps", {0, 0.6, 3}, {0, 0.3, 0}, 40);
    scene.add(level({0, 0, 0}, 1, 1), scene.add(Lambert{Rgb(0.7f)}));
    const std::size_t black = scene.add(Lambert{Rgb(0)});
    for (int i = 0; i < 16; ++i)
        scene.add(level({-0.75 + 0.5 * (i % 4), 0.4, -0.75 + 0.5 * (i / 4)}, 0.2, 0.2, false), black,
                  Rgb(i % 3 == 0 ? 4.0f : 0.5f));
    return scene;
}

/// A floor under a luminous sphere.
inline LibraryDescription floor_and_round_lamp() {
    auto scene = empty_view<AnyMaterial>("floor-and-round-lamp", {0, 0.6, 3}, {0, 0.45, 0}, 40);
    scene.add(level({0, 0, 0}, 1, 1), scene.add(Lambert{Rgb(0.7f)}));
    scene.add(Sphere{{0, 0.7, 0}, 0.4}, scene.add(Lambert{Rgb(0)}), Rgb(4));
    return scene;
}

/// A floor close under a luminous mesh with interpolated normals.
inline LibraryDescription floor_and_faceted_lamp() {
    auto scene = empty_view<AnyMaterial>("floor-and-faceted-lamp", {0, 0.6, 3}, {0, 0.3, 0}, 40);
    scene.add(level({0, 0, 0}, 1, 1), scene.add(Lambert{Rgb(0.7f)}));
    scene.add(faceted_ball({0, 0.52, 0}, 0.5), scene.add(Lambert{Rgb(0)}), Rgb(4));
    return scene;
}

/// A diffuse mesh with interpolated normals that fills the image, under a lamp that is out of view.
inline LibraryDescription faceted_ball_and_lamp() {
    auto scene = empty_view<AnyMaterial>("faceted-ball-and-lamp", {0, 0.3, 3}, {0, 0.05, 0}, 22);
    scene.add(faceted_ball({0, 0, 0}, 0.7), scene.add(Lambert{Rgb(0.7f)}));
    scene.add(level({0, 2, 0.5}, 0.3, 0.3, false), scene.add(Lambert{Rgb(0)}), Rgb(16));
    return scene;
}

/// A wall that stands on a floor, with the lamp behind it: the camera looks at its shadow.
inline LibraryDescription wall_and_shadow() {
    auto scene = empty_view<AnyMaterial>("wall-and-shadow", {0, 0.5, 0.7}, {0, 0, 0.1}, 50);
    const std::size_t grey = scene.add(TwoSided<Lambert>{{Rgb(0.7f)}});
    scene.add(level({0, 0, 0}, 1, 1), grey);
    scene.add(quad({-1, 0, 0}, {1, 0, 0}, {1, 0.3, 0}, {-1, 0.3, 0}), grey);
    scene.add(level({0, 1, -0.5}, 0.1, 0.1, false), scene.add(Lambert{Rgb(0)}), Rgb(40));
    return scene;
}

/// A large mirror on the floor, in which the lamp is seen, before a diffuse wall.
inline LibraryDescription mirror_and_lamp() {
    auto scene = empty_view<AnyMaterial>("mirror-and-lamp", {0, 0.6, 3}, {0, 0.3, 0}, 40);
    scene.add(level({0, 0, 0}, 2.5, 2.5), scene.add(Conductor{.reflectance = Rgb(0.9f)}));
    scene.add(quad({-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}), scene.add(Lambert{Rgb(0.7f)}));
    scene.add(level({0, 1, 0}, 0.4, 0.4, false), scene.add(Lambert{Rgb(0)}), Rgb(4));
    return scene;
}

/// The Cornell box, small.
inline LibraryDescription small_box() {
    LibraryDescription scene = stock::describe_cornell_box();
    scene.film.width = scene.film.height = 16;
    return scene;
}

/// The furnace, small.
inline LibraryDescription small_furnace(float albedo) {
    LibraryDescription scene = stock::describe_furnace(albedo);
    scene.film.width = scene.film.height = 16;
    return scene;
}

/// A ball under a sky of radiance 1. White, or of clear glass, it cannot be told from the sky.
template <class Material>
SceneDescription<Material> ball_in_sky(const Material& surface) {
    auto scene = empty_view<Material>("ball-in-sky", {0, 0, 3.5}, {0, 0, 0}, 40);
    scene.add(Sphere{}, scene.add(surface));
    scene.add(EnvironmentSource{});
    return scene;
}

/// The camera in a ball of glass under a sky of radiance 1, close enough to the centre that nothing is reflected
/// totally: all it sees is the square of the index of refraction.
template <class Material>
SceneDescription<Material> inside_glass(const Material& glass) {
    auto scene = empty_view<Material>("inside-glass", {0, 0, 0.4}, {0, 0, -1}, 60);
    scene.add(Sphere{}, scene.add(glass));
    scene.add(EnvironmentSource{});
    return scene;
}

}  // namespace lightswitch::test
