#include <lightswitch/bsdf/principled.hpp>
#include <lightswitch/bsdf/two_sided.hpp>

#include "principled_checks.hpp"

using namespace lightswitch;
using test::direction;
using test::random_disney;
using test::relative;

static_assert(Bsdf<Principled>);
static_assert(transmits<Principled> && !Principled::specular);
static_assert(sizeof(Principled) <= 64);
static_assert(sizeof(TwoSided<Principled>) > 0);

namespace {

constexpr double cosines[] = {0.9, 0.5, 0.1, -0.7};
constexpr int random_models = 24;
const double level = test::sidak(1e-6, random_models + 8);

template <Bsdf B>
B of_table(const test::MitsubaModel& model) {
    B result = test::disney_of<B>(model);
    const bool may_transmit = result.spec_trans != 0;
    result.eta = model.has("eta") ? B::eta_from_eta(model.number("eta"), may_transmit)
                                  : B::eta_from_specular(model.number("specular", 0.5f), may_transmit);
    return result;
}

}  // namespace

TEST_CASE("principled: values agree with Mitsuba's") {
    const auto models = test::mitsuba_models("principled");
    CHECK(models.size() == 22);
    for (const auto& model : models) test::check_values_against_mitsuba(of_table<Principled>(model), model, 3e-4);
}

TEST_CASE("principled: the index of refraction of `specular`") {
    CHECK(Principled::eta_from_specular(0.5f, false) == relative(1.5, 1e-6));
    CHECK(Principled::eta_from_specular(0, false) == 1);
    CHECK(Principled::eta_from_specular(0, true) == Principled::eta_from_specular(1e-3f, true));
    CHECK(Principled::eta_from_specular(0, true) > 1.01f);
    CHECK(Principled::eta_from_eta(1, false) == 1);
    CHECK(Principled::eta_from_eta(1, true) == 1.001f);
    CHECK(Principled::eta_from_eta(1.2f, true) == 1.2f);
    // At normal incidence 8 % of the parameter are reflected.
    for (const float s : {0.1f, 0.5f, 1.0f})
        CHECK(fresnel_dielectric(1, Principled::eta_from_specular(s, false)).reflectance ==
              relative(0.08 * double(s), 1e-5));
}

TEST_CASE("principled: sampling follows the density") {
    test::Random random(11);
    for (int n = 0; n < random_models; ++n) {
        const auto model = random_disney<Principled>(random, 0.4f);
        INFO(test::words(model));
        double cosine = cosines[n % 4];
        // From behind, there must be something to see.
        if (model.spec_trans == 0 || model.metallic == 1) cosine = std::abs(cosine);
        test::check_density(model, direction(cosine), 1, level, static_cast<std::uint32_t>(n) + 1);
    }
    for (const double cosine : {1.0, 0.5, 0.1}) {
        test::check_density(Principled{.roughness = 0.25f, .metallic = 1}, direction(cosine), 0.0625, level, 101);
        test::check_density(Principled{.roughness = 0.3f, .clearcoat = 1, .clearcoat_gloss = 0.3f}, direction(cosine),
                            0.07, level, 102);
    }
    test::check_density(Principled{.roughness = 0.35f, .spec_trans = 1}, direction(0.6), 1, level, 103);
    test::check_density(Principled{.roughness = 0.35f, .spec_trans = 1}, direction(-0.8), 1, level, 104);
}

TEST_CASE("principled: a density that forgets how glass compresses solid angles is found") {
    const Principled glass{.roughness = 0.6f, .spec_trans = 1};
    for (const double cosine : {0.6, -0.6}) {
        const Vec3 wo = direction(cosine);
        const auto sample = [&](const Vec3& u) -> std::optional<Vec3> {
            const auto s = glass.sample(wo, u, Transport::radiance);
            return s ? std::optional(s->wi) : std::nullopt;
        };
        const auto p_value = [&](double through) {
            const auto pdf = [&](const Vec3& wi) {
                return double(glass.evaluate(wo, wi, Transport::radiance).pdf.value) *
                       (wi.z * wo.z < 0 ? through : 1.0);
            };
            return test::chi_square_sphere(sample, pdf, {}, 200000, 1).chi_square.p_value;
        };
        CHECK(p_value(1) > 1e-6);
        CHECK(p_value(1.03) < 1e-12);
    }
}

