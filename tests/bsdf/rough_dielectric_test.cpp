#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/rough_dielectric.hpp>

#include "../support/relative.hpp"
#include "albedo_values.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<RoughDielectric> && transmits<RoughDielectric> && !RoughDielectric::specular);

namespace {

constexpr Facets kinds[] = {Facets::beckmann, Facets::ggx};
constexpr float etas[] = {1.5f, 1 / 1.5f, 1.1f, 2.4f};

RoughDielectric glass(Facets kind, float u, float v, float eta) {
    return {.distribution = kind, .alpha_u = u, .alpha_v = v, .eta = eta};
}

/// The direction of refraction, or of total reflection, at a smooth surface.
Vec3 refracted(const Vec3& wo, float eta) {
    return Dielectric{.eta = eta}.sample(wo, Vec3(1 - 0x1p-24f), Transport::importance)->wi;
}

}  // namespace

TEST_CASE("rough dielectric: values and densities agree with Mitsuba's") {
    const auto models = test::mitsuba_models("roughdielectric");
    CHECK(models.size() == 36);
    for (const auto& model : models)
        test::check_facets_against_mitsuba(RoughDielectric{.distribution = model.facets(),
                                                           .alpha_u = model.number("alpha_u"),
                                                           .alpha_v = model.number("alpha_v"),
                                                           .eta = model.eta(),
                                                           .reflectance = model.color("specular_reflectance"),
                                                           .transmittance = model.color("specular_transmittance")},
                                           model, 1e-4);
}

TEST_CASE("rough dielectric: sampling follows the density, which is one over the sphere") {
    std::uint32_t seed = 1;
    const double level = test::sidak(1e-6, 2 * 4 * 3 * 3 + 2 * 2 * 2 * 2 + 1);
    for (const Facets kind : kinds)
        for (const float eta : etas)
            for (const auto& [u, v] : {std::pair{0.5f, 0.5f}, std::pair{0.3f, 0.8f}, std::pair{1.0f, 1.0f}})
                for (const double cosine : {0.8, 0.1, -0.7}) {
                    CAPTURE(eta);
                    CAPTURE(u);
                    const Vec3 wo = direction(cosine);
                    // What hardly bends stays near the way straight on.
                    const test::SphereCells even, finer{.axis = -wo, .stretch = 3};
                    test::check_density_in(eta == 1.1f ? finer : even, glass(kind, u, v, eta), wo, level, seed++);
                }
    // Narrow lobes one by one, with fine cells around each.
    for (const Facets kind : kinds)
        for (const float alpha : {0.02f, 0.1f})
            for (const double cosine : {0.7, -0.9}) {
                const Vec3 wo = direction(cosine);
                const RoughDielectric b = glass(kind, alpha, alpha, 1.5f);
                test::SphereCells cells = test::cells_for(wo, double(alpha));
                test::check_density_in(cells, b, wo, level, seed++, std::copysign(1.0f, wo.z));
                cells.axis = refracted(wo, 1.5f);
                test::check_density_in(cells, b, wo, level, seed++, -std::copysign(1.0f, wo.z));
            }
    // Refraction that hardly bends spreads a tenth of what the facets do.
    const Vec3 wo = direction(0.8);
    test::check_density_in({.axis = -wo, .stretch = 4}, glass(Facets::ggx, 0.5f, 0.5f, 1.05f), wo, level, seed++, -1);
}

TEST_CASE("rough dielectric: a density without the Jacobian of refraction is found") {
    const RoughDielectric b = glass(Facets::ggx, 0.4f, 0.4f, 1.5f);
    const Vec3 wo = direction(0.6);
    const auto p_value = [&](const auto& factor) {
        return test::chi_square_sphere(
                   [&](const Vec3& u) -> std::optional<Vec3> {
                       const auto s = b.sample(wo, u, Transport::radiance);
                       return s ? std::optional(s->wi) : std::nullopt;
                   },
                   [&](const Vec3& wi) {
                       return double(b.evaluate(wo, wi, Transport::radiance).pdf.value) * (wi.z < 0 ? factor(wi) : 1);
                   },
                   {}, 200000, 1)
            .chi_square.p_value;
    };
    CHECK(p_value([](const Vec3&) { return 1.0; }) > 1e-6);
    CHECK(p_value([&](const Vec3& wi) { return double(length_squared(wo + 1.5f * wi)); }) < 1e-12);
}

