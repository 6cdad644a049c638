#pragma once

// An object in a scene file: its parameters, typed and each asked for by name, and the objects inside it. What nobody
// asked for is a problem, so that nothing in a file is ignored unseen.

#include <lightswitch/core/math.hpp>
#include <lightswitch/load/spectrum.hpp>
#include <lightswitch/load/xml.hpp>
#include <lightswitch/load/xml_transform.hpp>

namespace lightswitch::detail {

/// An object element, such as `<shape type="sphere">`. A number, colour or flag of the wrong type or with a malformed
/// value is a problem, and as if it were not there; for other parameters functions throw `Error` then.
class XmlElement {
public:
    /// Checks attributes and sorts the children; parameters given twice are a problem.
    XmlElement(const XmlFile& file, pugi::xml_node node);

    ReadingLog& log() const { return file_.log(); }
    Origin origin() const { return file_.origin(node_); }
    std::string type() const { return node_.attribute("type").value(); }
    [[noreturn]] void error(const std::string& what) const { fail(origin(), what); }
    static std::string unknown(const std::string& type, const std::string& known) {
        return "unknown type " + quote(type) + "; known are " + known;
    }
    /// The error for a plugin that is not supported.
    [[noreturn]] void unknown_type(const std::string& known) const { error(unknown(type(), known)); }

    bool has(const std::string& name) const { return parameters_.contains(name); }
    /// Whether there is an object of that name inside, such as a texture for a parameter.
    bool has_object(const std::string& name) const {
        return std::any_of(objects_.begin(), objects_.end(),
                           [&](pugi::xml_node node) { return node.attribute("name").value() == name; });
    }
    bool has_string(const std::string& name) const { return has_tag(name, {"string"}); }
    bool is_vector(const std::string& name) const { return has_tag(name, {"vector"}); }
    bool is_color(const std::string& name) const { return has_tag(name, {"rgb", "srgb", "spectrum"}); }
    /// Place of a parameter that is there.
    Origin origin(const std::string& name) const { return file_.origin(parameters_.at(name)); }
    /// Takes down what is wrong with that parameter, if it is there, or else with the element.
    void problem(const std::string& name, const std::string& what, std::string instead) const {
        log().problem(has(name) ? origin(name) : origin(), what, std::move(instead));
    }

    std::optional<double> number(const std::string& name);
    double number(const std::string& name, double otherwise) { return number(name).value_or(otherwise); }
    /// A number above 0, or `otherwise`.
    double positive(const std::string& name, double otherwise, const std::string& advice = "");
    /// An integer between `lowest` and `highest`.
    std::optional<int> integer(const std::string& name, int lowest, int highest = std::numeric_limits<int>::max());
    bool boolean(const std::string& name, bool otherwise);
    std::optional<std::string> text(const std::string& name);
    /// The file that the parameter "filename" names, which must be there.
    std::filesystem::path file_name();
    std::optional<DVec3> vector(const std::string& name);
    std::optional<DMat4> transform(const std::string& name);
    /// What a text means by `values`; one that is not among them is a problem, and as if it were not there.
    template <class T>
    T one_of(const std::string& name, const std::string& otherwise, const std::map<std::string, T>& values);

    /// A colour as Mitsuba's RGB variants see it: `<rgb>`, `<srgb>`, one number, or a `<spectrum>` in any form.
    Rgb color(const std::string& name, const Rgb& otherwise, SpectrumUse use = SpectrumUse::reflectance);
    Rgb color(const std::string& name, float otherwise, SpectrumUse use = SpectrumUse::reflectance) {
        return color(name, Rgb(otherwise), use);
    }

    /// Whether it was written for Mitsuba 0.x.
    bool is_old() const { return file_.is_old(node_); }

    /// The `<texture>` inside that gives the parameter of that name, or the `<ref>` to one. May be asked for again.
    std::optional<pugi::xml_node> texture(const std::string& name);

