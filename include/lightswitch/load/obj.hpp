#pragma once

// Wavefront OBJ: triangles and polygons with optional vertex normals.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/polygon.hpp>
#include <lightswitch/load/text.hpp>

#include <filesystem>
#include <unordered_map>

namespace lightswitch {

/// Reads a Wavefront OBJ file of at most 1 GiB, in double precision.
///
/// Convex polygons become fans around their first corner, others are cut into triangles that cover the same area.
/// Corners are one vertex when they agree in position, texture coordinate and normal, so that normals computed by
/// `Mesh::smooth` keep an edge where the texture has a seam (as in Mitsuba 3.9); with `FileNormals::ignore`, when they
/// agree in position and texture coordinate. Corners without a texture coordinate get (0, 0) when others have one.
/// Where the file's normals point is the front; where a corner has none, or one of length 0, while others have, it gets
/// what `Mesh::smooth` computes. Groups, materials and vertex colours are skipped.
///
/// `notices` gets a line for each kind of other statement that is skipped, such as `l` and `curv`, for polygons that
/// cross themselves and for normals that are computed because they are missing.
///
/// Throws `Error` with the line for anything malformed, an index out of range, or a statement that OBJ does not have,
/// and when there is no face. Thread safe.
Mesh load_obj(const std::filesystem::path& path, FileNormals normals = FileNormals::use, Notices* notices = nullptr);

namespace detail {

class ObjReader {
public:
    ObjReader(const std::filesystem::path& path, FileNormals use) : origin_{path.string(), 0, {}}, use_(use) {}

    Mesh read(std::string_view text, Notices* notices) {
        text = without_byte_order_mark(text);
        while (!text.empty()) statement(next_statement(text));
        origin_.line = 0;
        if (mesh_.triangles.empty()) fail(origin_, "contains no faces");
        if (!mesh_.normals.empty()) mesh_.normals.resize(mesh_.positions.size(), DVec3(0));
        if (!mesh_.uvs.empty()) mesh_.uvs.resize(mesh_.positions.size(), Vec2(0));
        for (std::size_t v = 0; v < mesh_.normals.size(); ++v)
            if (mesh_.normals[v] == DVec3(0)) {
                origin_.line = lines_[v];
                notices_.add(origin_, guessed_normal);
            }
        finish_normals(mesh_);
        notices_.report(notices);
        return std::move(mesh_);
    }

private:
    /// Index from 0 into the lists of positions, texture coordinates and normals; -1 for none.
    using Corner = std::array<std::int64_t, 3>;
    struct CornerHash {
        std::size_t operator()(const Corner& corner) const {
            std::uint64_t hash = 0;
            for (const std::int64_t index : corner) {
                hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15u;
                hash ^= hash >> 29;
            }
            return static_cast<std::size_t>(hash);
        }
    };

    /// Cuts one line off `text`, without its comment, together with the lines that it continues on.
    std::string_view next_statement(std::string_view& text) {
        joined_.clear();
        origin_.line += skipped_lines_ + 1;
        skipped_lines_ = 0;
        while (true) {
            std::string_view line = next_line(text);
            line = line.substr(0, line.find('#'));
            line = line.substr(0, line.find_last_not_of(" \t") + 1);
            const bool continues = line.ends_with('\\');
            if (continues) line.remove_suffix(1);
            if (!continues && joined_.empty()) return line;
            joined_.append(line).append(1, ' ');
            if (!continues || text.empty()) return joined_;
            ++skipped_lines_;
        }
    }

    void statement(std::string_view line) {
        const std::string_view keyword = next_word(line);
        if (keyword.empty()) return;
        if (keyword == "v") {
            positions_.push_back(vector(line, keyword, 3, 7));
        } else if (keyword == "vn") {
            normals_.push_back(vector(line, keyword, 3, 3));
        } else if (keyword == "vt") {
            const DVec3 uv = vector(line, keyword, 1, 3);
            texture_coordinates_.emplace_back(uv.x, uv.y);
        } else if (keyword == "f" || keyword == "fo") {  // the same in old files
            face(line);
        } else if (std::find(skipped.begin(), skipped.end(), keyword) != skipped.end()) {
            notices_.add(origin_, "the statement " + quote(keyword) + " is skipped");
        } else if (std::find(meaningless.begin(), meaningless.end(), keyword) == meaningless.end()) {
            fail(origin_, "unknown statement " + quote(keyword));
        }
    }

