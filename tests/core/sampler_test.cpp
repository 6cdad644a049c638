#include <lightswitch/core/sampler.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"
#include "../support/statistics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <vector>

using namespace lightswitch;
using test::chi_square;
using test::Mean;
using test::relative;
using test::UniformCorrelation;

namespace {

// False alarms, were the seeds drawn at random (they are fixed): all chi-square tests of this file together 1e-6; a
// correlation or a mean may be off by 6 standard errors, 2e-9, and there are fewer than 3000 of them: 6e-6.
constexpr int chi_square_tests = 1500;
const double level = test::sidak(1e-6, chi_square_tests);
constexpr double six_sigmas = 6;

constexpr Sampling both[] = {Sampling::sobol, Sampling::independent};

/// The first `pairs` points of one pixel in one iteration.
std::vector<Vec2> points(const IterationPoints& iteration, std::uint64_t pixel, std::size_t pairs,
                         std::uint32_t stream = 0) {
    Sampler sampler(iteration, stream, pixel);
    std::vector<Vec2> result(pairs);
    for (Vec2& p : result) p = sampler.next_2d();
    return result;
}

/// Chi-square of points that should be uniform in the unit square, in `side` x `side` cells.
class SquareTest {
public:
    explicit SquareTest(std::size_t side = 16) : side_(side), counts_(side * side) {}
    void add(float x, float y) { counts_[cell(x) * side_ + cell(y)] += 1; }
    double p_value() const {
        const double total = std::accumulate(counts_.begin(), counts_.end(), 0.0);
        return chi_square(counts_, std::vector<double>(counts_.size(), total / static_cast<double>(counts_.size())))
            .p_value;
    }

private:
    std::size_t cell(float x) const { return static_cast<std::size_t>(x * static_cast<float>(side_)); }
    std::size_t side_;
    std::vector<double> counts_;
};

/// Whether 2^k points are a (0,k,2)-net in base 2: each elementary interval of area 2^-k holds exactly one. Exact,
/// since all numbers have 24 bits.
bool is_net(const std::vector<Vec2>& net, int k) {
    for (int a = 0; a <= k; ++a) {
        std::vector<bool> taken(net.size());
        for (const Vec2& p : net) {
            const auto column = static_cast<std::size_t>(std::ldexp(p.x, a));
            const auto row = static_cast<std::size_t>(std::ldexp(p.y, k - a));
            const std::size_t interval = column << (k - a) | row;
            if (taken[interval]) return false;
            taken[interval] = true;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("sampler: numbers are in [0, 1) and multiples of 2^-24") {
    for (const Sampling sampling : both) {
        float lowest = 1, highest = 0;
        bool on_grid = true;
        for (std::uint64_t iteration = 0; iteration < 64; ++iteration) {
            const IterationPoints shared(sampling, 3, iteration);
            for (std::uint64_t pixel = 0; pixel < 256; ++pixel)
                for (const Vec2& p : points(shared, pixel, 70))
                    for (const float x : {p.x, p.y}) {
                        lowest = std::min(lowest, x);
                        highest = std::max(highest, x);
                        on_grid = on_grid && x * 0x1p24f == std::floor(x * 0x1p24f);
                    }
        }
        CHECK(on_grid);
        CHECK(lowest >= 0);
        CHECK(highest < 1);
        // 2.3 million numbers: each of these fails with probability exp(-230) when they are uniform.
        CHECK(lowest < 1e-4f);
        CHECK(highest > 1 - 1e-4f);
    }
}

TEST_CASE("random sequences: a number in [0, 1) is below 1, also as a float") {
    CHECK(detail::to_unit_float(0) == 0);
    CHECK(detail::to_unit_float(0xffffffffu) == 1 - 0x1p-24f);
    // The first double of these is so close to 1 that it would round to it.
    for (const std::uint64_t seed : {41744883u, 42938481u, 54323990u}) {
        REQUIRE(static_cast<float>(RandomSequence(seed).next()) == 1);
        CHECK(RandomSequence(seed).next() < 1);
        CHECK(RandomSequence(seed).next_float() == 1 - 0x1p-24f);
    }
    RandomSequence doubles(5), floats(5);
    for (int i = 0; i < 1000; ++i) {
        const double x = doubles.next(), y = double(floats.next_float());
        REQUIRE((y <= x && x - y < 0x1p-24));
    }
}

TEST_CASE("sampler: 2^k iterations of one pixel are a (0,k,2)-net in each of the first 64 pairs") {
    for (const int k : {0, 1, 2, 4, 7, 10, 12}) {
        const std::uint64_t n = std::uint64_t{1} << k;
        // Aligned blocks: the first one, a later one, and the last before the sequences start again.
        for (const std::uint64_t first :
             {std::uint64_t{0}, 5 * n, (std::uint64_t{1} << 32) - n, 3 * n + (std::uint64_t{7} << 32)}) {
            if (k > 10 && first != 0) continue;
            for (const std::uint64_t pixel : {std::uint64_t{0}, std::uint64_t{123457}}) {
                std::vector<std::vector<Vec2>> nets(IterationPoints::sobol_pairs, std::vector<Vec2>(n));
                for (std::uint64_t i = 0; i < n; ++i) {
                    const auto p = points(IterationPoints(Sampling::sobol, 11, first + i), pixel, nets.size());
                    for (std::size_t pair = 0; pair < nets.size(); ++pair) nets[pair][i] = p[pair];
                }
                int broken = 0;
                for (const auto& net : nets) broken += is_net(net, k) ? 0 : 1;
                CAPTURE(k);
                CAPTURE(first);
                CHECK(broken == 0);
            }
        }
    }
    // The check can fail: points that are independent are no net.
    std::vector<Vec2> random(16);
    for (std::uint64_t i = 0; i < 16; ++i) random[i] = points(IterationPoints(Sampling::independent, 1, i), 0, 1)[0];
    CHECK_FALSE(is_net(random, 4));
}

TEST_CASE("sampler: over the pixels of one iteration every pair of dimensions is uniform") {
    for (const Sampling sampling : both) {
        const IterationPoints shared(sampling, 5, 17);
        constexpr std::size_t pairs = 72;  // 64 of Sobol' points and some beyond
        std::vector<SquareTest> within(pairs), across(pairs - 1);
        constexpr std::size_t few = 5;  // all combinations of the first ten dimensions
        std::vector<SquareTest> all(2 * few * 2 * few);
        for (std::uint64_t pixel = 0; pixel < 20000; ++pixel) {
            const auto p = points(shared, pixel, pairs);
            for (std::size_t i = 0; i < pairs; ++i) within[i].add(p[i].x, p[i].y);
            for (std::size_t i = 0; i + 1 < pairs; ++i) across[i].add(p[i].y, p[i + 1].x);
            for (std::size_t i = 0; i < 2 * few; ++i)
                for (std::size_t j = 0; j < i; ++j)
                    all[i * 2 * few + j].add(p[i / 2][static_cast<int>(i % 2)], p[j / 2][static_cast<int>(j % 2)]);
        }
        double smallest = 1;
        for (const auto& t : within) smallest = std::min(smallest, t.p_value());
        CHECK(smallest > level);
        smallest = 1;
        for (const auto& t : across) smallest = std::min(smallest, t.p_value());
        CHECK(smallest > level);
        smallest = 1;
        for (std::size_t i = 0; i < 2 * few; ++i)
            for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, all[i * 2 * few + j].p_value());
        CHECK(smallest > level);
    }
}

TEST_CASE("sampler: over the iterations of one pixel dimensions of different pairs are uniform together") {
    // Sobol' points are more even than independent ones, in each dimension alone: that can only lower chi-square. If
    // two pairs had the same shuffling or scrambling, their points would lie on few lines.
    constexpr std::size_t pairs = 12;
    std::vector<SquareTest> xx(pairs * pairs, SquareTest(12)), xy(pairs * pairs, SquareTest(12));
    for (std::uint64_t i = 0; i < 4096; ++i) {
        const auto p = points(IterationPoints(Sampling::sobol, 2, i), 99, pairs);
        for (std::size_t a = 0; a < pairs; ++a)
            for (std::size_t b = 0; b < a; ++b) {
                xx[a * pairs + b].add(p[a].x, p[b].x);
                xy[a * pairs + b].add(p[a].x, p[b].y);
            }
    }
    double smallest = 1;
    for (std::size_t a = 0; a < pairs; ++a)
        for (std::size_t b = 0; b < a; ++b)
            smallest = std::min({smallest, xx[a * pairs + b].p_value(), xy[a * pairs + b].p_value()});
    CHECK(smallest > level);
}

TEST_CASE("sampler: pixels, streams and seeds are uncorrelated") {
    constexpr std::uint64_t pixels = 50000;
    for (const Sampling sampling : both) {
        const IterationPoints shared(sampling, 0, 4), other_seed(sampling, 1, 4), far_seed(sampling, 1u << 20, 4);
        double worst = 0, smallest = 1;
        const auto compare = [&](const IterationPoints& a, std::uint32_t stream_a, const IterationPoints& b,
                                 std::uint32_t stream_b, std::uint64_t lag) {
            UniformCorrelation x[2], y[2];
            SquareTest square;
            for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
                const auto p = points(a, pixel, 2, stream_a), q = points(b, pixel + lag, 2, stream_b);
                for (std::size_t i = 0; i < 2; ++i) {
                    x[i].add(double(p[i].x), double(q[i].x));
                    y[i].add(double(p[i].y), double(q[i].y));
                }
                square.add(p[0].x, q[0].x);
            }
            for (const auto& c : {x[0], x[1], y[0], y[1]}) worst = std::max(worst, std::abs(c.sigmas()));
            smallest = std::min(smallest, square.p_value());
        };
        for (const std::uint64_t lag : {1u, 2u, 3u, 16u, 255u, 256u, 1920u, 1u << 20})
            compare(shared, 0, shared, 0, lag);
        compare(shared, 0, shared, 1, 0);
        compare(shared, 0, other_seed, 0, 0);
        compare(shared, 0, far_seed, 0, 0);
        CHECK(worst < six_sigmas);
        CHECK(smallest > level);
    }
}

TEST_CASE("sampler: estimates of different pixels are uncorrelated") {
    // Pixels share their Sobol' points up to a shift; were the shift missing, both would make the same errors.
    for (const Sampling sampling : both) {
        Mean product, left, right;
        for (std::uint64_t seed = 0; seed < 3000; ++seed) {
            double a = 0, b = 0;
            for (std::uint64_t i = 0; i < 8; ++i) {
                const IterationPoints shared(sampling, seed, i);
                const auto f = [](const Vec2& u) { return double(u.x) * double(u.y) + double(u.x) * double(u.x); };
                a += f(points(shared, 40, 1)[0]);
                b += f(points(shared, 41, 1)[0]);
            }
            const double truth = 8 * (0.25 + 1.0 / 3);
            product.add((a - truth) * (b - truth));
            left.add(a);
            right.add(b);
        }
        CHECK(product.sigmas(0) < six_sigmas);
        CHECK(left.sigmas(8 * (0.25 + 1.0 / 3)) < six_sigmas);
        CHECK(right.sigmas(8 * (0.25 + 1.0 / 3)) < six_sigmas);
    }
}

TEST_CASE("sampler: numbers are a pure function of their arguments, in whatever order they are asked for") {
    for (const Sampling sampling : both) {
        const IterationPoints shared(sampling, 9, 5), again(sampling, 9, 5);
        const auto forward = points(shared, 7, 80);
        points(shared, 8, 3);
        CHECK(points(again, 7, 80) == forward);
        CHECK(points(shared, 7, 80) == forward);

        // Two samplers used in turns do not disturb each other, and a copy goes on where the original is.
        Sampler a(shared, 0, 7), b(shared, 0, 6);
        bool same = true;
        for (std::size_t i = 0; i < 40; ++i) {
            same = same && a.next_2d() == forward[i];
            b.next_1d();
        }
        Sampler copy = a;
        for (std::size_t i = 40; i < 80; ++i) same = same && copy.next_1d() == forward[i].x;
        CHECK(same);

        // Every argument counts.
        CHECK(points(shared, 8, 4) != points(shared, 7, 4));
        CHECK(points(shared, 7, 4, 1) != points(shared, 7, 4, 0));
        CHECK(points(IterationPoints(sampling, 9, 6), 7, 4) != points(shared, 7, 4));
        CHECK(points(IterationPoints(sampling, 10, 5), 7, 4) != points(shared, 7, 4));
        CHECK(points(IterationPoints(sampling, 9, 5 + (std::uint64_t{1} << 32)), 7, 4) != points(shared, 7, 4));
    }
    CHECK(points(IterationPoints(Sampling::sobol, 9, 5), 7, 4) !=
          points(IterationPoints(Sampling::independent, 9, 5), 7, 4));
}

TEST_CASE("sampler: seeds and iterations are not interchangeable") {
    // Numbers of (seed, iteration) and (seed + a, iteration + b) are equal as rarely as by chance: 40000 pairs of 24
    // bits give 0.0024 on average, so that three are a false alarm of 2e-9.
    for (const Sampling sampling : both)
        for (const int a : {-1, 1})
            for (const int b : {-1, 0, 1}) {
                const IterationPoints first(sampling, 100, 100);
                const IterationPoints second(sampling, 100 + static_cast<std::uint64_t>(a),
                                             100 + static_cast<std::uint64_t>(b));
                int equal = 0;
                for (std::uint64_t pixel = 0; pixel < 20000; ++pixel) {
                    const Vec2 p = points(first, pixel, 1)[0], q = points(second, pixel, 1)[0];
                    equal += (p.x == q.x) + (p.y == q.y);
                }
                CHECK(equal < 3);
            }
}

TEST_CASE("sampler: independent numbers have no relation between iterations, pixels and dimensions") {
    UniformCorrelation next_iteration[2], next_dimension, next_pair;
    SquareTest iterations, dimensions;
    std::vector<double> ones(24);
    Mean rises;
    constexpr std::uint64_t n = 50000;
    Vec2 previous = points(IterationPoints(Sampling::independent, 77, 0), 3, 1)[0];
    for (std::uint64_t i = 1; i <= n; ++i) {
        const auto p = points(IterationPoints(Sampling::independent, 77, i), 3, 2);
        next_iteration[0].add(double(previous.x), double(p[0].x));
        next_iteration[1].add(double(previous.y), double(p[0].y));
        next_dimension.add(double(p[0].x), double(p[0].y));
        next_pair.add(double(p[0].x), double(p[1].x));
        iterations.add(previous.x, p[0].x);
        dimensions.add(p[0].x, p[1].y);
        const auto bits = static_cast<std::uint32_t>(p[0].x * 0x1p24f);
        for (std::size_t bit = 0; bit < 24; ++bit) ones[bit] += bits >> bit & 1u;
        rises.add(p[0].x > previous.x ? 1 : 0);
        previous = p[0];
    }
    for (const auto& c : {next_iteration[0], next_iteration[1], next_dimension, next_pair})
        CHECK(std::abs(c.sigmas()) < six_sigmas);
    CHECK(iterations.p_value() > level);
    CHECK(dimensions.p_value() > level);
    // Each bit is a fair coin: variance n / 4.
    for (const double count : ones) CHECK(std::abs(count - 0.5 * n) < six_sigmas * std::sqrt(0.25 * n));
    // Numbers rise as often as they fall; neighbouring rises are anticorrelated, so that this bound is generous.
    CHECK(rises.sigmas(0.5) < six_sigmas);
}

TEST_CASE("sampler: beyond 64 pairs numbers stay uniform and change with the iteration") {
    for (const Sampling sampling : both) {
        SquareTest square, iterations;
        UniformCorrelation correlation;
        Vec2 previous{0.5f, 0.5f};
        int equal = 0;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const auto p = points(IterationPoints(sampling, 6, i), 3, 66);
            square.add(p[65].x, p[65].y);
            if (i > 0) {
                iterations.add(previous.x, p[65].x);
                correlation.add(double(previous.x), double(p[65].x));
                equal += previous.x == p[65].x;
            }
            previous = p[65];
        }
        CHECK(square.p_value() > level);
        CHECK(iterations.p_value() > level);
        CHECK(std::abs(correlation.sigmas()) < six_sigmas);
        CHECK(equal < 3);  // by chance: 20000 / 2^24, so 3 or more with probability 3e-10
    }
}

TEST_CASE("sampler: Sobol' points integrate a smooth function with less error, and without bias") {
    const auto f = [](const Vec2& u) {
        return std::sin(3.14159265358979323846 * double(u.x)) * double(u.y) * double(u.y);
    };
    constexpr double truth = 2 / 3.14159265358979323846 / 3;
    constexpr std::size_t pixels = 400, samples = 256;
    double errors[2];
    for (const Sampling sampling : both) {
        std::vector<double> sums(pixels);
        for (std::uint64_t i = 0; i < samples; ++i) {
            const IterationPoints shared(sampling, 21, i);
            for (std::size_t pixel = 0; pixel < pixels; ++pixel) sums[pixel] += f(points(shared, pixel, 3)[2]);
        }
        double squares = 0;
        for (const double sum : sums) squares += (sum / samples - truth) * (sum / samples - truth);
        errors[static_cast<int>(sampling)] = std::sqrt(squares / pixels);
    }
    CAPTURE(errors[0]);
    CAPTURE(errors[1]);
    // The deviation of f is 0.2345; 400 pixels estimate the error to 4 %, so this allows 6 standard errors.
    CHECK(errors[1] == relative(0.2345 / 16, 0.24));
    CHECK(errors[0] * 3 < errors[1]);

    for (const Sampling sampling : both)
        for (const std::uint64_t iterations : {1u, 7u}) {
            std::vector<double> sums(10000);
            for (std::uint64_t i = 0; i < iterations; ++i) {
                const IterationPoints shared(sampling, 22, i);
                for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) sums[pixel] += f(points(shared, pixel, 1)[0]);
            }
            Mean mean;
            for (const double sum : sums) mean.add(sum / static_cast<double>(iterations));
            CHECK(mean.sigmas(truth) < six_sigmas);
        }
}

