#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/thin_dielectric.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::mirrored;
using test::relative;

static_assert(Bsdf<Conductor> && Bsdf<Dielectric> && Bsdf<ThinDielectric>);
static_assert(Conductor::specular && Dielectric::specular && ThinDielectric::specular);
static_assert(transmits<Dielectric> && transmits<ThinDielectric> && !transmits<Conductor>);

namespace {
const Conductor silver{.eta = {0.155f, 0.117f, 0.138f}, .k = {4.83f, 3.12f, 2.15f}, .reflectance = {0.9f, 0.8f, 0.7f}};
constexpr Vec3 refract_u{1 - 0x1p-24f, 0.5f, 0.5f};
}  // namespace

TEST_CASE("conductor: mirror direction, Fresnel's weight, front only") {
    for (const double cosine : {1.0, 0.5, 0.01, 1e-7}) {
        const Vec3 wo = direction(cosine);
        const auto s = silver.sample(wo, Vec3(0.5f), Transport::importance);
        REQUIRE(s);
        CHECK(s->wi == mirrored(wo));
        CHECK(s->specular);
        CHECK(s->pdf.value == 0);
        CHECK(s->eta == 1);
        for (int c = 0; c < 3; ++c)
            CHECK(s->weight[c] ==
                  relative(silver.reflectance[c] * fresnel_conductor(wo.z, silver.eta[c], silver.k[c]), 1e-5));
        CHECK(is_black(silver.evaluate(wo, s->wi, Transport::radiance).value));
        CHECK_FALSE(silver.sample(direction(-cosine), Vec3(0.5f), Transport::radiance));
    }
    CHECK(Conductor{}.sample(direction(0.3), Vec3(0.5f), Transport::radiance)->weight == Rgb(1));
    CHECK_FALSE(silver.sample(Vec3(1, 0, 0), Vec3(0.5f), Transport::radiance));
}

TEST_CASE("dielectric: Snell's law from both sides, for eta above and below 1") {
    for (const float eta : {1.0f, 1.33f, 1.5f, 2.4f, 1 / 1.5f, 0.4f})
        for (const double cosine : {1.0, 0.99, 0.9, 0.6, 0.1, 1e-3, -1.0, -0.99, -0.9, -0.6, -0.1, -1e-3}) {
            CAPTURE(eta);
            CAPTURE(cosine);
            const Vec3 wo = direction(cosine);
            const Dielectric glass{.eta = eta};
            const float index = cosine > 0 ? eta : 1 / eta;
            const auto s = glass.sample(wo, refract_u, Transport::importance);
            REQUIRE(s);
            CHECK(s->specular);
            const double sine = std::sqrt((1 - cosine) * (1 + cosine)) / double(index);
            if (sine > 1) {  // total internal reflection
                CHECK(s->wi == mirrored(wo));
                CHECK(s->weight == Rgb(1));
                CHECK(s->eta == 1);
                continue;
            }
            CHECK(s->eta == relative(index, 1e-5));
            CHECK(s->wi.z * wo.z < 0);
            CHECK(std::hypot(s->wi.x, s->wi.y) == relative(sine, 1e-5));
            CHECK(std::abs(s->wi.x * wo.y - s->wi.y * wo.x) < 1e-6f);  // in the plane of incidence
            CHECK(s->wi.x * wo.x + s->wi.y * wo.y <= 0);               // on the other side of the normal
            CHECK(length_squared(s->wi) == relative(1, 1e-6));
            // The way back: same path, reciprocal eta.
            if (std::abs(s->wi.z) > 0.01f && std::abs(cosine) > 0.01) {
                const auto back = glass.sample(s->wi, refract_u, Transport::importance);
                REQUIRE(back);
                CHECK(glm::length(back->wi - wo) < 1e-4f);
                CHECK(back->eta * s->eta == relative(1, 1e-5));
            }
        }
}

TEST_CASE("dielectric: reflection has the probability of Fresnel's reflectance") {
    const Dielectric glass{.reflectance = {0.9f, 0.8f, 0.7f}, .transmittance = {0.3f, 0.4f, 0.5f}};
    for (const double cosine : {0.8, 0.1, -0.9}) {
        const Vec3 wo = direction(cosine);
        const float r = fresnel_dielectric(wo.z, glass.eta).reflectance;
        const auto below = glass.sample(wo, Vec3(std::nextafter(r, 0.0f), 0.9f, 0.9f), Transport::radiance);
        const auto above = glass.sample(wo, Vec3(r, 0, 0), Transport::radiance);
        REQUIRE((below && above));
        CHECK(below->wi == mirrored(wo));
        CHECK(below->weight == glass.reflectance);
        CHECK(below->eta == 1);
        CHECK(above->wi.z * wo.z < 0);
        CHECK(glm::length(above->weight - glass.transmittance / square(above->eta)) < 1e-6f);
        CHECK(glass.sample(wo, Vec3(r, 0, 0), Transport::importance)->weight == glass.transmittance);
    }
}

TEST_CASE("dielectric: radiance is scaled by 1 / eta^2, importance is not, and a slab of glass restores it") {
    const Dielectric glass;
    const Vec3 wo = direction(0.6);
    const auto in = glass.sample(wo, refract_u, Transport::radiance);
    REQUIRE(in);
    CHECK(in->weight.x == relative(1 / 2.25, 1e-5));  // Mitsuba's dielectric: 0.444444 with eta 1.5
    CHECK(in->wi.z == relative(-0.845905, 1e-5));     // likewise
    const auto out = glass.sample(in->wi, refract_u, Transport::radiance);
    REQUIRE(out);
    CHECK(out->weight.x == relative(2.25, 1e-5));
    CHECK(in->weight.x * out->weight.x == relative(1, 1e-5));
    // f*(wo, wi) = f(wi, wo): what importance sees one way is what radiance sees the other way times eta^2 (Veach
    // 5.14).
    const auto importance = glass.sample(wo, refract_u, Transport::importance);
    CHECK(importance->weight.x * square(1 / importance->eta) == relative(in->weight.x, 1e-5));
    CHECK(is_black(glass.evaluate(wo, in->wi, Transport::radiance).value));
}

