#pragma once

// What every surface model must satisfy, written once.
//
// False alarms, for seeds drawn at random (they are fixed): a chi-square test gives one with probability `level`, which
// each file sets so that all of its tests together stay at 1e-6; a comparison of means allows 6 standard errors, 2e-9.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/warp.hpp>

#include "../support/chi_square.hpp"

#include <doctest/doctest.h>

#include <optional>

namespace lightswitch::test {

/// Unit vector with that cosine to the normal, exact in z.
inline Vec3 direction(double cosine, double phi = 0.7) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return Vec3(DVec3(sine * std::cos(phi), sine * std::sin(phi), cosine));
}

inline Vec3 mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Cells for a lobe of the roughness `alpha`: finer around the mirror direction when it is narrow, else around the
/// normal, with the horizon, where densities jump, between two rings.
inline SphereCells cells_for(const Vec3& wo, double alpha) {
    if (alpha > 0.25) return {};
    return {.axis = normalize(mirrored(wo)), .stretch = std::max(1.0, std::log(alpha * alpha) / std::log(0.4))};
}

/// `sample` follows the density of `evaluate`, whose integral is the probability that `sample` returns a direction that
/// is not from a Dirac distribution. With a `side`, 1 or -1, only directions there count.
template <Bsdf B>
void check_density_in(const SphereCells& cells, const B& bsdf, const Vec3& wo, double level, std::uint32_t seed,
                      float side = 0) {
    const auto sample = [&](const Vec3& u) -> std::optional<Vec3> {
        const auto s = bsdf.sample(wo, u, Transport::radiance);
        return s && !s->specular && s->wi.z * side >= 0 ? std::optional(s->wi) : std::nullopt;
    };
    const auto pdf = [&](const Vec3& wi) {
        return wi.z * side < 0 ? 0 : double(bsdf.evaluate(wo, wi, Transport::radiance).pdf.value);
    };
    const auto result = chi_square_sphere(sample, pdf, cells, 200000, seed);
    CAPTURE(wo.z);
    CAPTURE(side);
    CAPTURE(result.chi_square);
    CHECK(result.chi_square.p_value > level);
    CHECK(result.chi_square.degrees_of_freedom > 50);
    CHECK(result.integral <= 1.001);  // the quadrature is good to 5e-4
}

/// The same for a lobe of the roughness `alpha` around the mirror direction.
template <Bsdf B>
void check_density(const B& bsdf, const Vec3& wo, double alpha, double level, std::uint32_t seed) {
    CAPTURE(alpha);
    check_density_in(cells_for(wo, alpha), bsdf, wo, level, seed);
}

/// The albedo by sampling is at most 1 and, without Dirac distributions, is that by quadrature of `evaluate`; returns
/// the whole albedo.
template <Bsdf B>
double check_albedo(const B& bsdf, const Vec3& wo, double alpha, std::uint32_t seed,
                    Transport transport = Transport::radiance) {
    constexpr int samples = 100000;
    Random random(seed);
    double sum[2] = {}, squares[2] = {};  // of all samples, and of those that are not from a Dirac distribution
    for (int i = 0; i < samples; ++i) {
        const auto s = bsdf.sample(wo, random.next_3d(), transport);
        const double w = s ? double(s->weight.y) : 0;
        for (int smooth = 0; smooth < (s && s->specular ? 1 : 2); ++smooth) {
            sum[smooth] += w;
            squares[smooth] += w * w;
        }
    }
    const double mean = sum[0] / samples, smooth_mean = sum[1] / samples;
    const auto error = [&](int i) {
        return std::sqrt(std::max(0.0, squares[i] / samples - sum[i] * sum[i] / samples / samples) / samples);
    };
    SphereCells cells = cells_for(wo, alpha);
    cells.rings = cells.sectors = 10;
    const auto parts = cells.integrals(
        [&](const Vec3& wi) { return double(bsdf.evaluate(wo, wi, transport).value.y) * std::abs(double(wi.z)); });
    const double quadrature = std::accumulate(parts.begin(), parts.end(), 0.0);
    CAPTURE(wo.z);
    CAPTURE(alpha);
    CHECK(mean <= 1 + 6 * error(0) + 1e-6);                            // of rounding, where all weights are 1
    CHECK(std::abs(smooth_mean - quadrature) <= 6 * error(1) + 1e-3);  // the quadrature is good to 5e-4
    return mean;
}

