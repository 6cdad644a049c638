#pragma once

// The header of a PLY file: which elements follow, how many, and how they are stored (Turk, "The PLY Polygon File
// Format", 1994).

#include <lightswitch/core/error.hpp>
#include <lightswitch/load/text.hpp>

#include <array>

namespace lightswitch::detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline constexpr std::array<std::size_t, 8> ply_type_bytes{1, 1, 2, 2, 4, 4, 4, 8};

struct PlyProperty {
    std::string name;
    PlyType type{};
    std::optional<PlyType> count_type;  ///< set for a list: the type of its length
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    int line = 0;

    /// Place of the property in the element, if there is one.
    std::optional<std::size_t> find(std::string_view property) const {
        for (std::size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == property) return i;
        return {};
    }
};

struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian };

    Format format = Format::ascii;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0;  ///< length of the header, so where the data begin
    int lines = 0;
    char line_end = '\n';  ///< '\r' in files of old Macintosh programs
};

class PlyHeaderReader {
public:
    explicit PlyHeaderReader(std::string file) : origin_{std::move(file), 0, {}} {}

    PlyHeader read(std::string_view text) {
        // Only the first line can tell: after the last one, any byte may be the first of the data.
        if (const std::size_t end = text.find_first_of("\r\n"); end != std::string_view::npos)
            header_.line_end = text.substr(end, 2) == "\r\n" ? '\n' : text[end];
        bool has_format = false;
        for (bool ended = false; !ended;) {
            ++origin_.line;
            const std::size_t end = text.find(header_.line_end, header_.bytes);
            if (end == std::string_view::npos)
                fail(origin_, origin_.line == 1 ? "is not a PLY file: it does not begin with \"ply\""
                                                : "the file ends within the header: \"end_header\" is missing");
            std::string_view line = text.substr(header_.bytes, end - header_.bytes);
            header_.bytes = end + 1;
            const std::string_view keyword = next_word(line);
            if (origin_.line == 1) {
                if (keyword != "ply") fail(origin_, "is not a PLY file: it does not begin with \"ply\"");
            } else if (keyword == "format") {
                if (has_format) fail(origin_, "the format is given twice");
                format(line);
                has_format = true;
            } else if (keyword == "element") {
                element(line);
            } else if (keyword == "property") {
                property(line);
            } else if (keyword == "end_header") {
                ended = true;
            } else if (keyword != "comment" && keyword != "obj_info") {
                fail(origin_, "unknown statement " + quote(keyword) + " in the header");
            }
            const bool free_text = keyword == "comment" || keyword == "obj_info";
            if (const auto excess = next_word(line); !free_text && !excess.empty())
                fail(origin_, "unexpected " + quote(excess) + " at the end of the line");
        }
        if (!has_format) fail(origin_, "the header names no format");
        header_.lines = origin_.line;
        return std::move(header_);
    }

private:
    void format(std::string_view& line) {
        const std::string_view name = next_word(line);
        if (name == "ascii") header_.format = PlyHeader::Format::ascii;
        else if (name == "binary_little_endian") header_.format = PlyHeader::Format::little_endian;
        else if (name == "binary_big_endian") header_.format = PlyHeader::Format::big_endian;
        else fail(origin_, quote(name) + " is not a PLY format");
        if (const auto version = next_word(line); version != "1.0")
            fail(origin_, "the format's version is " + quote(version) + ", but only \"1.0\" is known");
    }

    void element(std::string_view& line) {
        const std::string name(next_word(line));
        const std::string_view word = next_word(line);
        const auto count = parse_integer(word);
        if (name.empty() || !count || *count < 0)
            fail(origin_, "an element needs a name and a count, and " + quote(word) + " is no count");
        for (const PlyElement& other : header_.elements)
            if (other.name == name) fail(origin_, "the element " + quote(name) + " is given twice");
        if (header_.elements.size() == 256) fail(origin_, "more than 256 elements");
        header_.elements.push_back({name, static_cast<std::size_t>(*count), {}, origin_.line});
    }

    void property(std::string_view& line) {
        if (header_.elements.empty()) fail(origin_, "a property before any element");
        PlyElement& owner = header_.elements.back();
        PlyProperty result;
        std::string_view word = next_word(line);
        if (word == "list") {
            result.count_type = type(next_word(line));
            word = next_word(line);
        }
        result.type = type(word);
        result.name = next_word(line);
        if (result.name.empty()) fail(origin_, "the property has no name");
        if (owner.find(result.name)) fail(origin_, "the property " + quote(result.name) + " is given twice");
        if (owner.properties.size() == 256) fail(origin_, "more than 256 properties");
        owner.properties.push_back(std::move(result));
    }

    PlyType type(std::string_view name) {
        static constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                               {"uchar", "uint8"},
                                                                               {"short", "int16"},
                                                                               {"ushort", "uint16"},
                                                                               {"int", "int32"},
                                                                               {"uint", "uint32"},
                                                                               {"float", "float32"},
                                                                               {"double", "float64"}}};
        for (std::size_t i = 0; i < names.size(); ++i)
            if (name == names[i][0] || name == names[i][1]) return static_cast<PlyType>(i);
        fail(origin_, quote(name) + " is not a PLY type");
    }

    Origin origin_;
    PlyHeader header_;
};

}  // namespace lightswitch::detail
