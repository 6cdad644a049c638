#include "support/relative.hpp"
#include "support/renders.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

using TinyScene = Scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>;

/// Columns left of `edge` are black, the others see an environment of radiance 1. On a film of width 16 at distance 1
/// from the pinhole, 8 pixels are one unit, and +x is to the left.
SceneDescription<Lambert> describe_step(double edge, const Filter& filter) {
    SceneDescription<Lambert> scene;
    const double x = 1 - edge / 8;
    scene.add(quad({x, -9, 1}, {9, -9, 1}, {9, 9, 1}, {x, 9, 1}), scene.add(Lambert{Rgb(0)}));
    scene.add(EnvironmentSource{});
    scene.camera.fov = 90;
    scene.film = {.width = 16, .height = 4, .filter = filter, .origin = {}};
    return scene;
}

TinyScene tiny(int width, int height) {
    SceneDescription<Lambert> scene = describe_step(8, Filter::box());
    scene.film.width = width;
    scene.film.height = height;
    return build_scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>(scene);
}

struct Sky {
    static constexpr std::string_view name = "sky";
    static constexpr Kind kind = Kind::heuristic;
    Rgb radiance(const auto& scene, const Ray& ray, auto&) const {
        return scene.intersect(ray) ? Rgb(0) : scene.environment(ray.direction);
    }
};

/// 1 with a known probability, else 0.
struct Coin {
    static constexpr std::string_view name = "coin";
    static constexpr Kind kind = Kind::heuristic;
    float probability = 0.25f;
    float head = 1;
    Rgb radiance(const auto&, const Ray&, auto& sampler) const {
        return Rgb(sampler.next_1d() < probability ? head : 0);
    }
};

/// Whatever the function does with a frame.
template <class F>
struct Custom {
    static constexpr std::string_view name = "custom";
    static constexpr Kind kind = Kind::heuristic;
    F f;
    int start(auto&) const { return 0; }
    void iterate(auto& frame, int&) const { f(frame); }
};

}  // namespace

TEST_CASE("slots and splats of an iteration add up, and iterations are averaged") {
    Film film(3, 2);
    const SerialExecutor serial;
    CHECK(film.image().mean() == DVec3(0));
    CHECK(film.variance().mean() == DVec3(0));
    CHECK(std::isinf(film.relative_error()));
    for (const float value : {1.0f, 2.0f, 4.0f, 9.0f}) {
        film.slot(1) = Rgb(value, 2 * value, 0);
        const Splat splats[] = {{5, Rgb(value)}, {1, Rgb(10)}, {5, Rgb(1)}};
        film.add(splats);
        film.commit(serial);
    }
    CHECK(film.iterations() == 4);
    const Image image = film.image(), variance = film.variance();
    CHECK(image(1, 0) == Rgb(14, 18, 10));
    CHECK(image(2, 1) == Rgb(5));
    CHECK(image(0, 0) == Rgb(0));
    // 1, 2, 4, 9: squared deviations from the mean add up to 38, over 4 * 3.
    CHECK(variance(1, 0).x == relative(38.0 / 12, 1e-5));
    CHECK(variance(1, 0).y == relative(4 * 38.0 / 12, 1e-5));
    CHECK(variance(1, 0).z == 0);
    CHECK(variance(2, 1).x == relative(38.0 / 12, 1e-5));
    // Mean level (14 + 18 + 10 + 15) / 18; mean square error 38/12 * (1 + 4 + 3) / 18.
    CHECK(film.relative_error() == relative(std::sqrt(38.0 / 12 * 8 / 18) / (57.0 / 18), 1e-5));
}

TEST_CASE("the error of a black image is not known") {
    Film film(3, 2);
    const SerialExecutor serial;
    for (int i = 0; i < 20; ++i) film.commit(serial);
    CHECK(std::isinf(film.relative_error()));
    film.slot(1) = Rgb(1);
    film.commit(serial);
    CHECK(std::isfinite(film.relative_error()));
}

TEST_CASE("what is discarded leaves no trace") {
    Film film(2, 1);
    const SerialExecutor serial;
    film.slot(0) = Rgb(7);
    const Splat splats[] = {{1, Rgb(3)}};
    film.add(splats);
    film.discard(serial);
    CHECK(film.iterations() == 0);
    film.slot(1) = Rgb(1);
    film.commit(serial);
    film.commit(serial);
    CHECK(film.image()(0, 0) == Rgb(0));
    CHECK(film.image()(1, 0) == Rgb(0.5f));
}

