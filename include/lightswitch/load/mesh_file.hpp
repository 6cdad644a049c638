#pragma once

// What the mesh loaders share.

#include <lightswitch/core/error.hpp>
#include <lightswitch/scene/mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// What becomes of the vertex normals in a mesh file: `ignore` gives flat triangles whose winding says what is their
/// front.
enum class FileNormals { use, ignore };

/// What a loader passed over or had to guess: one line each for the user, which names file and line (or element). The
/// same of one file is said once, with the first place and how often.
using Notices = std::vector<std::string>;

namespace detail {

/// Larger mesh files are refused.
inline constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t(1) << 30;

inline constexpr std::string_view crossing_polygon =
    "the polygon crosses itself or has no area: its triangles may cover something else";
inline constexpr std::string_view guessed_normal =
    "the corner has no normal or one of length 0: it is computed from the triangles around it";

/// Gathers the notices of one file.
class FileNotices {
public:
    void add(const Origin& where, std::string_view what, std::size_t count = 1) {
        if (count == 0) return;
        const auto same = [&](const Kind& kind) { return kind.what == what; };
        const auto found = std::find_if(kinds_.begin(), kinds_.end(), same);
        if (found != kinds_.end()) found->count += count;
        else kinds_.push_back({where, std::string(what), count});
    }

    /// Appends them to `notices`, unless it is null.
    void report(Notices* notices) const {
        if (notices == nullptr) return;
        for (const Kind& kind : kinds_) {
            const std::string more = kind.count > 1 ? " (" + std::to_string(kind.count) + " times)" : "";
            notices->push_back(kind.where.prefix() + kind.what + more);
        }
    }

private:
    struct Kind {
        Origin where;
        std::string what;
        std::size_t count;
    };
    std::vector<Kind> kinds_;
};

/// Lets the normals decide the front of each triangle, and then replaces those of length 0 by what `Mesh::smooth`
/// computes.
inline void finish_normals(Mesh& mesh) {
    mesh.face_along_normals();
    const auto is_missing = [](const DVec3& normal) { return normal == DVec3(0); };
    if (std::none_of(mesh.normals.begin(), mesh.normals.end(), is_missing)) return;
    const std::vector<DVec3> given = std::move(mesh.normals);
    mesh.smooth();
    for (std::size_t i = 0; i < given.size(); ++i)
        if (!is_missing(given[i])) mesh.normals[i] = given[i];
}

}  // namespace detail
}  // namespace lightswitch
