#pragma once

// What can be wrong with the layers of a scene description.

#include <lightswitch/core/problem.hpp>
#include <lightswitch/scene/description.hpp>

namespace lightswitch::detail {

/// Numbers of the materials that a layer lies over.
inline std::vector<std::size_t> below(const MaterialLayer& layer) {
    return std::visit(
        [](const auto& over) -> std::vector<std::size_t> {
            if constexpr (requires { over.inner; }) return {over.inner};
            else if constexpr (requires { over.back; }) return {over.front, over.back};
            else return {over.first, over.second};
        },
        layer);
}

/// How many layers may lie over each other.
inline constexpr int deepest_layers = 64;
inline constexpr int unknown_depth = -1;

/// Length of the longest chain of layers from `layer` down, of which `above` others lie over it; it need not be in the
/// scene yet. `depths[i]` is the length for material i, once it is known. Throws when it is more than `deepest_layers`.
template <class Material>
int depth_over(const SceneDescription<Material>& scene, const MaterialLayer& layer, const Origin& origin,
               std::vector<int>& depths, int above = 0);

/// The same from that material down.
template <class Material>
int layer_depth(const SceneDescription<Material>& scene, std::size_t number, std::vector<int>& depths, int above = 0) {
    constexpr int under_way = -2;
    const auto& material = scene.materials[number];
    if (!material.layer) return 0;
    if (depths[number] == under_way) fail(material.origin, "the material contains itself");
    if (depths[number] != unknown_depth) return depths[number];
    depths[number] = under_way;
    return depths[number] = depth_over(scene, *material.layer, material.origin, depths, above);
}

template <class Material>
int depth_over(const SceneDescription<Material>& scene, const MaterialLayer& layer, const Origin& origin,
               std::vector<int>& depths, int above) {
    int depth = 0;
    // Deeper down is not looked: each step takes room on the stack.
    if (above >= deepest_layers) depth = deepest_layers;
    else
        for (const std::size_t inner : below(layer)) {
            if (inner >= scene.materials.size()) fail(origin, "the material inside does not exist");
            depth = std::max(depth, layer_depth(scene, inner, depths, above + 1));
        }
    if (depth >= deepest_layers)
        fail(origin, "more than " + std::to_string(deepest_layers) + " materials lie over each other");
    return depth + 1;
}

/// Whether `found(material)` is true of a material or of one that it lies over. Each is asked once, however often it is
/// used.
template <class Material>
bool any_below(const SceneDescription<Material>& scene, std::size_t number, const auto& found) {
    if (number < scene.materials.size() && !scene.materials[number].layer) return found(scene.materials[number]);
    std::vector<bool> seen(scene.materials.size(), false);
    std::vector<std::size_t> pending{number};
    while (!pending.empty()) {
        const std::size_t next = pending.back();
        pending.pop_back();
        if (next >= seen.size() || seen[next]) continue;
        seen[next] = true;
        const auto& material = scene.materials[next];
        if (found(material)) return true;
        if (!material.layer) continue;
        for (const std::size_t inner : below(*material.layer)) pending.push_back(inner);
    }
    return false;
}

/// Whether a ray can go through the surface because it is masked.
template <class Material>
bool is_masked(const SceneDescription<Material>& scene, std::size_t number) {
    return any_below(scene, number, [](const auto& material) {
        return material.layer && std::holds_alternative<Mask>(*material.layer);
    });
}

/// What a coat cannot lie over.
template <class Material>
std::string coating_problem(const SceneDescription<Material>& scene, const Coating& coating) {
    std::string problem;
    any_below(scene, coating.inner, [&](const auto& material) {
        if (!material.layer || std::holds_alternative<Blend>(*material.layer) ||
            std::holds_alternative<BothSides>(*material.layer))
            return false;
        problem = "a coat cannot lie over another layer that is a " + std::string(layer_name(*material.layer));
        return true;
    });
    return problem;
}

inline std::string layer_problem(const MaterialLayer& layer) {
    const auto fraction_problem = [](const std::string& what, const Texture& texture) -> std::string {
        if (const std::string problem = texture.problem(); !problem.empty()) return problem;
        if (luminance(texture.least()) >= -1e-4f && luminance(texture.most()) <= 1 + 1e-4f) return {};
        return what + " has values outside 0 to 1";
    };
    if (const auto* blend = std::get_if<Blend>(&layer)) return fraction_problem("the weight", blend->weight);
    if (const auto* mask = std::get_if<Mask>(&layer)) return fraction_problem("the opacity", mask->opacity);
    if (const auto* coating = std::get_if<Coating>(&layer)) return coating->coat.problem();
    if (const auto* map = std::get_if<NormalMap>(&layer)) {
        if (!is_finite(map->scale)) return "the scale of the normal map is not a finite number";
        return map->normals.problem();
    }
    if (const auto* bump = std::get_if<BumpMap>(&layer)) {
        if (!is_finite(bump->scale)) return "the scale of the bump map is not a finite number";
        return bump->height.problem();
    }
    return {};
}

}  // namespace lightswitch::detail
