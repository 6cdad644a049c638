#pragma once

// An object in a scene file: its parameters, typed and each asked for by name, and the objects inside it. What nobody asked
// for is an error, so that nothing in a file is ignored unseen.

#include <lightswitch/core/math.hpp>
#include <lightswitch/load/xml.hpp>
#include <lightswitch/scene/description.hpp>

namespace lightswitch::detail {

/// The matrix of a `<transform>`: its operations in the order of the file. Throws unless it is affine and invertible.
DMat4 read_transform(const XmlFile& file, pugi::xml_node node);

/// An object element, such as `<shape type="sphere">`. Functions that read a parameter throw `Error` when it has the wrong
/// type or a malformed value.
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
    /// Place of a parameter that is there.
    Origin origin(const std::string& name) const { return file_.origin(parameters_.at(name)); }

    std::optional<double> number(const std::string& name);
    double number(const std::string& name, double otherwise) { return number(name).value_or(otherwise); }
    /// An integer between `lowest` and `highest`.
    std::optional<int> integer(const std::string& name, int lowest, int highest = std::numeric_limits<int>::max());
    bool boolean(const std::string& name, bool otherwise);
    std::optional<std::string> text(const std::string& name);
    std::optional<DVec3> vector(const std::string& name);
    std::optional<DMat4> transform(const std::string& name);

    enum class Color { reflectance, emission };
    /// A colour as Mitsuba's RGB variants see it: `<rgb>`, one number, or a `<spectrum>` of one value. The latter is grey as a
    /// reflectance; as an emission it has the white of equal energy, which is not that of sRGB.
    Rgb color(const std::string& name, float otherwise, Color use = Color::reflectance);

    /// The objects inside with one of these tags, once each.
    std::vector<pugi::xml_node> objects(std::initializer_list<std::string_view> tags);
    /// Throws for every parameter and object that was never asked for.
    void finish() const;

private:
    /// The parameter's element if it is there; throws when its tag is none of `tags`.
    pugi::xml_node find(const std::string& name, std::initializer_list<std::string_view> tags);
    double parse(pugi::xml_node node, std::string_view word) const;

    const XmlFile& file_;
    pugi::xml_node node_;
    std::map<std::string, pugi::xml_node> parameters_;
    std::vector<pugi::xml_node> objects_;
    std::set<std::string> asked_;
};

/// The numbers in an attribute, separated by spaces or commas. Throws unless each is finite and there are as many as one of
/// `counts` says.
inline std::vector<double> read_numbers(const XmlFile& file, pugi::xml_node node, const char* attribute,
                                        std::initializer_list<std::size_t> counts) {
    std::string_view text = node.attribute(attribute).value();
    std::vector<double> result;
    const auto fits = [&] { return std::find(counts.begin(), counts.end(), result.size()) != counts.end(); };
    for (std::string_view word = next_word(text, " ,\t\r\n"); !word.empty(); word = next_word(text, " ,\t\r\n")) {
        const auto number = parse_number(word);
        if (!number) fail(file.origin(node), quote(word) + " is not a finite number");
        result.push_back(*number);
    }
    if (fits()) return result;
    std::string expected;
    for (const std::size_t count : counts) expected += (expected.empty() ? "" : " or ") + std::to_string(count);
    fail(file.origin(node), std::string("the attribute \"") + attribute + "\" needs " + expected + " numbers, not " +
                                std::to_string(result.size()));
}

/// `value` with one or three numbers, or x, y and z of which each may be left out when there is an `otherwise`.
inline DVec3 read_vector(const XmlFile& file, pugi::xml_node node, std::optional<double> otherwise) {
    if (node.attribute("value")) {
        for (const char* axis : {"x", "y", "z"})
            if (node.attribute(axis)) fail(file.origin(node), "give either \"value\" or x, y and z");
        const auto numbers = read_numbers(file, node, "value", {1, 3});
        return numbers.size() == 1 ? DVec3(numbers[0]) : DVec3(numbers[0], numbers[1], numbers[2]);
    }
    DVec3 result(otherwise.value_or(0));
    const char* const axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        if (node.attribute(axes[i])) result[i] = read_numbers(file, node, axes[i], {1})[0];
        else if (!otherwise) fail(file.origin(node), std::string("the attribute \"") + axes[i] + "\" is missing");
    }
    return result;
}

inline DMat4 rotation(const DVec3& axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    DMat4 result(1);
    for (int i = 0; i < 3; ++i) {
        DVec3 e(0);
        e[i] = 1;
        // Rodrigues' formula for the image of each coordinate axis.
        result[i] = glm::dvec4(c * e + s * glm::cross(axis, e) + (1 - c) * axis[i] * axis, 0);
    }
    return result;
}

