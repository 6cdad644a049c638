#pragma once

// Pearson's chi-square test: do samples follow the density that claims to describe them?

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <ostream>
#include <random>
#include <stdexcept>
#include <vector>

namespace lightswitch::test {

/// Uniform numbers in [0, 1) with 24 bits, as a renderer's sampler gives them.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float next() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    Vec2 next_2d() {
        const float x = next();
        return {x, next()};
    }
    Vec3 next_3d() {
        const Vec2 xy = next_2d();
        return {xy.x, xy.y, next()};
    }

private:
    std::mt19937 engine_;
};

/// Regularised upper incomplete gamma function Q(a, x): its series below a + 1, Lentz's continued fraction above
/// (Numerical Recipes, section 6.2).
inline double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 100000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * h;
}

/// The level of each of `tests` independent tests at which all together give a false alarm with probability `total`
/// (Sidak).
inline double sidak(double total, int tests) { return -std::expm1(std::log1p(-total) / tests); }

struct ChiSquare {
    double statistic = 0;
    int degrees_of_freedom = 0;
    double p_value = 1;  ///< probability of a statistic at least as large when the density is right

    friend std::ostream& operator<<(std::ostream& out, const ChiSquare& r) {
        return out << "chi-square " << r.statistic << " with " << r.degrees_of_freedom
                   << " degrees of freedom, p = " << r.p_value;
    }
};

/// Compares counts with their expectations, which have the same sum. Cells are pooled from the rarest upwards until
/// each pool expects `minimum`: 25 keeps the far tail of Pearson's approximation honest at the small levels used here.
inline ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected,
                            double minimum = 25) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return expected[i] < expected[j]; });
    ChiSquare result;
    int pools = 0;
    double e = 0, o = 0, remaining = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (std::size_t n = 0; n < order.size(); ++n) {
        e += expected[order[n]];
        o += observed[order[n]];
        remaining -= expected[order[n]];
        const bool last = n + 1 == order.size();
        if (!last && (e < minimum || remaining < minimum)) continue;
        result.statistic += (o - e) * (o - e) / e;
        ++pools;
        e = o = 0;
    }
    result.degrees_of_freedom = pools - 1;
    if (pools < 2) throw std::logic_error("chi-square: fewer than two cells hold enough samples");
    result.p_value = gamma_q(0.5 * result.degrees_of_freedom, 0.5 * result.statistic);
    return result;
}

/// Integral of `f` over a rectangle: Gauss's 3 x 3 points, halved in both axes at least twice, then until that changes
/// less than `tolerance` (absolute) or `depth` is used up. A rectangle of which some corners have `f` = 0 and others do
/// not is always halved: there `f` may jump, as densities do at the horizon, beside all of Gauss's points.
template <class F>
double integrate(const F& f, DVec2 low, DVec2 high, double tolerance, int depth = 5) {
    const auto gauss = [&f](const DVec2& a, const DVec2& b) {
        constexpr double node = 0.77459666924148337704, weights[3] = {5. / 18, 8. / 18, 5. / 18};
        const DVec2 center = 0.5 * (a + b), half = 0.5 * (b - a);
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                sum +=
                    weights[i] * weights[j] * f(center.x + (i - 1) * node * half.x, center.y + (j - 1) * node * half.y);
        return sum * (b.x - a.x) * (b.y - a.y);
    };
    const auto refine = [&](const auto& self, const DVec2& a, const DVec2& b, double whole, double limit,
                            int left) -> double {
        const DVec2 c = 0.5 * (a + b);
        const DVec2 lows[4] = {a, {c.x, a.y}, {a.x, c.y}, c}, highs[4] = {c, {b.x, c.y}, {c.x, b.y}, b};
        double parts[4], sum = 0;
        for (int i = 0; i < 4; ++i) sum += parts[i] = gauss(lows[i], highs[i]);
        const int zeros = (f(a.x, a.y) == 0) + (f(b.x, a.y) == 0) + (f(a.x, b.y) == 0) + (f(b.x, b.y) == 0);
        const bool smooth = left < depth && (zeros == 0 || zeros == 4);
        if (left <= 0 || (smooth && std::abs(sum - whole) < limit)) return sum;
        sum = 0;
        for (int i = 0; i < 4; ++i) sum += self(self, lows[i], highs[i], parts[i], 0.5 * limit, left - 1);
        return sum;
    };
    return refine(refine, low, high, gauss(low, high), tolerance, depth);
}

