#include "verify/planted/lights.hpp"
#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

using RoundLampScene = Scene<DiffuseBsdfs, Lights<SphereLight>>;

Estimator relit(const LibraryDescription& description, LightMistake mistake) {
    return estimator(std::make_shared<const Relit<DiffuseScene>>(
                         build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description), mistake),
                     PathTracerNee{});
}

Estimator relit_round(const LibraryDescription& description, LightMistake mistake) {
    return estimator(std::make_shared<const Relit<RoundLampScene>>(
                         build_scene<DiffuseBsdfs, Lights<SphereLight>>(description), mistake),
                     PathTracerNee{});
}

Estimator by_tree(TreeMistake mistake) {
    return estimator(std::make_shared<const ByTree<DiffuseScene>>(
                         build_scene<DiffuseBsdfs, Lights<TriangleLight>>(floor_and_many_lamps()), mistake),
                     PathTracerNee{});
}

template <class M>
Estimator under_sky(bool sine_missing, const M& method) {
    LibraryDescription description = ball_in_sky<AnyMaterial>(Lambert{Rgb(0.7f)});
    description.sources.clear();
    description.add(level({0, -1, 0}, 2, 2), 0);
    return estimator(std::make_shared<const UnderSky<DiffuseScene>>(
                         build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description), sine_missing),
                     method);
}

}  // namespace

std::vector<PlantedBug> light_bugs() {
    using enum LightMistake;
    using Describe = std::function<LibraryDescription()>;
    std::vector<PlantedBug> bugs;
    const auto add = [&](std::string_view name, std::string_view scene, int first_length, LightMistake mistake,
                         const Describe& describe, auto wrong) {
        bugs.push_back({name, scene, first_length, [=] {
                            const LibraryDescription description = describe();
                            return std::pair(wrong(description, mistake), library_nee(description));
                        }});
    };
    const auto floor = [] { return floor_and_lamp(); };
    const auto floor_from_above = [] { return floor_and_lamp(2.5); };
    add("light chosen by power, weighted uniformly", "floor-and-four-lamps", 2, weighted_uniformly,
        floor_and_four_lamps, relit);
    add("last light never chosen", "floor-and-four-lamps", 2, last_never_chosen, floor_and_four_lamps, relit);
    add("area density taken for solid angle", "floor-and-lamp", 2, area_density, floor, relit);
    add("root missing in the triangle warp", "floor-and-lamp", 2, root_missing, floor, relit);
    add("lamp emits from its back", "floor-and-lamp from above", 1, emits_backwards, floor_from_above, relit);
    add("light sampled from behind", "lamp-below-ceiling", 2, samples_backwards, lamp_below_ceiling, relit);
    add("emission side by the shading normal", "floor-and-faceted-lamp", 1, emits_by_shading_normal,
        floor_and_faceted_lamp, relit);
    add("light's cosine by the shading normal", "floor-and-faceted-lamp", 2, density_by_shading_normal,
        floor_and_faceted_lamp, relit);
    add("sphere sampled by area, weighted by cone", "floor-and-round-lamp", 2, area_sample_cone_density,
        floor_and_round_lamp, relit_round);
    add("cone of the sphere light too narrow", "floor-and-round-lamp", 2, cone_too_narrow, floor_and_round_lamp,
        relit_round);

    const auto of_tree = [&](std::string_view name, TreeMistake mistake) {
        bugs.push_back({name, "floor-and-many-lamps", 2,
                        [=] { return std::pair(by_tree(mistake), library_nee(floor_and_many_lamps())); }});
    };
    of_tree("light tree: density of the level above", TreeMistake::met_density_of_level_above);
    of_tree("light tree: probability of the other branch", TreeMistake::branch_probability_swapped);
    bugs.push_back({"sky density without the sine", "ball-and-floor in a gradient sky", 2,
                    [] { return std::pair(under_sky(true, PathTracerNee{}), under_sky(false, PathTracer{})); }});
    return bugs;
}

std::vector<CorrectPair> light_copies() {
    return {{"triangle lights without a mistake", "floor-and-four-lamps",
             [] {
                 const LibraryDescription description = floor_and_four_lamps();
                 return std::pair(relit(description, LightMistake::none), library_nee(description));
             }},
            {"light tree without a mistake", "floor-and-many-lamps",
             [] { return std::pair(by_tree(TreeMistake::none), library_nee(floor_and_many_lamps())); }},
            {"sphere light without a mistake", "floor-and-round-lamp",
             [] {
                 const LibraryDescription description = floor_and_round_lamp();
                 return std::pair(relit_round(description, LightMistake::none), library_nee(description));
             }},
            {"sky: path, path-nee", "ball-and-floor in a gradient sky",
             [] { return std::pair(under_sky(false, PathTracer{}), under_sky(false, PathTracerNee{})); }}};
}

}  // namespace lightswitch::test
