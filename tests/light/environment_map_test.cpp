// The environment map shows what its texels say, where Mitsuba shows it, and is sampled with the density it states.

#include <lightswitch/light/constant_environment.hpp>
#include <lightswitch/light/environment_map.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"
#include "../support/statistics.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <string>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

static_assert(EnvironmentLight<MappedEnvironment> && EmittingLight<MappedEnvironment>);

// False alarms, were the seeds drawn at random (they are fixed): all chi-square tests of this file together 1e-6; a
// mean may be off by 5 standard errors, 6e-7 each.
constexpr int chi_square_tests = 80;
const double level = sidak(1e-6, chi_square_tests);

constexpr double pi_d = 3.14159265358979323846;
constexpr float largest_u = 1 - 0x1p-24f;

const glm::mat3 identity(1);
/// 40 degrees around (0.48, 0.6, 0.64), column by column.
const glm::mat3 turned(0.8199478f, 0.47876325f, -0.31380144f, -0.34400484f, 0.8502684f, 0.39837694f, 0.4575437f,
                       -0.21869908f, 0.8618726f);

struct Map {
    std::string name;
    int width, height;
    std::vector<Rgb> texels;

    MappedEnvironment light(const glm::mat3& to_world = identity, float scale = 1, float radius = 1.5f) const {
        return {std::make_shared<const EnvironmentMap>(texels, width, height), to_world, scale, radius};
    }
    /// Bands of cells: there are none between the rows of a map with one row, and one with two is taken to have three.
    int bands() const { return height == 1 ? 1 : std::max(height, 3) - 1; }
};

Map made(const std::string& name, int width, int height, const std::function<Rgb(int column, int row)>& value) {
    Map map{name, width, height, {}};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) map.texels.push_back(value(column, row));
    return map;
}

/// A map like noise, from `low` to `high` in even steps of the logarithm.
Map noise(const std::string& name, int width, int height, double low, double high, std::uint32_t seed) {
    Random random(seed);
    return made(name, width, height, [&](int, int) {
        const auto value = [&] { return static_cast<float>(low * std::pow(high / low, double(random.next()))); };
        const float red = value(), green = value();
        return Rgb(red, green, value());
    });
}

/// Black but for the texels that `lit` says.
Map dots(const std::string& name, int width, int height, const std::function<bool(int column, int row)>& lit,
         float background = 0, float value = 1) {
    return made(name, width, height, [&](int column, int row) { return Rgb(lit(column, row) ? value : background); });
}

/// Maps that break what samples them badly.
std::vector<Map> maps() {
    return {
        dots("constant", 6, 4, [](int, int) { return true; }),
        noise("noise", 9, 7, 0.1, 2, 1),
        noise("extreme", 12, 9, 1e-3, 1e6, 2),
        dots(
            "hot texel", 16, 9, [](int c, int r) { return c == 5 && r == 3; }, 1, 1e4f),
        dots("hot texel alone", 16, 9, [](int c, int r) { return c == 5 && r == 3; }),
        dots(
            "hot texel in the top row", 8, 5, [](int c, int r) { return c == 2 && r == 0; }, 0.1f, 50),
        dots("hot texel in the bottom row", 8, 5, [](int c, int r) { return c == 7 && r == 4; }),
        dots("first column", 8, 5, [](int c, int) { return c == 0; }),
        dots(
            "last column", 8, 5, [](int c, int) { return c == 7; }, 0.01f),
        dots("mostly black", 15, 11, [](int c, int r) { return (c * 7 + r * 5) % 31 == 0; }),
        dots("lower half", 8, 6, [](int, int r) { return r > 3; }),
        noise("one row", 7, 1, 0.1, 10, 3),
        noise("one column", 1, 7, 0.1, 10, 4),
        noise("two rows", 5, 2, 0.1, 10, 5),
        noise("one texel", 1, 1, 1, 10, 6),
        noise("odd", 3, 3, 0.01, 10, 7),
    };
}

/// A point somewhere, on a surface with that normal.
SurfacePoint point(const Vec3& normal) {
    SurfacePoint at{};
    at.normal = at.shading_normal = at.wo = normal;
    return at;
}

