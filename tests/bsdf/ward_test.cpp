#include <lightswitch/bsdf/ward.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<Ward>);

namespace {

Ward red(float alpha_u, float alpha_v, WardVariant variant = WardVariant::balanced) {
    return {.variant = variant,
            .alpha_u = alpha_u,
            .alpha_v = alpha_v,
            .diffuse_reflectance = {0.5f, 0.3f, 0.1f},
            .specular_reflectance = {0.2f, 0.4f, 0.6f}};
}
Ward lobe(float alpha_u, float alpha_v, WardVariant variant = WardVariant::balanced) {
    return {.variant = variant,
            .alpha_u = alpha_u,
            .alpha_v = alpha_v,
            .diffuse_reflectance = Rgb(0),
            .specular_reflectance = Rgb(1)};
}

constexpr float alphas[][2] = {{0.02f, 0.02f}, {0.1f, 0.1f}, {0.1f, 0.4f}, {0.6f, 0.05f}, {1, 1}};
constexpr double cosines[] = {1, 0.85, 0.4, 0.1, 0.01};
constexpr WardVariant variants[] = {WardVariant::ward, WardVariant::ward_duer, WardVariant::balanced};
const double level = test::sidak(1e-6, 5 * 5 * 2 + 2);

}  // namespace

TEST_CASE("ward: values and densities are those of the papers' formulas") {
    const auto models = test::mitsuba_models("ward");
    CHECK(models.size() == 12);
    for (const auto& model : models)
        test::check_against_mitsuba(Ward{.variant = model.text("variant") == "ward"        ? WardVariant::ward
                                                    : model.text("variant") == "ward-duer" ? WardVariant::ward_duer
                                                                                           : WardVariant::balanced,
                                         .alpha_u = model.number("alpha_u"),
                                         .alpha_v = model.number("alpha_v"),
                                         .diffuse_reflectance = model.color("diffuse_reflectance"),
                                         .specular_reflectance = model.color("specular_reflectance")},
                                    model, 2e-5);
}

TEST_CASE("ward: sampling follows the density") {
    std::uint32_t seed = 1;
    for (const auto& alpha : alphas)
        for (const double cosine : cosines) {
            CAPTURE(alpha[1]);
            const double smaller = double(std::min(alpha[0], alpha[1]));
            test::check_density(red(alpha[0], alpha[1]), direction(cosine), smaller, level, seed++);
            test::check_density(lobe(alpha[0], alpha[1]), direction(cosine), smaller, level, seed++);
        }
    test::check_density(lobe(0.001f, 0.001f), direction(1), 0.001, level, seed++);
    test::check_density(lobe(0.001f, 0.001f), direction(0.5), 0.001, level, seed++);
}

TEST_CASE("ward: energy of the balanced variant") {
    // Loss of the lobe by roughness and cosine.
    const double loss[5][5] = {{0, 0, 0.001, 0.021, 0.186},
                               {0.010, 0.012, 0.038, 0.180, 0.105},
                               {0.085, 0.100, 0.179, 0.191, 0.059},
                               {0.175, 0.193, 0.232, 0.168, 0.042},
                               {0.632, 0.584, 0.416, 0.196, 0.037}};
    std::uint32_t seed = 101;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j) {
            const float u = alphas[i][0], v = alphas[i][1];
            CAPTURE(v);
            const double smaller = double(std::min(u, v));
            const double white = test::check_albedo(lobe(u, v), direction(cosines[j]), smaller, seed++);
            CHECK(std::abs(1 - white - loss[i][j]) < 0.01);
            test::check_albedo(red(u, v), direction(cosines[j]), smaller, seed++);
        }
}

