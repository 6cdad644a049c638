#include <lightswitch/bsdf/plastic.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<Plastic> && !Plastic::specular && partly_specular<Plastic> && !transmits<Plastic>);

namespace {

const Plastic red{.diffuse_reflectance = {0.8f, 0.3f, 0.1f}, .specular_reflectance = {0.9f, 0.7f, 0.5f}};
const Plastic models[] = {
    {},
    red,
    {.eta = 1.9f, .diffuse_reflectance = {0.9f, 0.5f, 0.2f}, .nonlinear = true},
    {.eta = 1 / 1.5f, .nonlinear = true},
    {.eta = 10, .diffuse_reflectance = Rgb(1), .specular_reflectance = Rgb(0.5f)},
    {.specular_reflectance = Rgb(0)},
};
constexpr double cosines[] = {1, 0.85, 0.4, 0.1, 0.01};
const double level = test::sidak(1e-6, 6 * 5);

Plastic white(float eta) { return {.eta = eta, .diffuse_reflectance = Rgb(1)}; }

}  // namespace

TEST_CASE("plastic: values and densities are Mitsuba's, but for its fit of the reflectance of diffuse light") {
    const auto tables = test::mitsuba_models("plastic");
    CHECK(tables.size() == 6);
    for (const auto& model : tables) {
        const Plastic plastic{.eta = model.eta(),
                              .diffuse_reflectance = model.color("diffuse_reflectance"),
                              .specular_reflectance = model.color("specular_reflectance"),
                              .nonlinear = model.text("nonlinear") == "True"};
        // What the inside of the coat reflects, after Egan and Hilgeman 1973 and exactly.
        const double n = 1 / double(plastic.eta), fit = 0.0636 / n + 0.6681 + 0.7099 * n - 1.4399 * n * n,
                     exact = 1 - double(plastic.coat_transmittance) * n * n;
        const double again = plastic.nonlinear ? double(plastic.diffuse_reflectance.x) : 1;
        const double ratio = (1 - again * exact) / (1 - again * fit);
        CHECK(ratio == relative(1, 1.3e-3));
        // Mitsuba chooses between the lobes as if the base reflected its own colour; here, the whole of the lobe
        // counts.
        const double shift = plastic.nonlinear ? (1 - exact) / (1 - again * exact) : 1;
        const auto pdf_ratio = [&](const Vec3& wo) {
            const double probability = double(plastic.evaluate(wo, {0, 0, 1}, Transport::radiance).pdf.value * pi);
            return 1 / (probability + (1 - probability) * shift);
        };
        test::check_against_mitsuba(
            plastic, model, 2e-6, [&](const Vec3&, const Vec3&) { return ratio; }, pdf_ratio);
    }
}

TEST_CASE("plastic: sampling follows the density, and the rest is the coat's") {
    std::uint32_t seed = 1;
    for (const Plastic& model : models)
        for (const double cosine : cosines) {
            if (model.eta < 1 && cosine < 0.75) continue;  // total reflection
            CAPTURE(model.eta);
            test::check_density(model, direction(cosine), 1, level, seed++);
        }
}

TEST_CASE("plastic: the mirror direction comes with the coat's probability and Fresnel's reflectance") {
    for (const Plastic& model : models)
        for (const double cosine : cosines) {
            const Vec3 wo = direction(cosine);
            const Vec3 up{0, 0, 1};
            const float probability = 1 - pi * model.evaluate(wo, up, Transport::radiance).pdf.value;
            const float reflected = fresnel_dielectric(wo.z, model.eta).reflectance;
            CAPTURE(model.eta);
            CAPTURE(cosine);
            if (!(probability > 1e-3f)) {
                CHECK(is_black(model.specular_reflectance));
                continue;
            }
            const auto below =
                model.sample(wo, Vec3(0.5f, 0.5f, std::max(probability - 1e-6f, 0.0f)), Transport::importance);
            REQUIRE(below);
            CHECK(below->specular);
            CHECK(below->pdf.value == 0);
            CHECK(below->eta == 1);
            CHECK(below->wi == test::mirrored(wo));
            for (int c = 0; c < 3; ++c)
                CHECK(below->weight[c] * probability == relative(reflected * model.specular_reflectance[c], 2e-4));
            if (!(probability < 1)) continue;
            const auto above =
                model.sample(wo, Vec3(0.5f, 0.5f, std::min(probability + 1e-6f, 1 - 0x1p-24f)), Transport::importance);
            REQUIRE(above);
            CHECK_FALSE(above->specular);
        }
}

TEST_CASE("plastic: energy") {
    std::uint32_t seed = 101;
    for (const Plastic& model : models)
        for (const double cosine : cosines) {
            CAPTURE(model.eta);
            const double albedo = test::check_albedo(model, direction(cosine), 1, seed++);
            if (model.nonlinear) continue;
            // What is not reflected comes back from the base, less what that absorbs.
            const float reflected = fresnel_dielectric(float(cosine), model.eta).reflectance;
            CHECK(albedo ==
                  relative(model.specular_reflectance.y * reflected + model.diffuse_reflectance.y * (1 - reflected),
                           0.015));
        }
}

TEST_CASE("plastic: a white base loses nothing, with either sum") {
    std::uint32_t seed = 201;
    for (const float eta : {1.0f, 1.01f, 1.49f, 2.5f, 10.0f, 0.7f})
        for (const bool nonlinear : {false, true})
            for (const double cosine : cosines) {
                Plastic model = white(eta);
                model.nonlinear = nonlinear;
                CAPTURE(eta);
                CHECK(test::check_albedo(model, direction(cosine), 1, seed++) == relative(1, 0.015));
            }
}