    /// The objects inside with that tag, and those that references stand for, once each.
    std::vector<pugi::xml_node> objects(std::string_view tag);
    /// The only one of them, or nothing. Others are a problem.
    std::optional<pugi::xml_node> object(std::string_view tag);
    /// Takes media for a problem each.
    void refuse_media();
    /// Takes every parameter and object that was never asked for as a problem.
    void finish() const;
    /// Lets parameters pass that say nothing about the image.
    void accept(std::initializer_list<const char*> names) {
        for (const char* name : names) parameters_.erase(name);
    }
    /// Those whose names begin with this.
    void accept_beginning(std::string_view prefix) {
        std::erase_if(parameters_, [&](const auto& parameter) { return parameter.first.starts_with(prefix); });
    }
    /// Lets everything pass that is there.
    void accept_rest() {
        accept_beginning("");
        objects_.clear();
    }

private:
    bool has_tag(const std::string& name, std::initializer_list<std::string_view> tags) const {
        const auto found = parameters_.find(name);
        return found != parameters_.end() && std::find(tags.begin(), tags.end(), found->second.name()) != tags.end();
    }
    void sort(pugi::xml_node child);
    /// The parameter's element if it is there; throws when its tag is none of `tags`.
    pugi::xml_node find(const std::string& name, std::initializer_list<std::string_view> tags);

