#include <lightswitch/film/filter.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::relative;

namespace {

/// Distribution function in one axis, from the filter's definition and the error function of the maths library.
double cumulative(const Filter& filter, double x) {
    const double r = double(filter.radius()), t = std::clamp(x / r, -1.0, 1.0);
    if (filter.kind() == Filter::Kind::box) return 0.5 + 0.5 * t;
    if (filter.kind() == Filter::Kind::tent) return t < 0 ? 0.5 * (1 + t) * (1 + t) : 1 - 0.5 * (1 - t) * (1 - t);
    const auto half = [](double z) {
        return std::sqrt(std::acos(-1.0) / 2) * std::erf(z / std::sqrt(2.0)) - z * std::exp(-8.0);
    };
    return 0.5 + 0.5 * half(4 * t) / half(4);
}

const Filter filters[] = {Filter::box(), Filter::tent(), Filter::tent(2.5f), Filter::gaussian(),
                          Filter::gaussian(1.7f)};

}  // namespace

TEST_CASE("filter: samples are the inverse of the distribution") {
    for (const Filter& filter : filters) {
        CAPTURE(filter.name());
        double worst = 0;
        bool rising = true;
        float previous = -infinity;
        for (int i = 0; i <= 1 << 17; ++i) {
            const float u = std::min(static_cast<float>(i) * 0x1p-17f, 1 - 0x1p-24f);
            const Vec2 p = filter.sample({u, 0.25f});
            worst = std::max(worst, std::abs(cumulative(filter, double(p.x)) - double(u)));
            rising = rising && p.x >= previous && std::abs(p.x) <= filter.radius();
            previous = p.x;
        }
        CHECK(worst < 1e-6);
        CHECK(rising);
        CHECK(filter.sample({0.5f, 0.5f}) == Vec2(0));
        CHECK(filter.sample({0.3f, 0.8f}).y == filter.sample({0.8f, 0.3f}).x);
    }
}

TEST_CASE("filter: the ends of the unit square are safe, also the 1 that no sampler gives") {
    for (const Filter& filter : filters)
        for (const float x : {0.0f, 0x1p-24f, 1 - 0x1p-24f, 1.0f}) {
            CAPTURE(filter.name());
            CAPTURE(x);
            const Vec2 p = filter.sample({x, 0.5f});
            CHECK(std::abs(p.x) <= filter.radius());
            CHECK(std::abs(p.x) > 0.98f * filter.radius());
            CHECK(p.y == 0);
        }
}

TEST_CASE("filter: the density is that of the samples and integrates to 1") {
    // Chi-square over 16 x 16 cells of the square |offset| <= radius, seeds fixed; false alarms: 1e-6 for all five
    // together.
    const double level = test::sidak(1e-6, 5);
    for (const Filter& filter : filters) {
        CAPTURE(filter.name());
        constexpr int side = 16, samples = 400000;
        const double r = double(filter.radius()), step = 2 * r / side;
        std::vector<double> expected, observed(side * side);
        double integral = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const DVec2 low(-r + i * step, -r + j * step);
                expected.push_back(
                    samples * test::integrate([&](double x, double y) { return double(filter.pdf(Vec2(DVec2(x, y)))); },
                                              low, low + step, 1e-8));
                integral += expected.back() / samples;
            }
        CHECK(integral == relative(1, 1e-5));
        test::Random random(5);
        for (int i = 0; i < samples; ++i) {
            const DVec2 cell = glm::clamp((DVec2(filter.sample(random.next_2d())) + r) / step, 0.0, side - 1.0);
            observed[static_cast<std::size_t>(cell.x) * side + static_cast<std::size_t>(cell.y)] += 1;
        }
        CHECK(test::chi_square(observed, expected).p_value > level);
        CHECK(filter.pdf({1.01f * filter.radius(), 0}) == 0);
        CHECK(filter.pdf({0, 0.1f}) == filter.pdf({0.1f, 0}));
    }
    // A tent of another radius is told apart.
    test::Random random(6);
    std::vector<double> observed(10), expected(10, 1000);
    for (int i = 0; i < 10000; ++i)
        observed[static_cast<std::size_t>(std::clamp(
            10 * cumulative(Filter::tent(1.1f), double(Filter::tent(1).sample(random.next_2d()).x)), 0.0, 9.9))] += 1;
    CHECK(test::chi_square(observed, expected).p_value < 1e-6);
}

TEST_CASE("filter: known values") {
    CHECK(Filter::box().pdf({0.2f, -0.4f}) == 1);
    CHECK(Filter::tent().pdf({0, 0}) == 1);
    CHECK(Filter::tent(2).pdf({1, 0}) == relative(0.125, 1e-5));
    CHECK(Filter::tent().sample({0.125f, 0.5f}).x == relative(-0.5, 1e-5));
    // The Gaussian keeps nearly its own variance: 0.25 for the standard deviation 0.5.
    double variance = 0;
    for (int i = 0; i < 10000; ++i)
        variance += 1e-4 * double(square(Filter::gaussian().sample({(static_cast<float>(i) + 0.5f) * 1e-4f, 0}).x));
    CHECK(variance == relative(0.25, 0.01));
    CHECK(Filter::gaussian().radius() == 2);
    CHECK(Filter::gaussian().name() == "gaussian");
    CHECK(Filter::tent().name() == "tent");
    CHECK(Filter::box().name() == "box");
}

TEST_CASE("filter: impossible radii are explained") {
    CHECK(Filter::box().problem() == "");
    CHECK(Filter::gaussian(0.5f).problem() == "");
    for (const float r : {0.0f, -1.0f, infinity, NAN})
        CHECK(Filter::tent(r).problem().find("radius") != std::string::npos);
    CHECK(Filter::gaussian(-1).problem().find("four standard deviations") != std::string::npos);
}
