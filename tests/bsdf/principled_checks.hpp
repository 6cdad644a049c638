#pragma once

// What the tests of Disney's two models share.

#include <lightswitch/bsdf/parameter.hpp>

#include "bsdf_checks.hpp"
#include "mitsuba_values.hpp"

#include <type_traits>

namespace lightswitch::test {

/// A model with parameters at random. Of those from 0 to 1 many are 0 or 1; the index of refraction is 0.4 to 2.5, and
/// the roughness at least `least_roughness`, for lobes that quadrature can resolve.
template <Bsdf B>
B random_disney(Random& random, float least_roughness) {
    B model;
    for_each_parameter<B>([&](std::size_t, const auto& parameter) {
        auto& value = model.*parameter.member;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) {
            const float kind = random.next(), x = random.next();
            value = parameter.range.most * (kind < 0.4f ? 0 : kind < 0.55f ? 1 : x);
        } else {
            value = random.next_3d();
        }
    });
    model.roughness = least_roughness + (1 - least_roughness) * random.next();
    model.eta = random.next() < 0.3f ? 0.4f + 0.5f * random.next() : 1.05f + 1.45f * random.next();
    return model;
}

/// In words, for messages.
template <Bsdf B>
std::string words(const B& model) {
    std::string text;
    for_each_parameter<B>([&](std::size_t, const auto& parameter) {
        const auto& value = model.*parameter.member;
        text += std::string(parameter.name) + "=";
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) text += std::to_string(value) + " ";
        else text += std::to_string(value.x) + "," + std::to_string(value.y) + "," + std::to_string(value.z) + " ";
    });
    return text;
}

/// A model with the parameters of a table, but for the index of refraction.
template <Bsdf B>
B disney_of(const MitsubaModel& model) {
    B result;
    for_each_parameter<B>([&](std::size_t, const auto& parameter) {
        const std::string name(parameter.name);
        if (name == "eta" || !model.has(name)) return;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(result.*parameter.member)>, float>)
            parameter.set(result, model.number(name));
        else parameter.set(result, model.color(name));
    });
    return result;
}

/// The rows of `model` are the values of `bsdf`, to that relative tolerance. Densities are its own affair.
template <Bsdf B>
void check_values_against_mitsuba(const B& bsdf, const MitsubaModel& model, double tolerance) {
    INFO(words(bsdf));
    CHECK(bsdf.problem() == "");
    for (const auto& row : model.evaluated) {
        CAPTURE(row.wo.z);
        CAPTURE(row.wi.z);
        const BsdfValue v = bsdf.evaluate(row.wo, row.wi, model.transport());
        for (int c = 0; c < 3; ++c)
            CHECK(double(v.value[c]) * std::abs(double(row.wi.z)) == relative(row.value[c], tolerance));
    }
}

/// What importance sees from `a` to `b` is what radiance sees from `b` to `a` (Veach 1997, equation 3.17), and for two
/// directions on one side the two are the same. Returns the share of pairs that are not black.
template <Bsdf B>
double check_both_ways(const B& bsdf, std::uint32_t seed) {
    constexpr int pairs = 5000;
    Random random(seed);
    double worst = 0, worst_of_reflection = 0;
    int bright = 0;
    for (int n = 0; n < pairs; ++n) {
        const Vec3 a = uniform_sphere(random.next_2d()), b = uniform_sphere(random.next_2d());
        const Rgb there = bsdf.evaluate(a, b, Transport::importance).value;
        const Rgb back = bsdf.evaluate(b, a, Transport::radiance).value;
        const Rgb same = bsdf.evaluate(b, a, Transport::importance).value;
        bright += max_component(there) > 0 ? 1 : 0;
        for (int c = 0; c < 3; ++c) {
            const double sum = 1e-6 + double(there[c]);
            worst = std::max(worst, std::abs(double(there[c]) - double(back[c])) / sum);
            if (a.z * b.z > 0)
                worst_of_reflection = std::max(worst_of_reflection, std::abs(double(there[c]) - double(same[c])) / sum);
        }
    }
    INFO(words(bsdf));
    CHECK(worst < 1e-3);  // half vectors of refraction lose digits as the index approaches 1
    CHECK(worst_of_reflection < 1e-5);
    return double(bright) / pairs;
}

/// The albedo by sampling is that by quadrature of `evaluate`; returns its largest component.
template <Bsdf B>
double check_albedo_of_samples(const B& bsdf, const Vec3& wo, std::uint32_t seed) {
    constexpr int samples = 50000;
    Random random(seed);
    DVec3 sum(0), squares(0);
    for (int n = 0; n < samples; ++n)
        if (const auto s = bsdf.sample(wo, random.next_3d(), Transport::radiance)) {
            const DVec3 w(s->weight);
            sum += w;
            squares += w * w;
        }
    const DVec3 mean = sum / double(samples);
    const SphereCells cells{.rings = 10, .sectors = 10};
    INFO(words(bsdf));
    CAPTURE(wo.z);
    for (int c = 0; c < 3; ++c) {
        const double error = std::sqrt(std::max(0.0, squares[c] / samples - mean[c] * mean[c]) / samples);
        const auto parts = cells.integrals([&](const Vec3& wi) {
            return double(bsdf.evaluate(wo, wi, Transport::radiance).value[c]) * std::abs(double(wi.z));
        });
        const double quadrature = std::accumulate(parts.begin(), parts.end(), 0.0);
        CHECK(std::abs(mean[c] - quadrature) <= 6 * error + 2e-3);
    }
    return std::max(mean.x, std::max(mean.y, mean.z));
}

}  // namespace lightswitch::test