TEST_CASE("rough dielectric: returns as much light as the formulas say") {
    for (const test::Albedo& row : test::albedo_values()) {
        if (row.eta == 0) continue;
        CAPTURE(row.eta);
        CAPTURE(row.alpha_u);
        CAPTURE(row.wo.z);
        const RoughDielectric b = glass(row.facets, row.alpha_u, row.alpha_v, row.eta);
        // From behind the other index does the same.
        RoughDielectric other = b;
        other.eta = 1 / row.eta;
        for (const auto& [bsdf, wo] : {std::pair(b, row.wo), std::pair(other, Vec3(row.wo.x, row.wo.y, -row.wo.z))}) {
            const test::Returned sampled = test::returned_light(bsdf, wo, Transport::importance, 21);
            CHECK(std::abs(sampled.reflected - row.reflected) < 6 * sampled.reflected_error + 1e-4);
            CHECK(std::abs(sampled.transmitted - row.transmitted) < 6 * sampled.transmitted_error + 1e-4);
            CHECK(sampled.reflected + sampled.transmitted <= 1 + 1e-6);
        }
    }
}

TEST_CASE("rough dielectric: the albedo by sampling is that of evaluate") {
    std::uint32_t seed = 31;
    for (const Facets kind : kinds)
        for (const float eta : {1.5f, 1 / 1.5f})
            for (const double cosine : {0.9, 0.2, -0.5})
                for (const Transport transport : {Transport::radiance, Transport::importance}) {
                    // Seen from the denser side, radiance is larger by eta^2 than the power that comes with it.
                    RoughDielectric b = glass(kind, 0.4f, 0.6f, eta);
                    b.transmittance = Rgb(1 / 2.25f);
                    CAPTURE(eta);
                    test::check_albedo(b, direction(cosine), 1, seed++, transport);
                }
}

TEST_CASE("rough dielectric: a sample's weight and density are those of evaluate") {
    for (const Facets kind : kinds)
        for (const float eta : etas)
            for (const double cosine : {0.99, 0.5, 0.1, -0.8, -0.3}) {
                CAPTURE(eta);
                for (const auto& [u, v] : {std::pair{0.1f, 0.1f}, std::pair{0.2f, 0.7f}, std::pair{1.0f, 1.0f}})
                    test::check_sample_agrees_with_evaluate(glass(kind, u, v, eta), direction(cosine), 1e-3, 5e-3);
                // As for metal: the half vector is known to a few units of roundoff, which count in units of alpha.
                test::check_sample_agrees_with_evaluate(glass(kind, 0.01f, 0.01f, eta), direction(cosine), 1e-3, 2e-2);
            }
}

TEST_CASE("rough dielectric: radiance one way is importance the other way, and eta^2 apart") {
    for (const Facets kind : kinds)
        for (const float eta : etas)
            for (const auto& [u, v] : {std::pair{0.1f, 0.6f}, std::pair{1.0f, 1.0f}}) {
                RoughDielectric b = glass(kind, u, v, eta);
                b.reflectance = {0.9f, 0.8f, 0.7f};
                b.transmittance = {0.3f, 0.4f, 0.5f};
                CAPTURE(eta);
                test::check_adjoint(b);
                test::Random random(12);
                for (int i = 0; i < 1000; ++i) {
                    const Vec3 a = uniform_sphere(random.next_2d()), c = uniform_sphere(random.next_2d());
                    const BsdfValue radiance = b.evaluate(a, c, Transport::radiance),
                                    importance = b.evaluate(a, c, Transport::importance);
                    const double relative_eta = a.z * c.z > 0 ? 1 : double(a.z > 0 ? eta : 1 / eta);
                    REQUIRE(double(importance.value.y) ==
                            relative(double(radiance.value.y) * relative_eta * relative_eta, 1e-5));
                    REQUIRE(importance.pdf.value == radiance.pdf.value);
                    // No light without a chance.
                    REQUIRE((radiance.value.y > 0) == (radiance.pdf.value > 0));
                }
            }
}

TEST_CASE("rough dielectric: goes over to the smooth one") {
    for (const Facets kind : kinds)
        for (const float eta : etas)
            for (const double cosine : {0.95, 0.5, -0.95, -0.2}) {
                const Vec3 wo = direction(cosine);
                const FresnelDielectric fresnel = fresnel_dielectric(wo.z, eta);
                CAPTURE(eta);
                CAPTURE(cosine);
                double before = infinity;
                for (const float alpha : {0.01f, 0.001f, 1e-4f, 1e-6f}) {
                    const test::Returned sampled =
                        test::returned_light(glass(kind, alpha, alpha, eta), wo, Transport::importance, 5);
                    const double least = std::max(double(alpha), 1e-4);
                    CHECK(std::abs(sampled.reflected - double(fresnel.reflectance)) <
                          6 * sampled.reflected_error + 2 * least);
                    CHECK(sampled.reflected + sampled.transmitted == relative(1, 3 * least));
                    const auto deviation = [](const DVec3& mean, const Vec3& smooth) {
                        return glm::length(glm::normalize(mean) - DVec3(smooth));
                    };
                    double off = 0;
                    if (sampled.reflected > 0.01) off = deviation(sampled.mean_reflected, test::mirrored(wo));
                    if (fresnel.cos_t != 0)
                        off = std::max(off, deviation(sampled.mean_transmitted, refracted(wo, eta)));
                    CHECK(off < 2 * least);
                    CHECK(off <= before + 1e-6);
                    before = off;
                }
            }
}

