#pragma once

// A method chosen at run time: of the library's, or of any list of methods.

#include <lightswitch/core/error.hpp>
#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/light_tracer.hpp>
#include <lightswitch/method/mlt.hpp>
#include <lightswitch/method/path_guided.hpp>
#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>
#include <lightswitch/method/photon_mapping.hpp>
#include <lightswitch/method/silhouette.hpp>
#include <lightswitch/method/vcm.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace lightswitch {

/// Any of the library's methods. One `std::visit` per render leads to code made for that method and scene type.
using AnyMethod =
    std::variant<Silhouette, Phong, PathTracer, PathTracerNee, LightTracer, Bdpt, PhotonMapping, Vcm, Mlt, PathGuided>;

namespace detail {

template <class Variant, class... More>
struct Append;
template <class... M, class... More>
struct Append<std::variant<M...>, More...> {
    using type = std::variant<M..., More...>;
};

}  // namespace detail

/// The variant with more alternatives, such as one's own methods beside the library's: `append_t<AnyMethod, Mine>`.
template <class Variant, class... More>
using append_t = typename detail::Append<Variant, More...>::type;

// All below take any `std::variant` of methods that have defaults; where nothing tells which, it is `AnyMethod`.

/// Calls `f(M{})` for every method of the variant in turn, with its defaults.
template <class Variant = AnyMethod>
void for_each_method(auto&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f(std::variant_alternative_t<I, Variant>{}), ...); }
    (std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// The names of all methods, separated by commas.
template <class Variant = AnyMethod>
std::string method_names() {
    std::string names;
    for_each_method<Variant>([&](const auto& m) { names += (names.empty() ? "" : ", ") + std::string(m.name); });
    return names;
}

/// The method of that name, with its defaults; the first of them when several have it. Throws `Error` that lists the
/// names when there is none.
template <class Variant = AnyMethod>
Variant method_by_name(std::string_view wanted) {
    std::optional<Variant> found;
    for_each_method<Variant>([&](const auto& m) {
        if (m.name == wanted && !found) found = m;
    });
    if (!found) throw Error("there is no method \"" + std::string(wanted) + "\"; known are " + method_names<Variant>());
    return *found;
}

template <class... M>
std::string_view method_name(const std::variant<M...>& method) {
    return std::visit([](const auto& m) -> std::string_view { return m.name; }, method);
}
template <class... M>
Kind method_kind(const std::variant<M...>& method) {
    return std::visit([](const auto& m) -> Kind { return m.kind; }, method);
}

/// Sets what a method has of the two; the rest is left alone.
template <class... M>
void set_path_length(std::variant<M...>& method, const PathLength& length) {
    std::visit(
        [&](auto& m) {
            if constexpr (requires { m.max_depth; }) m.max_depth = length.max_depth;
            if constexpr (requires { m.rr_depth; }) m.rr_depth = length.rr_depth;
        },
        method);
}

}  // namespace lightswitch
