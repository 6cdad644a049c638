// Budgets, observers, stopping and errors.

#include "support/errors.hpp"
#include "support/relative.hpp"
#include "support/renders.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

const DiffuseScene& scene() {
    static const DiffuseScene built = [] {
        LibraryDescription description = stock::describe_furnace();
        description.film.width = description.film.height = 20;
        return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    }();
    return built;
}

/// A method made of a function of (iteration, sampler); calls from several threads.
template <class F>
struct Noise {
    static constexpr std::string_view name = "noise";
    static constexpr Kind kind = Kind::heuristic;
    F value;
    int start(auto&) const { return 0; }
    void iterate(auto& frame, int&) const {
        frame.pixels([&](const Ray&, auto& sampler) { return Rgb(value(frame.iteration(), sampler)); });
    }
};

struct Step {
    std::uint64_t iterations;
    double seconds, fraction, seconds_left, error;
};

struct Run {
    std::vector<Step> steps;
    RenderStatistics statistics;
    Image image;
    double error = 0;
};

template <class F>
Run run(const F& value, const Budget& budget, Settings settings = {}) {
    Run result;
    settings.observer = [&, inner = settings.observer](const Progress& p) {
        result.steps.push_back({p.iterations, p.seconds, p.fraction, p.seconds_left, p.film.relative_error()});
        if (inner) inner(p);
    };
    const Noise<F> method{value};
    Session<DiffuseScene, Noise<F>> session(scene(), method, settings);
    session.run(budget);
    result.statistics = session.statistics();
    result.image = session.image();
    result.error = session.film().relative_error();
    return result;
}

/// What holds for every observer.
void check_progress(const Run& result) {
    REQUIRE(result.steps.size() == result.statistics.iterations);
    double fraction = 0, seconds = 0;
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
        const Step& step = result.steps[i];
        CHECK(step.iterations == i + 1);
        CHECK(step.fraction >= fraction);
        CHECK(step.fraction <= 1);
        CHECK(step.seconds >= seconds);
        CHECK(step.seconds_left >= 0);
        CHECK(std::isfinite(step.seconds_left));
        fraction = step.fraction;
        seconds = step.seconds;
    }
    CHECK(result.statistics.seconds >= seconds);
}

const auto uniform = [](std::uint64_t, auto& sampler) { return sampler.next_1d(); };
const auto rare = [](std::uint64_t, auto& sampler) { return sampler.next_1d() < 1e-3f ? 100.0f : 1.0f; };
const auto slow = [](std::uint64_t, auto& sampler) {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    return sampler.next_1d();
};

}  // namespace

TEST_CASE("a budget of samples is met exactly") {
    for (const int samples : {1, 2, 17}) {
        const Run result = run(uniform, {.samples = samples});
        CHECK(result.statistics.iterations == std::uint64_t(samples));
        CHECK_FALSE(result.statistics.cancelled);
        check_progress(result);
        CHECK(result.steps.back().fraction == 1);
        CHECK(result.steps.back().seconds_left == 0);
        CHECK(result.steps.front().fraction == relative(1.0 / samples, 1e-5));
    }
}

TEST_CASE("without limits 64 samples are made") {
    CHECK(run(uniform, {}).statistics.iterations == 64);
    CHECK(run(uniform, {.samples = 0, .seconds = 0, .error = 0}).statistics.iterations == 64);
}

TEST_CASE("limits that are negative or no number are refused, and nothing is rendered") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Noise<std::remove_cvref_t<decltype(uniform)>> method{uniform};
    Session<DiffuseScene, std::remove_cvref_t<decltype(method)>> session(scene(), method);
    const auto refusal = [&](const Budget& budget) { return message_of([&] { session.run(budget); }); };
    CHECK(refusal({.samples = -5}) == "the budget of samples is -5: give 0 for no limit");
    for (const double bad : {-1.0, -1e-300, nan, -std::numeric_limits<double>::infinity()}) {
        CAPTURE(bad);
        CHECK(refusal({.seconds = bad}).starts_with("the budget of seconds is "));
        CHECK(refusal({.error = bad}).starts_with("the budget of error is "));
        CHECK(refusal({.samples = 4, .seconds = 1, .error = bad}).starts_with("the budget of error is "));
    }
    CHECK(session.film().iterations() == 0);
    CHECK_THROWS_AS(render(scene(), method, {.samples = -1}), Error);
    session.run({.samples = 2, .seconds = std::numeric_limits<double>::infinity()});
    CHECK(session.film().iterations() == 2);
}

TEST_CASE("a budget of seconds ends with the first iteration that exceeds it") {
    for (const double seconds : {1e-9, 0.05}) {
        const Run result = run(slow, {.seconds = seconds});
        check_progress(result);
        CHECK(result.steps.back().seconds >= seconds);
        CHECK(result.steps.back().fraction == 1);
        for (std::size_t i = 0; i + 1 < result.steps.size(); ++i) CHECK(result.steps[i].seconds < seconds);
        if (seconds < 1e-6) CHECK(result.steps.size() == 1);
    }
}

TEST_CASE("seconds count from the call, and are summed over calls") {
    const Noise<std::remove_cvref_t<decltype(slow)>> method{slow};
    Session<DiffuseScene, std::remove_cvref_t<decltype(method)>> session(scene(), method);
    session.run({.seconds = 0.03});
    const auto first = session.statistics();
    session.run({.seconds = 0.03});
    CHECK(first.seconds >= 0.03);
    CHECK(session.statistics().seconds >= first.seconds + 0.03);
    CHECK(session.statistics().iterations > first.iterations);
}