namespace {

/// Correlations, and joint distributions, of the numbers of two samplers, which are made anew for every index: pairs of
/// the same number in both, and neighbouring ones.
void check_independent(const auto& two_samplers, std::size_t pairs) {
    constexpr std::uint64_t count = 16384;
    std::vector<std::vector<Vec2>> first(pairs), second(pairs);
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto [a, b] = two_samplers(i, pairs);
        for (std::size_t k = 0; k < pairs; ++k) {
            first[k].push_back(a[k]);
            second[k].push_back(b[k]);
        }
    }
    for (std::size_t k = 0; k < pairs; ++k)
        for (const std::size_t other : {k, (k + 1) % pairs}) {
            UniformCorrelation same, crossed;
            SquareTest joint;
            int equal = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const Vec2 a = first[k][i], b = second[other][i];
                same.add(double(a.x), double(b.x));
                crossed.add(double(a.x), double(b.y));
                joint.add(a.x, b.x);
                equal += a.x == b.x;
            }
            CAPTURE(k);
            CAPTURE(other);
            CHECK(std::abs(same.sigmas()) < six_sigmas);
            CHECK(std::abs(crossed.sigmas()) < six_sigmas);
            CHECK(joint.p_value() > level);
            CHECK(equal < 4);  // by chance: 16384 / 2^24, so 4 or more with probability 4e-14
        }
}

