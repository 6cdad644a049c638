// Making samples again, of methods that a user could have written.

#include <lightswitch/render/replay.hpp>

#include "support/errors.hpp"
#include "support/light_tracer.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

#include <atomic>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

const LibraryDescription& description() {
    static const LibraryDescription result = small_box(20, 17);
    return result;
}
const DiffuseScene& scene() {
    static const DiffuseScene result = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description());
    return result;
}

/// Ambient occlusion that tells nothing.
struct Occlusion {
    static constexpr std::string_view name = "ao";
    static constexpr Kind kind = Kind::heuristic;

    Rgb radiance(const auto& s, const Ray& ray, auto& sampler) const {
        const auto hit = s.intersect(ray);
        if (!hit) return Rgb(0);
        const Vec3 direction = hit->shading_frame().to_world(cosine_hemisphere(sampler.next_2d()));
        return Rgb(s.occluded(hit->spawn(direction, s.length(0.5))) ? 0.25f : 1.0f);
    }
};

/// `f(sampler)` in every pixel.
template <class F>
struct Noise {
    static constexpr std::string_view name = "noise";
    static constexpr Kind kind = Kind::unbiased;

    F f;

    Rgb radiance(const auto& s, const Ray&, auto& sampler) const {
        const Rgb value = f(sampler);
        if (tells) tell(s, Contributed{.value = value});
        return value;
    }
    bool tells = false;
};
template <class F>
Noise(F, bool = false) -> Noise<F>;

/// What a pixel gets depends on the pixel before it and on all iterations before, and splats come from everywhere.
struct Remembering {
    static constexpr std::string_view name = "remembering";
    static constexpr Kind kind = Kind::heuristic;

    struct State {
        std::vector<float> sums;
    };
    State start(auto& frame) const {
        State state{std::vector<float>(frame.area())};
        frame.paths(frame.area(), [&](std::uint64_t i, auto& sampler, auto&) { state.sums[i] = sampler.next_1d(); });
        return state;
    }
    void iterate(auto& frame, State& state) const {
        std::vector<float> next(frame.area());
        frame.pixels([&](const Ray&, auto& sampler, const PixelContext& pixel) {
            next[pixel.index] = state.sums[(pixel.index + 1) % next.size()] + sampler.next_1d();
            pixel.splatter.splat({sampler.next_1d() * 20, sampler.next_1d() * 17}, Rgb(0.1f));
            return Rgb(0.3f);
        });
        frame.pixels([&](const Ray&, auto&, const PixelContext& pixel) {
            return Rgb(next[pixel.index] * (next[pixel.index / 2] + 0.1f));
        });
        state.sums = next;
    }
};

/// Splats of so different sizes that their sum depends on their order, even in double precision.
struct WideRange {
    static constexpr std::string_view name = "wide";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr Dependence dependence = Dependence::pixel;

    struct State {};
    State start(auto&) const { return {}; }
    void iterate(auto& frame, State&) const {
        const auto splat = [](auto& sampler, auto& splatter) {
            const float u = sampler.next_1d();
            splatter.splat({sampler.next_1d() * 20, sampler.next_1d() * 17}, Rgb(std::exp2(100 * u - 50)));
        };
        frame.pixels([&](const Ray&, auto& sampler, const PixelContext& pixel) {
            for (int i = 0; i < 8; ++i) splat(sampler, pixel.splatter);
            return Rgb(1);
        });
        frame.paths(3000, [&](std::uint64_t, auto& sampler, auto& splatter) { splat(sampler, splatter); });
    }
};

