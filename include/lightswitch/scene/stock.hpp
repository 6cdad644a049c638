#pragma once

// Scenes that need no files.

#include <lightswitch/scene/any_scene.hpp>
#include <lightswitch/scene/shapes.hpp>

#include <numbers>

namespace lightswitch::stock {

namespace detail {

inline void add_room(LibraryDescription& scene, std::size_t white) {
    const std::size_t green = scene.add(Lambert{{0.105421f, 0.37798f, 0.076425f}});
    const std::size_t red = scene.add(Lambert{{0.570068f, 0.0430135f, 0.0443706f}});
    const std::size_t lamp = scene.add(TwoSided<Lambert>{{{0.885809f, 0.698859f, 0.666422f}}});
    scene.add(quad({-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}), white);
    scene.add(quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}), white);
    scene.add(quad({-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}), white);
    scene.add(quad({-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}), red);
    scene.add(quad({1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}), green);
    scene.add(quad({-0.23, 0.99, -0.18}, {0.23, 0.99, -0.18}, {0.23, 0.99, 0.2}, {-0.23, 0.99, 0.2}), lamp,
              Rgb(18.387f, 13.9873f, 6.75357f));
    scene.camera.to_world = CameraDescription::look_at({0, 0, 3.9}, {0, 0, 0}, {0, 1, 0});
    scene.camera.fov = 39.3077;
    scene.film.width = scene.film.height = 256;
}

inline LibraryDescription empty_room(std::string name) {
    LibraryDescription scene;
    scene.name = std::move(name);
    add_room(scene, scene.add(Lambert{{0.885809f, 0.698859f, 0.666422f}}));
    return scene;
}

/// The box between two corners, fronts outwards.
inline Mesh block(const DVec3& low, const DVec3& high) {
    const DVec3 center = 0.5 * (low + high), half = 0.5 * (high - low);
    return cube(DMat4({half.x, 0, 0, 0}, {0, half.y, 0, 0}, {0, 0, half.z, 0}, glm::dvec4(center, 1)));
}

