// Scenes whose image is known: furnaces, and planes under simple lights.

#include "support/relative.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// How far the pixels of a render are from a value that all of them should have.
struct Deviation {
    double worst = 0;  ///< largest |pixel - expected| in standard errors of the pixel
    double whole = 0;  ///< (mean of the image - expected) in standard errors, pixels being independent
    double bias = 0;   ///< relative difference of the means
};

template <class SceneType, class M>
Deviation deviation(const SceneType& scene, const M& method, int samples, double expected, std::uint64_t seed = 7) {
    const Settings settings{.seed = seed, .sampling = Sampling::independent};
    Session<SceneType, M> session(scene, method, settings);
    session.run({.samples = samples});
    CHECK(session.statistics().counts.non_finite == 0);
    const Image image = session.film().image(), variance = session.film().variance();
    Deviation result;
    double sum = 0, sum_of_variances = 0;
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
        const double difference = double(image.pixels()[i].y) - expected;
        // Rounding is no noise: in a render without any, 1e-6 of the value is one standard error.
        const double error = std::sqrt(double(variance.pixels()[i].y)) + 1e-6 * expected;
        result.worst = std::max(result.worst, std::abs(difference) / error);
        sum += difference;
        sum_of_variances += error * error;
    }
    // Roulette ends long paths once in a thousand times: what it takes may not have been met yet, and then there is no
    // spread that tells of it. One sample of all is as uncertain.
    const double event = expected / samples;
    result.whole = sum / std::sqrt(sum_of_variances + event * event);
    result.bias = sum / double(image.pixels().size()) / expected;
    return result;
}

FullScene build(const LibraryDescription& description) { return build_scene<AllBsdfs, AllLights>(description); }

/// A sphere of radius 1 that fills a film of 32 x 32 pixels, in an environment of radiance 1.
template <class B>
LibraryDescription describe_sphere_in_white(const B& bsdf) {
    LibraryDescription scene;
    scene.add(Sphere{}, scene.add(bsdf));
    scene.add(EnvironmentSource{});
    scene.camera.to_world = CameraDescription::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    scene.camera.fov = 34;
    scene.film.width = scene.film.height = 32;
    return scene;
}

}  // namespace

// Pixels are compared at 8 of their own standard errors. For normal means that is never, but means of 256 geometric
// numbers are skewed, and more so when divided by their own spread: simulated for albedo 0.2, the worst, one in 15 000
// is 5 standard errors off and one in 400 000 6.5. For the 80 000 pixels of this file together that makes about 0.01.
// Whole images are compared at 4.5 of their standard errors: 7e-6 each, 3e-4 for all of them.

TEST_CASE("a furnace is 1 / (1 - albedo) everywhere") {
    for (const float albedo : {0.2f, 0.5f, 0.8f}) {
        const DiffuseScene scene = stock::furnace(albedo);
        const double expected = 1 / (1 - double(albedo));
        CAPTURE(albedo);
        // With roulette from the first bounce on the number of bounces is geometric, and its mean close to normal.
        const auto path = deviation(scene, PathTracer{.rr_depth = 0}, 256, expected);
        CHECK(path.worst < 8);
        CHECK(std::abs(path.whole) < 4.5);
        CHECK(std::abs(path.bias) < 2e-3);
        const auto nee = deviation(scene, PathTracerNee{.rr_depth = 0}, 256, expected);
        CHECK(nee.worst < 8);
        CHECK(std::abs(nee.whole) < 4.5);
        CHECK(std::abs(nee.bias) < 2e-3);
        // The default depth of roulette, where single pixels are far from normal but whole images are not.
        CHECK(std::abs(deviation(scene, PathTracer{}, 64, expected).whole) < 4.5);
        CHECK(std::abs(deviation(scene, PathTracerNee{}, 64, expected).whole) < 4.5);
    }
}