TEST_CASE("rough dielectric: index 1 reflects nothing, and light goes straight on") {
    for (const Facets kind : kinds)
        for (const auto& [u, v] : {std::pair{1e-4f, 1e-4f}, std::pair{0.2f, 0.5f}, std::pair{1.0f, 1.0f}})
            for (const double cosine : {1.0, 0.5, 0.01, -0.7}) {
                const Vec3 wo = direction(cosine), above(wo.x, wo.y, std::abs(wo.z));
                const RoughDielectric b = glass(kind, u, v, 1);
                const auto s = b.sample(wo, Vec3(0, 0.3f, 0), Transport::radiance);
                REQUIRE(s);
                CHECK(s->specular);
                CHECK(s->wi == -wo);
                CHECK(s->eta == 1);
                CHECK(s->weight.x == Microfacets(kind, u, v).masking(above));
                CHECK(b.evaluate(wo, s->wi, Transport::radiance).pdf.value == 0);
                CHECK(b.evaluate(wo, direction(cosine, 2), Transport::radiance).pdf.value == 0);
                CHECK(b.evaluate(wo, -direction(cosine, 0.75), Transport::radiance).pdf.value == 0);
                // The neighbours of 1 are no other surface. At grazing angles they bend light by the root of what
                // they differ from 1.
                for (const float eta : {1 - 0x1p-24f, 1 + 0x1p-23f, 1.00001f}) {
                    test::Random random(6);
                    double bend = 0, weight = 0;
                    for (int i = 0; i < 1000; ++i) {
                        const auto near = glass(kind, u, v, eta).sample(wo, random.next_3d(), Transport::radiance);
                        if (!near || near->wi.z * wo.z > 0) continue;
                        bend = std::max(bend, double(glm::length(near->wi + wo)));
                        weight = std::max(weight, std::abs(double(near->weight.x / s->weight.x) - 1));
                    }
                    const double difference = std::abs(double(eta) - 1);
                    CAPTURE(eta);
                    CAPTURE(cosine);
                    CAPTURE(bend);
                    CHECK(bend < 3 * std::sqrt(difference));
                    if (std::abs(cosine) > 0.3) CHECK(weight < 20 * std::sqrt(difference));
                }
            }
}

TEST_CASE("rough dielectric: extremes") {
    for (const Facets kind : kinds)
        for (const auto& [u, v] :
             {std::pair{1e-6f, 1e-6f}, std::pair{1e-4f, 1.0f}, std::pair{0.1f, 0.1f}, std::pair{1.0f, 1.0f}})
            for (const float eta : {1.5f, 1.0f, 1 - 0x1p-24f, 1 + 0x1p-23f, 1e3f}) {
                CAPTURE(u);
                CAPTURE(eta);
                const float larger = std::max(eta, 1 / eta);
                test::check_extremes(glass(kind, u, v, eta), larger * larger);
            }
}

TEST_CASE("rough dielectric: impossible parameters are explained") {
    CHECK(RoughDielectric{}.problem() == "");
    for (const float alpha : {0.0f, -0.1f, 1.1f, infinity, NAN}) {
        CHECK(RoughDielectric{.alpha_u = alpha}.problem().find("alpha_u is") == 0);
        CHECK(RoughDielectric{.alpha_v = alpha}.problem().find("alpha_v is") == 0);
    }
    for (const float eta : {0.0f, -1.5f, infinity, NAN})
        CHECK(RoughDielectric{.eta = eta}.problem().find("eta is") == 0);
    CHECK(RoughDielectric{.reflectance = Rgb(0, 0, 1.1f)}.problem().find("specular_reflectance has") == 0);
    CHECK(RoughDielectric{.transmittance = Rgb(-1, 0, 0)}.problem().find("specular_transmittance has") == 0);
}

TEST_CASE("rough dielectric: Phong terms") {
    CHECK(RoughDielectric{.alpha_u = 0.1f, .alpha_v = 0.1f}.phong().shininess == relative(198, 1e-5));
    CHECK(RoughDielectric{.alpha_u = 1e-4f, .alpha_v = 1e-4f}.phong().shininess == Dielectric{}.phong().shininess);
    CHECK(RoughDielectric{.reflectance = Rgb(0.5f)}.phong().specular == Rgb(0.25f));
}
