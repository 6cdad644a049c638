// Lights are sampled with the density that they state, and bring the light that geometry says.

#include "../support/relative.hpp"
#include "../support/scenes.hpp"
#include "../support/statistics.hpp"

#include <doctest/doctest.h>

#include <optional>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

// False alarms, were the seeds drawn at random (they are fixed): all chi-square tests of this file together 1e-6; a
// mean may be off by 5 standard errors, 6e-7 each.
constexpr int chi_square_tests = 40;
const double level = sidak(1e-6, chi_square_tests);

constexpr double pi_d = 3.14159265358979323846;

/// Frame of a light at `center` that shines along `direction` (unit), with sides of that length.
DMat4 place(const DVec3& center, const DVec3& direction, double width, double height) {
    const Basis basis{Vec3(direction)};
    const DVec3 z = glm::normalize(direction),
                x = glm::normalize(DVec3(basis.tangent) - z * glm::dot(z, DVec3(basis.tangent)));
    return {glm::dvec4(x * (width / 2), 0), glm::dvec4(glm::cross(z, x) * (height / 2), 0), glm::dvec4(z, 0),
            glm::dvec4(center, 1)};
}

/// Density with which the scene's lights are sampled in the direction `wi`: found by looking there.
double density(const GreyScene& scene, const SurfacePoint& from, const Vec3& wi) {
    const auto hit = scene.intersect(Ray{.origin = from.position, .direction = wi});
    if (!hit) return double(scene.environment_pdf(from.facing_normal(), wi).value);
    if (!hit->light || is_black(scene.emitted(*hit, -wi))) return 0;
    return double(scene.light_pdf(from.position, from.lit_normal(), wi, *hit).value);
}

void check_density(const GreyScene& scene, const SurfacePoint& from, const SphereCells& cells, std::uint32_t seed) {
    Random choices(seed + 1000);
    const auto sample = [&](const Vec3& u) -> std::optional<Vec3> {
        const LightSample s = scene.sample_light(from, u.z, {u.x, u.y});
        return s.pdf.value > 0 ? std::optional(s.wi) : std::nullopt;
    };
    const auto result = chi_square_sphere(
        sample, [&](const Vec3& wi) { return density(scene, from, wi); }, cells, 200000, seed);
    CAPTURE(seed);
    CAPTURE(result.chi_square);
    CHECK(result.chi_square.p_value > level);
    CHECK(result.chi_square.degrees_of_freedom > 20);
    CHECK(result.integral < 1.003);
}

/// Cells around the direction from `from` to `to`, fine enough for what covers the angle `theta`.
SphereCells cells_towards(const DVec3& from, const DVec3& to, double theta) {
    const double lift = 1 - std::cos(std::min(theta, 1.5)), tiny = lift > 1e-12 ? lift : theta * theta / 2;
    return {.axis = Vec3(glm::normalize(to - from)), .stretch = std::max(1.0, std::log(tiny / 2) / std::log(0.5))};
}

struct Irradiance {
    Mean mean;
    double worst_pdf_difference = 0;  ///< relative, between the density of samples and that of what is found there
    int found = 0, lost = 0;          ///< samples that look free: the light is found in their direction, or is not
};

/// Irradiance at a point by sampling lights, in the green channel.
Irradiance irradiance(const GreyScene& scene, const SurfacePoint& from, int samples, std::uint32_t seed) {
    Irradiance result;
    Random random(seed);
    for (int i = 0; i < samples; ++i) {
        const LightSample s = scene.sample_light(from, random.next(), random.next_2d());
        const double cosine = double(dot(s.wi, from.normal));
        const bool free = s.pdf.value > 0 && !is_black(s.radiance) && !scene.occluded(s.visibility);
        result.mean.add(free && cosine > 0 ? double(s.radiance.y) * cosine / double(s.pdf.value) : 0);
        if (!free || s.dirac) continue;
        const double found = density(scene, from, s.wi);
        if (found > 0) {
            ++result.found;
            result.worst_pdf_difference =
                std::max(result.worst_pdf_difference, std::abs(found / double(s.pdf.value) - 1));
        } else {
            ++result.lost;
        }
    }
    return result;
}

