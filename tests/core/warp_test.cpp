#include <lightswitch/core/warp.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <optional>

using namespace lightswitch;
using lightswitch::test::chi_square;
using lightswitch::test::chi_square_sphere;
using lightswitch::test::Random;
using test::relative;

namespace {

constexpr double two_pi = 6.28318530717958647692;

// All chi-square tests of this file together raise a false alarm with probability 1e-6 for a seed chosen at random; the
// seeds are fixed.
constexpr int chi_square_tests = 12;
const double level = test::sidak(1e-6, chi_square_tests);

const float edges[] = {0,    0x1p-24f,        0x1p-12f, 0.25f,        0.5f - 0x1p-24f,
                       0.5f, 0.5f + 0x1p-24f, 0.75f,    1 - 0x1p-12f, 1 - 0x1p-24f};

/// Chi-square of points that should be uniform in the unit square, in 20 x 20 cells.
template <class Map>
test::ChiSquare uniform_square_test(const Map& map, std::uint32_t seed) {
    constexpr int side = 20, samples = 400000;
    std::vector<double> observed(side * side), expected(side * side, static_cast<double>(samples) / (side * side));
    Random random(seed);
    const auto cell = [](double x) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(x * side), 0, side - 1));
    };
    for (int i = 0; i < samples; ++i) {
        const DVec2 p = map(random.next_2d());
        observed[cell(p.x) * side + cell(p.y)] += 1;
    }
    return chi_square(observed, expected);
}

double turn(double y, double x) {
    const double t = std::atan2(y, x) / two_pi;
    return t < 0 ? t + 1 : t;
}

/// Mean of f over the centres of a 512 x 512 grid: the integral over the unit square, to about 1e-5 for smooth maps.
template <class F>
double mean(const F& f) {
    constexpr int n = 512;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            sum += f(Vec2((static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n));
    return sum / (n * n);
}

/// The square's point that `concentric_disk` maps to `p`: radius and angle to the larger coordinate and the ratio.
DVec2 inverse_concentric_disk(const DVec2& p) {
    const double radius = std::hypot(p.x, p.y), major = std::max(std::abs(p.x), std::abs(p.y));
    if (radius == 0) return {0.5, 0.5};
    const double minor = std::min(std::abs(p.x), std::abs(p.y));
    const double side = radius * std::atan2(minor, major) / (two_pi / 8);
    const bool near_x = std::abs(p.x) > std::abs(p.y);
    const DVec2 square(std::copysign(near_x ? radius : side, p.x), std::copysign(near_x ? side : radius, p.y));
    return 0.5 * square + 0.5;
}

double distance(const DVec2& a, const Vec2& b) {
    return std::max(std::abs(a.x - double(b.x)), std::abs(a.y - double(b.y)));
}

}  // namespace

TEST_CASE("warps: the ends of the unit square are safe, also the 1 that no sampler gives") {
    const float ends[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f, 1};
    for (const float x : ends)
        for (const float y : ends) {
            CAPTURE(x);
            CAPTURE(y);
            const Vec2 u(x, y);
            const auto unit = [](const Vec3& v) { return std::abs(double(length_squared(v)) - 1) < 1e-6; };
            CHECK(length_squared(Vec3(concentric_disk(u), 0)) < 1 + 1e-6f);
            CHECK(length_squared(Vec3(uniform_disk(u, 2.5f), 0)) < 2.5f * 2.5f * (1 + 1e-6f));
            CHECK(unit(cosine_hemisphere(u)));
            CHECK(cosine_hemisphere(u).z > 0);
            CHECK(unit(uniform_sphere(u)));
            for (const float cone : {1e-12f, 1e-4f, 1.0f, 2.0f}) {
                CHECK(unit(uniform_cone(u, cone)));
                CHECK(uniform_cone(u, cone).z >= 1 - cone);
            }
            const Vec2 b = uniform_triangle(u);
            CHECK((b.x >= 0 && b.y >= 0 && b.x + b.y <= 1));
        }
}

