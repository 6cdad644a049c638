#pragma once

// Fresnel's equations: how much unpolarised light a smooth boundary reflects. Exact, no approximation by powers of
// cosines.

#include <lightswitch/core/math.hpp>

#include <string>

namespace lightswitch {

/// What happens at a boundary between two transparent media.
struct FresnelDielectric {
    float reflectance;  ///< fraction of the power that is reflected, 0 to 1
    float cos_t;        ///< cosine of the refracted direction, of sign opposite to the incident one; 0 if there is none
    float eta;          ///< index of refraction on the far side over that on the incident side
};

/// Reflectance and refraction for the signed cosine `cos_i` of the incident direction and `eta`, above 0, the index of
/// refraction behind the surface (cos < 0) over that in front of it (Born and Wolf, Principles of Optics, section
/// 1.5.2).
///
/// Written with q = eta * |cos_t| = sqrt(eta^2 - 1 + cos_i^2), in which nothing cancels when eta is near 1 or the
/// direction is grazing. q^2 <= 0 is total internal reflection.
inline FresnelDielectric fresnel_dielectric(float cos_i, float eta) {
    const float relative = cos_i >= 0 ? eta : 1 / eta;
    const float c = std::abs(cos_i);
    const float contrast = (relative - 1) * (relative + 1);
    const float q_squared = contrast + c * c;
    if (!(q_squared > 0)) return {contrast == 0 ? 0.0f : 1.0f, 0, relative};
    const float q = std::sqrt(q_squared);
    const float perpendicular = contrast / square(c + q);
    const float dense_c = relative * relative * c;
    const float parallel = (dense_c - q) / (dense_c + q);
    return {0.5f * (square(perpendicular) + square(parallel)), std::copysign(q / relative, -cos_i), relative};
}

/// 1 - reflectance, of which grazing directions leave no digits, for the cosine `cos_i`, above 0, and `eta` of
/// `fresnel_dielectric`.
inline float fresnel_dielectric_transmittance(float cos_i, float eta) {
    const float q_squared = (eta - 1) * (eta + 1) + cos_i * cos_i;
    if (!(q_squared > 0)) return eta == 1 ? 1.0f : 0.0f;
    const float q = std::sqrt(q_squared);
    return 2 * cos_i * q * (1 / square(cos_i + q) + square(eta / (eta * eta * cos_i + q)));
}

/// Reflectance of a conductor whose index of refraction is eta - i k, in air or vacuum, for `cos_i` from 0 to 1
/// (Born and Wolf, section 14.2). eta and k are not below 0 and not both 0. The result is within 0 to 1.
///
/// With a + i b the square root of (eta - i k)^2 - sin^2, both reflectances are ratios of sums of squares.
inline float fresnel_conductor(float cos_i, float eta, float k) {
    if (!(cos_i > 0)) return 1;
    const float c_squared = cos_i * cos_i, s_squared = (1 - cos_i) * (1 + cos_i);
    const float real = (eta - 1) * (eta + 1) + c_squared - k * k;
    const float half_imaginary = eta * k;
    const float larger = std::sqrt(0.5f * (std::sqrt(real * real + 4 * square(half_imaginary)) + std::abs(real)));
    const float smaller = larger > 0 ? half_imaginary / larger : 0;
    const float a = real >= 0 ? larger : smaller, b = real >= 0 ? smaller : larger;

    const float perpendicular = (square(a - cos_i) + b * b) / (square(a + cos_i) + b * b);
    const float ac = a * cos_i, bc_squared = b * b * c_squared;
    // At normal incidence, a tiny eta without k leaves a, b and the sine 0.
    const float divisor = square(ac + s_squared) + bc_squared;
    const float ratio = divisor > 0 ? (square(ac - s_squared) + bc_squared) / divisor : 1;
    return 0.5f * perpendicular * (1 + ratio);
}

/// `fresnel_conductor` for each colour.
inline Rgb fresnel_conductor(float cos_i, const Rgb& eta, const Rgb& k) {
    return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
            fresnel_conductor(cos_i, eta.z, k.z)};
}

/// What part of evenly diffuse light gets through a boundary from its front: the integral of 2 cos (1 - reflectance)
/// over the cosine. Of light from behind, `diffuse_transmittance(eta) / eta^2` gets through, by reciprocity. `eta` as
/// of `fresnel_dielectric`; the result is within 0 to 1 and has the digits of a float.
///
/// The closed form is that of Walsh, 1926 (in Duntley, "The Optical Properties of Diffusing Materials", JOSA 1942).
/// Near index 1 its terms grow like 1 / (eta - 1) and cancel, for which doubles have digits enough.
inline float diffuse_transmittance(float eta) {
    if (eta == 1) return 1;
    const double n = eta > 1 ? double(eta) : 1 / double(eta);
    const double n2 = n * n, plus = n2 + 1, minus = (n - 1) * (n + 1), product = plus * minus, ln = std::log1p(n - 1);
    const double reflectance = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                               n2 * minus * minus / (plus * plus * plus) * (std::log(n - 1) - std::log(n + 1)) -
                               2 * n2 * n * (n2 + 2 * n - 1) / (plus * product) +
                               8 * n2 * n2 * (n2 * n2 + 1) / (plus * product * product) * ln;
    return static_cast<float>(eta > 1 ? 1 - reflectance : (1 - reflectance) / n2);
}

/// Explains an index of refraction that no conductor can have, or returns an empty string.
inline std::string conductor_problem(const Rgb& eta, const Rgb& k) {
    for (int c = 0; c < 3; ++c)
        if (eta[c] == 0 && k[c] == 0) return "eta and k are both 0 in one component; an ideal mirror has eta 0 and k 1";
    return {};
}

}  // namespace lightswitch