TEST_CASE("ward: the other variants lose light, or make some") {
    const auto albedo = [](WardVariant variant, double cosine) {
        const Ward model = lobe(0.1f, 0.1f, variant);
        const Vec3 wo = direction(cosine);
        test::Random random(4);
        double sum = 0;
        for (int i = 0; i < 100000; ++i) {
            const auto s = model.sample(wo, random.next_3d(), Transport::radiance);
            sum += s ? double(s->weight.x) : 0;
        }
        return sum / 100000;
    };
    for (const WardVariant variant : variants) CHECK(albedo(variant, 1) == relative(0.98, 0.02));
    CHECK(albedo(WardVariant::ward, 0.01) < 0.2);
    CHECK(albedo(WardVariant::ward_duer, 0.01) > 2);
    CHECK(albedo(WardVariant::balanced, 0.01) < 1);
}

TEST_CASE("ward: a sample's weight and density are those of evaluate, and it is reciprocal") {
    for (const WardVariant variant : variants)
        for (const auto& alpha : alphas) {
            const Ward model = red(alpha[0], alpha[1], variant);
            for (const double cosine : {1.0, 0.4, 1e-4})
                test::check_sample_agrees_with_evaluate(model, direction(cosine), 1e-6, 1e-6);
            test::check_reciprocity(model);
        }
}

TEST_CASE("ward: extremes") {
    for (const float alpha : {1e-6f, 1e-4f, 0.001f, 0.1f, 1.0f}) {
        CAPTURE(alpha);
        test::check_extremes(lobe(alpha, 0.1f), 2.0001f);
        test::check_extremes(Ward{.alpha_u = 0.1f, .alpha_v = alpha}, 2);
        for (const WardVariant variant : variants) test::check_extremes(lobe(alpha, alpha, variant), infinity);
    }
    for (const float z : {1e-6f, 1e-12f, 1e-16f, 1e-20f, 1e-38f, 1e-42f})
        for (const WardVariant variant : variants)
            for (const Vec3& wi : {Vec3(1, 0, z), Vec3(-1, 0, z), Vec3(0, 1, z)}) {
                const BsdfValue v = lobe(1e-4f, 0.3f, variant).evaluate({1, 0, z}, wi, Transport::radiance);
                CHECK((is_finite(v.value) && is_finite(v.pdf.value) && v.value.x >= 0 && v.pdf.value >= 0));
            }
}

TEST_CASE("ward: the back is black, and so is what reflects nothing") {
    const Vec3 up = direction(0.5), down = direction(-0.5);
    const Ward model = red(0.1f, 0.3f), black{.diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(0)};
    for (const Vec3& wo : {up, down}) CHECK(is_black(model.evaluate(wo, down, Transport::radiance).value));
    CHECK(is_black(model.evaluate(down, up, Transport::radiance).value));
    CHECK_FALSE(model.sample(down, Vec3(0.3f), Transport::radiance));
    CHECK(is_black(black.sample(up, Vec3(0.3f), Transport::radiance)->weight));
}

TEST_CASE("ward: impossible parameters are explained") {
    CHECK(Ward{}.problem() == "");
    for (const float alpha : {0.0f, -0.1f, 1.1f, infinity, NAN}) {
        CHECK(Ward{.alpha_u = alpha}.problem().find("alpha_u is") == 0);
        CHECK(Ward{.alpha_v = alpha}.problem().find("alpha_v is") == 0);
    }
    CHECK(Ward{.diffuse_reflectance = Rgb(0, 0, 1.1f)}.problem().find("diffuse_reflectance has") == 0);
    CHECK(Ward{.specular_reflectance = Rgb(0, NAN, 0)}.problem().find("specular_reflectance has") == 0);
    CHECK(Ward{.specular_reflectance = Rgb(0, 0.6f, 0)}.problem().find("add up to 1.1") != std::string::npos);
}

TEST_CASE("ward: Phong terms") {
    CHECK(red(0.1f, 0.1f).phong().diffuse == red(0.1f, 0.1f).diffuse_reflectance);
    CHECK(red(0.1f, 0.1f).phong().specular == red(0.1f, 0.1f).specular_reflectance);
    CHECK(red(0.1f, 0.1f).phong().shininess == relative(198, 1e-5));
}
