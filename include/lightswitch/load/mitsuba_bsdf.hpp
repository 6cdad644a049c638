#pragma once

// Surface models in Mitsuba's scene files.

#include <lightswitch/bsdf/coat.hpp>
#include <lightswitch/load/metals.hpp>
#include <lightswitch/load/mitsuba_texture.hpp>

namespace lightswitch::detail {

/// Index of refraction by Mitsuba's name (after Hecht, "Optics", 4th edition); nothing when unknown.
inline std::optional<double> index_of_refraction(const std::string& name) {
    static const std::map<std::string, double> media{
        {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
        {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
        {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
        {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
        {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
        {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
        {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
        {"pet", 1.5750},      {"diamond", 2.419}};
    const auto found = media.find(lower_case(name));
    if (found == media.end()) return {};
    return found->second;
}

inline double read_index_of_refraction(XmlElement& element, const std::string& name, const std::string& otherwise) {
    if (element.has_string(name) || !element.has(name)) {
        const std::string medium = element.text(name).value_or(otherwise);
        if (const auto index = index_of_refraction(medium)) return *index;
        element.problem(name, "unknown medium " + quote(medium) + ": give the index as a <float>",
                        "it is " + quote(otherwise));
        return *index_of_refraction(otherwise);
    }
    const double index = element.number(name, *index_of_refraction(otherwise));
    if (index > 0) return index;
    element.problem(name, "an index of refraction must be above 0", "it is " + quote(otherwise));
    return *index_of_refraction(otherwise);
}

/// `eta` of a model with two media, by Mitsuba's parameters and defaults.
inline float read_relative_index(XmlElement& element, const std::string& inside, const std::string& outside = "air") {
    const double index = read_index_of_refraction(element, "int_ior", inside);
    return static_cast<float>(index / read_index_of_refraction(element, "ext_ior", outside));
}

/// The value, or the nearest one in the range. Roughness goes no lower than in Mitsuba, where 0 is as good as that.
inline float clamped(XmlElement& element, const std::string& name, const ParameterRange& range, float value) {
    value = range.within(value);
    if (range.contains(value)) return value;
    const float result = range.within(std::clamp(value, range.least, range.most));
    element.problem(name, number_text(value) + outside(range), "it is " + number_text(result));
    return result;
}

/// The parameters of a model that are plain numbers and colours; what the file leaves out, and what a texture will
/// give, stays as it is.
template <class B>
void read_parameters(XmlElement& element, B& model) {
    for_each_parameter<B>([&](std::size_t, const auto& parameter) {
        if (!parameter.varies) return;
        const std::string name(parameter.name);
        if (!element.has(name)) return;
        const auto in_range = [&](float value) { return clamped(element, name, parameter.range, value); };
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(model.*parameter.member)>, float>) {
            if (element.is_color(name)) {  // of which Mitsuba takes the mean
                const Rgb color = element.color(name, Rgb(model.*parameter.member));
                parameter.set(model, in_range((color.x + color.y + color.z) / 3));
            } else if (const auto value = element.number(name)) {
                parameter.set(model, in_range(static_cast<float>(*value)));
            }
        } else {
            const Rgb value = element.color(name, model.*parameter.member,
                                            parameter.range.most > 1 ? SpectrumUse::index : SpectrumUse::reflectance);
            parameter.set(model, {in_range(value.x), in_range(value.y), in_range(value.z)});
        }
    });
}

/// A metal's name, instead of `eta` and `k`.
template <class Metal>
void read_metal_name(XmlElement& element, Metal& metal) {
    const auto material = element.text("material");
    if (!material || *material == "none") return;
    if (element.has("eta") || element.has("k"))
        return element.problem("material", "give either material, or eta and k", "it is ignored");
    const auto index = metal_by_name(*material);
    if (!index)
        return element.problem("material", "unknown metal " + quote(*material) + "; known are " + metal_names(),
                               "it reflects everything");
    metal.eta = index->eta;
    metal.k = index->k;
}

/// `distribution`. The cosine lobes of Mitsuba 0.6, "phong" and "as", have the exponent 2 / alpha^2 - 2: so Beckmann's
/// facets of the same alpha have the same density along the normal and the same masking, and otherwise nearly the same
/// shape (Walter et al. 2007, section 5.2): 2.4 % of the facets lie elsewhere at alpha 0.3, 0.3 % at 0.1.
inline Facets read_facets(XmlElement& element) {
    static const std::map<std::string, Facets> distributions{{"beckmann", Facets::beckmann}, {"ggx", Facets::ggx}};
    element.boolean("sample_visible", true);  // changes only the noise
    const std::string given = element.is_old() ? lower_case(element.text("distribution").value_or("")) : "";
    if (given == "phong" || given == "as") {
        element.log().notice(element.origin("distribution"), "facets of Phong's model are taken for Beckmann's");
        return Facets::beckmann;
    }
    return element.one_of("distribution", "beckmann", distributions);
}

/// What `coating` and `roughcoating` of Mitsuba 0.6 say of the coat.
inline Coat read_coat(XmlElement& element) {
    Coat coat{.eta = read_relative_index(element, "bk7")};
    if (element.type() == "roughcoating") {
        coat.distribution = read_facets(element);
        coat.alpha = clamped(element, "alpha", as_roughness, static_cast<float>(element.number("alpha", 0.1)));
    }
    read_parameters(element, coat);
    return coat;
}

/// Reads a `<bsdf>` that is a surface model, with Mitsuba's defaults for what is left out.
class BsdfReader {
public:
    BsdfReader(XmlElement& element, TextureReader& textures) : element_(element), textures_(textures) {}

    AnyMaterial read() {
        const std::string type = element_.type();
        // Exporters gave Mitsuba 0.6 these also where there is no roughness, and it passes over what it does not know.
        if (element_.is_old() && (type == "conductor" || type == "dielectric" || type == "thindielectric"))
            element_.accept({"distribution", "alpha", "alpha_u", "alpha_v"});
        if (type == "diffuse") return finished(Lambert{});
        if (type == "conductor") return metal(Conductor{});
        if (type == "roughconductor") return metal(rough(RoughConductor{}));
        if (type == "dielectric") return glass(Dielectric{}, "bk7");
        if (type == "thindielectric") return glass(ThinDielectric{}, "bk7");
        if (type == "roughdielectric") return glass(rough(RoughDielectric{}), "bk7");
        if (type == "plastic") return plastic();
        if (type == "roughplastic") return rough_plastic();
        if (type == "principled") return principled();
        if (type == "principledthin") {
            ignore_rates({"spec_reflect_sampling_rate", "spec_trans_sampling_rate", "diffuse_trans_sampling_rate",
                          "diffuse_reflect_sampling_rate", "diffuse_reflectance_sampling_rate"});
            return finished(PrincipledThin{});
        }
        if (type == "roughdiffuse") {
            RoughDiffuse model;
            model.use_fast_approx = element_.boolean("use_fast_approx", false);
            return finished(model);
        }
        if (type == "phong") return within_one(ModifiedPhong{});
        if (type == "ward") return ward();
        element_.unknown_type(
            "diffuse, conductor, roughconductor, dielectric, roughdielectric, thindielectric, plastic, roughplastic, "
            "principled, principledthin, roughdiffuse, phong, ward, coating, roughcoating, twosided, mask, null, "
            "polarizer, retarder, circular, blendbsdf, bumpmap and normalmap");
    }

private:
    template <class B>
    AnyMaterial finished(B model) {
        read_parameters(element_, model);
        return with_textures(model);
    }
    template <class B>
    AnyMaterial with_textures(const B& model) {
        AnyMaterial result = textures_.with_textures(element_, model);
        element_.finish();
        if (const std::string problem = result.problem(); !problem.empty()) element_.error(problem);
        return result;
    }
    /// What Mitsuba 0.6 darkens so that no more light leaves than comes.
    template <class B>
    AnyMaterial within_one(B model) {
        read_parameters(element_, model);
        const auto diffuse = element_.texture("diffuse_reflectance"), lobe = element_.texture("specular_reflectance");
        const Rgb most_diffuse = diffuse ? textures_.read(*diffuse).most() : model.diffuse_reflectance;
        const Rgb sum = most_diffuse + (lobe ? textures_.read(*lobe).most() : model.specular_reflectance);
        const float largest = std::max({sum.x, sum.y, sum.z});
        if (sum_problem(Rgb(0), sum).empty()) return with_textures(model);
        if (!diffuse && !lobe) {
            model.diffuse_reflectance *= 0.99f / largest;
            model.specular_reflectance *= 0.99f / largest;
            element_.log().notice(element_.origin(), "reflects more than all light, and is darkened as in Mitsuba 0.6");
        } else if (!lobe) {
            element_.problem("", "reflects more than all light", "its lobe is darkened");
            model.specular_reflectance = glm::clamp(Rgb(1) - most_diffuse, Rgb(0), model.specular_reflectance);
        }
        return with_textures(model);
    }
    template <class B>
    AnyMaterial metal(B model) {
        read_metal_name(element_, model);
        read_parameters(element_, model);
        // Of Mitsuba 0.6: what is around the metal.
        if (element_.has("ext_eta")) {
            const auto around = static_cast<float>(read_index_of_refraction(element_, "ext_eta", "air"));
            const bool ideal = model.eta == Rgb(0);
            model.eta /= around;
            if (!ideal) model.k /= around;
        }
        for (int c = 0; c < 3; ++c)
            if (model.eta[c] == 0 && model.k[c] == 0) {
                element_.problem("", "eta and k are both 0 in one component", "it reflects everything there");
                model.k[c] = 1;
            }
        return with_textures(model);
    }
    template <class B>
    AnyMaterial glass(B model, const char* inside) {
        model.eta = read_relative_index(element_, inside);
        return finished(model);
    }
    template <class B>
    B rough(B model) {
        model.distribution = read_facets(element_);
        const bool u = given("alpha_u"), v = given("alpha_v");
        if (u != v || (given("alpha") && u))
            element_.problem("alpha_u", "give either alpha, or both alpha_u and alpha_v",
                             "the others are left as usual");
        return model;
    }
    bool given(const std::string& name) const { return element_.has(name) || element_.has_object(name); }

    AnyMaterial plastic() {
        Plastic model{.eta = read_relative_index(element_, "polypropylene")};
        model.nonlinear = element_.boolean("nonlinear", false);
        return finished(model);
    }

    AnyMaterial rough_plastic() {
        const Facets facets = read_facets(element_);
        const float alpha = clamped(element_, "alpha", as_roughness, static_cast<float>(element_.number("alpha", 0.1)));
        const float eta = read_relative_index(element_, "polypropylene");
        if (!as_relative_index.contains(eta)) element_.error("the index of refraction is impossible");
        RoughPlastic model{.distribution = facets, .alpha = alpha, .eta = eta};
        model.nonlinear = element_.boolean("nonlinear", false);
        return finished(model);
    }

    AnyMaterial principled() {
        ignore_rates({"main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate"});
        Principled model;
        const bool transmits = element_.has_object("spec_trans") || element_.number("spec_trans", 0) != 0;
        const auto eta = element_.number("eta");
        auto specular = element_.number("specular");
        if (eta && specular) element_.problem("specular", "give either eta or specular", "it is ignored");
        if (specular) specular = clamped(element_, "specular", as_fraction, static_cast<float>(*specular));
        model.eta = eta ? Principled::eta_from_eta(static_cast<float>(*eta), transmits)
                        : Principled::eta_from_specular(static_cast<float>(specular.value_or(0.5)), transmits);
        return finished(model);
    }

    AnyMaterial ward() {
        static const std::map<std::string, WardVariant> variants{
            {"ward", WardVariant::ward}, {"ward-duer", WardVariant::ward_duer}, {"balanced", WardVariant::balanced}};
        return within_one(Ward{.variant = element_.one_of("variant", "balanced", variants)});
    }

    /// Parameters that only say how Mitsuba draws its samples.
    void ignore_rates(std::initializer_list<const char*> names) {
        for (const char* name : names) element_.number(name);
    }

    XmlElement& element_;
    TextureReader& textures_;
};

}  // namespace lightswitch::detail
