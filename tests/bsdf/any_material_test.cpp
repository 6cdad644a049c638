#include <lightswitch/bsdf/any_material.hpp>

#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/principled.hpp>
#include <lightswitch/texture/textured.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;

namespace {

/// A model of one's own that says no more than it must.
struct Soot {
    static constexpr bool specular = false;

    float darkness = 1;

    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }
    Maybe<BsdfSample> sample(const Vec3&, const Vec3&, Transport) const { return {}; }
    std::string problem() const { return darkness > 0 ? "" : "the darkness is not positive"; }
};

}  // namespace

TEST_CASE("any material: is what it was made from, and nothing else") {
    const AnyMaterial grey, soot = Soot{2}, textured = Textured<Lambert>(Lambert{Rgb(0.25f)});
    CHECK(grey.as<Lambert>().reflectance == Lambert{}.reflectance);
    CHECK(soot.as<Soot>().darkness == 2);
    CHECK(soot.get<Lambert>() == nullptr);
    CHECK(textured.get<Lambert>() == nullptr);
    CHECK(textured.get<Textured<Lambert>>() != nullptr);
    CHECK_THROWS_AS(textured.as<Lambert>(), std::bad_cast);

    AnyMaterial copy = soot;
    copy = Lambert{Rgb(0.125f)};
    CHECK(copy.as<Lambert>().reflectance == Rgb(0.125f));
    CHECK(soot.as<Soot>().darkness == 2);
}

TEST_CASE("any material: tells of the material what checks ask") {
    CHECK(AnyMaterial(Soot{}).problem().empty());
    CHECK(AnyMaterial(Soot{0}).problem() == "the darkness is not positive");
    CHECK_FALSE(AnyMaterial(Lambert{Rgb(2)}).problem().empty());

    CHECK(AnyMaterial(Dielectric{}).transmits_light());
    CHECK_FALSE(AnyMaterial(Lambert{}).transmits_light());

    CHECK(AnyMaterial(Soot{}).isotropic());
    CHECK(AnyMaterial(Principled{}).isotropic());
    CHECK_FALSE(AnyMaterial(Principled{.anisotropic = 0.5f}).isotropic());

    CHECK(AnyMaterial(Lambert{}).model_name() == "diffuse");
    CHECK(AnyMaterial(Textured<Lambert>(Lambert{})).model_name() == "diffuse");
    CHECK(AnyMaterial(Soot{}).model_name().empty());
    CHECK_FALSE(AnyMaterial(Lambert{}).placed());
    CHECK(AnyMaterial(Textured<Lambert>(Lambert{})).placed());
}
