#pragma once

// Scene files of Mitsuba 0.x in the words of Mitsuba 3. Names change as Mitsuba 3.9 changes them; what it does not know
// any more, but meant something in 0.6, is said in the way of 3 where there is one.

#include <lightswitch/load/text.hpp>

#include <pugixml.hpp>

#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace lightswitch::detail {

/// "toWorld" as "to_world", "intIOR" as "int_ior".
inline std::string with_underscores(std::string_view name) {
    const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
    std::string result;
    bool in_word = false;  // of capitals, which follows a small letter
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool begins = i > 0 && is_lower(name[i - 1]) && is_upper(name[i]);
        in_word = begins || (in_word && is_upper(name[i]));
        if (begins) result += '_';
        result += in_word ? lower_case(name.substr(i, 1)) : std::string(1, name[i]);
    }
    return result;
}

/// The parameter of `element` with that name.
inline pugi::xml_node parameter_of(pugi::xml_node element, std::string_view name) {
    return element.find_child([&](pugi::xml_node child) { return child.attribute("name").value() == name; });
}

inline void rename_parameter(pugi::xml_node element, const char* from, const char* to) {
    if (const auto parameter = parameter_of(element, from); parameter && !parameter_of(element, to))
        parameter.attribute("name").set_value(to);
}

/// Offsets and scales of texture coordinates become a transform. As Mitsuba 3.9 does it, the offset comes first.
inline void upgrade_uv(pugi::xml_node element) {
    pugi::xml_node place;
    std::string values[4];
    const char* const names[] = {"uoffset", "voffset", "uscale", "vscale"};
    for (int i = 0; i < 4; ++i) {
        const auto parameter = parameter_of(element, names[i]);
        values[i] = parameter ? parameter.attribute("value").value() : i < 2 ? "0" : "1";
        if (!parameter) continue;
        if (place) element.remove_child(parameter);
        else place = parameter;
    }
    if (!place || parameter_of(element, "to_uv")) return;
    place.set_name("transform");
    place.attribute("name").set_value("to_uv");
    place.remove_attribute("value");
    for (const int first : {0, 2}) {
        auto step = place.append_child(first == 0 ? "translate" : "scale");
        step.append_attribute("x").set_value(values[first].c_str());
        step.append_attribute("y").set_value(values[first + 1].c_str());
    }
}

inline void append_string(pugi::xml_node element, const char* name, const char* value) {
    auto parameter = element.append_child("string");
    parameter.append_attribute("name").set_value(name);
    parameter.append_attribute("value").set_value(value);
}

/// A bitmap of 0.6: its filters for distant textures make no other image than the bilinear one when there are enough
/// samples, and a gamma of 1 is what is called raw now.
inline void upgrade_bitmap(pugi::xml_node element) {
    if (const auto filter = parameter_of(element, "filter_type")) {
        const std::string value = lower_case(filter.attribute("value").value());
        if (value == "ewa" || value == "trilinear") filter.attribute("value").set_value("bilinear");
    }
    for (const char* name : {"max_anisotropy", "cache"}) element.remove_child(parameter_of(element, name));
    auto gamma = parameter_of(element, "gamma");
    if (!gamma) return;
    const auto value = parse_number(gamma.attribute("value").value());
    if (value == 1 && !parameter_of(element, "raw")) {
        gamma.set_name("boolean");
        gamma.attribute("name").set_value("raw");
        gamma.attribute("value").set_value("true");
    } else if (value == -1 || value == 2.2) {
        element.remove_child(gamma);  // what the file says; sRGB, which has about that exponent
    }
}

/// Changes the words of one element, whose attributes are final; those inside come after it.
inline void upgrade_words(pugi::xml_node element) {
    static const std::map<std::string_view, const char*> tags{
        {"lookAt", "lookat"}, {"lookAT", "lookat"}, {"luminaire", "emitter"}, {"camera", "sensor"}};
    if (const auto tag = tags.find(element.name()); tag != tags.end()) element.set_name(tag->second);
    if (auto name = element.attribute("name"); name && std::string_view(element.name()) != "default")
        name.set_value(with_underscores(name.value()).c_str());
    static const std::map<std::string_view, const char*> bsdfs{
        {"lambertian", "diffuse"}, {"roughmetal", "roughconductor"}, {"roughglass", "roughdielectric"}};
    if (std::string_view(element.name()) != "bsdf") return;
    if (const auto type = bsdfs.find(element.attribute("type").value()); type != bsdfs.end())
        element.attribute("type").set_value(type->second);
}

/// Changes the parameters of an element whose children have their final words.
inline void upgrade_parameters(pugi::xml_node element) {
    const std::string tag = element.name(), type = element.attribute("type").value();
    if (tag == "texture") upgrade_uv(element);
    if (tag == "texture" && type == "bitmap") upgrade_bitmap(element);
    if (tag == "emitter" || tag == "shape") element.remove_child(parameter_of(element, "sampling_weight"));
    if (tag == "bsdf" && type == "diffuse") rename_parameter(element, "diffuse_reflectance", "reflectance");
    if (tag == "bsdf" && type == "mirror") {
        element.attribute("type").set_value("conductor");
        append_string(element, "material", "none");
        return;
    }
    // In 0.6 a metal without a name is copper.
    const bool metal = tag == "bsdf" && (type == "conductor" || type == "roughconductor");
    if (metal && !parameter_of(element, "material") && !parameter_of(element, "eta") && !parameter_of(element, "k"))
        append_string(element, "material", "Cu");
}

}  // namespace lightswitch::detail