TEST_CASE("principled: the normals of the clear coat follow their density") {
    for (const float gloss : {0.0f, 0.5f, 1.0f}) {
        const Gtr1 coat(gloss);
        // In cells of equal length of log(tan), in which the density is smooth; the rest is the last one.
        constexpr int cells = 40;
        constexpr double low = -12, step = 0.4;
        std::vector<double> expected(cells + 1, 0.0), observed(cells + 1, 0.0);
        double whole = 0;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < 200; ++j) {
                const double tangent = std::exp(low + step * (i + (j + 0.5) / 200)),
                             cosine = 1 / std::hypot(1, tangent);
                const Vec3 m(DVec3(tangent * cosine, 0, cosine));
                const double mass = 2 * std::acos(-1.0) * double(coat.distribution(m)) * tangent * tangent *
                                    std::pow(cosine, 4) * step / 200;
                expected[static_cast<std::size_t>(i)] += mass;
                whole += mass;
            }
        CHECK(whole == relative(1, 2e-4));
        constexpr int samples = 200000;
        test::Random random(5);
        for (int n = 0; n < samples; ++n) {
            const Vec3 m = coat.sample(random.next_2d());
            const double i = (std::log(std::hypot(double(m.x), double(m.y)) / double(m.z)) - low) / step;
            observed[i >= 0 && i < cells ? static_cast<std::size_t>(i) : std::size_t{cells}] += 1;
        }
        for (double& e : expected) e *= samples / whole;
        CHECK(test::chi_square(observed, expected).p_value > test::sidak(1e-6, 3));
    }
}

TEST_CASE("principled: weights are those of evaluate") {
    test::Random random(12);
    for (int n = 0; n < 20; ++n) {
        const auto model = random_disney<Principled>(random, 0);
        INFO(test::words(model));
        for (const double cosine : cosines)
            test::check_sample_agrees_with_evaluate(model, direction(cosine), 1e-5, 1e-6);
    }
}

TEST_CASE("principled: reflection is reciprocal, refraction but for the index") {
    test::Random random(13);
    for (int n = 0; n < 40; ++n) {
        const auto model = random_disney<Principled>(random, 0.3f);
        CHECK(test::check_both_ways(model, static_cast<std::uint32_t>(n)) > (model.eta == 1 ? 0.0 : 0.2));
        auto opaque = random_disney<Principled>(random, 0.3f);
        opaque.spec_trans = 0;
        CHECK(!opaque.transmits_light());
        test::check_reciprocity(opaque);
    }
    // What enters is less bright by eta^2 for radiance, and only what enters.
    const Principled glass{.roughness = 0.4f, .spec_trans = 1};
    const Vec3 above = direction(0.7), below = -direction(0.8, 0.9), beside = direction(0.3, 2);
    const auto ratio = [&](const Vec3& wo, const Vec3& wi) {
        const float radiance = glass.evaluate(wo, wi, Transport::radiance).value.y;
        REQUIRE(radiance > 0);
        return glass.evaluate(wo, wi, Transport::importance).value.y / radiance;
    };
    CHECK(ratio(above, below) == relative(2.25, 1e-5));
    CHECK(ratio(below, above) == relative(1 / 2.25, 1e-5));
    CHECK(ratio(above, beside) == 1);
}

