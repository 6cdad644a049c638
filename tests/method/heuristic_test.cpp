// Silhouette and Phong: pictures that nothing physical can judge, but geometry can.

#include "support/random_scenes.hpp"
#include "support/relative.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>
#include <lightswitch/method/silhouette.hpp>

#include <doctest/doctest.h>

#include <numbers>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

FullScene build(const LibraryDescription& description) { return build_scene<AllBsdfs, AllLights>(description); }

/// A grey plane z = 0 under a camera at height 10 that sees 4 x 4 of it on 16 x 16 pixels: column x, row y looks at
/// ((x + 0.5) / 4 - 2, 2 - (y + 0.5) / 4).
LibraryDescription describe_plane(const AnyMaterial& bsdf = Lambert{Rgb(0.5f)}) {
    LibraryDescription scene;
    scene.add(quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}), scene.add(bsdf));
    scene.camera.to_world = CameraDescription::look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    scene.camera.fov = glm::degrees(2 * std::atan(0.2));
    scene.film.width = scene.film.height = 16;
    return scene;
}

double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        largest = std::max(largest, std::abs(double(a.pixels()[i].y) - double(b.pixels()[i].y)));
    return largest;
}

const Phong no_ambient{.ambient = 0};

}  // namespace

TEST_CASE("the silhouette of a rectangle covers the right part of each pixel") {
    LibraryDescription description;
    const std::size_t material = description.add(Lambert{});
    // On a film of width 16 at distance 1 with a field of view of 90 degrees: columns 3.25 to 11.5, rows 2.5 to 9.75.
    const auto at = [](double column, double row) { return DVec3(1 - column / 8, 1 - row / 8, 1); };
    description.add(quad(at(3.25, 2.5), at(11.5, 2.5), at(11.5, 9.75), at(3.25, 9.75)), material);
    description.camera.fov = 90;
    description.film.width = description.film.height = 16;
    const Image image = render(build(description), Silhouette{.color = {0.25f, 1, 2}}, {.samples = 256});
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const double across = std::clamp(std::min(x + 1.0, 11.5) - std::max(double(x), 3.25), 0.0, 1.0);
            const double down = std::clamp(std::min(y + 1.0, 9.75) - std::max(double(y), 2.5), 0.0, 1.0);
            // Quarters of a pixel hold their share of 256 Sobol' points exactly, up to one that the rounding of the
            // camera moves.
            CHECK(std::abs(double(image(x, y).y) - across * down) <= 1.0 / 256 + 1e-9);
            CHECK(image(x, y).x == relative(0.25 * double(image(x, y).y), 1e-5));
            CHECK(image(x, y).z == relative(2 * double(image(x, y).y), 1e-5));
        }
}

TEST_CASE("the silhouette of a sphere is a disk, and everything from inside") {
    LibraryDescription description;
    description.add(Sphere{{0, 0, 3}, 1}, description.add(Lambert{}));
    description.camera.fov = 60;
    description.film.width = description.film.height = 64;
    const double tangent = std::tan(std::asin(1.0 / 3)) / std::tan(std::numbers::pi / 6);
    // 64 x 64 pixels of 64 points: the boundary crosses some 150 pixels, which err by 1/64 each: 5e-5 of the whole.
    CHECK(render(build(description), Silhouette{}, {.samples = 64}).mean().x ==
          relative(std::numbers::pi / 4 * tangent * tangent, 5e-4));
    description.camera.to_world = CameraDescription::look_at({0.2, 0.3, 3}, {0, 0, 9}, {0, 1, 0});
    CHECK(render(build(description), Silhouette{}, {.samples = 4}).mean() == DVec3(1, 0, 1));
}

