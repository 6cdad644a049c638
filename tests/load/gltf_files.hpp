#pragma once

// glTF files that tests write.

#include "load/files.hpp"
#include "texture/files.hpp"

#include <lightswitch/film/bytes.hpp>

#include <bit>
#include <initializer_list>
#include <string>
#include <string_view>

namespace lightswitch::test {

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t b = 0; b < 3; ++b)
            word = word << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d) text += i + d <= bytes.size() ? alphabet[word >> (18 - 6 * d) & 63] : '=';
    }
    return text;
}

inline std::string floats(std::initializer_list<float> values) {
    std::string bytes;
    for (const float value : values) detail::put_little_endian(bytes, std::bit_cast<std::uint32_t>(value));
    return bytes;
}
inline std::string shorts(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) detail::put_little_endian(bytes, static_cast<std::uint16_t>(value));
    return bytes;
}

/// A file that is put together piece by piece; the buffer is a data URI, or the chunk of a .glb file.
struct GltfText {
    std::string buffer{};
    std::string views{}, accessors{};
    std::string meshes = R"({"primitives": [{"attributes": {"POSITION": 0}}]})";
    std::string nodes = R"({"mesh": 0})";
    std::string scene = "0";  ///< its nodes
    std::string more{};       ///< members of the whole, each behind a comma
    std::string version = "2.0";

    /// Appends bytes as a view of its own; returns its number.
    int view(std::string_view bytes, std::string_view members = "") {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        append(views, R"({"buffer": 0, "byteOffset": )" + std::to_string(buffer.size()) + R"(, "byteLength": )" +
                          std::to_string(bytes.size()) + std::string(members) + "}");
        buffer += bytes;
        return view_count_++;
    }
    /// An accessor of a view that is made of `bytes`; returns its number.
    int accessor(std::string_view bytes, int component, int count, std::string_view type, std::string_view members = "",
                 std::string_view view_members = "") {
        const int number = view(bytes, view_members);
        return accessor_of(number, component, count, type, members);
    }
    int accessor_of(int view_number, int component, int count, std::string_view type, std::string_view members = "") {
        append(accessors, (view_number < 0 ? "{" : R"({"bufferView": )" + std::to_string(view_number) + ",") +
                              R"("componentType": )" + std::to_string(component) + R"(, "count": )" +
                              std::to_string(count) + R"(, "type": ")" + std::string(type) + "\"" +
                              std::string(members) + "}");
        return accessor_count_++;
    }

    std::string json(bool with_uri = true) const {
        std::string text = R"({"asset": {"version": ")" + version + "\"}";
        if (!buffer.empty())
            text += R"(, "buffers": [{"byteLength": )" + std::to_string(buffer.size()) +
                    (with_uri ? R"(, "uri": "data:application/octet-stream;base64,)" + base64(buffer) + "\"" : "") +
                    "}]";
        const auto list = [&](const char* name, const std::string& elements) {
            if (!elements.empty()) text += std::string(", \"") + name + "\": [" + elements + "]";
        };
        list("bufferViews", views);
        list("accessors", accessors);
        list("meshes", meshes);
        list("nodes", nodes);
        list("scenes", scene.empty() ? "" : R"({"nodes": [)" + scene + "]}");
        return text + more + "}";
    }
    std::string glb() const {
        std::string text = json(false), bytes = buffer;
        while (text.size() % 4 != 0) text += ' ';
        while (bytes.size() % 4 != 0) bytes += '\0';
        std::string file = "glTF";
        for (const std::size_t word : {std::size_t{2}, 12 + 8 + text.size() + 8 + bytes.size(), text.size()})
            detail::put_little_endian(file, static_cast<std::uint32_t>(word));
        file += "JSON" + text;
        detail::put_little_endian(file, static_cast<std::uint32_t>(bytes.size()));
        return file + std::string("BIN\0", 4) + bytes;
    }

private:
    static void append(std::string& list, const std::string& element) { list += (list.empty() ? "" : ", ") + element; }

    int view_count_ = 0, accessor_count_ = 0;
};

/// One triangle, with corners at the origin, (1, 0, 0) and (0, 2, 0).
inline GltfText gltf_triangle() {
    GltfText file;
    file.accessor(floats({0, 0, 0, 1, 0, 0, 0, 2, 0}), 5126, 3, "VEC3");
    return file;
}

/// An image of one row for each of `rows`, of bytes that are RGB or RGBA, as a data URI.
inline std::string png_uri(int width, const std::vector<std::vector<int>>& rows, bool alpha = false) {
    std::string bytes;
    for (const auto& row : rows) {
        bytes += '\0';
        for (const int value : row) bytes += static_cast<char>(value);
    }
    return "data:image/png;base64," + base64(png_file(width, static_cast<int>(rows.size()), 8, alpha ? 6 : 2, bytes));
}

}  // namespace lightswitch::test