std::vector<Vec2> draw(Sampler& sampler, std::size_t pairs) {
    std::vector<Vec2> result(pairs);
    for (Vec2& p : result) p = sampler.next_2d();
    return result;
}

}  // namespace

TEST_CASE("sampler: a split one is independent of the one that it comes from, and of another split") {
    for (const Sampling sampling : both) {
        CAPTURE(name(sampling));
        // Some before the split; so many after it that the Sobol' pairs of both run out.
        check_independent(
            [&](std::uint64_t i, std::size_t pairs) {
                const IterationPoints points(sampling, 31, i);
                Sampler original(points, 0, 77);
                draw(original, 2);
                Sampler other = original.split();
                return std::pair(draw(original, pairs), draw(other, pairs));
            },
            70);
        check_independent(
            [&](std::uint64_t i, std::size_t pairs) {
                const IterationPoints points(sampling, 32, i);
                Sampler original(points, 0, 78);
                Sampler other = original.split(), third = original.split();
                return std::pair(draw(other, pairs), draw(third, pairs));
            },
            40);
        // Over the pixels of one iteration: with the original of the same pixel, and with the split one of the next.
        const IterationPoints points(sampling, 33, 6);
        check_independent(
            [&](std::uint64_t pixel, std::size_t pairs) {
                Sampler original(points, 0, pixel);
                Sampler other = original.split();
                return std::pair(draw(original, pairs), draw(other, pairs));
            },
            40);
        check_independent(
            [&](std::uint64_t pixel, std::size_t pairs) {
                Sampler a(points, 0, pixel), b(points, 0, pixel + 1);
                Sampler first = a.split(), second = b.split();
                return std::pair(draw(first, pairs), draw(second, pairs));
            },
            40);
    }
}