inline DMat4 read_transform_step(const XmlFile& file, pugi::xml_node node) {
    const std::string_view tag = node.name();
    DMat4 result(1);
    if (tag == "translate") {
        file.check_attributes(node, {}, {"value", "x", "y", "z"});
        result[3] = glm::dvec4(read_vector(file, node, 0), 1);
    } else if (tag == "scale") {
        file.check_attributes(node, {}, {"value", "x", "y", "z"});
        const DVec3 factors = read_vector(file, node, 1);
        for (int i = 0; i < 3; ++i) result[i][i] = factors[i];
    } else if (tag == "rotate") {
        file.check_attributes(node, {"angle"}, {"value", "x", "y", "z"});
        const DVec3 axis = read_vector(file, node, 0);
        const double length = glm::length(axis);
        if (!(std::abs(length - 1) < 1e-3))  // Mitsuba would use it as it is, which is not a rotation
            fail(file.origin(node), "the rotation axis has length " + std::to_string(length) + ": give a unit vector");
        result = rotation(axis / length, read_numbers(file, node, "angle", {1})[0]);
    } else if (tag == "lookat") {
        file.check_attributes(node, {"origin", "target"}, {"up"});
        const auto vector = [&](const char* name) {
            const auto n = read_numbers(file, node, name, {3});
            return DVec3(n[0], n[1], n[2]);
        };
        const DVec3 eye = vector("origin"), target = vector("target");
        DVec3 up = node.attribute("up") ? vector("up") : DVec3(0);
        if (up == DVec3(0)) up = DVec3(Basis(normalize(Vec3(glm::normalize(target - eye)))).tangent);  // as in Mitsuba
        try {
            result = CameraDescription::look_at(eye, target, up);
        } catch (const Error& error) {
            fail(file.origin(node), error.what());
        }
    } else if (tag == "matrix") {
        file.check_attributes(node, {"value"});
        const auto numbers = read_numbers(file, node, "value", {9, 16});
        const std::size_t size = numbers.size() == 16 ? 4 : 3;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            result[static_cast<int>(i % size)][static_cast<int>(i / size)] = numbers[i];
        if (result[0].w != 0 || result[1].w != 0 || result[2].w != 0 || result[3].w != 1)
            fail(file.origin(node), "the matrix is not affine: its last row must be 0 0 0 1");
    } else {
        fail(file.origin(node), "unknown transform; known are translate, scale, rotate, lookat and matrix");
    }
    if (const auto child = node.first_child(); child.type() == pugi::node_element)
        fail(file.origin(child), "unexpected inside " + file.origin(node).element);
    return result;
}

inline DMat4 read_transform(const XmlFile& file, pugi::xml_node node) {
    DMat4 result(1);
    for (const pugi::xml_node child : node.children())
        if (child.type() == pugi::node_element) result = read_transform_step(file, child) * result;
    const double determinant = linear_determinant(result);
    if (determinant == 0 || !parse_number(std::to_string(determinant)))
        fail(file.origin(node), "the transform cannot be inverted: it has a scale of 0, or overflows");
    return result;
}

inline XmlElement::XmlElement(const XmlFile& file, pugi::xml_node node) : file_(file), node_(node) {
    static const std::map<std::string_view, bool> tags{  // true for parameters, false for objects
        {"float", true},   {"integer", true}, {"boolean", true}, {"string", true},   {"rgb", true},     {"spectrum", true},
        {"point", true},   {"vector", true},  {"transform", true}, {"bsdf", false},  {"shape", false},  {"emitter", false},
        {"sensor", false}, {"film", false},   {"rfilter", false}, {"sampler", false}, {"integrator", false}, {"ref", false}};
    for (const pugi::xml_node child : node.children()) {
        if (child.type() != pugi::node_element || std::string_view(child.name()) == "default") continue;
        const auto tag = tags.find(child.name());
        if (tag == tags.end()) fail(file.origin(child), "this element is not supported here");
        if (!tag->second) {
            objects_.push_back(child);
            continue;
        }
        const std::string_view name = child.name();
        if (name == "point" || name == "vector") file.check_attributes(child, {"name"}, {"value", "x", "y", "z"});
        else if (name == "transform") file.check_attributes(child, {"name"});
        else file.check_attributes(child, {"name", "value"});
        if (!parameters_.emplace(child.attribute("name").value(), child).second)
            fail(file.origin(child), "this parameter is given twice");
        if (name != "transform")
            if (const auto inner = child.first_child(); inner.type() == pugi::node_element)
                fail(file.origin(inner), "unexpected inside a parameter");
    }
}
