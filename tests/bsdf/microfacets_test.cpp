#include <lightswitch/bsdf/microfacets.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

namespace {

constexpr Facets kinds[] = {Facets::beckmann, Facets::ggx};
constexpr float alphas[][2] = {{0.3f, 0.3f}, {0.1f, 0.5f}, {1, 0.4f}, {1, 1}};
constexpr double cosines[] = {1, 0.999, 0.85, 0.4, 0.1, 0.01, 1e-4};

/// D as Walter et al. write it (2007, equations 25 and 33), in double precision, for a unit vector.
double textbook_distribution(Facets facets, double u, double v, const DVec3& m) {
    const double cosine = m.z, tangents = (m.x * m.x / (u * u) + m.y * m.y / (v * v)) / (cosine * cosine);
    const double front = 1 / (std::acos(-1.0) * u * v * std::pow(cosine, 4));
    return front * (facets == Facets::ggx ? 1 / ((1 + tangents) * (1 + tangents)) : std::exp(-tangents));
}

/// G1 likewise (equations 23 and 34).
double textbook_masking(Facets facets, double u, double v, const DVec3& w) {
    const double tangent = std::hypot(u * w.x, v * w.y) / w.z;
    if (facets == Facets::ggx) return 2 / (1 + std::sqrt(1 + tangent * tangent));
    const double a = 1 / tangent;
    return 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(std::acos(-1.0))));
}

/// A direction within a few roughnesses of the normal: where there are facets.
Vec3 facet(test::Random& random, float u, float v) {
    const float reach = 4 * random.next(), turn = 6.28f * random.next();
    return normalize(Vec3(u * reach * std::cos(turn), v * reach * std::sin(turn), 1));
}

}  // namespace

TEST_CASE("microfacets: distribution and masking are the textbook's") {
    test::Random random(1);
    for (const Facets kind : kinds)
        for (int i = 0; i < 20000; ++i) {
            const auto roughness = [&] { return std::pow(10.0f, -4 * random.next()); };
            const float u = roughness(), v = i % 3 == 0 ? u : roughness();
            const Microfacets facets(kind, u, v);
            const Vec3 m = facet(random, u, v);
            const double d = textbook_distribution(kind, double(u), double(v), glm::normalize(DVec3(m)));
            // An exponent of 16 is known to 16 units of roundoff, and some more.
            REQUIRE(facets.distribution(m) == relative(d, 1e-5));
            REQUIRE(facets.distribution(m * (1e-3f + random.next())) == relative(d, 1e-5));
            const double cosine = std::pow(10.0, -6 * double(random.next()));
            const Vec3 w = direction(cosine, 6.28 * double(random.next()));
            REQUIRE(facets.masking(w) == relative(textbook_masking(kind, double(u), double(v), DVec3(w)), 2e-6));
        }
}

TEST_CASE("microfacets: masking where a cosine or a sine vanishes") {
    for (const Facets kind : kinds) {
        const Microfacets facets(kind, 0.2f, 0.5f);
        CHECK(facets.masking(Vec3(0, 0, 1)) == 1);
        CHECK(facets.masking(Vec3(1, 0, 0)) == 0);
        // Beckmann 1 / sqrt(pi), GGX 1 times the roughness in that direction, plus z.
        const double share = kind == Facets::ggx ? 1 : 1 / std::sqrt(std::acos(-1.0));
        CHECK(facets.smith_denominator(Vec3(1, 0, 0)) == relative(0.2 * share, 1e-6));
        CHECK(facets.smith_denominator(Vec3(0, 1, 0)) == relative(0.5 * share, 1e-6));
        CHECK(facets.masking(direction(1e-6, 0)) == relative(2e-6 / (0.2 * share), 1e-4));
        CHECK(facets.distribution(Vec3(1, 0, 0)) ==
              (kind == Facets::ggx ? relative(0.2 * 0.2 * 0.2 * 0.2 / std::acos(-1.0) / 0.1, 1e-5) : relative(0, 0)));
    }
}

TEST_CASE("microfacets: below 1e-4 roughness acts as 1e-4") {
    for (const Facets kind : kinds) {
        const Microfacets least(kind, 1e-4f, 1e-4f), less(kind, 1e-9f, 0);
        CHECK(less.distribution(Vec3(1e-4f, 0, 1)) == least.distribution(Vec3(1e-4f, 0, 1)));
        CHECK(less.masking(direction(1e-4)) == least.masking(direction(1e-4)));
    }
}

