// Rays that a method should not have made: Embree must not see them, and the user must learn of them.

#include <lightswitch/render/render.hpp>

#include "../support/scenes.hpp"

#include <doctest/doctest.h>

#include <functional>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();
constexpr float most = embree::Accelerator::largest_coordinate;

/// A ball around the origin in a box, so that every ray from within meets something.
GreyScene room(bool robust = false) {
    GreyDescription scene = grey_description();
    scene.add(cube().flipped(), 0);
    scene.add(Sphere{{0, 0, 0.5}, 0.25, false}, 0);
    scene.film.width = 4, scene.film.height = 3;
    return build_scene<Bsdfs<Lambert>, AllLights>(scene, {.embree_config = "threads=1", .robust = robust});
}

/// Rays that must be refused: a good one with one number exchanged for one that is not, or no direction.
std::vector<Ray> bad_rays() {
    std::vector<Ray> rays;
    const Ray good{.origin = {0.1f, 0.2f, 0}, .direction = {0.1f, 0.2f, 1}};
    for (const float bad : {nan_f, -nan_f, infinity, -infinity, 1.01f * most, -3e38f})
        for (int axis = 0; axis < 3; ++axis) {
            rays.push_back(good);
            rays.back().origin[axis] = bad;
            rays.push_back(good);
            rays.back().direction[axis] = bad;
        }
    rays.push_back(good);
    rays.back().direction = Vec3(0);
    rays.push_back(good);
    rays.back().direction = Vec3(-0.0f, 0, 0);
    rays.push_back(good);
    rays.back().near = nan_f;
    rays.push_back(good);
    rays.back().far = nan_f;
    rays.push_back(good);
    rays.back().near = rays.back().far = nan_f;
    return rays;
}

/// Shoots `ray` instead of the camera's where that is `chosen`, once for the closest hit and once for visibility.
struct Shooter {
    static constexpr std::string_view name = "shooter";
    static constexpr Kind kind = Kind::heuristic;
    std::function<bool(const Ray&)> chosen;
    Ray ray;

    Rgb radiance(const auto& scene, const Ray& camera_ray, auto&) const {
        const Ray& at = chosen(camera_ray) ? ray : camera_ray;
        return Rgb((scene.intersect(at) ? 0.0f : 1.0f) + (scene.occluded(at) ? 0.0f : 2.0f));
    }
};

/// Shoots `ray` along every light path.
struct LightShooter {
    static constexpr std::string_view name = "light-shooter";
    static constexpr Kind kind = Kind::heuristic;
    Ray ray;

    struct State {};
    State start(auto&) const { return {}; }
    void iterate(auto& frame, State&) const {
        frame.paths(2000, [&](std::uint64_t, auto&, auto&) { (void)frame.scene().intersect(ray); });
    }
};

}  // namespace

TEST_CASE("embree: a ray that is not finite, too large or without a direction meets nothing, and is counted") {
    for (const bool robust : {false, true}) {
        const GreyScene scene = room(robust);
        std::size_t number = 0;
        for (const Ray& ray : bad_rays()) {
            CAPTURE(number++);
            const RayCount before = ray_count;
            CHECK_FALSE(scene.intersect(ray));
            CHECK(ray_count.refused - before.refused == 1);
            CHECK_FALSE(scene.occluded(ray));
            CHECK(ray_count.refused - before.refused == 2);
            CHECK(ray_count.intersect - before.intersect == 1);
            CHECK(ray_count.occluded - before.occluded == 1);
        }
    }
}

TEST_CASE("embree: rays at the edge of what it takes are traced, and none is counted") {
    const GreyScene scene = room();
    const RayCount before = ray_count;
    const auto hits = [&](const Ray& ray) {
        CHECK(bool(scene.intersect(ray)) == scene.occluded(ray));
        return scene.occluded(ray);
    };
    CHECK(hits({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 1}}));
    CHECK(hits({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 0.99f * most}}));
    CHECK(hits({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 1e-15f}}));
    CHECK_FALSE(hits({.origin = {0.99f * most, 0.2f, 0}, .direction = {0, 0, 1}}));
    CHECK_FALSE(hits({.origin = {0, -0.99f * most, 0}, .direction = {0, -1, 0}}));
    // Between two numbers there is nothing when the second is smaller.
    CHECK_FALSE(hits({.origin = Vec3(0), .direction = {0, 0, 1}, .near = 2, .far = 1}));
    CHECK_FALSE(hits({.origin = Vec3(0), .direction = {0, 0, 1}, .near = 0, .far = -1}));
    CHECK_FALSE(hits({.origin = Vec3(0), .direction = {0, 0, 1}, .near = 0, .far = -infinity}));
    CHECK_FALSE(hits({.origin = Vec3(0), .direction = {0, 0, 1}, .near = infinity, .far = infinity}));
    // What is behind the origin is not met.
    const auto hit = scene.intersect({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 1}, .near = -5, .far = infinity});
    REQUIRE(hit);
    CHECK(hit->distance > 0);
    CHECK(hits({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 1}, .near = -infinity, .far = infinity}));
    CHECK_FALSE(hits({.origin = {0.1f, 0.2f, 0}, .direction = {0, 0, 1}, .near = -5, .far = -1}));
    CHECK(ray_count.refused == before.refused);
}

TEST_CASE("render: rays that Embree must not see are counted with pixel and iteration") {
    const GreyScene scene = room();
    // Only rays of pixel 6 leave between these two.
    const auto slope = [](const Ray& r) { return Vec2(r.direction.x, r.direction.y) / r.direction.z; };
    const Vec2 a = slope(scene.camera().ray({2, 1}, Vec2(0.5f))), b = slope(scene.camera().ray({3, 2}, Vec2(0.5f)));
    const auto chosen = [&](const Ray& ray) {
        return glm::all(glm::greaterThan(slope(ray), glm::min(a, b))) &&
               glm::all(glm::lessThan(slope(ray), glm::max(a, b)));
    };
    for (const Ray& ray : bad_rays()) {
        Session<GreyScene, Shooter> session(scene, Shooter{chosen, ray}, {.seed = 7});
        session.run({.samples = 3});
        const RenderCounts& counts = session.statistics().counts;
        CHECK(counts.non_finite == 6);  // two rays in each of three iterations
        REQUIRE(counts.first_non_finite.size() == 6);
        for (std::size_t i = 0; i < 6; ++i) CHECK(counts.first_non_finite[i] == NonFinite{i / 2, 7, 6});
        CHECK(counts.rays == 3 * 12 * 2);
        CHECK(session.film().image().pixels()[6] == Rgb(3));  // met nothing
        CHECK(session.image().metadata.at("non_finite") == "6");
    }
}

TEST_CASE("render: rays of light paths that Embree must not see are counted") {
    const GreyScene scene = room();
    Session<GreyScene, LightShooter> session(scene, LightShooter{{.origin = {nan_f, 0, 0}}}, {.seed = 3});
    session.run({.samples = 2});
    CHECK(session.statistics().counts.non_finite == 4000);
    REQUIRE(session.statistics().counts.first_non_finite.size() == 16);
    CHECK(session.statistics().counts.first_non_finite[0] == NonFinite{0, 3, 0});
}
