#pragma once

// The vertices of a mesh from an OBJ file, whose corners name position, texture coordinate and normal apart.

#include <lightswitch/core/floating_point.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// Indices from 0 into the file's lists, or none.
struct ObjCorner {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t position = none, uv = none, normal = none;

    auto operator<=>(const ObjCorner&) const = default;
};

/// Numbers corners in the order in which they first come up.
class ObjVertices {
public:
    /// What a corner names beside its position, and the next one with the same position.
    struct Vertex {
        std::uint32_t uv, normal, next;
    };

    /// The number of a corner, and whether it is a new one. There are that many positions in the file so far.
    std::pair<std::uint32_t, bool> number(const ObjCorner& corner, std::size_t positions) {
        if (corner.position >= first_.size()) first_.resize(positions, ObjCorner::none);
        // Those of one position are looked through one by one: nearly always there are few.
        std::uint32_t* link = &first_[corner.position];
        constexpr int most = 32;
        for (int count = 0; *link != ObjCorner::none;) {
            Vertex& known = vertices_[*link];
            if (known.uv == corner.uv && known.normal == corner.normal) return {*link, false};
            if (++count == most) return crowded(corner);
            link = &known.next;
        }
        *link = next_number();
        return add(corner);
    }

    void reserve(std::size_t count) { vertices_.reserve(count); }

    /// Frees what only `number` needs.
    void finish_numbers() {
        first_ = {};
        crowded_ = {};
    }

    /// Fills `result` with what each vertex has of `values`, or 0; leaves it empty when none has any.
    template <class T>
    void gather(const std::vector<T>& values, std::uint32_t Vertex::*index, std::vector<T>& result) const {
        const auto has = [&](const Vertex& vertex) { return vertex.*index != ObjCorner::none; };
        if (std::none_of(vertices_.begin(), vertices_.end(), has)) return;
        result.reserve(vertices_.size());
        for (const Vertex& vertex : vertices_) result.push_back(has(vertex) ? values[vertex.*index] : T(0));
    }

private:
    std::uint32_t next_number() const { return static_cast<std::uint32_t>(vertices_.size()); }

    std::pair<std::uint32_t, bool> add(const ObjCorner& corner) {
        vertices_.push_back({corner.uv, corner.normal, ObjCorner::none});
        return {next_number() - 1, true};
    }

    /// Of a corner at a position that has many others.
    std::pair<std::uint32_t, bool> crowded(const ObjCorner& corner) {
        const auto [entry, is_new] = crowded_.try_emplace(corner, next_number());
        return is_new ? add(corner) : std::pair{entry->second, false};
    }

    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> first_;  ///< by position: its first vertex
    std::map<ObjCorner, std::uint32_t> crowded_;
};

}  // namespace lightswitch::detail
