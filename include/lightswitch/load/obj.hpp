#pragma once

// Wavefront OBJ: triangles and polygons with optional vertex normals.

#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/obj_vertices.hpp>
#include <lightswitch/load/obj_words.hpp>
#include <lightswitch/load/polygon.hpp>
#include <lightswitch/load/text.hpp>
#include <lightswitch/load/text_file.hpp>

#include <filesystem>
#include <map>
#include <set>

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

/// What an OBJ file holds.
struct ObjContents {
    /// A name that the file gives to surfaces or to a file of materials, and the line where it does so first.
    struct Name {
        std::string text;
        int line;
    };
    /// From `first_triangle` on the surface is `materials[material]`.
    struct Use {
        std::size_t first_triangle, material;
    };
    Mesh mesh;
    std::vector<Name> materials, libraries;
    std::vector<Use> uses;
};

class ObjReader {
public:
    /// Materials are passed over unless they are wanted.
    ObjReader(const std::filesystem::path& path, FileNormals use, bool with_materials = false)
        : path_(path), origin_{path.string(), 0, {}}, use_(use), with_materials_(with_materials) {}

    ObjContents read(Notices* notices) {
        TextFile file(path_, max_mesh_bytes);
        std::string_view text = without_byte_order_mark(file.next());
        for (; !text.empty(); text = file.next()) {
            const double pieces_to_come =
                static_cast<double>(file.rest()) / static_cast<double>(std::max(text.size(), std::size_t(1) << 16));
            const Sizes before = sizes();
            read_piece(text);
            make_room(before, pieces_to_come);
        }
        origin_.line = 0;
        if (contents_.mesh.triangles.empty()) fail(origin_, "contains no faces");
        finish_vertices();
        finish_normals(contents_.mesh);
        notices_.report(notices);
        return std::move(contents_);
    }

private:
    void read_piece(std::string_view text) {
        end_ = text.data() + text.size();
        while (!text.empty()) {
            origin_.line += skipped_lines_ + 1;
            skipped_lines_ = 0;
            if (const char* const end = usual_statement(text.data()))
                text.remove_prefix(static_cast<std::size_t>(end - text.data()));
            else statement(next_statement(text));
        }
    }

    using Sizes = std::array<std::size_t, 5>;
    Sizes sizes() const {
        return {positions_.size(), texture_coordinates_.size(), normals_.size(), contents_.mesh.positions.size(),
                contents_.mesh.triangles.size()};
    }

    /// Lets lists that are nearly full have room for the rest of the file, if that goes on like the last piece: growing
    /// by and by would copy them. Room that is not used takes no memory.
    void make_room(const Sizes& before, double pieces_to_come) {
        const auto reserve = [&](auto& list, std::size_t size_before) {
            const std::size_t added = list.size() - size_before;
            if (list.capacity() - list.size() < 2 * added)
                list.reserve(list.size() +
                             static_cast<std::size_t>(1.1 * static_cast<double>(added) * (pieces_to_come + 1)));
        };
        reserve(positions_, before[0]);
        reserve(texture_coordinates_, before[1]);
        reserve(normals_, before[2]);
        reserve(contents_.mesh.positions, before[3]);
        reserve(contents_.mesh.triangles, before[4]);
        vertices_.reserve(contents_.mesh.positions.capacity());
    }

    // --- statements as nearly all are written: read fast, and otherwise left alone

    /// Takes in the line at `text` if it is a `v`, `vn`, `vt` or `f` without anything special, and returns where the
    /// next one begins; otherwise null, and `statement` has the word.
    const char* usual_statement(const char* text) {
        if (text[0] == 'f') return is_blank(text[1]) ? usual_face(text + 2) : nullptr;
        if (text[0] != 'v') return nullptr;
        DVec3 numbers;
        const char* end = nullptr;
        if (is_blank(text[1])) {
            if ((end = read_usual_vector(text + 2, end_, 3, 7, numbers))) positions_.push_back(numbers);
        } else if (text[1] == 'n' && is_blank(text[2])) {
            if ((end = read_usual_vector(text + 3, end_, 3, 3, numbers))) normals_.push_back(numbers);
        } else if (text[1] == 't' && is_blank(text[2])) {
            if ((end = read_usual_vector(text + 3, end_, 1, 3, numbers)))
                texture_coordinates_.emplace_back(numbers.x, numbers.y);
        }
        return end;
    }

    const char* usual_face(const char* text) {
        corners_.clear();
        while (true) {
            while (is_blank(*text)) ++text;
            if (is_line_end(*text)) break;
            ObjCorner corner;
            text = read_usual_index(text, positions_.size(), corner.position);
            if (text != nullptr && *text == '/' && *++text != '/')
                text = read_usual_index(text, texture_coordinates_.size(), corner.uv);
            if (text != nullptr && *text == '/') text = read_usual_index(text + 1, normals_.size(), corner.normal);
            if (text == nullptr || !(is_blank(*text) || is_line_end(*text))) return nullptr;
            corners_.push_back(vertex(corner));
        }
        if (corners_.size() < 3) return nullptr;
        add_polygon();
        return after_line_end(text);
    }

    // --- statements of all kinds

    /// Cuts one line off `text`, without its comment, together with the lines that it continues on.
    std::string_view next_statement(std::string_view& text) {
        joined_.clear();
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
        } else if (with_materials_ && keyword == "usemtl") {
            use_material(line);
        } else if (with_materials_ && keyword == "mtllib") {
            if (library_names_.emplace(trimmed(line)).second)
                contents_.libraries.push_back({std::string(trimmed(line)), origin_.line});
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
            const double number = finite_number(word, origin_);
            if (count < 3) result[count] = number;
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
        add_polygon();
    }