TEST_CASE("chi-square: the p-value is that of the literature") {
    CHECK(test::gamma_q(0.5, 0.5 * 3.841458820694124) == relative(0.05, 1e-9));
    CHECK(test::gamma_q(5, 0.5 * 18.307038053275146) == relative(0.05, 1e-9));
    CHECK(test::gamma_q(50, 0.5 * 149.449252777) == relative(1e-3, 1e-6));
    CHECK(test::gamma_q(3, 0) == 1);
    CHECK(test::sidak(0.05, 2) == relative(0.0253205655, 1e-8));
}

TEST_CASE("chi-square: wrong densities are found") {
    const auto cosine = [](const Vec3& u) { return std::optional(cosine_hemisphere(Vec2(u))); };
    const auto without_cosine = [](const Vec3& w) { return w.z > 0 ? 1 / two_pi : 0; };
    const auto slightly_wrong = [](const Vec3& w) {
        return double(cosine_hemisphere_pdf(w.z).value) * (1 + 0.05 * double(w.x));
    };
    const auto too_small = [](const Vec3& w) { return 0.97 * double(cosine_hemisphere_pdf(w.z).value); };
    CHECK(chi_square_sphere(cosine, without_cosine, {}, 100000, 1).chi_square.p_value < 1e-12);
    CHECK(chi_square_sphere(cosine, slightly_wrong, {}, 400000, 1).chi_square.p_value < 1e-12);
    CHECK(chi_square_sphere(cosine, too_small, {}, 100000, 1).chi_square.p_value < 1e-12);
}

TEST_CASE("warp: sine and cosine are within 2 units in the last place") {
    double worst_cos = 0, worst_sin = 0;
    const auto ulps = [](float value, double truth) {
        const float t = std::abs(static_cast<float>(truth));
        return std::abs(double(value) - truth) / double(std::nextafter(t, 2.0f) - t);
    };
    for (int i = 1; i <= 1 << 20; ++i) {
        const float x = static_cast<float>(i) * 0x1p-20f;
        const auto [c, s] = detail::cos_sin_quarter_pi(x);
        worst_cos = std::max(worst_cos, ulps(c, std::cos(two_pi / 8 * double(x))));
        worst_sin = std::max(worst_sin, ulps(s, std::sin(two_pi / 8 * double(x))));
    }
    CHECK(worst_cos < 2);
    CHECK(worst_sin < 2);
    CHECK(detail::cos_sin_quarter_pi(0).cos == 1);
    CHECK(detail::cos_sin_quarter_pi(-0.3f).sin == -detail::cos_sin_quarter_pi(0.3f).sin);
}

TEST_CASE("warp: inverses return to the square") {
    Random random(2);
    double disk = 0, hemisphere = 0, sphere = 0, cone = 0, narrow = 0, triangle = 0;
    const auto azimuthal = [](const Vec3& w, double height) {  // the disk whose radius^2 is (1 - w.z) / height
        const double r = std::sqrt((1 - double(w.z)) / height), length = std::hypot(double(w.x), double(w.y));
        return inverse_concentric_disk({double(w.x) / length * r, double(w.y) / length * r});
    };
    for (int i = 0; i < 100000; ++i) {
        const Vec2 u = random.next_2d();
        disk = std::max(disk, distance(inverse_concentric_disk(DVec2(concentric_disk(u))), u));
        const Vec3 up = cosine_hemisphere(u);
        hemisphere = std::max(hemisphere, distance(inverse_concentric_disk({double(up.x), double(up.y)}), u));
        const Vec3 any = uniform_sphere(u);
        if (std::abs(any.z) < 0.99f) sphere = std::max(sphere, distance(azimuthal(any, 2), u));
        const Vec3 within = uniform_cone(u, 0.5f);
        if (within.z < 0.99f) cone = std::max(cone, distance(azimuthal(within, 0.5), u));
        // Narrow: sin(theta) is the radius times sqrt(2 height) where height^2 no longer counts.
        const Vec3 thin = uniform_cone(u, 1e-12f);
        narrow =
            std::max(narrow, distance(inverse_concentric_disk(DVec2(Vec2(thin)) / std::sqrt(2 * double(1e-12f))), u));
        const Vec2 b = uniform_triangle(u);
        const double lift = std::min(b.x, b.y);
        triangle = std::max(triangle, distance(DVec2(b) + lift, u));
    }
    CHECK(disk < 4e-7);
    CHECK(hemisphere < 4e-7);
    CHECK(sphere < 4e-6);
    CHECK(cone < 2e-5);
    CHECK(narrow < 6e-7);
    CHECK(triangle < 2e-7);
}