TEST_CASE("a budget of error ends when the error is reached, and not before 16 iterations") {
    // Uniform numbers: one iteration errs by 0.577, so that 0.05 takes about 133.
    const Run result = run(uniform, {.error = 0.05}, {.sampling = Sampling::independent});
    check_progress(result);
    CHECK(result.error <= 0.05);
    CHECK(result.statistics.iterations > 100);
    CHECK(result.statistics.iterations < 170);
    for (std::size_t i = 15; i + 1 < result.steps.size(); ++i) CHECK(result.steps[i].error > 0.05);
    // The forecast is right to a quarter half-way.
    CHECK(result.steps[66].fraction == relative(0.5, 0.25));

    CHECK(run(uniform, {.error = 100}).statistics.iterations == 16);
    // While nothing was found nothing is known.
    const Run black = run([](std::uint64_t, auto&) { return 0.0f; }, {.samples = 40, .error = 100});
    CHECK(black.statistics.iterations == 40);
    CHECK(std::isinf(black.error));
    check_progress(black);
    const Run late =
        run([](std::uint64_t iteration, auto&) { return iteration < 30 ? 0.0f : 1.0f; }, {.samples = 99, .error = 100});
    CHECK(late.statistics.iterations == 31);
    check_progress(late);
    // An error that jumps up when something rare is met must not turn the progress back.
    const Run jumping = run(rare, {.error = 0.25}, {.sampling = Sampling::independent});
    check_progress(jumping);
    bool jumped = false;
    for (std::size_t i = 16; i < jumping.steps.size(); ++i)
        jumped |= jumping.steps[i].error > jumping.steps[i - 1].error;
    CHECK(jumped);
}

TEST_CASE("of several limits the first one counts") {
    CHECK(run(uniform, {.samples = 20, .error = 1e-6}).statistics.iterations == 20);
    CHECK(run(uniform, {.samples = 1000, .error = 1}).statistics.iterations == 16);
    CHECK(run(uniform, {.samples = 5, .seconds = 1000, .error = 10}).statistics.iterations == 5);
    const Run timed = run(slow, {.samples = 1 << 30, .seconds = 0.03, .error = 1e-9});
    CHECK(timed.statistics.iterations < 1000);
    check_progress(timed);
    check_progress(run(uniform, {.samples = 40, .error = 0.02}));
}

TEST_CASE("a budget of samples that is spent already makes no iteration") {
    const Noise<std::remove_cvref_t<decltype(uniform)>> method{uniform};
    Session<DiffuseScene, std::remove_cvref_t<decltype(method)>> session(scene(), method);
    session.run({.samples = 8});
    session.run({.samples = 8});
    session.run({.samples = 3});
    CHECK(session.film().iterations() == 8);
}

TEST_CASE("a stop before the start gives a black image") {
    std::stop_source source;
    source.request_stop();
    const Run result = run(uniform, {.samples = 4}, {.stop = source.get_token()});
    CHECK(result.statistics.iterations == 0);
    CHECK(result.statistics.cancelled);
    CHECK(result.steps.empty());
    CHECK(result.image.mean() == DVec3(0));
    CHECK(result.image.width() == 20);
}

TEST_CASE("a stop in the middle of an iteration keeps the whole iterations before it") {
    for (const int threads : {1, 2}) {
        std::stop_source source;
        std::atomic<int> calls = 0;
        const auto stopping = [&](std::uint64_t, auto& sampler) {
            if (++calls == 5 * 400 + 100) source.request_stop();  // in the sixth iteration
            return sampler.next_1d();
        };
        const Run result = run(stopping, {.samples = 100}, {.threads = threads, .stop = source.get_token()});
        CHECK(result.statistics.cancelled);
        CHECK(result.statistics.iterations == 5);
        CHECK(calls < 6 * 400);
        check_progress(result);
        CHECK(identical(result.image, run(uniform, {.samples = 5}).image));
        CHECK(result.image.metadata.at("samples") == "5");
    }
}

TEST_CASE("an observer may stop the render") {
    std::stop_source source;
    Settings settings{.stop = source.get_token()};
    settings.observer = [&](const Progress& p) {
        if (p.iterations == 3) source.request_stop();
    };
    const Run result = run(uniform, {.samples = 100}, settings);
    CHECK(result.statistics.iterations == 3);
    CHECK(result.statistics.cancelled);
    CHECK(identical(result.image, run(uniform, {.samples = 3}).image));
}

TEST_CASE("an exception in a method reaches the caller, and the render can go on") {
    for (const int threads : {1, 2}) {
        std::atomic<bool> armed = true;
        const auto throwing = [&](std::uint64_t iteration, auto& sampler) {
            const float u = sampler.next_1d();
            if (iteration == 2 && u > 0.9f && armed.exchange(false)) throw Error("the lens is broken");
            return u;
        };
        const Noise<std::remove_cvref_t<decltype(throwing)>> method{throwing};
        Session<DiffuseScene, std::remove_cvref_t<decltype(method)>> session(scene(), method, {.threads = threads});
        CHECK_THROWS_WITH_AS(session.run({.samples = 5}), "the lens is broken", Error);
        CHECK(session.film().iterations() == 2);
        session.run({.samples = 5});
        CHECK(session.film().iterations() == 5);
        CHECK(identical(session.film().image(), run(uniform, {.samples = 5}).image));
    }
}
