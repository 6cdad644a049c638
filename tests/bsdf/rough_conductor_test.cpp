#include <lightswitch/bsdf/rough_conductor.hpp>

#include "../support/relative.hpp"
#include "albedo_values.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<RoughConductor>);

namespace {

RoughConductor metal(Facets kind, float u, float v) {
    return {.distribution = kind,
            .alpha_u = u,
            .alpha_v = v,
            .eta = {0.2f, 0.92f, 1.1f},
            .k = {3.9f, 2.45f, 2.14f},
            .reflectance = {0.9f, 0.8f, 0.7f}};
}
RoughConductor metal(float alpha, Facets kind = Facets::ggx) { return metal(kind, alpha, alpha); }

constexpr Facets kinds[] = {Facets::beckmann, Facets::ggx};
constexpr float alphas[] = {0.02f, 0.1f, 0.3f, 1};
constexpr double cosines[] = {1, 0.85, 0.4, 0.1, 0.01};
const double level = test::sidak(1e-6, 2 * (4 * 5 + 2 + 3 * 3));

}  // namespace

TEST_CASE("rough conductor: values and densities agree with Mitsuba's") {
    const auto models = test::mitsuba_models("roughconductor");
    CHECK(models.size() == 12);
    for (const auto& model : models)
        test::check_facets_against_mitsuba(RoughConductor{.distribution = model.facets(),
                                                          .alpha_u = model.number("alpha_u"),
                                                          .alpha_v = model.number("alpha_v"),
                                                          .eta = model.color("eta"),
                                                          .k = model.color("k"),
                                                          .reflectance = model.color("specular_reflectance")},
                                           model, 1e-4);
}

TEST_CASE("rough conductor: sampling follows the density") {
    std::uint32_t seed = 1;
    for (const Facets kind : kinds) {
        for (const float alpha : alphas)
            for (const double cosine : cosines)
                // Gaussian slopes need finer cells than those with tails.
                test::check_density(metal(alpha, kind), direction(cosine),
                                    (kind == Facets::ggx ? 1 : 0.8) * double(alpha), level, seed++);
        test::check_density(metal(0.001f, kind), direction(1), 0.001, level, seed++);
        test::check_density(metal(0.001f, kind), direction(0.5), 0.001, level, seed++);
        for (const auto& [u, v] : {std::pair{0.1f, 0.4f}, std::pair{0.5f, 0.2f}, std::pair{1.0f, 0.3f}})
            for (const double cosine : {0.95, 0.4, 0.05})
                test::check_density(metal(kind, u, v), direction(cosine), 0.25, level, seed++);
    }
}

TEST_CASE("rough conductor: a density without the Jacobian of reflection, or without masking, is found") {
    const RoughConductor m = metal(0.3f);
    const Vec3 wo = direction(0.4);
    const auto sample = [&](const Vec3& u) -> std::optional<Vec3> {
        const auto s = m.sample(wo, u, Transport::radiance);
        return s ? std::optional(s->wi) : std::nullopt;
    };
    const auto p_value = [&](const auto& factor) {
        const auto pdf = [&](const Vec3& wi) {
            return double(m.evaluate(wo, wi, Transport::radiance).pdf.value) * factor(normalize(wo + wi));
        };
        return test::chi_square_sphere(sample, pdf, test::cells_for(wo, 0.3), 200000, 1).chi_square.p_value;
    };
    CHECK(p_value([](const Vec3&) { return 1.0; }) > 1e-6);
    CHECK(p_value([&](const Vec3& half) { return 4 * double(dot(wo, half)); }) < 1e-12);
    CHECK(p_value([&](const Vec3&) { return 1 / double(Microfacets(Facets::ggx, 0.3f, 0.3f).masking(wo)); }) < 1e-12);
}

TEST_CASE("rough conductor: energy") {
    std::uint32_t seed = 201;
    for (const float alpha : alphas)
        for (const double cosine : cosines) {
            test::check_albedo(metal(alpha), direction(cosine), double(alpha), seed++);
            // The ideal metal loses what single scattering loses: little when smooth; for alpha 1, where D is constant,
            // the albedo is an integral with the closed form 2 (1 - ln 2) / (1 + cos).
            const double white =
                test::check_albedo(RoughConductor{.distribution = Facets::ggx, .alpha_u = alpha, .alpha_v = alpha},
                                   direction(cosine), double(alpha), seed++);
            if (alpha == 1) CHECK(white == relative(2 * (1 - std::log(2.0)) / (1 + cosine), 0.015));
            if (alpha < 0.05f && cosine > 0.3) CHECK(white > 0.995);
        }
}

TEST_CASE("rough conductor: returns as much light as the formulas say") {
    for (const test::Albedo& row : test::albedo_values()) {
        if (row.eta != 0) continue;
        CAPTURE(row.alpha_u);
        CAPTURE(row.wo.z);
        const RoughConductor mirror{.distribution = row.facets, .alpha_u = row.alpha_u, .alpha_v = row.alpha_v};
        const test::Returned sampled = test::returned_light(mirror, row.wo, Transport::radiance, 21);
        CHECK(std::abs(sampled.reflected - row.reflected) < 6 * sampled.reflected_error + 1e-4);
        CHECK(sampled.transmitted == 0);
        if (std::max(row.alpha_u, row.alpha_v) > 0.25f) test::check_albedo(mirror, row.wo, 1, 22);
    }
}

