#include <lightswitch/mpi/shares.hpp>

#include <doctest/doctest.h>

#include <numeric>
#include <random>

using lightswitch::detail::shares;
using Counts = std::vector<std::uint64_t>;

namespace {

std::uint64_t sum(const Counts& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

}  // namespace

TEST_CASE("as long as no rate is known everyone makes one, as far as there are any") {
    const std::vector<double> unknown{0, 0, 5, 0};
    CHECK(shares(unknown, 1, 1000, false) == Counts{1, 1, 1, 1});
    CHECK(shares(unknown, 1, 3, false) == Counts{1, 1, 1, 0});
    CHECK(shares(unknown, 1, 1, false) == Counts{1, 0, 0, 0});
}

TEST_CASE("shares are in proportion to the rates, and nobody goes without unless time is short") {
    const std::vector<double> rates{100, 50, 0.1};
    CHECK(shares(rates, 2, 1000000, false) == Counts{200, 100, 1});
    CHECK(shares(rates, 2, 1000000, true) == Counts{200, 100, 0});
    CHECK(shares(rates, 0, 1000000, true) == Counts{0, 0, 0});
}

TEST_CASE("what is left is shared out so that all end together") {
    const std::vector<double> rates{30, 10};
    CHECK(shares(rates, 1, 40, false) == Counts{30, 10});
    CHECK(shares(rates, 1, 50, false) == Counts{38, 12});  // little more than a round: no further one for 10
    CHECK(shares(rates, 1, 8, false) == Counts{6, 2});
    CHECK(shares(rates, 1, 100, false) == Counts{30, 10});
}

TEST_CASE("shares never add up to more than there is") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-3, 6);
    for (int i = 0; i < 20000; ++i) {
        std::vector<double> rates(1 + random() % 9);
        for (double& rate : rates) rate = std::pow(10, exponent(random));
        const std::uint64_t left = 1 + random() % (i % 2 == 0 ? 20 : 100000);
        const bool in_time = i % 3 == 0;
        const Counts counts = shares(rates, std::pow(10, exponent(random) - 3), left, in_time);
        REQUIRE(sum(counts) <= left);
        if (!in_time) REQUIRE(sum(counts) > 0);
    }
}
