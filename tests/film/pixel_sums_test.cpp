#include "support/relative.hpp"

#include <lightswitch/film/film.hpp>
#include <lightswitch/film/pixel_sums.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

struct Sum {
    PixelSums sums;
    PixelSums::Windows windows;

    void add(const DVec3& value) { sums.add(windows, value); }
    void merge(const Sum& other) { sums.merge(windows, other.sums, other.windows); }
    DVec3 values() const { return sums.values(windows); }
    DVec3 squares() const { return sums.squares(windows); }
    friend bool operator==(const Sum&, const Sum&) = default;
};

Sum sum_of(const std::vector<DVec3>& terms) {
    Sum sum;
    for (const DVec3& term : terms) sum.add(term);
    return sum;
}

/// Terms of `bits` random bits whose magnitudes span `decades` binary orders, of both signs, some of them 0.
std::vector<DVec3> random_terms(std::mt19937_64& random, std::size_t count, int least, int decades) {
    std::uniform_int_distribution<int> exponent(least, least + decades);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    const auto number = [&] { return random() % 8 == 0 ? 0.0 : std::ldexp(mantissa(random), exponent(random)); };
    std::vector<DVec3> terms(count);
    for (DVec3& term : terms) term = {number(), number(), number()};
    return terms;
}

}  // namespace

TEST_CASE("sums are the same bits in any order and in any parts") {
    std::mt19937_64 random(3);
    for (const auto& [least, decades] : {std::pair(-4, 8), {-60, 120}, {-149, 276}, {20, 40}, {-33, 2}, {30, 3}}) {
        CAPTURE(least);
        CAPTURE(decades);
        for (int round = 0; round < 200; ++round) {
            std::vector<DVec3> terms = random_terms(random, 1 + random() % 60, least, decades);
            const Sum once = sum_of(terms);
            std::shuffle(terms.begin(), terms.end(), random);
            CHECK(sum_of(terms) == once);
            // Parts, merged as a chain.
            std::vector<Sum> parts(1 + random() % 7);
            for (const DVec3& term : terms) parts[random() % parts.size()].add(term);
            Sum chain;
            for (const Sum& part : parts) chain.merge(part);
            CHECK(chain == once);
            // And as a tree, from the other end.
            while (parts.size() > 1) {
                Sum last = parts.back();
                parts.pop_back();
                last.merge(parts.front());
                parts.front() = last;
            }
            CHECK(parts[0] == once);
        }
    }
}

TEST_CASE("a sum errs by at most 2^-64 of its largest term for each, and of squares by 2^-32") {
    std::mt19937_64 random(4);
    for (int round = 0; round < 300; ++round) {
        const std::vector<DVec3> terms = random_terms(random, 1 + random() % 100, -static_cast<int>(random() % 100),
                                                      static_cast<int>(random() % 50));
        const Sum sum = sum_of(terms);
        for (int c = 0; c < 3; ++c) {
            long double values = 0, squares = 0, largest = 0, largest_square = 0;
            for (const DVec3& term : terms) {
                values += static_cast<long double>(term[c]);
                squares += static_cast<long double>(term[c]) * static_cast<long double>(term[c]);
                for (int k = 0; k < 3; ++k) largest = std::max(largest, static_cast<long double>(std::abs(term[k])));
            }
            largest_square = largest * largest;
            const auto n = static_cast<long double>(terms.size());
            // And by its own rounding to a double, and that of the sum here.
            const long double rounding = std::abs(values) * 0x1p-53L + n * n * largest * 0x1p-63L;
            CHECK(std::abs(static_cast<long double>(sum.values()[c]) - values) <= n * largest * 0x1p-64L + rounding);
            CHECK(std::abs(static_cast<long double>(sum.squares()[c]) - squares) <= n * largest_square * 0x1.01p-32L);
        }
    }
}

TEST_CASE("floats of about one size are added exactly") {
    Sum sum;
    for (int i = 0; i < 1000; ++i) sum.add(DVec3(double(0.1f), double(0.7f), 3));
    CHECK(sum.values() == DVec3(1000 * double(0.1f), 1000 * double(0.7f), 3000));
    CHECK(sum.squares().z == 9000);
}

