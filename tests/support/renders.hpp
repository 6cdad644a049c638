#pragma once

// Renders as the tests of methods need them, and the scenes that more than one test uses.

#include "support/z_test.hpp"

#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/stock.hpp>

namespace lightswitch::test {

/// `replicas` independent renders of `samples` each, with the seeds `seed`, `seed` + 1, ...
template <class SceneType, class M>
TileEstimates replicate(const SceneType& scene, const M& method, int side, int replicas, int samples,
                        Sampling sampling = Sampling::sobol, std::uint64_t seed = 1) {
    Replicas result(side);
    for (int i = 0; i < replicas; ++i)
        result.add(render(scene, method, {.samples = samples},
                          {.seed = seed + static_cast<std::uint64_t>(i), .sampling = sampling}));
    return result.estimates();
}

/// Equal to the last bit.
inline bool identical(const Image& a, const Image& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), [](const Rgb& p, const Rgb& q) {
               return std::bit_cast<std::array<std::uint32_t, 3>>(p) == std::bit_cast<std::array<std::uint32_t, 3>>(q);
           });
}

/// The description with all positions mapped by `map`, and all lengths multiplied by `factor`.
template <class Map>
LibraryDescription mapped(LibraryDescription scene, const Map& map, double factor) {
    for (auto& shape : scene.shapes) {
        if (auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            for (DVec3& p : mesh->positions) p = map(p);
        } else {
            auto& sphere = std::get<Sphere>(shape.geometry);
            sphere.center = map(sphere.center);
            sphere.radius *= factor;
        }
    }
    for (auto& placed : scene.sources)
        if (auto* point = placed.source.get<PointSource>()) point->position = map(point->position);
    auto& camera = scene.camera;
    camera.to_world[3] = glm::dvec4(map(DVec3(camera.to_world[3])), 1);
    camera.aperture_radius *= factor;
    camera.focus_distance *= factor;
    camera.near_clip *= factor;
    camera.far_clip *= factor;
    return scene;
}

/// The description at 2^k times the size.
inline LibraryDescription scaled(const LibraryDescription& scene, int k) {
    const double factor = std::ldexp(1.0, k);
    return mapped(
        scene, [&](const DVec3& p) { return p * factor; }, factor);
}

/// Four glossy plates under five spheres (after Veach 1997, figure 9.2), as tests/data/cbox/veach-mis.xml.
inline LibraryDescription describe_veach_mis() {
    LibraryDescription scene;
    scene.name = "veach-mis";
    const std::size_t black = scene.add(Lambert{Rgb(0)}), floor = scene.add(Lambert{Rgb(0.4f)});
    scene.add(Sphere{{10, 10, 4}, 0.5}, black, Rgb(800));
    scene.add(Sphere{{-1.25, 0, 0}, 0.1}, black, Rgb(100));
    scene.add(Sphere{{-3.75, 0, 0}, 0.03333}, black, Rgb(901.803f));
    scene.add(Sphere{{1.25, 0, 0}, 0.3}, black, Rgb(11.1111f));
    scene.add(Sphere{{3.75, 0, 0}, 0.9}, black, Rgb(1.23457f));
    const auto plate = [&](float alpha, double y0, double z0, double y1, double z1) {
        const RoughConductor metal{
            .distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha, .reflectance = {0.7f, 0.75f, 0.8f}};
        scene.add(quad({4, y0, z0}, {4, y1, z1}, {-4, y1, z1}, {-4, y0, z0}),
                  scene.add(TwoSided<RoughConductor>{metal}));
    };
    plate(0.005f, -2.70651, 0.25609, -2.08375, -0.526323);
    plate(0.02f, -3.28825, 1.36972, -2.83856, 0.476536);
    plate(0.05f, -3.73096, 2.70046, -3.43378, 1.74564);
    plate(0.1f, -3.99615, 4.0667, -3.82069, 3.08221);
    scene.add(quad({-10, -4.14615, -10}, {-10, -4.14615, 10}, {10, -4.14615, 10}, {10, -4.14615, -10}), floor);
    scene.add(quad({-10, -10, -2}, {10, -10, -2}, {10, 10, -2}, {-10, 10, -2}), floor);
    scene.camera.to_world = CameraDescription::look_at({0, 2, 15}, {0, -2, 2.5}, {0, 1, 0});
    scene.camera.fov = 36;
    scene.film.width = scene.film.height = 256;
    return scene;
}

}  // namespace lightswitch::test
