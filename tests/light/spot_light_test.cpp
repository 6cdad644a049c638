// The spot light shines as Mitsuba's, and emits with the density it states.

#include <lightswitch/light/spot_light.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"
#include "../support/statistics.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

static_assert(Light<SpotLight> && EmittingLight<SpotLight>);

// False alarms, were the seeds drawn at random (they are fixed): all chi-square tests of this file together 1e-6; a
// mean may be off by 5 standard errors, 6e-7 each.
const double level = sidak(1e-6, 5);

constexpr double pi_d = 3.14159265358979323846, degree = pi_d / 180;

struct Angles {
    double cutoff, beam;  // degrees
};
constexpr Angles all_angles[] = {{20, 15}, {40, 30}, {30, 30}, {100, 20}, {180, 90}};

const Vec3 position(0.2f, -0.3f, 0.4f), axis(0.48f, 0.6f, 0.64f);
const Rgb intensity(1, 2, 3);

SpotLight spot(const Angles& angles) {
    return {position, axis, intensity, angles.cutoff * degree, angles.beam * degree};
}

/// A point at that distance from the light, off the axis by that angle.
SurfacePoint point(double angle, double distance) {
    const Basis basis(axis);
    const DVec3 direction = DVec3(basis.normal) * std::cos(angle) + DVec3(basis.tangent) * std::sin(angle) * 0.6 +
                            DVec3(basis.bitangent) * std::sin(angle) * 0.8;
    SurfacePoint at{};
    at.position = Vec3(DVec3(position) + direction * distance);
    at.normal = at.shading_normal = at.wo = Vec3(-direction);
    return at;
}

double red_intensity(const SpotLight& light, double angle, double distance = 2) {
    return double(light.sample(point(angle, distance), {0.5f, 0.5f}).radiance.x) * distance * distance;
}

}  // namespace

// Values of Mitsuba 3.9.1: `sample_direction` of the plugin `spot` in the variant scalar_rgb at distance 2, times 4.
TEST_CASE("spot light: the falloff is Mitsuba's") {
    struct Seen {
        Angles angles;
        double angle, red;
    };
    for (const Seen& seen : {
             Seen{{20, 15}, 0, 1},     {{20, 15}, 5, 1},    {{20, 15}, 16, 0.8},    {{20, 15}, 18, 0.4},
             {{20, 15}, 19.8, 0.04},   {{20, 15}, 20.2, 0}, {{20, 15}, 60, 0},      {{20, 15}, 120, 0},
             {{40, 30}, 32, 0.8},      {{40, 30}, 36, 0.4}, {{40, 30}, 39.6, 0.04}, {{40, 30}, 40.4, 0},
             {{30, 30}, 29.7, 1},      {{30, 30}, 30.3, 0}, {{100, 20}, 80, 0.25},  {{100, 20}, 90, 0.125},
             {{100, 20}, 99, 0.0125},  {{100, 20}, 101, 0}, {{30, 0}, 0, 1},        {{30, 0}, 5, 0.833333},
             {{30, 0}, 24, 0.2},       {{30, 40}, 29.7, 1}, {{30, 40}, 30.3, 0},    {{180, 90}, 120, 0.666667},
             {{180, 90}, 178.2, 0.02},
         }) {
        CAPTURE(seen.angles.cutoff);
        CAPTURE(seen.angle);
        CHECK(red_intensity(spot(seen.angles), seen.angle * degree) == relative(seen.red, 1e-4));
    }
}

TEST_CASE("spot light: a narrow beam keeps its shape") {
    const SpotLight light = spot({0.02, 0.01});
    CHECK(red_intensity(light, 0.005 * degree) == relative(1, 1e-5));
    CHECK(red_intensity(light, 0.015 * degree) == relative(0.5, 5e-3));
    CHECK(red_intensity(light, 0.021 * degree) == 0);
}

TEST_CASE("spot light: samples say all of the light") {
    const SpotLight light = spot({40, 30});
    const SurfacePoint at = point(35 * degree, 1.7);
    const LightSample s = light.sample(at, {0.1f, 0.9f});
    CHECK(s.dirac);
    CHECK(s.pdf.value == 1);
    CHECK(double(length_squared(s.wi - normalize(position - at.position))) < 1e-12);
    CHECK(double(s.radiance.z / s.radiance.x) == relative(3, 1e-6));
    CHECK(double(length_squared(s.visibility.origin + s.visibility.direction - position)) < 1e-12);
    // Outside of the cone, behind the light, and at the light itself there is nothing.
    for (const double angle : {41.0, 90.0, 179.0})
        CHECK(light.sample(point(angle * degree, 1), {0.5f, 0.5f}).pdf.value == 0);
    CHECK(light.sample(point(0, 0), {0.5f, 0.5f}).pdf.value == 0);
}

