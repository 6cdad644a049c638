#pragma once

// What the program tells about methods beyond what they say themselves.

#include <lightswitch/render/any_method.hpp>

#include <array>
#include <string_view>

namespace lightswitch::program {

struct MethodNotes {
    std::string_view name;
    std::string_view can;
    std::string_view cannot;
    bool sees_dirac_lights = true;  ///< point and directional lights, which no ray meets by chance
    bool sees_in_mirrors = true;    ///< and through glass
};

inline constexpr std::array method_notes{
    MethodNotes{Silhouette::name, "where anything is: one colour, no light, no noise but at edges",
                "show light, materials or depth"},
    MethodNotes{Phong::name, "light from each lamp's centre, hard shadows, highlights; quick and nearly free of noise",
                "show indirect light, soft shadows, mirrors or glass"},
    MethodNotes{PathTracer::name, "all light transport by the rendering equation alone: the ground truth",
                "see point and directional lights; small lamps are noisy", false},
    MethodNotes{PathTracerNee::name, "all light transport, lamps sampled directly: the best choice for most scenes",
                "find caustics of point and directional lights; those of small lamps are noisy"},
    MethodNotes{LightTracer::name, "light from the lamps' side: sharp caustics, point lights, lamps seen directly",
                "show what is seen in a mirror or through glass", true, false},
    MethodNotes{Bdpt::name, "all light transport, paths from both sides joined in every way: hidden lamps, caustics",
                "find caustics of point lights in mirrors; a sample costs several times one of path-nee"},
    MethodNotes{PhotonMapping::name, "caustics, also in mirrors, and smooth indirect light, blurred within a shrinking radius",
                "be sharp at once: its error falls slowly; glossy surfaces are noisy"},
    MethodNotes{Vcm::name, "all light transport: bdpt that also merges nearby paths, so caustics in mirrors, too",
                "be exact at once where it merges; takes memory for all light paths of an iteration"},
    MethodNotes{Mlt::name, "all light transport, by chains that stay where light is found: hidden lamps, caustics",
                "spread its noise evenly: errors are blotches, and the brightness settles with the work"},
};

/// The notes on a method of `AnyMethod`.
constexpr const MethodNotes& notes_on(std::string_view name) {
    for (const MethodNotes& notes : method_notes)
        if (notes.name == name) return notes;
    throw "a method has no notes: add a line to method_notes";
}

/// The names of all methods.
inline constexpr auto known_methods = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<std::string_view, sizeof...(I)>{notes_on(std::variant_alternative_t<I, AnyMethod>::name).name...};
}
(std::make_index_sequence<std::variant_size_v<AnyMethod>>{});

/// The method that an option names. Throws `Error`, which ends with `hint`, when there is none.
AnyMethod find_method(std::string_view wanted, std::string_view option, std::string_view hint = "");

}  // namespace lightswitch::program
