#pragma once

// PLY: triangles and polygons with optional vertex normals, ASCII or binary.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/ply_bulk.hpp>
#include <lightswitch/load/ply_data.hpp>
#include <lightswitch/load/polygon.hpp>

#include <filesystem>

namespace lightswitch {

/// Reads a PLY file of at most 1 GiB: ASCII, or binary with either byte order.
///
/// The element `vertex` gives x, y, z, perhaps nx, ny, nz, and perhaps texture coordinates (u and v, s and t, or
/// texture_u and texture_v); the elements `face` and `tristrips`, before or after it,
/// give the list `vertex_indices` or `vertex_index`; all in any type. In a strip, -1 begins the next one. Convex
/// polygons become fans around their first corner, others are cut into triangles that cover the same area. Where the
/// file's normals point is the front; one of length 0 in use is replaced by what `Mesh::smooth` computes. Everything
/// else in the file is skipped.
///
/// `notices` gets a line for each other element that is skipped, for polygons that cross themselves and for normals of
/// length 0 in use.
///
/// Throws `Error` with the line (ASCII) or the number of the element from 0 (binary) for anything malformed: a file
/// that is shorter or longer than its header says, a number that is not finite, an index out of range or not whole, or
/// when there is no face. Thread safe.
Mesh load_ply(const std::filesystem::path& path, FileNormals normals = FileNormals::use, Notices* notices = nullptr);

namespace detail {

class PlyReader {
public:
    PlyReader(std::string_view bytes, std::string file, FileNormals use)
        : header_(PlyHeaderReader(file).read(bytes)),
          data_(bytes, header_, file),
          origin_{std::move(file), 0, {}},
          use_(use) {}

    Mesh read(Notices* notices) {
        std::vector<std::pair<const PlyElement*, PlyData>> before_vertices;
        for (const PlyElement& element : header_.elements) {
            const bool is_faces = element.name == "face" || element.name == "tristrips";
            data_.check_count(element);
            if (element.name == "vertex") {
                vertices(element);
            } else if (is_faces && !mesh_.positions.empty()) {
                faces(element);
            } else {
                if (is_faces) before_vertices.emplace_back(&element, data_);
                else if (element.count > 0)
                    notices_.add({origin_.file, element.line, {}},
                                 "the element " + quote(element.name) + " is skipped");
                skip(element);
            }
        }
        data_.check_end();
        for (const auto& [element, data] : before_vertices) {
            data_ = data;
            faces(*element);
        }
        if (mesh_.triangles.empty()) fail(origin_, "contains no faces");
        finish_normals(mesh_);
        notices_.report(notices);
        return std::move(mesh_);
    }

private:
    void vertices(const PlyElement& element) {
        static constexpr std::array<const char*, 6> names{"x", "y", "z", "nx", "ny", "nz"};
        static constexpr std::array<std::array<const char*, 2>, 3> uv_names{
            {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}};
        PlyVertexRoles roles;
        roles.of.assign(element.properties.size(), PlyVertexRoles::none);
        roles.with_normals = use_ == FileNormals::use && element.find("nx") && element.find("ny") && element.find("nz");
        for (std::size_t i = 0; i < (roles.with_normals ? 6 : 3); ++i) {
            const auto place = element.find(names[i]);
            if (!place) fail({origin_.file, element.line, {}}, std::string("the vertices have no ") + names[i]);
            if (element.properties[*place].count_type)
                fail({origin_.file, element.line, {}}, quote(names[i]) + " is a list, not a number");
            roles.of[*place] = i;
        }

        const auto place_of = [&](const char* name) {
            const auto place = element.find(name);
            return place && !element.properties[*place].count_type ? place : std::nullopt;
        };
        const auto uv = std::find_if(uv_names.begin(), uv_names.end(),
                                     [&](const auto& pair) { return place_of(pair[0]) && place_of(pair[1]); });
        roles.with_uvs = uv != uv_names.end();
        if (roles.with_uvs) {
            roles.of[*place_of((*uv)[0])] = PlyVertexRoles::u;
            roles.of[*place_of((*uv)[1])] = PlyVertexRoles::v;
        }

        mesh_.positions.reserve(element.count);
        if (roles.with_normals) mesh_.normals.reserve(element.count);
        if (roles.with_uvs) mesh_.uvs.reserve(element.count);
        const auto read = is_ascii() ? read_ascii_vertices : read_binary_vertices;
        for (std::size_t i = 0; i < element.count;) {
            i += read(data_, element, roles, element.count - i, mesh_);
            if (i < element.count) vertex(element, roles, i++);
        }
        lacks_normals_ = std::find(mesh_.normals.begin(), mesh_.normals.end(), DVec3(0)) != mesh_.normals.end();
    }

    void vertex(const PlyElement& element, const PlyVertexRoles& roles, std::size_t index) {
        std::array<double, PlyVertexRoles::none> values{};
        data_.begin(element, index);
        for (std::size_t p = 0; p < element.properties.size(); ++p)
            if (roles.of[p] != PlyVertexRoles::none) values[roles.of[p]] = data_.next(element.properties[p].type);
            else skip(element.properties[p]);
        mesh_.positions.emplace_back(values[0], values[1], values[2]);
        if (roles.with_normals) mesh_.normals.emplace_back(values[3], values[4], values[5]);
        if (roles.with_uvs) mesh_.uvs.emplace_back(values[PlyVertexRoles::u], values[PlyVertexRoles::v]);
    }

