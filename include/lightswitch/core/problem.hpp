#pragma once

// What is wrong with a value of a description, in words.

#include <lightswitch/core/math.hpp>

#include <string>

namespace lightswitch::detail {

/// Coordinates beyond this would overflow when they are squared.
inline constexpr double largest_coordinate = 1e100;

/// What is wrong with a position, direction or amount of light, in words that begin with `what`; or nothing.
inline std::string position_problem(const DVec3& p, const std::string& what) {
    if (!is_finite(p)) return what + " is not a finite number";
    if (glm::any(glm::greaterThan(glm::abs(p), DVec3(largest_coordinate)))) return what + " is beyond 1e100";
    return {};
}
inline std::string direction_problem(const DVec3& d, const std::string& what) {
    return is_finite(d) && glm::length(d) > 0 ? "" : what + " is not a direction";
}
inline std::string radiance_problem(const Rgb& value, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        if (!is_finite(value[c])) return what + " is not a finite number";
        if (value[c] < 0) return what + " is negative";
        if (value[c] > 1e30f) return what + " is above 1e30";
    }
    return {};
}

}  // namespace lightswitch::detail
