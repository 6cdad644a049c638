#pragma once

// Words: suggestions for misspelt ones, and numbers read from them.

#include <span>
#include <string>
#include <string_view>

namespace lightswitch::program {

/// "; did you mean "path"?" for the nearest of `known`, which are in small letters, or an empty string when none is
/// near.
std::string suggestion(std::string_view given, std::span<const std::string_view> known);

/// "a, b, c".
std::string list(std::span<const std::string_view> names);

/// All of `text` as a number. Throws `Error` that begins with `option` unless it is one between `least` and `most`.
long long parse_integer_option(std::string_view option, std::string_view text, long long least, long long most);
/// The same for a finite decimal number of at least `least`, or above it when `above` is set.
double parse_number_option(std::string_view option, std::string_view text, double least, bool above);

}  // namespace lightswitch::program