    void add_polygon() {
        if (!cutter_.cut(corners_, contents_.mesh)) notices_.add(origin_, crossing_polygon);
    }

    std::uint32_t corner(std::string_view word) {
        static constexpr std::array<const char*, 3> names{"vertex", "texture coordinate", "normal"};
        const std::array<std::size_t, 3> sizes{positions_.size(), texture_coordinates_.size(), normals_.size()};
        ObjCorner key;
        std::uint32_t* const parts[] = {&key.position, &key.uv, &key.normal};
        std::string_view rest = word;
        for (std::size_t i = 0;; ++i) {
            const std::size_t slash = rest.find('/');
            const std::string_view part = rest.substr(0, slash);
            if (i == 3 || (i == 0 && part.empty()))
                fail(origin_, quote(word) + " is not a corner (v, v/vt, v//vn or v/vt/vn)");
            if (!part.empty()) *parts[i] = index(part, sizes[i], names[i]);
            if (slash == std::string_view::npos) break;
            rest.remove_prefix(slash + 1);
        }
        return vertex(key);
    }

    std::uint32_t index(std::string_view word, std::size_t size, const char* what) {
        const auto number = parse_integer(word);
        if (!number) fail(origin_, quote(word) + " is not an index");
        const auto count = static_cast<std::int64_t>(size);
        if (*number == 0 || *number > count || *number < -count)
            fail(origin_, std::string(what) + " " + std::to_string(*number) + " does not exist: " +
                              std::to_string(count) + (count == 1 ? " is" : " are") + " defined above");
        return static_cast<std::uint32_t>(*number > 0 ? *number - 1 : count + *number);
    }

    void use_material(std::string_view line) {
        const auto [entry, is_new] =
            material_numbers_.try_emplace(std::string(trimmed(line)), material_numbers_.size());
        if (is_new) contents_.materials.push_back({entry->first, origin_.line});
        const ObjContents::Use use{contents_.mesh.triangles.size(), entry->second};
        auto& uses = contents_.uses;
        if (!uses.empty() && uses.back().first_triangle == use.first_triangle) uses.back() = use;
        else if (uses.empty() || uses.back().material != use.material) uses.push_back(use);
    }

    /// The number of the mesh's vertex for a corner, which is made when it comes up first.
    [[gnu::always_inline]] std::uint32_t vertex(ObjCorner corner) {
        if (use_ == FileNormals::ignore) corner.normal = ObjCorner::none;
        const auto [number, is_new] = vertices_.number(corner, positions_.size());
        if (is_new) {
            const bool has_normal = corner.normal != ObjCorner::none && normals_[corner.normal] != DVec3(0);
            if (!has_normal && line_without_normal_ == 0) line_without_normal_ = origin_.line;
            contents_.mesh.positions.push_back(positions_[corner.position]);
        }
        return number;
    }

    /// Gives the vertices their normals and texture coordinates, and gives back memory as soon as it can.
    void finish_vertices() {
        Mesh& mesh = contents_.mesh;
        positions_ = {};
        vertices_.finish_numbers();
        vertices_.gather(texture_coordinates_, &ObjVertices::Vertex::uv, mesh.uvs);
        texture_coordinates_ = {};
        vertices_.gather(normals_, &ObjVertices::Vertex::normal, mesh.normals);
        normals_ = {};
        vertices_ = {};
        const auto missing = std::count(mesh.normals.begin(), mesh.normals.end(), DVec3(0));
        notices_.add({origin_.file, line_without_normal_, {}}, guessed_normal, static_cast<std::size_t>(missing));
    }

    /// In nearly every file, and without meaning for a mesh.
    static constexpr std::array<std::string_view, 5> meaningless{"o", "g", "s", "usemtl", "mtllib"};
    static constexpr auto skipped = std::to_array<std::string_view>(
        {"p",     "l",        "vp",       "cstype", "deg",  "bmat", "step",       "curv",     "curv2",
         "surf",  "parm",     "trim",     "hole",   "scrv", "sp",   "end",        "con",      "mg",
         "bevel", "lod",      "usemap",   "maplib", "call", "csh",  "ctech",      "stech",    "bsp",
         "bzp",   "c_interp", "d_interp", "cdc",    "cdp",  "res",  "shadow_obj", "trace_obj"});

    std::filesystem::path path_;
    Origin origin_;
    FileNormals use_;
    bool with_materials_;
    const char* end_ = nullptr;  ///< of the piece that is being read
    std::string joined_;
    int skipped_lines_ = 0;
    std::vector<DVec3> positions_, normals_;
    std::vector<Vec2> texture_coordinates_;
    ObjVertices vertices_;
    int line_without_normal_ = 0;
    std::vector<std::uint32_t> corners_;
    std::map<std::string, std::size_t, std::less<>> material_numbers_;
    std::set<std::string, std::less<>> library_names_;
    PolygonCutter cutter_;
    ObjContents contents_;
    FileNotices notices_;
};

}  // namespace detail

inline Mesh load_obj(const std::filesystem::path& path, FileNormals normals, Notices* notices) {
    return detail::ObjReader(path, normals).read(notices).mesh;
}

}  // namespace lightswitch
