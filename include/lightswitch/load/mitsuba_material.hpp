#pragma once

// Materials in Mitsuba's scene files: surface models, and the layers over them.

#include <lightswitch/load/mitsuba_bsdf.hpp>
#include <lightswitch/scene/check.hpp>

namespace lightswitch::detail {

/// Reads the materials of one scene file into a description, one for each `<bsdf>`, however often it is used.
class MaterialReader {
public:
    MaterialReader(const XmlFile& file, TextureReader& textures, LibraryDescription& scene)
        : file_(file), textures_(textures), scene_(scene) {}

    /// Index of the material of a `<bsdf>` or a `<ref>` to one.
    std::size_t read(pugi::xml_node node) {
        if (std::string_view(node.name()) == "ref") node = file_.target(node, "bsdf");
        const auto known = materials_.find(node.offset_debug());
        if (known != materials_.end()) {
            if (known->second == under_way) fail(file_.origin(node), "the bsdf contains itself");
            return known->second;
        }
        materials_[node.offset_debug()] = under_way;
        const std::size_t index = read_new(node);
        return materials_[node.offset_debug()] = index;
    }

    /// Mitsuba gives a shape without a BSDF a grey one, or a black one when it is a light.
    std::size_t by_default(bool light, const Origin& origin) {
        auto& index = light ? black_ : grey_;
        if (!index) index = scene_.add(Lambert{.reflectance = Rgb(light ? 0.0f : 0.5f)}, origin);
        return *index;
    }

    /// For a light whose `<bsdf>` is the plugin `null`: other than a surface that is not there, one that can be met.
    std::size_t invisible_light(const Origin& origin) {
        if (!invisible_) invisible_ = scene_.add(Dielectric{.eta = 1}, origin);
        return *invisible_;
    }

private:
    static constexpr std::size_t under_way = static_cast<std::size_t>(-1);

    std::size_t read_new(pugi::xml_node node) {
        XmlElement element(file_, node);
        const std::string type = element.type();
        const Origin origin = element.origin();
        if (type == "twosided") return read_two_sided(element);
        if (type == "blendbsdf") {
            const Texture weight = textures_.value_or_texture(element, "weight");
            const auto [first, second] = read_two(element);
            element.finish();
            return add(Blend{first, second, weight}, origin);
        }
        if (type == "mask") {
            const Texture opacity = textures_.value_or_texture(element, "opacity", 0.5f);
            const std::size_t inner = read_one(element);
            element.finish();
            return add(Mask{inner, opacity}, origin);
        }
        if (type == "null") {
            element.finish();
            return add(Mask{by_default(true, origin), Texture(Rgb(0))}, origin);
        }
        if (type == "bumpmap") {
            BumpMap map{.inner = 0, .height = textures_.only_texture(element)};
            map.scale = static_cast<float>(element.number("scale", 1));
            return finish_map(element, std::move(map));
        }
        if (type == "normalmap")
            return finish_map(element, NormalMap{.inner = 0, .normals = textures_.texture(element, "normalmap")});
        return scene_.add(BsdfReader(element, textures_).read(), origin);
    }

    std::size_t finish_map(XmlElement& element, auto map) {
        map.flips = element.boolean("flip_invalid_normals", true);
        map.shadows = element.boolean("use_shadowing_function", true);
        map.inner = read_one(element);
        element.finish();
        return add(std::move(map), element.origin());
    }

    std::size_t add(MaterialLayer layer, const Origin& origin) {
        if (const std::string problem = layer_problem(layer); !problem.empty()) fail(origin, problem);
        return scene_.add(std::move(layer), origin);
    }

    std::size_t read_one(XmlElement& element) {
        const auto inner = element.objects({"bsdf", "ref"});
        if (inner.size() != 1) element.error("needs exactly one bsdf inside, not " + std::to_string(inner.size()));
        return read(inner[0]);
    }
    std::pair<std::size_t, std::size_t> read_two(XmlElement& element) {
        const auto inner = element.objects({"bsdf", "ref"});
        if (inner.size() != 2) element.error("needs two bsdfs inside, not " + std::to_string(inner.size()));
        const std::size_t first = read(inner[0]);
        return {first, read(inner[1])};
    }

    std::size_t read_two_sided(XmlElement& element) {
        const auto inner = element.objects({"bsdf", "ref"});
        if (inner.empty() || inner.size() > 2)
            element.error("needs one bsdf inside, for both sides, or two, not " + std::to_string(inner.size()));
        element.finish();
        std::vector<std::size_t> sides;
        for (const pugi::xml_node node : inner) {
            sides.push_back(read(node));
            if (scene_.materials[sides.back()].two_sided)
                fail(file_.origin(node), "a twosided bsdf cannot be inside another one");
            if (transmits_light(sides.back()))
                fail(file_.origin(node), "a bsdf that transmits light cannot be twosided");
        }
        if (sides.size() == 2) return add(BothSides{sides[0], sides[1]}, element.origin());
        auto both = scene_.materials[sides[0]];
        both.two_sided = true;
        both.origin = element.origin();
        scene_.materials.push_back(std::move(both));
        return scene_.materials.size() - 1;
    }

    bool transmits_light(std::size_t number) const {
        const auto& material = scene_.materials[number];
        if (!material.layer)
            return std::visit([](const auto& bsdf) { return lightswitch::transmits_light(bsdf); }, material.bsdf);
        if (std::holds_alternative<Mask>(*material.layer)) return true;
        const auto inner = below(*material.layer);
        return std::any_of(inner.begin(), inner.end(), [&](std::size_t i) { return transmits_light(i); });
    }

    const XmlFile& file_;
    TextureReader& textures_;
    LibraryDescription& scene_;
    std::map<std::ptrdiff_t, std::size_t> materials_;
    std::optional<std::size_t> grey_, black_, invisible_;
};

}  // namespace lightswitch::detail