TEST_CASE("plastic: internal scattering is the sum over all bounces between base and coat") {
    for (const float eta : {1.2f, 1.49f, 2.5f, 0.7f}) {
        const Plastic model{.eta = eta, .diffuse_reflectance = {0.9f, 0.5f, 0.1f}, .nonlinear = true};
        const Vec3 wo = direction(0.9), wi = direction(0.8, 2);
        const double enters = 1 - double(fresnel_dielectric(wo.z, eta).reflectance),
                     leaves = (1 - double(fresnel_dielectric(wi.z, eta).reflectance)) / double(eta * eta);
        // From inside, of diffuse light, by midpoints.
        double back = 0;
        constexpr int steps = 200000;
        for (int i = 0; i < steps; ++i) {
            const float cosine = static_cast<float>((i + 0.5) / steps);
            back += 2 * double(cosine) * double(fresnel_dielectric(-cosine, eta).reflectance) / steps;
        }
        for (int c = 0; c < 3; ++c) {
            double sum = 0, light = enters;
            for (int bounce = 0; bounce < 2000; ++bounce) {
                light *= double(model.diffuse_reflectance[c]);
                sum += light * leaves / 3.14159265358979;
                light *= back;
            }
            CHECK(model.evaluate(wo, wi, Transport::radiance).value[c] == relative(sum, 2e-5));
        }
    }
}

TEST_CASE("plastic: an index of 1 is no coat") {
    for (const bool nonlinear : {false, true}) {
        const Plastic model{.eta = 1, .diffuse_reflectance = {0.8f, 0.3f, 0.1f}, .nonlinear = nonlinear};
        test::Random random(3);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 wo = cosine_hemisphere(random.next_2d()), wi = cosine_hemisphere(random.next_2d());
            const BsdfValue v = model.evaluate(wo, wi, Transport::radiance);
            for (int c = 0; c < 3; ++c) CHECK(v.value[c] == relative(model.diffuse_reflectance[c] * inv_pi, 1e-6));
            CHECK(v.pdf == cosine_hemisphere_pdf(wi.z));
            CHECK_FALSE(model.sample(wo, random.next_3d(), Transport::radiance)->specular);
        }
    }
}

TEST_CASE("plastic: a sample's weight and density are those of evaluate, and it is reciprocal") {
    for (const Plastic& model : models) {
        CAPTURE(model.eta);
        for (const double cosine : {1.0, 0.85, 0.1, 1e-4})
            test::check_sample_agrees_with_evaluate(model, direction(cosine), 1e-6, 1e-6);
        test::check_reciprocity(model);
    }
    test::check_sample_agrees_with_evaluate(white(1.0000001f), direction(1e-4), 1e-6, 1e-6);
}

TEST_CASE("plastic: extremes") {
    // Where light gets through the coat better than on average, the weight of a white base is above 1.
    for (const float eta : {1.0f, 1 + 0x1p-23f, 1.49f, 10.0f, 1000.0f, 0.999999f, 0.5f, 0.001f}) {
        CAPTURE(eta);
        const Plastic model = white(eta);
        const double lowest = std::sqrt(std::max(0.0, 1 - double(eta) * double(eta)));  // below, reflection is total
        float most = 0;
        for (int i = 1; i <= 10000; ++i)
            most = std::max(
                most, fresnel_dielectric_transmittance(static_cast<float>(lowest + (1 - lowest) * i * 1e-4), eta));
        test::check_extremes(model, std::max(1.0f, most / model.coat_transmittance) * (1 + 1e-4f));
        if (eta != 1) test::check_extremes(Plastic{.eta = eta, .diffuse_reflectance = Rgb(0)});
    }
    test::check_extremes(red, 3);  // one colour more often than it is worth
    test::check_extremes(Plastic{.specular_reflectance = Rgb(0)}, 0.55f);
}

TEST_CASE("plastic: the back is black, and so is a plastic that reflects nothing") {
    const Vec3 up = direction(0.5), down = direction(-0.5);
    for (const Vec3& wo : {up, down}) CHECK(is_black(red.evaluate(wo, down, Transport::radiance).value));
    CHECK(is_black(red.evaluate(down, up, Transport::radiance).value));
    CHECK_FALSE(red.sample(down, Vec3(0.3f), Transport::radiance));
    const Plastic black{.diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(0)};
    CHECK_FALSE(black.sample(up, Vec3(0.3f), Transport::radiance));
    CHECK(black.evaluate(up, up, Transport::radiance).pdf.value == 0);
}

TEST_CASE("plastic: impossible parameters are explained") {
    for (const Plastic& model : models) CHECK(model.problem() == "");
    for (const float eta : {0.0f, -1.5f, infinity, NAN}) CHECK(Plastic{.eta = eta}.problem().find("eta is") == 0);
    CHECK(Plastic{.diffuse_reflectance = Rgb(0, 0, 1.1f)}.problem().find("diffuse_reflectance has") == 0);
    CHECK(Plastic{.specular_reflectance = Rgb(0, NAN, 0)}.problem().find("specular_reflectance has") == 0);
    Plastic changed;
    changed.eta = 1.6f;
    CHECK(changed.problem().find("coat_transmittance") == 0);
}

TEST_CASE("plastic: Phong terms") {
    CHECK(red.phong().diffuse == red.diffuse_reflectance);
    CHECK(max_component(red.phong().specular) > 0);
}
