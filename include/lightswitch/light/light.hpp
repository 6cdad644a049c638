#pragma once

// What a light is: the concept that every one meets, and the sample that they return.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/pdf.hpp>
#include <lightswitch/core/warp.hpp>
#include <lightswitch/geometry/surface_point.hpp>

#include <concepts>

namespace lightswitch {

/// A direction from which a light reaches a point.
struct LightSample {
    Vec3 wi{0, 0, 1};  ///< unit, from the point towards the light
    Rgb radiance{0};   ///< what arrives if nothing is in between; for a Dirac light the irradiance at normal incidence
    SolidAnglePdf pdf{};  ///< density of `wi`; for a Dirac light the probability of having chosen it
    bool dirac = false;   ///< true when no other strategy can find the light: point and directional lights
    Ray visibility;       ///< the ray that must be free
    float spread = 0;     ///< as `EmittingLight` says; only if the light is one
};

/// The start of a light path.
struct LightEmission {
    Ray ray;             ///< leaves the light, off its surface
    Rgb weight{0};       ///< emitted radiance * |cosine| / density: the power that the path carries
    EmissionPdf pdf{};   ///< density of the ray
    float cosine = 1;    ///< between the ray and the light's normal; 1 when it has none
    bool dirac = false;  ///< true when no ray can meet the light: point and directional lights
    TypedIndex light{};  ///< which one; set by the scene
};

/// A parallel ray from infinitely far away, against the direction `towards` (unit): `place` in [0,1)^2 is mapped evenly
/// to the disk that the scene's bounding sphere, of that radius around the origin, fills in that direction.
inline Ray ray_into_scene(const Vec3& towards, const Vec2& place, float scene_radius) {
    const Vec2 p = uniform_disk(place, scene_radius);
    const Basis basis(towards);
    // A little outside of the sphere, so that rounding does not cut off what touches it.
    return {.origin = 1.001f * scene_radius * towards + p.x * basis.tangent + p.y * basis.bitangent,
            .direction = -towards};
}

/// Where a light is, and into which directions it shines how strongly: what it is chosen by among many (`LightTree`).
/// In render space. Bounds that leave something out cost noise and never bias.
struct LightBounds {
    Vec3 center{0};
    float radius = 0;        ///< of a sphere around `center` that holds the light
    Vec3 axis{0, 0, 1};      ///< unit
    float cos_normals = -1;  ///< the cosine of the largest angle between `axis` and a normal of the light; -1 if round
    float cos_emission = 0;  ///< the cosine of the largest angle between a normal and the light that leaves there
    double intensity = 0;    ///< the largest radiant intensity (luminous weight) along a direction

    /// Whether all of it is finite; a light without usable bounds is chosen as one that gives none.
    bool usable() const {
        return is_finite(center) && is_finite(axis) && is_finite(cos_normals) && is_finite(cos_emission) &&
               is_finite(intensity) && is_finite(radius) && intensity >= 0 && radius >= 0;
    }
};

/// A source of light in render space. `sample` may return black when the light cannot reach the point; the density in
/// it is that of the light alone, without the probability of having chosen the light. Safe to use from several threads.
///
/// - `infinite`: true when the light is beyond the scene and is met by rays that leave it;
/// - `power()`: luminous weight by which the light is selected, proportional to the flux that it brings into the scene;
/// - optionally `bounds()`, `LightBounds` of a light that is not `infinite`: then a scene of many lights chooses it by
///   what it may bring to a point, too (`BoundedLight`).
template <class L>
concept Light = requires(const L light, const SurfacePoint point, const Vec2 u) {
    { L::infinite } -> std::convertible_to<bool>;
    { light.sample(point, u) } -> std::same_as<LightSample>;
    { light.power() } -> std::convertible_to<double>;
};

/// A light that says where it is.
template <class L>
concept BoundedLight = Light<L> && requires(const L light) {
    { light.bounds() } -> std::same_as<LightBounds>;
};

/// A light with a surface, which rays can hit. `pdf(from, wi, hit)` is the density with which `sample` at the
/// position `from` chooses the direction `wi` to the point `hit` on the light; `emitted` the radiance that leaves it.
template <class L>
concept AreaLight = Light<L> &&
    requires(const L light, const SurfacePoint point, const Vec3 position, const Vec3 direction) {
    { light.emitted(point, direction) } -> std::same_as<Rgb>;
    { light.pdf(position, direction, point) } -> std::same_as<SolidAnglePdf>;
};

/// A light that surrounds the scene. `radiance(wi)` arrives from the direction `wi`, which `sample`, at a
/// point whose `lit_normal()` is `normal`, chooses with density `pdf(normal, wi)`.
template <class L>
concept EnvironmentLight = Light<L> && requires(const L light, const Vec3 direction) {
    { light.radiance(direction) } -> std::same_as<Rgb>;
    { light.pdf(direction, direction) } -> std::same_as<SolidAnglePdf>;
};

/// A light at which paths can start, for methods that trace light.
///
/// - `emit(place, direction)`: a ray, from two points in [0,1)^2;
/// - `spread(at, wi, place)`: over what area, across their way, paths that start at `place` (on the light) are spread
///   when they get to the point `at`, which sees that place in the direction `wi`: the density with which `sample` at
///   `at` chooses the place, over the density with which `emit` does so and passes there. The square of the distance,
///   times 4 pi, for a point light;
/// - of a light that rays can meet, the density of `emit`: `emission_pdf(point, direction)` of a ray that leaves the
///   `point` of an area light along `direction`, or `emission_pdf(wi)` of one that comes from the direction `wi` of an
///   environment.
template <class L>
concept EmittingLight = Light<L> && requires(const L light, const SurfacePoint point, const Vec3 v, const Vec2 u) {
    { light.emit(u, u) } -> std::same_as<LightEmission>;
    { light.spread(point, v, v) } -> std::same_as<float>;
    requires !AreaLight<L> || requires {
        { light.emission_pdf(point, v) } -> std::same_as<EmissionPdf>;
    };
    requires !EnvironmentLight<L> || requires {
        { light.emission_pdf(v) } -> std::same_as<EmissionPdf>;
    };
};

}  // namespace lightswitch
