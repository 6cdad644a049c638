// The ray that a light sample asks to be free: it must end before the light, whatever the sizes and distances, and must
// still see what is just in front of the light.

#include "../support/scenes.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

struct Blocked {
    int samples = 0, blocked = 0;
};

constexpr double inside = 0.99;

/// Samples a light of `size` at `center`, alone in the box from -1 to 1, from points all over the box; of a sphere that
/// emits inwards from points in it. `also` may add to the scene what depends on the size and the centre.
template <class Add>
Blocked blocked_samples(const Add& add, bool from_inside, const DVec3& center, double size, int points, bool robust,
                        Random& random) {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    add(description);
    const auto scene =
        build_scene<Bsdfs<Lambert>, AllLights>(description, {.embree_config = "threads=1", .robust = robust});
    Blocked result;
    for (int i = 0; i < points; ++i) {
        const DVec3 anywhere = DVec3(random.next_3d()) * 1.8 - 0.9;
        const DVec3 ball = DVec3(uniform_sphere(random.next_2d()));
        const DVec3 position =
            from_inside ? center + size * inside * std::cbrt(double(random.next())) * ball : anywhere;
        const LightSample sample = scene.sample_light(free_point(scene, position), random.next(), random.next_2d());
        if (!(sample.pdf.value > 0)) continue;
        ++result.samples;
        result.blocked += scene.occluded(sample.visibility);
    }
    return result;
}

constexpr double sizes[] = {0.5, 0.1, 0.01, 1e-3, 1e-4, 1e-5};
constexpr double places[] = {0, 0.01, 0.5};

/// Of lights of all sizes, in the centre of the scene, where coordinates are small, and away from it.
template <class Add>
Blocked over_sizes_and_places(const Add& add, bool from_inside, bool robust, std::uint32_t seed) {
    Random random(seed);
    Blocked all;
    for (const double size : sizes)
        for (const double place : places)
            for (int i = 0; i < 8; ++i) {
                const DVec3 center = place * DVec3(uniform_sphere(random.next_2d()));
                const auto here = [&](GreyDescription& description) { add(description, center, size, random); };
                const Blocked one = blocked_samples(here, from_inside, center, size, 2000, robust, random);
                all.samples += one.samples;
                all.blocked += one.blocked;
            }
    return all;
}

void add_triangle(GreyDescription& scene, const DVec3& center, double size, Random& random) {
    scene.add(random_triangle(random, center, size), 0, Rgb(1));
}
void add_sphere(GreyDescription& scene, const DVec3& center, double size, Random&) {
    scene.add(Sphere{center, size, false}, 0, Rgb(1));
}
void add_inward_sphere(GreyDescription& scene, const DVec3& center, double size, Random&) {
    scene.add(Sphere{center, size, true}, 0, Rgb(1));
}

}  // namespace

TEST_CASE("light visibility: no light hides itself") {
    for (const bool robust : {false, true}) {
        CAPTURE(robust);
        const Blocked triangle = over_sizes_and_places(add_triangle, false, robust, 1);
        CHECK(triangle.samples > 100000);
        CHECK(triangle.blocked == 0);
        const Blocked sphere = over_sizes_and_places(add_sphere, false, robust, 2);
        CHECK(sphere.samples > 200000);
        CHECK(sphere.blocked == 0);
        const Blocked inward = over_sizes_and_places(add_inward_sphere, true, robust, 3);
        CHECK(inward.samples > 200000);
        CHECK(inward.blocked == 0);
    }
}

