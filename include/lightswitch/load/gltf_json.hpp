#pragma once

// The text of glTF files: what is checked before tinygltf reads it.

#if LIGHTSWITCH_HAS_GLTF

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/text.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::detail {

/// An element of a glTF file, such as "accessors[3]".
inline Origin gltf_origin(const std::filesystem::path& file, const std::string& list, std::size_t number) {
    return {file.string(), 0, list + "[" + std::to_string(number) + "]"};
}

/// A message of a library, fit for one of ours.
inline std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    if (text.size() > 200) text.resize(200);
    for (char& c : text)
        if (c < ' ' || c > '~') c = ' ';
    return text;
}

/// The JSON of a glTF file. Throws for another version, for extensions that are required and not known, for what is no
/// list of objects where one must be, and for so much of it that it cannot be honest; tells of what is ignored.
class GltfJson {
public:
    GltfJson(const std::filesystem::path& path, FileNotices& notices, std::string_view text)
        : path_(path), notices_(notices) {
        if (text.size() > max_text) fail(origin(), "has more than 256 MiB of JSON");
        check_nesting(text);
        try {
            json_ = Json::parse(text);
        } catch (const std::exception& error) {
            fail(origin(), "is no JSON: " + one_line(error.what()));
        }
        if (!json_.is_object()) fail(origin(), "is no glTF: its JSON is not an object");
        check_version();
        check_extensions();
        check_elements();
        normalize(json_);
    }

    nlohmann::json& json() { return json_; }

private:
    using Json = nlohmann::json;

    static constexpr std::size_t max_text = std::size_t{1} << 28;

    Origin origin() const { return file_origin(path_); }
    Origin origin(const std::string& list, std::size_t number) const { return gltf_origin(path_, list, number); }

    /// Arrays and objects in each other are read by recursion.
    void check_nesting(std::string_view text) const {
        int depth = 0;
        bool in_string = false;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const char c = text[i];
            if (in_string) {
                if (c == '\\') ++i;
                else if (c == '"') in_string = false;
            } else if (c == '"') {
                in_string = true;
            } else if (c == '[' || c == '{') {
                if (++depth > 64) fail(origin(), "its JSON has more than 64 levels");
            } else if (c == ']' || c == '}') {
                --depth;
            }
        }
    }

    void check_version() const {
        const auto asset = json_.find("asset");
        if (asset == json_.end() || !asset->is_object() || !asset->contains("version") ||
            !(*asset)["version"].is_string())
            fail(origin(), "is no glTF: it has no asset.version");
        const std::string version = (*asset)["version"];
        if (!version.starts_with("2."))
            fail(origin(), "is glTF of version " + quote(version) + "; only version 2 is known");
    }

    void check_extensions() const {
        static constexpr std::string_view known[] = {
            "KHR_lights_punctual",   "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
            "KHR_materials_ior",     "KHR_materials_transmission", "KHR_materials_unlit",
            "KHR_mesh_quantization", "KHR_texture_transform"};
        const auto each_unknown = [&](const char* list, const auto& f) {
            const auto names = json_.find(list);
            if (names == json_.end() || !names->is_array()) return;
            for (const Json& name : *names)
                if (name.is_string() && std::find(std::begin(known), std::end(known),
                                                  name.get_ref<const std::string&>()) == std::end(known))
                    f(name.get_ref<const std::string&>());
        };
        std::string missing;
        each_unknown("extensionsRequired",
                     [&](const std::string& name) { missing += (missing.empty() ? "" : ", ") + shown(name); });
        if (!missing.empty()) fail(origin(), "requires extensions of glTF that are not supported: " + missing);
        int listed = 0;
        each_unknown("extensionsUsed", [&](const std::string& name) {
            if (listed++ < 100) notices_.add(origin(), "the extension " + shown(name) + " is ignored");
        });
    }

    /// The parts of a file are arrays of objects, not very many, which have what makes them what they are.
    void check_elements() const {
        static const std::map<std::string, std::vector<const char*>> required{
            {"accessors", {"componentType", "count", "type"}},
            {"buffers", {"byteLength"}},
            {"bufferViews", {"buffer", "byteLength"}},
            {"cameras", {"type"}},
            {"images", {}},
            {"materials", {}},
            {"meshes", {"primitives"}},
            {"nodes", {}},
            {"samplers", {}},
            {"scenes", {}},
            {"textures", {}}};
        constexpr std::size_t most = std::size_t{1} << 20;
        std::size_t count = 0;
        for (const auto& [list, members] : required) {
            const auto found = json_.find(list);
            if (found == json_.end()) continue;
            if (!found->is_array()) fail(origin(), list + " is no array");
            for (std::size_t i = 0; i < found->size(); ++i) {
                const Origin where = origin(list, i);
                if (!(*found)[i].is_object()) fail(where, "is no object");
                for (const char* member : members) check_member((*found)[i], member, where);
            }
            count += found->size();
        }
        if (count > most) fail(origin(), "has more than 1048576 parts");
        check_indices();
    }

    static void check_member(const Json& element, const std::string& name, const Origin& where) {
        const auto member = element.find(name);
        if (member == element.end()) fail(where, "has no " + name);
        if (name == "type" && !member->is_string()) fail(where, "has a type that is no text");
        if (name == "primitives" && !member->is_array()) fail(where, "has primitives that are no array");
        if (name == "type" || name == "primitives") return;
        if (!member->is_number_unsigned() || member->get<std::uint64_t>() > 0x7fffffff)
            fail(where, "has a " + name + " that is no whole number of at least 0 and below 2^31");
    }

    /// tinygltf would not say of which mesh they are.
    void check_indices() const {
        const auto meshes = json_.find("meshes"), accessors = json_.find("accessors");
        if (meshes == json_.end()) return;
        const std::size_t count = accessors == json_.end() ? 0 : accessors->size();
        for (std::size_t i = 0; i < meshes->size(); ++i)
            for (const Json& primitive : (*meshes)[i]["primitives"]) {
                if (!primitive.is_object()) fail(origin("meshes", i), "has a primitive that is no object");
                const auto indices = primitive.find("indices");
                if (indices == primitive.end()) continue;
                if (!indices->is_number_unsigned() || indices->get<std::uint64_t>() >= count)
                    fail(origin("meshes", i), "names accessors[" + shown(indices->dump()) + "], but there are " +
                                                  std::to_string(count) + " (counted from 0)");
                const auto number = indices->get<std::size_t>();
                if (!(*accessors)[number].contains("bufferView"))
                    fail(origin("accessors", number), "has no bufferView, which indices need");
            }
    }

    /// Removes what means nothing, and whole numbers that tinygltf would cut to 32 bits: as fractions it refuses them.
    static void normalize(Json& json) {
        if (json.is_object()) {
            for (const char* ignored : {"extras", "min", "max"}) json.erase(ignored);
            for (auto& [name, value] : json.items()) normalize(value);
        } else if (json.is_array()) {
            for (Json& value : json) normalize(value);
        } else if (json.is_number_integer()) {
            const double value = json.get<double>();
            if (std::abs(value) > 0x7fffffff) json = value;
        }
    }

    const std::filesystem::path& path_;
    FileNotices& notices_;
    Json json_;
};

}  // namespace lightswitch::detail

#endif