    const XmlFile& file_;
    pugi::xml_node node_;
    std::map<std::string, pugi::xml_node> parameters_;
    std::vector<pugi::xml_node> objects_;
    std::set<std::string> asked_;
    std::set<pugi::xml_node> read_textures_;
};

inline XmlElement::XmlElement(const XmlFile& file, pugi::xml_node node) : file_(file), node_(node) {
    if (std::string_view(node.name()) == "scene") file.check_attributes(node, {}, {"version", "type", "id", "name"});
    else file.check_attributes(node, {"type"}, {"id", "name"});
    for (const pugi::xml_node child : file.children(node)) file.log().attempt("it is left out", [&] { sort(child); });
}

inline void XmlElement::sort(pugi::xml_node child) {
    static const std::set<std::string_view> vectors{"point", "vector"}, values{"float", "integer", "boolean", "string"},
        colors{"rgb", "srgb"}, objects{"bsdf",    "shape",      "emitter", "sensor", "film",  "rfilter",
                                       "sampler", "integrator", "texture", "ref",    "medium"};
    const std::string_view tag = child.name();
    if (objects.contains(tag)) return objects_.push_back(child);
    const bool typed = tag == "spectrum" && child.attribute("type");
    if (tag == "spectrum") file_.check_attributes(child, {"name"}, {"value", "filename", "type", "id", "intent"});
    else if (tag == "blackbody") file_.check_attributes(child, {"name", "temperature"}, {"scale"});
    else if (values.contains(tag)) file_.check_attributes(child, {"name", "value"});
    else if (colors.contains(tag)) file_.check_attributes(child, {"name", "value"}, {"intent"});
    else if (vectors.contains(tag)) file_.check_attributes(child, {"name"}, {"value", "x", "y", "z"});
    else if (tag == "transform") file_.check_attributes(child, {"name"});
    else fail(file_.origin(child), "elements of this kind are not supported here");
    if (tag != "transform" && !typed) file_.check_childless(child);
    const auto [first, is_new] = parameters_.emplace(child.attribute("name").value(), child);
    // With the same value again nothing is in doubt.
    const bool same = !is_new && tag == first->second.name() && child.attribute("value") &&
                      std::string_view(child.attribute("value").value()) == first->second.attribute("value").value();
    if (!is_new && !same) fail(file_.origin(child), "the parameter is given twice");
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
    return log().attempt(
        "it is ignored",
        [&]() -> std::optional<double> {
            const auto node = find(name, {"float", "integer"});
            if (!node) return {};
            return read_numbers(file_, node, "value", {1})[0];
        },
        [] { return std::nullopt; });
}

inline double XmlElement::positive(const std::string& name, double otherwise, const std::string& advice) {
    const double value = number(name, otherwise);
    if (value > 0) return value;
    problem(name, "must be above 0" + advice, "it is " + number_text(otherwise));
    return otherwise;
}

inline std::optional<int> XmlElement::integer(const std::string& name, int lowest, int highest) {
    return log().attempt(
        "it is ignored",
        [&]() -> std::optional<int> {
            const auto node = find(name, {"integer", "float"});
            if (!node) return {};
            std::string_view text = node.attribute("value").value();
            const std::string_view word = next_word(text);
            auto value = parse_integer(word);
            const auto real = parse_number(word);
            if (std::string_view(node.name()) == "float" && real && std::abs(*real) < 1e15 &&
                std::trunc(*real) == *real)
                value = static_cast<std::int64_t>(*real);
            if (!value || !next_word(text).empty())
                fail(file_.origin(node), quote(node.attribute("value").value()) + " is not an integer");
            if (*value < lowest || *value > highest)
                fail(file_.origin(node), std::to_string(*value) + " is not between " + std::to_string(lowest) +
                                             " and " + std::to_string(highest));
            return static_cast<int>(*value);
        },
        [] { return std::nullopt; });
}

inline bool XmlElement::boolean(const std::string& name, bool otherwise) {
    return log().attempt(
        "it is ignored",
        [&] {
            const auto node = find(name, {"boolean"});
            if (!node) return otherwise;
            const std::string value = lower_case(node.attribute("value").value());
            if (value != "true" && value != "false")
                fail(file_.origin(node), quote(value) + " is neither true nor false");
            return value == "true";
        },
        [&] { return otherwise; });
}

inline std::optional<std::string> XmlElement::text(const std::string& name) {
    const auto node = find(name, {"string"});
    if (!node) return {};
    return node.attribute("value").value();
}

inline std::filesystem::path XmlElement::file_name() {
    const auto name = text("filename");
    if (!name) error("the parameter \"filename\" is missing");
    return file_.locate(parameters_.at("filename"), *name);
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

template <class T>
T XmlElement::one_of(const std::string& name, const std::string& otherwise, const std::map<std::string, T>& values) {
    const std::string value = lower_case(text(name).value_or(otherwise));
    const auto found = values.find(value);
    if (found != values.end()) return found->second;
    std::string known;
    for (const auto& [text, meaning] : values) known += (known.empty() ? "" : ", ") + text;
    problem(name, quote(value) + " is not one of " + known, "it is " + quote(otherwise));
    return values.at(otherwise);
}

inline std::optional<pugi::xml_node> XmlElement::texture(const std::string& name) {
    asked_.insert(name);
    const auto found = std::find_if(objects_.begin(), objects_.end(), [&](pugi::xml_node node) {
        const std::string_view tag = node.name();
        return node.attribute("name").value() == name && (tag == "texture" || tag == "ref");
    });
    if (found == objects_.end()) return {};
    const pugi::xml_node node = *found;
    read_textures_.insert(node);
    if (parameters_.contains(name))
        log().problem(file_.origin(node), "the parameter is given twice", "the texture counts");
    return node;
}

inline std::vector<pugi::xml_node> XmlElement::objects(std::string_view tag) {
    std::vector<pugi::xml_node> result;
    std::erase_if(objects_, [&](pugi::xml_node node) {
        if (read_textures_.contains(node)) return false;
        const bool reference = std::string_view(node.name()) == "ref";
        const pugi::xml_node meant = reference ? file_.target(node) : node;
        if (!meant || meant.name() != tag) return false;
        result.push_back(meant);
        return true;
    });
    return result;
}

inline std::optional<pugi::xml_node> XmlElement::object(std::string_view tag) {
    const auto found = objects(tag);
    for (std::size_t i = 1; i < found.size(); ++i)
        log().problem(file_.origin(found[i]), "is the second one in " + origin().element, "it is left out");
    if (found.empty()) return {};
    return found[0];
}

inline void XmlElement::refuse_media() {
    for (const pugi::xml_node medium : objects("medium"))
        log().problem(file_.origin(medium), "media are not supported", "it is left out");
}

inline void XmlElement::finish() const {
    for (const auto& [name, node] : parameters_) {
        if (asked_.contains(name)) continue;
        std::string known;
        for (const std::string& other : asked_) known += (known.empty() ? "; known are " : ", ") + other;
        log().problem({file_.origin(node).file, file_.origin(node).line, origin().element},
                      "unknown parameter " + quote(name) + known, "it is ignored");
    }
    for (const pugi::xml_node node : objects_) {
        if (read_textures_.contains(node)) continue;
        const bool reference = std::string_view(node.name()) == "ref";
        const pugi::xml_node meant = reference ? file_.target(node) : pugi::xml_node();
        const std::string what = !reference ? ""
                                 : meant    ? "refers to " + file_.origin(meant).element + ", which "
                                            : "there is no element with the id " + quote(node.attribute("id").value());
        log().problem(file_.origin(node),
                      reference && !meant ? what : what + "does not belong into " + origin().element, "it is left out");
    }
}

}  // namespace lightswitch::detail
