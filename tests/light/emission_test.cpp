// Light paths start with the density that is stated, carry the power that light sampling finds, and spread as stated.

#include "../support/relative.hpp"
#include "../support/scenes.hpp"
#include "../support/statistics.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <string>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

// False alarms, were the seeds drawn at random (they are fixed): all chi-square tests of this file together 1e-6; a
// mean may be off by 5 standard errors, 6e-7 each.
constexpr int chi_square_tests = 12;
const double level = sidak(1e-6, chi_square_tests);

constexpr double pi_d = 3.14159265358979323846;

/// The lights of this file, each for itself: a description without surfaces of its own.
struct Lamp {
    std::string name;
    std::function<void(GreyDescription&)> add;
};

const Lamp rectangle_lamp{
    "rectangle", [](GreyDescription& d) {
        d.add(quad({-0.5, 0.7, -0.4}, {0.3, 0.7, -0.4}, {0.3, 0.8, 0.4}, {-0.5, 0.8, 0.4}), 0, Rgb(2));
    }};
const Lamp sphere_lamp{"sphere", [](GreyDescription& d) { d.add(Sphere{{0.2, 0.5, 0.1}, 0.25}, 0, Rgb(3)); }};
const Lamp hollow_lamp{"hollow sphere", [](GreyDescription& d) { d.add(Sphere{{0.1, 0, 0}, 0.85, true}, 0, Rgb(1)); }};
const Lamp point_lamp{"point", [](GreyDescription& d) { d.add(PointSource{{0.2, 0.6, -0.1}, Rgb(1.5f)}); }};
const Lamp sun_lamp{"sun", [](GreyDescription& d) { d.add(DirectionalSource{{0.3, -1, 0.2}, Rgb(2)}); }};
const Lamp sky_lamp{"sky", [](GreyDescription& d) { d.add(EnvironmentSource{Rgb(0.7f)}); }};
const Lamp lamps[] = {rectangle_lamp, sphere_lamp, hollow_lamp, point_lamp, sun_lamp, sky_lamp};

GreyScene with_lamp(const Lamp& lamp) {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    lamp.add(description);
    return build_grey(description);
}

LightEmission emit(const GreyScene& scene, Random& random) {
    const float choice = random.next();
    const Vec2 place = random.next_2d();
    return scene.sample_emission(choice, place, random.next_2d());
}

/// The point of the light at which a path starts.
Maybe<SurfacePoint> start_of(const GreyScene& scene, const Ray& ray) {
    return scene.intersect(Ray{.origin = ray.origin + 1e-3f * ray.direction, .direction = -ray.direction});
}

/// Cell of a point of a unit interval.
std::size_t cell(double x, std::size_t cells) {
    return static_cast<std::size_t>(std::clamp(x * double(cells), 0.0, double(cells) - 1));
}

/// Angle of (x, y) as a fraction of the full circle.
double turn_of(double x, double y) { return std::atan2(y, x) / (2 * pi_d) + 0.5; }

/// Chi-square of numbers that should be uniform in [0, 1)^4, in 4 cells along each axis.
class Hypercube {
public:
    void add(double a, double b, double c, double d) {
        counts_[((cell(a, 4) * 4 + cell(b, 4)) * 4 + cell(c, 4)) * 4 + cell(d, 4)] += 1;
    }
    double p_value() const {
        const double total = std::accumulate(counts_.begin(), counts_.end(), 0.0);
        return chi_square(counts_, std::vector<double>(256, total / 256)).p_value;
    }

private:
    std::vector<double> counts_ = std::vector<double>(256);
};

}  // namespace

