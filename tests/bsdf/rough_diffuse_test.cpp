#include <lightswitch/bsdf/rough_diffuse.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<RoughDiffuse>);

namespace {
constexpr float alphas[] = {0, 0.05f, 0.4f, 1};
constexpr double cosines[] = {1, 0.85, 0.4, 0.1, 0.01};
const double level = test::sidak(1e-6, 2);
}  // namespace

TEST_CASE("rough diffuse: values are those of the paper's formulas") {
    const auto models = test::mitsuba_models("roughdiffuse");
    CHECK(models.size() == 10);
    for (const auto& model : models)
        test::check_against_mitsuba(RoughDiffuse{.alpha = model.number("alpha"),
                                                 .reflectance = model.color("reflectance"),
                                                 .use_fast_approx = model.text("use_fast_approx") == "True"},
                                    model, 3e-6);
}

TEST_CASE("rough diffuse: sampling follows the density") {
    test::check_density(RoughDiffuse{}, direction(0.9), 1, level, 1);
    test::check_density(RoughDiffuse{.alpha = 1}, direction(1e-3), 1, level, 2);
}

TEST_CASE("rough diffuse: energy") {
    // Loss of the reflectance 0.95 by alpha and cosine. A white surface would gain up to 5 % at grazing angles.
    const double loss[4][5] = {{0.050, 0.050, 0.050, 0.050, 0.050},
                               {0.050, 0.050, 0.050, 0.049, 0.048},
                               {0.084, 0.082, 0.058, 0.026, 0.009},
                               {0.214, 0.210, 0.167, 0.110, 0.078}};
    const double fast_loss[4][5] = {{0.050, 0.050, 0.050, 0.050, 0.050},
                                    {0.052, 0.051, 0.050, 0.049, 0.049},
                                    {0.143, 0.116, 0.074, 0.049, 0.043},
                                    {0.336, 0.289, 0.212, 0.167, 0.156}};
    std::uint32_t seed = 101;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 5; ++j) {
            const double full = test::check_albedo(RoughDiffuse{.alpha = alphas[i], .reflectance = Rgb(0.95f)},
                                                   direction(cosines[j]), 1, seed++);
            const double fast =
                test::check_albedo(RoughDiffuse{.alpha = alphas[i], .reflectance = Rgb(0.95f), .use_fast_approx = true},
                                   direction(cosines[j]), 1, seed++);
            CHECK(std::abs(1 - full - loss[i][j]) < 0.01);
            CHECK(std::abs(1 - fast - fast_loss[i][j]) < 0.01);
        }
}

TEST_CASE("rough diffuse: without roughness it is Lambert's") {
    test::Random random(3);
    for (const bool fast : {false, true}) {
        const RoughDiffuse smooth{.alpha = 0, .reflectance = {0.8f, 0.3f, 0.1f}, .use_fast_approx = fast};
        for (int i = 0; i < 1000; ++i) {
            const Vec3 wo = cosine_hemisphere(random.next_2d()), wi = cosine_hemisphere(random.next_2d());
            const BsdfValue v = smooth.evaluate(wo, wi, Transport::radiance);
            for (int c = 0; c < 3; ++c) CHECK(v.value[c] == relative(smooth.reflectance[c] * inv_pi, 1e-6));
        }
    }
}

TEST_CASE("rough diffuse: grazing directions keep their digits") {
    // Opposite to each other, the limits of the paper's formulas: sin a - (2 b / pi)^3 goes like 6 h / pi, h = pi/2 -
    // b.
    const RoughDiffuse plaster{.alpha = 0.5f, .reflectance = Rgb(1)};
    const double variance = 0.125, share = variance / (variance + 0.09);
    const double limit = (1 - 0.5 * variance / (variance + 0.33) - 0.45 * share * 6 / std::acos(-1.0) +
                          2 * 0.17 * variance / (variance + 0.13)) /
                         std::acos(-1.0);
    for (const double cosine : {1e-4, 1e-6, 1e-10, 1e-20, 1e-37}) {
        const Vec3 wo = direction(cosine, 0), wi = Vec3(-wo.x, 0, wo.z);
        CHECK(plaster.evaluate(wo, wi, Transport::radiance).value.x == relative(limit, 1e-3));
        CHECK(is_finite(plaster.evaluate(wo, wo, Transport::radiance).value));
    }
}

TEST_CASE("rough diffuse: a sample's weight and density are those of evaluate, and it is reciprocal") {
    for (const float alpha : alphas)
        for (const bool fast : {false, true}) {
            const RoughDiffuse model{.alpha = alpha, .reflectance = {0.8f, 0.5f, 0.1f}, .use_fast_approx = fast};
            for (const double cosine : {1.0, 0.4, 1e-4})
                test::check_sample_agrees_with_evaluate(model, direction(cosine), 1e-6, 1e-6);
            test::check_reciprocity(model);
        }
}

TEST_CASE("rough diffuse: extremes") {
    for (const float alpha : alphas)
        for (const bool fast : {false, true})  // the paper's tangents have no bound
            test::check_extremes(RoughDiffuse{.alpha = alpha, .reflectance = Rgb(1), .use_fast_approx = fast},
                                 infinity);
}

TEST_CASE("rough diffuse: the back is black") {
    const Vec3 up = direction(0.5), down = direction(-0.5);
    for (const Vec3& wo : {up, down}) CHECK(is_black(RoughDiffuse{}.evaluate(wo, down, Transport::radiance).value));
    CHECK(is_black(RoughDiffuse{}.evaluate(down, up, Transport::radiance).value));
    CHECK_FALSE(RoughDiffuse{}.sample(down, Vec3(0.3f), Transport::radiance));
}

TEST_CASE("rough diffuse: impossible parameters are explained") {
    CHECK(RoughDiffuse{}.problem() == "");
    CHECK(RoughDiffuse{.alpha = 0}.problem() == "");
    for (const float alpha : {-0.1f, 1.1f, NAN}) CHECK(RoughDiffuse{.alpha = alpha}.problem().find("alpha is") == 0);
    CHECK(RoughDiffuse{.reflectance = Rgb(0, 0, 1.1f)}.problem().find("reflectance has") == 0);
    CHECK(RoughDiffuse{.reflectance = Rgb(NAN)}.problem().find("reflectance has") == 0);
    CHECK(RoughDiffuse{.reflectance = Rgb(0.3f)}.phong().diffuse == Rgb(0.3f));
}
