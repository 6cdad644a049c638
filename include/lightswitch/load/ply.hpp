#pragma once

// PLY: triangles and polygons with optional vertex normals, ASCII or binary.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/ply_header.hpp>
#include <lightswitch/load/polygon.hpp>

#include <filesystem>

namespace lightswitch {

/// Reads a PLY file of at most 1 GiB: ASCII, or binary with either byte order.
///
/// The element `vertex` gives x, y, z and perhaps nx, ny, nz; the elements `face` and `tristrips`, before or after it,
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

/// The values after the header, in the order in which they stand.
class PlyData {
public:
    PlyData(std::string_view bytes, const PlyHeader& header, std::string file)
        : rest_(bytes.substr(header.bytes)),
          format_(header.format),
          line_end_(header.line_end),
          line_(header.lines + 1),
          file_(std::move(file)) {}

    /// Names the element that is read next, for errors.
    void begin(const PlyElement& element, std::size_t index) {
        element_ = &element;
        index_ = index;
    }

    /// The next value, which is finite and fits its type.
    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word_as(type) : next_binary(type); }
    /// The length of the list that is next.
    double next_length(PlyType type) {
        const double length = next(type);
        if (length < 0 || length != std::floor(length)) error("a list cannot have the length " + shown(length));
        return length;
    }
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

    /// The element that is being read.
    Origin place() const {
        const bool ascii = format_ == PlyHeader::Format::ascii;
        return {file_, ascii ? line_ : 0, element_ == nullptr ? "" : element_->name + " " + std::to_string(index_)};
    }
    [[noreturn]] void error(const std::string& what) const { fail(place(), what); }

private:
    std::string_view word() {
        const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
        line_ +=
            static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(begin), line_end_));
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
        if (!is_finite(value)) error("a number is not finite");
        return value;
    }

    std::string_view rest_;
    PlyHeader::Format format_;
    char line_end_;
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
        const Origin header{origin_.file, element.line, {}};
        if (!place || !element.properties[*place].count_type)
            fail(header, "the element " + quote(element.name) + " has no list called \"vertex_indices\"");
        if (mesh_.positions.empty()) fail(header, "there are no vertices");

        for (std::size_t i = 0; i < element.count; ++i) {
            data_.begin(element, i);
            for (std::size_t p = 0; p < element.properties.size(); ++p)
                if (p != *place) skip(element.properties[p]);
                else if (element.name == "face") polygon(element.properties[p]);
                else strips(element.properties[p]);
        }
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

    PlyHeader header_;
    PlyData data_;
    Origin origin_;
    FileNormals use_;
    std::vector<std::uint32_t> corners_;
    PolygonCutter cutter_;
    Mesh mesh_;
    FileNotices notices_;
};

}  // namespace detail

inline Mesh load_ply(const std::filesystem::path& path, FileNormals normals, Notices* notices) {
    const std::string bytes = read_file(path, detail::max_mesh_bytes);
    return detail::PlyReader(detail::without_byte_order_mark(bytes), path.string(), normals).read(notices);
}

}  // namespace lightswitch
