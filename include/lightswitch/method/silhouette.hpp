#pragma once

#include <lightswitch/render/method.hpp>
#include <lightswitch/render/recording.hpp>

namespace lightswitch {

/// One colour where a ray hits anything, black elsewhere: the coverage of the scene (Sato and Cohen 2021, the first
/// renderer of the paper, which uses magenta).
struct Silhouette {
    static constexpr std::string_view name = "silhouette";
    static constexpr Kind kind = Kind::heuristic;

    Rgb color{1, 0, 1};

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const {
        const Rgb found = scene.intersect(ray) ? color : Rgb(0);
        tell(scene, Contributed{.value = found});
        return found;
    }
};

}  // namespace lightswitch
