// A sample that is made again is the one that the film got, whatever the method, and what is told of it adds up.

#include <lightswitch/compiled.hpp>
#include <lightswitch/render/replay.hpp>

#include "../support/relative.hpp"
#include "support/renders.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr int width = 24, height = 18;

/// A stock scene on a small film, which has more than one tile.
AnyScene small(std::string_view name, const Filter& filter = Filter::box(), double aperture = 0) {
    LibraryDescription description = *stock::describe(name);
    description.film.width = width;
    description.film.height = height;
    description.film.filter = filter;
    description.camera.aperture_radius = aperture;
    description.camera.focus_distance = 4;
    return build_any(description);
}

bool same_bits(const Rgb& a, const Rgb& b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

/// Adds up what is told, as `PathReplay` says that it adds up.
void check_sums(const PathReplay& replayed) {
    Rgb sum(0), slot(0);
    DVec3 splatted(0);
    for (const PathEvent& event : replayed.events) {
        if (event.kind == PathEvent::Kind::contribution) sum += event.value;
        if (event.kind == PathEvent::Kind::splat && event.here) splatted += DVec3(event.value);
        if (event.kind != PathEvent::Kind::sample) continue;
        CHECK(same_bits(sum, event.value));
        slot += event.value;
        sum = Rgb(0);
    }
    CHECK(same_bits(slot, replayed.sample));
    CHECK(splatted == replayed.splatted);
    CHECK(replayed.value() == DVec3(slot) + splatted);
}

/// What a method can be asked for in a test without rendering for long.
template <class M>
M quick(M method) {
    if constexpr (requires { method.bootstrap; }) method.bootstrap = 500;
    if constexpr (requires { method.always_guide; }) {
        method.first_training = 8;
        method.always_guide = true;
    }
    return method;
}

/// Random pixels of the first iterations: what the film holds after each of them, and its variance, are those of the
/// replayed values.
template <class SceneType, class M>
void check_method(const SceneType& scene, const M& method, const Settings& settings, int pixels) {
    CAPTURE(M::name);
    CAPTURE(scene.name());
    constexpr int iterations = 3;
    std::vector<Image> means;
    Session<SceneType, M> session(scene, method, settings);
    for (int n = 1; n <= iterations; ++n) {
        session.run({.samples = n});
        means.push_back(session.film().image());
    }
    const Image variance = session.film().variance();
    Random random(static_cast<std::uint32_t>(settings.seed));
    for (int i = 0; i < pixels; ++i) {
        const int x = static_cast<int>(random.next() * width), y = static_cast<int>(random.next() * height);
        const auto pixel = static_cast<std::size_t>(y * width + x);
        CAPTURE(x);
        CAPTURE(y);
        PixelSums sums;
        PixelSums::Windows windows;
        for (int n = 0; n < iterations; ++n) {
            const PathReplay replayed = replay(scene, method, settings, x, y, static_cast<std::uint64_t>(n));
            check_sums(replayed);
            // Which of a chain's paths a splat came of is not told.
            if (std::string_view(M::name) != "mlt") CHECK(replayed.explained);
            CHECK(replayed.dropped == 0);
            CHECK_FALSE(replayed.cancelled);
            sums.add(windows, replayed.value());
            CHECK(same_bits(Rgb(sums.values(windows) / double(n + 1)),
                            means[static_cast<std::size_t>(n)].pixels()[pixel]));
        }
        const DVec3 sum = sums.values(windows);
        const DVec3 spread = glm::max(sums.squares(windows) - sum * sum / double(iterations), DVec3(0));
        CHECK(same_bits(Rgb(spread / double(iterations * (iterations - 1))), variance.pixels()[pixel]));
    }
}

}  // namespace

TEST_CASE("replay: every method's values are those that the film got, bit for bit") {
    const AnyScene scenes[] = {small("cornell-box"), small("cornell-spheres", Filter::gaussian(), 0.1),
                               small("still-life", Filter::tent()), small("furnace")};
    std::uint64_t seed = 3;
    for (const AnyScene& scene : scenes)
        for_each_method([&](const auto& m) {
            const auto method = quick(m);
            const Sampling sampling = ++seed % 2 ? Sampling::sobol : Sampling::independent;
            std::visit([&](const auto& s) { check_method(s, method, {.seed = seed, .sampling = sampling}, 4); }, scene);
        });
}