/// Direction of the map at the fraction `u` of the width from the left edge, and at that angle from the top.
Vec3 direction(double u, double theta) {
    const double phi = 2 * pi_d * u;
    return Vec3(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
}

/// Cells between the middles of columns and between rows, cut in two both ways.
struct Cells {
    int columns, bands;

    explicit Cells(const Map& map) : columns(2 * map.width), bands(map.bands()) {}

    double height(int edge) const {  // (1 - cos) / 2, in the middle of each band, too
        const auto at = [&](int band) { return 0.5 - 0.5 * std::cos(pi_d * band / bands); };
        return edge % 2 == 0 ? at(edge / 2) : 0.5 * (at(edge / 2) + at(edge / 2 + 1));
    }
    std::size_t index(const Vec3& wi) const {
        double u = std::atan2(double(wi.x), -double(wi.z)) / (2 * pi_d) - 1.0 / columns;
        u -= std::floor(u);
        const double sine = std::hypot(double(wi.x), double(wi.z)), theta = std::atan2(sine, double(wi.y));
        const int band = std::min(static_cast<int>(theta / pi_d * bands), bands - 1);
        const double h = theta < pi_d / 2 ? 0.5 * sine * sine / (1 + double(wi.y)) : 0.5 * (1 - double(wi.y));
        const int half = 2 * band + (h >= height(2 * band + 1));
        return static_cast<std::size_t>(half * columns + std::min(static_cast<int>(u * columns), columns - 1));
    }
    /// Integrals of a function that is smooth in each cell.
    std::vector<double> integrals(const std::function<double(const Vec3&)>& f) const {
        std::vector<double> result;
        constexpr int points = 10;
        for (int half = 0; half < 2 * bands; ++half)
            for (int column = 0; column < columns; ++column) {
                double sum = 0;
                for (int i = 0; i < points; ++i)
                    for (int j = 0; j < points; ++j) {
                        const double low = height(half), high = height(half + 1);
                        const double h = low + (high - low) * (i + 0.5) / points;
                        sum += f(direction((column + 1 + (j + 0.5) / points) / columns, std::acos(1 - 2 * h)));
                    }
                result.push_back(sum / points / points * 4 * pi_d * (height(half + 1) - height(half)) / columns);
            }
        return result;
    }
};

/// Whether directions follow the density; none of density 0 may come.
void check_density(const Map& map, const std::function<Vec3(const Vec2&)>& sample,
                   const std::function<double(const Vec3&)>& pdf, std::uint32_t seed) {
    CAPTURE(map.name);
    constexpr int samples = 200000;
    const Cells cells(map);
    std::vector<double> expected = cells.integrals(pdf), observed(expected.size());
    const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
    CHECK(integral == relative(1, 1e-3));  // of the quadrature, at the horizon
    for (double& e : expected) e *= samples / integral;
    Random random(seed);
    for (int i = 0; i < samples; ++i) observed[cells.index(sample(random.next_2d()))] += 1;
    const ChiSquare result = chi_square(observed, expected);
    CAPTURE(result);
    CHECK(result.p_value > level);
}

/// Integral of `f` over the sphere: midpoints in the angles.
DVec3 over_sphere(const std::function<DVec3(const Vec3&)>& f, int steps = 600) {
    DVec3 sum(0);
    for (int i = 0; i < steps; ++i) {
        const double theta = pi_d * (i + 0.5) / steps;
        DVec3 ring(0);
        for (int j = 0; j < 2 * steps; ++j) ring += f(direction((j + 0.5) / (2 * steps), theta));
        sum += ring * std::sin(theta);
    }
    return sum * (pi_d / steps) * (pi_d / steps);
}

const Vec3 normals[] = {{0, 1, 0}, normalize(Vec3(0.3f, -0.6f, 0.5f))};

struct Seen {
    DVec3 wi, value;
};

}  // namespace