inline void add_quad(Mesh& mesh, const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

/// The tiles of one colour of a floor at height 0: squares of half a unit, of which every second is missing.
inline Mesh tiles(int parity) {
    Mesh mesh;
    for (int x = -6; x < 6; ++x)
        for (int z = -7; z < 11; ++z) {
            if (((x + z) & 1) != parity) continue;
            const DVec3 corner = 0.5 * DVec3(x, 0, z), right(0.5, 0, 0), near(0, 0, 0.5);
            add_quad(mesh, corner, corner + near, corner + right + near, corner + right);
        }
    return mesh;
}

/// A wall across z = 0 with a doorway from `left` to `right` and up to `top`, for the rooms of `add_two_rooms`: it
/// reaches into their floor, their ceiling and the walls beside it.
inline Mesh wall_with_doorway(double left, double right, double top, double thickness) {
    const double x[] = {-2.7, left, right, 2.7}, y[] = {-0.2, top, 2.8};
    const auto corner = [&](int i, int j, int side) { return DVec3(x[i], y[j], (side - 0.5) * thickness); };
    Mesh mesh;
    const auto add = [&](const auto&... corners) { add_quad(mesh, corners...); };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) {
            if (i == 1 && j == 0) continue;  // the doorway
            add(corner(i, j, 1), corner(i + 1, j, 1), corner(i + 1, j + 1, 1), corner(i, j + 1, 1));
            add(corner(i + 1, j, 0), corner(i, j, 0), corner(i, j + 1, 0), corner(i + 1, j + 1, 0));
        }
    add(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
    add(corner(2, 0, 1), corner(2, 1, 1), corner(2, 1, 0), corner(2, 0, 0));
    add(corner(1, 1, 0), corner(2, 1, 0), corner(2, 1, 1), corner(1, 1, 1));
    return mesh;
}

/// The rooms of `describe_ajar_door`, the door between them and the lamp. Surfaces that meet reach through each other,
/// so that no light passes where they do.
inline void add_two_rooms(LibraryDescription& scene) {
    const std::size_t plaster = scene.add(Lambert{{0.82f, 0.81f, 0.79f}});
    const std::size_t blue = scene.add(Lambert{{0.30f, 0.45f, 0.58f}});
    const std::size_t light_tile = scene.add(Lambert{{0.74f, 0.72f, 0.68f}});
    const std::size_t dark_tile = scene.add(Lambert{{0.22f, 0.20f, 0.20f}});
    const std::size_t paint = scene.add(Lambert{{0.55f, 0.29f, 0.17f}});
    const std::size_t brass = scene.add(RoughConductor{
        .distribution = Facets::ggx, .alpha_u = 0.2f, .alpha_v = 0.2f, .reflectance = {0.9f, 0.7f, 0.35f}});
    const std::size_t lamp = scene.add(TwoSided<Lambert>{{Rgb(0.5f)}});
    scene.add(block({-2.6, -0.1, -3}, {2.6, 2.6, 5}).flipped(), plaster);
    scene.add(quad({-2.5, -0.2, 5.1}, {-2.5, -0.2, -3.1}, {-2.5, 2.7, -3.1}, {-2.5, 2.7, 5.1}), blue);
    scene.add(tiles(0), light_tile);
    scene.add(tiles(1), dark_tile);

    constexpr double left = -1.75, right = -0.75, top = 2.1, thickness = 0.12;
    scene.add(wall_with_doorway(left, right, top, thickness), plaster);
    // The door turns about the edge of the wall at its left, into the room of the camera.
    const double opened = glm::radians(24.0), c = std::cos(opened), s = std::sin(opened);
    const DMat4 turned({c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 0}, {left, 0, thickness / 2, 1});
    scene.add(block({-0.005, 0.01, -0.045}, {right - left - 0.01, top - 0.01, 0}).transformed(turned), paint);
    scene.add(Sphere{DVec3(turned * glm::dvec4(0.9, 1.02, 0.05, 1)), 0.035}, brass);

    scene.add(quad({1.1, 0.9, -1}, {-0.1, 0.9, -1}, {-0.1, 1.9, -1}, {1.1, 1.9, -1}), lamp, Rgb(560, 520, 450));
}

/// The table of `describe_ajar_door` with what stands on it.
inline void add_table(LibraryDescription& scene) {
    const std::size_t wood = scene.add(Lambert{{0.55f, 0.38f, 0.22f}});
    scene.add(block({-0.75, 0.72, 1.45}, {1.25, 0.77, 2.4}), wood);
    for (const double x : {-0.68, 1.1})
        for (const double z : {1.52, 2.25}) scene.add(block({x, -0.1, z}, {x + 0.08, 0.73, z + 0.08}), wood);
    const auto stand = [&](double x, double z, double radius, AnyMaterial bsdf) {
        scene.add(Sphere{{x, 0.77 + radius, z}, radius}, scene.add(bsdf));
    };
    stand(-0.48, 2.02, 0.21, Dielectric{.eta = 1.5f});
    stand(-0.06, 1.72, 0.26, Conductor{.reflectance = Rgb(0.9f)});
    stand(0.4, 2.12, 0.19,
          RoughConductor{
              .distribution = Facets::ggx, .alpha_u = 0.15f, .alpha_v = 0.15f, .reflectance = {0.9f, 0.62f, 0.3f}});
    stand(0.88, 1.8, 0.24, Lambert{{0.2f, 0.5f, 0.42f}});
}

}  // namespace detail

/// A tube around a (2,3) torus knot with smooth normals, `along` x `around` quadrilaterals, in a box of about 2 x 2 x
/// 1.
inline Mesh torus_knot(int along = 400, int around = 16, double tube = 0.16) {
    Mesh mesh;
    const auto curve = [](double t) {
        const double r = (2 + std::cos(3 * t)) / 3;
        return DVec3(r * std::cos(2 * t), r * std::sin(2 * t), std::sin(3 * t) / 3);
    };
    for (int i = 0; i < along; ++i) {
        const double t = 2 * std::numbers::pi * i / along, step = 1e-4;
        const DVec3 center = curve(t), tangent = glm::normalize(curve(t + step) - curve(t - step));
        const DVec3 outward(std::cos(2 * t), std::sin(2 * t), 0);
        const DVec3 side = glm::normalize(glm::cross(tangent, outward)), up = glm::cross(side, tangent);
        for (int j = 0; j < around; ++j) {
            const double angle = 2 * std::numbers::pi * j / around;
            const DVec3 normal = std::cos(angle) * up + std::sin(angle) * side;
            mesh.positions.push_back(center + tube * normal);
            mesh.normals.push_back(normal);
        }
    }
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(i % along * around + j % around); };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
            mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
        }
    return mesh;
}

