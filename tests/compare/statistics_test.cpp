#include <lightswitch/compare/statistics.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace lightswitch;
using test::relative;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Estimate with_skew(double mean, double sigma, double skew) {
    return {.mean = mean, .variance = sigma * sigma, .third = skew * sigma * sigma * sigma};
}

}  // namespace

// Expected values: SciPy 1.16 (stats.t.sf, stats.ttest_ind with equal_var=False, stats.kstat, stats.poisson.cdf).

TEST_CASE("Student's t has its tabulated quantiles") {
    CHECK(student_p(0, 7) == relative(1, 1e-5));
    CHECK(student_p(5.0, 3.7) == relative(0.009163967644893314, 1e-5));
    CHECK(student_p(-8.25, 12.5) == relative(2.08170451604855e-06, 1e-5));
    CHECK(student_p(3.3, 250) == relative(0.0011077158723040437, 1e-5));
    CHECK(student_p(1.959963985, infinite) == relative(0.05, 1e-5));
    CHECK(student_p(2.5, 1e7) == relative(student_p(2.5, infinite), 1e-5));
    for (const double freedom : {1.0, 4.5, 31.0, infinite})
        for (const double p : {0.5, 0.01, 1e-6, 1e-12})
            CHECK(student_p(student_quantile(p, freedom), freedom) == relative(p, 1e-6));
}

TEST_CASE("moments of values that come one by one") {
    Moments m;
    for (const double v : {1.0, 2.0, 4.0, 9.0}) m.add(v);
    CHECK(m.count() == 4);
    CHECK(m.mean() == 4);
    CHECK(m.variance() == relative(38.0 / 3, 1e-5));
    CHECK(m.third() == relative(60, 1e-5));
    Moments more;
    for (const double v : {3.5, 3.75, 4.25, 8.0, 10.5, 6.0}) more.add(v + 1e6);  // far from 0, nothing is lost
    CHECK(more.third() == relative(20.025, 1e-6));
    const Estimate e = Estimate::of(m);
    CHECK(e.variance == relative(38.0 / 12, 1e-5));
    CHECK(e.freedom == 3);
    CHECK(e.third == 0);  // four values do not tell a skewness
    Moments rare;
    for (int i = 0; i < 100; ++i) rare.add(i == 50 ? 1 : 0);
    CHECK(Estimate::of(rare).third ==
          relative((rare.third() - 2 * std::sqrt(0.06) * std::pow(rare.variance(), 1.5)) / 1e4, 1e-5));
}

TEST_CASE("Welch's test without skewness is SciPy's") {
    const std::vector<double> x{1, 2, 4, 9}, y{3.5, 3.75, 4.25, 8, 10.5, 6};
    Estimate a = Estimate::of(x), b = Estimate::of(y);
    a.third = b.third = 0;
    CHECK((a - b).freedom == relative(5.399818172825911, 1e-5));
    CHECK(welch_p(a, b) == relative(0.3837628002549575, 1e-5));
    b.mean += 20;
    CHECK(welch_p(a, b) == relative(8.844370643946329e-05, 1e-5));
    CHECK(welch_p(b, a) == welch_p(a, b));
    CHECK(welch_p(a, a) == 1);
    CHECK(welch_p(Estimate::exact(1), Estimate::exact(1.1)) == 0);
    CHECK(welch_p(Estimate::exact(1), Estimate::exact(1.1), 0.2) == 1);
    CHECK(welch_p(Estimate{.mean = std::nan(""), .variance = 1, .freedom = 9}, a) == 0);
    // A certain value adds no degrees of freedom.
    CHECK((Estimate::of(x) - Estimate::exact(1)).freedom == relative(3, 1e-5));
}

TEST_CASE("a sum of rare events that falls short is as improbable as Poisson's distribution says") {
    // 100 events were seen: deviation 10, skewness 1 / 10. The other side knows that 200 are expected.
    const double p = welch_p(with_skew(100, 10, 0.1), Estimate::exact(200));
    CHECK(p > 3.7236412152014045e-15);  // Poisson: 100 or fewer of 200. The bound may be larger, not smaller.
    CHECK(p < 30 * 3.7236412152014045e-15);
    // 400 of 520.
    CHECK(welch_p(with_skew(400, 20, 0.05), Estimate::exact(520)) > 2.4403434267631236e-08);
    CHECK(welch_p(with_skew(400, 20, 0.05), Estimate::exact(520)) < 30 * 2.4403434267631236e-08);
    // The side that has too much of them cannot have missed any.
    CHECK(welch_p(with_skew(100, 10, 0.1), Estimate::exact(40)) == relative(student_p(6, infinite), 1e-5));
    // Symmetric: what is positive for one is negative for the other.
    CHECK(welch_p(Estimate::exact(200), with_skew(100, 10, 0.1)) == p);
    CHECK(welch_p(Estimate::exact(-200), with_skew(-100, 10, -0.1)) == p);
}

TEST_CASE("what was never seen may still be there") {
    Estimate nothing{};
    nothing.unseen = 0.5;
    CHECK(welch_p(nothing, Estimate::exact(2)) == relative(std::exp(-4.0), 1e-5));
    CHECK(welch_p(nothing, Estimate::exact(-2)) == 0);
    const Interval interval = welch_interval(nothing, Estimate::exact(2), 1e-3);
    CHECK(interval.low == -2);
    CHECK(interval.high == relative(-2 + 0.5 * std::log(1000), 1e-5));
}

TEST_CASE("an interval holds what the test does not refuse") {
    for (const double skew : {0.0, 0.02, 0.3, 3.0})
        for (const double p : {0.01, 1e-4, 1e-9})
            for (const double freedom : {5.0, 40.0, infinite}) {
                Estimate a = with_skew(3, 0.2, skew);
                a.freedom = freedom;
                const Interval interval = welch_interval(a, Estimate::exact(0), p);
                CHECK(interval.low < 3);
                CHECK(interval.high > 3);
                CHECK(std::log(welch_p(a, Estimate::exact(interval.low))) == relative(std::log(p), 1e-3));
                CHECK(std::log(welch_p(a, Estimate::exact(interval.high))) == relative(std::log(p), 1e-3));
            }
}

// The sum of n values of which one in 200 is 1 and the others 0, against its expectation: with the correction, a
// p-value below 1e-4 may come up 20 000 x 1e-4 = 2 times; more than 12 do with probability 1e-6. The plain test is
// wrong far more often, which shows that there is something to correct.
TEST_CASE("false alarms of rare events") {
    std::mt19937 engine(1);
    std::binomial_distribution<int> image(50, 0.005);
    int alarms = 0, plain = 0;
    for (int run = 0; run < 20000; ++run) {
        Moments m;
        for (int i = 0; i < 64; ++i) m.add(image(engine));
        Estimate e = Estimate::of(m);
        e.unseen = 1.0 / 64;
        alarms += welch_p(e, Estimate::exact(0.25)) < 1e-4;
        e.third = e.unseen = 0;
        plain += welch_p(e, Estimate::exact(0.25)) < 1e-4;
    }
    CHECK(alarms <= 12);
    CHECK(plain > 24);
}