TEST_CASE("emission: paths start on a rectangle with the density that is stated") {
    const GreyScene scene = with_lamp(rectangle_lamp);
    const double area = 0.8 * std::sqrt(0.64 + 0.01);
    Random random(1);
    Hypercube cube;
    const DVec3 corner = scene.space().point({-0.5, 0.7, -0.4});
    for (int i = 0; i < 60000; ++i) {
        const LightEmission e = emit(scene, random);
        const auto at = start_of(scene, e.ray);
        REQUIRE(at);
        REQUIRE(at->light);
        REQUIRE(scene.light_number(at->light) == scene.light_number(e.light));
        const double cosine = double(dot(at->normal, e.ray.direction));
        // Both triangles are as large, so that the density is even over the rectangle.
        CHECK(double(e.pdf.value) == relative(cosine / (pi_d * area), 1e-4));
        CHECK(double(scene.emission_pdf(*at, e.ray.direction).value) == relative(double(e.pdf.value), 1e-4));
        CHECK(double(e.cosine) == relative(cosine, 1e-4));
        CHECK(double(e.weight.y) == relative(2 * cosine / double(e.pdf.value), 1e-4));
        CHECK_FALSE(e.dirac);
        const DVec3 on = DVec3(at->position) - corner;
        const Vec3 local = Basis(at->normal).to_local(e.ray.direction);
        cube.add(on.x / 0.8, on.z / 0.8, cosine * cosine, turn_of(local.x, local.y));
    }
    CHECK(cube.p_value() > level);
}

TEST_CASE("emission: paths start on a sphere, outside or inside, with the density that is stated") {
    for (const Lamp& lamp : {sphere_lamp, hollow_lamp}) {
        const GreyScene scene = with_lamp(lamp);
        const bool inward = lamp.name == "hollow sphere";
        const DVec3 center = scene.space().point(inward ? DVec3(0.1, 0, 0) : DVec3(0.2, 0.5, 0.1));
        const double radius = inward ? 0.85 : 0.25, area = 4 * pi_d * radius * radius;
        Random random(2);
        Hypercube cube;
        for (int i = 0; i < 60000; ++i) {
            const LightEmission e = emit(scene, random);
            const DVec3 outward = glm::normalize(DVec3(e.ray.origin) - center), normal = inward ? -outward : outward;
            const double cosine = glm::dot(normal, DVec3(e.ray.direction));
            REQUIRE(cosine > 0);
            CHECK(glm::length(DVec3(e.ray.origin) - center) == relative(radius, 1e-4));
            CHECK(double(e.pdf.value) == relative(cosine / (pi_d * area), 1e-3));
            CHECK(double(e.cosine) == relative(cosine, 1e-3));
            CHECK(double(e.weight.y) == relative((inward ? 1 : 3) * pi_d * area, 1e-3));
            SurfacePoint at;
            at.position = e.ray.origin;
            at.normal = Vec3(normal);
            at.light = e.light;
            CHECK(double(scene.emission_pdf(at, e.ray.direction).value) == relative(double(e.pdf.value), 1e-3));
            const Vec3 local = Basis(Vec3(normal)).to_local(e.ray.direction);
            cube.add(0.5 + 0.5 * outward.z, turn_of(outward.x, outward.y), cosine * cosine, turn_of(local.x, local.y));
        }
        CHECK(cube.p_value() > level);
    }
}

TEST_CASE("emission: a point sends paths everywhere, a sun and a sky through all of the scene") {
    for (const Lamp& lamp : {point_lamp, sun_lamp, sky_lamp}) {
        const GreyScene scene = with_lamp(lamp);
        CAPTURE(lamp.name);
        const std::string_view kind = lamp.name;
        Random random(3);
        Hypercube cube;
        // Of the sphere around the scene: its corners are at distance sqrt(3), nearly.
        double radius = 0;
        for (int i = 0; i < 60000; ++i) {
            const LightEmission e = emit(scene, random);
            const DVec3 d(e.ray.direction), o(e.ray.origin);
            CHECK(e.dirac == (kind != "sky"));
            CHECK(e.cosine == 1);
            const double z = 0.5 + 0.5 * d.z, around = turn_of(d.x, d.y);
            if (kind == "point") {
                CHECK(glm::length(o - scene.space().point({0.2, 0.6, -0.1})) < 1e-6);
                CHECK(double(e.pdf.value) == relative(1 / (4 * pi_d), 1e-5));
                CHECK(double(e.weight.y) == relative(1.5 * 4 * pi_d, 1e-5));
                cube.add(z, around, std::fmod(16 * z, 1.0), std::fmod(16 * around, 1.0));
                continue;
            }
            const DVec3 across = o - d * glm::dot(o, d);
            if (i == 0) radius = std::sqrt(double(e.weight.y) / (kind == "sun" ? 2 * pi_d : 0.7 * 4 * pi_d * pi_d));
            CHECK(radius > std::sqrt(3.0) * 0.9998);
            CHECK(radius < 1.8);
            CHECK(glm::dot(o, d) < -std::sqrt(3.0) * 0.9998);  // begins outside
            CHECK(glm::length(across) < radius * (1 + 1e-5));
            const double disk = 1 / (pi_d * radius * radius);
            CHECK(double(e.pdf.value) == relative(kind == "sun" ? disk : disk / (4 * pi_d), 1e-4));
            const Basis basis(-e.ray.direction);
            const double x = glm::dot(across, DVec3(basis.tangent)), y = glm::dot(across, DVec3(basis.bitangent));
            const double r2 = (x * x + y * y) / (radius * radius), angle = turn_of(x, y);
            if (kind == "sun") {
                CHECK(glm::length(d - glm::normalize(DVec3(0.3, -1, 0.2))) < 1e-6);
                cube.add(r2, angle, std::fmod(16 * r2, 1.0), std::fmod(16 * angle, 1.0));
            } else {
                CHECK(double(scene.environment_emission_pdf(-e.ray.direction).value) ==
                      relative(double(e.pdf.value), 1e-5));
                cube.add(z, around, r2, angle);
            }
        }
        CHECK(cube.p_value() > level);
    }
}

