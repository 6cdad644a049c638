#include "verify/planted/methods.hpp"
#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

/// For methods that take long to compile.
template <class M>
Estimator on_diffuse_scene(const LibraryDescription& description, const M& method) {
    return estimator(
        std::make_shared<const DiffuseScene>(build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description)), method);
}

}  // namespace

std::vector<PlantedBug> method_bugs() {
    std::vector<PlantedBug> bugs;
    using Describe = std::function<LibraryDescription()>;
    const auto nee = [&](std::string_view name, std::string_view scene, int first_length, NeeMistake mistake,
                         const Describe& describe, int max_depth = -1) {
        bugs.push_back({name, scene, first_length, [=] {
                            const LibraryDescription description = describe();
                            return std::pair(
                                on_library_scene(description, PlantedNee{.mistake = mistake, .max_depth = max_depth}),
                                library_nee(description, {.max_depth = max_depth}));
                        }});
    };
    const auto floor = [] { return floor_and_lamp(); };
    const auto panel = [] { return floor_under_panel<AnyMaterial>(Lambert{Rgb(0.7f)}, Lambert{Rgb(0)}); };
    const auto far_lamp = [] { return floor_under_far_lamp<AnyMaterial>(Lambert{Rgb(0.7f)}, Lambert{Rgb(0)}); };
    nee("cosine missing in direct light", "floor-and-lamp", 2, NeeMistake::cosine_missing, floor);
    nee("geometric cosine in direct light", "faceted-ball-and-lamp", 2, NeeMistake::geometric_cosine,
        faceted_ball_and_lamp);
    nee("direct light counted twice", "floor-and-lamp", 2, NeeMistake::light_counted_twice, floor);
    nee("sky counted twice", "ball-in-sky", 2, NeeMistake::sky_counted_twice,
        [] { return ball_in_sky<AnyMaterial>(Lambert{Rgb(0.7f)}); });
    nee("lights ignored when met", "floor-under-panel", 2, NeeMistake::met_lights_ignored, panel);
    nee("MIS without the probability of selection", "floor-and-four-lamps", 2, NeeMistake::met_density_unselected,
        floor_and_four_lamps);
    nee("MIS density 10 % off on one side", "floor-under-panel", 2, NeeMistake::met_density_ten_percent_off, panel);
    nee("MIS with the BSDF density of swapped directions", "floor-under-panel", 2, NeeMistake::bsdf_density_swapped,
        panel);
    nee("emission lost after a mirror", "mirror-and-lamp", 2, NeeMistake::emission_lost_after_mirror, mirror_and_lamp);
    nee("emission lost at the camera", "floor-and-lamp", 1, NeeMistake::emission_lost_at_camera, floor);
    nee("shadow ray starts inside", "floor-and-lamp", 2, NeeMistake::shadow_ray_from_inside, floor);
    nee("shadow ray skips 0.05", "wall-and-shadow", 2, NeeMistake::shadow_ray_skips, wall_and_shadow);
    nee("one bounce more than max_depth", "cornell-box", 1, NeeMistake::one_bounce_more, small_box, 3);
    nee("light point reuses the pair of the direction", "indirect-ceiling", 3, NeeMistake::light_point_reused,
        indirect_ceiling);
    nee("direct light 0.2 % too strong", "floor-under-far-lamp", 2, NeeMistake::light_too_strong, far_lamp);
    nee("blue of direct light 1 % too strong", "floor-under-far-lamp", 2, NeeMistake::blue_too_strong, far_lamp);

    const auto path = [&](std::string_view name, int first_length, PathMistake mistake) {
        bugs.push_back({name, "cornell-box", first_length, [=] {
                            const LibraryDescription description = small_box();
                            return std::pair(on_library_scene(description, PlantedPath{.mistake = mistake}),
                                             library_nee(description));
                        }});
    };
    path("throughput without the first weight", 2, PathMistake::first_weight_forgotten);
    path("indirect light clamped", 3, PathMistake::indirect_light_clamped);
    path("direction reused at every bounce", 3, PathMistake::direction_reused);

    // The first bounce that roulette decides is the one after `rr_depth`, and what it leads to is one longer.
    const auto roulette = [&](std::string_view name, PathMistake mistake, int rr_depth) {
        bugs.push_back({name, "furnace", rr_depth + 2, [=] {
                            const LibraryDescription description = small_furnace(0.75f);
                            const PlantedPath wrong{.mistake = mistake, .rr_depth = rr_depth};
                            return std::pair(on_library_scene(description, wrong), library_path(description));
                        }});
    };
    roulette("roulette not compensated", PathMistake::roulette_not_compensated, 1);
    roulette("roulette compensated twice", PathMistake::roulette_compensated_twice, 3);

    const auto chains = [&](std::string_view name, ChainMistake mistake) {
        bugs.push_back({name, "wall-and-shadow", 2, [=] {
                            const LibraryDescription description = wall_and_shadow();
                            return std::pair(on_diffuse_scene(description, PlantedMlt{mistake}),
                                             library_nee(description));
                        }});
    };
    chains("what is left to chains counted twice", ChainMistake::left_counted_twice);
    chains("chains without the ratio", ChainMistake::every_step_accepted);
    chains("energy of small finds lost", ChainMistake::energy_lost);
    return bugs;
}

std::vector<CorrectPair> method_copies() {
    return {{"planted-nee without a mistake", "mirror-and-lamp",
             [] {
                 const LibraryDescription description = mirror_and_lamp();
                 return std::pair(on_library_scene(description, PlantedNee{}), library_nee(description));
             }},
            {"planted-path without a mistake", "cornell-box",
             [] {
                 const LibraryDescription description = small_box();
                 return std::pair(on_library_scene(description, PlantedPath{}), library_path(description));
             }},
            {"planted-mlt without a mistake", "cornell-box", [] {
                 const LibraryDescription description = small_box();
                 return std::pair(on_diffuse_scene(description, PlantedMlt{}), library_nee(description));
             }}};
}

}  // namespace lightswitch::test