TEST_CASE("replay: settings of methods, and deep paths") {
    const AnyScene any = small("cornell-spheres");
    const auto& scene = std::get<FullScene>(any);
    check_method(scene, Bdpt{.only = Strategy{2, 2}}, {.seed = 2}, 6);
    check_method(scene, Bdpt{.only = Strategy{3, 1, false}}, {.seed = 2}, 6);
    check_method(scene, Bdpt{.max_depth = 3, .rr_depth = 0}, {.seed = 2}, 6);
    check_method(scene, PhotonMapping{.paths_per_pixel = 2, .final_gather = true}, {.seed = 3}, 6);
    check_method(scene, Vcm{.rr_depth = 1, .radius = {.pixels = 0}}, {.seed = 4}, 6);
    check_method(scene, PathTracerNee{.rr_depth = 0}, {.seed = 5}, 30);
    check_method(scene, PathTracer{.max_depth = 2}, {.seed = 6}, 30);
    check_method(scene, PathTracerNee{.max_depth = 0}, {.seed = 5}, 3);
}

TEST_CASE("replay: materials that differ from place to place") {
    LibraryDescription description = *stock::describe("cornell-spheres");
    description.film.width = width;
    description.film.height = height;
    const std::size_t under = description.materials.size() - 1;
    description.add(Mask{under, Texture(Rgb(0.5f))});
    description.add(Sphere{{0, 0, 0.8}, 0.3}, under + 1);
    const AnyScene any = build_any(description);
    const auto& scene = std::get<TexturedScene>(any);
    check_method(scene, PathTracerNee{}, {.seed = 2}, 40);
    check_method(scene, Bdpt{}, {.seed = 2}, 10);
    check_method(scene, Vcm{}, {.seed = 2}, 5);
}

TEST_CASE("replay: the same again, for any number of threads") {
    const AnyScene any = small("cornell-box");
    const auto& scene = std::get<DiffuseScene>(any);
    const auto text = [](const PathReplay& replayed) {
        std::string result;
        for (const PathEvent& event : replayed.events)
            for (const double number : {event.position.x, event.direction.y, double(event.value.z),
                                        double(event.weight), double(event.throughput.x), double(event.path)})
                result += std::to_string(std::bit_cast<std::uint64_t>(number)) + ' ';
        return result;
    };
    for (const auto dependence : {dependence_of<DiffuseScene, Bdpt>, dependence_of<DiffuseScene, PathTracer>})
        CHECK(dependence == Dependence::pixel);
    CHECK(dependence_of<DiffuseScene, Vcm> == Dependence::iteration);
    CHECK(dependence_of<DiffuseScene, Mlt> == Dependence::history);
    const auto check = [&](const auto& method) {
        const std::string once = text(replay(scene, method, {.threads = 1}, 7, 9, 1));
        CHECK_FALSE(once.empty());
        CHECK(text(replay(scene, method, {.threads = 1}, 7, 9, 1)) == once);
        CHECK(text(replay(scene, method, {.threads = 5}, 7, 9, 1)) == once);
    };
    check(Bdpt{});
    check(LightTracer{});
    check(quick(Mlt{}));
}

TEST_CASE("replay: what other pixels splat may be left out") {
    const AnyScene any = small("cornell-spheres");
    const auto& scene = std::get<FullScene>(any);
    int more = 0;
    for (int x = 0; x < width; x += 3) {
        const PathReplay all = replay(scene, Bdpt{}, {}, x, 13, 2), own = replay(scene, Bdpt{}, {}, x, 13, 2, {false});
        check_sums(own);
        CHECK(own.explained);
        CHECK(same_bits(own.sample, all.sample));
        CHECK(luminance(own.splatted) <= luminance(all.splatted));
        more += all.splatted != own.splatted;
        for (const PathEvent& event : own.events) CHECK(event.path == static_cast<std::uint64_t>(13 * width + x));
    }
    CHECK(more > 0);
}

