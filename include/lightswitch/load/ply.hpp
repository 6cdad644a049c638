#pragma once

// PLY: triangles and polygons with optional vertex normals, ASCII or binary.

#include <lightswitch/film/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/ply_header.hpp>

#include <filesystem>

namespace lightswitch {

/// Reads a PLY file of at most 1 GiB: ASCII, or binary with either byte order.
///
/// The element `vertex` gives x, y, z and perhaps nx, ny, nz, in any scalar type; the element `face` gives the list
/// `vertex_indices` or `vertex_index`. Polygons become fans around their first corner. Where the file's normals point
/// is the front. Everything else in the file is skipped.
///
/// Throws `Error` with the line (ASCII) or the number of the element from 0 (binary) for anything malformed: a file
/// that is shorter or longer than its header says, a number that is not finite, an index out of range, a normal of
/// length 0 in use, or when there is no face. Thread safe.
Mesh load_ply(const std::filesystem::path& path, FileNormals normals = FileNormals::use);

namespace detail {

/// The values after the header, in the order in which they stand.
class PlyData {
public:
    PlyData(std::string_view bytes, const PlyHeader& header, std::string file)
        : rest_(bytes.substr(header.bytes)), format_(header.format), line_(header.lines + 1), file_(std::move(file)) {}

    /// Names the element that is read next, for errors.
    void begin(const PlyElement& element, std::size_t index) {
        element_ = &element;
        index_ = index;
    }

    /// The next value, which is finite and fits its type.
    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word_as(type) : next_binary(type); }
    /// Passes over the next value, whatever it is.
    void skip(PlyType type) {
        if (format_ == PlyHeader::Format::ascii) next_word_of_file();
        else take(type);
    }

    /// Refuses a count that the rest of the file cannot hold, before memory is spent on it.
    void check_count(const PlyElement& element) {
        const bool ascii = format_ == PlyHeader::Format::ascii;
        std::size_t least = 0;
        for (const PlyProperty& p : element.properties)
            least += ascii ? 2 : ply_type_bytes[static_cast<std::size_t>(p.count_type.value_or(p.type))];
        // One more byte: the last word of an ASCII file needs no separator after it.
        if (least > 0 && element.count > (rest_.size() + 1) / least)
            fail({file_, element.line, {}}, std::to_string(element.count) + " of the element " + quote(element.name) +
                                                " cannot be in the " + std::to_string(rest_.size()) +
                                                " bytes that follow");
    }

    void check_end() {
        element_ = nullptr;
        if (format_ == PlyHeader::Format::ascii && word().empty()) return;
        if (format_ != PlyHeader::Format::ascii && rest_.empty()) return;
        error("the file goes on after its last element");
    }

    [[noreturn]] void error(const std::string& what) const {
        const bool ascii = format_ == PlyHeader::Format::ascii;
        fail({file_, ascii ? line_ : 0, {}},
             element_ == nullptr ? what : element_->name + " " + std::to_string(index_) + ": " + what);
    }

private:
    std::string_view word() {
        const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
        line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
        return next_word(rest_);
    }

    std::string_view next_word_of_file() {
        const std::string_view text = word();
        if (text.empty()) error("the file ends too early");
        return text;
    }

    double next_word_as(PlyType type) {
        static constexpr std::array<std::array<double, 2>, 6> ranges{
            {{-128, 127}, {0, 255}, {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647.0}, {0, 4294967295.0}}};
        const std::string_view text = next_word_of_file();
        if (type >= PlyType::float32) {
            const auto number = parse_number(text);
            if (!number) error(quote(text) + " is not a finite number");
            return *number;
        }
        const auto integer = parse_integer(text);
        if (!integer) error(quote(text) + " is not an integer");
        const auto number = static_cast<double>(*integer);
        const auto& [lowest, highest] = ranges[static_cast<std::size_t>(type)];
        if (number < lowest || number > highest) error(quote(text) + " does not fit the type that the header gives");
        return number;
    }

    /// The bytes of the next value as a number, the most significant first.
    std::uint64_t take(PlyType type) {
        const std::size_t size = ply_type_bytes[static_cast<std::size_t>(type)];
        if (rest_.size() < size) error("the file ends too early");
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t at = format_ == PlyHeader::Format::little_endian ? size - 1 - i : i;
            bits = bits << 8 | static_cast<unsigned char>(rest_[at]);
        }
        rest_.remove_prefix(size);
        return bits;
    }

    double next_binary(PlyType type) {
        const std::uint64_t bits = take(type);
        switch (type) {
            case PlyType::int8: return static_cast<std::int8_t>(bits);
            case PlyType::int16: return static_cast<std::int16_t>(bits);
            case PlyType::int32: return static_cast<std::int32_t>(bits);
            case PlyType::uint8:
            case PlyType::uint16:
            case PlyType::uint32: return static_cast<double>(bits);
            case PlyType::float32: {
                const float value = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
                if (!lightswitch::is_finite(value)) error("a number is not finite");
                return value;
            }
            case PlyType::float64: break;
        }
        const double value = std::bit_cast<double>(bits);
        if (!has_finite_bits(value)) error("a number is not finite");
        return value;
    }

