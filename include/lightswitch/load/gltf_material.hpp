#pragma once

// Materials in glTF files.

#include <lightswitch/load/gltf_texture.hpp>

#if LIGHTSWITCH_HAS_GLTF

#include <lightswitch/scene/library.hpp>

namespace lightswitch::detail {

/// What a material of a glTF file is for a shape.
struct GltfSurface {
    std::size_t material = 0;  ///< its number in the description
    std::optional<Rgb> emission{};
    std::optional<Texture> emission_texture{};
    bool textured = false;  ///< whether anything of it needs texture coordinates
};

/// Reads the materials of one glTF file into a description, each once, and only those that are used.
class GltfMaterials {
public:
    GltfMaterials(GltfFile& file, LibraryDescription& scene) : file_(file), textures_(file), scene_(scene) {}

    /// The material of that number, or glTF's default for -1; `user` names it.
    const GltfSurface& of(int number, const Origin& user) {
        if (const auto known = surfaces_.find(number); known != surfaces_.end()) return known->second;
        const bool none = number == -1;
        const tinygltf::Material by_default;
        const auto& material = none ? by_default : file_.element(file_.model().materials, number, "materials", user);
        where_ = none ? user : file_.origin("materials", static_cast<std::size_t>(number));
        surface_ = {};
        if (gltf_extension(material.extensions, "KHR_materials_unlit")) read_unlit(material);
        else read(material);
        return surfaces_.emplace(number, surface_).first->second;
    }

private:
    void read_unlit(const tinygltf::Material& material) {
        notice("what is unlit becomes a black surface that shines with its colour, from the front");
        shine(color(material.pbrMetallicRoughness.baseColorFactor, Rgb(1), "baseColorFactor"),
              GltfTextureUse::of(material.pbrMetallicRoughness.baseColorTexture));
        surface_.material = scene_.add(Lambert{.reflectance = Rgb(0)}, where_);
        add_opacity(material);
    }

    void read(const tinygltf::Material& material) {
        Textured<Principled> model = read_model(material);
        const bool both_sides = material.doubleSided && !model.transmits_light();
        if (const auto* constant = model.constant())
            surface_.material = scene_.add(static_cast<const Principled&>(*constant), where_);
        else surface_.material = scene_.add(std::move(model), where_);
        scene_.materials.back().two_sided = both_sides;

        Rgb emission(0);
        for (int c = 0; c < 3 && material.emissiveFactor.size() == 3; ++c)
            emission[c] = static_cast<float>(std::max(material.emissiveFactor[static_cast<std::size_t>(c)], 0.0));
        if (const auto* strength = gltf_extension(material.extensions, "KHR_materials_emissive_strength"))
            emission *= static_cast<float>(std::max(gltf_number(*strength, "emissiveStrength", 1), 0.0));
        shine(emission, GltfTextureUse::of(material.emissiveTexture));
        if (surface_.emission && material.doubleSided) notice("shines from its front only, though it is double-sided");

        if (const auto normals =
                texture(GltfTextureUse::of(material.normalTexture), ImageChannels::color, TexelEncoding::linear)) {
            surface_.material = scene_.add(NormalMap{.inner = surface_.material,
                                                     .normals = *normals,
                                                     .scale = static_cast<float>(material.normalTexture.scale),
                                                     .against_v = true},
                                           where_);
        }
        add_opacity(material);
    }