// Values of Mitsuba 3.9.1: `eval` of the plugin `envmap` in the variant scalar_rgb, given the bitmap below, `scale` and
// `to_world` (made by its rotate([0.48, 0.6, 0.64], 40)), for the normalized directions.
TEST_CASE("environment map: what is seen where is as in Mitsuba") {
    const auto value = [](int c, int r) { return Rgb(c + 1, 10 * (r + 1), (c + 1) * (r * r + 1)); };
    const auto check = [](const MappedEnvironment& light, const std::vector<Seen>& seen) {
        for (const Seen& one : seen) {
            const Rgb found = light.radiance(Vec3(glm::normalize(one.wi)));
            CAPTURE(one.wi.x);
            CAPTURE(one.wi.y);
            CAPTURE(one.wi.z);
            for (int c = 0; c < 3; ++c) CHECK(double(found[c]) == relative(one.value[c], 5e-6));
        }
    };
    const Map five = made("5 x 4", 5, 4, value);
    check(five.light(), {
                            {{1, 0, 0}, {1.75, 25.0, 6.125}},
                            {{-1, 0, 0}, {4.25, 25.0, 14.875}},
                            {{0, 0, 1}, {3.0, 25.0, 10.5}},
                            {{0, 0, -1}, {3.0, 25.0, 10.5}},
                            {{1, .2, -1}, {1.125, 23.65842, 3.484718}},
                            {{-.3, .5, .8}, {3.2855, 19.94393, 6.552579}},
                            {{.1, -.9, .2}, {2.631041, 37.67455, 23.25123}},
                            {{-1, .3, -2}, {4.475836, 23.72643, 13.95534}},
                            {{.05, .1, -1}, {2.840977, 24.04942, 9.133243}},
                            {{-.05, .1, -1}, {3.159024, 24.04941, 10.15571}},
                            {{.7, 2, -.1}, {1.637082, 13.2452, 2.168348}},
                            {{.001, 1, .002}, {2.631041, 10.02137, 2.636663}},
                            {{.01, -1, -.01}, {1.125, 39.86498, 11.17406}},
                        });
    check(five.light(turned, 2.5f), {
                                        {{1, 0, 0}, {5.387577, 70.88377, 24.27671}},
                                        {{-1, 0, 0}, {11.63758, 54.11623, 29.0235}},
                                        {{0, 0, 1}, {8.19466, 52.71802, 19.06211}},
                                        {{0, 0, -1}, {4.721364, 72.28198, 22.06689}},
                                        {{1, .2, -1}, {3.679747, 72.34273, 17.22536}},
                                        {{-.3, .5, .8}, {8.548203, 37.98743, 12.98897}},
                                        {{.1, -.9, .2}, {9.054544, 83.72021, 61.06423}},
                                        {{-1, .3, -2}, {7.67251, 64.59434, 28.78205}},
                                        {{.7, 2, -.1}, {4.117651, 44.9931, 7.410635}},
                                    });
    check(made("3 x 2", 3, 2, value).light(), {
                                                  {{.1, 1, .1}, {1.625, 10.89439, 1.770337}},
                                                  {{1, 1, 0}, {1.25, 15.0, 1.875}},
                                                  {{1, -1, 0}, {1.25, 20.0, 2.5}},
                                                  {{.1, -1, .2}, {1.778625, 20.0, 3.557249}},
                                              });
    check(made("1 x 3", 1, 3, value).light(), {
                                                  {{1, .2, -1}, {1.0, 19.105614, 1.9105614}},
                                                  {{.1, -.9, .2}, {1.0, 28.449697, 4.5349092}},
                                              });
    check(made("3 x 1", 3, 1, value).light(), {
                                                  {{1, .2, -1}, {1.25, 10.0, 1.25}},
                                                  {{-.3, .5, .8}, {2.1713002, 10.0, 2.1713002}},
                                              });
}

TEST_CASE("environment map: directions are sampled with the density that is stated") {
    std::uint32_t seed = 1;
    for (const Map& map : maps()) {
        const MappedEnvironment light = map.light();
        for (const Vec3& normal : normals) {
            const SurfacePoint at = point(normal);
            check_density(
                map, [&](const Vec2& u) { return light.sample(at, u).wi; },
                [&](const Vec3& wi) { return double(light.pdf(normal, wi).value); }, seed++);
        }
    }
}

