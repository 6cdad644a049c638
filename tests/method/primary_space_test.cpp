// The random walk of Markov chains through random numbers, and what tells where they are of use.

#include "support/chi_square.hpp"
#include "support/relative.hpp"
#include "support/statistics.hpp"

#include <lightswitch/method/brightness_guide.hpp>
#include <lightswitch/method/coverage.hpp>
#include <lightswitch/method/primary_space.hpp>

#include <doctest/doctest.h>

#include <bit>

using namespace lightswitch;
using namespace lightswitch::test;

// Statistical tests here compare p-values with 1e-6 or means at 5 standard errors (6e-7): some 60 of them give a false
// alarm with a probability of 6e-5 in all.

namespace {

/// The first `n` numbers of a stream.
std::vector<float> read(PrimarySample& sample, std::size_t stream, std::size_t n) {
    PrimarySample::Reader reader(sample, stream);
    std::vector<float> result;
    while (result.size() < n) result.push_back(reader.next_1d());
    return result;
}

/// The distance from `a` to `b` around the end of [0, 1), signed.
double moved(float a, float b) {
    const double d = double(b) - double(a);
    return d - std::round(d);
}

double uniform_p(const std::vector<float>& values, int cells) {
    std::vector<double> observed(static_cast<std::size_t>(cells));
    for (const float v : values) ++observed[static_cast<std::size_t>(v * static_cast<float>(cells))];
    return chi_square(observed, std::vector<double>(observed.size(), double(values.size()) / cells)).p_value;
}

/// Mean squares of the steps of numbers that are read again after `steps` accepted small steps.
Mean spread_after(int steps) {
    Mean result;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        PrimarySample sample(seed);
        const float before = read(sample, 1, 1)[0];
        for (int i = 0; i < steps; ++i) {
            sample.propose();
            read(sample, 0, 1);  // others move all the while
        }
        const double d = moved(before, read(sample, 1, 1)[0]);
        result.add(d * d);
    }
    return result;
}

}  // namespace

TEST_CASE("primary samples: a fresh one is uniform, and a function of its seed") {
    std::vector<float> values;
    UniformCorrelation neighbours, streams;
    for (std::uint64_t seed = 0; seed < 5000; ++seed) {
        PrimarySample sample(seed), again(seed);
        for (std::size_t stream = 0; stream < PrimarySample::streams; ++stream) {
            const auto numbers = read(sample, stream, 4);
            CHECK(numbers == read(again, stream, 4));
            CHECK(numbers == read(sample, stream, 4));  // reading moves nothing
            values.insert(values.end(), numbers.begin(), numbers.end());
            neighbours.add(double(numbers[0]), double(numbers[1]));
        }
        streams.add(double(read(sample, 0, 1)[0]), double(read(sample, 1, 1)[0]));
    }
    CHECK(uniform_p(values, 100) > 1e-6);
    CHECK(std::abs(neighbours.sigmas()) < 5);
    CHECK(std::abs(streams.sigmas()) < 5);
}

TEST_CASE("primary samples: a number is below 1 where the double that it is made of rounds to 1") {
    for (const std::uint64_t seed : {41744883u, 42938481u, 54323990u}) {
        PrimarySample sample(seed);
        CHECK(read(sample, 0, 1)[0] == 1 - 0x1p-24f);
    }
}

TEST_CASE("primary samples: small steps stay within [0, 1) and leave the uniform distribution uniform") {
    std::vector<float> once, often;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        PrimarySample sample(seed);
        read(sample, 0, 2);
        for (int step = 1; step <= 40; ++step) {
            sample.propose();
            const auto numbers = read(sample, 0, 2);
            for (const float v : numbers) REQUIRE((v >= 0 && v < 1));
            if (step == 1 || step == 40) {
                auto& values = step == 1 ? once : often;
                values.insert(values.end(), numbers.begin(), numbers.end());
            }
        }
    }
    CHECK(uniform_p(once, 200) > 1e-6);
    CHECK(uniform_p(often, 200) > 1e-6);
}

