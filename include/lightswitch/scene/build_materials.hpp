#pragma once

// From the materials of a description to those of a scene: surface models by kind, and the layers over them.

#include <lightswitch/bsdf/any_material.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/scene_data.hpp>

#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>

namespace lightswitch::detail {

template <class Data>
class MaterialAssembly;

template <class... B, class... L>
class MaterialAssembly<SceneData<Bsdfs<B...>, Lights<L...>>> {
public:
    using Data = SceneData<Bsdfs<B...>, Lights<L...>>;

    /// Puts the materials of a checked description into `data`.
    template <class M>
    MaterialAssembly(const SceneDescription<M>& description, Data& data)
        : data_(data), indices_(description.materials.size(), MaterialIndex(unknown, 0)) {
        for (std::size_t i = 0; i < indices_.size(); ++i) add_material(description, i);
    }

    /// By the numbers of the description.
    const std::vector<MaterialIndex>& indices() const { return indices_; }

private:
    static constexpr std::size_t layers = sizeof...(B);
    static constexpr std::size_t unknown = layers + 1;
    static constexpr bool placed = (PlacedMaterial<B> || ...);

    /// Adds the material of that number, and those that it lies over before it.
    void add_material(const auto& description, std::size_t number) {
        if (indices_[number].kind() != unknown) return;
        const auto& material = description.materials[number];
        if (material.layer) {
            add_layer(description, number);
            return;
        }
        const auto add_one = [&](const auto& bsdf) { return add(bsdf, material.two_sided, material.origin); };
        if constexpr (requires { std::visit(add_one, material.bsdf); })
            indices_[number] = std::visit(add_one, material.bsdf);
        else if constexpr (std::same_as<decltype(material.bsdf), AnyMaterial>)
            indices_[number] = add_any(material.bsdf, material.two_sided, material.origin);
        else indices_[number] = add_one(material.bsdf);
    }

    void add_layer(const auto& description, std::size_t number) {
        const auto& material = description.materials[number];
        const MaterialLayer& layer = *material.layer;
        if (!placed)
            fail(material.origin,
                 "this scene type has no place for layers of materials; put a Textured<...> into the scene's "
                 "Bsdfs<...>");
        for (const std::size_t inner : below(layer)) add_material(description, inner);
        if (const auto* coating = std::get_if<Coating>(&layer)) {
            if (!coating->coat.smooth() && has_specular_model(indices_[coating->inner]))
                fail(material.origin,
                     "a rough coat cannot lie over a mirror, or over other models without a smooth lobe");
            data_.coats.push_back(CoatOptics(coating->coat));
        }
        check_count(data_.layers.size(), MaterialIndex::max_position, material.origin, "layers of materials");
        indices_[number] = MaterialIndex(layers, data_.layers.size(),
                                         MaterialIndex::varying | (material.two_sided ? MaterialIndex::both_sides : 0));
        data_.layers.push_back(record(layer));
        data_.masked = data_.masked || std::holds_alternative<Mask>(layer);
        count_ways(material.origin);
    }

    /// Finds whether the latest layer is certain. If it is not, `presence` goes all ways down from it, for photons.
    void count_ways(const Origin& origin) {
        constexpr double most = 65536;
        LayerRecord& layer = data_.layers.back();
        const bool both = layer.kind == LayerRecord::Kind::blend || layer.kind == LayerRecord::Kind::both_sides;
        double ways = 0;
        layer.certain = layer.kind != LayerRecord::Kind::mask;
        for (std::size_t i = 0; i < (both ? 2 : 1); ++i) {
            const MaterialIndex inner = layer.inner[i];
            const bool is_layer = inner.kind() == layers;
            ways += is_layer ? ways_[inner.position()] : 1;
            layer.certain =
                layer.certain && (is_layer ? data_.layers[inner.position()].certain : !Data::is_specular[inner.kind()]);
        }
        if (!layer.certain && ways > most)
            fail(origin, "materials lie over each other in more than " + std::to_string(int(most)) + " ways");
        ways_.push_back(layer.certain ? 1 : ways);
    }