TEST_CASE("rough conductor: a sample's weight and density are those of evaluate, down to the smoothest") {
    for (const Facets kind : kinds) {
        for (const float alpha : alphas)
            for (const double cosine : cosines)
                test::check_sample_agrees_with_evaluate(metal(alpha, kind), direction(cosine), 1e-4, 2e-3);
        test::check_sample_agrees_with_evaluate(metal(kind, 0.1f, 0.8f), direction(0.3), 1e-4, 2e-3);
        // The half vector is known to a few units of roundoff, which count in units of alpha.
        test::check_sample_agrees_with_evaluate(metal(0.005f, kind), direction(0.7), 1e-4, 1e-3);
        test::check_sample_agrees_with_evaluate(metal(0.001f, kind), direction(0.7), 1e-4, 5e-3);
        test::check_sample_agrees_with_evaluate(metal(0.0001f, kind), direction(0.7), 1e-4, 5e-2);
    }
}

TEST_CASE("rough conductor: reciprocity") {
    for (const Facets kind : kinds) {
        for (const float alpha : alphas) test::check_reciprocity(metal(alpha, kind));
        test::check_reciprocity(metal(kind, 0.1f, 0.8f));
    }
}

TEST_CASE("rough conductor: approaches the mirror") {
    const Vec3 wo = direction(0.6);
    for (const Facets kind : kinds) {
        test::Random random(4);
        for (int i = 0; i < 1000; ++i) {
            const auto s = metal(0.0001f, kind).sample(wo, random.next_3d(), Transport::radiance);
            if (!s) continue;
            CHECK(s->weight.x == relative(0.9f * fresnel_conductor(0.6f, 0.2f, 3.9f), 1e-2));
        }
        for (const float alpha : {0.01f, 0.001f, 1e-4f, 1e-6f}) {
            const test::Returned sampled = test::returned_light(
                RoughConductor{.distribution = kind, .alpha_u = alpha, .alpha_v = alpha}, wo, Transport::radiance, 5);
            const double least = std::max(double(alpha), 1e-4);
            CHECK(sampled.reflected == relative(1, 2 * least));
            CHECK(glm::length(glm::normalize(sampled.mean_reflected) - DVec3(test::mirrored(wo))) < 2 * least);
        }
    }
}

TEST_CASE("rough conductor: stretched along x, the highlight is long in x") {
    // A facet of the slope s is as frequent along x as one of s / 4 along y.
    const Vec3 wo(0, 0, 1);
    for (const Facets kind : kinds) {
        const RoughConductor brushed = metal(kind, 0.4f, 0.1f);
        const auto value = [&](const Vec3& m) {
            const Vec3 unit = normalize(m);
            return double(brushed.evaluate(wo, 2 * unit.z * unit - wo, Transport::radiance).pdf.value) /
                   double(square(square(unit.z)));
        };
        CHECK(value(Vec3(0.2f, 0, 1)) > 2 * value(Vec3(0, 0.2f, 1)));
    }
}

TEST_CASE("rough conductor: extremes") {
    for (const Facets kind : kinds) {
        for (const float alpha : {1e-6f, 1e-4f, 0.005f, 0.1f, 1.0f}) {
            CAPTURE(alpha);
            test::check_extremes(RoughConductor{.distribution = kind, .alpha_u = alpha, .alpha_v = alpha});
        }
        test::check_extremes(RoughConductor{.distribution = kind, .alpha_u = 1e-4f, .alpha_v = 1});
    }
}

TEST_CASE("rough conductor: impossible parameters are explained") {
    CHECK(metal(1).problem() == "");
    for (const float alpha : {0.0f, -0.1f, 1.1f, infinity, NAN}) {
        CHECK(metal(Facets::ggx, alpha, 0.1f).problem().find("alpha_u is") == 0);
        CHECK(metal(Facets::ggx, 0.1f, alpha).problem().find("alpha_v is") == 0);
    }
    CHECK(RoughConductor{.k = Rgb(1, 1, -0.5f)}.problem().find("k has a component of -0.5") == 0);
    CHECK(RoughConductor{.eta = Rgb(1, 1, NAN)}.problem().find("eta has") == 0);
    CHECK(RoughConductor{.k = Rgb(infinity)}.problem().find("k has") == 0);
    CHECK(RoughConductor{.eta = Rgb(1, 0, 1), .k = Rgb(1, 0, 1)}.problem().find("both 0") != std::string::npos);
    CHECK(RoughConductor{.reflectance = Rgb(NAN)}.problem().find("specular_reflectance has") == 0);
}

TEST_CASE("rough conductor: Phong terms") {
    CHECK(metal(0.1f).phong().shininess == relative(198, 1e-5));
    CHECK(metal(1).phong().shininess == 1);
    CHECK(metal(0.0001f).phong().shininess == 1000);
    CHECK(RoughConductor{}.phong().specular == Rgb(1));
}
