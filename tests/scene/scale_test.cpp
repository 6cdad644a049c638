// Images do not depend on the unit of length, nor on where the origin of coordinates is.

#include "support/renders.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/stock.hpp>

#include <doctest/doctest.h>

#include <cstring>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

LibraryDescription moved(const LibraryDescription& scene, const DVec3& by) {
    return mapped(
        scene, [&](const DVec3& p) { return p + by; }, 1);
}

/// The description with coordinates rounded to 2^-20, so that moving it as far as 2^30 changes no digit of a double.
LibraryDescription on_grid(const LibraryDescription& scene) {
    return mapped(
        scene, [](const DVec3& p) { return glm::round(p * 0x1p20) * 0x1p-20; }, 1);
}

Image image(const LibraryDescription& description) {
    const auto scene = build_scene<AllBsdfs, AllLights>(description, {.embree_config = "threads=1"});
    return render(scene, PathTracerNee{}, {.samples = 4}, {.threads = 1});
}

bool same_bits(const Image& a, const Image& b, float factor = 1) {
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const Rgb p = a.pixels()[i] * factor, q = b.pixels()[i];
        if (std::memcmp(&p, &q, sizeof p) != 0) return false;
    }
    return a.mean().x > 0;
}

/// Several scenes, between them with everything that has a length: a lens, clipping planes, radii, point lights.
std::vector<LibraryDescription> scenes() {
    std::vector<LibraryDescription> list{stock::describe_cornell_box(), stock::describe_cornell_spheres()};
    LibraryDescription lens = stock::describe_cornell_spheres();
    lens.camera.aperture_radius = 0.1;
    lens.camera.focus_distance = 3.5;
    lens.camera.near_clip = 3.2;
    lens.camera.far_clip = 4.7;
    list.push_back(lens);
    LibraryDescription far = stock::describe_cornell_box();
    far.camera.to_world = CameraDescription::look_at({0, 0, 1e5}, {0, 0, 0}, {0, 1, 0});
    far.camera.fov = 0.0014;
    list.push_back(far);
    LibraryDescription lamps = stock::describe_cornell_box();  // enough of them for a light tree
    for (int i = 0; i < 40; ++i)
        lamps.add(Sphere{{-0.7 + 0.2 * (i % 8), -0.5 + 0.2 * (i / 8), -0.3 + 0.09 * (i % 5)}, 0.01 + 0.001 * i}, 0,
                  Rgb(static_cast<float>(1 + i % 7)));
    list.push_back(lamps);
    for (auto& scene : list) scene.film.width = scene.film.height = 32;
    return list;
}

}  // namespace

TEST_CASE("scale: a scene multiplied by a power of two is the same image, bit by bit") {
    for (const LibraryDescription& scene : scenes()) {
        const Image original = image(scene);
        for (const int k : {-40, -10, -1, 10, 40}) {
            CAPTURE(k);
            CHECK(same_bits(original, image(scaled(scene, k))));
        }
        // Another scene is another image: the comparison can fail.
        CHECK_FALSE(same_bits(original, image(mapped(
                                            scene, [](const DVec3& p) { return p * 1.1; }, 1))));
    }
}

TEST_CASE("scale: light of a point falls with the square of the length, and nothing else changes") {
    LibraryDescription scene = stock::describe_cornell_spheres();
    scene.film.width = scene.film.height = 32;
    for (auto& shape : scene.shapes) shape.emission.reset();
    scene.add(Source(PointSource{{0.1, 0.6, 0.3}, Rgb(3, 2, 1)}));
    const Image original = image(scene);
    for (const int k : {-40, -10, 10, 40}) {
        CAPTURE(k);
        CHECK(same_bits(original, image(scaled(scene, k)), std::ldexp(1.0f, -2 * k)));
    }
}

TEST_CASE("scale: a scene that is moved without rounding is the same image, bit by bit") {
    for (const LibraryDescription& scene : scenes()) {
        const LibraryDescription exact = on_grid(scene);
        const Image original = image(exact);
        for (const DVec3& by : {DVec3(1024, -2048, 3072), DVec3(0x1p30, -0x1p29, 0x1p28)})
            CHECK(same_bits(original, image(moved(exact, by))));
        // Both at once.
        CHECK(same_bits(original, image(scaled(moved(exact, DVec3(1024, 0, -1024)), 17))));
    }
}

TEST_CASE("scale: ten thousand kilometres from the origin") {
    // Here rounding moves corners by 1e-9, so that single paths differ.
    for (const LibraryDescription& scene : scenes()) {
        const DVec3 near = image(scene).mean(), far = image(moved(scene, DVec3(1e7))).mean();
        for (int c = 0; c < 3; ++c) CHECK(std::abs(far[c] / near[c] - 1) < 1e-4);
    }
}
