#include <lightswitch/core/grid_distribution.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <vector>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr float largest_u = 1 - 0x1p-24f;

// Chi-square tests of this file, together a false alarm of 1e-6; the seeds are fixed.
const double level = sidak(1e-6, 4);

struct Grid {
    std::size_t columns, rows;
    std::vector<double> weights;

    double at(std::size_t column, std::size_t row) const { return weights[row * columns + column]; }
    GridDistribution distribution() const {
        return {columns, rows, [this](std::size_t row, std::span<double> out) {
                    std::copy_n(weights.begin() + std::ptrdiff_t(row * columns), columns, out.begin());
                }};
    }
};

Grid made(std::size_t columns, std::size_t rows, double (*weight)(std::size_t column, std::size_t row)) {
    Grid grid{columns, rows, {}};
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column) grid.weights.push_back(weight(column, row));
    return grid;
}

std::vector<Grid> grids() {
    return {
        {1, 1, {2}},
        {3, 2, {0, 1, 0, 0, 0, 0}},
        {2, 4, {0, 0, 1, 3, 0, 0, 2, 0}},
        {4, 3, {1e-30, 1, 1e-300, 1e6, 1e-3, 1e-3, 0, 1e-3, 0, 0, 0, 1e-30}},
        made(7, 1, [](std::size_t c, std::size_t) { return double(c % 3); }),
        made(1, 9, [](std::size_t, std::size_t r) { return double(r % 4); }),
        made(1000, 3, [](std::size_t c, std::size_t r) { return c == 500 && r == 1 ? 1e9 : 1.0; }),
    };
}

}  // namespace

TEST_CASE("interval: the probability that is stated is that with which a part is chosen") {
    std::vector<std::vector<double>> cases{{1},        {1, 2, 3},  {0, 1, 0},
                                           {1e-30, 1}, {1, 1e-30}, {1e30, 1e-30, 1, 0, 1e30}};
    cases.emplace_back(100000, 1.0);
    for (const auto& weights : cases) {
        std::vector<std::uint32_t> ends(weights.size()), counts(weights.size());
        interval::cut(weights, ends);
        std::size_t previous = 0;
        float previous_place = 0;
        bool ordered = true;
        for (std::uint32_t u = 0; u < interval::steps; ++u) {
            const auto [part, place] = interval::find(ends, static_cast<float>(u) * 0x1p-24f);
            ++counts[part];
            ordered =
                ordered && place >= 0 && place < 1 && part >= previous && (part > previous || place >= previous_place);
            previous = part;
            previous_place = place;
        }
        CHECK(ordered);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < weights.size(); ++i)
            wrong += static_cast<float>(counts[i]) * 0x1p-24f != interval::probability(ends, i) ||
                     (weights[i] > 0) != (counts[i] > 0);
        CHECK(wrong == 0);
    }
}

TEST_CASE("interval: places fill a part evenly, with its middle as their mean, however short it is") {
    const std::vector<double> weights{1, 1e-9, 3e-7, 1, 1e-4};
    std::vector<std::uint32_t> ends(weights.size()), counts(weights.size());
    interval::cut(weights, ends);
    std::vector<double> sums(weights.size()), lowest(weights.size(), 1), highest(weights.size(), 0);
    for (std::uint32_t u = 0; u < interval::steps; ++u) {
        const auto [part, place] = interval::find(ends, static_cast<float>(u) * 0x1p-24f);
        ++counts[part];
        sums[part] += double(place);
        lowest[part] = std::min(lowest[part], double(place));
        highest[part] = std::max(highest[part], double(place));
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        CAPTURE(counts[i]);
        CHECK(sums[i] / counts[i] == relative(0.5, 1e-6));
        CHECK(lowest[i] == relative(0.5 / counts[i], 1e-5));
        CHECK(1 - highest[i] == relative(0.5 / counts[i], 1e-5).or_absolute(0x1p-24));
    }
}