/// Solid angle form factor of a rectangle a x b in a plane parallel to the receiver at distance c, with one corner
/// straight above it (Siegel and Howell, configuration 11), times pi.
double corner_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

GreyScene with_light(const std::variant<Mesh, Sphere>& geometry, const Rgb& radiance = Rgb(2)) {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    description.add(geometry, 0, radiance);
    return build_grey(description);
}

}  // namespace

TEST_CASE("light sampling: a rectangle, from near, far, beside and behind") {
    const DVec3 center(0.1, 0.2, 0.3);
    for (const auto& [size, distance] : {std::pair{0.4, 0.05}, {0.4, 0.5}, {2e-4, 1.0}, {0.02, 1e-3}}) {
        const DVec3 axis = glm::normalize(DVec3(0.3, -0.2, -1));
        const GreyScene scene = with_light(rectangle(place(center, axis, size, size)));
        const DVec3 straight = center + axis * distance, aside = straight + DVec3(0.3, 0.1, 0.03) * distance;
        CAPTURE(size);
        CAPTURE(distance);
        for (const DVec3& p : {straight, aside}) {
            const SurfacePoint from = free_point(scene, p, Vec3(-axis));
            check_density(scene, from, cells_towards(p, center, std::atan(0.5 * size / distance)), 11);
            const Irradiance e = irradiance(scene, from, 40000, 12);
            CHECK(e.found > 39500);
            CHECK(e.lost < 200);  // at the very edge
            CHECK(e.worst_pdf_difference < 1e-3);
        }
        const double half = size / 2;
        const double in_front = 2 * 4 * corner_factor(half, half, distance);
        // The corners are rounded by up to 2^-25, each side of the rectangle by twice that.
        const double rounding = in_front * (1e-5 + 4 * 0x1p-25 / size);
        CHECK(irradiance(scene, free_point(scene, straight, Vec3(-axis)), 100000, 13).mean.sigmas(in_front, rounding) <
              5);
        // In its plane, but for rounding, and behind it there is nothing.
        for (const double behind : {0.0, -1e-5, -0.3}) {
            const SurfacePoint there = free_point(scene, center + axis * behind, Vec3(-axis));
            CHECK(irradiance(scene, there, 1000, 14).mean.value() == relative(0, 0).or_absolute(1e-5 * in_front));
        }
    }
}

TEST_CASE("light sampling: a sphere from outside") {
    const DVec3 center(0.1, 0.2, 0.3);
    for (const auto& [radius, distance] :
         {std::pair{0.3, 0.303}, {0.3, 0.9}, {1e-2, 1.0}, {1e-4, 1.0}, {0.02, 0.0200002}}) {
        const GreyScene scene = with_light(Sphere{center, radius, false});
        const DVec3 direction = glm::normalize(DVec3(0.5, -0.3, -0.8)), p = center + direction * distance;
        CAPTURE(radius);
        CAPTURE(distance);
        SurfacePoint from = free_point(scene, p, Vec3(-direction));
        check_density(scene, from, cells_towards(p, center, std::asin(radius / distance)), 21);
        const Irradiance e = irradiance(scene, from, 40000, 22);
        CHECK(e.lost < 200);  // at the very edge
        CHECK(e.found > 39500);
        CHECK(e.worst_pdf_difference < 1e-5);
        const double sine = radius / distance;
        // The light is above the horizon of the receiver as long as the receiver leans less than this.
        const double lean = 0.9 * std::acos(sine);
        for (const double angle : {0.0, 0.5 * lean, lean}) {
            const Basis basis{Vec3(-direction)};
            const Vec3 normal = basis.to_world(Vec3(DVec3(std::sin(angle), 0, std::cos(angle))));
            from.normal = from.shading_normal = from.wo = normal;
            CHECK(irradiance(scene, from, 50000, 23)
                      .mean.sigmas(2 * pi_d * sine * sine * std::cos(angle), 3e-5 * sine * sine) < 5);
        }
    }
}