/// The weight and density of a sample are those of `evaluate` for its direction, to the given relative errors.
template <Bsdf B>
void check_sample_agrees_with_evaluate(const B& bsdf, const Vec3& wo, double weight_tolerance, double pdf_tolerance) {
    Random random(7);
    double weight_error = 0, pdf_error = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto s = bsdf.sample(wo, random.next_3d(), Transport::radiance);
        if (!s || s->specular) continue;
        const BsdfValue v = bsdf.evaluate(wo, s->wi, Transport::radiance);
        for (int c = 0; c < 3; ++c) {
            const double direct = double(v.value[c]) * std::abs(double(s->wi.z)) / double(v.pdf.value);
            weight_error = std::max(weight_error, std::abs(double(s->weight[c]) - direct) / direct);
        }
        pdf_error = std::max(pdf_error, std::abs(double(s->pdf.value) / double(v.pdf.value) - 1));
    }
    CAPTURE(wo.z);
    CHECK(weight_error < weight_tolerance);
    CHECK(pdf_error < pdf_tolerance);
}

/// f(wo, wi) = f(wi, wo), to rounding.
template <Bsdf B>
void check_reciprocity(const B& bsdf) {
    Random random(8);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 a = uniform_sphere(random.next_2d()), b = uniform_sphere(random.next_2d());
        const Rgb ab = bsdf.evaluate(a, b, Transport::radiance).value,
                  ba = bsdf.evaluate(b, a, Transport::radiance).value;
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(double(ab[c]) - double(ba[c])) / (1e-6 + double(ab[c])));
    }
    CHECK(worst < 1e-5);
}

/// What radiance sees one way, importance sees the other way (Veach 1997, section 5.2): f(a, b) = f*(b, a), to 1e-5 of
/// the value and of `scale`, by which rounding is measured where facets are seen edge-on.
template <Bsdf B>
void check_adjoint(const B& bsdf, double scale = 0.1) {
    Random random(10);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 a = uniform_sphere(random.next_2d()), b = uniform_sphere(random.next_2d());
        const Rgb ab = bsdf.evaluate(a, b, Transport::radiance).value,
                  ba = bsdf.evaluate(b, a, Transport::importance).value;
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(double(ab[c]) - double(ba[c])) / (scale + double(ab[c])));
    }
    CHECK(worst < 1e-5);
}

/// No parameters of `sample` and `evaluate` give what is not finite, negative, not of unit length, or a weight above
/// `largest_weight`: over 400000 directions and numbers, among them the extreme ones, of which `least` give a sample.
template <Bsdf B>
void check_extremes(const B& bsdf, float largest_weight = 1, int least = 80000) {
    constexpr float extreme[] = {0, 0x1p-24f, 0.5f, 0.5f - 0x1p-24f, 1 - 0x1p-24f};
    constexpr double cosines[] = {1, 0.999999, 0.5, 1e-2, 1e-4, 1e-6, 1e-7, 0};
    Random random(9);
    const auto pick = [&](const auto& list) {
        return list[static_cast<std::size_t>(random.next() * static_cast<float>(std::size(list)))];
    };
    int bad_samples = 0, bad_values = 0, sampled = 0;
    for (int i = 0; i < 400000; ++i) {
        const auto any_direction = [&] {
            Vec3 w = random.next() < 0.5f ? uniform_sphere(random.next_2d())
                                          : direction(pick(cosines), 6.28 * double(random.next()));
            if (random.next() < 0.3f) w.z = -w.z;
            return w;
        };
        const Vec3 wo = any_direction();
        Vec3 u = random.next_3d();
        for (int c = 0; c < 3; ++c)
            if (random.next() < 0.3f) u[c] = pick(extreme);
        const Transport transport = i % 2 == 0 ? Transport::radiance : Transport::importance;
        if (const auto s = bsdf.sample(wo, u, transport)) {
            ++sampled;
            const float smallest = std::min(s->weight.x, std::min(s->weight.y, s->weight.z));
            const bool good = is_finite(s->wi) && std::abs(length_squared(s->wi) - 1) < 2e-6f && s->wi.z != 0 &&
                              is_finite(s->weight) && smallest >= 0 &&
                              max_component(s->weight) <= largest_weight * (1 + 1e-6f) && is_finite(s->pdf.value) &&
                              (s->specular ? s->pdf.value == 0 : s->pdf.value > 0) && s->eta > 0;
            bad_samples += good ? 0 : 1;
        }
        const BsdfValue v = bsdf.evaluate(wo, i % 3 == 0 ? mirrored(wo) : any_direction(), transport);
        const float smallest = std::min(v.value.x, std::min(v.value.y, v.value.z));
        bad_values += is_finite(v.value) && smallest >= 0 && is_finite(v.pdf.value) && v.pdf.value >= 0 ? 0 : 1;
    }
    CHECK(bad_samples == 0);
    CHECK(bad_values == 0);
    CHECK(sampled > least);
}

}  // namespace lightswitch::test
