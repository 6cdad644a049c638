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

}  // namespace detail

/// A tube around a (2,3) torus knot with smooth normals, `along` x `around` quadrilaterals, in a box of about 2 x 2 x 1.
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

/// The Cornell box with two blocks (Cornell University Program of Computer Graphics, colours in BT.709 as Mitsuba 3 ships
/// them).
inline LibraryDescription describe_cornell_box() {
    LibraryDescription scene = detail::empty_room("cornell-box");
    scene.add(cube(DMat4({0.286891, 0, 0.0877115, 0}, {0, 0.3, 0, 0}, {-0.0877115, 0, 0.286891, 0}, {0.335, -0.7, 0.38, 1})), 0);
    scene.add(cube(DMat4({0.28491, 0, -0.0939491, 0}, {0, 0.61, 0, 0}, {0.0939491, 0, 0.28491, 0}, {-0.33, -0.4, -0.28, 1})), 0);
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
    const std::size_t bronze =
        scene.add(RoughConductor{.alpha = 0.25f, .reflectance = Rgb(0.85f, 0.62f, 0.4f)});
    scene.add(Sphere{{0.45, -0.65, 0.3}, 0.35}, mirror);
    const DMat4 place({0.5, 0, -0.2, 0}, {0, 0.54, 0, 0}, {0.2, 0, 0.5, 0}, {-0.35, -0.39, -0.3, 1});
    scene.add(torus_knot().transformed(place), bronze);
    return scene;
}

/// A closed box with the camera inside, every wall of which reflects `albedo` and emits 1: every pixel is 1 / (1 - albedo), and up
/// to depth d the sum of the first d powers of `albedo`.
inline LibraryDescription describe_furnace(float albedo = 0.5f) {
    LibraryDescription scene;
    scene.name = "furnace";
    scene.add(cube().flipped(), scene.add(Lambert{Rgb(albedo)}), Rgb(1));
    scene.camera.to_world = CameraDescription::look_at({0.3, 0.2, 0.6}, {0, 0, -1}, {0, 1, 0});
    scene.camera.fov = 60;
    scene.film.width = scene.film.height = 64;
    return scene;
}

/// `describe_cornell_box`, built.
inline DiffuseScene cornell_box() {
    return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(describe_cornell_box());
}
/// `describe_cornell_spheres`, built.
inline FullScene cornell_spheres() { return build_scene<AllBsdfs, AllLights>(describe_cornell_spheres()); }
/// `describe_cornell_sculpture`, built.
inline FullScene cornell_sculpture() { return build_scene<AllBsdfs, AllLights>(describe_cornell_sculpture()); }
/// `describe_furnace`, built.
inline DiffuseScene furnace(float albedo = 0.5f) {
    return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(describe_furnace(albedo));
}

/// Names that `describe` knows.
inline constexpr std::array<std::string_view, 4> names{"cornell-box", "cornell-spheres", "cornell-sculpture", "furnace"};

/// The stock scene of that name, or nothing.
inline std::optional<LibraryDescription> describe(std::string_view name) {
    if (name == "cornell-box") return describe_cornell_box();
    if (name == "cornell-spheres") return describe_cornell_spheres();
    if (name == "cornell-sculpture") return describe_cornell_sculpture();
    if (name == "furnace") return describe_furnace();
    return std::nullopt;
}

}  // namespace lightswitch::stock