TEST_CASE("primary samples: small steps go up as often as down, far as often as near in logarithms") {
    constexpr double shortest = 1.0 / 1024, longest = 1.0 / 64;
    constexpr std::size_t cells = 32;
    std::vector<double> up(cells), down(cells);
    Mean direction;
    for (std::uint64_t seed = 0; seed < 100000; ++seed) {
        PrimarySample sample(seed);
        const float before = read(sample, 0, 1)[0];
        sample.propose();
        const double d = moved(before, read(sample, 0, 1)[0]);
        REQUIRE(std::abs(d) > shortest - 1e-6);
        REQUIRE(std::abs(d) < longest + 1e-6);
        const double along = std::log(std::abs(d) / shortest) / std::log(longest / shortest);
        ++(d > 0 ? up : down)[static_cast<std::size_t>(std::clamp(along, 0.0, 0.9999) * cells)];
        direction.add(d > 0 ? 1 : -1);
    }
    CHECK(std::abs(direction.sigmas(0)) < 5);
    // Two histograms of equal size have the same density; together they are the log-uniform one.
    double statistic = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        const double difference = up[i] - down[i];
        statistic += difference * difference / (up[i] + down[i]);
    }
    CHECK(gamma_q(0.5 * cells, 0.5 * statistic) > 1e-6);
    for (std::size_t i = 0; i < cells; ++i) up[i] += down[i];
    CHECK(chi_square(up, std::vector<double>(cells, 100000.0 / cells)).p_value > 1e-6);
}

TEST_CASE("primary samples: what is rejected leaves no trace but in the numbers that were never used before") {
    Random choice(3);
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        PrimarySample sample(seed);
        std::array<std::vector<float>, PrimarySample::streams> state;
        for (std::size_t s = 0; s < state.size(); ++s) state[s] = read(sample, s, 2 + s);
        for (int step = 0; step < 40; ++step) {
            sample.propose();
            std::array<std::vector<float>, PrimarySample::streams> proposed;
            for (std::size_t s = 0; s < state.size(); ++s)
                proposed[s] = read(sample, s, state[s].size() + (choice.next() < 0.3f ? 1 : 0));
            if (choice.next() < 0.5f) {
                state = proposed;
            } else {
                sample.reject();
                // The state is what a step of no length from here reads: numbers that were read at the state's own step
                // come back from a copy without being moved.
                PrimarySample copy = sample;
                for (std::size_t s = 0; s < state.size(); ++s) {
                    const auto now = read(copy, s, state[s].size());
                    for (std::size_t i = 0; i < now.size(); ++i)
                        CHECK(std::bit_cast<std::uint32_t>(now[i]) == std::bit_cast<std::uint32_t>(state[s][i]));
                }
            }
        }
    }
}

TEST_CASE("primary samples: numbers first used in a rejected step are fresh when they are used again") {
    UniformCorrelation related;
    std::vector<float> values;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        PrimarySample sample(seed);
        read(sample, 1, 1);
        sample.propose();
        const float rejected = read(sample, 1, 2)[1];
        sample.reject();
        sample.propose();
        const float taken = read(sample, 1, 2)[1];
        values.push_back(taken);
        related.add(double(rejected), double(taken));
    }
    CHECK(std::abs(related.sigmas()) < 5);
    CHECK(uniform_p(values, 100) > 1e-6);
}

TEST_CASE("primary samples: a number that is not read for n steps moves as far as n steps do") {
    const Mean one = spread_after(1);
    // E d^2 for a log-uniform distance from 1/1024 to 1/64.
    const double expected = (1.0 / 4096 - 1.0 / 1048576) / (2 * std::log(16.0));
    CHECK(std::abs(one.sigmas(expected)) < 5);
    for (const int steps : {2, 5, 20}) CHECK_MESSAGE(std::abs(spread_after(steps).sigmas(steps * expected)) < 5, steps);
}

