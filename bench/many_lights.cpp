// What a light tree is worth: path-nee where a tree chooses among the lamps, over the same scene where a table does.
//
//   many_lights [MOST_LAMPS [PAIRS]]
//
// A grey closed room with 1 to MOST_LAMPS (100000) square lamps of two triangles each, 64 x 64 pixels, direct light and
// one bounce, independent points, one thread. `panel`: a grid of lamps in the ceiling. `scattered`: anywhere, facing
// any way but the camera, the brightest 20 times as bright as the dimmest. `near and far`: the same, but one in ten has
// 100 times the area of the others. The two scenes are rendered in turn, PAIRS (12) times with other seeds. Time is
// processor time, its ratio the median of the pairs; variance is that of a sample, mean over the pixels, over the
// squared mean of the image; `gain` is what is left of the ratio of variances after that of times.

#include "paired.hpp"

#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

namespace {

namespace ls = lightswitch;
using ls::DVec3;

constexpr int samples = 4;

ls::Mesh parallelogram(const DVec3& corner, const DVec3& u, const DVec3& v) {
    return {.positions = {corner, corner + u, corner + u + v, corner + v},
            .normals = {},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

ls::LibraryDescription room(std::string_view kind, int lamps) {
    ls::LibraryDescription scene;
    const std::size_t grey = scene.add(ls::TwoSided<ls::Lambert>{{ls::Rgb(0.5f)}});
    const std::size_t black = scene.add(ls::Lambert{ls::Rgb(0)});
    const DVec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), eye(0, 0, 0.95);
    for (const auto& wall :
         {parallelogram(DVec3(-1), x, z), parallelogram(DVec3(-1), x, y), parallelogram(DVec3(-1), z, y),
          parallelogram({-1, 1, -1}, x, z), parallelogram({1, -1, -1}, z, y), parallelogram({-1, -1, 1}, x, y)})
        scene.add(wall, grey);
    std::mt19937 engine(5);
    const auto random = [&] { return double(engine() >> 8) * 0x1p-24; };
    const int side = static_cast<int>(std::ceil(std::sqrt(double(lamps))));
    for (int i = 0; i < lamps; ++i) {
        if (kind == "panel") {
            const double width = 1.0 / side;
            const DVec3 corner(-0.5 + width * (i % side), 0.99, -0.5 + width * (i / side));
            scene.add(parallelogram(corner, {width / 2, 0, 0}, {0, 0, width / 2}), black, ls::Rgb(4));
            continue;
        }
        const DVec3 center = 1.8 * DVec3(random(), random(), random()) - 0.9;
        const double height = -random(), angle = 6.2831853 * random(), across = std::sqrt(1 - height * height);
        DVec3 axis(across * std::cos(angle), across * std::sin(angle), height);
        if (glm::dot(axis, eye - center) > 0) axis = -axis;
        const DVec3 u = glm::normalize(glm::cross(axis, DVec3(0.3, 0.5, 0.8))), v = glm::cross(axis, u);
        double half = 0.06 / std::sqrt(double(lamps)), radiance = 20 * std::exp(3 * random() - 1.5);
        if (kind == "near and far" && i % 10 != 0) half *= 0.1;
        scene.add(parallelogram(center - half * (u + v), 2 * half * u, 2 * half * v), black,
                  ls::Rgb(static_cast<float>(radiance)));
    }
    scene.camera.to_world = ls::CameraDescription::look_at(eye, {0, -0.2, -1}, {0, 1, 0});
    scene.camera.fov = 80;
    scene.film.width = scene.film.height = 64;
    return scene;
}

/// Of a sample, over the squared mean.
double variance(const std::vector<ls::Image>& images) {
    const double n = double(images.size());
    double variances = 0, means = 0;
    for (std::size_t p = 0; p < images[0].pixels().size(); ++p) {
        double sum = 0, squares = 0;
        for (const ls::Image& image : images) {
            const double value = double(image.pixels()[p].y);
            sum += value;
            squares += value * value;
        }
        variances += (squares - sum * sum / n) / (n - 1);
        means += sum / n;
    }
    const double pixels = double(images[0].pixels().size());
    return samples * variances / pixels / (means / pixels * means / pixels);
}

void compare(std::string_view kind, int lamps, int pairs) {
    const ls::LibraryDescription description = room(kind, lamps);
    const auto build = [&](std::size_t tree_from) {
        return ls::build_as<ls::DiffuseScene>(description, {.embree_config = "threads=1", .tree_from = tree_from});
    };
    const ls::DiffuseScene tree = build(1), table = build(std::numeric_limits<std::size_t>::max());
    std::vector<ls::Image> of_tree, of_table;
    const auto rendered = [](const ls::DiffuseScene& scene, std::vector<ls::Image>& images) {
        return [&] {
            const ls::Settings settings{.seed = images.size() + 1, .threads = 1, .sampling = ls::Sampling::independent};
            images.push_back(ls::render(scene, ls::PathTracerNee{.max_depth = 3}, {.samples = samples}, settings));
        };
    };
    const bench::Pairs time = bench::compare(pairs, rendered(tree, of_tree), rendered(table, of_table));
    const double with = variance(of_tree), without = variance(of_table);
    std::printf("%-12s %7d %8zu %10.4g %10.4g %8.2f %7.3f (%.3f to %.3f) %8.2f %9.3g %9.3g\n",
                std::string(kind).c_str(), lamps, tree.light_count(), without, with, without / with, time.ratio.median,
                time.ratio.low, time.ratio.high, without / with / time.ratio.median,
                1e3 * tree.statistics().light_tree_build_seconds, 1e-3 * double(tree.statistics().light_tree_bytes));
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    const int most = count > 1 ? std::atoi(arguments[1]) : 100000, pairs = count > 2 ? std::atoi(arguments[2]) : 12;
    std::printf("%-12s %7s %8s %10s %10s %8s %24s %8s %9s %9s\n", "lamps", "number", "lights", "table", "tree", "ratio",
                "time", "gain", "build ms", "kB");
    for (const std::string_view kind : {"panel", "scattered", "near and far"})
        for (int lamps = 1; lamps <= most; lamps *= 10) compare(kind, lamps, std::max(pairs, 2));
}
