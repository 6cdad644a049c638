#pragma once

// The common layouts of PLY files, in loops that only go on: whatever is out of the ordinary, wrong above all, is left
// for `PlyData`, which reads any file and says what is wrong with it.

#include <lightswitch/load/number.hpp>
#include <lightswitch/load/ply_data.hpp>
#include <lightswitch/scene/mesh.hpp>

#include <cstring>
#include <span>

namespace lightswitch::detail {

template <class T>
T reversed_bytes(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
}

template <class T, bool reversed>
T load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return reversed ? reversed_bytes(value) : value;
}

/// Calls `f` with the type of that number as a tag and whether its bytes must be reversed; returns 0 for other types.
template <class... T>
std::size_t with_type(PlyType type, PlyHeader::Format format, const auto& f) {
    const bool reversed = (format == PlyHeader::Format::little_endian) != (std::endian::native == std::endian::little);
    const auto known = []<class Number>(PlyType of) {
        if constexpr (std::is_same_v<Number, float>) return of == PlyType::float32;
        else if constexpr (std::is_same_v<Number, double>) return of == PlyType::float64;
        else if constexpr (sizeof(Number) == 1) return of == PlyType::uint8;
        else return of == PlyType::uint32 || of == PlyType::int32;  // negative ones are too large
    };
    std::size_t result = 0;
    const auto call = [&]<class Number>() {
        if (!known.template operator()<Number>(type)) return false;
        result = reversed ? f(Number(), std::true_type()) : f(Number(), std::false_type());
        return true;
    };
    (void)(call.template operator()<T>() || ...);
    return result;
}

/// Which property of a vertex is what.
struct PlyVertexRoles {
    static constexpr std::size_t u = 6, v = 7, none = 8;
    std::vector<std::size_t> of;  ///< by property: 0 to 2 for the position, 3 to 5 for the normal, u, v or none
    bool with_normals = false, with_uvs = false;
};

/// Appends the values of `count` elements with `stride` bytes each, at `offsets` in them, while they are finite.
/// Returns of how many.
template <std::size_t n, class Vector>
std::size_t gather(const char* bytes, std::size_t stride, const std::array<std::size_t, n>& offsets, PlyType type,
                   PlyHeader::Format format, std::size_t count, std::vector<Vector>& result) {
    return with_type<float, double>(type, format, [&]<class T, bool reversed>(T, std::bool_constant<reversed>) {
        std::array<Vector, 256> block;
        bool finite = true;
        const std::size_t used = std::min(count, block.size());
        for (std::size_t i = 0; i < used; ++i)
            for (std::size_t c = 0; c < n; ++c) {
                const T value = load<T, reversed>(bytes + i * stride + offsets[c]);
                finite = finite & is_finite(value);
                block[i][static_cast<int>(c)] = static_cast<typename Vector::value_type>(value);
            }
        if (!finite) return std::size_t(0);
        result.insert(result.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(used));
        return used;
    });
}

/// Reads vertices of a binary file, up to `count`, while position, normal and texture coordinates each are numbers of
/// one floating point type and there is no list. Returns how many.
inline std::size_t read_binary_vertices(PlyData& data, const PlyElement& element, const PlyVertexRoles& roles,
                                        std::size_t count, Mesh& mesh) {
    std::array<std::size_t, PlyVertexRoles::none + 1> offsets{};
    std::array<PlyType, PlyVertexRoles::none + 1> types{};
    std::size_t stride = 0;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (element.properties[p].count_type) return 0;
        offsets[roles.of[p]] = stride;
        types[roles.of[p]] = element.properties[p].type;
        stride += ply_type_bytes[static_cast<std::size_t>(element.properties[p].type)];
    }
    const auto same = [&](std::size_t begin, std::size_t end) {
        return std::all_of(&types[begin], &types[end], [&](PlyType type) { return type == types[begin]; });
    };
    if (!same(0, 3) || !same(3, 6) || !same(6, 8)) return 0;

    std::size_t done = 0;
    count = std::min(count, data.rest().size() / stride);
    while (done < count) {
        const char* const bytes = data.rest().data();
        const auto take = [&]<std::size_t n>(auto& to, std::size_t first, std::size_t most) {
            std::array<std::size_t, n> places;
            std::copy_n(&offsets[first], n, places.begin());
            return gather<n>(bytes, stride, places, types[first], data.format(), most, to);
        };
        const std::size_t before = mesh.positions.size();
        const std::size_t used = take.template operator()<3>(mesh.positions, 0, count - done);
        const bool good = used > 0 && (!roles.with_normals || take.template operator()<3>(mesh.normals, 3, used) > 0) &&
                          (!roles.with_uvs || take.template operator()<2>(mesh.uvs, 6, used) > 0);
        if (!good) {
            mesh.positions.resize(before);
            if (roles.with_normals) mesh.normals.resize(before);
            break;
        }
        data.pass(used * stride, 0);
        done += used;
    }
    return done;
}

