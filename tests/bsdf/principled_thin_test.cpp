#include <lightswitch/bsdf/principled_thin.hpp>

#include "principled_checks.hpp"

using namespace lightswitch;
using test::direction;
using test::random_disney;
using test::relative;

static_assert(Bsdf<PrincipledThin>);
static_assert(transmits<PrincipledThin> && !PrincipledThin::specular);
static_assert(sizeof(PrincipledThin) <= 64);

namespace {

constexpr double cosines[] = {0.9, 0.5, 0.1, -0.7};
constexpr int random_models = 16;
const double level = test::sidak(1e-6, random_models + 6);

/// At an index of 0.54, a pane does not blur what is seen through it, which quadrature would have to find.
PrincipledThin resolvable(test::Random& random, float least_roughness) {
    auto model = random_disney<PrincipledThin>(random, least_roughness);
    model.eta = std::max(model.eta, 1.25f);
    return model;
}

}  // namespace

TEST_CASE("principled thin: values agree with Mitsuba's") {
    const auto models = test::mitsuba_models("principledthin");
    CHECK(models.size() == 18);
    for (const auto& model : models) {
        auto thin = test::disney_of<PrincipledThin>(model);
        thin.eta = model.number("eta", 1.5f);
        test::check_values_against_mitsuba(thin, model, 3e-4);
    }
}

TEST_CASE("principled thin: sampling follows the density") {
    test::Random random(21);
    for (int n = 0; n < random_models; ++n) {
        const auto model = resolvable(random, 0.5f);
        INFO(test::words(model));
        test::check_density(model, direction(cosines[n % 4]), 1, level, static_cast<std::uint32_t>(n) + 1);
    }
    for (const double cosine : {1.0, 0.5, -0.1}) {
        test::check_density(PrincipledThin{.roughness = 0.6f, .spec_trans = 1}, direction(cosine), 1, level, 101);
        test::check_density(PrincipledThin{.diff_trans = 1.3f}, direction(cosine), 1, level, 102);
    }
}

TEST_CASE("principled thin: weights are those of evaluate") {
    test::Random random(22);
    for (int n = 0; n < 20; ++n) {
        const auto model = random_disney<PrincipledThin>(random, 0);
        INFO(test::words(model));
        for (const double cosine : cosines)
            test::check_sample_agrees_with_evaluate(model, direction(cosine), 1e-5, 1e-6);
    }
}

TEST_CASE("principled thin: importance sees the surface that radiance sees") {
    test::Random random(23);
    for (int n = 0; n < 40; ++n) {
        const auto model = random_disney<PrincipledThin>(random, 0.3f);
        CHECK(test::check_both_ways(model, static_cast<std::uint32_t>(n)) > 0.1);
    }
    // Where it is not reciprocal: what falls in steeply and would leave at a grazing angle is dropped, and not the
    // other way round.
    const PrincipledThin pane{.roughness = 1, .spec_trans = 1};
    const Vec3 steep = direction(0.99, 0), grazing = -direction(0.05, 3);
    CHECK(is_black(pane.evaluate(steep, grazing, Transport::radiance).value));
    CHECK_FALSE(is_black(pane.evaluate(grazing, steep, Transport::radiance).value));
    CHECK(is_black(pane.evaluate(grazing, steep, Transport::importance).value));
    CHECK_FALSE(is_black(pane.evaluate(steep, grazing, Transport::importance).value));
}

TEST_CASE("principled thin: both sides look alike") {
    test::Random random(24);
    for (int n = 0; n < 20; ++n) {
        const auto model = random_disney<PrincipledThin>(random, 0.1f);
        for (int i = 0; i < 100; ++i) {
            const Vec3 wo = uniform_sphere(random.next_2d()), wi = uniform_sphere(random.next_2d());
            const BsdfValue front = model.evaluate(wo, wi, Transport::radiance);
            const BsdfValue back = model.evaluate(-wo, -wi, Transport::radiance);
            CHECK(front.value == back.value);
            CHECK(front.pdf.value == back.pdf.value);
        }
    }
}

