#pragma once

// What a refusal says.

#include <lightswitch/core/error.hpp>

#include <string>

namespace lightswitch::test {

/// The message of the `Error` that `action` throws, or "(no error)".
std::string message_of(const auto& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "(no error)";
}

}  // namespace lightswitch::test
