// Instances: what they show is what the same shapes show when they are written out, to rounding; rays that leave them
// neither meet them again nor get through.

#include <lightswitch/core/warp.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include "support/errors.hpp"
#include "support/statistics.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

DMat4 affine(const DVec3& x, const DVec3& y, const DVec3& z, const DVec3& shift) {
    return DMat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(shift, 1));
}

/// Turned, of about that size, stretched by up to 1 : 6 unless `rigid`, and mirrored if `mirrored`.
DMat4 random_transform(std::mt19937& random, double size, double spread, bool mirrored, bool rigid = false) {
    std::uniform_real_distribution<float> u(0, 1);
    const auto direction = [&] { return DVec3(uniform_sphere({u(random), u(random)})); };
    const DVec3 x = direction(), y = glm::normalize(glm::cross(x, direction()));
    const auto scale = [&] { return rigid ? size : size * (0.4 + 2 * double(u(random))); };
    const DVec3 z = glm::cross(x, y);
    return affine(x * scale(), y * scale(), z * (mirrored ? -scale() : scale()), spread * direction());
}

/// A ball of triangles with normals and texture coordinates that are no affine map of the positions.
Mesh ball(int rings) {
    Mesh mesh;
    const int sectors = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sectors; ++j) {
            const double theta = 3.141592653589793 * i / rings, phi = 6.283185307179586 * j / sectors;
            const DVec3 p(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            mesh.positions.push_back(p);
            mesh.normals.push_back(p);
            mesh.uvs.emplace_back(float(j) / float(sectors), float(i * i) / float(rings * rings));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (sectors + 1) + j); };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

constexpr auto plain = Lambert{.reflectance = Rgb(0.7f)};

/// A group of a ball and a sphere beside it, placed `count` times; `written_out` has the meshes in place instead.
LibraryDescription balls(int count, bool written_out, double origin = 0, bool rigid = false) {
    LibraryDescription scene;
    scene.add(Textured<Lambert>(plain));
    using Group = LibraryDescription::Group;
    Group group;
    group.shapes.push_back({.geometry = ball(12), .material = 0, .emission = {}, .origin = {}});
    std::mt19937 random(5);
    for (int i = 0; i < count; ++i) {
        DMat4 m = random_transform(random, 0.3, 3, i % 3 == 2, rigid);
        m[3] += glm::dvec4(DVec3(origin), 0);
        if (written_out) scene.add(std::get<Mesh>(group.shapes[0].geometry).transformed(m), 0);
        else scene.instances.push_back({.group = 0, .to_world = m, .origin = {}});
    }
    if (!written_out) scene.groups.push_back(std::move(group));
    // Something in place, too.
    scene.add(rectangle(affine({6, 0, 0}, {0, -6, 0}, {0, 0, -1}, DVec3(origin) + DVec3(0, 0, 5))), 0);
    scene.camera.to_world = affine({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, DVec3(origin) - DVec3(0, 0, 20));
    scene.film = {.width = 32, .height = 32, .origin = {}};
    scene.add(EnvironmentSource{.radiance = Rgb(1)});
    return scene;
}

using PlacedScene = Scene<TexturedBsdfs, AllLights>;
PlacedScene build(const LibraryDescription& description) { return build_scene<TexturedBsdfs, AllLights>(description); }

}  // namespace

TEST_CASE("instance: rays find the same points as on shapes that are written out") {
    for (const auto& [origin, rigid] : {std::pair(0.0, false), std::pair(1e5, true)}) {
        const PlacedScene instanced = build(balls(12, false, origin, rigid)),
                          written = build(balls(12, true, origin, rigid));
        REQUIRE(instanced.instance_count() == 12);
        CHECK(10 * instanced.statistics().triangles < written.statistics().triangles);
        // The boxes around instances are not tight: the two scenes have spaces of their own.
        const auto to_scene = [](const PlacedScene& scene, const Vec3& p) {
            return DVec3(p) / scene.space().scale() + scene.space().center();
        };
        std::mt19937 random(3);
        std::uniform_real_distribution<float> u(0, 1);
        int hits = 0, differ = 0;
        double distance = 0, normal = 0, shading = 0, uv = 0;
        for (int i = 0; i < 20000; ++i) {
            const DVec3 from = DVec3(origin) + 8.0 * DVec3(uniform_sphere({u(random), u(random)}));
            const DVec3 to = DVec3(origin) + 3.0 * DVec3(uniform_sphere({u(random), u(random)}));
            const auto shoot = [&](const PlacedScene& scene) {
                return scene.intersect({.origin = Vec3(scene.space().point(from)),
                                        .direction = Vec3(glm::normalize(to - from)),
                                        .near = 0,
                                        .far = infinity});
            };
            const auto a = shoot(instanced), b = shoot(written);
            if (!a != !b) ++differ;
            if (!a || !b) continue;
            const double error = glm::length(to_scene(instanced, a->position) - to_scene(written, b->position));
            if (error > 0.01 || dot(a->normal, b->normal) < 0.99f) {  // at an edge
                ++differ;
                continue;
            }
            ++hits;
            distance = std::max(distance, error);
            normal = std::max(normal, double(length_squared(a->normal - b->normal)));
            shading = std::max(shading, double(length_squared(a->shading_normal - b->shading_normal)));
            uv = std::max(uv, double(glm::length(a->uv - b->uv)));
        }
        CAPTURE(origin);
        CHECK(hits > 5000);
        CHECK(differ < hits / 1000);
        CHECK(distance < 2e-4);
        CHECK(normal < 1e-9);
        // Normals are interpolated before they are transformed: only then is a smooth ball a smooth ellipsoid.
        CHECK(shading < (rigid ? 1e-8 : 0.05));
        CHECK(uv < 1e-3);
    }
}

