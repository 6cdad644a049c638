#pragma once

// The version of the library: the one place that states it (the build reads it from here).

#include <lightswitch/core/floating_point.hpp>

#include <string>

#define LIGHTSWITCH_VERSION_MAJOR 0
#define LIGHTSWITCH_VERSION_MINOR 1
#define LIGHTSWITCH_VERSION_PATCH 0

namespace lightswitch {

/// The version of the headers that a program is compiled with, as text ("1.2.3", https://semver.org).
/// For `#if` there are the macros above.
inline std::string version() {
    return std::to_string(LIGHTSWITCH_VERSION_MAJOR) + "." + std::to_string(LIGHTSWITCH_VERSION_MINOR) + "." +
           std::to_string(LIGHTSWITCH_VERSION_PATCH);
}

}  // namespace lightswitch