/// Where in the values of a face its list of corners is.
struct PlyFaceLayout {
    std::size_t list = 0;               ///< number of the property
    std::size_t before = 0, after = 0;  ///< bytes (ASCII: words) beside the list
    std::uint64_t vertices = 0;         ///< numbers of vertices are below this and in the range of their type

    /// Nothing when a face has other lists, or a list of a rare type.
    static std::optional<PlyFaceLayout> of(const PlyElement& element, std::size_t list, PlyHeader::Format format,
                                           std::size_t vertices) {
        static constexpr std::array<std::uint64_t, 6> above{128, 256, 32768, 65536, 1u << 31, std::uint64_t(1) << 32};
        PlyFaceLayout layout{.list = list};
        const PlyProperty& corners = element.properties[list];
        if (corners.type >= PlyType::float32 || *corners.count_type >= PlyType::float32) return {};
        layout.vertices = std::min<std::uint64_t>(vertices, above[static_cast<std::size_t>(corners.type)]);
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            if (p == list) continue;
            if (element.properties[p].count_type) return {};
            (p < list ? layout.before : layout.after) +=
                format == PlyHeader::Format::ascii
                    ? 1
                    : ply_type_bytes[static_cast<std::size_t>(element.properties[p].type)];
        }
        return layout;
    }
};

/// Reads faces of a binary file, up to `count`, while they are right. `polygon(face, corners)` is called for those that
/// are not triangles, after `data` has gone over them. Returns how many were read.
inline std::size_t read_binary_faces(PlyData& data, const PlyElement& element, const PlyFaceLayout& layout,
                                     std::size_t count, Mesh& mesh, const auto& polygon) {
    const PlyProperty& list = element.properties[layout.list];
    std::vector<std::uint32_t> corners;
    return with_type<std::uint8_t, std::uint32_t>(
        *list.count_type, data.format(), [&]<class Count, bool reversed>(Count, std::bool_constant<reversed>) {
            return with_type<std::uint32_t>(list.type, data.format(), [&](auto, auto) {
                using Index = std::uint32_t;
                std::array<std::array<Index, 3>, 256> block;
                std::size_t in_block = 0, done = 0;
                const char* at = data.rest().data();
                const char* const end = at + data.rest().size();
                const auto finish = [&] {
                    mesh.triangles.insert(mesh.triangles.end(), block.begin(),
                                          block.begin() + static_cast<std::ptrdiff_t>(in_block));
                    in_block = 0;
                    data.pass(static_cast<std::size_t>(at - data.rest().data()), 0);
                };
                const std::size_t around = layout.before + sizeof(Count) + layout.after;
                for (; done < count; ++done) {
                    const auto left = static_cast<std::size_t>(end - at);
                    if (left < around) break;
                    const std::size_t length = load<Count, reversed>(at + layout.before);
                    if (length < 3 || (left - around) / sizeof(Index) < length) break;
                    const char* const first = at + layout.before + sizeof(Count);
                    if (length == 3) {
                        const Index a = load<Index, reversed>(first), b = load<Index, reversed>(first + 4),
                                    c = load<Index, reversed>(first + 8);
                        if (std::max({a, b, c}) >= layout.vertices) break;
                        block[in_block] = {a, b, c};
                        at += around + 3 * sizeof(Index);
                        if (++in_block == block.size()) finish();
                        continue;
                    }
                    corners.resize(length);
                    for (std::size_t i = 0; i < length; ++i)
                        corners[i] = load<Index, reversed>(first + i * sizeof(Index));
                    if (*std::max_element(corners.begin(), corners.end()) >= layout.vertices) break;
                    at += around + length * sizeof(Index);
                    finish();
                    polygon(done, std::span<const std::uint32_t>(corners));
                }
                finish();
                return done;
            });
        });
}