TEST_CASE("replay: events say where paths went, by which density and with which weight") {
    const AnyScene any = small("cornell-box");
    const auto& scene = std::get<DiffuseScene>(any);
    int surfaces = 0, lamps = 0, weights = 0, free = 0, blocked = 0;
    for (int i = 0; i < 150; ++i) {
        const int x = (i * 7) % width, y = (i * 5) % height;
        const PathReplay replayed = replay(scene, PathTracerNee{}, {.seed = 9}, x, y, static_cast<std::uint64_t>(i));
        const auto& events = replayed.events;
        REQUIRE(events.size() >= 2);
        CHECK(events.front().kind == PathEvent::Kind::camera);
        CHECK(events.back().kind == PathEvent::Kind::sample);
        CHECK(glm::length(events.front().from - DVec3(0, 0, 3.9)) < 1e-6);
        CHECK(std::abs(events.front().film.x - x - 0.5) <= 0.5);
        CHECK(std::abs(events.front().film.y - y - 0.5) <= 0.5);
        const PathEvent* at = nullptr;
        double light_sampled_weight = 0;
        for (const PathEvent& event : events) {
            CHECK_FALSE(event.of_light);
            if (event.kind == PathEvent::Kind::surface) {
                ++surfaces;
                CHECK(event.vertex == (at ? at->vertex : 0) + 1);
                CHECK(event.surface == "diffuse");
                lamps += event.light == "TriangleLight";
                CHECK((event.shape >= 1 && event.shape <= 8 && event.primitive >= 1));
                const DVec3 way = glm::normalize(event.position - event.from);
                CHECK(glm::length(way - event.direction) < 1e-4);
                at = &event;
            }
            if (event.kind == PathEvent::Kind::scatter) {
                REQUIRE(at);
                CHECK(event.pdf == relative(std::abs(glm::dot(event.direction, at->normal)) / double(pi), 1e-4));
                CHECK(event.survived == (&event != &events[events.size() - 2]));
                CHECK((event.vertex > 5 || event.survival == 1));
            }
            if (event.kind == PathEvent::Kind::shadow) ++(event.blocked ? blocked : free);
            if (event.kind == PathEvent::Kind::contribution) {
                CHECK(event.camera_vertices == event.vertex + 1);
                CHECK(event.light_vertices == (event.how == Finding::light_sampled ? 1 : 0));
                CHECK((event.weight > 0 && event.weight <= 1));
                light_sampled_weight = event.how == Finding::light_sampled ? double(event.weight) : 0;
                weights += light_sampled_weight > 0 && light_sampled_weight < 1;
            }
        }
        // The output of that name, by the same ray.
        const PathReplay position =
            replay(scene, PathTracer{.max_depth = 1}, {.seed = 9}, x, y, static_cast<std::uint64_t>(i));
        CHECK(position.events[1].position == events[1].position);
    }
    CHECK(surfaces > 300);
    CHECK(lamps > 0);
    CHECK(weights > 50);
    CHECK(free > 50);
    CHECK(blocked > 5);
}

TEST_CASE("replay: bidirectional strategies and their weights") {
    const AnyScene any = small("cornell-box");
    const auto& scene = std::get<DiffuseScene>(any);
    int found[5][3] = {};
    for (int i = 0; i < 60; ++i)
        for (const PathEvent& event :
             replay(scene, Bdpt{.max_depth = 4}, {}, (i * 5) % width, (i * 7) % height, 0, {.others = false}).events) {
            const bool splat = event.kind == PathEvent::Kind::splat;
            if (!splat && event.kind != PathEvent::Kind::contribution) continue;
            CHECK((event.weight > 0 && event.weight < 1 + 1e-6f));
            CHECK(splat == (event.camera_vertices == 1));
            CHECK((event.how == Finding::connected) == (event.light_vertices > 1 && event.camera_vertices > 1));
            CHECK(event.light_vertices + event.camera_vertices <= 5);
            ++found[event.light_vertices][std::min(event.camera_vertices, 3) - 1];
        }
    for (const auto& [s, t] : {std::pair(1, 2), {1, 3}, {2, 1}, {2, 2}, {2, 3}, {3, 1}, {4, 1}}) {
        CAPTURE(s);
        CAPTURE(t);
        CHECK(found[s][t - 1] > 0);
    }
}

TEST_CASE("brightest_sample: the one that a search through all of them finds") {
    const AnyScene any = small("cornell-spheres");
    const auto& scene = std::get<FullScene>(any);
    const auto check = [&](const auto& method, std::uint64_t iterations, const ReplayOptions& options = {}) {
        CAPTURE(method.name);
        const Settings settings{.seed = 8};
        std::uint64_t brightest = 0;
        DVec3 value(-1), sum(0);
        for (std::uint64_t i = 0; i < iterations; ++i) {
            const DVec3 one = replay(scene, method, settings, 11, 12, i, options).value();
            sum += one;
            if (luminance(one) > luminance(value)) {
                value = one;
                brightest = i;
            }
        }
        for (const int threads : {1, 3}) {
            const BrightestSample found =
                brightest_sample(scene, method, {.seed = 8, .threads = threads}, 11, 12, iterations, options);
            CHECK(found.iteration == brightest);
            CHECK(found.value == value);
            CHECK(luminance(found.mean) == relative(luminance(sum) / double(iterations), 1e-12));
            CHECK(found.tried == iterations);
            CHECK(found.non_finite == 0);
            CHECK_FALSE(found.first_non_finite);
            CHECK_FALSE(found.cancelled);
        }
    };
    check(PathTracerNee{}, 200);
    check(PathTracer{}, 65);
    check(Bdpt{}, 5);
    check(Bdpt{}, 130, {.others = false});
    check(PhotonMapping{}, 5);
    check(quick(Mlt{}), 4);
}
