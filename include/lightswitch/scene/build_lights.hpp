#pragma once

// How often each light of a scene is chosen.

#include <lightswitch/scene/scene_data.hpp>

#include <algorithm>
#include <numeric>
#include <string>

namespace lightswitch::detail {

/// The lights of one emitter of a scene that is being built: the first of them, and how many there are.
struct PendingEmitter {
    TypedIndex light;
    std::size_t count;
};

/// Numbers the lights and decides how often each is chosen: half by power, half evenly among the emitters, because a
/// dim light may be the one that matters where it is near. Within an emitter its lights are chosen by power.
template <class BsdfList, class... L>
void choose_lights(SceneData<BsdfList, Lights<L...>>& data, const std::vector<PendingEmitter>& pending) {
    std::vector<double> powers;
    const auto append_powers = [&](const auto& lights) {
        for (const auto& light : lights) powers.push_back(light.power());
    };
    (append_powers(std::get<std::vector<L>>(data.lights)), ...);
    data.statistics.lights = powers.size();
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    if (!(total > 0)) return;
    const std::size_t counts[] = {std::get<std::vector<L>>(data.lights).size()..., 0};
    std::vector<double> weights(powers.size());
    for (std::size_t i = 0; i < pending.size(); ++i) {
        std::size_t first = pending[i].light.position();
        for (std::size_t kind = 0; kind < pending[i].light.kind(); ++kind) first += counts[kind];
        Emitter& emitter = data.emitters[i];
        emitter.first_light = first;
        emitter.light_count = pending[i].count;
        const auto begin = powers.begin() + std::ptrdiff_t(first);
        const double power = std::accumulate(begin, begin + std::ptrdiff_t(emitter.light_count), 0.0);
        for (std::size_t light = first; light < first + emitter.light_count; ++light)
            if (power > 0) weights[light] = powers[light] * (1 / total + 1 / (power * double(pending.size())));
    }
    data.light_choice = DiscreteDistribution(weights);
}

/// Refuses light of which products would be lost in single precision, unless that is much less than there is besides.
/// Of points it is compared in render space, where their intensity is about what they do to surfaces.
inline void refuse_dim(const std::vector<Emitter>& emitters, const std::string& scene) {
    float most = 0;
    for (const Emitter& emitter : emitters) most = std::max(most, max_component(emitter.strength));
    if (most > 0 && most < 1e-30f)
        throw Error(scene +
                    ": the brightest light is below 1e-30, where single precision ends: multiply all lights by " +
                    "the same power of two");
}

}  // namespace lightswitch::detail
