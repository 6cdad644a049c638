#pragma once

// How often each light of a scene is chosen.

#include <lightswitch/light/build_light_tree.hpp>
#include <lightswitch/scene/scene_data.hpp>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <string>

namespace lightswitch::detail {

/// The lights of one emitter of a scene that is being built: the first of them, and how many there are.
struct PendingEmitter {
    TypedIndex light;
    std::size_t count;
};

/// The lights that a tree can choose, with as many steps as `table` gives them.
template <class... L>
std::vector<LightToChoose> lights_for_tree(const std::tuple<std::vector<L>...>& lights,
                                           const DiscreteDistribution& table) {
    std::vector<LightToChoose> result;
    std::uint32_t number = 0;
    const auto append = [&](const auto& list) {
        for (const auto& light : list) {
            const auto steps = static_cast<std::uint32_t>(table.probability(number) * 0x1p24f);
            if constexpr (BoundedLight<std::remove_cvref_t<decltype(light)>>) {
                const LightBounds bounds = light.bounds();
                if (steps > 0 && bounds.usable()) result.push_back({bounds, number, steps});
            }
            ++number;
        }
    };
    (append(std::get<std::vector<L>>(lights)), ...);
    return result;
}

/// Numbers the lights and decides how often each is chosen: half by power, half evenly among the emitters, because a
/// dim light may be the one that matters where it is near. Within an emitter its lights are chosen by power.
/// At surface points a tree takes over, of lights that have bounds, if there are at least `tree_from` of them.
template <class BsdfList, class... L>
void choose_lights(SceneData<BsdfList, Lights<L...>>& data, const std::vector<PendingEmitter>& pending,
                   std::size_t tree_from) {
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
    DiscreteDistribution table(weights);
    const auto start = std::chrono::steady_clock::now();
    std::vector<LightToChoose> bounded = lights_for_tree(data.lights, table);
    if (bounded.size() < std::max(tree_from, std::size_t{1})) {
        data.light_choice = LightChoice(std::move(table));
        return;
    }
    SceneStatistics& statistics = data.statistics;
    statistics.tree_lights = bounded.size();
    LightTree tree = LightTreeBuilder::build(std::move(bounded), table.size());
    statistics.light_tree_bytes = static_cast<std::int64_t>(tree.bytes());
    data.light_choice = LightChoice(std::move(table), std::move(tree));
    statistics.light_tree_build_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
