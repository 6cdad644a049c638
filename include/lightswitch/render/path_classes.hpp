#pragma once

// Kinds of light paths that some methods cannot make: what a comparison of two methods must know.

#include <lightswitch/core/floating_point.hpp>

#include <string>

namespace lightswitch {

/// A set of classes of light paths. A *Dirac light* is a point or directional one, which no ray meets by chance; a
/// *caustic* is light that reaches a rough surface by mirrors or glass; *mirrored* is what the camera sees in mirrors
/// or through glass.
///
/// A method says with `static constexpr PathClasses cannot_make` which of them its paths never form, however many it
/// traces; without it, all are taken to be made. Methods may also have a member `PathClasses left_out`, the classes
/// that are to be missing from the image, and say with `static constexpr PathClasses can_leave_out` which ones it may
/// name: so they can be compared with methods that see less.
struct PathClasses {
    bool dirac_light = false;             ///< all that comes from Dirac lights
    bool dirac_caustic = false;           ///< caustics of Dirac lights
    bool mirrored_dirac_caustic = false;  ///< caustics of Dirac lights, seen in mirrors or through glass
    bool mirrored = false;                ///< all that is seen in mirrors or through glass, lights too

    constexpr bool any() const { return dirac_light || dirac_caustic || mirrored_dirac_caustic || mirrored; }

    friend constexpr PathClasses operator&(const PathClasses& a, const PathClasses& b) {
        return {a.dirac_light && b.dirac_light, a.dirac_caustic && b.dirac_caustic,
                a.mirrored_dirac_caustic && b.mirrored_dirac_caustic, a.mirrored && b.mirrored};
    }
    friend constexpr PathClasses operator|(const PathClasses& a, const PathClasses& b) {
        return {a.dirac_light || b.dirac_light, a.dirac_caustic || b.dirac_caustic,
                a.mirrored_dirac_caustic || b.mirrored_dirac_caustic, a.mirrored || b.mirrored};
    }
    /// Those of `a` that are not in `b`.
    friend constexpr PathClasses operator-(const PathClasses& a, const PathClasses& b) {
        return {a.dirac_light && !b.dirac_light, a.dirac_caustic && !b.dirac_caustic,
                a.mirrored_dirac_caustic && !b.mirrored_dirac_caustic, a.mirrored && !b.mirrored};
    }
    friend constexpr bool operator==(const PathClasses&, const PathClasses&) = default;

    /// The length (as in `PathLength`) of the shortest path that may belong to one of the classes.
    constexpr int shortest() const { return dirac_light || mirrored ? 2 : dirac_caustic ? 3 : 4; }
};

/// The classes in words, without those that another one includes; empty without any.
inline std::string describe(const PathClasses& classes) {
    std::string text;
    const auto add = [&](bool there, const char* words) {
        if (there) text += (text.empty() ? "" : "; ") + std::string(words);
    };
    add(classes.dirac_light, "light of point and directional lights");
    add(classes.dirac_caustic && !classes.dirac_light, "caustics of point and directional lights");
    add(classes.mirrored, "what is seen in mirrors or through glass");
    add(classes.mirrored_dirac_caustic && !classes.dirac_caustic && !classes.dirac_light && !classes.mirrored,
        "caustics of point and directional lights, seen in mirrors or through glass");
    return text;
}

/// What the method cannot make, of what it says itself.
template <class M>
constexpr PathClasses cannot_make() {
    if constexpr (requires { M::cannot_make; }) return M::cannot_make;
    else return {};
}

/// The classes of which the scene may hold paths: by its lights and materials, wherever they stand.
PathClasses possible_paths(const auto& scene) {
    bool dirac = false;
    for (const auto& emitter : scene.emitters()) dirac = dirac || emitter.dirac();
    const bool specular = scene.has_specular();
    return {dirac, dirac && specular, dirac && specular, specular};
}

}  // namespace lightswitch
