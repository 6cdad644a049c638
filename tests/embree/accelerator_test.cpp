#include <lightswitch/core/warp.hpp>
#include <lightswitch/embree/accelerator.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <optional>
#include <thread>
#include <vector>

using namespace lightswitch;
using test::Random;
using test::relative;

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Accelerator = embree::Accelerator;

const std::string one_thread = "threads=1";

struct Shapes {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    std::vector<Accelerator::SphereData> spheres;
};

Shapes random_shapes(std::size_t triangles, std::size_t spheres, Random& random) {
    Shapes shapes;
    const auto anywhere = [&] { return random.next_3d() * 2.0f - 1.0f; };
    for (std::size_t i = 0; i < triangles; ++i) {
        const Vec3 center = anywhere();
        for (int corner = 0; corner < 3; ++corner) shapes.positions.push_back(center + 0.4f * anywhere());
        const auto first = static_cast<std::uint32_t>(3 * i);
        shapes.triangles.push_back({first, first + 1, first + 2});
    }
    for (std::size_t i = 0; i < spheres; ++i) shapes.spheres.push_back({anywhere(), 0.02f + 0.3f * random.next()});
    return shapes;
}

Accelerator build(const Shapes& shapes, bool robust = false) {
    Accelerator accelerator(one_thread);
    if (!shapes.triangles.empty()) accelerator.add(shapes.positions, shapes.triangles);
    if (!shapes.spheres.empty()) accelerator.add(shapes.spheres);
    accelerator.commit(robust);
    return accelerator;
}

/// What a ray hits, by double precision and patience. `margin` is how clearly: the relative distance by which the
/// decision (inside the triangle, in front of the next one) could change before it would be another one.
struct Reference {
    bool hit = false;
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t geometry = 0, primitive = 0;
    double u = 0, v = 0, margin = 1;
};

void offer(Reference& best, double distance, std::uint32_t geometry, std::uint32_t primitive, double u, double v) {
    if (best.hit) best.margin = std::min(best.margin, std::abs(distance - best.distance));
    if (best.hit && best.distance <= distance) return;
    best.hit = true;
    best.distance = distance;
    best.geometry = geometry;
    best.primitive = primitive;
    best.u = u;
    best.v = v;
}

Reference brute_force(const Shapes& shapes, const Ray& ray) {
    Reference best;
    const DVec3 o(ray.origin), d(ray.direction);
    for (std::uint32_t i = 0; i < shapes.triangles.size(); ++i) {
        const DVec3 a(shapes.positions[shapes.triangles[i][0]]),
            e1 = DVec3(shapes.positions[shapes.triangles[i][1]]) - a,
            e2 = DVec3(shapes.positions[shapes.triangles[i][2]]) - a;
        const DVec3 p = glm::cross(d, e2), t = o - a, q = glm::cross(t, e1);
        const double determinant = glm::dot(e1, p);
        const double u = glm::dot(t, p) / determinant, v = glm::dot(d, q) / determinant,
                     distance = glm::dot(e2, q) / determinant;
        const double inside = std::min({u, v, 1 - u - v});
        if (distance > -1e-5) best.margin = std::min({best.margin, std::abs(inside), std::abs(distance)});
        if (inside >= 0 && distance > 0) offer(best, distance, 0, i, u, v);
    }
    const std::uint32_t sphere_geometry = shapes.triangles.empty() ? 0 : 1;
    for (std::uint32_t i = 0; i < shapes.spheres.size(); ++i) {
        const DVec3 c = DVec3(shapes.spheres[i].center) - o;
        const double r = double(shapes.spheres[i].radius), b = glm::dot(c, d), d2 = glm::dot(d, d);
        const double l = glm::length(c - d * (b / d2));
        best.margin = std::min(best.margin, std::abs(l - r));
        if (l > r) continue;
        const double half = std::sqrt((r * r - l * l) / d2);
        for (const double distance : {b / d2 - half, b / d2 + half}) {
            best.margin = std::min(best.margin, std::abs(distance));
            if (distance > 0) offer(best, distance, sphere_geometry, i, 0, 0);
        }
    }
    return best;
}

}  // namespace

