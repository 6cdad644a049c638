#include "verify/planted/bsdfs.hpp"
#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

using enum BsdfMistake;
using Material = std::variant<PlantedLambert, PlantedDielectric, PlantedRoughConductor, PlantedCoat, Coated>;
using PlantedScene = Scene<Bsdfs<PlantedLambert, PlantedDielectric, PlantedRoughConductor, PlantedCoat, Coated>,
                           Lights<ConstantEnvironment, TriangleLight>>;

std::shared_ptr<const PlantedScene> build(const SceneDescription<Material>& description) {
    return std::make_shared<const PlantedScene>(
        build_scene<Bsdfs<PlantedLambert, PlantedDielectric, PlantedRoughConductor, PlantedCoat, Coated>,
                    Lights<ConstantEnvironment, TriangleLight>>(description));
}

Estimator on_planted(const SceneDescription<Material>& description) {
    return estimator(build(description), PathTracerNee{});
}

/// `PlantedCoat` without a mistake as the library has it, in the place of the first material.
LibraryDescription coated(LibraryDescription scene) {
    scene.materials[0].layer = Coating{scene.add(PlantedCoat::base), PlantedCoat::coat};
    return scene;
}

}  // namespace

std::vector<PlantedBug> bsdf_bugs() {
    const Material planted_black = PlantedLambert{.reflectance = Rgb(0)};
    std::vector<PlantedBug> bugs;

    const auto ball = [&](std::string_view name, const Material& material, const AnyMaterial& right) {
        bugs.push_back({name, "ball-in-sky", 2,
                        [=] { return std::pair(on_planted(ball_in_sky(material)), library_nee(ball_in_sky(right))); }});
    };
    ball("cosine doubled in the weight of samples", PlantedLambert{cosine_doubled, Rgb(1)}, Lambert{Rgb(1)});
    ball("Fresnel reflectance also in the weight", PlantedDielectric{fresnel_in_weight}, Dielectric{});

    bugs.push_back({"refraction without the scale of radiance", "inside-glass", 2, [] {
                        const auto description = inside_glass<Material>(PlantedDielectric{radiance_unscaled});
                        return std::pair(on_planted(description), library_nee(inside_glass<AnyMaterial>(Dielectric{})));
                    }});
    // Seen from inside, where the wrong index has total reflection nowhere.
    bugs.push_back({"refraction with the index reversed", "inside-glass", 2, [] {
                        const auto description = inside_glass<Material>(PlantedDielectric{refraction_reversed});
                        return std::pair(on_planted(description), library_nee(inside_glass<AnyMaterial>(Dielectric{})));
                    }});

    const auto floor = [&](std::string_view name, const Material& material, const AnyMaterial& right) {
        bugs.push_back({name, "floor-and-lamp", 2, [=] {
                            return std::pair(on_planted(floor_and_lamp(material, planted_black)),
                                             library_nee(floor_and_lamp<AnyMaterial>(right, Lambert{Rgb(0)})));
                        }});
    };
    const Rgb blue(0.2f, 0.5f, 0.8f);
    floor("1 / pi missing in the value", PlantedLambert{inverse_pi_missing}, Lambert{});
    floor("colour channels swapped", PlantedLambert{channels_swapped, blue}, Lambert{blue});
    const RoughConductor rough{.distribution = Facets::ggx, .alpha_u = 0.5f, .alpha_v = 0.5f};
    floor("GGX density without the Jacobian", PlantedRoughConductor{jacobian_missing}, rough);
    floor("GGX density without the Jacobian in the value alone", PlantedRoughConductor{jacobian_missing_in_value},
          rough);
    floor("GGX masking of one direction missing", PlantedRoughConductor{masking_one_sided}, rough);

    const auto coat = [&](std::string_view name, BsdfMistake mistake) {
        bugs.push_back({name, "floor-under-panel", 2, [=] {
                            const Material material = PlantedCoat{mistake};
                            const AnyMaterial any = Lambert{}, black = Lambert{Rgb(0)};
                            return std::pair(on_planted(floor_under_panel(material, planted_black)),
                                             library_nee(coated(floor_under_panel(any, black))));
                        }});
    };
    coat("coat: 1 / eta^2 missing", coat_spreads_nothing);
    coat("coat: absorbs on one of two ways", coat_absorbs_one_way);
    coat("coat: density of the direction inside in the value alone", coat_density_of_inside);

    bugs.push_back({"albedo 0.5 % too high in the value alone", "floor-under-far-lamp", 2, [planted_black] {
                        const Material bright = PlantedLambert{value_half_percent_up, Rgb(0.7f)};
                        const AnyMaterial right = Lambert{Rgb(0.7f)}, black = Lambert{Rgb(0)};
                        return std::pair(on_planted(floor_under_far_lamp(bright, planted_black)),
                                         library_nee(floor_under_far_lamp(right, black)));
                    }});
    bugs.push_back({"lobe and direction from one number", "floor-under-panel", 2, [planted_black] {
                        const auto wrong = floor_under_panel<Material>(Coated{lobe_shares_number}, planted_black);
                        return std::pair(estimator(build(wrong), PathTracer{}),
                                         on_planted(floor_under_panel<Material>(Coated{}, planted_black)));
                    }});
    return bugs;
}

std::vector<CorrectPair> bsdf_copies() {
    const Material planted_black = PlantedLambert{none, Rgb(0)};
    const auto floor = [=](std::string_view name, const Material& copy, const AnyMaterial& original) {
        return CorrectPair{name, "floor-and-lamp", [=] {
                               const AnyMaterial black = Lambert{Rgb(0)};
                               return std::pair(on_planted(floor_and_lamp(copy, planted_black)),
                                                library_nee(floor_and_lamp(original, black)));
                           }};
    };
    return {floor("lambert without a mistake", PlantedLambert{}, Lambert{}),
            floor("rough conductor without a mistake", PlantedRoughConductor{},
                  RoughConductor{.distribution = Facets::ggx, .alpha_u = 0.5f, .alpha_v = 0.5f}),
            {"dielectric without a mistake", "ball-in-sky",
             [] {
                 return std::pair(on_planted(ball_in_sky<Material>(PlantedDielectric{})),
                                  library_nee(ball_in_sky<AnyMaterial>(Dielectric{})));
             }},
            {"coat without a mistake", "floor-and-lamp",
             [=] {
                 const AnyMaterial any = Lambert{}, black = Lambert{Rgb(0)};
                 return std::pair(on_planted(floor_and_lamp<Material>(PlantedCoat{}, planted_black)),
                                  library_nee(coated(floor_and_lamp(any, black))));
             }},
            {"two lobes: path, path-nee", "floor-and-lamp", [=] {
                 const auto scene = build(floor_and_lamp<Material>(Coated{}, planted_black));
                 return std::pair(estimator(scene, PathTracer{}), estimator(scene, PathTracerNee{}));
             }}};
}

}  // namespace lightswitch::test
