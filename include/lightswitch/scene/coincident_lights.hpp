#pragma once

// Lamps that lie in another surface, of which rounding decides who sees them.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/light/source.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lightswitch {

/// Which emitters of a scene lie in another surface, so that rays which should meet the one meet the other: then shadow
/// rays reach the lamp and rays that look at it do not, and methods differ.
struct CoincidentLight {
    std::size_t emitter = 0;  ///< index in `Scene::emitters()`
    double share = 0;         ///< of its places that rays from in front do not see, about
};

/// Those of which rays from in front miss at least a quarter: of a block that stands on a floor it is a sixth. They are
/// found by `most_rays` pairs of rays in all, at most 256 for each emitter and at least 8; of more emitters than that
/// allows, every so manieth is looked at. Deterministic.
template <class SceneType>
std::vector<CoincidentLight> coincident_lights(const SceneType& scene, std::size_t most_rays = 65536) {
    const std::vector<Emitter>& emitters = scene.emitters();
    std::vector<CoincidentLight> found;
    const std::size_t step = emitters.size() / (most_rays / 8 + 1) + 1;
    const std::size_t rays = std::clamp<std::size_t>(most_rays / std::max<std::size_t>(emitters.size(), 1), 8, 256);
    for (std::size_t i = 0; i < emitters.size(); i += step) {
        const Emitter& emitter = emitters[i];
        if (emitter.kind != Emitter::Kind::surface || emitter.light_count == 0) continue;
        RandomSequence random(i);
        std::size_t seen = 0, missed = 0;
        for (std::size_t ray = 0; ray < rays; ++ray) {
            const auto number =
                emitter.first_light + static_cast<std::size_t>(random.next() * double(emitter.light_count));
            const Vec2 place(random.next_float(), random.next_float());
            const Vec2 direction(random.next_float(), random.next_float());
            Ray out;
            scene.with_light(scene.light_of_number(number), [&](const auto& light) {
                if constexpr (requires { light.emit(place, direction); }) out = light.emit(place, direction).ray;
            });
            if (!(length_squared(out.direction) > 0.5f)) continue;
            // From halfway to what the lamp's own ray meets it looks back.
            float distance = std::sqrt(emitter.area);
            if (const auto hit = scene.intersect(out)) distance = std::min(distance, hit->distance);
            distance *= 0.5f;
            const Ray back{.origin = out.origin + distance * out.direction, .direction = -out.direction};
            const auto hit = scene.intersect(back);
            if (!hit) continue;
            const std::size_t met = hit->light ? scene.light_number(hit->light) : ~std::size_t{0};
            if (met - emitter.first_light < emitter.light_count) ++seen;
            else if (std::abs(hit->distance - distance) < 1e-5f * distance + 8 * hit->offset) ++missed;
        }
        if (seen + missed >= 4 && 4 * missed >= seen + missed)
            found.push_back({i, double(missed) / double(seen + missed)});
    }
    return found;
}

}  // namespace lightswitch