TEST_CASE("emission: the density includes the choice among lights") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    for (const Lamp& lamp : {rectangle_lamp, sphere_lamp, point_lamp, sun_lamp, sky_lamp}) lamp.add(description);
    const GreyScene scene = build_grey(description);
    Random random(4);
    std::vector<double> chosen(scene.light_count()), claimed(scene.light_count());
    for (int i = 0; i < 100000; ++i) {
        const LightEmission e = emit(scene, random);
        const std::size_t number = scene.light_number(e.light);
        chosen[number] += 1;
        SurfacePoint upright;
        upright.normal = {0, 0, 1};
        const double alone = scene.with_light(e.light, [&](const auto& light) {
            if constexpr (AreaLight<std::remove_cvref_t<decltype(light)>>)
                return double(light.emission_pdf(upright, {std::sqrt(1 - e.cosine * e.cosine), 0, e.cosine}).value);
            else if constexpr (EnvironmentLight<std::remove_cvref_t<decltype(light)>>)
                return double(light.emission_pdf(-e.ray.direction).value);
            else return double(light.emit({0.5f, 0.5f}, {0.5f, 0.5f}).pdf.value);
        });
        claimed[number] = double(e.pdf.value) / alone;
        if (!e.dirac) {
            const double density = [&] {
                if (scene.infinite(e.light)) return double(scene.environment_emission_pdf(-e.ray.direction).value);
                SurfacePoint at;
                at.light = e.light;
                at.normal = {0, 0, 1};
                return double(scene.emission_pdf(at, {std::sqrt(1 - e.cosine * e.cosine), 0, e.cosine}).value);
            }();
            CHECK(density == relative(double(e.pdf.value), 1e-3));
        }
    }
    CHECK(std::accumulate(claimed.begin(), claimed.end(), 0.0) == relative(1, 1e-4));
    for (double& c : claimed) c *= 100000;
    CHECK(chi_square(chosen, claimed).p_value > level);
}