TEST_CASE("microfacets: visible normals follow their density, which is one") {
    std::uint32_t seed = 1;
    const double level = test::sidak(1e-6, 2 * 4 * 7);
    for (const Facets kind : kinds)
        for (const auto& [u, v] : alphas)
            for (const double cosine : cosines) {
                CAPTURE(u);
                CAPTURE(cosine);
                const Microfacets facets(kind, u, v);
                const Vec3 wo = direction(cosine);
                const auto result = test::chi_square_sphere(
                    [&](const Vec3& x) {
                        const Vec3 m = normalize(facets.sample_visible_normal(wo, Vec2(x)));
                        return dot(m, wo) > 0 ? std::optional(m) : std::nullopt;
                    },
                    [&](const Vec3& m) { return m.z > 0 ? double(facets.visible_pdf(wo, m)) : 0; },
                    {.stretch = u < 0.5f ? 2.0 : 1.0}, 200000, seed++);
                CAPTURE(result.chi_square);
                CHECK(result.chi_square.p_value > level);
                CHECK(result.chi_square.degrees_of_freedom > 50);
                CHECK(result.integral == relative(1, 1e-3));
            }
}

TEST_CASE("microfacets: stretching to the least roughness samples the same slopes") {
    // Visible slopes depend on direction and roughness through their products alone: what holds at roughness 1 holds.
    for (const Facets kind : kinds)
        for (const float alpha : {1e-4f, 1e-3f, 0.1f}) {
            test::Random random(3);
            double worst = 0;
            for (int i = 0; i < 100000; ++i) {
                const Vec3 w = cosine_hemisphere(random.next_2d());
                const Vec2 u = random.next_2d();
                const Vec3 smooth = normalize(Vec3(w.x, w.y, alpha * w.z));
                const Vec3 a = Microfacets(kind, 1, 1).sample_visible_normal(w, u),
                           b = Microfacets(kind, alpha, alpha).sample_visible_normal(smooth, u);
                const Vec2 difference = Vec2(b) / (alpha * b.z) - Vec2(a) / a.z;
                const double size = 1 + double(std::hypot(a.x, a.y) / a.z);
                worst = std::max(worst, double(std::hypot(difference.x, difference.y)) / (size * size));
            }
            // Where the density ends, a rounding of u moves the slope by the square root of it.
            CHECK(worst < 2e-3);
        }
}

TEST_CASE("microfacets: extreme directions and numbers give normals that face the direction") {
    constexpr float extreme[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
    test::Random random(4);
    for (const Facets kind : kinds)
        for (const float u : {1e-4f, 0.01f, 1.0f})
            for (const float v : {1e-4f, 0.3f}) {
                const Microfacets facets(kind, u, v);
                int bad = 0, away = 0;
                for (int i = 0; i < 100000; ++i) {
                    const Vec3 w = direction(std::pow(10.0, -7 * double(random.next())), 6.28 * double(random.next()));
                    Vec2 x = random.next_2d();
                    for (int c = 0; c < 2; ++c)
                        if (random.next() < 0.4f) x[c] = extreme[static_cast<int>(4 * random.next())];
                    const Vec3 m = facets.sample_visible_normal(w, x);
                    bad += is_finite(m) && m.z > 0 && is_finite(facets.distribution(m)) && facets.distribution(m) > 0 &&
                                   is_finite(facets.visible_pdf(w, normalize(m)))
                               ? 0
                               : 1;
                    away += dot(m, w) > 0 ? 0 : 1;
                }
                CAPTURE(u);
                CAPTURE(v);
                CHECK(bad == 0);
                CHECK(away < 1000);  // only by rounding, at the end of the density
            }
}

TEST_CASE("microfacets: the map from numbers to Beckmann's normals is continuous and monotone") {
    for (const double cosine : {1.0, 0.9, 0.3, 0.01, 1e-5}) {
        const Microfacets facets(Facets::beckmann, 0.5f, 0.5f);
        const Vec3 wo = direction(cosine, 0);
        float before = infinity;
        int backward = 0, jumps = 0;
        for (int i = 0; i < 100000; ++i) {
            const Vec3 m = facets.sample_visible_normal(wo, {(float(i) + 0.5f) / 100000, 0.5f});
            // From the far tail, which leans towards wo, to facets that are seen edge-on.
            backward += m.x > before + 1e-4f ? 1 : 0;
            jumps += i > 0 && m.x < before - 0.2f ? 1 : 0;
            before = m.x;
        }
        CHECK(backward == 0);
        CHECK(jumps == 0);
    }
}