TEST_CASE("instance: rays that leave a closed shape do not meet it again where they start, and none gets through") {
    // Balls of smooth shape, strongly stretched, far apart and near, from 1e-3 to 1e3 of the scene's size.
    std::mt19937 random(11);
    std::uniform_real_distribution<float> u(0, 1);
    int left = 0, met_itself = 0, inside = 0, leaked = 0;
    for (int trial = 0; trial < 24; ++trial) {
        const double size = std::pow(10.0, -3 + trial % 4);
        LibraryDescription scene;
        scene.add(plain);
        LibraryDescription::Group group;
        if (trial % 2 == 0) group.shapes.push_back({.geometry = Sphere{}, .material = 0, .emission = {}, .origin = {}});
        else group.shapes.push_back({.geometry = ball(20), .material = 0, .emission = {}, .origin = {}});
        scene.groups.push_back(std::move(group));
        const DMat4 to_world = random_transform(random, size, 1, trial % 3 == 0);
        scene.instances.push_back({.group = 0, .to_world = to_world, .origin = {}});
        // Makes the scene wide.
        scene.add(rectangle(affine({50, 0, 0}, {0, 50, 0}, {0, 0, 1}, {0, 0, -50})), 0);
        const auto built = build_scene<AllBsdfs, AllLights>(scene);
        const DVec3 center(to_world[3]);
        const auto in_space = [&](const DVec3& p) { return Vec3(built.space().point(p)); };
        for (int i = 0; i < 4000; ++i) {
            // From the middle of the ball outward: the first hit is its inside.
            const Vec3 way = uniform_sphere({u(random), u(random)});
            const auto hit =
                built.intersect({.origin = in_space(center), .direction = way, .near = 0, .far = infinity});
            const double farthest = built.space().length(7 * size);
            if (!hit || hit->distance > farthest) {
                ++leaked;
                continue;
            }
            // Outward no ray meets the convex ball again; inward every ray does, and not at once.
            Vec3 out = uniform_sphere({u(random), u(random)});
            if (dot(out, hit->normal) < 0) out = -out;
            const auto again = built.intersect(hit->spawn(out));
            ++left;
            if (again && again->distance < farthest) ++met_itself;
            const auto across = built.intersect(hit->spawn(-out));
            ++inside;
            if (!across || across->distance > farthest) ++leaked;
        }
    }
    CHECK(left > 90000);
    CHECK(inside > 90000);
    CHECK(met_itself == 0);
    CHECK(leaked == 0);
}

TEST_CASE("instance: lights in instances shine from each place as lights of their own do") {
    const auto make = [](bool written_out) {
        LibraryDescription scene;
        scene.add(plain);
        scene.add(Lambert{.reflectance = Rgb(0)});
        LibraryDescription::Group lamp;
        lamp.shapes.push_back({.geometry = rectangle(), .material = 1, .emission = Rgb(5, 4, 3), .origin = {}});
        lamp.shapes.push_back(
            {.geometry = Sphere{.center = {0, 0, 2}, .radius = 0.5}, .material = 1, .emission = Rgb(2), .origin = {}});
        for (int i = 0; i < 3; ++i) {
            const DMat4 m = affine({0.3, 0, 0}, {0, 0, -0.3}, {0, 0.3, 0}, {i - 1.0, -1.5, 0.5});
            if (!written_out) scene.instances.push_back({.group = 0, .to_world = m, .origin = {}});
            else
                for (const auto& shape : lamp.shapes)
                    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry))
                        scene.add(mesh->transformed(m), 1, shape.emission);
                    else scene.add(*std::get<Sphere>(shape.geometry).transformed(m), 1, shape.emission);
        }
        if (!written_out) scene.groups.push_back(lamp);
        scene.add(rectangle(affine({3, 0, 0}, {0, 0, -3}, {0, 3, 0}, {0, -2, 0})), 0);
        scene.camera.to_world = affine({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -6});
        scene.film = {.width = 24, .height = 24, .origin = {}};
        return build_scene<AllBsdfs, AllLights>(scene);
    };
    const auto a = make(false), b = make(true);
    CHECK(a.light_count() == 9);
    CHECK(a.light_count() == b.light_count());
    const Image left = render(a, PathTracerNee{}, Budget{.samples = 256}),
                right = render(b, PathTracerNee{}, Budget{.samples = 256});
    // The same random numbers: only rounding differs, and what it makes of single rays.
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < left.pixels().size(); ++i) {
        difference += std::abs(double(left.pixels()[i].y) - double(right.pixels()[i].y));
        sum += double(right.pixels()[i].y);
    }
    CHECK(sum > 10);
    CHECK(difference < 2e-3 * sum);
    CHECK_THROWS_AS(a.with_instance(0, DMat4(1)), Error);
}

