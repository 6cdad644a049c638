#pragma once

// How much white light rough surfaces return: by the table tests/data/bsdf/albedo.txt, which albedo_values.py writes,
// and by sampling.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/microfacets.hpp>

#include "../support/chi_square.hpp"
#include "support/paths.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lightswitch::test {

/// A line of the table: fractions of the power, good to 1e-4.
struct Albedo {
    Facets facets;
    float alpha_u, alpha_v;
    float eta;  ///< 0 for a perfect mirror
    Vec3 wo;
    double reflected, transmitted;
};

inline std::vector<Albedo> albedo_values() {
    std::ifstream file(test::folder() + "/data/bsdf/albedo.txt");
    std::vector<Albedo> rows;
    for (std::string line, facets; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream in(line);
        Albedo& row = rows.emplace_back();
        in >> facets >> row.alpha_u >> row.alpha_v >> row.eta >> row.wo.x >> row.wo.y >> row.wo.z >> row.reflected >>
            row.transmitted;
        if (!in) throw std::runtime_error("albedo.txt: " + line);
        row.facets = facets == "ggx" ? Facets::ggx : Facets::beckmann;
        row.wo = normalize(row.wo);
    }
    if (rows.empty()) throw std::runtime_error("albedo.txt: no such file, or nothing in it");
    return rows;
}

/// What 20000 samples of a model do with white light (its second colour): means and their standard errors.
struct Returned {
    double reflected = 0, reflected_error = 0, transmitted = 0, transmitted_error = 0;
    DVec3 mean_reflected{0}, mean_transmitted{0};  ///< directions, each with its weight
};

template <Bsdf B>
Returned returned_light(const B& bsdf, const Vec3& wo, Transport transport, std::uint32_t seed) {
    constexpr int samples = 20000;
    Random random(seed);
    double sums[2] = {}, squares[2] = {};
    Returned result;
    for (int i = 0; i < samples; ++i) {
        const auto s = bsdf.sample(wo, random.next_3d(), transport);
        if (!s) continue;
        const int through = s->wi.z * wo.z < 0 ? 1 : 0;
        const double weight = double(s->weight.y);
        sums[through] += weight;
        squares[through] += weight * weight;
        (through ? result.mean_transmitted : result.mean_reflected) += weight / samples * DVec3(s->wi);
    }
    const auto error = [&](int i) {
        const double mean = sums[i] / samples;
        return std::sqrt(std::max(0.0, squares[i] / samples - mean * mean) / samples);
    };
    result.reflected = sums[0] / samples;
    result.transmitted = sums[1] / samples;
    result.reflected_error = error(0);
    result.transmitted_error = error(1);
    return result;
}

}  // namespace lightswitch::test
