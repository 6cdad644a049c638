#pragma once

// Surface models in Mitsuba's scene files.

#include <lightswitch/load/mitsuba_texture.hpp>

namespace lightswitch::detail {

/// Index of refraction by Mitsuba's name (after Hecht, "Optics", 4th edition); nothing when unknown.
inline std::optional<double> index_of_refraction(const std::string& name) {
    static const std::map<std::string, double> media{
        {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
        {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
        {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
        {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
        {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
        {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
        {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
        {"pet", 1.5750},      {"diamond", 2.419}};
    const auto found = media.find(lower_case(name));
    if (found == media.end()) return {};
    return found->second;
}

inline double read_index_of_refraction(XmlElement& element, const std::string& name, const std::string& otherwise) {
    if (element.has_string(name) || !element.has(name)) {
        const std::string medium = element.text(name).value_or(otherwise);
        const auto index = index_of_refraction(medium);
        if (!index) fail(element.origin(name), "unknown medium " + quote(medium) + ": give the index as a <float>");
        return *index;
    }
    const double index = *element.number(name);
    if (!(index > 0)) fail(element.origin(name), "an index of refraction must be above 0");
    return index;
}

/// `eta`, `k` and `specular_reflectance` of a metal.
template <class Metal>
void read_metal(XmlElement& element, Metal& metal) {
    if (const auto material = element.text("material"); material && *material != "none")
        fail(element.origin("material"),
             "measured metals are not supported: give eta and k as <rgb> instead of " + quote(*material));
    metal.eta = element.color("eta", 0);
    metal.k = element.color("k", 1);
    metal.reflectance = element.color("specular_reflectance", 1);
}

inline RoughConductor read_rough_conductor(XmlElement& element) {
    RoughConductor result;
    read_metal(element, result);
    // Mitsuba's default is beckmann, which would look different.
    const std::string distribution = lower_case(element.text("distribution").value_or("beckmann"));
    if (distribution != "ggx")
        element.error("the distribution is " + quote(distribution) +
                      (element.has("distribution") ? "" : " by default") +
                      ", but only \"ggx\" is supported: give <string name=\"distribution\" value=\"ggx\"/>");
    element.boolean("sample_visible", true);  // changes only the noise
    const auto alpha = element.number("alpha"), alpha_u = element.number("alpha_u"),
               alpha_v = element.number("alpha_v");
    if (alpha_u.has_value() != alpha_v.has_value() || (alpha && alpha_u))
        element.error("give either alpha, or both alpha_u and alpha_v");
    if (alpha_u && *alpha_u != *alpha_v)
        element.error("anisotropic roughness is not supported: alpha_u and alpha_v must be equal");
    result.distribution = Facets::ggx;
    result.alpha_u = result.alpha_v = static_cast<float>(alpha_u ? *alpha_u : alpha.value_or(0.1));
    return result;
}

/// The element that a `<ref>` stands for, or the element itself. Throws unless it is a BSDF.
inline pugi::xml_node resolve_bsdf(const XmlFile& file, pugi::xml_node node) {
    return std::string_view(node.name()) == "ref" ? file.target(node, "bsdf") : node;
}

/// Reads a `<bsdf>`, with Mitsuba's defaults for what is left out.
inline LibraryBsdf read_bsdf(const XmlFile& file, pugi::xml_node node, TextureReader& textures) {
    XmlElement element(file, node);
    const auto finished = [&](const auto& bsdf) {
        LibraryBsdf result = textures.with_textures(element, bsdf);
        element.finish();
        return result;
    };
    if (element.type() == "diffuse") return finished(Lambert{.reflectance = element.color("reflectance", 0.5f)});
    if (element.type() == "conductor") {
        Conductor result;
        read_metal(element, result);
        return finished(result);
    }
    if (element.type() == "roughconductor") return finished(read_rough_conductor(element));
    if (element.type() == "dielectric") {
        Dielectric result;
        const double inside = read_index_of_refraction(element, "int_ior", "bk7");
        result.eta = static_cast<float>(inside / read_index_of_refraction(element, "ext_ior", "air"));
        result.reflectance = element.color("specular_reflectance", 1);
        result.transmittance = element.color("specular_transmittance", 1);
        return finished(result);
    }
    element.unknown_type("diffuse, conductor, roughconductor, dielectric and twosided");
}

/// A `<bsdf>`, and whether it is a `twosided` one: then what is inside.
struct ReadMaterial {
    LibraryBsdf bsdf;
    bool two_sided = false;
};
inline ReadMaterial read_material(const XmlFile& file, pugi::xml_node node, TextureReader& textures) {
    if (std::string_view(node.attribute("type").value()) != "twosided") return {read_bsdf(file, node, textures)};
    XmlElement element(file, node);
    const auto inner = element.objects({"bsdf", "ref"});
    if (inner.size() != 1)
        element.error("needs exactly one bsdf inside, for both sides, not " + std::to_string(inner.size()));
    const pugi::xml_node front = resolve_bsdf(file, inner[0]);
    if (std::string_view(front.attribute("type").value()) == "twosided")
        fail(file.origin(inner[0]), "a twosided bsdf cannot be inside another one");
    ReadMaterial result{read_bsdf(file, front, textures), true};
    if (std::visit([]<class B>(const B&) { return transmits<B>; }, result.bsdf))
        fail(file.origin(inner[0]), "a bsdf that transmits light cannot be twosided");
    element.finish();
    return result;
}

}  // namespace lightswitch::detail