TEST_CASE("primary samples: rejected steps do not count as time") {
    Mean spread;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        PrimarySample sample(seed);
        const float before = read(sample, 1, 1)[0];
        for (int i = 0; i < 10; ++i) {
            sample.propose();
            read(sample, 1, 1);
            sample.reject();
        }
        sample.propose();
        const double d = moved(before, read(sample, 1, 1)[0]);
        spread.add(d * d);
    }
    CHECK(std::abs(spread.sigmas((1.0 / 4096 - 1.0 / 1048576) / (2 * std::log(16.0)))) < 5);
}

TEST_CASE("primary samples: begin where they are told to, and go on from there") {
    PrimarySample sample(7);
    sample.begin_at(1, {0.25f, 0.5f});
    sample.begin_at(1, {0.75f, 0.125f});
    PrimarySample::Reader reader(sample, 1);
    CHECK(reader.next_2d() == Vec2(0.25f, 0.5f));
    reader.skip();
    CHECK(reader.next_1d() != 0.75f);  // the third pair is a fresh one
    PrimarySample::Reader again(sample, 1);
    again.skip();
    CHECK(again.next_1d() == 0.75f);
    sample.propose();
    PrimarySample::Reader moving(sample, 1);
    const Vec2 to = moving.next_2d();
    for (const double d : {moved(0.25f, to.x), moved(0.5f, to.y)}) CHECK((std::abs(d) > 0 && std::abs(d) < 1.0 / 63));
    sample.reject();
    PrimarySample::Reader back(sample, 1);
    CHECK(back.next_2d() == Vec2(0.25f, 0.5f));
}

// A walk of the kind that light transport makes: in half of the square the second number is not used, so that it is
// read after pauses of any length. Cells of one histogram depend on each other along a chain; independent chains do
// not.
TEST_CASE("primary samples: a Metropolis walk follows its density") {
    constexpr int cells = 8, chains = 4000, steps = 1000;
    // Over the square; constant in y for x < 1/2.
    const auto density = [](double x, double y) { return x < 0.5 ? 0.4 + x : 0.1 + 2 * x * y * y; };
    std::vector<double> expected;
    double total = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            expected.push_back(integrate(density, {i / double(cells), j / double(cells)},
                                         {(i + 1) / double(cells), (j + 1) / double(cells)}, 1e-10));
            total += expected.back();
        }
    std::vector<Mean> visits(expected.size());
    for (std::uint64_t chain = 0; chain < chains; ++chain) {
        PrimarySample sample(chain + 1000);
        // The start follows the density: found by rejection from seeds.
        Random random(static_cast<std::uint32_t>(chain));
        const auto evaluate = [&](DVec2& at) {
            PrimarySample::Reader reader(sample, 1);
            at.x = double(reader.next_1d());
            if (at.x >= 0.5) at.y = double(reader.next_1d());
            return density(at.x, at.y);
        };
        DVec2 at(0);
        double value = evaluate(at);
        for (std::uint64_t seed = chain + 1001; double(random.next()) * 2.1 > value; seed += chains) {
            sample = PrimarySample(seed);
            value = evaluate(at);
        }
        std::vector<double> counts(expected.size());
        for (int i = 0; i < steps; ++i) {
            sample.propose();
            DVec2 to(0);
            const double proposed = evaluate(to);
            if (sample.random().next() < proposed / value) {
                at = to;
                value = proposed;
            } else {
                sample.reject();
            }
            if (at.x < 0.5) {  // y is not known here
                for (int j = 0; j < cells; ++j)
                    counts[static_cast<std::size_t>(int(at.x * cells) * cells + j)] += 1.0 / cells;
            } else {
                ++counts[static_cast<std::size_t>(int(at.x * cells) * cells + int(at.y * cells))];
            }
        }
        for (std::size_t i = 0; i < counts.size(); ++i) visits[i].add(counts[i] / steps);
    }
    for (std::size_t i = 0; i < visits.size(); ++i)
        CHECK_MESSAGE(std::abs(visits[i].sigmas(expected[i] / total)) < 5.5, "cell ", i, ": ", visits[i].value(),
                      " against ", expected[i] / total);
}

