#pragma once

// The surface models that scene files can name.

#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/rough_conductor.hpp>
#include <lightswitch/scene/description.hpp>
#include <lightswitch/texture/textured.hpp>

namespace lightswitch {

/// Any of the library's surface models.
using LibraryBsdf = std::variant<Lambert, Conductor, RoughConductor, Dielectric, Textured<Lambert>, Textured<Conductor>,
                                 Textured<RoughConductor>, Textured<Dielectric>>;
/// What a scene file holds.
using LibraryDescription = SceneDescription<LibraryBsdf>;

}  // namespace lightswitch