TEST_CASE("sums of floats that are multiplied by a power of two have the same digits") {
    std::mt19937_64 random(6);
    for (int round = 0; round < 300; ++round) {
        std::vector<DVec3> terms = random_terms(random, 1 + random() % 100, -20, 12);
        for (DVec3& term : terms) term = DVec3(Rgb(term));
        const DVec3 sum = sum_of(terms).values();
        for (const int k : {-80, -37, -20, -1, 1, 15, 31, 60, 80}) {
            std::vector<DVec3> scaled = terms;
            for (DVec3& term : scaled) term *= std::ldexp(1.0, k);
            CHECK(sum_of(scaled).values() == sum * std::ldexp(1.0, k));
        }
    }
}

TEST_CASE("the largest number of terms has room, at the edge of a window") {
    // As if that many had been added: a part, doubled.
    Sum sum;
    const double edge = std::nextafter(0x1p31, 0.0);
    sum.add(DVec3(edge, -edge, edge));
    for (int i = 0; i < 31; ++i) sum.merge(Sum(sum));
    CHECK(sum.values().x == relative(edge * 0x1p31, 1e-15));
    CHECK(sum.values().y == relative(-edge * 0x1p31, 1e-15));
    CHECK(sum.squares().z == relative(edge * edge * 0x1p31, 1e-15));
}

TEST_CASE("what is not finite makes a sum infinite, in any order") {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const DVec3 bad : {DVec3(inf, 0, 0), DVec3(0, -inf, 1), DVec3(1, 2, nan), DVec3(1e300, 0, 0)}) {
        Sum before, after, merged;
        before.add(bad);
        before.add(DVec3(1));
        after.add(DVec3(1));
        after.add(bad);
        merged.add(DVec3(2));
        merged.merge(after);
        CHECK(before == after);
        CHECK(merged == after);
        CHECK(std::isinf(before.values().x));
        CHECK(std::isinf(before.squares().y));
    }
}

TEST_CASE("films of parts merge to the film of the whole, bit for bit") {
    constexpr int width = 5, height = 4, iterations = 40;
    const SerialExecutor serial;
    std::mt19937_64 random(5);
    std::vector<std::vector<DVec3>> values;
    for (int i = 0; i < iterations; ++i) values.push_back(random_terms(random, width * height, -30, 40));
    const auto add = [&](Film& film, std::size_t iteration, bool splatted) {
        for (std::uint32_t pixel = 0; pixel < width * height; ++pixel) {
            film.slot(pixel) = Rgb(values[iteration][pixel]);
            const Splat splats[] = {{pixel, Rgb(values[iteration][pixel] * 0.3)}, {pixel / 2, Rgb(1e-5f)}};
            if (splatted) film.add(splats);
        }
        film.commit(serial);
    };
    for (const bool splatted : {false, true}) {
        Film whole(width, height);
        for (std::size_t i = 0; i < iterations; ++i) add(whole, i, splatted);
        for (int round = 0; round < 20; ++round) {
            std::vector<Film> parts(1 + random() % 6, Film(width, height));
            std::vector<std::size_t> order(iterations);
            for (std::size_t i = 0; i < iterations; ++i) order[i] = i;
            std::shuffle(order.begin(), order.end(), random);
            for (const std::size_t i : order) add(parts[random() % parts.size()], i, splatted);
            Film merged(width, height);
            for (const Film& part : parts) merged.merge(part);
            CHECK(merged.iterations() == whole.iterations());
            CHECK(merged.sums() == whole.sums());
            CHECK(merged.windows() == whole.windows());
            CHECK(merged.image().pixels() == whole.image().pixels());
            CHECK(merged.variance().pixels() == whole.variance().pixels());
            CHECK(merged.relative_error() == whole.relative_error());
        }
    }
    Film other(width, height + 1), film(width, height);
    CHECK_THROWS_AS(film.merge(other), Error);
}

TEST_CASE("a film refuses more iterations than its sums have room for") {
    Film film(1, 1);
    film.restore(PixelSums::most_terms, std::vector<PixelSums>(1), std::vector<PixelSums::Windows>(1));
    CHECK_THROWS_AS(film.commit(SerialExecutor{}), Error);
    CHECK(film.iterations() == PixelSums::most_terms);
    CHECK_THROWS_AS(
        film.restore(PixelSums::most_terms + 1, std::vector<PixelSums>(1), std::vector<PixelSums::Windows>(1)), Error);
}
