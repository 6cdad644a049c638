#pragma once

// What the program tells about methods beyond what they say themselves.

#include <lightswitch/method/any_method.hpp>

#include <array>
#include <string_view>

namespace lightswitch::program {

struct MethodNotes {
    std::string_view name;
    std::string_view can;
    std::string_view cannot;  ///< beside the paths that it cannot make (`PathClasses`)
};

inline constexpr std::array method_notes{
    MethodNotes{Silhouette::name, "where anything is: one colour, no light, no noise but at edges",
                "show light, materials or depth"},
    MethodNotes{Phong::name, "light from each lamp's centre, hard shadows, highlights; quick and nearly free of noise",
                "show indirect light, soft shadows, mirrors or glass"},
    MethodNotes{PathTracer::name, "all light transport by the rendering equation alone: the ground truth",
                "find small lamps without much noise"},
    MethodNotes{PathTracerNee::name, "all light transport, lamps sampled directly: the best choice for most scenes",
                "find caustics of small lamps without much noise"},
    MethodNotes{LightTracer::name, "light from the lamps' side: sharp caustics, point lights, lamps seen directly", ""},
    MethodNotes{Bdpt::name, "all light transport, paths from both sides joined in every way: hidden lamps, caustics",
                "be quick: a sample costs several times one of path-nee"},
    MethodNotes{PhotonMapping::name,
                "caustics, also in mirrors, and smooth indirect light, blurred within a shrinking radius",
                "be sharp at once: its error falls slowly; glossy surfaces are noisy"},
    MethodNotes{Vcm::name, "all light transport: bdpt that also merges nearby paths, so caustics in mirrors, too",
                "be exact at once where it merges; takes memory for all light paths of an iteration"},
    MethodNotes{Mlt::name, "all light transport: bdpt whose brightest finds chains spread out: caustics, rare light",
                "be better than bdpt where nothing is rare; what is left of rare light is blotches"},
    MethodNotes{PathGuided::name,
                "all light transport: path-nee that learns where light comes from; light through gaps",
                "help at once: what it learns takes some of the time"},
};

/// The notes on a method of `AnyMethod`.
constexpr const MethodNotes& notes_on(std::string_view name) {
    for (const MethodNotes& notes : method_notes)
        if (notes.name == name) return notes;
    throw "a method has no notes: add a line to method_notes";
}

/// The paths that a method of that name cannot make.
inline PathClasses cannot_make(std::string_view name) {
    PathClasses result;
    for_each_method([&]<class M>(const M&) {
        if (M::name == name) result = lightswitch::cannot_make<M>();
    });
    return result;
}

/// The names of all methods.
inline constexpr auto known_methods = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<std::string_view, sizeof...(I)>{notes_on(std::variant_alternative_t<I, AnyMethod>::name).name...};
}
(std::make_index_sequence<std::variant_size_v<AnyMethod>>{});

/// The method that an option names. Throws `Error`, which ends with `hint`, when there is none.
AnyMethod find_method(std::string_view wanted, std::string_view option, std::string_view hint = "");

}  // namespace lightswitch::program
