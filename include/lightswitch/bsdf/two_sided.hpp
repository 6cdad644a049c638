#pragma once

#include <lightswitch/bsdf/material.hpp>

namespace lightswitch {

/// Says in a description that the back of a surface looks like its front, whose model is `inner`. Not for models that
/// transmit; those that do so with some parameters only are refused when the scene is built.
///
/// It is not a model itself, and no kind of its own in a scene: built surfaces keep a bit (`MaterialIndex`).
template <Material Inner>
struct TwoSided {
    static_assert(
        !transmits<Inner> || requires(const Inner& inner) { inner.transmits_light(); },
        "a surface that transmits light has no back of its own");

    Inner inner;
};

}  // namespace lightswitch