TEST_CASE("environment map: emission has the density that is stated, in direction and place") {
    std::uint32_t seed = 100;
    for (const Map& map : maps()) {
        const MappedEnvironment light = map.light();
        const double disk = pi_d * 1.5 * 1.5;
        check_density(
            map,
            [&](const Vec2& u) {
                return -light.emit({0.3f, 0.6f}, u).ray.direction;
            },
            [&](const Vec3& wi) { return double(light.emission_pdf(wi).value) * disk; }, seed++);
        Random random(seed++);
        std::vector<double> observed(64);
        for (int i = 0; i < 20000; ++i) {
            const LightEmission e = light.emit(random.next_2d(), random.next_2d());
            const Vec3 across = e.ray.origin - e.ray.direction * dot(e.ray.origin, e.ray.direction);
            CHECK(dot(e.ray.origin, e.ray.direction) < -1.5f);
            const Basis basis(-e.ray.direction);
            const double x = double(dot(across, basis.tangent)), y = double(dot(across, basis.bitangent));
            const double radius2 = (x * x + y * y) / 2.25, turn = std::atan2(y, x) / (2 * pi_d) + 0.5;
            REQUIRE(radius2 < 1 + 1e-5);
            observed[static_cast<std::size_t>(std::min(radius2 * 8, 7.0)) * 8 +
                     static_cast<std::size_t>(std::min(turn * 8, 7.0))] += 1;
        }
        CHECK(chi_square(observed, std::vector<double>(64, 20000.0 / 64)).p_value > level);
    }
}

TEST_CASE("environment map: a sample is what is found in its direction, and an emission carries it") {
    for (const Map& map : maps())
        for (const glm::mat3& to_world : {identity, turned}) {
            CAPTURE(map.name);
            const MappedEnvironment light = map.light(to_world, 3);
            Random random(200);
            float brightest = 0;
            for (const Rgb& texel : map.texels) brightest = std::max(brightest, 3 * max_component(texel));
            // Close to a pole the rounding of a rotation changes the angle around it by more than elsewhere.
            const auto same = [&](const Rgb& a, const Rgb& b) {
                for (int c = 0; c < 3; ++c)
                    CHECK(double(a[c]) == relative(double(b[c]), 1e-5).or_absolute(1e-4 * double(brightest)));
            };
            int elsewhere = 0;  // by rounding, at the edge of a cell
            const int samples = 5000;
            for (int i = 0; i < samples; ++i) {
                const SurfacePoint at = point(normals[i % 2]);
                const LightSample s = light.sample(at, random.next_2d());
                REQUIRE(s.pdf.value > 0);
                CHECK_FALSE(s.dirac);
                CHECK(double(length_squared(s.wi)) == relative(1, 2e-6));
                CHECK(s.visibility.far == infinity);
                same(s.radiance, light.radiance(s.wi));
                const double emission = double(light.emission_pdf(s.wi).value);
                elsewhere += double(light.pdf(at.facing_normal(), s.wi).value) != relative(double(s.pdf.value), 1e-4);
                const double spread = double(light.spread(at, s.wi, Vec3(0)));
                if (emission > 0 && s.spread < infinity)
                    elsewhere += spread != relative(double(s.spread), 1e-4) ||
                                 spread != relative(double(s.pdf.value) / emission, 1e-4);
                else CHECK(spread == 0);

                const LightEmission e = light.emit(random.next_2d(), random.next_2d());
                CHECK(e.cosine == 1);
                CHECK_FALSE(e.dirac);
                elsewhere += double(light.emission_pdf(-e.ray.direction).value) != relative(double(e.pdf.value), 1e-4);
                same(e.weight * e.pdf.value, light.radiance(-e.ray.direction));
            }
            CHECK(elsewhere <= 4);
        }
}

TEST_CASE("environment map: wherever there is light, it can be sampled, and one sample never stands for too much") {
    for (const Map& map : maps()) {
        CAPTURE(map.name);
        const MappedEnvironment light = map.light();
        const double mean = light.map->mean_luminance();
        Random random(300);
        int never = 0;
        double most = 0;
        for (int i = 0; i < 100000; ++i) {
            const Vec3 wi = uniform_sphere(random.next_2d());
            const double luminous = double(luminance(light.radiance(wi)));
            const double density = double(light.map->pdf(wi).value);
            if (luminous > 0) {
                never += !(density > 0);
                most = std::max(most, luminous / (density * 4 * pi_d * mean));
            }
        }
        CHECK(never == 0);
        // A corner, over the mean of its cell: 4, and up to 6 at a pole, where the cell narrows away from it.
        CHECK(most < 6.1);
    }
}