TEST_CASE("interval: numbers that no sampler gives") {
    for (const auto& weights : std::vector<std::vector<double>>{{1}, {1, 0}, {0, 1, 0, 0}, {1, 1e-30}}) {
        std::vector<std::uint32_t> ends(weights.size());
        interval::cut(weights, ends);
        std::size_t last = weights.size() - 1;
        while (weights[last] == 0) --last;
        for (const float u : {largest_u, 1.0f, 1e9f}) {
            CHECK(interval::find(ends, u).part == last);
            CHECK(interval::find(ends, u).place < 1);
        }
        CHECK(weights[interval::find(ends, -1).part] > 0);
    }
}

TEST_CASE("grid distribution: cells are as frequent as their weights") {
    const std::vector<Grid> all = grids();
    for (const std::size_t index : {std::size_t{2}, std::size_t{4}, std::size_t{5}, std::size_t{6}}) {
        const Grid& grid = all[index];
        const GridDistribution distribution = grid.distribution();
        const int samples = 200000;
        // Cut in two both ways, so that the place counts, too.
        std::vector<double> observed(4 * grid.weights.size()), expected(observed.size());
        const double total = std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = samples * grid.weights[i / 4] / total / 4;
        Random random(std::uint32_t(index) + 1);
        for (int i = 0; i < samples; ++i) {
            const GridDistribution::Cell cell = distribution.sample(random.next_2d());
            const auto quarter = std::size_t((cell.place.y >= 0.5f) * 2 + (cell.place.x >= 0.5f));
            ++observed[4 * (cell.row * grid.columns + cell.column) + quarter];
        }
        CAPTURE(index);
        CHECK(chi_square(observed, expected).p_value > level);
    }
}

TEST_CASE("grid distribution: probabilities add up to 1, and are 0 for weight 0 alone") {
    for (const Grid& grid : grids()) {
        const GridDistribution distribution = grid.distribution();
        REQUIRE_FALSE(distribution.empty());
        double sum = 0, off = 0;
        std::size_t wrong = 0;
        const double total = std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
        for (std::size_t row = 0; row < grid.rows; ++row)
            for (std::size_t column = 0; column < grid.columns; ++column) {
                const double p = double(distribution.probability(column, row));
                sum += p;
                wrong += (p > 0) != (grid.at(column, row) > 0);
                off = std::max(off, std::abs(p - grid.at(column, row) / total));
            }
        CAPTURE(grid.columns);
        CAPTURE(grid.rows);
        CHECK(sum == relative(1, 1e-6));
        CHECK(wrong == 0);
        CHECK(off < double(grid.columns + grid.rows) * 0x1p-24);
    }
}

TEST_CASE("grid distribution: the ends of [0, 1) are safe") {
    for (const Grid& grid : grids()) {
        const GridDistribution distribution = grid.distribution();
        for (const float x : {0.0f, 1e-30f, largest_u})
            for (const float y : {0.0f, 1e-30f, largest_u}) {
                const GridDistribution::Cell cell = distribution.sample({x, y});
                REQUIRE(cell.column < grid.columns);
                REQUIRE(cell.row < grid.rows);
                CHECK(grid.at(cell.column, cell.row) > 0);
                CHECK(cell.place.x >= 0);
                CHECK(cell.place.x < 1);
                CHECK(cell.place.y >= 0);
                CHECK(cell.place.y < 1);
            }
    }
}

TEST_CASE("grid distribution: nothing to choose, and impossible weights") {
    CHECK(Grid{2, 2, {0, 0, 0, 0}}.distribution().empty());
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, infinite, std::numeric_limits<double>::quiet_NaN()})
        CHECK_THROWS_AS((Grid{2, 2, {1, 1, bad, 1}}.distribution()), Error);
    CHECK_THROWS_AS((Grid{1, 2, {1e308, 1e308}}.distribution()), Error);
    CHECK_THROWS_AS((Grid{2, 1, {1e308, 1e308}}.distribution()), Error);
}
