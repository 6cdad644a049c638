#pragma once

// Surface models and layers for the materials of OBJ files.

#include <lightswitch/load/mtl_textures.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/library.hpp>

namespace lightswitch::detail {

/// Makes materials of a description. docs/scene-files.md says which statements become which model.
class ObjMaterials {
public:
    struct Made {
        std::size_t material;
        std::optional<Rgb> emission{};
        std::optional<Texture> emission_texture{};
    };

    /// Images are looked for in the folders of the OBJ file and of the material files.
    ObjMaterials(std::vector<std::filesystem::path> folders, LibraryDescription& scene, FileNotices& notices)
        : textures_(std::move(folders), notices), scene_(scene), notices_(notices) {}

    Made make(const MtlMaterial& material) {
        const std::size_t base = layered(material, add_surface(material));
        Made made{base};
        add_emission(material, made);
        add_mask(material, made);
        return made;
    }

    /// For what has no material.
    std::size_t grey() {
        if (!grey_) grey_ = scene_.add(TwoSided{Lambert{.reflectance = Rgb(0.5f)}});
        return *grey_;
    }

    const std::set<std::string>& images() const { return textures_.files(); }

private:
    using Use = MtlTextures::Use;

    static Rgb limited(const Rgb& color) { return glm::clamp(color, Rgb(0), Rgb(1)); }
    /// Black but for what nobody means: it cannot be scaled.
    static bool is_dark(const Rgb& color) { return luminance(color) < 1e-4f; }
    static float fraction(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

    /// Phong's exponent as roughness (Walter et al. 2007, section 5.2), in steps of 4 percent: the coat of each rough
    /// plastic takes time to make.
    static float alpha(const MtlMaterial& material) {
        const double exponent = std::max(material.number("ns").value_or(10), 0.0);
        const double steps = std::round(16 * std::log2(std::sqrt(2 / (exponent + 2))));
        return static_cast<float>(std::max(std::exp2(steps / 16), 1e-3));
    }

    /// Of refraction; 1 when the material does not tell.
    static double index(const MtlMaterial& material) {
        const double ni = material.number("ni").value_or(1);
        return ni > 0 ? ni : 1;
    }

    static double opacity(const MtlMaterial& material) {
        if (const auto d = material.number("d")) return std::clamp(*d, 0.0, 1.0);
        return 1 - std::clamp(material.number("tr").value_or(0), 0.0, 1.0);
    }

    /// A colour that a texture may multiply. Black under a texture is taken for a mistake of a program.
    struct Paint {
        Rgb color;
        std::optional<Texture> texture;
    };
    Paint diffuse(const MtlMaterial& material) { return paint(material, "kd", "map_kd", Rgb(0.5f), 1); }
    Paint paint(const MtlMaterial& material, std::string_view key, std::string_view map_key, const Rgb& otherwise,
                float gain) {
        const MtlMap* const map = material.map(map_key);
        const Rgb color = limited(material.color(key).value_or(map ? Rgb(1) : otherwise) * gain);
        if (!map) return {color, {}};
        const bool black = is_dark(color);
        auto texture = textures_.read(*map, Use::fraction, black ? Rgb(1) : color);
        if (black && texture) notices_.add(map->origin, "the image multiplies black: it is used as if that were white");
        return {color, std::move(texture)};
    }

    template <class B>
    struct Entry {
        std::string_view parameter;
        std::optional<Texture> texture;
    };
    template <class B>
    std::size_t add(const B& model, const Origin& origin, std::initializer_list<Entry<B>> textures = {}) {
        Textured<B> textured(model);
        for (const auto& [parameter, texture] : textures)
            if (texture) textured.set(parameter, *texture);
        const bool is_plain = textured.constant() != nullptr;
        const std::size_t number = scene_.add(is_plain ? AnyMaterial(model) : AnyMaterial(std::move(textured)), origin);
        scene_.materials[number].two_sided = !transmits_light(model);
        return number;
    }

    std::size_t add_surface(const MtlMaterial& material) {
        const Origin& origin = material.origin;
        const double illum = material.number("illum").value_or(2);
        if (is_glass(material, illum)) return add_glass(material);
        const bool is_physical = std::any_of(std::begin(physical), std::end(physical), [&](std::string_view key) {
            return material.number(key) || material.map(key);
        });
        if (is_physical) return add_principled(material);
        const Paint kd = diffuse(material);
        const Rgb ks = limited(material.color("ks").value_or(Rgb(0)));
        const bool shines = !is_dark(ks) || material.map("map_ks");
        if ((illum == 3 || illum == 5 || illum == 8) && !is_dark(ks)) {
            if (is_dark(kd.color) && !kd.texture) return add(Conductor{.reflectance = ks}, origin);
            if (illum == 5)
                return add(Plastic{.eta = 1.5f, .diffuse_reflectance = kd.color}, origin,
                           {{"diffuse_reflectance", kd.texture}});
            return add_half_mirror(material, ks);
        }
        if (!shines || illum == 0 || illum == 1) return add(Lambert{kd.color}, origin, {{"reflectance", kd.texture}});
        // The coat reflects 4 percent, what programs of today mean by 0.5.
        const Paint coat = paint(material, "ks", "map_ks", Rgb(1), 2);
        return add(RoughPlastic{.distribution = Facets::ggx,
                                .alpha = alpha(material),
                                .eta = 1.5f,
                                .diffuse_reflectance = kd.color,
                                .specular_reflectance = coat.color},
                   origin, {{"diffuse_reflectance", kd.texture}, {"specular_reflectance", coat.texture}});
    }

    static bool is_glass(const MtlMaterial& material, double illum) {
        // Some programs write illum 4, Tf 1 and Ni 1 for everything.
        const bool refracts = illum == 6 || illum == 7, has_index = index(material) != 1;
        if (!refracts && illum != 4 && illum != 5 && illum != 9) return false;
        const bool filters = !is_black(material.color("tf").value_or(Rgb(0)));
        return opacity(material) < 1 ? refracts || has_index : filters && has_index;
    }

    std::size_t add_glass(const MtlMaterial& material) {
        const double ni = index(material);
        const float eta = ni == 1 ? 1.5f : static_cast<float>(std::clamp(ni, 1e-3, 1e3));
        const Rgb tf = limited(material.color("tf").value_or(Rgb(1))), through = is_black(tf) ? Rgb(1) : tf;
        const float roughness = fraction(material.number("pr").value_or(0));
        if (square(roughness) < 1e-3f) return add(Dielectric{.eta = eta, .transmittance = through}, material.origin);
        return add(RoughDielectric{.distribution = Facets::ggx,
                                   .alpha_u = square(roughness),
                                   .alpha_v = square(roughness),
                                   .eta = eta,
                                   .transmittance = through},
                   material.origin);
    }

    std::size_t add_principled(const MtlMaterial& material) {
        const Paint kd = diffuse(material);
        const auto value = [&](std::string_view key, float otherwise) {
            return fraction(material.number(key).value_or(double(otherwise)));
        };
        const auto texture = [&](std::string_view key) -> std::optional<Texture> {
            if (const MtlMap* const map = material.map(key)) return textures_.read(*map, Use::raw_fraction);
            return {};
        };
        const float by_exponent = material.number("ns") ? std::sqrt(alpha(material)) : 0.5f;
        const Principled model{.base_color = kd.color,
                               .roughness = value("pr", by_exponent),
                               .anisotropic = value("aniso", 0),
                               .metallic = value("pm", 0),
                               .sheen = value("ps", 0),
                               .clearcoat = value("pc", 0),
                               .clearcoat_gloss = 1 - value("pcr", 0)};
        return add(model, material.origin,
                   {{"base_color", kd.texture}, {"roughness", texture("map_pr")}, {"metallic", texture("map_pm")}});
    }

    /// Kd + Ks, where Ks is a mirror: of two models that are each seen in part.
    std::size_t add_half_mirror(const MtlMaterial& material, const Rgb& ks) {
        const Rgb kd = limited(material.color("kd").value_or(material.map("map_kd") ? Rgb(1) : Rgb(0.5f)));
        const float mirror = luminance(ks), rest = luminance(is_dark(kd) ? Rgb(1) : kd), both = mirror + rest;
        const Paint base = paint(material, "kd", "map_kd", Rgb(0.5f), std::min(both, 1.0f) / rest);
        const std::size_t first = add(Lambert{base.color}, material.origin, {{"reflectance", base.texture}});
        const std::size_t second =
            add(Conductor{.reflectance = limited(ks * (std::min(both, 1.0f) / mirror))}, material.origin);
        for (const std::size_t part : {first, second}) scene_.materials[part].two_sided = false;
        return scene_.add(Blend{first, second, Texture(Rgb(mirror / both))}, material.origin);
    }

    /// Under the normals of a map, and seen from both sides.
    std::size_t layered(const MtlMaterial& material, std::size_t inner) {
        const bool two_sided = scene_.materials[inner].two_sided || scene_.materials[inner].layer;
        std::optional<MaterialLayer> layer;
        if (const MtlMap* const normals = material.map("norm")) {
            if (const auto texture = textures_.read(*normals, Use::raw))
                layer = NormalMap{.inner = inner, .normals = *texture};
        } else if (const MtlMap* const bump = material.map("map_bump")) {
            if (const auto texture = textures_.read(*bump, Use::raw)) layer = bump_or_normals(*bump, *texture, inner);
        }
        if (layer) {
            scene_.materials[inner].two_sided = false;
            inner = scene_.add(*std::move(layer), material.origin);
        }
        scene_.materials[inner].two_sided = two_sided;
        return inner;
    }

    /// Programs of today write maps of normals, which are bluish, as maps of heights.
    MaterialLayer bump_or_normals(const MtlMap& map, const Texture& texture, std::size_t inner) {
        const Rgb mean = texture.mean();
        const auto is_half = [](float value) { return value > 0.35f && value < 0.65f; };
        if (is_half(mean.x) && is_half(mean.y) && mean.z > 0.75f) {
            notices_.add(map.origin, "the image looks like a map of normals, and is used as one");
            return NormalMap{.inner = inner, .normals = texture};
        }
        return BumpMap{.inner = inner, .height = texture, .scale = static_cast<float>(map.bump)};
    }

    void add_emission(const MtlMaterial& material, Made& made) {
        const Rgb ke = material.color("ke").value_or(Rgb(0));
        if (const MtlMap* const map = material.map("map_ke")) made.emission_texture = textures_.read(*map, Use::light);
        if (made.emission_texture) made.emission = is_black(ke) ? Rgb(1) : ke;
        else if (!is_black(ke)) made.emission = ke;
    }

    void add_mask(const MtlMaterial& material, Made& made) {
        const double d = opacity(material);
        const MtlMap* const map = material.map("map_d");
        if (is_glass(material, material.number("illum").value_or(2)) || (d == 1 && !map)) return;
        if (made.emission) {
            notices_.add(material.origin, "the material shines and cannot be transparent as well: it is opaque");
            return;
        }
        std::optional<Texture> texture;
        if (map && material.map("map_kd") && material.map("map_kd")->file == map->file)
            notices_.add(map->origin, "the opacity is in the alpha of the image of \"map_Kd\", which is not read");
        else if (map) texture = textures_.read(*map, Use::raw_fraction, Rgb(d == 0 ? 1.0f : float(d)));
        if (!texture && d == 1) return;
        if (!texture && d == 0) notices_.add(material.origin, "the material is invisible");
        made.material = scene_.add(Mask{made.material, texture.value_or(Texture(Rgb(float(d))))}, material.origin);
    }

    /// What only the extension for physically based rendering has.
    static constexpr std::string_view physical[] = {"pr", "pm", "ps", "pc", "map_pr", "map_pm"};

    MtlTextures textures_;
    LibraryDescription& scene_;
    FileNotices& notices_;
    std::optional<std::size_t> grey_;
};

}  // namespace lightswitch::detail