TEST_CASE("environment map: the power is that of a constant environment with the mean luminance") {
    for (const Map& map : maps()) {
        CAPTURE(map.name);
        const MappedEnvironment light = map.light(turned, 2);
        const double flux = over_sphere([&](const Vec3& wi) { return DVec3(luminance(light.radiance(wi))); }).x;
        const ConstantEnvironment even{Rgb(static_cast<float>(flux / (4 * pi_d))), 1.5f};
        CHECK(light.power() == relative(even.power(), 2e-3));  // the quadrature is good to 1e-3
    }
    const MappedEnvironment light = maps()[0].light();
    CHECK(light.power() == relative(ConstantEnvironment{Rgb(1), 1.5f}.power(), 1e-6));
}

TEST_CASE("environment map: the irradiance is that by quadrature, by samples and by emission") {
    for (const Map& map : maps()) {
        const MappedEnvironment light = map.light(turned, 2);
        for (const Vec3& normal : normals) {
            CAPTURE(map.name);
            CAPTURE(normal.y);
            const SurfacePoint at = point(normal);
            const DVec3 truth = over_sphere(
                [&](const Vec3& wi) { return DVec3(light.radiance(wi)) * std::max(0.0, double(dot(wi, normal))); });
            Random random(400);
            Mean sampled, emitted;
            for (int i = 0; i < 100000; ++i) {
                const LightSample s = light.sample(at, random.next_2d());
                const double cosine = std::max(0.0, double(dot(s.wi, normal)));
                sampled.add(double(s.radiance.y) * cosine / double(s.pdf.value));
                // What crosses the disk at right angles comes to a surface as the cosine says.
                const LightEmission e = light.emit(random.next_2d(), random.next_2d());
                emitted.add(double(e.weight.y) * std::max(0.0, -double(dot(e.ray.direction, normal))) / (pi_d * 2.25));
            }
            CHECK(sampled.sigmas(truth.y, 1e-3 * truth.y) < 5);  // the quadrature is good to 5e-4
            CHECK(emitted.sigmas(truth.y, 1e-3 * truth.y) < 5);
        }
    }
}

TEST_CASE("environment map: a constant map is sampled as a constant environment") {
    const MappedEnvironment light = maps()[0].light();
    const ConstantEnvironment even{Rgb(1), 1.5f};
    Random random(500);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u = random.next_2d();
        const SurfacePoint at = point(normals[1]);
        const LightSample ours = light.sample(at, u), theirs = even.sample(at, u);
        CHECK(double(length_squared(ours.wi - theirs.wi)) < 1e-6);
        CHECK(double(ours.radiance.y) == relative(1, 1e-6));
        CHECK(double(ours.pdf.value) == relative(double(theirs.pdf.value), 1e-3).or_absolute(1e-4));
    }
    // On even parts of the sphere: even emission.
    const LightEmission e = light.emit({0.2f, 0.7f}, {0.4f, 0.1f});
    CHECK(double(e.pdf.value) == relative(double(even.emission_pdf(Vec3(0, 1, 0)).value), 1e-5));
    CHECK(double(e.weight.y) == relative(double(even.emit({0.2f, 0.7f}, {0.4f, 0.1f}).weight.y), 1e-5));
}

TEST_CASE("environment map: the extremes of the numbers, and of directions") {
    for (const Map& map : maps()) {
        CAPTURE(map.name);
        const MappedEnvironment light = map.light();
        for (const float x : {0.0f, 0x1p-24f, 0.5f, largest_u})
            for (const float y : {0.0f, 0x1p-24f, 0.5f, largest_u}) {
                const LightSample s = light.sample(point(normals[0]), {x, y});
                CHECK(double(length_squared(s.wi)) == relative(1, 1e-6));
                CHECK(s.pdf.value > 0);
                CHECK(is_finite(s.pdf.value));
                CHECK(is_finite(s.radiance / s.pdf.value));
                const LightEmission e = light.emit({x, y}, {y, x});
                CHECK(e.pdf.value > 0);
                CHECK(is_finite(e.weight));
                CHECK(is_finite(e.ray.origin));
            }
        for (const Vec3& wi : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, -1), Vec3(-0.0f, 0, -1), Vec3(0, 0, 1),
                               Vec3(1, 0, 0), Vec3(1e-30f, 1, -1e-30f), Vec3(0, -1.0000001f, 0)}) {
            CHECK(is_finite(light.radiance(wi)));
            CHECK(is_finite(light.pdf(normals[0], wi).value));
            CHECK(is_finite(light.emission_pdf(wi).value));
            CHECK(light.spread(point(normals[0]), wi, Vec3(0)) >= 0);
        }
    }
}