/// The Cornell box with two blocks (Cornell University Program of Computer Graphics, colours in BT.709 as Mitsuba 3
/// ships them).
inline LibraryDescription describe_cornell_box() {
    LibraryDescription scene = detail::empty_room("cornell-box");
    scene.add(
        cube(DMat4({0.286891, 0, 0.0877115, 0}, {0, 0.3, 0, 0}, {-0.0877115, 0, 0.286891, 0}, {0.335, -0.7, 0.38, 1})),
        0);
    scene.add(
        cube(DMat4({0.28491, 0, -0.0939491, 0}, {0, 0.61, 0, 0}, {0.0939491, 0, 0.28491, 0}, {-0.33, -0.4, -0.28, 1})),
        0);
    return scene;
}

/// The Cornell box with a glass sphere and a mirror sphere: a caustic.
inline LibraryDescription describe_cornell_spheres() {
    LibraryDescription scene = detail::empty_room("cornell-spheres");
    const std::size_t glass = scene.add(Dielectric{.eta = 1.5f});
    const std::size_t mirror = scene.add(Conductor{.reflectance = Rgb(0.9f)});
    scene.add(Sphere{{0.42, -0.62, 0.35}, 0.38}, glass);
    scene.add(Sphere{{-0.45, -0.58, -0.35}, 0.42}, mirror);
    return scene;
}

/// The Cornell box with a mirror sphere and a sculpture of 12800 triangles, after figure 1 of Sato and Cohen (2021).
inline LibraryDescription describe_cornell_sculpture() {
    LibraryDescription scene = detail::empty_room("cornell-sculpture");
    const std::size_t mirror = scene.add(Conductor{.reflectance = Rgb(0.9f)});
    const std::size_t bronze = scene.add(RoughConductor{
        .distribution = Facets::ggx, .alpha_u = 0.25f, .alpha_v = 0.25f, .reflectance = Rgb(0.85f, 0.62f, 0.4f)});
    scene.add(Sphere{{0.45, -0.65, 0.3}, 0.35}, mirror);
    const DMat4 place({0.5, 0, -0.2, 0}, {0, 0.54, 0, 0}, {0.2, 0, 0.5, 0}, {-0.35, -0.39, -0.3, 1});
    scene.add(torus_knot().transformed(place), bronze);
    return scene;
}

/// The sculpture, a sphere of glass and a matt one on a slab before an empty background, lit by two lamps outside of
/// the picture: the scene in which outlines show.
inline LibraryDescription describe_still_life() {
    LibraryDescription scene;
    scene.name = "still-life";
    const std::size_t stone = scene.add(Lambert{{0.62f, 0.58f, 0.52f}});
    const std::size_t bronze = scene.add(RoughConductor{
        .distribution = Facets::ggx, .alpha_u = 0.25f, .alpha_v = 0.25f, .reflectance = {0.85f, 0.62f, 0.4f}});
    const std::size_t lamp = scene.add(Lambert{Rgb(0)});
    scene.add(detail::block({-1.3, -0.12, -0.8}, {1.3, 0, 0.8}), stone);
    scene.add(
        torus_knot().transformed(DMat4({0.5, 0, -0.2, 0}, {0, 0.54, 0, 0}, {0.2, 0, 0.5, 0}, {-0.52, 0.6, -0.1, 1})),
        bronze);
    scene.add(Sphere{{0.25, 0.26, 0.4}, 0.26}, scene.add(Dielectric{.eta = 1.5f}));
    scene.add(Sphere{{0.76, 0.42, -0.15}, 0.42}, scene.add(Lambert{{0.12f, 0.45f, 0.42f}}));
    scene.add(quad({-0.4, 3, 0.2}, {0.4, 3, 0.2}, {0.4, 3, 1}, {-0.4, 3, 1}), lamp, Rgb(42, 37, 30));
    scene.add(quad({-3, 0.4, 1.6}, {-3, 0.4, 0.4}, {-3, 1.8, 0.4}, {-3, 1.8, 1.6}), lamp, Rgb(6, 8, 12));
    scene.camera.to_world = CameraDescription::look_at({0, 1.3, 4.4}, {0, 0.52, 0}, {0, 1, 0});
    scene.camera.fov = 34;
    scene.film.width = scene.film.height = 256;
    return scene;
}

