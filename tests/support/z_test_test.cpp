// The yardstick of the statistical tests is tested itself.

#include "support/z_test.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// Independent images of normal noise around `level`, as tiles.
TileEstimates noise(std::mt19937& engine, double level, int replicas) {
    std::normal_distribution<float> normal(static_cast<float>(level), 0.1f);
    Replicas result(2);
    for (int i = 0; i < replicas; ++i) {
        Image image(16, 16);
        for (Rgb& p : image.pixels()) p = {normal(engine), normal(engine), normal(engine)};
        result.add(image);
    }
    return result.estimates();
}

}  // namespace

// 400 comparisons that may each give a false alarm with probability 0.05: more than 42 of them happen with probability
// 2e-6. Without that many being possible, at least one does not happen with probability 1e-9.
TEST_CASE("false alarms are as rare as promised, and not rarer by much") {
    std::mt19937 engine(3);
    int alarms = 0, together = 0;
    for (int i = 0; i < 400; ++i) {
        const Comparison comparison = compare(noise(engine, 1, 8), noise(engine, 1, 5), 0.05);
        alarms += comparison.smallest <= comparison.level;
        together += comparison.together.p_value < 0.05;
    }
    CHECK(alarms <= 42);
    CHECK(alarms > 0);
    CHECK(together <= 42);
    CHECK(together > 0);
}

TEST_CASE("differences are found: a small one everywhere, a large one in one tile, one in the whole") {
    std::mt19937 engine(4);
    const TileEstimates a = noise(engine, 1, 16);
    // A tile's mean errs by 0.1 / sqrt(4 * 16) = 0.0125, the whole's by 0.0016.
    CHECK(compare(a, noise(engine, 1, 16), 1e-6).agree());
    CHECK_FALSE(compare(a, noise(engine, 1.03, 16), 1e-6).agree());
    TileEstimates b = noise(engine, 1, 16);
    b.tiles[3 * 17 + 2].mean += 0.2;
    const Comparison comparison = compare(a, b, 1e-6);
    CHECK_FALSE(comparison.agree());
    CHECK(comparison.worst_tile == 17);
    CHECK(comparison.worst_channel == 2);
    CHECK_FALSE(BiasInterval(noise(engine, 1.01, 16).whole[0], {1, 0}).within(0.005));
    CHECK(BiasInterval(noise(engine, 1, 16).whole[0], {1, 0}).within(0.01));
}

TEST_CASE("joined tiles have the mean and the error of their parts") {
    std::mt19937 engine(5);
    const TileEstimates a = noise(engine, 1, 16), b = a.joined(4);
    CHECK(b.columns == 2);
    CHECK(b.side == 8);
    double mean = 0, variance = 0;
    for (int y = 4; y < 8; ++y)
        for (int x = 0; x < 4; ++x) {
            mean += a.tiles[std::size_t(3 * (8 * y + x) + 1)].mean / 16;
            variance += a.tiles[std::size_t(3 * (8 * y + x) + 1)].variance / 256;
        }
    CHECK(b.tiles[3 * 2 + 1].mean == relative(mean, 1e-5));
    CHECK(b.tiles[3 * 2 + 1].variance == relative(variance, 1e-5));
}