TEST_CASE("light sampling: a sphere does not light itself, nor what is inside") {
    const DVec3 center(0.1, 0.2, 0.3);
    const GreyScene scene = with_light(Sphere{center, 0.3, false});
    Random random(31);
    int lit = 0, densities = 0;
    for (int i = 0; i < 20000; ++i) {
        // As found by a ray: rounding puts half of these points inside the sphere and half outside.
        const DVec3 outward(uniform_sphere(random.next_2d()));
        const auto hit = scene.intersect(
            Ray{.origin = Vec3(scene.space().point(center + 0.5 * outward)), .direction = -Vec3(outward)});
        REQUIRE(hit);
        const LightSample s = scene.sample_light(*hit, 0.5f, random.next_2d());
        lit += s.pdf.value > 0 && dot(s.wi, hit->normal) > 0 && !scene.occluded(s.visibility);
        const SurfacePoint within = free_point(scene, center + 0.29 * outward);
        const LightSample t = scene.sample_light(within, 0.5f, random.next_2d());
        lit += t.pdf.value > 0 && !is_black(t.radiance) && !scene.occluded(t.visibility);
        // What sampling cannot find must have no density, or multiple importance sampling would lose it.
        const auto back = scene.intersect(Ray{.origin = within.position, .direction = Vec3(outward)});
        densities += back && scene.light_pdf(within.position, within.lit_normal(), Vec3(outward), *back).value > 0;
    }
    CHECK(lit == 0);
    CHECK(densities == 0);
}

TEST_CASE("light sampling: a sphere that shines inwards gives pi times its radiance everywhere in it") {
    const DVec3 center(0.1, 0.2, 0.3);
    for (const double radius : {0.5, 1e-3}) {
        const GreyScene scene = with_light(Sphere{center, radius, true});
        Random random(41);
        for (const double at : {0.0, 0.5, 0.99}) {
            const DVec3 outward(uniform_sphere(random.next_2d())), p = center + at * radius * outward;
            const SurfacePoint from = free_point(scene, p, uniform_sphere(random.next_2d()));
            check_density(scene, from, {.axis = Vec3(outward), .rings = 30, .sectors = 12}, 42);
            const Irradiance e = irradiance(scene, from, 100000, 43);
            CHECK(e.lost < 20);
            CHECK(e.worst_pdf_difference < 1e-2);
            if (at < 0.9) CHECK(e.mean.sigmas(2 * pi_d, 1e-4) < 5);
        }
        // On the wall itself, where rounding puts half of the points outside.
        Mean wall;
        double ratio = 0;
        for (int i = 0; i < 100000; ++i) {
            const auto hit = scene.intersect(
                Ray{.origin = Vec3(scene.space().point(center)), .direction = uniform_sphere(random.next_2d())});
            REQUIRE(hit);
            const LightSample s = scene.sample_light(*hit, 0.5f, random.next_2d());
            const double cosine = double(dot(s.wi, hit->normal));
            const bool free = s.pdf.value > 0 && cosine > 0 && !scene.occluded(s.visibility);
            wall.add(free ? double(s.radiance.y) * cosine / double(s.pdf.value) : 0);
            if (!free || cosine < 0.1) continue;
            const auto found = scene.intersect(hit->spawn(s.wi));
            REQUIRE(found);
            ratio = std::max(
                ratio,
                std::abs(double(scene.light_pdf(hit->position, hit->lit_normal(), s.wi, *found).value / s.pdf.value) -
                         1));
        }
        CHECK(wall.sigmas(2 * pi_d, 1e-3) < 5);
        // The next ray starts a little off the wall, which counts where the way across is short.
        CHECK(ratio < (radius < 0.1 ? 0.05 : 1e-3));
    }
}

