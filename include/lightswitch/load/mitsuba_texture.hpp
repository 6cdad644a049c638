#pragma once

// Textures in Mitsuba's scene files.

#include <lightswitch/load/texture_memory.hpp>
#include <lightswitch/load/xml_color.hpp>
#include <lightswitch/scene/library.hpp>
#include <lightswitch/texture/load_bitmap.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

namespace lightswitch::detail {

/// Reads the textures of one scene file, each file and each `<texture>` once. In the place of one that cannot be read
/// is middle grey.
class TextureReader {
public:
    explicit TextureReader(const XmlFile& file) : file_(file) {}

    /// Reads a `<texture>`, or the one that a `<ref>` stands for.
    Texture read(pugi::xml_node node) {
        return file_.log().attempt(
            "it is middle grey", [&] { return read_or_throw(node); }, [] { return Texture(Rgb(0.5f)); });
    }

    /// The `<texture>` (or `<ref>`) of that name, which must be there and whole.
    Texture texture(XmlElement& element, const std::string& name) {
        const auto node = element.texture(name);
        if (!node) element.error("needs a texture named " + quote(name));
        return read_or_throw(*node);
    }
    /// The only `<texture>` inside, whatever its name, which must be whole. What a texture of type `scale` multiplies
    /// it by goes into `scale`.
    Texture only_texture(XmlElement& element, float& scale) {
        constexpr int deepest = 64;
        pugi::xml_node node = only_texture_in(element);
        for (int depth = 0;; ++depth) {
            XmlElement inner(file_, node);
            if (inner.type() != "scale") return read_or_throw(node);
            if (depth == deepest)
                inner.error("contains itself, or is in more than " + std::to_string(deepest) + " textures of its type");
            scale *= static_cast<float>(inner.number("scale", 1));
            node = only_texture_in(inner);
            inner.finish();
        }
    }
    /// A parameter that is a number or colour, or a texture. Without `otherwise` it must be there.
    Texture value_or_texture(XmlElement& element, const std::string& name, std::optional<float> otherwise = {}) {
        if (const auto node = element.texture(name)) return read(*node);
        if (!otherwise && !element.has(name)) element.error("the parameter " + quote(name) + " is missing");
        return Texture(element.color(name, otherwise.value_or(0)));
    }

    /// A surface model with those of its parameters that `element` gives as textures.
    template <class B>
    AnyMaterial with_textures(XmlElement& element, const B& bsdf) {
        Textured<B> textured(bsdf);
        bool any = false;
        for_each_parameter<B>([&](std::size_t, const auto& parameter) {
            if (!parameter.varies) return;
            const auto node = element.texture(std::string(parameter.name));
            if (!node) return;
            textured.set(parameter.name, read(*node));
            any = true;
        });
        if (!any) return bsdf;
        return textured;
    }

private:
    static pugi::xml_node only_texture_in(XmlElement& element) {
        const auto nodes = element.objects("texture");
        if (nodes.size() != 1) element.error("needs exactly one texture inside, not " + std::to_string(nodes.size()));
        return nodes[0];
    }

    static UvTransform read_to_uv(XmlElement& element) {
        const auto to_uv = element.transform("to_uv");
        if (!to_uv) return {};
        const DMat4& m = *to_uv;
        return {.u = Vec3(m[0].x, m[1].x, m[3].x), .v = Vec3(m[0].y, m[1].y, m[3].y)};
    }

    Texture read_or_throw(pugi::xml_node node) {
        if (std::string_view(node.name()) == "ref") {
            const pugi::xml_node meant = file_.target(node);
            if (!meant)
                fail(file_.origin(node), "there is no element with the id " + quote(node.attribute("id").value()));
            if (std::string_view(meant.name()) != "texture")
                fail(file_.origin(node),
                     "refers to " + file_.origin(meant).element + ", but only a <texture> can be referred to");
            node = meant;
        }
        const auto known = textures_.find(node);
        if (known != textures_.end()) return known->second;
        XmlElement element(file_, node);
        const std::string type = element.type();
        const Texture texture = type == "bitmap"        ? read_bitmap(element)
                                : type == "scale"       ? read_scaled(element)
                                : type == "rawconstant" ? read_constant(element)
                                                        : read_checkerboard(element);
        element.finish();
        if (const std::string problem = texture.problem(); !problem.empty()) element.error(problem);
        return textures_.emplace(node, texture).first->second;
    }

    /// The texture of Mitsuba 0.6 that multiplies another one.
    Texture read_scaled(XmlElement& element) {
        float scale = 1;
        const Texture result = only_texture(element, scale);
        if (scale != 1) element.problem("scale", "only bump maps can be scaled", "it is 1");
        return result;
    }

    Texture read_bitmap(XmlElement& element) {
        const std::string path = element.file_name().string();
        static const std::map<std::string, TextureFilter> filters{{"bilinear", TextureFilter::bilinear},
                                                                  {"nearest", TextureFilter::nearest}};
        static const std::map<std::string, TextureWrap> wraps{
            {"repeat", TextureWrap::repeat}, {"mirror", TextureWrap::mirror}, {"clamp", TextureWrap::clamp}};
        const TextureFilter filter = element.one_of("filter_type", "bilinear", filters);
        const TextureWrap wrap = element.one_of("wrap_mode", "repeat", wraps);
        const bool raw = element.boolean("raw", false);
        element.boolean("accel", true);  // and what it is stored as in memory, which changes nothing either
        element.text("format");
        auto& bitmap = bitmaps_[{path, raw, filter, wrap}];
        if (!bitmap) {
            auto read = at_place(element.origin(), [&] {
                return std::make_shared<const Bitmap>(load_bitmap(path, {.raw = raw, .filter = filter, .wrap = wrap}));
            });
            memory_.add(read->bytes(), element.origin());
            bitmap = std::move(read);
        }
        return Texture(bitmap, read_to_uv(element));
    }

    static Texture read_constant(XmlElement& element) {
        const std::string name = "value";
        if (!element.has(name)) element.error("the parameter \"value\" is missing");
        if (!element.is_vector(name)) return Texture(Rgb(static_cast<float>(element.number(name, 0.5))));
        return Texture(Rgb(element.vector(name).value_or(DVec3(0.5))));
    }

    static Texture read_checkerboard(XmlElement& element) {
        if (element.type() != "checkerboard") element.unknown_type("bitmap, checkerboard and rawconstant");
        const Checkerboard pattern{element.color("color0", 0.4f), element.color("color1", 0.2f)};
        return Texture(pattern, read_to_uv(element));
    }

    const XmlFile& file_;
    std::map<pugi::xml_node, Texture> textures_;
    std::map<std::tuple<std::string, bool, TextureFilter, TextureWrap>, std::shared_ptr<const Bitmap>> bitmaps_;
    TextureMemory memory_;
};

}  // namespace lightswitch::detail
