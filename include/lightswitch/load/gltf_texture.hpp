#pragma once

// Textures in glTF files.

#include <lightswitch/load/gltf_file.hpp>

#if LIGHTSWITCH_HAS_GLTF

#include <lightswitch/load/texture_memory.hpp>
#include <lightswitch/texture/stb_decode.hpp>
#include <lightswitch/texture/texture.hpp>

#include <memory>
#include <tuple>

namespace lightswitch::detail {

/// A number of an extension, or `otherwise`.
inline double gltf_number(const tinygltf::Value& value, const std::string& name, double otherwise) {
    if (!value.IsObject() || !value.Has(name) || !value.Get(name).IsNumber()) return otherwise;
    return value.Get(name).GetNumberAsDouble();
}
/// The same of the one at that place of an array.
inline double gltf_number(const tinygltf::Value& value, const std::string& name, int place, double otherwise) {
    if (!value.IsObject() || !value.Has(name) || !value.Get(name).IsArray()) return otherwise;
    const tinygltf::Value& number = value.Get(name).Get(place);
    return number.IsNumber() ? number.GetNumberAsDouble() : otherwise;
}
/// A number of an extension that counts something, or -1.
inline int gltf_index(const tinygltf::Value& value, const std::string& name) {
    const double number = gltf_number(value, name, -1);
    return number >= 0 && number <= 0x7fffffff ? static_cast<int>(number) : -1;
}

inline const tinygltf::Value* gltf_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

/// What a material says of a texture.
struct GltfTextureUse {
    int texture = -1;  ///< -1 where there is none
    int uv_set = 0;
    UvTransform to_uv{};

    /// Of any of tinygltf's structures for it.
    template <class Info>
    static GltfTextureUse of(const Info& info) {
        GltfTextureUse use{info.index, info.texCoord, {}};
        if (const auto* transform = gltf_extension(info.extensions, "KHR_texture_transform")) use.transform(*transform);
        return use;
    }
    /// Of the texture with that name in an extension.
    static GltfTextureUse of(const tinygltf::Value& extension, const std::string& name) {
        if (!extension.IsObject() || !extension.Has(name)) return {};
        const tinygltf::Value& info = extension.Get(name);
        GltfTextureUse use{gltf_index(info, "index"), std::max(gltf_index(info, "texCoord"), 0), {}};
        if (!info.IsObject() || !info.Has("extensions")) return use;
        const tinygltf::Value& extensions = info.Get("extensions");
        if (extensions.IsObject() && extensions.Has("KHR_texture_transform"))
            use.transform(extensions.Get("KHR_texture_transform"));
        return use;
    }

private:
    /// Scales, turns and moves uv, in this order. With v downwards the turn is counter-clockwise as seen.
    void transform(const tinygltf::Value& value) {
        const double angle = gltf_number(value, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
        const double x = gltf_number(value, "scale", 0, 1), y = gltf_number(value, "scale", 1, 1);
        to_uv.u = Vec3(DVec3(c * x, s * y, gltf_number(value, "offset", 0, 0)));
        to_uv.v = Vec3(DVec3(-s * x, c * y, gltf_number(value, "offset", 1, 0)));
        if (const int set = gltf_index(value, "texCoord"); set >= 0) uv_set = set;
    }
};

/// Reads the textures of one glTF file, each image once for each way in which it is used.
class GltfTextures {
public:
    explicit GltfTextures(GltfFile& file) : file_(file) {}

    /// The channels of the texture's image. Nothing where there is no texture, or none that can be used.
    std::optional<Texture> read(const GltfTextureUse& use, ImageChannels channels, TexelEncoding encoding,
                                const Origin& user) {
        return read({0, channels, encoding, {}, {}, always}, use, user);
    }

