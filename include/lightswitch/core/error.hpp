#pragma once

// Errors that say where, what, and what to do.

#include <lightswitch/core/floating_point.hpp>

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace lightswitch {

/// Everything that the library throws. The message is one line for the user, without a trailing newline.
class Error : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A place in an input file, carried by whatever was made from it so that a later check can still name it.
/// All parts are optional: things made in code have no file.
struct Origin {
    std::string file{};     ///< path as the user gave it
    int line = 0;           ///< 1-based; 0 when unknown
    std::string element{};  ///< for example `<shape type="obj">`

    /// "room.xml:12: <shape type="obj">: ", or as much of it as is known.
    std::string prefix() const {
        std::string text = file;
        if (line > 0) text += ":" + std::to_string(line);
        if (!text.empty()) text += ": ";
        if (!element.empty()) text += element + ": ";
        return text;
    }
};

/// A number as messages show it: as short as six digits allow.
inline std::string number_text(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", x);
    return text;
}

/// Throws an `Error` whose message begins with the place.
[[noreturn]] inline void fail(const Origin& where, std::string_view what) {
    throw Error(where.prefix() + std::string(what));
}

/// What `f()` returns; an `Error` that it throws is said to be of that place.
template <class F>
decltype(auto) at_place(const Origin& where, F&& f) {
    try {
        return f();
    } catch (const Error& error) {
        fail(where, error.what());
    }
}

}  // namespace lightswitch