TEST_CASE("environment map: a black map gives nothing") {
    const MappedEnvironment light = dots("black", 3, 3, [](int, int) { return false; }).light();
    CHECK(light.map->empty());
    CHECK(light.power() == 0);
    CHECK(light.sample(point(normals[0]), {0.5f, 0.5f}).pdf.value == 0);
    CHECK(is_black(light.emit({0.5f, 0.5f}, {0.5f, 0.5f}).weight));
    CHECK(light.pdf(normals[0], normals[0]).value == 0);
    CHECK(light.emission_pdf(normals[0]).value == 0);
    CHECK(is_black(light.radiance(normals[0])));
}

TEST_CASE("environment map: texels from the smallest to the largest floats") {
    constexpr float tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
    const Map map = made("ends", 4, 3, [](int c, int) {
        return c == 0 ? Rgb(0, 0, tiny) : c == 2 ? Rgb(huge) : Rgb(0);
    });
    const MappedEnvironment light = map.light();
    CHECK(is_finite(light.power()));
    Random random(600);
    for (int i = 0; i < 1000; ++i) {
        const LightSample s = light.sample(point(normals[0]), random.next_2d());
        CHECK(s.pdf.value > 0);
        CHECK(is_finite(s.radiance));
    }
    const MappedEnvironment dim = made("dim", 2, 2, [](int, int) { return Rgb(0, 0, tiny); }).light();
    CHECK(dim.power() > 0);
    CHECK(dim.sample(point(normals[0]), {0.5f, 0.5f}).pdf.value > 0);
}

TEST_CASE("environment map: impossible texels and sizes are refused") {
    std::vector<Rgb> texels(12, Rgb(1));
    CHECK_FALSE(EnvironmentMap::problem(texels, 4));
    for (const float bad : {-1e-30f, infinity, std::numeric_limits<float>::quiet_NaN()}) {
        texels[6].z = bad;
        const auto found = EnvironmentMap::problem(texels, 4);
        REQUIRE(found);
        CHECK(found->column == 2);
        CHECK(found->row == 1);
        CHECK(found->value.x == 1);
        CHECK_THROWS_WITH_AS(EnvironmentMap(texels, 4, 3), doctest::Contains("in column 2 of row 1"), Error);
    }
    texels.assign(12, Rgb(1));
    CHECK_THROWS_AS(EnvironmentMap(texels, 4, 4), Error);
    CHECK_THROWS_AS(EnvironmentMap(texels, -4, -3), Error);
    CHECK_THROWS_AS(EnvironmentMap({}, 0, 0), Error);
    CHECK_THROWS_AS(EnvironmentMap(std::vector<Rgb>(65537, Rgb(1)), 1, 65537), Error);
}

TEST_CASE("environment map: the longest sides keep their cells") {
    for (const auto& [width, height] : {std::pair{1, 65536}, {65536, 1}, {65536, 3}}) {
        const EnvironmentMap map(std::vector<Rgb>(std::size_t(width) * std::size_t(height), Rgb(1)), width, height);
        CHECK(map.mean_luminance() == relative(1, 1e-9));
        Random random(700);
        Mean mean;
        for (int i = 0; i < 100000; ++i) {
            const EnvironmentMap::Sample s = map.sample(random.next_2d());
            REQUIRE(s.pdf.value > 0);
            CHECK(double(length_squared(s.wi)) == relative(1, 1e-6));
            mean.add(double(map.radiance(s.wi).y) / double(s.pdf.value) / (4 * pi_d));
        }
        CHECK(mean.sigmas(1, 1e-5) < 5);
    }
}