template <class M>
std::size_t check_values(const M& method, int iterations) {
    Session<DiffuseScene, M> session(scene(), method, {.seed = 4});
    std::vector<Image> means;
    for (int n = 1; n <= iterations; ++n) {
        session.run({.samples = n});
        means.push_back(session.film().image());
    }
    std::size_t events = 0;
    for (int pixel = 0; pixel < 20 * 17; pixel += 37) {
        PixelSums sums;
        PixelSums::Windows windows;
        for (int n = 0; n < iterations; ++n) {
            const PathReplay replayed =
                replay(scene(), method, {.seed = 4}, pixel % 20, pixel / 20, static_cast<std::uint64_t>(n));
            sums.add(windows, replayed.value());
            events += replayed.events.size();
            const DVec3 sum = sums.values(windows);
            CHECK(Rgb(sum / double(n + 1)) == means[static_cast<std::size_t>(n)].pixels()[std::size_t(pixel)]);
        }
    }
    return events;
}

}  // namespace

TEST_CASE("replay: a method that tells nothing has its values and its rays told") {
    CHECK(check_values(Occlusion{}, 3) > 0);
    const PathReplay replayed = replay(scene(), Occlusion{}, {}, 10, 16, 0);
    REQUIRE(replayed.events.size() == 4);
    CHECK(replayed.events[0].kind == PathEvent::Kind::camera);
    CHECK(replayed.events[1].kind == PathEvent::Kind::surface);
    CHECK(replayed.events[1].surface == "diffuse");
    CHECK(replayed.events[2].kind == PathEvent::Kind::shadow);
    CHECK(replayed.events[3].kind == PathEvent::Kind::sample);
    CHECK(replayed.sample == replayed.events[3].value);
    CHECK_FALSE(replayed.explained);
    // A segment that is free has its length; one that is not ends at what is in between.
    const PathEvent& shadow = replayed.events[2];
    const double length = glm::length(shadow.position - shadow.from);
    if (shadow.blocked) CHECK(length < 0.5 + 1e-6);
    else CHECK(std::abs(length - 0.5) < 1e-6);
    CHECK(check_values(light_tracer_for(description(), scene()), 2) > 0);
}

TEST_CASE("replay: a method of which nothing is known is made again from its first iteration on") {
    CHECK(dependence_of<DiffuseScene, Remembering> == Dependence::history);
    CHECK(check_values(Remembering{}, 4) > 0);
}

TEST_CASE("replay: splats are added in the order of the film, with all bits of its sums") {
    // The film's estimate of its error knows every bit of every pixel's sums.
    const WideRange method;
    constexpr int n = 2;
    Session session(scene(), method, {.seed = 5});
    session.run({.samples = n});
    DVec3 mean(0), variance(0);
    for (int pixel = 0; pixel < 20 * 17; ++pixel) {
        PixelSums sums;
        PixelSums::Windows windows;
        for (std::uint64_t i = 0; i < n; ++i)
            sums.add(windows, replay(scene(), method, {.seed = 5}, pixel % 20, pixel / 20, i).value());
        const DVec3 sum = sums.values(windows), squares = sums.squares(windows);
        mean += sum / double(n);
        variance += glm::max(squares - sum * sum / double(n), DVec3(0)) / (double(n) * (n - 1));
    }
    const double channels = 3 * 20 * 17;
    const double level = (mean.x + mean.y + mean.z) / channels;
    CHECK(std::sqrt((variance.x + variance.y + variance.z) / channels) / level == session.film().relative_error());
}

TEST_CASE("replay: a method of a user may tell its contributions") {
    const Noise method{[](auto& sampler) { return Rgb(sampler.next_1d()); }, true};
    const PathReplay replayed = replay(scene(), method, {}, 3, 4, 5);
    CHECK(replayed.explained);
    CHECK(replayed.events.size() == 2);
    CHECK_FALSE(replay(scene(), Noise{method.f, false}, {}, 3, 4, 5).explained);
}