TEST_CASE("light sampling: a constant environment") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    description.add(Source(EnvironmentSource{Rgb(2)}));
    const GreyScene scene = build_grey(description);
    const Vec3 normal = lightswitch::normalize(Vec3(0.2f, -0.7f, 0.4f));
    for (const float side : {1.0f, -1.0f}) {
        SurfacePoint from = free_point(scene, {0, 0, 0}, normal);
        from.wo = side * normal;
        check_density(scene, from, {.axis = normal}, 51);
        from.normal = side * normal;
        CHECK(irradiance(scene, from, 100000, 52).mean.sigmas(2 * pi_d, 1e-4) < 5);
        CHECK(irradiance(scene, from, 100000, 52).worst_pdf_difference < 1e-4);
    }
    CHECK(scene.environment({0, 0, 1}) == Rgb(2));
}

TEST_CASE("light sampling: point and directional lights") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    description.add(Source(PointSource{{0.2, 0.3, 0.7}, Rgb(3, 5, 7)}));
    const GreyScene scene = build_grey(description);
    for (const double distance : {1e-3, 0.5, 1.5}) {
        const DVec3 direction = glm::normalize(DVec3(0.1, 0.4, 0.9));
        const SurfacePoint from = free_point(scene, DVec3(0.2, 0.3, 0.7) - distance * direction, {0, 0, 1});
        CHECK(irradiance(scene, from, 10, 61).mean.value() == relative(5 * direction.z / (distance * distance), 1e-3));
    }
    CHECK(irradiance(scene, free_point(scene, {0.2, 0.3, 0.8}), 10, 62).mean.value() == 0);
    // In the light itself there is no direction to it.
    CHECK(scene.sample_light(free_point(scene, {0.2, 0.3, 0.7}), 0.5f, {0.5f, 0.5f}).pdf.value == 0);

    description.sources.clear();
    description.add(Source(DirectionalSource{{3, 0, -4}, Rgb(3, 5, 7)}));
    const GreyScene sunny = build_grey(description);
    CHECK(irradiance(sunny, free_point(sunny, {0, 0, 0}), 10, 63).mean.value() == relative(5 * 0.8, 1e-5));
    CHECK(irradiance(sunny, free_point(sunny, {0, 0, 0}, {0, 0, -1}), 10, 64).mean.value() == 0);
    CHECK(irradiance(sunny, free_point(sunny, {0, 0, 0}, {-0.6f, 0, 0.8f}), 10, 65).mean.value() == relative(5, 1e-5));
}

TEST_CASE("light sampling: only the front of a surface shines") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    description.add(rectangle(DMat4({0.1, 0, 0, 0}, {0, 0.1, 0, 0}, {0, 0, 0.1, 0}, {-0.5, 0, 0, 1})), 0, Rgb(1, 2, 3));
    description.add(Sphere{{0.3, 0, 0}, 0.1, false}, 0, Rgb(4, 5, 6));
    description.add(Sphere{{0.7, 0, 0}, 0.1, true}, 0, Rgb(7, 8, 9));
    const GreyScene scene = build_grey(description);
    const auto seen = [&](const DVec3& from, const Vec3& direction) {
        const auto hit = scene.intersect(Ray{.origin = Vec3(scene.space().point(from)), .direction = direction});
        REQUIRE(hit);
        REQUIRE(static_cast<bool>(hit->light));
        return scene.emitted(*hit, -direction);
    };
    CHECK(seen({-0.48, 0.02, 0.5}, {0, 0, -1}) == Rgb(1, 2, 3));
    CHECK(seen({-0.48, 0.02, -0.5}, {0, 0, 1}) == Rgb(0));
    CHECK(seen({0.3, 0, 0.5}, {0, 0, -1}) == Rgb(4, 5, 6));
    CHECK(seen({0.3, 0, 0}, {0, 0, 1}) == Rgb(0));
    CHECK(seen({0.7, 0, 0.5}, {0, 0, -1}) == Rgb(0));
    CHECK(seen({0.7, 0, 0}, {0, 0, 1}) == Rgb(7, 8, 9));
}