TEST_CASE("principled thin: energy") {
    test::Random random(25);
    for (int n = 0; n < 16; ++n) {
        const auto model = resolvable(random, 0.6f);
        test::check_albedo_of_samples(model, direction(cosines[n % 4]), static_cast<std::uint32_t>(n) + 1);
    }
    // White panes never gain, nor do diffuse ones that let all light through.
    for (const double cosine : {1.0, 0.5, 0.1})
        for (const float rough : {0.6f, 0.8f, 1.0f}) {
            const PrincipledThin pane{.base_color = Rgb(1), .roughness = rough, .spec_trans = 1};
            CHECK(test::check_albedo_of_samples(pane, direction(cosine), 101) <= 1);
            const PrincipledThin paper{.base_color = Rgb(1), .roughness = rough, .diff_trans = 2};
            CHECK(test::check_albedo_of_samples(paper, direction(cosine), 102) == relative(1, 1e-4));
        }
    // Diffuse reflection from rough white gains towards grazing angles, and more with sheen: 1.54 and 1.62 are the most
    // found without tints. The tint of a pure blue is 13.9 times its luminance and gives 2.86 here, and 3.35
    // when smooth.
    const PrincipledThin rough{.base_color = Rgb(1), .roughness = 1};
    CHECK(test::check_albedo_of_samples(rough, direction(0.01), 103) == relative(1.54, 0.01));
    PrincipledThin cloth = rough;
    cloth.sheen = 1;
    CHECK(test::check_albedo_of_samples(cloth, direction(0.01), 104) == relative(1.63, 0.01));
    const PrincipledThin blue{.base_color = {0, 0, 1}, .roughness = 0.5f, .spec_trans = 1, .eta = 2.5f, .spec_tint = 1};
    CHECK(test::check_albedo_of_samples(blue, direction(1), 105) == relative(2.86, 0.01));
    for (const double cosine : {1.0, 0.5, 0.1})
        CHECK(test::check_albedo_of_samples(PrincipledThin{}, direction(cosine), 106) < 1);
}

TEST_CASE("principled thin: extremes") {
    test::Random random(26);
    for (int n = 0; n < 8; ++n) {
        auto model = random_disney<PrincipledThin>(random, 0);
        model.flatness = 0;
        model.sheen_tint = model.spec_tint = 0;
        if (n % 3 == 0) model.roughness = 0;
        INFO(test::words(model));
        test::check_extremes(model, 12);
    }
    for (const float eta : {1.0f, 1.0000001f, 1e-3f, 1e3f}) {
        CAPTURE(eta);
        for (const float anisotropic : {0.0f, 1.0f})
            test::check_extremes(
                PrincipledThin{.roughness = 1, .anisotropic = anisotropic, .spec_trans = 0.5f, .eta = eta}, 12);
    }
    // A tint's brightest component over its luminance.
    test::check_extremes(
        PrincipledThin{.base_color = {0, 0, 1}, .roughness = 0, .spec_tint = 1, .sheen = 1, .sheen_tint = 1}, 64);
    // The imitation of subsurface scattering, of which Burley's formula has a pole where both directions graze.
    test::check_extremes(PrincipledThin{.base_color = Rgb(1), .roughness = 1, .flatness = 1}, infinity);
    test::check_extremes(PrincipledThin{.base_color = Rgb(0), .spec_trans = 0.5f, .spec_tint = 1, .sheen = 1}, 12);
}

TEST_CASE("principled thin: what is seen through a pane is blurred up to an alpha of 100") {
    const Vec3 up(0, 0, 1);
    for (const float eta : {20.0f, 100.0f, 1000.0f}) {
        const PrincipledThin pane{.base_color = Rgb(1), .roughness = 1, .spec_trans = 1, .eta = eta};
        const double through = 4 * double(eta) / std::pow(1 + double(eta), 2);
        CHECK(pane.evaluate(up, -up, Transport::radiance).value.y ==
              relative(through / (4 * 1e4 * std::acos(-1.0)), 1e-3));
    }
}

TEST_CASE("principled thin: impossible parameters are explained") {
    CHECK(PrincipledThin{}.problem() == "");
    CHECK(PrincipledThin{.roughness = 0, .diff_trans = 2}.problem() == "");
    CHECK(PrincipledThin{.base_color = Rgb(0, 1.5f, 0)}.problem().find("base_color has a component of 1.5") == 0);
    CHECK(PrincipledThin{.eta = 0}.problem().find("eta is") == 0);
    CHECK(PrincipledThin{.diff_trans = 2.1f}.problem().find("diff_trans is") == 0);
    for (const float bad : {-0.1f, 1001.0f, infinity, NAN})
        for_each_parameter<PrincipledThin>([&](std::size_t, const auto& parameter) {
            PrincipledThin model;
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(model.*parameter.member)>, float>)
                model.*parameter.member = bad;
            else model.*parameter.member = Rgb(bad);
            CHECK(model.problem().find(std::string(parameter.name)) == 0);
        });
}

TEST_CASE("principled thin: Phong terms") {
    CHECK(PrincipledThin{}.phong().diffuse == Rgb(0.5f));
    CHECK(is_black(PrincipledThin{}.phong().specular));
    const PhongTerms pane = PrincipledThin{.roughness = 0, .spec_trans = 1}.phong();
    CHECK((max_component(pane.diffuse) < 0.2f && max_component(pane.specular) > 0.2f && pane.shininess == 1000));
    CHECK(max_component(
              PrincipledThin{.base_color = {0, 0, 1}, .spec_trans = 1, .eta = 3, .spec_tint = 1}.phong().specular) <=
          1);
}
