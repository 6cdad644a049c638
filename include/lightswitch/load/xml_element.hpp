#pragma once

// An object in a scene file: its parameters, typed and each asked for by name, and the objects inside it. What nobody
// asked for is an error, so that nothing in a file is ignored unseen.

#include <lightswitch/core/math.hpp>
#include <lightswitch/load/spectrum.hpp>
#include <lightswitch/load/xml.hpp>
#include <lightswitch/load/xml_transform.hpp>

namespace lightswitch::detail {

/// An object element, such as `<shape type="sphere">`. Functions that read a parameter throw `Error` when it has the
/// wrong type or a malformed value.
class XmlElement {
public:
    /// Checks attributes and sorts the children; parameters given twice are an error.
    XmlElement(const XmlFile& file, pugi::xml_node node);

    const XmlFile& file() const { return file_; }
    Origin origin() const { return file_.origin(node_); }
    std::string type() const { return node_.attribute("type").value(); }
    [[noreturn]] void error(const std::string& what) const { fail(origin(), what); }
    /// The error for a plugin that is not supported.
    [[noreturn]] void unknown_type(const std::string& known) const {
        error("unknown type " + quote(type()) + "; known are " + known);
    }

    bool has(const std::string& name) const { return parameters_.contains(name); }
    /// Whether there is an object of that name inside, such as a texture for a parameter.
    bool has_object(const std::string& name) const {
        return std::any_of(objects_.begin(), objects_.end(),
                           [&](pugi::xml_node node) { return node.attribute("name").value() == name; });
    }
    bool has_string(const std::string& name) const {
        return has(name) && std::string_view(parameters_.at(name).name()) == "string";
    }
    /// Place of a parameter that is there.
    Origin origin(const std::string& name) const { return file_.origin(parameters_.at(name)); }

    std::optional<double> number(const std::string& name);
    double number(const std::string& name, double otherwise) { return number(name).value_or(otherwise); }
    /// An integer between `lowest` and `highest`.
    std::optional<int> integer(const std::string& name, int lowest, int highest = std::numeric_limits<int>::max());
    bool boolean(const std::string& name, bool otherwise);
    std::optional<std::string> text(const std::string& name);
    /// The file that the parameter "filename" names, which must be there, from that folder.
    std::filesystem::path file_name(const std::filesystem::path& folder);
    std::optional<DVec3> vector(const std::string& name);
    std::optional<DMat4> transform(const std::string& name);

    /// A colour as Mitsuba's RGB variants see it: `<rgb>`, one number, or a `<spectrum>` in any form.
    Rgb color(const std::string& name, const Rgb& otherwise, SpectrumUse use = SpectrumUse::reflectance);
    Rgb color(const std::string& name, float otherwise, SpectrumUse use = SpectrumUse::reflectance) {
        return color(name, Rgb(otherwise), use);
    }

    /// The `<texture>` inside that gives the parameter of that name, or the `<ref>` to one.
    std::optional<pugi::xml_node> texture(const std::string& name);

    /// The objects inside with one of these tags, once each.
    std::vector<pugi::xml_node> objects(std::initializer_list<std::string_view> tags);
    /// Throws for every parameter and object that was never asked for.
    void finish() const;

private:
    /// The parameter's element if it is there; throws when its tag is none of `tags`.
    pugi::xml_node find(const std::string& name, std::initializer_list<std::string_view> tags);
    /// The colour of a `<spectrum>` by value or from a file, or of a type.
    static Rgb read_spectrum(const XmlFile& file, pugi::xml_node node, SpectrumUse use);
    Rgb spectrum_of_type(SpectrumUse use);

