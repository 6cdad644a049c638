#pragma once

// What lies over surface models: layers, which name other materials of a description by their numbers. They may be
// nested in any way, and add no type to a scene: a ray that meets them is led to one surface model.

#include <lightswitch/bsdf/coat.hpp>
#include <lightswitch/texture/texture.hpp>

#include <string_view>
#include <variant>

namespace lightswitch {

/// `weight` (0 to 1, its luminance counts) of `second`, and the rest of `first`. Which of the two a path sees at a
/// vertex is decided by a number that is drawn from place and direction (as in pbrt-v4, section 10.5.1): noise, but no
/// bias.
struct Blend {
    std::size_t first, second;
    Texture weight;
};

/// A surface that is there with the probability `opacity` (0 to 1, luminance), and is `inner` then. Where it is not,
/// paths and shadow rays go straight on, and no bounce is counted. The number that decides is drawn like that of a
/// `Blend`.
struct Mask {
    std::size_t inner;
    Texture opacity;
};

/// `inner` under the normal of a surface that is raised by `scale * height` (scene units; luminance), after Blinn 1978.
/// What becomes of directions that see the raised surface and the true one from different sides: `Mapped`.
struct BumpMap {
    std::size_t inner;
    Texture height;
    float scale = 1;
    bool flips = true, shadows = true;  ///< see `MappedNormal`
};

/// `inner` under the normal 2 c - 1 for the colour c, in the frame of dp/du, its right angle and the shading normal.
struct NormalMap {
    std::size_t inner;
    Texture normals;
    bool flips = true, shadows = true;  ///< see `MappedNormal`
    float scale = 1;                    ///< of the normal's first two parts
    /// The right angle points to where v falls, as glTF has it, and not a quarter turn to the left of dp/du: the two
    /// differ where the texture lies mirrored on the surface.
    bool against_v = false;
};

/// `front` where the surface is seen from its front, and `back`, in a mirrored frame, where from behind.
struct BothSides {
    std::size_t front, back;
};

/// `inner` under a coat: not a mask, a map or another coat, which may lie over it but not below. Under a rough coat
/// `inner` has no model that is specular as a whole, such as a mirror.
struct Coating {
    std::size_t inner;
    Coat coat;
};

using MaterialLayer = std::variant<Blend, Mask, BumpMap, NormalMap, BothSides, Coating>;

/// What the layer is called in lists.
inline std::string_view layer_name(const MaterialLayer& layer) {
    constexpr std::string_view names[] = {"blend", "mask", "bump map", "normal map", "two models, one on each side",
                                          "coat"};
    static_assert(std::size(names) == std::variant_size_v<MaterialLayer>);
    return names[layer.index()];
}

}  // namespace lightswitch