TEST_CASE("principled: energy") {
    test::Random random(14);
    for (int n = 0; n < 16; ++n) {
        const auto model = random_disney<Principled>(random, 0.5f);
        test::check_albedo_of_samples(model, direction(cosines[n % 4]), static_cast<std::uint32_t>(n) + 1);
    }
    // Facets alone never gain: what they do not reflect they refract, and some is lost to single scattering.
    for (const double cosine : cosines)
        for (const float rough : {0.5f, 0.7f, 1.0f}) {
            const Principled glass{.base_color = Rgb(1), .roughness = rough, .spec_trans = 1};
            Principled lens = glass;
            lens.eta = 1 / glass.eta;
            const double white = test::check_albedo_of_samples(
                Principled{.base_color = Rgb(1), .roughness = rough, .metallic = 1}, direction(std::abs(cosine)), 101);
            CHECK(white <= 1);
            // Radiance is brighter by eta^2 at most in the denser medium, which is where the path comes from.
            CHECK(test::check_albedo_of_samples(glass, direction(cosine), 102) <= (cosine > 0 ? 1 : 2.25));
            CHECK(test::check_albedo_of_samples(lens, direction(cosine), 103) <= (cosine > 0 ? 2.25 : 1));
        }
    // All else may gain, as artists' colours do not know of each other. White diffuse reflection under full reflection,
    // which an index below 1 has: 2.07 is the most found, among indices from 0.4 to 2.5.
    const Principled bright{.base_color = Rgb(1), .roughness = 1, .eta = 0.455f};
    CHECK(test::check_albedo_of_samples(bright, direction(0.01), 104) == relative(2.07, 0.01));
    // With everything on, but without tints, 2.4; with the tint of a pure blue, 13.9 times its luminance, 4.2.
    const Principled coated{
        .base_color = Rgb(1), .roughness = 0.5f, .eta = 0.53f, .sheen = 0.7f, .clearcoat = 1, .clearcoat_gloss = 0};
    CHECK(test::check_albedo_of_samples(coated, direction(0.7), 105) < 2.4);
    const Principled blue{.base_color = {0, 0, 1},
                          .roughness = 0.8f,
                          .eta = 2.39f,
                          .spec_tint = 1,
                          .sheen = 1,
                          .sheen_tint = 1,
                          .flatness = 1,
                          .clearcoat = 0.5f};
    CHECK(test::check_albedo_of_samples(blue, direction(0.01), 106) == relative(4.2, 0.02));
    // The default keeps below 1: half of the light, and a highlight.
    for (const double cosine : {1.0, 0.5, 0.1})
        CHECK(test::check_albedo_of_samples(Principled{}, direction(cosine), 107) < 1);
}

TEST_CASE("principled: an index of refraction next to 1 lets through all that is not masked") {
    for (const float eta : {1.0f, 1.0000001f, 0.9999999f, 1.00001f, 0.9999f, 1.001f})
        for (const double cosine : {0.9, -0.5}) {
            CAPTURE(eta);
            CAPTURE(cosine);
            const Principled glass{.base_color = Rgb(1), .roughness = 1, .spec_trans = 1, .eta = eta};
            test::Random random(16);
            double sum = 0;
            for (int n = 0; n < 10000; ++n)
                if (const auto s = glass.sample(direction(cosine), random.next_3d(), Transport::importance))
                    sum += double(s->weight.y);
            const double z = std::abs(cosine);
            CHECK(sum / 10000 == relative(2 * z / (1 + z), 0.01));
        }
}

TEST_CASE("principled: from behind there is glass alone") {
    Principled model{.roughness = 0.5f, .metallic = 0.3f, .sheen = 1, .clearcoat = 1};
    const Vec3 wo = direction(-0.8), wi = direction(-0.5, 3.6);
    CHECK(is_black(model.evaluate(wo, wi, Transport::radiance).value));
    CHECK(model.evaluate(wo, wi, Transport::radiance).pdf.value == 0);
    CHECK_FALSE(model.sample(wo, Vec3(0.5f), Transport::radiance));
    model.spec_trans = 0.5f;
    CHECK_FALSE(is_black(model.evaluate(wo, wi, Transport::radiance).value));
    CHECK(model.sample(wo, Vec3(0.5f), Transport::radiance));
    model.metallic = 1;
    CHECK(is_black(model.evaluate(wo, wi, Transport::radiance).value));
    CHECK_FALSE(model.sample(wo, Vec3(0.5f), Transport::radiance));
}

