#pragma once

// Probability densities as types: one per measure, so that two measures cannot be mixed by mistake.

#include <lightswitch/core/math.hpp>

#include <concepts>

namespace lightswitch {

/// Density with respect to solid angle, in 1/sr. Arithmetic between densities of the same measure is allowed;
/// a change of measure must name its geometry term.
struct SolidAnglePdf {
    float value = 0;

    friend SolidAnglePdf operator*(SolidAnglePdf p, float probability) { return {p.value * probability}; }
    friend auto operator<=>(const SolidAnglePdf&, const SolidAnglePdf&) = default;
};

/// Density with respect to surface area, in 1 / (render unit)^2.
struct AreaPdf {
    float value = 0;

    friend AreaPdf operator*(AreaPdf p, float probability) { return {p.value * probability}; }
    friend auto operator<=>(const AreaPdf&, const AreaPdf&) = default;
};

/// Density of light that leaves a surface, with respect to its area and to solid angle, in 1 / (render unit)^2 / sr. A
/// Dirac distribution over place or direction is left out of it.
struct EmissionPdf {
    float value = 0;

    friend EmissionPdf operator*(EmissionPdf p, float probability) { return {p.value * probability}; }
    friend auto operator<=>(const EmissionPdf&, const EmissionPdf&) = default;
};

/// Changes area density to solid angle density as seen from a point at `distance_squared`, where `abs_cosine` is the
/// cosine at the surface that is seen (Veach 1997, equation 8.10). Infinite at grazing angles.
inline SolidAnglePdf to_solid_angle(AreaPdf p, float distance_squared, float abs_cosine) {
    return {p.value * distance_squared / abs_cosine};
}

/// The inverse of `to_solid_angle`.
inline AreaPdf to_area(SolidAnglePdf p, float distance_squared, float abs_cosine) {
    return {p.value * abs_cosine / distance_squared};
}

/// Any of them.
template <class P>
concept Density = std::same_as<P, SolidAnglePdf> || std::same_as<P, AreaPdf> || std::same_as<P, EmissionPdf>;

/// Whether what has that density can be chosen at all; false for NaN.
template <Density P>
[[gnu::always_inline]] inline bool is_positive(P p) {
    return p.value > 0;
}

/// Of what is chosen in two ways, each density with its probability in it already.
template <Density P>
[[gnu::always_inline]] inline P operator+(P a, P b) {
    return {a.value + b.value};
}

/// A ratio of densities of one measure, which has no unit.
template <Density P>
[[gnu::always_inline]] inline double operator/(const P& a, const P& b) {
    return double(a.value) / double(b.value);
}

/// What has been chosen with that density, such as radiance or a cosine, as it counts in an estimate.
template <class T, Density P>
requires(std::floating_point<T> || std::same_as<T, Rgb>) [[gnu::always_inline]] inline T operator/(const T& term, P p) {
    return term / p.value;
}

inline EmissionPdf operator*(AreaPdf place, SolidAnglePdf direction) { return {place.value * direction.value}; }

/// What a ratio of two densities counts in a weight of multiple importance sampling (power heuristic with exponent 2).
inline double heuristic(double ratio) { return ratio * ratio; }

/// What a density counts as the numerator of such a ratio.
template <Density P>
[[gnu::always_inline]] inline double heuristic(P p) {
    return heuristic(double(p.value));
}

/// What the density counts once it is changed by `to_area`, all in double.
[[gnu::always_inline]] inline double heuristic_per_area(SolidAnglePdf p, double distance_squared, double abs_cosine) {
    return heuristic(double(p.value) * abs_cosine / distance_squared);
}

/// Multiple importance sampling weight of the strategy that has density `ours`, against one other strategy
/// (power heuristic with exponent 2; Veach 1997, section 9.2.3). Both 0 gives 0; an infinite `ours` gives 1.
inline float power_heuristic(SolidAnglePdf ours, SolidAnglePdf other) {
    if (!(ours.value > 0)) return 0;
    if (ours.value == infinity) return 1;
    const float ratio = other.value / ours.value;
    return 1 / (1 + ratio * ratio);
}

}  // namespace lightswitch