TEST_CASE("Phong has no randomness of its own") {
    for (std::uint32_t seed = 1; seed < 9; ++seed) {
        const FullScene scene = build(random_scene(seed));
        const IterationPoints points(Sampling::independent, 1, 0);
        for (int i = 0; i < 16; ++i) {
            const Ray ray = scene.camera().ray({static_cast<float>(i) + 0.5f, 8.5f}, {0.5f, 0.5f});
            Sampler one(points, 0, 1), two(points, 0, 2);
            const Rgb radiance = Phong{}.radiance(scene, ray, one);
            CHECK(radiance == Phong{}.radiance(scene, ray, two));
        }
        for (const Rgb& p : render(scene, Phong{}, {.samples = 4}).pixels()) {
            CHECK(is_finite(p));
            CHECK(std::min(p.x, std::min(p.y, p.z)) >= 0);
        }
    }
}

TEST_CASE("on a diffuse plane Phong is exact for point and directional lights, and for an environment") {
    const auto check = [](const Source& source) {
        LibraryDescription description = describe_plane();
        description.add(source);
        const FullScene scene = build(description);
        const Image exact = render(scene, PathTracerNee{.max_depth = 2}, {.samples = 256});
        // The light is smooth over the plane: only the places within the pixels differ, and they are the same points.
        const Image phong = render(scene, no_ambient, {.samples = 256});
        CHECK(phong.mean().y > 0.01);
        CHECK(largest_difference(phong, exact) < 1e-3 * exact.mean().y);
        // Ambient light makes everything brighter by the same amount, but an environment counts in any case.
        const Image ambient = render(scene, Phong{}, {.samples = 256});
        const double added = ambient.mean().y - phong.mean().y;
        CHECK(added >= 0);
        CHECK((added > 0) == !Source(source).is_environment());
        for (std::size_t i = 0; i < ambient.pixels().size(); ++i)
            CHECK(double(ambient.pixels()[i].y - phong.pixels()[i].y) == relative(added, 1e-3));
    };
    check(PointSource{{0.5, -1, 3}, Rgb(4)});
    check(DirectionalSource{{1, 1, -2}, Rgb(3)});
}

TEST_CASE("an environment lights a diffuse plane exactly") {
    LibraryDescription description = describe_plane();
    description.add(EnvironmentSource{Rgb(0.6f)});
    for (const Rgb& p : render(build(description), no_ambient, {.samples = 1}).pixels())
        CHECK(p.y == relative(0.3, 1e-5));
}

TEST_CASE("on a diffuse plane Phong is nearly exact for small lamps") {
    const auto check = [](const std::variant<Mesh, Sphere>& lamp, double tolerance) {
        LibraryDescription description = describe_plane();
        description.add(lamp, description.add(Lambert{Rgb(0)}), Rgb(100));
        const FullScene scene = build(description);
        const Image phong = render(scene, no_ambient, {.samples = 64});
        const Image exact = render(scene, PathTracerNee{.max_depth = 2}, {.samples = 1024});
        CHECK(exact.mean().y > 0.005);
        CHECK(largest_difference(phong, exact) < tolerance * exact.mean().y);
    };
    // Beside the camera's view, above the plane, a fortieth of their distance in size.
    check(Sphere{{3, 0, 3}, 0.08}, 0.01);
    check(quad({3, -0.07, 3}, {3, 0.07, 3}, {3.14, 0.07, 3}, {3.14, -0.07, 3}), 0.01);  // faces down
    // A closed mesh counts as if it were round; a cube is up to a third larger or smaller seen from some sides.
    check(cube(DMat4({0.05, 0, 0, 0}, {0, 0.05, 0, 0}, {0, 0, 0.05, 0}, {-3, 0, 3, 1})), 0.35);
}

TEST_CASE("a lamp shines only from its front, and is seen to shine") {
    LibraryDescription description = describe_plane();
    const Mesh lamp = quad({2.5, -0.2, 3}, {2.5, 0.2, 3}, {2.9, 0.2, 3}, {2.9, -0.2, 3});
    description.add(lamp.flipped(), description.add(Lambert{Rgb(0)}), Rgb(50));
    CHECK(render(build(description), no_ambient, {.samples = 4}).mean().y == 0);

    LibraryDescription view = describe_plane();
    view.add(quad({-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1}), view.add(Lambert{Rgb(0)}), Rgb(7));
    CHECK(render(build(view), no_ambient, {.samples = 4})(8, 8) == Rgb(7));
}