TEST_CASE(
    "light visibility: what stands in front by a ten-thousandth of the distance is seen, what stands behind is not") {
    // A square light of side 2 a at z = 0 that shines down, and points around 1 below it; `gap` is where the screen is.
    const auto blocked = [](double a, double gap, std::uint32_t seed) {
        GreyDescription description = grey_description();
        stretch_to_unit_box(description);
        const Mesh square = rectangle(DMat4({a, 0, 0, 0}, {0, -a, 0, 0}, {0, 0, -1, 0}, {0.1, 0.2, 0, 1}));
        description.add(square, 0, Rgb(1));
        Mesh screen = square;
        for (DVec3& p : screen.positions) p = (p - DVec3(0.1, 0.2, 0)) * 10.0 + DVec3(0.1, 0.2, -gap);
        description.add(screen, 0);
        const GreyScene scene = build_grey(description);
        Random random(seed);
        Blocked result;
        for (int i = 0; i < 50000; ++i) {
            const DVec3 from(double(random.next()) - 0.5, double(random.next()) - 0.5, -0.95);
            const LightSample sample = scene.sample_light(free_point(scene, from), random.next(), random.next_2d());
            ++result.samples;
            result.blocked += scene.occluded(sample.visibility);
        }
        return result;
    };
    for (const double a : {0.05, 1e-3}) {
        const Blocked front = blocked(a, 1e-4, 4), behind = blocked(a, -1e-4, 5);
        CHECK(front.blocked == front.samples);
        CHECK(behind.blocked == 0);
    }
}

TEST_CASE("light visibility: screens around a luminous sphere") {
    for (const double radius : {0.2, 1e-2, 1e-4})
        for (const double shell : {1 + 1e-4 / radius, 1 - 1e-4}) {
            GreyDescription description = grey_description();
            stretch_to_unit_box(description);
            const DVec3 center(0.1, -0.2, 0.3);
            description.add(Sphere{center, radius, false}, 0, Rgb(1));
            description.add(Sphere{center, radius * shell, false}, 0);
            const GreyScene scene = build_grey(description);
            Random random(6);
            Blocked result;
            for (int i = 0; i < 30000; ++i) {
                const DVec3 from =
                    center + (0.5 + 0.1 * double(random.next())) * DVec3(uniform_sphere(random.next_2d()));
                const LightSample sample = scene.sample_light(free_point(scene, from), random.next(), random.next_2d());
                ++result.samples;
                result.blocked += scene.occluded(sample.visibility);
            }
            CAPTURE(radius);
            CAPTURE(shell);
            CHECK(result.blocked == (shell > 1 ? result.samples : 0));
        }
}

TEST_CASE("light visibility: point and directional lights and the environment") {
    GreyDescription description = grey_description();
    stretch_to_unit_box(description);
    const DVec3 lamp(0.2, 0.1, 0.6);
    description.add(Source(PointSource{lamp, Rgb(1)}));
    description.add(rectangle(DMat4({0.3, 0, 0, 0}, {0, 0.3, 0, 0}, {0, 0, 1, 0}, {0.2, 0.1, 0.3, 1})), 0);
    const GreyScene scene = build_grey(description);
    const auto free = [&](const DVec3& from) {
        return !scene.occluded(scene.sample_light(free_point(scene, from), 0.5f, {0.5f, 0.5f}).visibility);
    };
    CHECK_FALSE(free({0.2, 0.1, -0.4}));
    CHECK_FALSE(free({0.2, 0.1, 0.3 - 1e-5}));
    CHECK(free({0.2, 0.1, 0.3 + 1e-5}));
    CHECK(free({0.9, 0.9, 0.6}));
    CHECK(free(lamp + DVec3(0, 0, 0.3)));

    for (const Source& far : {Source(DirectionalSource{{0, 0, -1}, Rgb(1)}), Source(EnvironmentSource{Rgb(1)})}) {
        description.sources.clear();
        description.add(far);
        const GreyScene outdoor = build_grey(description);
        const auto blocked = [&](const DVec3& from) {
            return outdoor.occluded(outdoor.sample_light(free_point(outdoor, from), 0.5f, {0.5f, 0.5f}).visibility);
        };
        CHECK(blocked({0.2, 0.1, 0.29}));
        CHECK_FALSE(blocked({0.2, 0.1, 0.31}));
    }
}