TEST_CASE("impossible sizes are errors") {
    CHECK_THROWS_AS(Film(0, 4), Error);
    CHECK_THROWS_AS(Film(4, -1), Error);
    CHECK_THROWS_AS(Film(65536, 65536), Error);
}

TEST_CASE("large constant values have no variance") {
    Film film(1, 1);
    for (int i = 0; i < 1000; ++i) {
        film.slot(0) = Rgb(12345.678f);
        film.commit(SerialExecutor{});
    }
    CHECK(film.image()(0, 0).x == 12345.678f);
    CHECK(std::sqrt(film.variance()(0, 0).x) < 1e-6 * 12345);
}

TEST_CASE("the variance of a known distribution") {
    const TinyScene scene = tiny(64, 64);
    constexpr int samples = 64;
    constexpr double p = 0.25, exact = p * (1 - p) / samples;
    const Settings settings{.seed = 11, .sampling = Sampling::independent};
    const Coin coin;
    Session<TinyScene, Coin> session(scene, coin, settings);
    session.run({.samples = samples});
    const Image image = session.film().image(), variance = session.film().variance();
    double sum = 0, sum_of_squares = 0, errors = 0;
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
        const double v = double(variance.pixels()[i].x), error = double(image.pixels()[i].x) - p;
        sum += v;
        sum_of_squares += v * v;
        errors += error * error;
    }
    const double n = double(image.pixels().size()), mean = sum / n;
    const double error_of_mean = std::sqrt((sum_of_squares / n - mean * mean) / n);
    // Five standard errors each: 6e-7. The mean of the squared errors of binomial numbers scatters like chi-square.
    CHECK(std::abs(mean - exact) < 5 * error_of_mean);
    CHECK(std::abs(errors / n - exact) < 5 * exact * std::sqrt(2 / n));
    CHECK(session.film().relative_error() == relative(std::sqrt(exact) / p, 0.05));
}

TEST_CASE("Sobol' points put the right share of every pixel's samples into an interval") {
    const TinyScene scene = tiny(32, 32);
    const Coin coin;
    Session<TinyScene, Coin> session(scene, coin);
    session.run({.samples = 64});
    // A quarter of the unit interval holds a quarter of 64 points of a (0,2)-sequence exactly, whatever the digital
    // shift.
    for (const Rgb& p : session.film().image().pixels()) CHECK(p.x == 0.25f);
    // The estimate from the spread knows nothing of that.
    CHECK(session.film().variance().mean().x == relative(0.25 * 0.75 / 63, 1e-6));
}

TEST_CASE("values that are not finite are counted, named and replaced by black") {
    const TinyScene scene = tiny(40, 20);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity})
        for (const Sampling sampling : {Sampling::sobol, Sampling::independent}) {
            const Coin coin{.probability = 0.02f, .head = bad};
            Session<TinyScene, Coin> session(scene, coin, {.seed = 9, .sampling = sampling});
            session.run({.samples = 4});
            const RenderCounts& counts = session.statistics().counts;
            // 3200 trials of probability 0.02: 64 +- 8; at six standard deviations a false alarm is 2e-9.
            CHECK(counts.non_finite > 16);
            CHECK(counts.non_finite < 112);
            REQUIRE(counts.first_non_finite.size() == 16);
            CHECK(std::is_sorted(counts.first_non_finite.begin(), counts.first_non_finite.end()));
            for (const NonFinite& found : counts.first_non_finite) {
                // Replayed from what was noted: the numbers of that pixel in that iteration.
                CHECK(found.seed == 9);
                CHECK(found.iteration < 4);
                REQUIRE(found.pixel < 800);
                const IterationPoints points(sampling, found.seed, found.iteration);
                Sampler sampler(points, 0, found.pixel);
                sampler.next_2d();  // the place within the pixel
                CHECK(sampler.next_1d() < 0.02f);
            }
            CHECK(session.film().image().mean() == DVec3(0));

            Session<TinyScene, Coin, SerialExecutor> serial(scene, coin, {.seed = 9, .sampling = sampling}, {});
            serial.run({.samples = 4});
            CHECK(serial.statistics().counts.non_finite == counts.non_finite);
            CHECK(serial.statistics().counts.first_non_finite == counts.first_non_finite);
        }
}