TEST_CASE("embree: the closest hit is that of a brute-force search in double precision") {
    for (const bool robust : {false, true}) {
        Random random(1);
        const Shapes shapes = random_shapes(60, 20, random);
        const Accelerator accelerator = build(shapes, robust);
        int wrong = 0, clear = 0, hits = 0, wrong_occlusion = 0;
        double worst_distance = 0, worst_weight = 0, worst_normal = 0;
        for (int i = 0; i < 100000; ++i) {
            Ray ray;
            ray.origin = random.next_3d() * 2.4f - 1.2f;
            ray.direction = uniform_sphere(random.next_2d()) * (i % 2 == 0 ? 1.0f : 3.7f);
            const Reference truth = brute_force(shapes, ray);
            if (truth.margin < 1e-4) continue;  // a matter of rounding
            ++clear;
            embree::Hit hit{};
            const bool found = accelerator.intersect(ray, hit);
            if (found != truth.hit || (found && (hit.geometry != truth.geometry || hit.primitive != truth.primitive))) {
                ++wrong;
                continue;
            }
            if (!found) continue;
            ++hits;
            worst_distance = std::max(worst_distance, std::abs(double(hit.distance) - truth.distance));
            if (truth.geometry == 0) {
                worst_weight =
                    std::max({worst_weight, std::abs(double(hit.u) - truth.u), std::abs(double(hit.v) - truth.v)});
                const auto corner = [&](int n) {
                    return DVec3(shapes.positions[shapes.triangles[truth.primitive][static_cast<std::size_t>(n)]]);
                };
                const DVec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
                worst_normal = std::max(worst_normal, glm::length(glm::normalize(DVec3(hit.normal)) - normal));
            }
            // Before the hit the way is free, and beyond it is not.
            ray.far = hit.distance * 0.999f;
            wrong_occlusion += accelerator.occluded(ray);
            ray.far = hit.distance * 1.001f;
            wrong_occlusion += !accelerator.occluded(ray);
            ray.near = hit.distance * 1.0005f;
            wrong_occlusion += accelerator.occluded(ray) && truth.margin > 0.01;
        }
        CAPTURE(robust);
        CHECK(clear > 90000);
        CHECK(hits > 30000);
        CHECK(wrong == 0);
        CHECK(wrong_occlusion == 0);
        CHECK(worst_distance < 1e-4);
        CHECK(worst_weight < 1e-3);
        CHECK(worst_normal < 1e-4);
    }
}

TEST_CASE("embree: geometries are numbered in the order in which they were added") {
    Random random(2);
    Accelerator accelerator(one_thread);
    const std::vector<Triangle> one{{0, 1, 2}};
    for (std::uint32_t i = 0; i < 5; ++i) {
        const float x = static_cast<float>(i);
        CHECK(accelerator.add(std::vector<Vec3>{{x, 0, 1}, {x + 0.5f, 0, 1}, {x, 1, 1}}, one) == i);
    }
    CHECK(accelerator.add(std::vector<Accelerator::SphereData>{{{7, 0, 3}, 1}, {{10, 0, 3}, 1}}) == 5);
    accelerator.commit();
    embree::Hit hit{};
    for (std::uint32_t i = 0; i < 5; ++i) {
        REQUIRE(accelerator.intersect(Ray{.origin = {static_cast<float>(i) + 0.1f, 0.2f, 0}}, hit));
        CHECK(hit.geometry == i);
        CHECK(hit.primitive == 0);
        CHECK(hit.distance == 1);
        CHECK(hit.normal.z > 0);
    }
    REQUIRE(accelerator.intersect(Ray{.origin = {10, 0, 0}}, hit));
    CHECK(hit.geometry == 5);
    CHECK(hit.primitive == 1);
    CHECK(hit.distance == relative(2, 1e-5));
}