TEST_CASE("emission: what arrives at a surface is what light sampling finds there") {
    const auto check = [](const std::string& name, const auto& add) {
        GreyDescription description = grey_description();
        stretch_to_unit_box(description);
        add(description);
        // Something in the way of some of it.
        description.add(Sphere{{-0.2, 0, 0.3}, 0.15}, 0);
        const std::size_t receiver = description.add(Lambert{Rgb(0.1f)});
        description.add(quad({-0.3, -0.4, 0.3}, {0.3, -0.4, 0.3}, {0.3, -0.4, -0.3}, {-0.3, -0.4, -0.3}), receiver);
        const GreyScene scene = build_grey(description);
        Random random(5);
        const auto at = [&](const Vec2& u) {
            const Vec3 from(Vec3(-0.3f + 0.6f * u.x, -0.35f, -0.3f + 0.6f * u.y));
            return scene.intersect(Ray{.origin = Vec3(scene.space().point(DVec3(from))), .direction = {0, -1, 0}});
        };
        const double area = 0.36;
        Mean sampled, emitted;
        const MaterialIndex receiving = at({0.5f, 0.5f})->material;
        for (int i = 0; i < 300000; ++i) {
            const auto point = at(random.next_2d());
            REQUIRE(point);
            const LightSample s = scene.sample_light(*point, random.next(), random.next_2d());
            const double cosine = double(dot(s.wi, point->normal));
            const bool reaches = s.pdf.value > 0 && cosine > 0 && !scene.occluded(s.visibility);
            sampled.add(reaches ? area * double(s.radiance.y) * cosine / double(s.pdf.value) : 0);

            const LightEmission e = emit(scene, random);
            const auto hit = scene.intersect(e.ray);
            const bool arrives =
                hit && hit->material.position() == receiving.position() && dot(hit->normal, e.ray.direction) < 0;
            emitted.add(arrives ? double(e.weight.y) : 0);
        }
        CAPTURE(name);
        CAPTURE(sampled.value());
        CAPTURE(emitted.value());
        CHECK(sampled.value() > 0);
        CHECK(std::abs(sampled.value() - emitted.value()) < 5 * std::hypot(sampled.error(), emitted.error()));
        CHECK(emitted.error() < 0.03 * emitted.value());
    };
    for (const Lamp& lamp : lamps) check(lamp.name, lamp.add);
    check("all", [](GreyDescription& d) {
        for (const Lamp& lamp : {rectangle_lamp, sphere_lamp, point_lamp, sun_lamp, sky_lamp}) lamp.add(d);
    });
}

// Among the paths that pass a small ball around a point, each counted by the spread over the ball's cross-section,
// places on the light are distributed as `sample` at the point chooses them: the mean of any function of the place is
// the same.
TEST_CASE("emission: the spread is the ratio of the densities of sampling and of passing") {
    for (const Lamp& lamp : lamps) {
        CAPTURE(lamp.name);
        const GreyScene scene = with_lamp(lamp);
        const SurfacePoint at = free_point(scene, {0.05, -0.1, 0.2}, normalize(Vec3(0.2f, 0.9f, 0.1f)));
        const DVec3 center(at.position);
        constexpr double ball = 0.06;
        const auto functions = [&](const DVec3& wi) { return DVec3(1, wi.x, wi.z); };
        Random random(6);
        Mean sampled[3], passed[3];
        const TypedIndex light = emit(scene, random).light;
        for (int i = 0; i < 20000; ++i) {
            const LightSample s = scene.sample_light(at, random.next(), random.next_2d());
            const bool found = s.pdf.value > 0;
            const DVec3 f = found ? functions(DVec3(s.wi)) : DVec3(0);
            for (int k = 0; k < 3; ++k) sampled[k].add(f[k]);
            if (!found || s.dirac) continue;
            // The same by the other road.
            const auto hit = scene.intersect(Ray{.origin = at.position, .direction = s.wi});
            if (hit && hit->light && !scene.infinite(hit->light) && dot(hit->normal, s.wi) < -0.05f)
                CHECK(double(scene.spread(hit->light, at, s.wi, hit->position)) == relative(double(s.spread), 2e-3));
            if (!hit) CHECK(double(scene.spread(light, at, s.wi, Vec3(0))) == relative(double(s.spread), 1e-4));
        }
        for (int i = 0; i < 1000000; ++i) {
            const LightEmission e = emit(scene, random);
            const DVec3 o(e.ray.origin), d(e.ray.direction), closest = o + d * glm::dot(center - o, d);
            DVec3 f(0);
            if (glm::dot(center - o, d) > 0 && glm::length(closest - center) < ball) {
                // Of light from beyond the scene the direction is the place.
                const Vec3 wi = scene.infinite(e.light) ? -e.ray.direction : normalize(e.ray.origin - at.position);
                const double spread = double(scene.spread(e.light, at, wi, e.ray.origin));
                f = functions(DVec3(wi)) * (spread / (pi_d * ball * ball));
            }
            for (int k = 0; k < 3; ++k) passed[k].add(f[k]);
        }
        for (int k = 0; k < 3; ++k) {
            CAPTURE(k);
            CAPTURE(sampled[k].value());
            CAPTURE(passed[k].value());
            // The ball is not a point, which is worth less than 1 %.
            CHECK(std::abs(sampled[k].value() - passed[k].value()) <
                  5 * std::hypot(sampled[k].error(), passed[k].error()) + 0.01);
        }
        CHECK(passed[0].error() < 0.06);
    }
}