    DVec3 vector(std::string_view line, std::string_view keyword, int fewest, int most) {
        DVec3 result(0);
        int count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
            const auto number = parse_number(word);
            if (!number) fail(origin_, quote(word) + " is not a finite number");
            if (count < 3) result[count] = *number;
        }
        if (count < fewest || count > most)
            fail(origin_, quote(keyword) + " takes " + std::to_string(fewest) +
                              (most > fewest ? " to " + std::to_string(most) : std::string()) + " numbers, not " +
                              std::to_string(count));
        return result;
    }

    void face(std::string_view line) {
        corners_.clear();
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
            corners_.push_back(corner(word));
        if (corners_.size() < 3)
            fail(origin_, "a face needs at least 3 corners, not " + std::to_string(corners_.size()));
        if (!cutter_.cut(corners_, mesh_)) notices_.add(origin_, crossing_polygon);
    }

    std::uint32_t corner(std::string_view word) {
        static constexpr std::array<const char*, 3> names{"vertex", "texture coordinate", "normal"};
        const std::array<std::size_t, 3> sizes{positions_.size(), texture_coordinates_.size(), normals_.size()};
        Corner key{-1, -1, -1};
        std::string_view rest = word;
        for (std::size_t i = 0;; ++i) {
            const std::size_t slash = rest.find('/');
            const std::string_view part = rest.substr(0, slash);
            if (i == 3 || (i == 0 && part.empty()))
                fail(origin_, quote(word) + " is not a corner (v, v/vt, v//vn or v/vt/vn)");
            if (!part.empty()) key[i] = index(part, sizes[i], names[i]);
            if (slash == std::string_view::npos) break;
            rest.remove_prefix(slash + 1);
        }
        if (use_ == FileNormals::ignore) key[2] = -1;
        return vertex(key);
    }

    std::int64_t index(std::string_view word, std::size_t size, const char* what) {
        const auto number = parse_integer(word);
        if (!number) fail(origin_, quote(word) + " is not an index");
        const auto count = static_cast<std::int64_t>(size);
        if (*number == 0 || *number > count || *number < -count)
            fail(origin_, std::string(what) + " " + std::to_string(*number) + " does not exist: " +
                              std::to_string(count) + (count == 1 ? " is" : " are") + " defined above");
        return *number > 0 ? *number - 1 : count + *number;
    }

    std::uint32_t vertex(const Corner& key) {
        const auto [entry, is_new] = vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (!is_new) return entry->second;

        if (key[2] >= 0) {
            mesh_.normals.resize(mesh_.positions.size(), DVec3(0));
            mesh_.normals.push_back(normals_[static_cast<std::size_t>(key[2])]);
        }
        if (key[1] >= 0) {
            mesh_.uvs.resize(mesh_.positions.size(), Vec2(0));
            mesh_.uvs.push_back(texture_coordinates_[static_cast<std::size_t>(key[1])]);
        }
        mesh_.positions.push_back(positions_[static_cast<std::size_t>(key[0])]);
        lines_.push_back(origin_.line);
        return entry->second;
    }

    /// In nearly every file, and without meaning here.
    static constexpr std::array<std::string_view, 5> meaningless{"o", "g", "s", "usemtl", "mtllib"};
    static constexpr auto skipped = std::to_array<std::string_view>(
        {"p",     "l",        "vp",       "cstype", "deg",  "bmat", "step",       "curv",     "curv2",
         "surf",  "parm",     "trim",     "hole",   "scrv", "sp",   "end",        "con",      "mg",
         "bevel", "lod",      "usemap",   "maplib", "call", "csh",  "ctech",      "stech",    "bsp",
         "bzp",   "c_interp", "d_interp", "cdc",    "cdp",  "res",  "shadow_obj", "trace_obj"});

    Origin origin_;
    FileNormals use_;
    std::string joined_;
    int skipped_lines_ = 0;
    std::vector<DVec3> positions_, normals_;
    std::vector<Vec2> texture_coordinates_;
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
    std::vector<std::uint32_t> corners_;
    PolygonCutter cutter_;
    Mesh mesh_;
    std::vector<int> lines_;  ///< where each of the mesh's positions is first used
    FileNotices notices_;
};

}  // namespace detail

inline Mesh load_obj(const std::filesystem::path& path, FileNormals normals, Notices* notices) {
    const std::string text = read_file(path, detail::max_mesh_bytes);
    return detail::ObjReader(path, normals).read(text, notices);
}

}  // namespace lightswitch