TEST_CASE("brightest_sample: finds a planted outlier and the value that is not finite") {
    // One of 4000 numbers is large, and one of 8000 is none.
    const auto planted = [](auto& sampler) {
        const float u = sampler.next_1d(), v = sampler.next_1d();
        if (u < 1 / 8000.0f) return Rgb(std::numeric_limits<float>::quiet_NaN());
        return Rgb(v < 1 / 4000.0f ? 1000 + v : v);
    };
    const Noise method{planted};
    constexpr std::uint64_t iterations = 100'000;  // without any of a kind with probability exp(-12)
    const Settings settings{.seed = 1, .sampling = Sampling::independent};
    const BrightestSample found = brightest_sample(scene(), method, settings, 12, 9, iterations);
    CHECK(found.tried == iterations);
    CHECK(found.value.x > 1000);
    CHECK(found.mean.x < 2);
    REQUIRE(found.first_non_finite);
    CHECK(found.non_finite >= 1);
    CHECK(found.non_finite < 40);
    CHECK(replay(scene(), method, settings, 12, 9, found.iteration).value() == found.value);
    const PathReplay broken = replay(scene(), method, settings, 12, 9, *found.first_non_finite);
    CHECK(broken.value() == DVec3(0));
    CHECK(broken.dropped == 1);
    REQUIRE(!broken.events.empty());
    CHECK(std::isnan(broken.events.back().value.x));
    CHECK_FALSE(broken.events.back().here);
    // None before the first: the search ends just there.
    CHECK(brightest_sample(scene(), method, settings, 12, 9, *found.first_non_finite).non_finite == 0);
    CHECK(brightest_sample(scene(), method, settings, 12, 9, found.iteration).value.x < found.value.x);
}

TEST_CASE("replay: what a render notes as not finite is met again") {
    const auto planted = [](auto& sampler) { return Rgb(sampler.next_1d() < 0.002f ? infinity : 0.5f); };
    const Noise method{planted};
    Session session(scene(), method, {.seed = 6});
    session.run({.samples = 4});
    const auto& noted = session.statistics().counts.first_non_finite;
    REQUIRE(!noted.empty());
    for (const NonFinite& place : noted) {
        const int pixel = static_cast<int>(place.pixel);
        const PathReplay replayed =
            replay(scene(), method, {.seed = place.seed}, pixel % 20, pixel / 20, place.iteration);
        CHECK(replayed.dropped == 1);
        CHECK(std::isinf(replayed.events.back().value.x));
    }
}

TEST_CASE("replay: a stop ends the search, and what was tried counts") {
    std::stop_source source;
    std::atomic<int> calls = 0;
    const Noise method{[&](auto& sampler) {
        if (++calls == 5000) source.request_stop();
        return Rgb(sampler.next_1d());
    }};
    const BrightestSample found =
        brightest_sample(scene(), method, {.stop = source.get_token()}, 1, 2, std::uint64_t{1} << 40);
    CHECK(found.cancelled);
    CHECK(found.tried > 4000);
    CHECK(found.tried < 5000);
    CHECK(found.value.x > 0.9);
    CHECK(replay(scene(), Bdpt{}, {.stop = source.get_token()}, 1, 2, 0).cancelled);
    const BrightestSample none = brightest_sample(scene(), Bdpt{}, {.stop = source.get_token()}, 1, 2, 10);
    CHECK(none.cancelled);
    CHECK(none.tried == 0);
}

TEST_CASE("replay: a pixel that is none is an error that names it") {
    const std::string refusal = "pixel (20, 3) is outside of the image of 20 x 17 pixels";
    CHECK(message_of([] { replay(scene(), PathTracerNee{}, {}, 20, 3, 0); }) == refusal);
    CHECK(message_of([] { brightest_sample(scene(), PathTracerNee{}, {}, 20, 3, 4); }) == refusal);
    for (const auto& [x, y] : {std::pair(-1, 0), {0, -1}, {0, 17}})
        CHECK_THROWS_AS(replay(scene(), PathTracerNee{}, {}, x, y, 0), Error);
    CHECK(brightest_sample(scene(), PathTracerNee{}, {}, 1, 3, 0).tried == 0);
}
