#include "support/random_scenes.hpp"
#include "support/renders.hpp"
#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

LibraryDescription sized(LibraryDescription scene, int side) {
    scene.film.width = scene.film.height = side;
    return scene;
}

LibraryDescription sky_alone() {
    auto scene = ball_in_sky<AnyMaterial>(Lambert{{0.8f, 0.5f, 0.2f}});
    scene.add(level({0, -1, 0}, 3, 3), scene.add(TwoSided<Lambert>{{Rgb(0.6f)}}));
    return scene;
}

LibraryDescription thin_lens() {
    LibraryDescription scene = small_box();
    scene.camera.aperture_radius = 0.3;
    scene.camera.focus_distance = 3.5;
    scene.film.filter = Filter::gaussian();
    return scene;
}

/// 100 lamps of two triangles, of strengths from 1 to 50.
LibraryDescription many_lamps() {
    auto scene = empty_view<AnyMaterial>("many-lamps", {0, 1.2, 3}, {0, 0.3, 0}, 45);
    scene.add(level({0, 0, 0}, 1.2, 1.2), scene.add(Lambert{Rgb(0.7f)}));
    const std::size_t black = scene.add(Lambert{Rgb(0)});
    for (int i = 0; i < 100; ++i)
        scene.add(level({-0.9 + 0.2 * (i % 10), 0.3 + 0.005 * i, -0.9 + 0.2 * (i / 10)}, 0.03, 0.03, false), black,
                  Rgb(static_cast<float>(1 + i * 37 % 50)));
    return scene;
}

}  // namespace

std::vector<CorrectPair> correct_pairs() {
    using Describe = std::function<LibraryDescription()>;
    std::vector<CorrectPair> pairs;
    const auto path_and_nee = [&](std::string_view scene, const Describe& describe) {
        pairs.push_back({"path, path-nee", scene, [=] {
                             const LibraryDescription description = describe();
                             return std::pair(library_path(description), library_nee(description));
                         }});
    };
    path_and_nee("cornell-box", small_box);
    path_and_nee("cornell-spheres, 32 x 32", [] { return sized(stock::describe_cornell_spheres(), 32); });
    path_and_nee("veach-mis", [] { return sized(describe_veach_mis(), 16); });
    path_and_nee("ball-and-floor in the sky", sky_alone);
    path_and_nee("cornell-box, thin lens", thin_lens);
    path_and_nee("faceted-ball-and-lamp", faceted_ball_and_lamp);
    path_and_nee("many-lamps", many_lamps);
    path_and_nee("floor-and-round-lamp", floor_and_round_lamp);
    path_and_nee("random-3", [] { return random_scene(3); });
    path_and_nee("random-8", [] { return random_scene(8); });
    path_and_nee("random-14", [] { return random_scene(14); });

    pairs.push_back({"path, path", "cornell-box", [] {
                         const LibraryDescription description = small_box();
                         return std::pair(library_path(description), library_path(description));
                     }});
    pairs.push_back({"path-nee, path-nee with early roulette", "cornell-spheres, 32 x 32", [] {
                         const auto description = sized(stock::describe_cornell_spheres(), 32);
                         return std::pair(library_nee(description), library_nee(description, {.rr_depth = 1}));
                     }});
    const auto and_exact = [&](std::string_view name, std::string_view scene, const Describe& describe, float value,
                               auto library) {
        pairs.push_back({name, scene, [=] {
                             const LibraryDescription description = describe();
                             return std::pair(library(description), exactly_everywhere(description.film, value));
                         }});
    };
    const auto path = [](const LibraryDescription& d) { return library_path(d); };
    const auto nee = [](const LibraryDescription& d) { return library_nee(d); };
    const auto furnace = [] { return small_furnace(0.75f); };
    and_exact("path, exact", "furnace", furnace, 4, path);
    and_exact("path-nee, exact", "furnace", furnace, 4, nee);
    and_exact(
        "path, exact", "inside-glass", [] { return inside_glass<AnyMaterial>(Dielectric{}); }, 2.25f, path);
    and_exact(
        "path-nee, exact", "white ball-in-sky", [] { return ball_in_sky<AnyMaterial>(Lambert{Rgb(1)}); }, 1, nee);
    for (const auto& copies : {method_copies(), bsdf_copies(), light_copies(), pixel_copies(), guided_copies()})
        pairs.insert(pairs.end(), copies.begin(), copies.end());
    return pairs;
}

}  // namespace lightswitch::test
