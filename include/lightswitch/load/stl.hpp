#pragma once

// STL: triangles from computer aided design and for 3D printing, ASCII or binary.

#include <lightswitch/core/file.hpp>
#include <lightswitch/film/bytes.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/number.hpp>

#include <bit>
#include <filesystem>
#include <limits>

namespace lightswitch {

/// Reads an STL file of at most 1 GiB, ASCII or binary (3D Systems, "StereoLithography Interface Specification", 1989).
///
/// It is binary when it has the size that its count of facets asks for, whatever it begins with. Corners with equal
/// coordinates become one vertex (0 and -0 are equal), so that `Mesh::smooth` can make normals of them. The mesh is
/// flat: the file's normals are skipped, whatever the argument says, and the winding says what is the front. The names
/// of solids and the attributes of facets are skipped. All solids become one mesh.
///
/// `notices` gets a line for facets without area, which are dropped.
///
/// Throws `Error` with the line (ASCII) or the number of the facet from 0 (binary) for anything malformed: a file that
/// is shorter or longer than its header says, a number that is not finite, or when there is no facet with an area.
/// Thread safe.
Mesh load_stl(const std::filesystem::path& path, FileNormals normals = FileNormals::use, Notices* notices = nullptr);

namespace detail {

/// Gives equal positions one number: a hash table of numbers, at most half full, that are looked up by position.
class PositionNumbers {
public:
    /// The number of `p` in `positions`, to which it is appended when it is new.
    std::uint32_t of(const DVec3& p, std::vector<DVec3>& positions) {
        if (positions.size() * 2 >= slots_.size()) grow(positions);
        std::uint32_t& slot = find(p, positions);
        if (slot == none) {
            slot = static_cast<std::uint32_t>(positions.size());
            positions.push_back(p);
        }
        return slot;
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    static std::size_t hash(const DVec3& p) {
        std::uint64_t hash = 0;
        for (int c = 0; c < 3; ++c) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[c])) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }

    std::uint32_t& find(const DVec3& p, const std::vector<DVec3>& positions) {
        std::size_t at = hash(p) & (slots_.size() - 1);
        while (slots_[at] != none && positions[slots_[at]] != p) at = (at + 1) & (slots_.size() - 1);
        return slots_[at];
    }

    void grow(const std::vector<DVec3>& positions) {
        slots_.assign(std::max<std::size_t>(1024, slots_.size() * 4), none);
        for (std::size_t i = 0; i < positions.size(); ++i)
            find(positions[i], positions) = static_cast<std::uint32_t>(i);
    }

    std::vector<std::uint32_t> slots_;  ///< a power of two of them
};

class StlReader {
public:
    StlReader(std::string_view bytes, std::string file) : bytes_(bytes), where_{std::move(file), 0, {}} {}

    Mesh read(Notices* notices) {
        if (is_binary()) binary();
        else ascii();
        where_ = {where_.file, 0, {}};
        if (mesh_.triangles.empty()) fail(where_, "contains no facets with an area");
        notices_.report(notices);
        return std::move(mesh_);
    }

private:
    static constexpr std::size_t header_bytes = 84, facet_bytes = 50;

    /// The count of facets alone tells: written as text, its bytes would ask for more than the largest file.
    bool is_binary() const {
        const std::uint64_t size = bytes_.size();
        const std::uint64_t promised = size < header_bytes ? 0 : header_bytes + facet_bytes * std::uint64_t(number(80));
        if (size >= header_bytes && size == promised) return true;
        std::string_view rest = without_byte_order_mark(bytes_);
        const bool has_zeros = bytes_.substr(0, header_bytes).find('\0') != std::string_view::npos;
        if (!has_zeros && lower_case(next_word(rest).substr(0, 5)) == "solid") return false;
        fail(where_, size < header_bytes
                         ? "is not an STL file: it does not begin with \"solid\", and a binary one has 84 bytes or more"
                         : "is not an STL file: it is not text that begins with \"solid\", and a binary one with " +
                               std::to_string(number(80)) + " facets has " + std::to_string(promised) + " bytes, not " +
                               std::to_string(size));
    }