/// Two rooms after the scene with the ajar door of Veach (1997, chapter 11): the only lamp is in the far one and shines
/// away from the door, so that all light in the room of the camera has come through the gap, after one reflection at
/// least. On the table are a sphere of glass, a mirror, a glossy and a diffuse one.
inline LibraryDescription describe_ajar_door() {
    LibraryDescription scene;
    scene.name = "ajar-door";
    detail::add_two_rooms(scene);
    detail::add_table(scene);
    scene.camera.to_world = CameraDescription::look_at({1.1, 1.55, 4.6}, {-0.3, 0.96, 0}, {0, 1, 0});
    scene.camera.fov = 43;
    scene.film.width = scene.film.height = 256;
    return scene;
}

/// A closed box with the camera inside, every wall of which reflects `albedo` and emits 1: every pixel is 1 / (1 -
/// albedo), and up to depth d the sum of the first d powers of `albedo`.
inline LibraryDescription describe_furnace(float albedo = 0.5f) {
    LibraryDescription scene;
    scene.name = "furnace";
    scene.add(cube().flipped(), scene.add(Lambert{Rgb(albedo)}), Rgb(1));
    scene.camera.to_world = CameraDescription::look_at({0.3, 0.2, 0.6}, {0, 0, -1}, {0, 1, 0});
    scene.camera.fov = 60;
    scene.film.width = scene.film.height = 64;
    return scene;
}

// Built, as any type of scene that can hold them: templates, so that only those which are used are compiled.

/// `describe_cornell_box`, built.
template <class SceneType = DiffuseScene>
SceneType cornell_box() {
    return build_as<SceneType>(describe_cornell_box());
}
/// `describe_cornell_spheres`, built.
template <class SceneType = FullScene>
SceneType cornell_spheres() {
    return build_as<SceneType>(describe_cornell_spheres());
}
/// `describe_cornell_sculpture`, built.
template <class SceneType = FullScene>
SceneType cornell_sculpture() {
    return build_as<SceneType>(describe_cornell_sculpture());
}
/// `describe_still_life`, built.
template <class SceneType = FullScene>
SceneType still_life() {
    return build_as<SceneType>(describe_still_life());
}
/// `describe_ajar_door`, built.
template <class SceneType = FullScene>
SceneType ajar_door() {
    return build_as<SceneType>(describe_ajar_door());
}
/// `describe_furnace`, built.
template <class SceneType = DiffuseScene>
SceneType furnace(float albedo = 0.5f) {
    return build_as<SceneType>(describe_furnace(albedo));
}

/// Names that `describe` knows.
inline constexpr std::array<std::string_view, 6> names{"cornell-box", "cornell-spheres", "cornell-sculpture",
                                                       "still-life",  "ajar-door",       "furnace"};

/// The stock scene of that name, or nothing.
inline std::optional<LibraryDescription> describe(std::string_view name) {
    if (name == "cornell-box") return describe_cornell_box();
    if (name == "cornell-spheres") return describe_cornell_spheres();
    if (name == "cornell-sculpture") return describe_cornell_sculpture();
    if (name == "still-life") return describe_still_life();
    if (name == "ajar-door") return describe_ajar_door();
    if (name == "furnace") return describe_furnace();
    return std::nullopt;
}

}  // namespace lightswitch::stock