TEST_CASE("splats off the film are ignored, and those that are not finite are counted") {
    const TinyScene scene = tiny(4, 3);
    const auto run = [&](const auto& f) {
        const Custom method{f};
        Session<TinyScene, std::remove_cvref_t<decltype(method)>> session(scene, method, {.seed = 2});
        session.run({.samples = 1});
        return std::pair(session.film().image(), session.statistics().counts);
    };
    const auto splat = [&](const Vec2& at, const Rgb& value) {
        return run([=](auto& frame) {
            frame.paths(1, [=](std::uint64_t, auto&, auto& splatter) { splatter.splat(at, value); });
        });
    };
    for (const Vec2 at :
         {Vec2(-1e-6f, 1), Vec2(1, -0.5f), Vec2(4, 1), Vec2(1, 3), Vec2(3e38f, 0), Vec2(-1e30f, 1e30f)}) {
        const auto [image, counts] = splat(at, Rgb(1));
        CHECK(image.mean() == DVec3(0));
        CHECK(counts.splats == 0);
        CHECK(counts.non_finite == 0);
    }
    for (const Vec2 at : {Vec2(infinity, 0), Vec2(1, -infinity), Vec2(std::numeric_limits<float>::quiet_NaN(), 1)}) {
        const auto [image, counts] = splat(at, Rgb(1));
        CHECK(image.mean() == DVec3(0));
        CHECK(counts.splats == 0);
        CHECK(counts.non_finite == 1);
    }
    const auto [corner, corner_counts] = splat({3.9999f, 2.9999f}, Rgb(1, 2, 3));
    CHECK(corner(3, 2) == Rgb(1, 2, 3));
    CHECK(corner_counts.splats == 1);
    CHECK(splat({0, 0}, Rgb(1)).first(0, 0) == Rgb(1));

    const auto [nan, nan_counts] = splat({2.5f, 1.5f}, Rgb(0, std::numeric_limits<float>::quiet_NaN(), 0));
    CHECK(nan.mean() == DVec3(0));
    CHECK(nan_counts.splats == 0);
    CHECK(nan_counts.non_finite == 1);
    REQUIRE(nan_counts.first_non_finite.size() == 1);
    CHECK(nan_counts.first_non_finite[0] == NonFinite{.iteration = 0, .seed = 2, .pixel = 1 * 4 + 2});
}

TEST_CASE("every filter keeps a constant image constant") {
    for (const Filter& filter :
         {Filter::box(), Filter::tent(), Filter::tent(2.5f), Filter::gaussian(), Filter::gaussian(1.5f)}) {
        const TinyScene scene = build_scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>(describe_step(-1000, filter));
        for (const Rgb& p : render(scene, Sky{}, {.samples = 16}).pixels()) CHECK(p == Rgb(1));
    }
}

TEST_CASE("a step becomes the integral of the filter") {
    const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
    const auto box = [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); };
    const auto tent = [](double radius) {
        return [=](double x) {
            const double t = std::clamp(x / radius, -1.0, 1.0);
            return 0.5 + t - 0.5 * t * std::abs(t);
        };
    };
    const auto gaussian = [&](double sigma) {
        return [=](double x) {
            const double t = std::clamp(x / sigma, -4.0, 4.0), shift = std::exp(-8) / std::sqrt(2 * std::numbers::pi);
            return (normal(t) - normal(-4) - shift * (t + 4)) / (normal(4) - normal(-4) - shift * 8);
        };
    };
    const auto check = [&](const Filter& filter, const auto& cumulative) {
        for (const double edge : {8.0, 7.3, 5.81}) {
            const TinyScene scene =
                build_scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>(describe_step(edge, filter));
            const Image image = render(scene, Sky{}, {.samples = 4096});
            for (int x = 0; x < 16; ++x) {
                CAPTURE(filter.name());
                CAPTURE(x);
                // 4096 Sobol' points fill an interval to within 2 of them; the rest is the float camera.
                for (int y = 0; y < 4; ++y)
                    CHECK(std::abs(double(image(x, y).x) - (1 - cumulative(edge - x - 0.5))) < 1e-3);
            }
        }
    };
    check(Filter::box(), box);
    check(Filter::tent(), tent(1));
    check(Filter::tent(2), tent(2));
    check(Filter::gaussian(), gaussian(0.5));
    check(Filter::gaussian(1), gaussian(1));
}

namespace {

/// An image made by splats alone: `value(x, y)` over a film of 8 x 4 pixels and its surroundings, by the midpoint rule.
template <class F>
Image splatted(const Filter& filter, const F& value) {
    SceneDescription<Lambert> scene = describe_step(-1000, filter);
    scene.film.width = 8;
    scene.film.height = 4;
    constexpr int fine = 16, margin = 8;
    const auto splat_all = [&](auto& frame) {
        frame.paths(std::uint64_t((8 + 2 * margin) * fine), [&](std::uint64_t i, auto&, auto& splatter) {
            for (int j = 0; j < (4 + 2 * margin) * fine; ++j) {
                const Vec2 at((float(i) + 0.5f) / fine - margin, (float(j) + 0.5f) / fine - margin);
                splatter.splat(at, Rgb(value(at) / (fine * fine)));
            }
        });
    };
    const auto built = build_scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>(scene);
    return render(built, Custom{splat_all}, {.samples = 1});
}

}  // namespace