/// How the sphere is cut into cells: rings around `axis` and sectors. Ring edges are at 1 - cos(theta) = 2 q^stretch
/// for equidistant q: 1 makes all cells equal, more makes them finer around the axis, for narrow lobes.
struct SphereCells {
    Vec3 axis{0, 0, 1};
    double stretch = 1;
    int rings = 20, sectors = 24;

    Vec3 direction(double q, double phi) const {
        const double lift = 2 * std::pow(q, stretch), r = std::sqrt(lift * (2 - lift));
        const DVec3 local(r * std::cos(phi), r * std::sin(phi), 1 - lift);
        const Basis basis(axis);
        return Vec3(local.x * DVec3(basis.tangent) + local.y * DVec3(basis.bitangent) + local.z * DVec3(basis.normal));
    }
    /// Of solid angle to (q, phi). Never 0, which would look like the edge of the density.
    double jacobian(double q) const { return 2 * stretch * std::pow(std::max(q, 1e-9), stretch - 1); }

    std::size_t index(const Vec3& w) const {
        const Basis basis(axis);
        const DVec3 d(w), difference = d - DVec3(axis);
        // |w - axis|^2 / 2 is 1 - cos(theta) without cancellation.
        const double lift = 0.5 * glm::dot(difference, difference);
        const double phi = std::atan2(glm::dot(d, DVec3(basis.bitangent)), glm::dot(d, DVec3(basis.tangent)));
        const int ring = std::clamp(static_cast<int>(std::pow(0.5 * lift, 1 / stretch) * rings), 0, rings - 1);
        const int sector = std::clamp(
            static_cast<int>((phi / (2 * 3.14159265358979323846) + (phi < 0 ? 1 : 0)) * sectors), 0, sectors - 1);
        return static_cast<std::size_t>(ring * sectors + sector);
    }

    /// Integral over each cell of `f(direction)` with respect to solid angle.
    template <class F>
    std::vector<double> integrals(const F& f) const {
        std::vector<double> cells;
        const double step = 2 * 3.14159265358979323846 / sectors;
        for (int ring = 0; ring < rings; ++ring)
            for (int sector = 0; sector < sectors; ++sector)
                cells.push_back(integrate([&](double q, double phi) { return jacobian(q) * f(direction(q, phi)); },
                                          {static_cast<double>(ring) / rings, sector * step},
                                          {(ring + 1.0) / rings, (sector + 1) * step}, 1e-6));
        return cells;
    }
};

struct SphereTest {
    ChiSquare chi_square;
    double integral = 0;  ///< of the density, over the sphere
};

/// Tests that directions from `sample(u)` (an optional unit vector for uniform `u` in the unit cube) follow
/// `pdf(direction)` per solid angle. What `sample` refuses counts in one cell more, which expects what the density
/// lacks to 1.
template <class Sample, class Pdf>
SphereTest chi_square_sphere(const Sample& sample, const Pdf& pdf, const SphereCells& cells, int samples,
                             std::uint32_t seed) {
    std::vector<double> expected = cells.integrals(pdf);
    const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
    expected.push_back(std::max(0.0, 1 - integral));
    for (double& e : expected) e *= samples / std::max(1.0, integral);
    std::vector<double> observed(expected.size());
    Random random(seed);
    for (int i = 0; i < samples; ++i) {
        const auto w = sample(random.next_3d());
        observed[w ? cells.index(*w) : observed.size() - 1] += 1;
    }
    return {chi_square(observed, expected), integral};
}

}  // namespace lightswitch::test
