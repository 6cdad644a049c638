#include <lightswitch/bsdf/lambert.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"

using namespace lightswitch;
using test::relative;

static_assert(Bsdf<Lambert>);

namespace {
const double level = test::sidak(1e-6, 4);
const Lambert lambert{.reflectance = {0.25f, 0.5f, 0.75f}};
}  // namespace

TEST_CASE("lambert: sampling follows the density, on both sides of a two-sided surface") {
    test::check_density(lambert, test::direction(0.9), 1, level, 1);
    test::check_density(lambert, test::direction(1e-3), 1, level, 2);
}

TEST_CASE("lambert: a missing cosine in the density is found") {
    struct Wrong : Lambert {
        BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport t) const {
            BsdfValue v = Lambert::evaluate(wo, wi, t);
            v.pdf = {wi.z > 0 ? 0.5f * inv_pi : 0};
            return v;
        }
    };
    const Wrong wrong;
    const Vec3 wo = test::direction(0.5);
    const auto result = test::chi_square_sphere(
        [&](const Vec3& u) { return std::optional(wrong.sample(wo, u, Transport::radiance)->wi); },
        [&](const Vec3& wi) { return double(wrong.evaluate(wo, wi, Transport::radiance).pdf.value); }, {}, 200000, 1);
    CHECK(result.chi_square.p_value < 1e-12);
}

TEST_CASE("lambert: energy, weights and reciprocity") {
    CHECK(test::check_albedo(lambert, test::direction(0.2), 1, 5) == relative(0.5, 1e-5));
    test::check_sample_agrees_with_evaluate(lambert, test::direction(0.2), 1e-6, 1e-6);
    test::check_reciprocity(lambert);
}

TEST_CASE("lambert: extremes") { test::check_extremes(lambert); }

TEST_CASE("lambert: the back is black") {
    const Vec3 up = test::direction(0.5), down = test::direction(-0.5);
    CHECK(is_black(lambert.evaluate(down, down, Transport::radiance).value));
    CHECK(is_black(lambert.evaluate(up, down, Transport::radiance).value));
    CHECK_FALSE(lambert.sample(down, Vec3(0.3f), Transport::radiance));
}

TEST_CASE("lambert: impossible parameters are explained") {
    CHECK(lambert.problem() == "");
    CHECK(Lambert{.reflectance = Rgb(1.5f, 0, 0)}.problem().find("reflectance has a component of 1.5") !=
          std::string::npos);
    CHECK(Lambert{.reflectance = Rgb(0, -0.1f, 0)}.problem() != "");
    CHECK(Lambert{.reflectance = Rgb(0, 0, NAN)}.problem() != "");
    CHECK(lambert.phong().diffuse == lambert.reflectance);
}