TEST_CASE("splats go through the film's filter: a constant stays constant up to the border") {
    for (const Filter& filter : {Filter::box(), Filter::tent(), Filter::tent(2.5f), Filter::tent(0.5f),
                                 Filter::gaussian(), Filter::gaussian(1.5f)}) {
        CAPTURE(filter.name());
        CAPTURE(filter.radius());
        const Image image = splatted(filter, [](const Vec2&) { return 1.0f; });
        // The midpoint rule is exact for tents that begin between the splats, and nearly so for smooth weights.
        for (const Rgb& p : image.pixels()) CHECK(p.x == relative(1, 3e-3));
    }
}

TEST_CASE("splats go through the film's filter: as samples of the pixels would") {
    // Bright and dark, on the film and beside it; the edges are between the splats.
    const auto scene = [](const Vec2& at) {
        return (at.x < 2.25f ? 3.0f : 1.0f) + (at.y > 3.625f ? 0.5f : 0.0f) * at.x;
    };
    for (const Filter& filter :
         {Filter::box(), Filter::tent(), Filter::tent(2.5f), Filter::gaussian(), Filter::gaussian(1.5f)}) {
        CAPTURE(filter.name());
        CAPTURE(filter.radius());
        const Image image = splatted(filter, scene);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 8; ++x) {
                // 256 x 256 midpoints of the unit square, mapped by the filter as camera rays are.
                double sum = 0;
                for (int i = 0; i < 256; ++i)
                    for (int j = 0; j < 256; ++j) {
                        const Vec2 u((float(i) + 0.5f) / 256, (float(j) + 0.5f) / 256);
                        sum += double(scene(Vec2(float(x) + 0.5f, float(y) + 0.5f) + filter.sample(u)));
                    }
                // 256 points place an edge to within 1/256 of the light on its other side, which is at most 4.
                CAPTURE(x);
                CAPTURE(y);
                CHECK(std::abs(double(image(x, y).x) - sum / 65536) < 0.02);
            }
    }
}

TEST_CASE("a splat spreads to the pixels within the filter's radius, by its weights") {
    const Filter filter = Filter::tent(1.25f);
    SceneDescription<Lambert> description = describe_step(-1000, filter);
    const auto scene = build_scene<Bsdfs<Lambert>, Lights<ConstantEnvironment>>(description);
    for (const Vec2 at :
         {Vec2(3.2f, 1.9f), Vec2(0.1f, 0.2f), Vec2(15.9f, 3.9f), Vec2(-0.5f, 2), Vec2(16.6f, 4.7f), Vec2(7, 2)}) {
        const auto splat_one = [&](auto& frame) {
            frame.paths(1, [&](std::uint64_t, auto&, auto& splatter) { splatter.splat(at, Rgb(1, 2, 4)); });
        };
        const Image image = render(scene, Custom{splat_one}, {.samples = 1});
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 16; ++x) {
                const float weight = filter.pdf(at - Vec2(float(x) + 0.5f, float(y) + 0.5f));
                CHECK(image(x, y).x == relative(double(weight), 1e-5));
                CHECK(image(x, y).z == relative(4 * double(weight), 1e-5));
            }
    }
    // Not finite, value or place: counted once, whatever the number of pixels. Far away: nothing.
    const auto splat_nan = [&](auto& frame) {
        frame.paths(1, [](std::uint64_t, auto&, auto& splatter) {
            splatter.splat({3.2f, 1.9f}, Rgb(infinity));
            splatter.splat({3.2f, std::numeric_limits<float>::quiet_NaN()}, Rgb(1));
            splatter.splat({infinity, 1.9f}, Rgb(1));
            splatter.splat({3e38f, 1.9f}, Rgb(infinity));
            splatter.splat({-3e38f, 3e38f}, Rgb(1));
        });
    };
    const Custom method{splat_nan};
    Session<TinyScene, std::remove_cvref_t<decltype(method)>> session(scene, method);
    session.run({.samples = 1});
    CHECK(session.statistics().counts.non_finite == 3);
    CHECK(session.film().image().mean() == DVec3(0));
}