    bool has_specular_model(MaterialIndex material) const {
        const bool is_layer = material.kind() == layers;
        return is_layer ? !data_.layers[material.position()].certain : Data::is_specular[material.kind()];
    }

    LayerRecord record(const MaterialLayer& layer) const {
        using Kind = LayerRecord::Kind;
        if (const auto* blend = std::get_if<Blend>(&layer))
            return {Kind::blend, {indices_[blend->first], indices_[blend->second]}, blend->weight};
        if (const auto* mask = std::get_if<Mask>(&layer)) return {Kind::mask, {indices_[mask->inner]}, mask->opacity};
        if (const auto* map = std::get_if<NormalMap>(&layer))
            return {Kind::normal_map, {indices_[map->inner]}, map->normals,  map->scale,
                    map->flips,       map->shadows,           map->against_v};
        if (const auto* bump = std::get_if<BumpMap>(&layer))
            return {Kind::bump_map, {indices_[bump->inner]},
                    bump->height,   static_cast<float>(data_.space.length(double(bump->scale))),
                    bump->flips,    bump->shadows};
        if (const auto* coating = std::get_if<Coating>(&layer)) {
            LayerRecord result{Kind::coat, {indices_[coating->inner]}};
            result.coat = data_.coats.size() - 1;
            return result;
        }
        const auto& sides = std::get<BothSides>(layer);
        return {Kind::both_sides, {indices_[sides.front], indices_[sides.back]}};
    }

    /// The scene's own types first, and then what they are made from.
    MaterialIndex add_any(const AnyMaterial& material, bool two_sided, const Origin& origin) {
        std::optional<MaterialIndex> index;
        const auto try_as = [&]<class M>(std::type_identity<M>) {
            if (const M* found = index ? nullptr : material.get<M>()) index = add(*found, two_sided, origin);
        };
        (try_as(std::type_identity<B>()), ...);
        if constexpr (placed) (try_as(std::type_identity<model_of<B>>()), ...);
        if (!index) no_place(material.model_name(), origin);
        return *index;
    }

    [[noreturn]] static void no_place(std::string_view name, const Origin& origin) {
        fail(origin, "this scene type has no place for that surface model" +
                         (name.empty() ? std::string() : " (" + std::string(name) + ")") +
                         "; add it to the scene's Bsdfs<...>");
    }

    template <Material M>
    MaterialIndex add(const M& material, bool two_sided, const Origin& origin) {
        if constexpr (Bsdf<M> && !placed)
            if (!is_isotropic(material))
                fail(origin,
                     "this scene type does not know where u grows on a surface, which that surface model needs; put a "
                     "Textured<...> into the scene's Bsdfs<...>");
        if (two_sided && transmits_light(material))
            fail(origin, "a surface that transmits light has no back of its own and cannot be two-sided");
        constexpr std::size_t itself = index_of<M, B...>();
        // Or what can be made of it, such as `Textured<M>`.
        constexpr std::size_t kind =
            itself < sizeof...(B) ? itself : first_of<std::is_constructible_v<B, const M&>...>();
        if constexpr (kind == sizeof...(B)) {
            no_place(model_name<M>(), origin);
        } else {
            auto& list = std::get<kind>(data_.bsdfs);
            check_count(list.size(), MaterialIndex::max_position, origin, "surface models");
            list.emplace_back(material);
            return MaterialIndex(kind, list.size() - 1,
                                 (two_sided ? MaterialIndex::both_sides : 0) | flags_of(list.back()));
        }
    }

    template <class Stored>
    static std::size_t flags_of(const Stored& material) {
        // Of smooth lobes only: mirrors and clear glass are not asked for light.
        std::size_t flags = !model_of<Stored>::specular && transmits_light(material) ? MaterialIndex::through : 0;
        if constexpr (PlacedMaterial<Stored>) {
            const auto* model = detail::constant_model(material);
            if (!model || !is_isotropic(*model)) flags |= MaterialIndex::varying;
        } else if (placed) {
            flags |= MaterialIndex::varying;  // points keep the models of such scene types
        }
        return flags;
    }

    Data& data_;
    std::vector<MaterialIndex> indices_;
    std::vector<double> ways_;  // down from each layer
};

}  // namespace lightswitch::detail