TEST_CASE("warp: chi-square against independent parametrisations and the stated densities") {
    const auto polar = [](const DVec2& p) { return DVec2(glm::dot(p, p), turn(p.y, p.x)); };
    CHECK(uniform_square_test([&](const Vec2& u) { return polar(DVec2(concentric_disk(u))); }, 11).p_value > level);
    CHECK(uniform_square_test([&](const Vec2& u) { return polar(DVec2(uniform_disk(u, 3)) / 3.0); }, 12).p_value >
          level);
    CHECK(uniform_square_test(
              [](const Vec2& u) {
                  const DVec2 b(uniform_triangle(u));
                  return DVec2((1 - b.x) * (1 - b.x), b.y / (1 - b.x));
              },
              13)
              .p_value > level);
    for (const float height : {2.0f, 0.5f, 1e-4f, 1e-8f}) {
        const auto map = [&](const Vec2& u) {
            const DVec3 w(uniform_cone(u, height));
            const double r_squared = w.x * w.x + w.y * w.y;  // 1 - cos = sin^2 / (1 + cos)
            return DVec2(height < 1 ? r_squared / (1 + w.z) / double(height) : (1 - w.z) / double(height),
                         turn(w.y, w.x));
        };
        CHECK(uniform_square_test(map, 14).p_value > level);
    }

    const auto check = [&](const auto& sample, const auto& pdf, std::uint32_t seed) {
        const auto result = chi_square_sphere([&](const Vec3& u) { return std::optional(sample(Vec2(u))); }, pdf,
                                              {.axis = normalize(Vec3(0.3f, -0.5f, 0.8f))}, 400000, seed);
        CAPTURE(result.chi_square);
        CHECK(result.chi_square.p_value > level);
        CHECK(result.integral == relative(1, 2e-4));
    };
    check([](const Vec2& u) { return cosine_hemisphere(u); },
          [](const Vec3& w) { return double(cosine_hemisphere_pdf(w.z).value); }, 15);
    check([](const Vec2& u) { return uniform_sphere(u); },
          [](const Vec3&) { return double(uniform_sphere_pdf().value); }, 16);
    check([](const Vec2& u) { return uniform_cone(u, 0.7f); },
          [](const Vec3& w) { return w.z > 0.3f ? double(uniform_cone_pdf(0.7f).value) : 0; }, 17);
    check([](const Vec2& u) { return uniform_cone(u, 1.8f); },
          [](const Vec3& w) { return w.z > -0.8f ? double(uniform_cone_pdf(1.8f).value) : 0; }, 18);
    check([](const Vec2& u) { return uniform_cone(u, 2); },
          [](const Vec3&) { return double(uniform_cone_pdf(2).value); }, 19);
}