TEST_CASE("spot light: the power is the integral of the intensity") {
    for (const Angles& angles : all_angles) {
        const SpotLight light = spot(angles);
        double sum = 0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double angle = angles.cutoff * degree * (i + 0.5) / steps;
            sum += red_intensity(light, angle) * std::sin(angle) * angles.cutoff * degree / steps;
        }
        CAPTURE(angles.cutoff);
        CHECK(light.power() == relative(2 * pi_d * sum * double(luminance(intensity)), 1e-5));
    }
    // A cone so narrow that it is flat: the intensity times the solid angle of beam and penumbra.
    const double beam = 1e-4, cutoff = 3e-4;
    const double flat = pi_d * (beam * beam + beam * cutoff + cutoff * cutoff) / 3;
    CHECK(SpotLight(position, axis, Rgb(1), cutoff, beam).power() == relative(flat, 1e-6));
    CHECK(SpotLight(position, axis, Rgb(1), pi_d, pi_d).power() == relative(4 * pi_d, 1e-6));
}

TEST_CASE("spot light: emission is even over the cone, with the density that is stated, and carries the intensity") {
    std::uint32_t seed = 1;
    for (const Angles& angles : all_angles) {
        CAPTURE(angles.cutoff);
        const SpotLight light = spot(angles);
        const double cap = 1 - std::cos(angles.cutoff * degree);
        Random random(seed++);
        const Basis basis(axis);
        std::vector<double> observed(16 * 12);
        Mean power;
        constexpr int samples = 100000;
        for (int i = 0; i < samples; ++i) {
            const LightEmission e = light.emit(random.next_2d(), random.next_2d());
            REQUIRE(e.ray.origin == position);
            REQUIRE(e.dirac);
            REQUIRE(e.cosine == 1);
            CHECK(double(e.pdf.value) == relative(1 / (2 * pi_d * cap), 1e-5));
            const DVec3 d(e.ray.direction);
            const double ring = (1 - glm::dot(d, DVec3(axis))) / cap;
            const double turn =
                std::atan2(glm::dot(d, DVec3(basis.bitangent)), glm::dot(d, DVec3(basis.tangent))) / (2 * pi_d) + 0.5;
            REQUIRE(ring < 1 + 1e-5);
            observed[static_cast<std::size_t>(std::clamp(ring * 16, 0.0, 15.0)) * 12 +
                     static_cast<std::size_t>(std::min(turn * 12, 11.0))] += 1;
            power.add(double(luminance(e.weight)));
            // A point on the path gets by sampling what the path brings there.
            SurfacePoint at{};
            at.position = position + 2.0f * e.ray.direction;
            const LightSample s = light.sample(at, {0.5f, 0.5f});
            const double brought = double(e.weight.y) * double(e.pdf.value) / 4;
            CHECK(double(s.radiance.y) == relative(brought, 1e-3).or_absolute(1e-6));
            const double spread = double(light.spread(at, -e.ray.direction, position));
            // The area, over the distance squared: what the density of directions is spread to.
            CHECK(spread == relative(4 / double(e.pdf.value), 1e-4));
            if (s.pdf.value > 0) CHECK(double(s.spread) == relative(spread, 1e-5));
        }
        CHECK(chi_square(observed, std::vector<double>(observed.size(), samples / 192.0)).p_value > level);
        CHECK(power.sigmas(light.power(), 1e-5 * light.power()) < 5);
    }
}

TEST_CASE("spot light: the extremes of the numbers") {
    constexpr float largest_u = 1 - 0x1p-24f;
    for (const Angles& angles : all_angles)
        for (const float x : {0.0f, 0.5f, largest_u})
            for (const float y : {0.0f, 0.5f, largest_u}) {
                const LightEmission e = spot(angles).emit({x, y}, {x, y});
                CHECK(double(length_squared(e.ray.direction)) == relative(1, 1e-6));
                CHECK(is_finite(e.weight));
            }
}
