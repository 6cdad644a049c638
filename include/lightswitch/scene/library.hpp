#pragma once

// The surface models that scene files can name.

#include <lightswitch/bsdf/any_material.hpp>
#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/modified_phong.hpp>
#include <lightswitch/bsdf/plastic.hpp>
#include <lightswitch/bsdf/principled.hpp>
#include <lightswitch/bsdf/principled_thin.hpp>
#include <lightswitch/bsdf/rough_conductor.hpp>
#include <lightswitch/bsdf/rough_dielectric.hpp>
#include <lightswitch/bsdf/rough_diffuse.hpp>
#include <lightswitch/bsdf/rough_plastic.hpp>
#include <lightswitch/bsdf/thin_dielectric.hpp>
#include <lightswitch/bsdf/ward.hpp>
#include <lightswitch/scene/description.hpp>
#include <lightswitch/texture/textured.hpp>

namespace lightswitch {

namespace detail {

template <class... B>
struct Library {
    using Plain = Bsdfs<B...>;
    using Placed = Bsdfs<Textured<B>...>;
};

/// Common ones first: finding a model's code takes a comparison for each that comes before it.
using AllModels = Library<Lambert, Conductor, RoughConductor, Dielectric, Principled, Plastic, RoughPlastic,
                          RoughDielectric, ThinDielectric, PrincipledThin, RoughDiffuse, ModifiedPhong, Ward>;

}  // namespace detail

/// All of the library's surface models.
using AllBsdfs = detail::AllModels::Plain;
/// The same with any parameter of a model from a texture, and layers over them.
using TexturedBsdfs = detail::AllModels::Placed;
/// What a scene file holds: any materials.
using LibraryDescription = SceneDescription<AnyMaterial>;

}  // namespace lightswitch