    std::string_view rest_;
    PlyHeader::Format format_;
    int line_;
    std::string file_;
    const PlyElement* element_ = nullptr;
    std::size_t index_ = 0;
};

class PlyReader {
public:
    PlyReader(std::string_view bytes, std::string file, FileNormals use)
        : header_(PlyHeaderReader(file).read(bytes)),
          data_(bytes, header_, file),
          origin_{std::move(file), 0, {}},
          use_(use) {}

    Mesh read() {
        for (const PlyElement& element : header_.elements) {
            data_.check_count(element);
            if (element.name == "vertex") vertices(element);
            else if (element.name == "face") faces(element);
            else skip(element);
        }
        data_.check_end();
        if (mesh_.triangles.empty()) fail(origin_, "contains no faces");
        mesh_.face_along_normals();
        return std::move(mesh_);
    }

private:
    void vertices(const PlyElement& element) {
        static constexpr std::array<const char*, 6> names{"x", "y", "z", "nx", "ny", "nz"};
        std::vector<std::size_t> roles(element.properties.size(), names.size());
        const bool with_normals =
            use_ == FileNormals::use && element.find("nx") && element.find("ny") && element.find("nz");
        for (std::size_t i = 0; i < (with_normals ? 6 : 3); ++i) {
            const auto place = element.find(names[i]);
            if (!place) fail({origin_.file, element.line, {}}, std::string("the vertices have no ") + names[i]);
            if (element.properties[*place].count_type)
                fail({origin_.file, element.line, {}}, quote(names[i]) + " is a list, not a number");
            roles[*place] = i;
        }

        mesh_.positions.reserve(element.count);
        if (with_normals) mesh_.normals.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            std::array<double, 6> values{};
            data_.begin(element, i);
            for (std::size_t p = 0; p < element.properties.size(); ++p)
                if (roles[p] < names.size()) values[roles[p]] = data_.next(element.properties[p].type);
                else skip(element.properties[p]);
            mesh_.positions.emplace_back(values[0], values[1], values[2]);
            if (with_normals) mesh_.normals.emplace_back(values[3], values[4], values[5]);
        }
    }

    void faces(const PlyElement& element) {
        const auto place =
            element.find("vertex_indices") ? element.find("vertex_indices") : element.find("vertex_index");
        if (!place || !element.properties[*place].count_type || element.properties[*place].type >= PlyType::float32)
            fail({origin_.file, element.line, {}}, "the faces have no list of integers called \"vertex_indices\"");
        if (mesh_.positions.empty()) fail({origin_.file, element.line, {}}, "there are no vertices before the faces");

        std::vector<bool> used(mesh_.positions.size(), false);
        for (std::size_t i = 0; i < element.count; ++i) {
            data_.begin(element, i);
            for (std::size_t p = 0; p < element.properties.size(); ++p)
                if (p == *place) polygon(element.properties[p], used);
                else skip(element.properties[p]);
        }
        // A normal of length 0 is common where no face uses the vertex; any direction will do there.
        for (std::size_t v = 0; v < mesh_.normals.size(); ++v)
            if (!used[v]) mesh_.normals[v] = DVec3(1, 0, 0);
    }

    void polygon(const PlyProperty& property, std::vector<bool>& used) {
        const double corners = data_.next(*property.count_type);
        if (corners < 3)
            data_.error("a face needs at least 3 corners, not " + std::to_string(static_cast<int>(corners)));
        std::array<std::uint32_t, 3> triangle{};
        for (double c = 0; c < corners; ++c) {
            const double index = data_.next(property.type);
            if (index < 0 || index >= static_cast<double>(mesh_.positions.size()))
                data_.error("vertex " + std::to_string(static_cast<std::int64_t>(index)) +
                            " does not exist: there are " + std::to_string(mesh_.positions.size()) +
                            " (counted from 0)");
            const auto vertex = static_cast<std::uint32_t>(index);
            if (!mesh_.normals.empty() && mesh_.normals[vertex] == DVec3(0))
                data_.error("the normal of vertex " + std::to_string(vertex) + " has no direction");
            used[vertex] = true;
            if (c >= 2) {
                triangle[2] = vertex;
                mesh_.triangles.push_back(triangle);
            }
            triangle[c == 0 ? 0 : 1] = vertex;
        }
    }

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (std::size_t i = 0; i < element.count; ++i) {
            data_.begin(element, i);
            for (const PlyProperty& p : element.properties) skip(p);
        }
    }

    void skip(const PlyProperty& property) {
        const double values = property.count_type ? data_.next(*property.count_type) : 1;
        if (values < 0) data_.error("a list has a negative length");
        for (double i = 0; i < values; ++i) data_.skip(property.type);
    }

    PlyHeader header_;
    PlyData data_;
    Origin origin_;
    FileNormals use_;
    Mesh mesh_;
};

}  // namespace detail

inline Mesh load_ply(const std::filesystem::path& path, FileNormals normals) {
    const std::string bytes = read_file(path, detail::max_mesh_bytes);
    return detail::PlyReader(bytes, path.string(), normals).read();
}

}  // namespace lightswitch