TEST_CASE("warp: moments have their analytic values") {
    const auto near = [](double value, double truth) { CHECK(value == relative(truth, 2e-4).or_absolute(2e-4 * 0.1)); };
    near(mean([](const Vec2& u) { return square(concentric_disk(u).x); }), 0.25);
    near(mean([](const Vec2& u) { return square(square(concentric_disk(u).y)); }), 0.125);
    near(mean([](const Vec2& u) { return concentric_disk(u).x; }), 0);
    near(mean([](const Vec2& u) { return square(uniform_disk(u, 2).x); }), 1);
    near(mean([](const Vec2& u) { return cosine_hemisphere(u).z; }), 2.0 / 3);
    near(mean([](const Vec2& u) { return square(cosine_hemisphere(u).x); }), 0.25);
    near(mean([](const Vec2& u) { return uniform_sphere(u).z; }), 0);
    near(mean([](const Vec2& u) { return square(uniform_sphere(u).z); }), 1.0 / 3);
    near(mean([](const Vec2& u) { return square(uniform_sphere(u).x); }), 1.0 / 3);
    near(mean([](const Vec2& u) { return uniform_cone(u, 0.4f).z; }), 0.8);
    // <sin^2> / height for a thin cone is 1.
    near(mean([](const Vec2& u) { return length_squared(uniform_cone(u, 1e-10f) * Vec3(1, 1, 0)) * 1e10f; }), 1);
    near(mean([](const Vec2& u) { return uniform_triangle(u).x; }), 1.0 / 3);
    near(mean([](const Vec2& u) { return square(uniform_triangle(u).y); }), 1.0 / 6);
    near(mean([](const Vec2& u) { return uniform_triangle(u).x * uniform_triangle(u).y; }), 1.0 / 12);
}

TEST_CASE("warp: results are inside their domain, to the edges of the square") {
    const auto check = [](const Vec2& u) {
        const Vec2 p = concentric_disk(u), b = uniform_triangle(u);
        bool good = length_squared(Vec3(p, 0)) <= 1 + 4e-7f && b.x >= 0 && b.y >= 0 && b.x + b.y <= 1;
        for (const Vec3& w : {cosine_hemisphere(u), uniform_sphere(u), uniform_cone(u, 1e-9f), uniform_cone(u, 2),
                              uniform_cone(u, 0.3f)})
            good = good && is_finite(w) && std::abs(length_squared(w) - 1) < 1e-6f;
        return good && cosine_hemisphere(u).z > 0 && uniform_cone(u, 0.3f).z > 0.7f - 1e-6f;
    };
    for (const float x : edges)
        for (const float y : edges) {
            CAPTURE(x);
            CAPTURE(y);
            CHECK(check({x, y}));
        }
    Random random(3);
    int bad = 0;
    for (int i = 0; i < 1000000; ++i) bad += check(random.next_2d()) ? 0 : 1;
    CHECK(bad == 0);
    CHECK(concentric_disk({0.5f, 0.5f}) == Vec2(0));
    CHECK(cosine_hemisphere_pdf(-0.5f).value == 0);
}

TEST_CASE("warp: neighbours in the square stay neighbours") {
    // The largest stretch of each map, over steps that cross all seams of its pieces: sqrt(2) would be the least
    // possible for a disk of radius 1 from a square of half its width along the diagonal. A polar map would tear at the
    // angle 0.
    constexpr float step = 1.0f / 512;
    float disk = 0, triangle = 0, hemisphere_xy = 0;
    for (float x = 0; x < 1 - step; x += step)
        for (float y = 0; y < 1 - step; y += step)
            for (const Vec2 d : {Vec2(step, 0), Vec2(0, step)}) {
                const Vec2 u(x, y);
                disk = std::max(disk, glm::length(concentric_disk(u + d) - concentric_disk(u)) / step);
                triangle = std::max(triangle, glm::length(uniform_triangle(u + d) - uniform_triangle(u)) / step);
                hemisphere_xy = std::max(
                    hemisphere_xy, glm::length(Vec2(cosine_hemisphere(u + d)) - Vec2(cosine_hemisphere(u))) / step);
            }
    CHECK(disk < 2.6f);
    CHECK(triangle < 1.2f);
    CHECK(hemisphere_xy < 2.6f);
}