    const XmlFile& file_;
    pugi::xml_node node_;
    std::map<std::string, pugi::xml_node> parameters_;
    std::vector<pugi::xml_node> objects_;
    std::set<std::string> asked_;
};

inline XmlElement::XmlElement(const XmlFile& file, pugi::xml_node node) : file_(file), node_(node) {
    if (std::string_view(node.name()) == "scene") file.check_attributes(node, {"version"}, {"type", "id", "name"});
    else file.check_attributes(node, {"type"}, {"id", "name"});

    static const std::set<std::string_view> vectors{"point", "vector"},
        values{"float", "integer", "boolean", "string", "rgb", "spectrum"},
        objects{"bsdf", "shape", "emitter", "sensor", "film", "rfilter", "sampler", "integrator", "texture", "ref"};
    for (const pugi::xml_node child : node.children()) {
        const std::string_view tag = child.name();
        if (child.type() != pugi::node_element || tag == "default" || tag == "alias") continue;
        if (objects.contains(tag)) {
            objects_.push_back(child);
            continue;
        }
        const bool typed = tag == "spectrum" && child.attribute("type");
        if (tag == "spectrum") file.check_attributes(child, {"name"}, {"value", "filename", "type", "id"});
        else if (values.contains(tag)) file.check_attributes(child, {"name", "value"});
        else if (vectors.contains(tag)) file.check_attributes(child, {"name"}, {"value", "x", "y", "z"});
        else if (tag == "transform") file.check_attributes(child, {"name"});
        else fail(file.origin(child), "elements of this kind are not supported here");
        if (tag != "transform" && !typed) file.check_childless(child);
        if (!parameters_.emplace(child.attribute("name").value(), child).second)
            fail(file.origin(child), "the parameter is given twice");
    }
}

inline pugi::xml_node XmlElement::find(const std::string& name, std::initializer_list<std::string_view> tags) {
    asked_.insert(name);
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return {};
    std::string expected;
    for (const std::string_view tag : tags) {
        if (tag == found->second.name()) return found->second;
        expected += (expected.empty() ? "<" : " or <") + std::string(tag) + ">";
    }
    fail(file_.origin(found->second),
         "has the wrong type: " + quote(name) + " of " + origin().element + " must be " + expected);
}

inline std::optional<double> XmlElement::number(const std::string& name) {
    const auto node = find(name, {"float", "integer"});
    if (!node) return {};
    return read_numbers(file_, node, "value", {1})[0];
}

inline std::optional<int> XmlElement::integer(const std::string& name, int lowest, int highest) {
    const auto node = find(name, {"integer"});
    if (!node) return {};
    std::string_view text = node.attribute("value").value();
    const std::string_view word = next_word(text);
    const auto value = parse_integer(word);
    if (!value || !next_word(text).empty())
        fail(file_.origin(node), quote(node.attribute("value").value()) + " is not an integer");
    if (*value < lowest || *value > highest)
        fail(file_.origin(node),
             std::to_string(*value) + " is not between " + std::to_string(lowest) + " and " + std::to_string(highest));
    return static_cast<int>(*value);
}

inline bool XmlElement::boolean(const std::string& name, bool otherwise) {
    const auto node = find(name, {"boolean"});
    if (!node) return otherwise;
    const std::string value = lower_case(node.attribute("value").value());
    if (value != "true" && value != "false") fail(file_.origin(node), quote(value) + " is neither true nor false");
    return value == "true";
}

inline std::optional<std::string> XmlElement::text(const std::string& name) {
    const auto node = find(name, {"string"});
    if (!node) return {};
    return node.attribute("value").value();
}

inline std::filesystem::path XmlElement::file_name(const std::filesystem::path& folder) {
    const auto name = text("filename");
    if (!name) error("the parameter \"filename\" is missing");
    return folder / *name;
}

inline std::optional<DVec3> XmlElement::vector(const std::string& name) {
    const auto node = find(name, {"point", "vector"});
    if (!node) return {};
    return read_vector(file_, node, {});
}

inline std::optional<DMat4> XmlElement::transform(const std::string& name) {
    const auto node = find(name, {"transform"});
    if (!node) return {};
    return read_transform(file_, node);
}

inline Rgb XmlElement::color(const std::string& name, const Rgb& otherwise, SpectrumUse use) {
    const auto node = find(name, {"rgb", "float", "integer", "spectrum"});
    if (!node) return otherwise;
    const std::string_view tag = node.name();
    if (tag == "spectrum") return read_spectrum(file_, node, use);
    const auto numbers =
        tag == "rgb" ? read_numbers(file_, node, "value", {1, 3}) : read_numbers(file_, node, "value", {1});
    const Rgb result(numbers.size() == 1 ? DVec3(numbers[0]) : DVec3(numbers[0], numbers[1], numbers[2]));
    if (!lightswitch::is_finite(result)) fail(file_.origin(node), "the colour is too large");
    return result;
}

inline Rgb XmlElement::read_spectrum(const XmlFile& file, pugi::xml_node node, SpectrumUse use) {
    const Origin where = file.origin(node);
    if ((node.attribute("value") ? 1 : 0) + (node.attribute("filename") ? 1 : 0) + (node.attribute("type") ? 1 : 0) !=
        1)
        fail(where, "needs one of the attributes \"value\", \"filename\" and \"type\"");
    if (node.attribute("type")) return XmlElement(file, node).spectrum_of_type(use);
    if (node.attribute("value"))
        return spectrum_to_rgb(parse_spectrum(node.attribute("value").value(), where), use, where);
    const auto folder = std::filesystem::path(where.file).parent_path();
    const Spectrum spectrum =
        at_place(where, [&] { return load_spectrum(folder / node.attribute("filename").value()); });
    return spectrum_to_rgb(spectrum, use, where);
}

inline Rgb XmlElement::spectrum_of_type(SpectrumUse use) {
    const std::string kind = type();
    Rgb result;
    if (kind == "uniform") {
        result = Rgb(static_cast<float>(number("value", 1)));
    } else if (kind == "d65") {
        result = color("color", 1) * static_cast<float>(number("scale", 1));
    } else if (kind == "srgb") {
        result = color("color", 1);
    } else if (kind == "regular") {
        const double lowest = number("wavelength_min", cie_first), highest = number("wavelength_max", cie_last);
        result = spectrum_to_rgb(parse_regular_spectrum(lowest, highest, text("values").value_or(""), origin()), use,
                                 origin());
    } else if (kind == "irregular") {
        const std::string wavelengths = text("wavelengths").value_or("");
        result = spectrum_to_rgb(parse_irregular_spectrum(wavelengths, text("values").value_or(""), origin()), use,
                                 origin());
    } else if (kind == "blackbody") {
        const auto temperature = number("temperature");
        if (!temperature) error("the parameter \"temperature\" is missing");
        const double lowest = number("wavelength_min", cie_first);
        result = blackbody_to_rgb(*temperature, lowest, number("wavelength_max", cie_last), origin());
    } else {
        unknown_type("uniform, d65, srgb, regular, irregular and blackbody");
    }
    finish();
    return result;
}

inline std::optional<pugi::xml_node> XmlElement::texture(const std::string& name) {
    asked_.insert(name);
    const auto found = std::find_if(objects_.begin(), objects_.end(), [&](pugi::xml_node node) {
        const std::string_view tag = node.name();
        return node.attribute("name").value() == name && (tag == "texture" || tag == "ref");
    });
    if (found == objects_.end()) return {};
    const pugi::xml_node node = *found;
    objects_.erase(found);
    if (parameters_.contains(name)) fail(file_.origin(node), "the parameter is given twice");
    return node;
}

inline std::vector<pugi::xml_node> XmlElement::objects(std::initializer_list<std::string_view> tags) {
    std::vector<pugi::xml_node> result;
    const auto wanted = [&](pugi::xml_node node) {
        return std::find(tags.begin(), tags.end(), node.name()) != tags.end();
    };
    std::copy_if(objects_.begin(), objects_.end(), std::back_inserter(result), wanted);
    std::erase_if(objects_, wanted);
    return result;
}

inline void XmlElement::finish() const {
    for (const auto& [name, node] : parameters_) {
        if (asked_.contains(name)) continue;
        std::string known;
        for (const std::string& other : asked_) known += (known.empty() ? "; known are " : ", ") + other;
        fail({file_.origin(node).file, file_.origin(node).line, origin().element},
             "unknown parameter " + quote(name) + known);
    }
    if (!objects_.empty()) fail(file_.origin(objects_.front()), "does not belong into " + origin().element);
}

}  // namespace lightswitch::detail
