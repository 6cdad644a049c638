#pragma once

// What a light is: the concept that every one meets, and the sample that they return.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/pdf.hpp>
#include <lightswitch/scene/surface_point.hpp>

#include <concepts>

namespace lightswitch {

/// A direction from which a light reaches a point.
struct LightSample {
    Vec3 wi{0, 0, 1};      ///< unit, from the point towards the light
    Rgb radiance{0};       ///< what arrives if nothing is in between; for a Dirac light the irradiance at normal incidence
    SolidAnglePdf pdf{};   ///< density of `wi`; for a Dirac light the probability of having chosen it
    bool dirac = false;    ///< true when no other strategy can find the light: point and directional lights
    Ray visibility;        ///< the ray that must be free
};

/// A source of light in render space. `sample` may return black when the light cannot reach the point; the density in it is
/// that of the light alone, without the probability of having chosen the light. Safe to use from several threads.
///
/// - `infinite`: true when the light is beyond the scene and is met by rays that leave it;
/// - `power()`: luminous weight by which the light is selected, proportional to the flux that it brings into the scene.
template <class L>
concept Light = requires(const L light, const SurfacePoint point, const Vec2 u) {
    { L::infinite } -> std::convertible_to<bool>;
    { light.sample(point, u) } -> std::same_as<LightSample>;
    { light.power() } -> std::convertible_to<double>;
};

/// A light with a surface, which rays can hit. `pdf(from, wi, hit)` is the density with which `sample` at the
/// position `from` chooses the direction `wi` to the point `hit` on the light; `emitted` the radiance that leaves it.
template <class L>
concept AreaLight = Light<L> && requires(const L light, const SurfacePoint point, const Vec3 position, const Vec3 direction) {
    { light.emitted(point, direction) } -> std::same_as<Rgb>;
    { light.pdf(position, direction, point) } -> std::same_as<SolidAnglePdf>;
};

/// A light that surrounds the scene. `radiance(wi)` arrives from the direction `wi`, which `sample`, at a
/// point whose `facing_normal()` is `normal`, chooses with density `pdf(normal, wi)`.
template <class L>
concept EnvironmentLight = Light<L> && requires(const L light, const Vec3 direction) {
    { light.radiance(direction) } -> std::same_as<Rgb>;
    { light.pdf(direction, direction) } -> std::same_as<SolidAnglePdf>;
};

}  // namespace lightswitch