    std::uint32_t number(std::size_t at) const { return get_little_endian<std::uint32_t>(bytes_.data() + at); }

    void binary() {
        const std::size_t count = number(80);
        mesh_.triangles.reserve(count);
        for (std::size_t facet = 0; facet < count; ++facet) {
            std::array<DVec3, 3> corners;
            for (std::size_t i = 0; i < 9; ++i) {
                const float value =
                    std::bit_cast<float>(number(header_bytes + facet_bytes * facet + 4 * (3 + i)));  // after the normal
                if (!is_finite(value)) fail(facet_origin(facet), "a number is not finite");
                corners[i / 3][static_cast<int>(i % 3)] = value;
            }
            if (!add(corners)) notices_.add(facet_origin(facet), no_area);
        }
    }

    Origin facet_origin(std::size_t facet) const { return {where_.file, 0, "facet " + std::to_string(facet)}; }

    void ascii() {
        rest_ = without_byte_order_mark(bytes_);
        where_.line = 1;
        bool in_solid = false;
        for (std::string word = keyword(); !word.empty(); word = keyword()) {
            if (word == (in_solid ? "endsolid" : "solid")) {
                pass(rest_.substr(0, rest_.find_first_of("\r\n")));  // the name
                in_solid = !in_solid;
            } else if (in_solid && word == "facet") {
                facet();
            } else {
                fail(where_, quote(word) + " instead of " + (in_solid ? "\"facet\" or \"endsolid\"" : "\"solid\""));
            }
        }
        if (in_solid) fail(where_, "the file ends too early: \"endsolid\" is missing");
    }

    void facet() {
        const Origin begin = where_;
        expect("normal");
        for (int i = 0; i < 3; ++i)
            if (word().empty()) fail(where_, "the file ends too early");
        expect("outer");
        expect("loop");
        std::array<DVec3, 3> corners;
        for (DVec3& corner : corners) {
            expect("vertex");
            for (int c = 0; c < 3; ++c) {
                const std::string_view text = word();
                const auto value = parse_number_fast(text);
                if (!value)
                    fail(where_, text.empty() ? "the file ends too early" : quote(text) + " is not a finite number");
                corner[c] = *value;
            }
        }
        expect("endloop");
        expect("endfacet");
        if (!add(corners)) notices_.add(begin, no_area);
    }

    void expect(std::string_view wanted) {
        const std::string_view found = word();
        if (found == wanted) return;
        if (found.empty()) fail(where_, "the file ends too early");
        if (lower_case(found) != wanted) fail(where_, quote(found) + " instead of " + quote(wanted));
    }

    std::string keyword() { return lower_case(word()); }

    std::string_view word() {
        std::size_t begin = 0;
        while (begin < rest_.size() && is_space(rest_[begin])) ++begin;
        pass(rest_.substr(0, begin));
        std::size_t end = 0;
        while (end < rest_.size() && !is_space(rest_[end])) ++end;
        const std::string_view result = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return result;
    }

    /// Goes over the beginning of what is left. A line ends with LF, CRLF or CR.
    void pass(std::string_view text) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n' || (text[i] == '\r' && !rest_.substr(i + 1).starts_with('\n'))) ++where_.line;
        rest_.remove_prefix(text.size());
    }

    /// Appends a facet, unless it has no area.
    bool add(std::array<DVec3, 3>& corners) {
        if (glm::cross(corners[1] - corners[0], corners[2] - corners[0]) == DVec3(0)) return false;
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i)
            triangle[i] = numbers_.of(corners[i] + 0.0, mesh_.positions);  // + 0: makes 0 of -0
        mesh_.triangles.push_back(triangle);
        return true;
    }

    static constexpr std::string_view no_area = "the facet has no area and is dropped";

    std::string_view bytes_, rest_;
    Origin where_;
    PositionNumbers numbers_;
    Mesh mesh_;
    FileNotices notices_;
};

}  // namespace detail

inline Mesh load_stl(const std::filesystem::path& path, FileNormals, Notices* notices) {
    const FileBytes file(path, detail::max_mesh_bytes);
    return detail::StlReader(file.view(), path.string()).read(notices);
}

}  // namespace lightswitch
