#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/rough_dielectric.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

using namespace lightswitch;
using test::direction;
using test::relative;

static_assert(Bsdf<RoughDielectric> && transmits<RoughDielectric>);

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
