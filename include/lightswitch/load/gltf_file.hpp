#pragma once

// glTF files as tinygltf reads them, after checks of what it takes on trust. The only file that includes tinygltf,
// whose library is linked (LIGHTSWITCH_HAS_GLTF is 1): nothing of its implementation is compiled here.

#if LIGHTSWITCH_HAS_GLTF

#include <lightswitch/core/file.hpp>
#include <lightswitch/film/bytes.hpp>
#include <lightswitch/load/gltf_json.hpp>
#include <lightswitch/load/gltf_uri.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// A glTF 2.0 file: what tinygltf makes of its text, and the bytes of its buffers and images, which are fetched here,
/// each once and when they are asked for. So nothing is read twice, and memory is in proportion to the files.
class GltfFile {
public:
    GltfFile(const std::filesystem::path& path, FileNotices& notices) : path_(path), notices_(notices) {
        bytes_ = read_file(path, max_mesh_bytes);
        used_bytes_ = bytes_.size();
        files_.push_back(path.string());
        std::string_view text = bytes_;
        if (text.starts_with("glTF")) text = open_container();
        parse(text);
    }

    const tinygltf::Model& model() const { return model_; }
    FileNotices& notices() const { return notices_; }
    /// The files that were read.
    const std::vector<std::string>& files() const { return files_; }
    /// Of all files that were read.
    std::size_t used_bytes() const { return used_bytes_; }
    std::size_t image_count() const { return images_.size(); }

    Origin origin(const char* list, std::size_t number) const { return gltf_origin(path_, list, number); }
    Origin origin() const { return file_origin(path_); }

    /// The element of that number, which `user` names. Throws when there is none.
    template <class T>
    const T& element(const std::vector<T>& all, int number, const char* list, const Origin& user) const {
        if (number < 0 || static_cast<std::size_t>(number) >= all.size())
            fail(user, "names " + std::string(list) + "[" + std::to_string(number) + "], but there are " +
                           std::to_string(all.size()) + " (counted from 0)");
        return all[static_cast<std::size_t>(number)];
    }

    /// The bytes of a buffer view that `user` names.
    std::string_view view(int number, const Origin& user) {
        const auto& view = element(model_.bufferViews, number, "bufferViews", user);
        const Origin where = origin("bufferViews", static_cast<std::size_t>(number));
        const std::string_view bytes = buffer(view.buffer, where);
        if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
            fail(where, "has " + std::to_string(view.byteLength) + " bytes from byte " +
                            std::to_string(view.byteOffset) + " on, but buffers[" + std::to_string(view.buffer) +
                            "] has " + std::to_string(bytes.size()));
        return bytes.substr(view.byteOffset, view.byteLength);
    }

    /// The file in an image, still encoded.
    std::string_view image(std::size_t number) {
        Resource& image = images_.at(number);
        const Origin where = origin("images", number);
        if (image.view >= 0) return view(image.view, where);
        if (image.uri.empty()) fail(where, "has neither a uri nor a bufferView");
        return fetched(image, where);
    }

private:
    using Json = nlohmann::json;

    struct Resource {
        std::string uri;
        int view = -1;                       ///< of an image
        std::uint64_t length = 0;            ///< of a buffer
        std::optional<std::string> bytes{};  ///< once they were asked for
    };

    /// The text in a .glb file; keeps where its binary chunk is.
    std::string_view open_container() {
        ByteReader reader(bytes_, path_.string());
        reader.take(4);
        const auto version = reader.number<std::uint32_t>(), length = reader.number<std::uint32_t>();
        if (version != 2)
            fail(origin(), "is a .glb file of version " + std::to_string(version) + "; only version 2 is known");
        if (length > bytes_.size()) reader.truncated();
        std::string_view text;
        for (int chunk = 0; reader.position() + 8 <= length; ++chunk) {
            const auto size = reader.number<std::uint32_t>(), type = reader.number<std::uint32_t>();
            const std::string_view content = reader.take(size);
            constexpr std::uint32_t json = 0x4e4f534a, binary = 0x004e4942;
            if (chunk == 0 && type != json) fail(origin(), "is a damaged .glb file: its first chunk is no JSON");
            if (chunk == 0) text = content;
            if (chunk == 1 && type == binary) binary_ = content;
        }
        return text;
    }

