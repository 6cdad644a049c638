#include "verify/planted/pixels.hpp"

#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

Estimator planted(const LibraryDescription& description, PixelMistake mistake) {
    const auto scene =
        std::make_shared<const DiffuseScene>(build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description));
    return planted_estimator(scene, PathTracerNee{}, mistake);
}

}  // namespace

std::vector<PlantedBug> pixel_bugs() {
    using Describe = std::function<LibraryDescription()>;
    std::vector<PlantedBug> bugs;
    const auto add = [&](std::string_view name, std::string_view scene, int first_length, PixelMistake mistake,
                         const Describe& describe) {
        bugs.push_back({name, scene, first_length,
                        [=] {
                            const LibraryDescription description = describe();
                            return std::pair(planted(description, mistake), library_nee(description));
                        },
                        mistake == PixelMistake::neighbours_alike});
    };
    const auto floor = [] { return floor_and_lamp(); };
    const auto far_lamp = [] {
        auto scene = floor_under_far_lamp<AnyMaterial>(Lambert{Rgb(0.7f)}, Lambert{Rgb(0)});
        scene.film.width = scene.film.height = 32;
        return scene;
    };
    add("image shifted by half a pixel", "floor-and-lamp", 1, PixelMistake::half_pixel, floor);
    add("neighbouring pixels share random numbers", "floor-and-lamp", 0, PixelMistake::neighbours_alike, floor);
    add("one corner of 64 tiles 5 % too dark", "floor-under-far-lamp, 32 x 32", 2, PixelMistake::corner_too_dark,
        far_lamp);
    return bugs;
}

std::vector<CorrectPair> pixel_copies() {
    return {{"pixel loop without a mistake", "floor-and-lamp", [] {
                 const LibraryDescription description = floor_and_lamp();
                 return std::pair(planted(description, PixelMistake::none), library_nee(description));
             }}};
}

}  // namespace lightswitch::test
