#pragma once

#include <lightswitch/bsdf/material.hpp>

namespace lightswitch {

/// Says in a description that the back of a surface looks like its front, whose model is `inner`. Not for models that
/// transmit.
///
/// It is not a model itself, and no kind of its own in a scene: built surfaces keep a bit (`MaterialIndex`).
template <Material Inner>
struct TwoSided {
    static_assert(!transmits<Inner>, "a surface that transmits light has no back of its own");

    Inner inner;
};

}  // namespace lightswitch