TEST_CASE("instance: moving one gives the scene that is built with it there, and shares the rest") {
    LibraryDescription scene = balls(20, false);
    const PlacedScene before = build(scene);
    DMat4 there = scene.instances[7].to_world;
    there[3] = glm::dvec4(0.5, -0.25, 0.1, 1);
    const PlacedScene moved = before.with_instance(7, there);
    CHECK(&moved.statistics() == &before.statistics());
    CHECK(moved.accelerator().handle() != before.accelerator().handle());
    const Budget budget{.samples = 8};
    const Image old = render(before, PathTracerNee{}, budget), image = render(moved, PathTracerNee{}, budget);
    CHECK(old.pixels() != image.pixels());
    CHECK(render(before, PathTracerNee{}, budget).pixels() == old.pixels());
    // Back again: the same bits as at first.
    CHECK(render(moved.with_instance(7, scene.instances[7].to_world), PathTracerNee{}, budget).pixels() ==
          old.pixels());
    // The bounding box stays what it was, so the space does, too.
    scene.instances[7].to_world = there;
    const PlacedScene built = build(scene);
    if (built.space().scale() == before.space().scale() && built.space().center() == before.space().center())
        CHECK(render(built, PathTracerNee{}, budget).pixels() == image.pixels());
}

TEST_CASE("instance: what is impossible is refused with a reason") {
    LibraryDescription scene = balls(3, false);
    const PlacedScene good = build(scene);
    CHECK(message_of([&] { good.with_instance(3, DMat4(1)); }).find("there is no instance 3") != std::string::npos);
    DMat4 away(1);
    away[3] = glm::dvec4(1000, 0, 0, 1);
    CHECK(message_of([&] { good.with_instance(0, away); }).find("leave the sphere") != std::string::npos);
    DMat4 flat(1);
    flat[2] = glm::dvec4(0);
    CHECK(message_of([&] { good.with_instance(0, flat); }).find("has no inverse") != std::string::npos);
    // All of these have an inverse of nothing but NaN.
    DMat4 line = flat, point = flat;
    line[1] = glm::dvec4(2, 0, 0, 0);
    point[0] = point[1] = glm::dvec4(0);
    for (const DMat4& m : {line, point})
        CHECK(message_of([&] { good.with_instance(0, m); }).find("has no inverse") != std::string::npos);

    const auto refused = [&](const auto& change) {
        LibraryDescription changed = balls(3, false);
        change(changed);
        return message_of([&] { build(changed); });
    };
    CHECK(refused([&](auto& s) { s.instances[1].to_world = flat; }).find("has no inverse") != std::string::npos);
    CHECK(refused([](auto& s) { s.instances[1].group = 1; }).find("group does not exist") != std::string::npos);
    CHECK(refused([](auto& s) { s.instances[1].to_world[0].w = 1; }).find("not affine") != std::string::npos);
    CHECK(refused([](auto& s) { s.instances[1].to_world[3].x = NAN; }).find("instance's transform") !=
          std::string::npos);
    CHECK(refused([](auto& s) { s.groups[0].shapes.clear(); }).find("has no shapes") != std::string::npos);
    CHECK(refused([](auto& s) { s.groups[0].shapes[0].material = 9; }).find("material does not exist") !=
          std::string::npos);
    CHECK(refused([](auto& s) {
              s.groups[0].shapes[0] = {.geometry = Sphere{}, .material = 0, .emission = Rgb(1), .origin = {}};
          }).find("luminous sphere must stay one") != std::string::npos);
    CHECK(refused([](auto& s) { s.instances.clear(); }) == "(no error)");  // a group that is not used
}