TEST_CASE("Phong's shadows are hard and where they belong") {
    const auto check = [](const Source& source, double lit_share) {
        LibraryDescription description = describe_plane(Lambert{Rgb(1)});
        description.add(source);
        const FullScene open = build(description);
        // A square of side 1 at height 1 throws the shadow. Seen from above it hides a part of the plane, black itself.
        description.add(quad({-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1}),
                        description.add(Lambert{Rgb(0)}));
        const FullScene shadowed = build(description);
        const IterationPoints points(Sampling::sobol, 1, 0);
        int lit = 0, dark = 0;
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x) {
                Sampler sampler(points, 0, 0);
                const Vec2 position((static_cast<float>(x) + 0.5f) / 16, (static_cast<float>(y) + 0.5f) / 16);
                const Ray ray = shadowed.camera().ray(position, {});
                const float value = no_ambient.radiance(shadowed, ray, sampler).y;
                if (value == 0) {
                    ++dark;
                } else {
                    ++lit;  // the full light or none
                    CHECK(value ==
                          relative(no_ambient.radiance(open, open.camera().ray(position, {}), sampler).y, 1e-4));
                }
            }
        CHECK(double(lit) / (lit + dark) == relative(lit_share, 5e-3));
    };
    // The square hides (10/9)^2 of the 16 that are seen. Light from the side, 45 degrees: the shadow is a unit square
    // shifted by 1 in x, of which the part from 0.5 to 5/9 is hidden too.
    check(DirectionalSource{{1, 0, -1}, Rgb(1)}, 1 - (100.0 / 81 + 1 - (5.0 / 9 - 0.5) * 1) / 16);
    // A point at height 2 above the corner (0.5, 0.5) doubles the square away from that corner: from -1.5 to 0.5.
    check(PointSource{{0.5, 0.5, 2}, Rgb(1)}, 1 - (4 + 100.0 / 81 - std::pow(5.0 / 9 + 0.5, 2)) / 16);
}

TEST_CASE("Phong lights the side that is seen") {
    for (const bool flipped : {false, true}) {
        LibraryDescription description = describe_plane();
        auto& mesh = std::get<Mesh>(description.shapes[0].geometry);
        if (flipped) mesh = mesh.flipped();
        description.add(DirectionalSource{{0, 0, -1}, Rgb(2)});
        for (const Rgb& p : render(build(description), no_ambient, {.samples = 1}).pixels())
            CHECK(p.y == relative(std::numbers::inv_pi, 1e-5));
        description.sources.clear();
        description.add(DirectionalSource{{0, 0, 1}, Rgb(2)});  // from behind
        CHECK(render(build(description), no_ambient, {.samples = 1}).mean().y == 0);
    }
}

TEST_CASE("a highlight is where a mirror would show the light, and the picture is symmetric") {
    LibraryDescription description =
        describe_plane(RoughConductor{.distribution = Facets::ggx, .alpha_u = 0.1f, .alpha_v = 0.1f});
    description.add(PointSource{{0, 3, 10}, Rgb(1)});  // as high as the camera: mirrored half-way, at y = 1.5
    const FullScene scene = build(description);
    const Image image = render(scene, no_ambient, {.samples = 256});
    int best = 0;
    for (int i = 0; i < 256; ++i)
        if (image.pixels()[std::size_t(i)].y > image.pixels()[std::size_t(best)].y) best = i;
    CHECK((best % 16 == 7 || best % 16 == 8));
    CHECK((best / 16 == 1 || best / 16 == 2));  // y from 1.25 to 1.75
    const IterationPoints points(Sampling::sobol, 1, 0);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 8; ++x) {
            Sampler sampler(points, 0, 0);
            const auto value = [&](float column) {
                return no_ambient
                    .radiance(scene, scene.camera().ray({column, static_cast<float>(y) + 0.5f}, {}), sampler)
                    .y;
            };
            CHECK(value(static_cast<float>(x) + 0.5f) == relative(value(15.5f - static_cast<float>(x)), 1e-3));
        }
}