/// Goes over the words of an ASCII file.
class PlyWords {
public:
    explicit PlyWords(const PlyData& data)
        : begin_(data.rest().data()), end_(begin_ + data.rest().size()), at_(begin_), line_end_(data.line_end()) {}

    /// The next number, where it is a finite one.
    bool number(double& value) {
        skip_space();
        if (const char* const end = read_simple_number(at_, end_, value); end != nullptr && at_end_of_word(end)) {
            at_ = end;
            return true;
        }
        const char* const begin = at_;
        skip_word();
        const auto parsed = parse_number({begin, at_});
        value = parsed.value_or(0);
        return parsed.has_value();
    }
    /// The next number, where it is a whole one below `limit`.
    bool integer(std::uint64_t limit, std::uint64_t& value) {
        skip_space();
        const char* const end = read_simple_integer(at_, end_, value);
        if (end == nullptr || value >= limit || !at_end_of_word(end)) return false;
        at_ = end;
        return true;
    }
    bool skip() {
        skip_space();
        const char* const begin = at_;
        skip_word();
        return at_ != begin;
    }
    bool skip(std::size_t words) {
        for (std::size_t i = 0; i < words; ++i)
            if (!skip()) return false;
        return true;
    }

    /// Has `data` go over all words so far.
    void keep(PlyData& data) {
        data.pass(static_cast<std::size_t>(at_ - begin_), lines_);
        begin_ = at_;
        lines_ = 0;
    }

private:
    bool at_end_of_word(const char* at) const { return at == end_ || is_space(*at); }
    void skip_space() {
        for (; at_ != end_ && is_space(*at_); ++at_)
            if (*at_ == line_end_) ++lines_;
    }
    void skip_word() {
        while (!at_end_of_word(at_)) ++at_;
    }

    const char *begin_, *end_, *at_;
    char line_end_;
    int lines_ = 0;
};

/// Reads vertices of an ASCII file, up to `count`, while they are right, the numbers in use are of floating point types
/// and there is no list. Returns how many.
inline std::size_t read_ascii_vertices(PlyData& data, const PlyElement& element, const PlyVertexRoles& roles,
                                       std::size_t count, Mesh& mesh) {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
        if (element.properties[p].count_type ||
            (roles.of[p] != PlyVertexRoles::none && element.properties[p].type < PlyType::float32))
            return 0;
    PlyWords words(data);
    for (std::size_t done = 0; done < count; ++done) {
        std::array<double, PlyVertexRoles::none> values{};
        for (const std::size_t role : roles.of)
            if (!(role == PlyVertexRoles::none ? words.skip() : words.number(values[role]))) return done;
        mesh.positions.emplace_back(values[0], values[1], values[2]);
        if (roles.with_normals) mesh.normals.emplace_back(values[3], values[4], values[5]);
        if (roles.with_uvs) mesh.uvs.emplace_back(values[PlyVertexRoles::u], values[PlyVertexRoles::v]);
        words.keep(data);
    }
    return count;
}

/// The same as `read_binary_faces` for an ASCII file.
inline std::size_t read_ascii_faces(PlyData& data, const PlyElement& element, const PlyFaceLayout& layout,
                                    std::size_t count, Mesh& mesh, const auto& polygon) {
    // Longer lists than these are left to others, so that their length need not be compared with what is left.
    const std::uint64_t longest = *element.properties[layout.list].count_type == PlyType::int8 ? 128 : 256;
    PlyWords words(data);
    std::array<std::uint32_t, 256> corners;
    for (std::size_t done = 0; done < count; ++done) {
        std::uint64_t length = 0, corner = 0;
        if (!words.skip(layout.before) || !words.integer(longest, length) || length < 3) return done;
        for (std::size_t i = 0; i < length; ++i) {
            if (!words.integer(layout.vertices, corner)) return done;
            corners[i] = static_cast<std::uint32_t>(corner);
        }
        if (!words.skip(layout.after)) return done;
        words.keep(data);
        if (length == 3) mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        else polygon(done, std::span<const std::uint32_t>(corners.data(), length));
    }
    return count;
}

}  // namespace lightswitch::detail