TEST_CASE("a furnace cut off at a depth is the partial sum of the geometric series") {
    for (const float albedo : {0.2f, 0.8f}) {
        const DiffuseScene scene = stock::furnace(albedo);
        CHECK(render(scene, PathTracer{.max_depth = 0}, {.samples = 1}).mean() == DVec3(0));
        CHECK(render(scene, PathTracerNee{.max_depth = 0}, {.samples = 1}).mean() == DVec3(0));
        double expected = 0;
        for (int depth = 1; depth <= 6; ++depth) {
            expected += std::pow(double(albedo), depth - 1);
            CAPTURE(albedo);
            CAPTURE(depth);
            // No roulette up to five bounces: nothing is random for the path tracer.
            CHECK(std::abs(deviation(scene, PathTracer{.max_depth = depth}, 2, expected).bias) < 1e-6);
            const auto nee = deviation(scene, PathTracerNee{.max_depth = depth}, 64, expected);
            CHECK(nee.worst < 8);
            CHECK(std::abs(nee.whole) < 4.5);
            if (depth == 1) CHECK(std::abs(nee.bias) < 1e-7);
        }
    }
}

TEST_CASE("a luminous sphere seen from inside is a furnace too") {
    LibraryDescription description;
    description.add(Sphere{.inward = true}, description.add(Lambert{Rgb(0.6f)}), Rgb(1));
    description.camera.to_world = CameraDescription::look_at({0.3, 0.2, 0.5}, {0, 0, -1}, {0, 1, 0});
    description.film.width = description.film.height = 32;
    const FullScene scene = build(description);
    const auto path = deviation(scene, PathTracer{.rr_depth = 0}, 512, 2.5);
    CHECK(path.worst < 8);
    CHECK(std::abs(path.whole) < 4.5);
    const auto nee = deviation(scene, PathTracerNee{.rr_depth = 0}, 512, 2.5);
    CHECK(nee.worst < 8);
    CHECK(std::abs(nee.whole) < 4.5);
    CHECK(std::abs(deviation(scene, PathTracerNee{.max_depth = 2}, 256, 1.6).whole) < 4.5);
}

TEST_CASE("white things vanish in a white environment") {
    const auto test = [](const auto& bsdf, bool both_sides = false) {
        LibraryDescription description = describe_sphere_in_white(bsdf);
        for (auto& material : description.materials) material.two_sided = both_sides;
        const FullScene scene = build(description);
        const auto path = deviation(scene, PathTracer{}, 64, 1);
        CHECK(path.worst < 8);
        const auto nee = deviation(scene, PathTracerNee{}, 256, 1);
        CHECK(nee.worst < 8);
        CHECK(std::abs(nee.whole) < 4.5);
    };
    test(Lambert{Rgb(1)});
    test(Lambert{Rgb(1)}, true);
    test(Conductor{});
    test(Dielectric{});
    test(Dielectric{.eta = 1 / 1.5f});
}

TEST_CASE("rough metal returns no more than it receives, and polished metal nearly all") {
    for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f}) {
        CAPTURE(alpha);
        const FullScene scene = build(
            describe_sphere_in_white(RoughConductor{.distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha}));
        for (const Image& image :
             {render(scene, PathTracer{}, {.samples = 64}), render(scene, PathTracerNee{}, {.samples = 256})}) {
            // Of the path tracer every single sample is at most 1; with light sampling 5 standard errors, as above.
            for (const Rgb& p : image.pixels()) CHECK(p.y < 1.2f);
            CHECK(image.mean().y < 1.0005);
            CHECK(image.mean().y > (alpha < 0.2f ? 0.98 : 0.6));
        }
        const Image path = render(scene, PathTracer{}, {.samples = 64});
        for (const Rgb& p : path.pixels()) CHECK(p.y <= 1 + 1e-5f);
    }
}

