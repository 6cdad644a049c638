#pragma once

// The surface models that scene files can name.

#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/rough_conductor.hpp>
#include <lightswitch/bsdf/two_sided.hpp>
#include <lightswitch/scene/description.hpp>

namespace lightswitch {

/// Any of the library's surface models.
using LibraryBsdf = std::variant<Lambert, TwoSided<Lambert>, Conductor, TwoSided<Conductor>, RoughConductor,
                                 TwoSided<RoughConductor>, Dielectric>;
/// What a scene file holds.
using LibraryDescription = SceneDescription<LibraryBsdf>;

}  // namespace lightswitch