    void parse(std::string_view text) {
        GltfJson checked(path_, notices_, text);
        Json& json = checked.json();
        take_resources(json);
        const std::string rest = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        std::string error, warning;
        tinygltf::TinyGLTF reader;
        bool good = false;
        try {
            good = reader.LoadASCIIFromString(&model_, &error, &warning, rest.data(),
                                              static_cast<unsigned>(rest.size()), "");
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        if (!good) fail(origin(), "is damaged glTF: " + one_line(error));
    }

    /// Takes buffers and images out of `json`, and what is ignored.
    void take_resources(Json& json) {
        const auto take = [&](const char* list, std::vector<Resource>& into) {
            const auto found = json.find(list);
            if (found == json.end()) return;
            for (const Json& element : *found) {
                Resource& resource = into.emplace_back();
                if (const auto uri = element.find("uri"); uri != element.end() && uri->is_string())
                    resource.uri = uri->get<std::string>();
                const auto whole = [&](const char* name) -> std::optional<std::uint64_t> {
                    const auto number = element.find(name);
                    if (number == element.end() || !number->is_number_unsigned()) return {};
                    return number->get<std::uint64_t>();
                };
                if (const auto view = whole("bufferView"))
                    resource.view = static_cast<int>(std::min<std::uint64_t>(*view, 0x7fffffff));
                resource.length = whole("byteLength").value_or(0);
            }
            json.erase(found);
        };
        take("buffers", buffers_);
        take("images", images_);
        for (const char* ignored : {"animations", "skins"}) {
            if (const auto found = json.find(ignored); found != json.end() && !found->empty())
                notices_.add(origin(), std::string("the file's ") + ignored + " are ignored");
            json.erase(ignored);
        }
    }

    std::string_view buffer(int number, const Origin& user) {
        element(buffers_, number, "buffers", user);
        Resource& buffer = buffers_[static_cast<std::size_t>(number)];
        const Origin where = origin("buffers", static_cast<std::size_t>(number));
        std::string_view bytes = binary_;
        if (!buffer.uri.empty()) {
            bytes = fetched(buffer, where);
        } else if (number != 0 || binary_.empty()) {
            fail(where, "has no uri, so its bytes are nowhere");
        }
        // The binary chunk, and in practice files, may be longer.
        if (buffer.length > bytes.size())
            fail(where, "has " + std::to_string(bytes.size()) + " bytes, but its byteLength is " +
                            std::to_string(buffer.length));
        return bytes.substr(0, buffer.length);
    }

    std::string_view fetched(Resource& resource, const Origin& where) {
        if (!resource.bytes) resource.bytes = fetch(resource.uri, where);
        return *resource.bytes;
    }

    std::string fetch(const std::string& uri, const Origin& where) {
        if (uri.starts_with("data:")) {
            auto bytes = decode_data_uri(uri);
            if (!bytes) fail(where, "has a data: uri that is not in base64, or damaged");
            return std::move(*bytes);
        }
        if (uri.find("://") != std::string::npos) fail(where, "is elsewhere: " + quote(uri) + " is no file name");
        const std::filesystem::path file = path_.parent_path() / decode_percent(uri);
        std::string bytes = at_place(where, [&] { return read_file(file, max_mesh_bytes); });
        used_bytes_ += bytes.size();
        if (used_bytes_ > 4 * max_mesh_bytes) fail(where, "is too much: all files together have more than 4 GiB");
        if (std::find(files_.begin(), files_.end(), file.string()) == files_.end()) files_.push_back(file.string());
        return bytes;
    }

    std::filesystem::path path_;
    FileNotices& notices_;
    std::string bytes_;
    std::string_view binary_;
    std::size_t used_bytes_ = 0;
    std::vector<std::string> files_;
    std::vector<Resource> buffers_, images_;
    tinygltf::Model model_;
};

}  // namespace lightswitch::detail

#endif
