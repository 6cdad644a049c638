#include <lightswitch/bsdf/modified_phong.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<ModifiedPhong>);

namespace {

ModifiedPhong red(float exponent) {
    return {
        .exponent = exponent, .diffuse_reflectance = {0.5f, 0.3f, 0.1f}, .specular_reflectance = {0.2f, 0.4f, 0.6f}};
}
ModifiedPhong lobe(float exponent) {
    return {.exponent = exponent, .diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(1)};
}
/// The roughness of facets that look alike.
double alpha_of(float exponent) { return std::min(1.0, std::sqrt(2 / (2 + double(exponent)))); }

constexpr float exponents[] = {0, 1, 30, 1000};
constexpr double cosines[] = {1, 0.85, 0.4, 0.1, 0.01};
const double level = test::sidak(1e-6, 4 * 5 * 2 + 2);

}  // namespace

TEST_CASE("modified Phong: values and densities are those of the paper's formulas") {
    const auto models = test::mitsuba_models("phong");
    CHECK(models.size() == 4);
    for (const auto& model : models)
        test::check_against_mitsuba(ModifiedPhong{.exponent = model.number("exponent"),
                                                  .diffuse_reflectance = model.color("diffuse_reflectance"),
                                                  .specular_reflectance = model.color("specular_reflectance")},
                                    model, 1e-5);
}

TEST_CASE("modified Phong: sampling follows the density") {
    std::uint32_t seed = 1;
    for (const float exponent : exponents)
        for (const double cosine : cosines) {
            CAPTURE(exponent);
            test::check_density(red(exponent), direction(cosine), alpha_of(exponent), level, seed++);
            test::check_density(lobe(exponent), direction(cosine), alpha_of(exponent), level, seed++);
        }
    test::check_density(lobe(1e6f), direction(1), alpha_of(1e6f), level, seed++);
    test::check_density(lobe(1e6f), direction(0.5), alpha_of(1e6f), level, seed++);
}

TEST_CASE("modified Phong: energy") {
    // Loss of the lobe by exponent and cosine: none at normal incidence; narrow lobes reflect the cosine.
    const double loss[4][5] = {{0, 0.074, 0.300, 0.450, 0.495},
                               {0, 0.132, 0.456, 0.630, 0.677},
                               {0, 0.150, 0.599, 0.867, 0.923},
                               {0, 0.150, 0.600, 0.900, 0.982}};
    std::uint32_t seed = 101;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 5; ++j) {
            CAPTURE(exponents[i]);
            const double alpha = alpha_of(exponents[i]);
            const double white = test::check_albedo(lobe(exponents[i]), direction(cosines[j]), alpha, seed++);
            CHECK(std::abs(1 - white - loss[i][j]) < 0.01);
            test::check_albedo(red(exponents[i]), direction(cosines[j]), alpha, seed++);
        }
}

TEST_CASE("modified Phong: a sample's weight and density are those of evaluate, and it is reciprocal") {
    for (const float exponent : exponents) {
        for (const double cosine : {1.0, 0.4, 1e-4})
            test::check_sample_agrees_with_evaluate(red(exponent), direction(cosine), 1e-6, 1e-6);
        test::check_reciprocity(red(exponent));
    }
}

TEST_CASE("modified Phong: a narrow lobe keeps its digits") {
    const ModifiedPhong mirror = lobe(1e6f);
    const Vec3 wo = direction(0.6, 0);
    for (const double angle : {1e-4, 1e-3, 2e-3}) {
        const double theta = std::acos(double(wo.z)) + angle;
        const Vec3 wi(DVec3(-std::sin(theta), 0, std::cos(theta)));
        const double exact = std::atan2(-double(wi.x), double(wi.z)) - std::atan2(double(wo.x), double(wo.z));
        CHECK(mirror.evaluate(wo, wi, Transport::radiance).value.x ==
              relative((1e6 + 2) / (2 * std::acos(-1.0)) * std::exp(1e6 * std::log(std::cos(exact))), 2e-3));
    }
}

TEST_CASE("modified Phong: extremes") {
    for (const float exponent : {0.0f, 1.0f, 30.0f, 1e4f, 1e6f}) {
        CAPTURE(exponent);
        test::check_extremes(lobe(exponent), (exponent + 2) / (exponent + 1) * (1 + 1e-5f));
        test::check_extremes(ModifiedPhong{.exponent = exponent}, 1.4f);
    }
}

TEST_CASE("modified Phong: the back is black, and so is what reflects nothing") {
    const Vec3 up = direction(0.5), down = direction(-0.5);
    const ModifiedPhong model = red(30), black{.diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(0)};
    for (const Vec3& wo : {up, down}) CHECK(is_black(model.evaluate(wo, down, Transport::radiance).value));
    CHECK(is_black(model.evaluate(down, up, Transport::radiance).value));
    CHECK_FALSE(model.sample(down, Vec3(0.3f), Transport::radiance));
    CHECK(is_black(black.sample(up, Vec3(0.3f), Transport::radiance)->weight));
}

TEST_CASE("modified Phong: impossible parameters are explained") {
    CHECK(ModifiedPhong{}.problem() == "");
    CHECK(lobe(1e6f).problem() == "");
    for (const float exponent : {-1.0f, 1e7f, infinity, NAN})
        CHECK(ModifiedPhong{.exponent = exponent}.problem().find("exponent is") == 0);
    CHECK(ModifiedPhong{.diffuse_reflectance = Rgb(0, 0, 1.1f)}.problem().find("diffuse_reflectance has") == 0);
    CHECK(ModifiedPhong{.specular_reflectance = Rgb(0, NAN, 0)}.problem().find("specular_reflectance has") == 0);
    CHECK(ModifiedPhong{.specular_reflectance = Rgb(0, 0.6f, 0)}.problem().find("add up to 1.1") != std::string::npos);
    for (int i = 0; i <= 1000; ++i) {
        const float part = static_cast<float>(i / 1000.0), rest = static_cast<float>((1000 - i) / 1000.0);
        CHECK(ModifiedPhong{.diffuse_reflectance = Rgb(part), .specular_reflectance = Rgb(rest)}.problem() == "");
    }
}

TEST_CASE("modified Phong: Phong terms") {
    CHECK(red(30).phong().diffuse == red(30).diffuse_reflectance);
    CHECK(red(30).phong().specular == red(30).specular_reflectance);
    CHECK(red(30).phong().shininess == 30);
    CHECK(red(0).phong().shininess == 1);
    CHECK(red(1e5f).phong().shininess == 1000);
}
