// What ending an iteration costs the film, and what a pixel takes of memory: sums that do not depend on their order
// (the film), beside plain sums in double, and such with a second double for what is lost (Knuth's two-sum).
//
//   film [SIDE]     a square of so many pixels a side; 512 without
//
// One thread; the film and each of the others alternate; in brackets the middle half of the pairs' ratios.

#include <lightswitch/film/film.hpp>

#include <cstdio>
#include <cstdlib>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;
using ls::DVec3;

/// The film as it would be with `Sum`.
template <class Sum>
struct Other {
    std::vector<ls::Rgb> slots;
    std::vector<Sum> sum, squares;

    explicit Other(std::size_t area) : slots(area, ls::Rgb(0)), sum(area), squares(area) {}
    std::size_t bytes_per_pixel() const { return sizeof(ls::Rgb) + 2 * sizeof(Sum); }
    void commit() {
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const DVec3 value(slots[i]);
            sum[i].add(value);
            squares[i].add(value * value);
            slots[i] = ls::Rgb(0);
        }
    }
};

struct Plain {
    DVec3 sum{0};
    void add(const DVec3& x) { sum += x; }
};

struct TwoSum {
    DVec3 sum{0}, lost{0};
    void add(const DVec3& x) {
        const DVec3 s = sum + x, part = s - sum;
        lost += (sum - (s - part)) + (x - part);
        sum = s;
    }
};

void measure(const char* name, std::size_t side, auto& other) {
    constexpr int iterations = 16;
    ls::Film film(static_cast<int>(side), static_cast<int>(side));
    const auto fill = [&](auto&& slot) {
        for (std::size_t i = 0; i < side * side; ++i) slot(i) = ls::Rgb(0.1f, 0.7f, 0.3f) * float(i % 97);
    };
    const auto ours = [&] {
        for (int k = 0; k < iterations; ++k) {
            fill([&](std::size_t i) -> ls::Rgb& { return film.slot(i); });
            film.commit(ls::SerialExecutor{});
        }
    };
    const auto theirs = [&] {
        for (int k = 0; k < iterations; ++k) {
            fill([&](std::size_t i) -> ls::Rgb& { return other.slots[i]; });
            other.commit();
        }
    };
    const auto only_filling = [&] {
        for (int k = 0; k < iterations; ++k) fill([&](std::size_t i) -> ls::Rgb& { return other.slots[i]; });
    };
    const auto result = bench::compare(31, ours, theirs);
    const auto filling = bench::compare(31, ours, only_filling);
    const double per_pixel = 1e9 / double(iterations) / double(side * side);
    std::printf("%-8s %7zu bytes a pixel, %6.2f ns; the film %6.2f ns; ratio %.3f (%.3f to %.3f)\n", name,
                other.bytes_per_pixel(), (result.b.median - filling.b.median) * per_pixel,
                (result.a.median - filling.b.median) * per_pixel, result.ratio.median, result.ratio.low,
                result.ratio.high);
}

}  // namespace

int main(int argc, char** argv) {
    const auto side = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 512);
    Other<Plain> plain(side * side);
    Other<TwoSum> two_sum(side * side);
    measure("plain", side, plain);
    measure("two-sum", side, two_sum);
    std::printf("film     %7zu bytes a pixel, and %zu more with splats\n", ls::Film::bytes_per_pixel, sizeof(DVec3));
}
