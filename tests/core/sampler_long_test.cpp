// A thousand million draws of everything that makes numbers in [0, 1): one that is rounded to float reaches 1 every
// 2^25 draws.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/method/primary_space.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;

namespace {

constexpr std::uint64_t draws = 1000000000;

/// The largest of as many numbers as `draw` makes.
template <class Number>
Number largest(std::uint64_t calls, const auto& draw) {
    Number result = 0;
    for (std::uint64_t i = 0; i < calls; ++i) result = std::max<Number>(result, draw(i));
    return result;
}

}  // namespace

TEST_CASE("random sequences: no number is 1 in 1e9") {
    RandomSequence doubles(1), floats(2);
    CHECK(largest<double>(draws, [&](std::uint64_t) { return doubles.next(); }) < 1);
    CHECK(largest<float>(draws, [&](std::uint64_t) { return floats.next_float(); }) == 1 - 0x1p-24f);
}

TEST_CASE("sampler: no number is 1 in 1e9") {
    for (const Sampling sampling : {Sampling::sobol, Sampling::independent})
        for (const bool split : {false, true}) {
            constexpr std::uint64_t pairs = 100;  // of which Sobol' points are the first 64
            IterationPoints points(sampling, 3, 0);
            CHECK(largest<float>(draws / (2 * pairs), [&](std::uint64_t i) {
                      if (i % 100000 == 0) points = IterationPoints(sampling, 3, i / 100000);
                      Sampler sampler(points, 0, i);
                      if (split) sampler = sampler.split();
                      float highest = 0;
                      for (std::uint64_t pair = 0; pair < pairs; ++pair) {
                          const Vec2 u = sampler.next_2d();
                          highest = std::max({highest, u.x, u.y});
                      }
                      return highest;
                  }) == 1 - 0x1p-24f);
        }
}

TEST_CASE("primary samples: no number is 1 in 1e9") {
    PrimarySample sample(4);
    CHECK(largest<float>(draws, [&](std::uint64_t) {
              sample.propose();
              return PrimarySample::Reader(sample, 0).next_1d();
          }) == 1 - 0x1p-24f);
}
