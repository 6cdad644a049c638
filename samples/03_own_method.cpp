// A rendering method of one's own: an aggregate with a name, a kind and one function. Nothing is registered or derived
// from; the compiler inlines it into the loop like the library's own.

#include <lightswitch/lightswitch.hpp>

#include <cstdio>

namespace ls = lightswitch;

/// How much of the hemisphere above a point is open up to `radius`: ambient occlusion.
struct AmbientOcclusion {
    static constexpr std::string_view name = "ao";
    static constexpr ls::Kind kind = ls::Kind::heuristic;
    double radius = 0.5;  // in scene units

    ls::Rgb radiance(const auto& scene, const ls::Ray& ray, auto& sampler) const {
        const auto hit = scene.intersect(ray);
        if (!hit) return ls::Rgb(0);
        const ls::Vec3 direction = hit->shading_frame().to_world(ls::cosine_hemisphere(sampler.next_2d()));
        return ls::Rgb(scene.occluded(hit->spawn(direction, scene.length(radius))) ? 0.0f : 1.0f);
    }
};

int main() try {
    ls::save("ambient-occlusion.png", ls::render(ls::stock::cornell_sculpture(), AmbientOcclusion{}, {.samples = 64}));
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