namespace {

/// A plane z = 0 of albedo 0.5 from above; the film of 8 x 8 pixels covers `side` x `side` around the origin.
LibraryDescription describe_plane(double side, double scale = 1) {
    LibraryDescription scene;
    scene.add(quad({-4 * scale, -4 * scale, 0}, {4 * scale, -4 * scale, 0}, {4 * scale, 4 * scale, 0},
                   {-4 * scale, 4 * scale, 0}),
              scene.add(Lambert{Rgb(0.5f)}));
    scene.camera.to_world = CameraDescription::look_at({0, 0, 10 * scale}, {0, 0, 0}, {0, 1, 0});
    scene.camera.fov = glm::degrees(2 * std::atan(side / 20));
    scene.film.width = scene.film.height = 8;
    return scene;
}

/// Mean over a pixel of the plane of `radiance(x, y)`: the midpoint rule on 64 x 64 points.
double pixel_mean(int column, int row, double side, const auto& radiance) {
    double sum = 0;
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j)
            sum += radiance(side * ((column + (i + 0.5) / 64) / 8 - 0.5), side * (0.5 - (row + (j + 0.5) / 64) / 8));
    return sum / 4096;
}

}  // namespace

TEST_CASE("a point light falls off with the square of the distance and the cosine") {
    for (const double scale : {1.0, 1e-3, 1000.0}) {
        LibraryDescription description = describe_plane(4, scale);
        description.add(PointSource{DVec3(0.7, -0.4, 1.5) * scale, Rgb(2, 3, 5)});
        const Image image = render(build(description), PathTracerNee{}, {.samples = 1024});
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const double expected = pixel_mean(x, y, 4,
                                                   [&](double px, double py) {
                                                       const double d2 =
                                                           (px - 0.7) * (px - 0.7) + (py + 0.4) * (py + 0.4) + 2.25;
                                                       return 0.5 / std::numbers::pi * 1.5 / (d2 * std::sqrt(d2));
                                                   }) /
                                        (scale * scale);
                // Only the place within the pixel is random, and 1024 Sobol' points leave 1e-4 of that.
                CHECK(image(x, y).x == relative(2 * expected, 1e-3));
                CHECK(image(x, y).y == relative(3 * expected, 1e-3));
                CHECK(image(x, y).z == relative(5 * expected, 1e-3));
            }
    }
}

TEST_CASE("a directional light gives the same irradiance everywhere") {
    LibraryDescription description = describe_plane(4);
    description.add(DirectionalSource{{1, 0, -2}, Rgb(3, 2, 1)});
    const FullScene scene = build(description);
    const Image image = render(scene, PathTracerNee{}, {.samples = 4});
    for (const Rgb& p : image.pixels())
        for (int c = 0; c < 3; ++c)
            CHECK(p[c] == relative(0.5 / std::numbers::pi * (3 - c) * 2 / std::sqrt(5.0), 1e-5));
    // What lies behind: a path tracer cannot meet the light.
    CHECK(render(scene, PathTracer{}, {.samples = 4}).mean().y == 0);
}

TEST_CASE("several sources add up, whichever is chosen") {
    LibraryDescription description = describe_plane(0.5);
    description.add(DirectionalSource{{0, 0, -1}, Rgb(1)});
    description.add(PointSource{{0, 0, 1}, Rgb(2)});
    description.add(EnvironmentSource{Rgb(0.3f)});
    const FullScene scene = build(description);
    // Irradiance 1 + 2 (close to the axis) + 0.3 pi; the middle pixels lie within 0.06 of the axis.
    const double tile = pixel_mean(3, 3, 0.5, [](double x, double y) { return 2 * std::pow(x * x + y * y + 1, -1.5); });
    const auto estimates = replicate(scene, PathTracerNee{}, 1, 32, 256);
    for (const int pixel : {27, 28, 35, 36}) {
        // False alarm: 1e-4 in each of four.
        const Estimate truth{0.5 / std::numbers::pi * (1 + tile + 0.3 * std::numbers::pi), 0};
        CHECK(welch_p(estimates.tiles[std::size_t(3 * pixel + 1)], truth) > 1e-4);
    }
}

