#pragma once

// Vectors and transforms in scene files.

#include <lightswitch/core/math.hpp>
#include <lightswitch/load/xml.hpp>
#include <lightswitch/scene/check.hpp>

#include <numbers>

namespace lightswitch::detail {

/// The matrix of a `<transform>`: its operations in the order of the file. Throws unless it is affine and invertible.
DMat4 read_transform(const XmlFile& file, pugi::xml_node node);

/// The numbers in an attribute, separated by spaces or commas. Throws unless each is finite and there are as many as
/// one of `counts` says.
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

/// Turns by `degrees` about the unit vector `axis`. With an axis of another length it is no rotation.
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

/// The first tangent of the basis by Duff et al. (see `Basis`), which is what Mitsuba takes for a missing up vector.
inline DVec3 any_tangent(const DVec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// The matrix of one operation inside a `<transform>`.
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
        if (!(length > 0)) {
            file.log().problem(file.origin(node), "the rotation axis has length 0: give a unit vector",
                               "it is left out");
            return result;
        }
        // Mitsuba 0.6 takes it for a direction, 3 puts it into Rodrigues' formula as it is.
        const bool unit = std::abs(length - 1) < 1e-3 || file.is_old(node);
        if (!unit)
            file.log().notice(file.origin(node), "the rotation axis has length " + std::to_string(length) +
                                                     ": as in Mitsuba 3, this scales besides");
        result = rotation(unit ? axis / length : axis, read_numbers(file, node, "angle", {1})[0]);
    } else if (tag == "lookat") {
        file.check_attributes(node, {"origin", "target"}, {"up"});
        const auto vector = [&](const char* name) {
            const auto n = read_numbers(file, node, name, {3});
            return DVec3(n[0], n[1], n[2]);
        };
        const DVec3 eye = vector("origin"), target = vector("target");
        DVec3 up = node.attribute("up") ? vector("up") : DVec3(0);
        if (up == DVec3(0) && target != eye) up = any_tangent(glm::normalize(target - eye));
        if (!(glm::length(target - eye) > 0)) fail(file.origin(node), "\"target\" is at \"origin\": move one of them");
        try {
            result = CameraDescription::look_at(eye, target, up);
        } catch (const Error&) {  // which speaks of a camera
            file.log().problem(file.origin(node),
                               "\"up\" is parallel to the way from \"origin\" to \"target\": give another one",
                               "another one is used");
            result = CameraDescription::look_at(eye, target, any_tangent(glm::normalize(target - eye)));
        }
    } else if (tag == "matrix") {
        file.check_attributes(node, {"value"});
        const auto numbers = read_numbers(file, node, "value", {9, 16});
        const std::size_t size = numbers.size() == 16 ? 4 : 3;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            result[static_cast<int>(i % size)][static_cast<int>(i / size)] = numbers[i];
        if (!is_affine(result)) fail(file.origin(node), "the matrix is not affine: its last row must be 0 0 0 1");
    } else {
        fail(file.origin(node), "unknown transform; known are translate, scale, rotate, lookat and matrix");
    }
    file.check_childless(node);
    return result;
}

inline DMat4 read_transform(const XmlFile& file, pugi::xml_node node) {
    DMat4 result(1);
    for (const pugi::xml_node child : file.children(node)) result = read_transform_step(file, child) * result;
    const double determinant = linear_determinant(result);
    if (determinant == 0 || !is_finite(determinant))
        fail(file.origin(node), "the transform cannot be inverted: it has a scale of 0, or overflows");
    return result;
}

}  // namespace lightswitch::detail
