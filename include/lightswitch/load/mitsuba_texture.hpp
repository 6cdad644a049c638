#pragma once

// Textures in Mitsuba's scene files.

#include <lightswitch/load/xml_element.hpp>
#include <lightswitch/scene/library.hpp>
#include <lightswitch/texture/load_bitmap.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

namespace lightswitch::detail {

/// Reads the textures of one scene file, each file and each `<texture>` once.
class TextureReader {
public:
    TextureReader(const XmlFile& file, std::filesystem::path folder) : file_(file), folder_(std::move(folder)) {}

    /// Reads a `<texture>`, or the one that a `<ref>` stands for.
    Texture read(pugi::xml_node node) {
        if (std::string_view(node.name()) == "ref") node = file_.target(node, "texture");
        const auto known = textures_.find(node.offset_debug());
        if (known != textures_.end()) return known->second;
        XmlElement element(file_, node);
        const Texture texture = element.type() == "bitmap" ? read_bitmap(element) : read_checkerboard(element);
        element.finish();
        if (const std::string problem = texture.problem(); !problem.empty()) element.error(problem);
        return textures_.emplace(node.offset_debug(), texture).first->second;
    }

    /// The `<texture>` (or `<ref>`) of that name, which must be there.
    Texture texture(XmlElement& element, const std::string& name) {
        const auto node = element.texture(name);
        if (!node) element.error("needs a texture named " + quote(name));
        return read(*node);
    }
    /// The only `<texture>` inside, whatever its name.
    Texture only_texture(XmlElement& element) {
        const auto nodes = element.objects({"texture"});
        if (nodes.size() != 1) element.error("needs exactly one texture inside, not " + std::to_string(nodes.size()));
        return read(nodes[0]);
    }
    /// A parameter that is a number or colour, or a texture. Without `otherwise` it must be there.
    Texture value_or_texture(XmlElement& element, const std::string& name, std::optional<float> otherwise = {}) {
        if (const auto node = element.texture(name)) return read(*node);
        if (!otherwise && !element.has(name)) element.error("the parameter " + quote(name) + " is missing");
        return Texture(element.color(name, otherwise.value_or(0)));
    }

    /// The image files that were read.
    std::vector<std::string> files() const {
        std::vector<std::string> result;
        for (const auto& [options, bitmap] : bitmaps_) result.push_back(std::get<0>(options));
        return result;
    }

    /// A surface model with those of its parameters that `element` gives as textures.
    template <class B>
    LibraryBsdf with_textures(XmlElement& element, const B& bsdf) {
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
    static UvTransform read_to_uv(XmlElement& element) {
        const auto to_uv = element.transform("to_uv");
        if (!to_uv) return {};
        const DMat4& m = *to_uv;
        return {.u = Vec3(m[0].x, m[1].x, m[3].x), .v = Vec3(m[0].y, m[1].y, m[3].y)};
    }

    Texture read_bitmap(XmlElement& element) {
        const std::string path = element.file_name(folder_).string();
        const auto one_of = [&](const char* parameter, const char* otherwise, const auto& values) {
            const std::string value = lower_case(element.text(parameter).value_or(otherwise));
            const auto found = values.find(value);
            if (found == values.end()) {
                std::string known;
                for (const auto& [text, meaning] : values) known += (known.empty() ? "" : ", ") + text;
                fail(element.origin(parameter), quote(value) + " is not one of " + known);
            }
            return found->second;
        };
        static const std::map<std::string, TextureFilter> filters{{"bilinear", TextureFilter::bilinear},
                                                                  {"nearest", TextureFilter::nearest}};
        static const std::map<std::string, TextureWrap> wraps{
            {"repeat", TextureWrap::repeat}, {"mirror", TextureWrap::mirror}, {"clamp", TextureWrap::clamp}};
        const TextureFilter filter = one_of("filter_type", "bilinear", filters);
        const TextureWrap wrap = one_of("wrap_mode", "repeat", wraps);
        const bool raw = element.boolean("raw", false);
        auto& bitmap = bitmaps_[{path, raw, filter, wrap}];
        if (!bitmap)
            bitmap = at_place(element.origin(), [&] {
                return std::make_shared<const Bitmap>(load_bitmap(path, {.raw = raw, .filter = filter, .wrap = wrap}));
            });
        return Texture(bitmap, read_to_uv(element));
    }

    static Texture read_checkerboard(XmlElement& element) {
        if (element.type() != "checkerboard") element.unknown_type("bitmap and checkerboard");
        const Checkerboard pattern{element.color("color0", 0.4f), element.color("color1", 0.2f)};
        return Texture(pattern, read_to_uv(element));
    }

    const XmlFile& file_;
    std::filesystem::path folder_;
    std::map<std::ptrdiff_t, Texture> textures_;
    std::map<std::tuple<std::string, bool, TextureFilter, TextureWrap>, std::shared_ptr<const Bitmap>> bitmaps_;
};

}  // namespace lightswitch::detail