TEST_CASE("a luminous rectangle and a luminous sphere irradiate a plane as the form factor says") {
    // Sphere of radius r at height h above the point: irradiance pi L r^2 / h^2 (exact). Its centre pixel is 0.06 wide.
    LibraryDescription description = describe_plane(0.5);
    const std::size_t black = description.add(Lambert{Rgb(0)});
    // Beside the camera's view, over the origin at height 2 seen under 30 degrees.
    description.add(Sphere{{2, 0, 2}, 0.5}, black, Rgb(4));
    const FullScene sphere = build(description);
    const double expected_sphere = pixel_mean(3, 3, 0.5, [](double x, double y) {
        const double d2 = (x - 2) * (x - 2) + y * y + 4;
        return 0.5 * 4 * 0.25 / d2 * (2 / std::sqrt(d2));
    });
    const auto by_sphere = replicate(sphere, PathTracerNee{.max_depth = 2}, 1, 16, 256);
    CHECK(welch_p(by_sphere.tiles[std::size_t(3 * 27 + 1)], {expected_sphere, 0}) > 1e-4);
    CHECK(by_sphere.tiles[std::size_t(3 * 27 + 1)].mean == relative(expected_sphere, 1e-3));

    // A small rectangle facing down, by quadrature.
    LibraryDescription flat = describe_plane(0.5);
    flat.add(quad({1, -0.5, 2}, {1, 0.5, 2}, {2, 0.5, 2}, {2, -0.5, 2}), flat.add(Lambert{Rgb(0)}), Rgb(4));
    const double expected_flat = pixel_mean(3, 3, 0.5, [](double x, double y) {
        double sum = 0;
        for (int i = 0; i < 16; ++i)
            for (int j = 0; j < 16; ++j) {
                const double dx = 1 + (i + 0.5) / 16 - x, dy = -0.5 + (j + 0.5) / 16 - y, d2 = dx * dx + dy * dy + 4;
                sum += 4 / (d2 * d2) / 256;
            }
        return 0.5 / std::numbers::pi * 4 * sum;
    });
    const FullScene lit = build(flat);
    const auto by_flat = replicate(lit, PathTracerNee{.max_depth = 2}, 1, 16, 256);
    CHECK(welch_p(by_flat.tiles[std::size_t(3 * 27 + 1)], {expected_flat, 0}) > 1e-4);
    // 16384 independent samples would be off by 0.1 %, Sobol' points by much less.
    const Image image = render(lit, PathTracerNee{.max_depth = 2}, {.samples = 16384});
    CHECK(image(3, 3).y == relative(expected_flat, 1e-3));
}

TEST_CASE("furnace: roulette leaves the variance of long paths finite") {
    // A closed box shows 1 when its walls shine with what they do not reflect. Half of the light has bounced more than
    // 69 times. Were paths ended with 5 % at least, the estimated variance would grow with the number of samples.
    constexpr float albedo = 0.99f;
    LibraryDescription description;
    description.add(cube().flipped(), description.add(Lambert{Rgb(albedo)}), Rgb(1 - albedo));
    description.camera.to_world = CameraDescription::look_at({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0});
    description.film.width = description.film.height = 8;
    const auto scene = build_as<DiffuseScene>(description);
    Session<DiffuseScene, PathTracer> session(scene, PathTracer{}, {.seed = 3, .sampling = Sampling::independent});
    session.run({.samples = 256});
    const double mean = session.film().image().mean().y;
    double variance = 0;
    for (const Rgb& pixel : session.film().variance().pixels()) variance += double(pixel.y) / (64 * 64);
    // By chance once in 10^6. The lengths of paths have an exponential distribution, whose mean is its deviation.
    CHECK(std::abs(mean - 1) < 5 * std::sqrt(variance));
    CHECK(variance < 2.0 / (64 * 256));
}
