#pragma once

#include <lightswitch/core/math.hpp>

#include <string_view>
#include <tuple>

namespace lightswitch {

/// A parameter of a surface model: its name in scene files, and where it is kept. `T` is `float` or `Rgb`.
template <class B, class T>
struct Parameter {
    std::string_view name;
    T B::*member;
};

/// The parameters of a surface model that can be textured, as a `std::tuple` of `Parameter`s; each model names its own
/// beside itself.
template <class B>
inline constexpr auto parameters_of = std::tuple{};

}  // namespace lightswitch