TEST_CASE("principled: extremes") {
    test::Random random(15);
    for (int n = 0; n < 12; ++n) {
        auto model = random_disney<Principled>(random, 0);
        model.flatness = 0;
        model.sheen_tint = model.spec_tint = 0;
        if (n % 3 == 0) model.roughness = 0;
        INFO(test::words(model));
        test::check_extremes(model, 12);
    }
    for (const float eta : {1.0f, 1.0000001f, 0.9999f, 1e-3f, 1e3f})
        for (const float trans : {0.0f, 0.5f, 1.0f}) {
            CAPTURE(eta);
            CAPTURE(trans);
            const float radiance = square(std::max(eta, 1 / eta));
            test::check_extremes(Principled{.roughness = 0.3f, .metallic = 0.1f, .spec_trans = trans, .eta = eta},
                                 trans > 0 ? std::max(12.0f, 1.3f * radiance) : 12.0f);
        }
    // A tint's brightest component over its luminance.
    test::check_extremes(
        Principled{.base_color = {0, 0, 1}, .roughness = 0, .spec_trans = 1, .sheen = 1, .sheen_tint = 1}, 64);
    // The imitation of subsurface scattering, of which Burley's formula has a pole where both directions graze.
    test::check_extremes(Principled{.base_color = Rgb(1), .roughness = 1, .flatness = 1}, infinity);
    for (const Rgb& color : {Rgb(0), Rgb(0, 0, 1e-40f)})
        test::check_extremes(Principled{.base_color = color,
                                        .anisotropic = 1,
                                        .spec_trans = 0.5f,
                                        .spec_tint = 1,
                                        .sheen = 1,
                                        .sheen_tint = 1,
                                        .clearcoat = 1,
                                        .clearcoat_gloss = 1},
                             64);
}

TEST_CASE("principled: impossible parameters are explained") {
    CHECK(Principled{}.problem() == "");
    CHECK(Principled{.roughness = 0}.problem() == "");
    CHECK(Principled{.base_color = Rgb(0, 1.5f, 0)}.problem().find("base_color has a component of 1.5") == 0);
    for (const float bad : {-0.1f, 1.1f, infinity, NAN}) {
        for_each_parameter<Principled>([&](std::size_t, const auto& parameter) {
            Principled model;
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(model.*parameter.member)>, float>) {
                if (bad == 1.1f && parameter.name == "eta") return;
                model.*parameter.member = bad;
            } else {
                model.*parameter.member = Rgb(bad);
            }
            CHECK(model.problem().find(std::string(parameter.name)) == 0);
        });
    }
    CHECK(Principled{.eta = 0}.problem().find("eta is") == 0);
}

TEST_CASE("principled: Phong terms") {
    const PhongTerms plastic = Principled{}.phong();
    CHECK(plastic.diffuse == Rgb(0.5f));
    CHECK(plastic.specular.x == relative(0.04, 1e-5));
    CHECK(plastic.shininess == relative(30, 1e-5));
    const PhongTerms gold = Principled{.base_color = {0.9f, 0.6f, 0.2f}, .roughness = 0, .metallic = 1}.phong();
    CHECK(is_black(gold.diffuse));
    CHECK(gold.specular.y == relative(0.6, 1e-5));
    CHECK(gold.shininess == 1000);
    const PhongTerms glass = Principled{.spec_trans = 1}.phong();
    CHECK((max_component(glass.diffuse) < 0.2f && max_component(glass.specular) > 0.2f));
    CHECK(max_component(Principled{.base_color = {0, 0, 1}, .eta = 3, .spec_tint = 1}.phong().specular) <= 1);
}
