#pragma once

// The tables of Mitsuba's values in tests/data/bsdf, which mitsuba_values.py writes, and the comparison with them.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/bsdf/microfacets.hpp>

#include "../support/relative.hpp"
#include "support/paths.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lightswitch::test {

/// One model of a table: parameters by Mitsuba's names, and rows.
struct MitsubaModel {
    struct Evaluated {
        Vec3 wo, wi;
        Rgb value;  ///< with the cosine of wi
        float pdf;
    };
    struct Sampled {
        Vec3 wo;
        float u;  ///< chooses the lobe
        Vec3 wi;
        Rgb weight;
        float eta;
    };

    std::map<std::string, std::string> parameters;
    std::vector<Evaluated> evaluated;
    std::vector<Sampled> sampled;

    bool has(const std::string& name) const { return parameters.count(name) > 0; }
    const std::string& text(const std::string& name) const { return parameters.at(name); }
    float number(const std::string& name) const { return std::stof(text(name)); }
    float number(const std::string& name, float otherwise) const { return has(name) ? number(name) : otherwise; }
    Rgb color(const std::string& name) const {
        std::istringstream in(text(name));
        Rgb value;
        char comma;
        if (!(in >> value.x >> comma >> value.y >> comma >> value.z)) throw std::runtime_error(name + ": no colour");
        return value;
    }
    Facets facets() const { return text("distribution") == "ggx" ? Facets::ggx : Facets::beckmann; }
    /// Index of refraction behind the surface over that in front of it.
    float eta() const { return float(std::stod(text("int_ior")) / std::stod(text("ext_ior"))); }
    Transport transport() const {
        return has("transport") && text("transport") == "importance" ? Transport::importance : Transport::radiance;
    }
};

/// The table tests/data/bsdf/NAME.txt.
inline std::vector<MitsubaModel> mitsuba_models(const std::string& name) {
    const std::string path = test::folder() + "/data/bsdf/" + name + ".txt";
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::vector<MitsubaModel> models;
    for (std::string line, word; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream in(line);
        in >> word;
        const auto read = [&in](auto& v) { in >> v.x >> v.y >> v.z; };
        if (word == "model") {
            for (models.emplace_back(); in >> word;)
                models.back().parameters[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
            continue;
        }
        if (word == "e") {
            auto& row = models.at(models.size() - 1).evaluated.emplace_back();
            read(row.wo), read(row.wi), read(row.value);
            in >> row.pdf;
        } else {
            auto& row = models.at(models.size() - 1).sampled.emplace_back();
            read(row.wo);
            in >> row.u;
            read(row.wi), read(row.weight);
            in >> row.eta;
        }
        if (!in) throw std::runtime_error(path + ": " + line);
    }
    return models;
}

/// Smith's masking as Mitsuba 3 has it, over the exact one: for Beckmann's facets a rational fit (Walter et al. 2007,
/// section 5.2), up to 0.35 % off.
inline double mitsuba_masking_ratio(Facets facets, float alpha_u, float alpha_v, const Vec3& v) {
    if (facets == Facets::ggx) return 1;
    const double reach = std::hypot(double(alpha_u) * double(v.x), double(alpha_v) * double(v.y));
    const double a = std::abs(double(v.z)) / reach;
    const double exact = 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(std::acos(-1.0))));
    return (a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a) : 1) / exact;
}

/// The rows of `model` are what `bsdf` says, to that relative tolerance, after `value_ratio(wo, wi)` and
/// `pdf_ratio(wo)` have turned its values into Mitsuba's where the two are meant to differ.
template <Bsdf B>
void check_against_mitsuba(const B& bsdf, const MitsubaModel& model, double tolerance, const auto& value_ratio,
                           const auto& pdf_ratio) {
    std::string parameters;
    for (const auto& [name, value] : model.parameters) parameters += name + "=" + value + " ";
    INFO(parameters);
    for (const auto& row : model.evaluated) {
        CAPTURE(row.wo.z);
        CAPTURE(row.wi.z);
        CAPTURE(row.pdf);
        const BsdfValue v = bsdf.evaluate(row.wo, row.wi, model.transport());
        for (int c = 0; c < 3; ++c)
            CHECK(double(v.value[c]) * std::abs(double(row.wi.z)) * value_ratio(row.wo, row.wi) ==
                  relative(row.value[c], tolerance));
        CHECK(double(v.pdf.value) * pdf_ratio(row.wo) == relative(row.pdf, tolerance));
    }
}

/// The same where nothing is meant to differ.
template <Bsdf B>
void check_against_mitsuba(const B& bsdf, const MitsubaModel& model, double tolerance) {
    check_against_mitsuba(
        bsdf, model, tolerance, [](const Vec3&, const Vec3&) { return 1.0; }, [](const Vec3&) { return 1.0; });
}

/// The same for microfacet models, whose masking differs for Beckmann's facets.
template <Bsdf B>
void check_facets_against_mitsuba(const B& bsdf, const MitsubaModel& model, double tolerance) {
    const auto ratio = [&](const Vec3& v) {
        return mitsuba_masking_ratio(model.facets(), bsdf.alpha_u, bsdf.alpha_v, v);
    };
    check_against_mitsuba(
        bsdf, model, tolerance, [&](const Vec3& wo, const Vec3& wi) { return ratio(wo) * ratio(wi); }, ratio);
}

}  // namespace lightswitch::test