    /// 1 where the alpha of the texture's image is at least `threshold`, and 0 elsewhere.
    std::optional<Texture> read_cut(const GltfTextureUse& use, double threshold, const Origin& user) {
        const double level = std::ceil(std::clamp(threshold, 0.0, 1.01) * 255);
        return read({0, ImageChannels::alpha, TexelEncoding::linear, {}, {}, static_cast<int>(level)}, use, user);
    }

private:
    static constexpr int always = -1;  ///< no threshold
    /// Image, its channels and their meaning, look-up, and threshold in 255ths.
    using Key = std::tuple<std::size_t, ImageChannels, TexelEncoding, TextureFilter, TextureWrap, int>;

    std::optional<Texture> read(Key key, const GltfTextureUse& use, const Origin& user) {
        if (use.texture == -1) return {};
        const auto& texture = file_.element(file_.model().textures, use.texture, "textures", user);
        const Origin where = file_.origin("textures", static_cast<std::size_t>(use.texture));
        if (use.uv_set != 0) {
            file_.notices().add(user, "a texture by other coordinates than TEXCOORD_0 is ignored");
            return {};
        }
        if (texture.source == -1) {
            file_.notices().add(where, "a texture without an image that can be read is ignored");
            return {};
        }
        if (texture.source < 0 || static_cast<std::size_t>(texture.source) >= file_.image_count())
            fail(where, "names images[" + std::to_string(texture.source) + "], but there are " +
                            std::to_string(file_.image_count()) + " (counted from 0)");
        const TextureLookup lookup = lookup_of(texture, where);
        std::get<std::size_t>(key) = static_cast<std::size_t>(texture.source);
        std::get<TextureFilter>(key) = lookup.filter;
        std::get<TextureWrap>(key) = lookup.wrap;
        const Texture result(bitmap(key), use.to_uv);
        if (const std::string problem = result.problem(); !problem.empty()) fail(user, problem);
        return result;
    }

    TextureLookup lookup_of(const tinygltf::Texture& texture, const Origin& where) {
        TextureLookup lookup;
        if (texture.sampler == -1) return lookup;
        const auto& sampler = file_.element(file_.model().samplers, texture.sampler, "samplers", where);
        if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) lookup.filter = TextureFilter::nearest;
        if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) lookup.wrap = TextureWrap::clamp;
        if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) lookup.wrap = TextureWrap::mirror;
        if (sampler.wrapS != sampler.wrapT)
            file_.notices().add(file_.origin("samplers", static_cast<std::size_t>(texture.sampler)),
                                "wrapT differs from wrapS, which is used for both");
        return lookup;
    }

    std::shared_ptr<const Bitmap> bitmap(const Key& key) {
        if (const auto known = bitmaps_.find(key); known != bitmaps_.end()) return known->second;
        const auto [number, channels, encoding, filter, wrap, level] = key;
        std::shared_ptr<const Bitmap> result;
        if (level == always) {
            const Origin where = file_.origin("images", number);
            const std::string_view bytes = file_.image(number);
            if (bytes.empty()) fail(where, "is empty");
            result = std::make_shared<const Bitmap>(
                decode_stb(bytes, where.file + ": " + where.element, encoding, {filter, wrap}, channels));
        } else {
            const auto whole = bitmap({number, channels, encoding, filter, wrap, always});
            std::vector<std::uint8_t> texels;
            texels.reserve(static_cast<std::size_t>(whole->width()) * static_cast<std::size_t>(whole->height()));
            for (int y = 0; y < whole->height(); ++y)
                for (int x = 0; x < whole->width(); ++x)
                    texels.push_back(std::round(whole->texel(x, y).x * 255) >= static_cast<float>(level) ? 255 : 0);
            result = std::make_shared<const Bitmap>(whole->width(), whole->height(), std::move(texels),
                                                    TexelEncoding::linear, TextureLookup{filter, wrap});
        }
        memory_.add(result->bytes(), file_.origin("images", number));
        return bitmaps_.emplace(key, std::move(result)).first->second;
    }

    GltfFile& file_;
    std::map<Key, std::shared_ptr<const Bitmap>> bitmaps_;
    TextureMemory memory_;
};

}  // namespace lightswitch::detail

#endif