TEST_CASE("thin dielectric: samples are Mitsuba's") {
    const auto models = test::mitsuba_models("thindielectric");
    CHECK(models.size() == 3);
    int reflected = 0;
    for (const auto& model : models) {
        const ThinDielectric pane{.eta = model.eta(),
                                  .reflectance = model.color("specular_reflectance"),
                                  .transmittance = model.color("specular_transmittance")};
        for (const auto& row : model.sampled) {
            CAPTURE(row.wo.z);
            CAPTURE(row.u);
            const auto s = pane.sample(row.wo, Vec3(row.u, 0.5f, 0.5f), Transport::radiance);
            REQUIRE(s);
            CHECK(s->specular);
            CHECK(s->wi == row.wi);
            CHECK(s->weight == row.weight);
            CHECK(s->eta == row.eta);
            reflected += row.wi.z * row.wo.z > 0 ? 1 : 0;
        }
    }
    CHECK(reflected >= 3);
}

TEST_CASE("thin dielectric: the reflectance is the sum over all ways between the faces") {
    for (const float eta : {1.0f, 1.0001f, 1.5f, 2.4f, 0.7f})
        for (const double cosine : {1.0, 0.6, 0.05, -0.3}) {
            CAPTURE(eta);
            CAPTURE(cosine);
            const Vec3 wo = direction(cosine);
            const double face = double(fresnel_dielectric(std::abs(wo.z), eta).reflectance);
            double sum = face, inside = (1 - face) * (1 - face) * face;
            for (int bounce = 0; bounce < 1000; ++bounce, inside *= face * face) sum += inside;
            if (face == 1) sum = 1;
            const ThinDielectric pane{.eta = eta, .reflectance = Rgb(0.9f), .transmittance = Rgb(0.4f)};
            const auto at = [&](double u) { return pane.sample(wo, Vec3(float(u), 0, 0), Transport::importance); };
            if (sum > 1e-5) CHECK(at(sum * (1 - 1e-5))->wi == mirrored(wo));
            if (sum < 1 - 1e-6) CHECK(at(sum * (1 + 1e-5) + 1e-9)->wi == -wo);
            if (sum > 1e-5) CHECK(at(0)->weight == Rgb(0.9f));
            if (sum < 1 - 1e-6) CHECK(at(1 - 0x1p-24)->weight == Rgb(0.4f));
            CHECK(is_black(pane.evaluate(wo, -wo, Transport::radiance).value));
        }
    CHECK_FALSE(ThinDielectric{}.sample(Vec3(1, 0, 0), Vec3(0.5f), Transport::radiance));
}

TEST_CASE("specular models: extremes") {
    for (const float eta : {1e-3f, 0.5f, 1.0f, 1.0000001f, 1.5f, 1e3f})
        test::check_extremes(ThinDielectric{.eta = eta});
    test::check_extremes(Conductor{});
    test::check_extremes(silver, 0.9f);
    test::check_extremes(Dielectric{}, 2.25f);
    test::check_extremes(Dielectric{.eta = 0.5f}, 4);
    test::check_extremes(Dielectric{.eta = 1});
    test::check_extremes(Dielectric{.eta = 1.0000001f});
    test::check_extremes(Dielectric{.eta = 1000}, 1.00001e6f);
    test::check_extremes(Dielectric{.eta = 0.001f}, 1.00001e6f);
}

TEST_CASE("specular models: impossible parameters are explained") {
    CHECK(Conductor{}.problem() == "");
    CHECK(silver.problem() == "");
    CHECK(Conductor{.k = Rgb(-1)}.problem().find("k has") == 0);
    CHECK(Conductor{.reflectance = Rgb(2)}.problem().find("specular_reflectance has") == 0);
    CHECK(Dielectric{}.problem() == "");
    for (const float eta : {0.0f, -1.5f, infinity, NAN}) CHECK(Dielectric{.eta = eta}.problem().find("eta is") == 0);
    CHECK(ThinDielectric{}.problem() == "");
    for (const float eta : {0.0f, -1.5f, infinity, NAN})
        CHECK(ThinDielectric{.eta = eta}.problem().find("eta is") == 0);
    CHECK(ThinDielectric{.reflectance = Rgb(0, 0, 1.1f)}.problem().find("specular_reflectance has") == 0);
    CHECK(ThinDielectric{.transmittance = Rgb(-1, 0, 0)}.problem().find("specular_transmittance has") == 0);
    CHECK(Dielectric{.reflectance = Rgb(0, 0, 1.1f)}.problem().find("specular_reflectance has") == 0);
    CHECK(Dielectric{.transmittance = Rgb(-1, 0, 0)}.problem().find("specular_transmittance has") == 0);
}

TEST_CASE("specular models: Phong terms") {
    CHECK(Conductor{}.phong().specular == Rgb(1));
    CHECK(Conductor{}.phong().diffuse == Rgb(0));
    CHECK(silver.phong().specular.x == relative(0.9f * fresnel_conductor(1, 0.155f, 4.83f), 1e-5));
    CHECK(ThinDielectric{.reflectance = Rgb(0.5f)}.phong().specular == Rgb(0.25f));
    const PhongTerms glass = Dielectric{}.phong();
    CHECK((max_component(glass.diffuse) < 0.2f && max_component(glass.specular) > 0.2f && glass.shininess > 100));
}
