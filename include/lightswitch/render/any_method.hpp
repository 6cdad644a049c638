#pragma once

// A method chosen at run time.

#include <lightswitch/core/error.hpp>
#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/mlt.hpp>
#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>
#include <lightswitch/method/photon_mapping.hpp>
#include <lightswitch/method/silhouette.hpp>
#include <lightswitch/method/vcm.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <string>
#include <string_view>
#include <variant>

namespace lightswitch {

/// Any of the library's methods. One `std::visit` per render leads to code made for that method and scene type.
using AnyMethod = std::variant<Silhouette, Phong, PathTracer, PathTracerNee, LightTracer, Bdpt, PhotonMapping, Vcm, Mlt>;

/// Calls `f(M{})` for every method of `AnyMethod` in turn, with its defaults.
void for_each_method(auto&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (f(std::variant_alternative_t<I, AnyMethod>{}), ...);
    }(std::make_index_sequence<std::variant_size_v<AnyMethod>>{});
}

/// The names of all methods, separated by commas.
inline std::string method_names() {
    std::string names;
    for_each_method([&](const auto& m) { names += (names.empty() ? "" : ", ") + std::string(m.name); });
    return names;
}

/// The method of that name, with its defaults. Throws `Error` that lists the names when there is none.
inline AnyMethod method_by_name(std::string_view wanted) {
    std::optional<AnyMethod> found;
    for_each_method([&](const auto& m) {
        if (m.name == wanted) found = m;
    });
    if (!found) throw Error("there is no method \"" + std::string(wanted) + "\"; known are " + method_names());
    return *found;
}

inline std::string_view method_name(const AnyMethod& method) {
    return std::visit([](const auto& m) -> std::string_view { return m.name; }, method);
}
inline Kind method_kind(const AnyMethod& method) {
    return std::visit([](const auto& m) { return m.kind; }, method);
}

/// Sets what a method has of the two; the rest is left alone.
inline void set_path_length(AnyMethod& method, const PathLength& length) {
    std::visit(
        [&](auto& m) {
            if constexpr (requires { m.max_depth; }) m.max_depth = length.max_depth;
            if constexpr (requires { m.rr_depth; }) m.rr_depth = length.rr_depth;
        },
        method);
}

}  // namespace lightswitch