TEST_CASE("sampler: a split one is uniform, also beyond the Sobol' pairs, and over pixels") {
    for (const Sampling sampling : both)
        for (const std::size_t pair : {0u, 5u, 60u}) {
            SquareTest over_iterations, over_pixels;
            const IterationPoints one(sampling, 34, 5);
            for (std::uint64_t i = 0; i < 20000; ++i) {
                const IterationPoints points(sampling, 34, i);
                Sampler a(points, 0, 9), b(one, 0, i);
                Sampler first = a.split(), second = b.split();
                const Vec2 p = draw(first, pair + 1)[pair], q = draw(second, pair + 1)[pair];
                over_iterations.add(p.x, p.y);
                over_pixels.add(q.x, q.y);
            }
            CHECK(over_pixels.p_value() > level);
            CHECK(over_iterations.p_value() > level);
        }
}

TEST_CASE("sampler: both halves of a split keep the net of Sobol' points") {
    std::vector<Vec2> original, split;
    for (std::uint64_t i = 0; i < 64; ++i) {
        const IterationPoints points(Sampling::sobol, 35, i);
        Sampler a(points, 0, 3);
        Sampler b = a.split();
        original.push_back(draw(a, 3)[2]);
        split.push_back(draw(b, 3)[2]);
    }
    CHECK(is_net(original, 6));
    CHECK(is_net(split, 6));
}
