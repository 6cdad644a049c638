#include <lightswitch/core/table.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <numeric>
#include <vector>

using namespace lightswitch;
using test::relative;

namespace {

constexpr float largest_u = 1 - 0x1p-24f;

// Four chi-square tests, together a false alarm of 1e-6; the seeds are fixed.
const double level = test::sidak(1e-6, 4);

double frequencies_p_value(const std::vector<double>& weights, int samples, std::uint32_t seed) {
    const DiscreteDistribution table(weights);
    std::vector<double> observed(weights.size()), expected(weights.size());
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) expected[i] = samples * weights[i] / total;
    test::Random random(seed);
    for (int i = 0; i < samples; ++i) ++observed[table.sample(random.next())];
    return test::chi_square(observed, expected).p_value;
}

/// How often each index is chosen among all 2^24 numbers that a sampler can give: exact, since the map is monotone.
std::vector<std::uint32_t> exact_counts(const DiscreteDistribution& table) {
    std::vector<std::uint32_t> counts(table.size());
    for (std::uint32_t u = 0; u < 1u << 24; ++u) ++counts[table.sample(static_cast<float>(u) * 0x1p-24f)];
    return counts;
}

}  // namespace

TEST_CASE("discrete distribution: indices are as frequent as their weights") {
    CHECK(frequencies_p_value({1, 2, 3, 4}, 100000, 1) > level);
    CHECK(frequencies_p_value({0, 5, 0, 0, 1, 0.25, 0}, 100000, 2) > level);
    CHECK(frequencies_p_value({1e30, 2e30, 3e30}, 100000, 3) > level);
    std::vector<double> many(1000);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i * i % 97) + (i == 500 ? 3000.0 : 0.0);
    CHECK(frequencies_p_value(many, 1000000, 4) > level);
}

TEST_CASE("discrete distribution: the probability that is stated is that with which an index is chosen") {
    // Otherwise what is divided by it would be biased, however many samples are taken.
    std::vector<std::vector<double>> cases{{1},        {1, 2, 3},  {0, 1, 0},
                                           {1e-30, 1}, {1, 1e-30}, {1e30, 1e-30, 1, 0, 1e30}};
    cases.emplace_back(100000, 1.0);
    cases.emplace_back(1000000);
    for (std::size_t i = 0; i < cases.back().size(); ++i) cases.back()[i] = static_cast<double>(i % 7);
    for (const auto& weights : cases) {
        const DiscreteDistribution table(weights);
        const auto counts = exact_counts(table);
        double worst = 0, sum = 0;
        int never = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double chosen = counts[i] * 0x1p-24, stated = double(table.probability(i));
            worst = std::max(worst, std::abs(chosen - stated));
            never += weights[i] > 0 && counts[i] == 0;
            never += weights[i] == 0 && (counts[i] != 0 || stated != 0);
            sum += stated;
        }
        CAPTURE(weights.size());
        CHECK(worst == 0);
        CHECK(never == 0);
        CHECK(sum == 1);
    }
}

TEST_CASE("discrete distribution: choices are monotone, and the ends of [0, 1) are safe") {
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{7}, std::size_t{100000}}) {
        for (const double end : {0.0, 1.0, 1e-30}) {
            std::vector<double> weights(n, 1.0);
            if (n > 2) weights.front() = weights.back() = end;
            const DiscreteDistribution table(weights);
            CHECK(table.size() == n);
            CHECK(weights[table.sample(0)] > 0);
            CHECK(weights[table.sample(largest_u)] > 0);
            std::size_t previous = 0;
            bool monotone = true, positive = true;
            for (int i = 0; i < 1 << 16; ++i) {
                const std::size_t index = table.sample(static_cast<float>(i) * 0x1p-16f);
                monotone = monotone && index >= previous;
                positive = positive && weights[index] > 0;
                previous = index;
            }
            CHECK(monotone);
            CHECK(positive);
        }
    }
}

TEST_CASE("discrete distribution: even 1 and more, which no sampler gives, choose an index that can be chosen") {
    for (const auto& weights : std::vector<std::vector<double>>{
             {1}, {1, 2, 3}, {1, 0}, {0, 1, 0, 0}, {1, 1e-30}, {1e30, 1e-30, 0}, std::vector<double>(100000, 1.0)}) {
        const DiscreteDistribution table(weights);
        std::size_t last = weights.size() - 1;
        while (weights[last] == 0) --last;
        CAPTURE(weights.size());
        CHECK(table.sample(largest_u) <= last);
        for (const float u : {1.0f, 1.5f, 1e9f}) CHECK(table.sample(u) == last);
    }
}

TEST_CASE("discrete distribution: weights of very different sizes") {
    const DiscreteDistribution table(std::vector<double>{1e-30, 1, 1e-30, 3, 1e-300});
    CHECK(table.probability(1) == relative(0.25, 1e-6));
    CHECK(table.probability(3) == relative(0.75, 1e-6));
    CHECK(table.probability(4) == 0x1p-24f);
    CHECK(table.sample(0) == 0);
    CHECK(table.sample(0.2f) == 1);
    CHECK(table.sample(0.3f) == 3);
    CHECK(table.sample(largest_u) == 4);
    const DiscreteDistribution tiny(std::vector<double>{1e-30, 3e-30});
    CHECK(tiny.probability(1) == relative(0.75, 1e-5));
    const DiscreteDistribution huge(std::vector<double>{1e30, 3e30});
    CHECK(huge.probability(1) == relative(0.75, 1e-5));
}

TEST_CASE("discrete distribution: impossible weights are refused") {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{0, 0}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{1, -1e-300}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{1, infinite}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{1e308, 1e308}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>((1u << 24) + 1, 1.0)), Error);
    CHECK(DiscreteDistribution().empty());
}

TEST_CASE("discrete distribution: the cost does not grow with the number of weights") {
    // Steps of the search cannot be counted from outside; time is compared with a linear search's, which would be
    // thousands of times slower at this size. Weights that fall like 1 / i^2 crowd nearly all indices into the last
    // buckets.
    std::vector<double> weights(100000);
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 1 / (1 + double(i) * double(i));
    const DiscreteDistribution table(weights);
    test::Random random(5);
    const auto start = std::chrono::steady_clock::now();
    std::size_t sum = 0;
    for (int i = 0; i < 1000000; ++i) sum += table.sample(random.next());
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 2);
    CHECK(sum > 0);
}