TEST_CASE("embree: an empty scene is free everywhere") {
    const Accelerator accelerator = build({});
    embree::Hit hit{};
    CHECK_FALSE(accelerator.intersect(Ray{}, hit));
    CHECK_FALSE(accelerator.occluded(Ray{}));
}

TEST_CASE("embree: impossible configurations are errors that name the string") {
    for (const char* config : {"threads=x", "threads=", "verbose=loud"}) {
        CAPTURE(config);
        try {
            const embree::Device device(config);
            FAIL("accepted");
        } catch (const Error& error) {
            CHECK(std::string(error.what()).find(config) != std::string::npos);
            CHECK(std::string(error.what()).find('\n') == std::string::npos);
        }
    }
    CHECK_THROWS_AS(Accelerator("threads=many"), Error);
    // A failure leaves nothing behind that would fail the next one.
    CHECK_NOTHROW(embree::Device());
    CHECK_NOTHROW(embree::Device("threads=2"));
}

TEST_CASE("embree: errors of later calls are kept until they are asked for, and then thrown once") {
    const embree::Device device(one_thread);
    CHECK_NOTHROW(device.check("doing nothing"));
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, 100000);
    rtcReleaseGeometry(geometry);
    try {
        device.check("asking for too many time steps");
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find("asking for too many time steps") != std::string::npos);
    }
    CHECK_NOTHROW(device.check("doing nothing"));
}

TEST_CASE("embree: memory is counted, and given back") {
    Random random(3);
    const Shapes small = random_shapes(10, 0, random), large = random_shapes(20000, 100, random);
    const Accelerator a = build(small), b = build(large);
    CHECK(a.memory() > 0);
    CHECK(b.memory() > a.memory());
    CHECK(b.memory() > 20000 * 48);
    CHECK(b.memory() < 20000 * 2000);
    CHECK(b.build_seconds() > 0);

    const embree::Device device(one_thread);
    {
        const RTCScene scene = rtcNewScene(device.get());
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 100000);
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1);
        CHECK(device.memory() >= 1200000);
        rtcReleaseGeometry(geometry);
        rtcReleaseScene(scene);
    }
    CHECK(device.memory() < 100000);
}

TEST_CASE("embree: numbers of elements that no machine has are errors, not crashes") {
    const embree::Device device(one_thread);
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, std::size_t{1} << 55);
    CHECK_THROWS_AS(device.check("allocating a buffer"), Error);
    rtcReleaseGeometry(geometry);
}

TEST_CASE("embree: many devices and scenes at once, moved and used from several threads") {
    Random random(4);
    const Shapes shapes = random_shapes(50, 5, random);
    std::vector<Accelerator> many;
    for (int i = 0; i < 40; ++i) many.push_back(build(shapes));
    std::vector<std::uint32_t> sums(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < sums.size(); ++t)
        threads.emplace_back([&, t] {
            Random local(5);
            for (int i = 0; i < 4000; ++i) {
                embree::Hit hit{};
                const Ray ray{.origin = local.next_3d(), .direction = uniform_sphere(local.next_2d())};
                if (many[static_cast<std::size_t>(i) % many.size()].intersect(ray, hit))
                    sums[t] = sums[t] * 31 + hit.primitive + 7 * hit.geometry;
            }
        });
    for (auto& thread : threads) thread.join();
    CHECK(sums[0] != 0);
    for (const auto sum : sums) CHECK(sum == sums[0]);
}

TEST_CASE("embree: rays are counted per thread") {
    const Accelerator accelerator = build({});
    const RayCount before = ray_count;
    embree::Hit hit{};
    for (int i = 0; i < 5; ++i) accelerator.intersect(Ray{}, hit);
    for (int i = 0; i < 3; ++i) (void)accelerator.occluded(Ray{});
    CHECK(ray_count.intersect - before.intersect == 5);
    CHECK(ray_count.occluded - before.occluded == 3);
    std::thread([&] { CHECK(ray_count.intersect == 0); }).join();
}