TEST_CASE("coverage: the share of light that does not rest on few paths in its part") {
    Coverage coverage;
    CHECK(coverage.covered() == 1);
    CHECK(coverage.paths_left() == 0);
    for (int i = 0; i < 900; ++i) coverage.add({0.1f, 0.1f}, 2, 1, 0);
    CHECK(coverage.covered() == 1);
    // Of 2: 15 paths are too few, and the next one is enough.
    for (int i = 0; i < 15; ++i) coverage.add({0.6f, 0.1f}, 3, 4, 2);
    CHECK(coverage.light == 960);
    CHECK(coverage.left == 30);
    CHECK(coverage.paths_left() == relative(15, 1e-12));
    CHECK(coverage.covered() == relative(1 - 30.0 / 960, 1e-12));
    Coverage other;
    other.add({0.7f, 0.2f}, 3, 4, 2);
    coverage += other;
    CHECK(coverage.covered() == 1);
    // Elsewhere, of another length, or beyond the film: other parts. Lengths from 5 on are one.
    for (const auto& [place, length] :
         {std::pair(Vec2(0.8f, 0.1f), 3), {Vec2(0.6f, 0.1f), 4}, {Vec2(0.6f, 0.3f), 3}, {Vec2(7, -7), 5}}) {
        Coverage more = coverage;
        more.add(place, length, 4, 2);
        CHECK(more.covered() == relative(1 - 2 / 968.0, 1e-12));
    }
    for (int length = 5; length < 21; ++length) coverage.add({0.9f, 0.9f}, length, 4, 2);
    CHECK(coverage.covered() == 1);
    // One that outshines all others makes them few.
    coverage.add({0.6f, 0.1f}, 3, 1000, 1000);
    CHECK(coverage.covered() < 0.6);
}

namespace {

struct Bright {
    Vec2 pixel{0};
    double target = 0;
};

}  // namespace

TEST_CASE("brightness guide: even until it learns, from nothing, and from darkness") {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 5}, std::pair{16, 16}, std::pair{100, 33}}) {
        BrightnessGuide guide(width, height);
        for (const auto& samples : {std::vector<Bright>{}, std::vector<Bright>(100)}) {
            guide.learn(samples);
            for (const Vec2 at : {Vec2(0), Vec2(float(width), float(height)), Vec2(-4, 900)}) CHECK(guide(at) == 1);
        }
    }
}

TEST_CASE("brightness guide: positive everywhere, around 1, and brighter where the image is") {
    for (const auto& film : {std::pair{7, 5}, std::pair{16, 16}, std::pair{17, 16}, std::pair{160, 90}}) {
        const int width = film.first, height = film.second;
        CAPTURE(width);
        const Vec2 size(width, height);
        BrightnessGuide guide(width, height);
        std::vector<Bright> samples;
        Random random(5);
        // Dark at the left, black at the very left, also on a margin of 2 pixels; one outshines all.
        for (int i = 0; i < 50000; ++i) {
            const Vec2 at = random.next_2d() * (size + 4.0f) - 2.0f;
            const double along = double(at.x) / width;
            samples.push_back({at, along < 0.25 ? 0.0 : 1e-3 * along * along});
        }
        samples.front().target = 1e-2;
        guide.learn(samples);
        Mean mean;
        for (int y = -3; y < height + 3; ++y)
            for (int x = -3; x < width + 3; ++x) {
                const float at = guide(Vec2(float(x) + 0.5f, float(y) + 0.5f));
                CHECK(at >= 0.1f);
                CHECK(at < 50);
                if (x >= 0 && y >= 0 && x < width && y < height) mean.add(double(at));
            }
        CHECK(mean.value() > 0.8);
        CHECK(mean.value() < 1.3);
        if (width > 48) CHECK(guide(size - 1.0f) > 5 * guide(Vec2(1)));
        else if (width <= 16) CHECK(guide(size - 1.0f) == guide(Vec2(0)));
        // Beyond the film as at its edge.
        CHECK(guide(Vec2(-100)) == guide(Vec2(0)));
        CHECK(guide(size + 100.0f) == guide(size - 0.5f));
    }
}
