#pragma once

// Materials in Mitsuba's scene files: surface models, and the layers over them.

#include <lightswitch/load/mitsuba_bsdf.hpp>
#include <lightswitch/scene/check.hpp>

namespace lightswitch::detail {

/// Reads the materials of one scene file into a description, one for each `<bsdf>`, however often it is used. One that
/// cannot be read is what it contains, or else grey.
class MaterialReader {
public:
    MaterialReader(const XmlFile& file, TextureReader& textures, LibraryDescription& scene)
        : file_(file), textures_(textures), scene_(scene) {}

    /// Index of the material of a `<bsdf>`.
    std::size_t read(pugi::xml_node node) {
        const auto known = materials_.find(node);
        if (known != materials_.end()) {
            if (known->second == under_way) fail(file_.origin(node), "the bsdf contains itself");
            return known->second;
        }
        if (depth_ > deepest_layers)
            fail(file_.origin(node), "is in more than " + std::to_string(deepest_layers) + " other bsdfs");
        materials_[node] = under_way;
        ++depth_;
        const bool nested = !nested_bsdfs(node).empty();
        const std::size_t index = file_.log().attempt(
            nested ? "the bsdf inside takes its place" : "it is diffuse", [&] { return read_new(node); },
            [&] { return stand_in(node); });
        --depth_;
        return materials_[node] = index;
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

    /// What light can meet of a material: itself, but what is inside of a mask.
    std::size_t unmasked(std::size_t number, bool light, const Origin& origin) {
        while (scene_.materials[number].layer) {
            const auto* mask = std::get_if<Mask>(&*scene_.materials[number].layer);
            if (mask == nullptr) break;
            number = mask->inner;
        }
        return is_masked(scene_, number) ? by_default(light, origin) : number;
    }

private:
    static constexpr std::size_t under_way = static_cast<std::size_t>(-1);

    std::vector<pugi::xml_node> nested_bsdfs(pugi::xml_node node) const {
        std::vector<pugi::xml_node> result;
        for (const pugi::xml_node child : file_.children(node)) {
            const bool reference = std::string_view(child.name()) == "ref";
            const pugi::xml_node meant = reference ? file_.target(child) : child;
            if (meant && std::string_view(meant.name()) == "bsdf") result.push_back(meant);
        }
        return result;
    }

    /// What takes the place of a bsdf that cannot be read: the first one inside, or a diffuse one of the colour that it
    /// has.
    std::size_t stand_in(pugi::xml_node node) {
        for (const pugi::xml_node inner : nested_bsdfs(node)) {
            try {
                return read(inner);
            } catch (const Error&) {  // it contains the other; which has been told
            }
        }
        Rgb color(0.5f);
        file_.log().attempt("it is grey", [&] {
            XmlElement element(file_, node);
            for (const char* name : {"reflectance", "diffuse_reflectance", "base_color", "transmittance"})
                if (element.has(name)) color = glm::clamp(element.color(name, color), 0.0f, 1.0f);
        });
        return scene_.add(Lambert{.reflectance = color}, file_.origin(node));
    }

    std::size_t read_new(pugi::xml_node node) {
        XmlElement element(file_, node);
        const std::string type = element.type();
        const Origin origin = element.origin();
        if (type == "twosided") return read_two_sided(element);
        if (type == "blendbsdf") {
            const Texture weight = textures_.value_or_texture(element, "weight");
            const auto inner = read_all(element);
            if (inner.size() != 2) element.error("needs two bsdfs inside, not " + std::to_string(inner.size()));
            element.finish();
            return add(Blend{inner[0], inner[1], weight}, origin);
        }
        if (type == "mixturebsdf") return read_mixture(element);
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
        if (type == "coating" || type == "roughcoating") return read_coating(element);
        if (type == "polarizer" || type == "retarder" || type == "circular") return read_filter(element);
        if (type == "bumpmap") {
            BumpMap map{.inner = 0, .height = Texture(Rgb(0))};
            map.scale = static_cast<float>(element.number("scale", 1));
            map.height = textures_.only_texture(element, map.scale);
            return finish_map(element, std::move(map));
        }
        if (type == "normalmap")
            return finish_map(element, NormalMap{.inner = 0, .normals = textures_.texture(element, "normalmap")});
        return scene_.add(BsdfReader(element, textures_).read(), origin);
    }

    /// A filter for polarized light, without which it lets a part of the light through and absorbs the rest: half,
    /// but for a retarder.
    std::size_t read_filter(XmlElement& element) {
        const Texture transmittance = textures_.value_or_texture(element, "transmittance", 1);
        const Rgb least = transmittance.least(), most = transmittance.most();
        if (least != most || most != Rgb(most.x))
            element.problem("transmittance", "only grey of one value is supported here", "its mean counts");
        // What a polarizer's turn, and a retarder's phase, mean without polarization: nothing.
        for (const char* name : {"theta", "delta"}) textures_.value_or_texture(element, name, 0);
        for (const char* name : {"polarizing", "left_handed"}) element.boolean(name, true);
        element.finish();
        const float through = luminance(transmittance.mean()) * (element.type() == "retarder" ? 1.0f : 0.5f);
        return add(Mask{by_default(true, element.origin()), Texture(Rgb(1 - through))}, element.origin());
    }

    /// Several bsdfs of Mitsuba 0.6, each with its share of the light: blends of two.
    std::size_t read_mixture(XmlElement& element) {
        const auto inner = read_all(element);
        const std::vector<double> weights = parse_list(element.text("weights").value_or(""), element.origin());
        if (inner.empty() || inner.size() != weights.size())
            element.error("has " + std::to_string(weights.size()) + " weights for " + std::to_string(inner.size()) +
                          " bsdfs");
        double sum = 0;
        for (const double weight : weights) {
            if (!(weight >= 0)) fail(element.origin("weights"), "a weight must not be negative");
            sum += weight;
        }
        if (!(std::abs(sum - 1) < 1e-3))
            element.problem("weights", "the weights do not sum to 1 but to " + number_text(sum),
                            "they are divided by that");
        element.finish();
        std::size_t mixture = inner[0];
        double so_far = weights[0];
        for (std::size_t i = 1; i < inner.size(); ++i) {
            so_far += weights[i];
            const double share = so_far > 0 ? weights[i] / so_far : 0;
            mixture = add(Blend{mixture, inner[i], Texture(Rgb(static_cast<float>(share)))}, element.origin());
        }
        return mixture;
    }

    std::size_t read_coating(XmlElement& element) {
        Coating coating{.inner = 0, .coat = read_coat(element)};
        coating.inner = read_one(element);
        element.finish();
        const auto is_specular = [](const auto& material) { return !material.layer && material.bsdf.specular(); };
        if (!coating.coat.smooth() && any_below(scene_, coating.inner, is_specular)) {
            element.problem("", "a rough coat cannot lie over what is specular as a whole", "it is smooth");
            coating.coat.alpha = 0;
        }
        const std::string problem = coating_problem(scene_, coating);
        if (problem.empty()) return add(std::move(coating), element.origin());
        element.problem("", problem, "the coat is left out");
        return coating.inner;
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
        depths_.resize(scene_.materials.size(), unknown_depth);
        depth_over(scene_, layer, origin, depths_);
        return scene_.add(std::move(layer), origin);
    }

    std::vector<std::size_t> read_all(XmlElement& element) {
        std::vector<std::size_t> result;
        for (const pugi::xml_node node : element.objects("bsdf")) result.push_back(read(node));
        return result;
    }
    std::size_t read_one(XmlElement& element) {
        const auto inner = element.objects("bsdf");
        if (inner.size() != 1) element.error("needs exactly one bsdf inside, not " + std::to_string(inner.size()));
        return read(inner[0]);
    }

    std::size_t read_two_sided(XmlElement& element) {
        const auto inner = element.objects("bsdf");
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
        return any_below(scene_, number, [](const auto& material) {
            if (material.layer) return std::holds_alternative<Mask>(*material.layer);
            return material.bsdf.transmits_light();
        });
    }

    const XmlFile& file_;
    TextureReader& textures_;
    LibraryDescription& scene_;
    std::map<pugi::xml_node, std::size_t> materials_;
    int depth_ = 0;            ///< of the bsdf that is being read: how many it is in
    std::vector<int> depths_;  ///< of layers, by material
    std::optional<std::size_t> grey_, black_, invisible_;
};

}  // namespace lightswitch::detail