    void faces(const PlyElement& element) {
        const auto place =
            element.find("vertex_indices") ? element.find("vertex_indices") : element.find("vertex_index");
        const Origin header{origin_.file, element.line, {}};
        if (!place || !element.properties[*place].count_type)
            fail(header, "the element " + quote(element.name) + " has no list called \"vertex_indices\"");
        if (mesh_.positions.empty()) fail(header, "there are no vertices");

        const bool is_face = element.name == "face";
        std::optional<PlyFaceLayout> layout;
        if (is_face && !lacks_normals_)  // where normals are missing, each face that uses one is a notice
            layout = PlyFaceLayout::of(element, *place, header_.format, mesh_.positions.size());
        // As many as there are faces, but for a count that cannot be true.
        if (layout) mesh_.triangles.reserve(mesh_.triangles.size() + std::min(element.count, data_.rest().size() / 6));
        for (std::size_t i = 0; i < element.count;) {
            if (layout) i += faces(element, *layout, i);
            if (i == element.count) break;
            data_.begin(element, i++);
            for (std::size_t p = 0; p < element.properties.size(); ++p)
                if (p != *place) skip(element.properties[p]);
                else if (is_face) polygon(element.properties[p]);
                else strips(element.properties[p]);
        }
    }

    /// Those from number `first` on, while nothing is out of the ordinary.
    std::size_t faces(const PlyElement& element, const PlyFaceLayout& layout, std::size_t first) {
        const auto polygon = [&](std::size_t index, std::span<const std::uint32_t> corners) {
            if (cutter_.cut(corners, mesh_)) return;
            data_.begin(element, first + index);
            notices_.add(data_.place(), crossing_polygon);
        };
        const std::size_t count = element.count - first;
        return is_ascii() ? read_ascii_faces(data_, element, layout, count, mesh_, polygon)
                          : read_binary_faces(data_, element, layout, count, mesh_, polygon);
    }

    void polygon(const PlyProperty& property) {
        const double length = data_.next_length(*property.count_type);
        corners_.clear();
        for (double c = 0; c < length; ++c) corners_.push_back(vertex(data_.next(property.type)));
        check_corners();
        if (!cutter_.cut(corners_, mesh_)) notices_.add(data_.place(), crossing_polygon);
    }

    void strips(const PlyProperty& property) {
        const double length = data_.next_length(*property.count_type);
        corners_.clear();
        for (double c = 0; c < length; ++c) {
            const double index = data_.next(property.type);
            if (index != -1) corners_.push_back(vertex(index));
            else strip();
        }
        strip();
    }

    /// Every second triangle of a strip has its corners in reverse. Those that repeat a corner only turn the strip.
    void strip() {
        if (!corners_.empty()) check_corners();
        for (std::size_t i = 2; i < corners_.size(); ++i) {
            const std::uint32_t a = corners_[i - 2], b = corners_[i - 1], c = corners_[i];
            if (a == b || b == c || c == a) continue;
            if (i % 2 == 0) mesh_.triangles.push_back({a, b, c});
            else mesh_.triangles.push_back({b, a, c});
        }
        corners_.clear();
    }

    void check_corners() const {
        if (corners_.size() < 3) data_.error("a face needs at least 3 corners, not " + std::to_string(corners_.size()));
    }

    std::uint32_t vertex(double index) {
        const auto count = static_cast<double>(mesh_.positions.size());
        if (!(index >= 0 && index < count && index == std::floor(index)))
            data_.error("vertex " + shown(index) + " does not exist: there are " +
                        std::to_string(mesh_.positions.size()) + " (counted from 0)");
        const auto result = static_cast<std::uint32_t>(index);
        if (!mesh_.normals.empty() && mesh_.normals[result] == DVec3(0)) notices_.add(data_.place(), guessed_normal);
        return result;
    }

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (std::size_t i = 0; i < element.count; ++i) {
            data_.begin(element, i);
            for (const PlyProperty& p : element.properties) skip(p);
        }
    }

    void skip(const PlyProperty& property) {
        const double values = property.count_type ? data_.next_length(*property.count_type) : 1;
        for (double i = 0; i < values; ++i) data_.skip(property.type);
    }

    bool is_ascii() const { return header_.format == PlyHeader::Format::ascii; }

    PlyHeader header_;
    PlyData data_;
    Origin origin_;
    FileNormals use_;
    std::vector<std::uint32_t> corners_;
    PolygonCutter cutter_;
    Mesh mesh_;
    bool lacks_normals_ = false;
    FileNotices notices_;
};

}  // namespace detail

inline Mesh load_ply(const std::filesystem::path& path, FileNormals normals, Notices* notices) {
    const FileBytes file(path, detail::max_mesh_bytes);
    return detail::PlyReader(detail::without_byte_order_mark(file.view()), path.string(), normals).read(notices);
}

}  // namespace lightswitch