    Textured<Principled> read_model(const tinygltf::Material& material) {
        const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        Principled model;
        std::vector<std::pair<const char*, Texture>> placed;
        const auto set = [&](const char* name, float& value, double factor, const GltfTextureUse& use,
                             ImageChannels channel) {
            value = fraction(factor, name);
            const auto found = value > 0 ? texture(use, channel, TexelEncoding::linear) : std::nullopt;
            if (!found) return;
            const Texture scaled = found->scaled(Rgb(value));
            value = scaled.most().x;
            if (scaled.least() != scaled.most()) placed.emplace_back(name, scaled);
        };
        model.base_color = color(pbr.baseColorFactor, Rgb(1), "baseColorFactor");
        if (const auto colors =
                texture(GltfTextureUse::of(pbr.baseColorTexture), ImageChannels::color, TexelEncoding::srgb))
            placed.emplace_back("base_color", colors->scaled(model.base_color));
        const GltfTextureUse both = GltfTextureUse::of(pbr.metallicRoughnessTexture);
        set("metallic", model.metallic, pbr.metallicFactor, both, ImageChannels::blue);
        set("roughness", model.roughness, pbr.roughnessFactor, both, ImageChannels::green);

        if (const auto* glass = gltf_extension(material.extensions, "KHR_materials_transmission")) {
            set("spec_trans", model.spec_trans, gltf_number(*glass, "transmissionFactor", 0),
                GltfTextureUse::of(*glass, "transmissionTexture"), ImageChannels::red);
            if (model.spec_trans > 0 && !gltf_extension(material.extensions, "KHR_materials_volume"))
                notice("what transmits is thin in glTF, but refracts here like the surface of something solid");
        }
        if (const auto* coat = gltf_extension(material.extensions, "KHR_materials_clearcoat")) {
            set("clearcoat", model.clearcoat, gltf_number(*coat, "clearcoatFactor", 0),
                GltfTextureUse::of(*coat, "clearcoatTexture"), ImageChannels::red);
            // The model's alpha of its coat goes from 0.1 to 0.001.
            const double roughness =
                fraction(gltf_number(*coat, "clearcoatRoughnessFactor", 0), "clearcoatRoughnessFactor");
            model.clearcoat_gloss = static_cast<float>(std::clamp((0.1 - roughness * roughness) / 0.099, 0.0, 1.0));
            for (const char* ignored : {"clearcoatRoughnessTexture", "clearcoatNormalTexture"})
                if (GltfTextureUse::of(*coat, ignored).texture != -1) notice(std::string(ignored) + " is ignored");
        }
        if (const auto* index = gltf_extension(material.extensions, "KHR_materials_ior")) {
            const double ior = gltf_number(*index, "ior", 1.5);
            if (ior >= 1 && ior <= 1e3) model.eta = static_cast<float>(ior);
            else notice("the index of refraction is outside of 1 to 1000: it is taken as 1.5");
        }
        model.eta = Principled::eta_from_eta(model.eta, model.spec_trans > 0);

        Textured<Principled> result(model);
        for (auto& [name, texture] : placed) result.set(name, std::move(texture));
        surface_.textured = surface_.textured || !placed.empty();
        return result;
    }

    void shine(const Rgb& emission, const GltfTextureUse& use) {
        if (is_black(emission)) return;
        const auto found = texture(use, ImageChannels::color, TexelEncoding::srgb);
        if (found && is_black(found->most())) return;
        surface_.emission = emission;
        surface_.emission_texture = found;
    }

    /// The outermost layer.
    void add_opacity(const tinygltf::Material& material) {
        const bool cut = material.alphaMode == "MASK";
        if (!cut && material.alphaMode != "BLEND") return;
        const auto& factors = material.pbrMetallicRoughness.baseColorFactor;
        const double factor = double(fraction(factors.size() == 4 ? factors[3] : 1, "alpha"));
        const GltfTextureUse use = GltfTextureUse::of(material.pbrMetallicRoughness.baseColorTexture);
        std::optional<Texture> opacity;
        if (cut) {
            opacity = textures_.read_cut(use, factor > 0 ? material.alphaCutoff / factor : 2, where_);
            if (!opacity) opacity = Texture(Rgb(factor >= material.alphaCutoff ? 1.0f : 0.0f));
        } else {
            opacity = textures_.read(use, ImageChannels::alpha, TexelEncoding::linear, where_);
            opacity =
                opacity ? opacity->scaled(Rgb(static_cast<float>(factor))) : Texture(Rgb(static_cast<float>(factor)));
        }
        if (opacity->least().x >= 1) return;
        if (surface_.emission) {
            notice("shines, so that it is taken as opaque");
            return;
        }
        surface_.textured = true;
        surface_.material = scene_.add(Mask{surface_.material, *opacity}, where_);
    }

    std::optional<Texture> texture(const GltfTextureUse& use, ImageChannels channels, TexelEncoding encoding) {
        const auto result = textures_.read(use, channels, encoding, where_);
        surface_.textured = surface_.textured || result;
        return result;
    }

    float fraction(double value, const char* what) {
        if (value >= 0 && value <= 1) return static_cast<float>(value);
        notice(std::string(what) + " is outside of 0 to 1 and is limited to that");
        return static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    Rgb color(const std::vector<double>& factors, const Rgb& otherwise, const char* what) {
        if (factors.size() < 3) return otherwise;
        return {fraction(factors[0], what), fraction(factors[1], what), fraction(factors[2], what)};
    }

    void notice(std::string_view what) { file_.notices().add(where_, what); }

    GltfFile& file_;
    GltfTextures textures_;
    LibraryDescription& scene_;
    std::map<int, GltfSurface> surfaces_;
    // Of the one that is being read.
    Origin where_;
    GltfSurface surface_;
};

}  // namespace lightswitch::detail

#endif
