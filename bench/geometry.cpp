// Memory of large meshes, and the price of instances.
//
//   geometry [MILLION_TRIANGLES]
//
// Bytes per triangle that the scene and Embree hold (10 million triangles): flat, with normals, with texture
// coordinates; then 1000 instances of a mesh: bytes against the same written out, seconds to build, seconds to move
// one, and what rays cost.

#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/build.hpp>
#include <lightswitch/texture/textured.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace ls = lightswitch;

namespace {

using Materials = ls::Bsdfs<ls::Textured<ls::Lambert>>;
using Description = ls::SceneDescription<ls::Textured<ls::Lambert>>;

double seconds_of(const auto& action) {
    const auto start = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A wavy square of 2 n n triangles.
ls::Mesh waves(std::uint32_t n, bool normals, bool uvs) {
    ls::Mesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const double u = double(x) / n, v = double(y) / n;
            mesh.positions.emplace_back(u - 0.5, 0.02 * std::sin(40 * u) * std::cos(50 * v), v - 0.5);
            if (uvs) mesh.uvs.emplace_back(float(u), float(v));
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x;
            mesh.triangles.push_back({a, a + n + 1, a + 1});
            mesh.triangles.push_back({a + 1, a + n + 1, a + n + 2});
        }
    if (normals) mesh.smooth();
    return mesh;
}

Description under_sky() {
    Description scene;
    scene.add(ls::Textured<ls::Lambert>());
    scene.add(ls::EnvironmentSource{});
    scene.camera.to_world = ls::CameraDescription::look_at({0, 8, 12}, {0, 0, 0}, {0, 1, 0});
    scene.film = {.width = 64, .height = 64, .origin = {}};
    return scene;
}

auto build(const Description& scene) { return ls::build_scene<Materials, ls::Lights<ls::ConstantEnvironment>>(scene); }

void memory(double million) {
    const auto n = static_cast<std::uint32_t>(std::sqrt(million * 1e6 / 2));
    std::printf("%-44s %10s %10s %10s\n", "mesh", "triangles", "Embree B", "scene B");
    const auto line = [&](const char* name, bool normals, bool uvs) {
        Description scene = under_sky();
        scene.add(waves(n, normals, uvs), 0);
        const auto built = build(scene);
        const auto& s = built.statistics();
        const auto each = [&](std::int64_t bytes) { return double(bytes) / double(s.triangles); };
        std::printf("%-44s %10zu %10.1f %10.1f\n", name, s.triangles, each(s.embree_bytes), each(s.scene_bytes));
    };
    line("flat", false, false);
    line("with normals", true, false);
    line("with texture coordinates", false, true);
}

void instances() {
    constexpr int side = 32;
    const ls::Mesh mesh = waves(40, true, true);
    Description placed = under_sky(), written = under_sky();
    placed.groups.push_back(
        {.shapes = {{.geometry = mesh, .material = 0, .emission = {}, .origin = {}}}, .origin = {}});
    const auto at = [](int i, double height) {
        ls::DMat4 m(0.3);
        m[3] = glm::dvec4(0.35 * (i % side - side / 2), height, 0.35 * (i / side - side / 2), 1);
        return m;
    };
    for (int i = 0; i < 1000; ++i) {
        placed.instances.push_back({.group = 0, .to_world = at(i, 0), .origin = {}});
        written.add(mesh.transformed(at(i, 0)), 0);
    }
    const double time_placed = seconds_of([&] { build(placed); }), time_written = seconds_of([&] { build(written); });
    const auto few = build(placed), many = build(written);
    const auto bytes = [](const auto& scene) {
        return double(scene.statistics().embree_bytes + scene.statistics().scene_bytes);
    };
    std::printf(
        "\n1000 instances of %zu triangles: %.1f kB each, written out %.1f kB; built in %.3f s, written out %.3f s\n",
        mesh.triangles.size(), bytes(few) / 1e6, bytes(many) / 1e6, time_placed, time_written);
    auto moved = few;
    const double time_moved = seconds_of([&] { moved = few.with_instance(500, at(500, 0.1)); });
    std::printf("moving one: %.4f s\n", time_moved);
    const ls::PathTracerNee method;
    const auto render_seconds = [&](const auto& scene) {
        return seconds_of([&] { ls::render(scene, method, ls::Budget{.samples = 32}, ls::Settings{.threads = 1}); });
    };
    for (int i = 0; i < 3; ++i) {
        const double a = render_seconds(few), b = render_seconds(many);
        std::printf("path-nee: %.3f times the seconds of the same written out\n", a / b);
    }
}

}  // namespace

int main(int argc, char** argv) {
    memory(argc > 1 ? std::atof(argv[1]) : 10);
    instances();
}
