#pragma once

// The settings of methods, as the command line gives them and as --stats tells them.

#include "program.hpp"

#include <lightswitch/method/any_method.hpp>

#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lightswitch::program {

/// Sets what `options` holds in those of the methods that have it, for images of so many pixels. Throws `Error` when an
/// option is of no use to any of them, or impossible for one.
void set_options(std::span<AnyMethod> methods, const MethodOptions& options, std::size_t pixels);

/// What `set_options` can set of the method: key of --stats, and value.
std::vector<std::pair<std::string_view, std::variant<bool, int, double>>> settings_of(const AnyMethod& method);

}  // namespace lightswitch::program
