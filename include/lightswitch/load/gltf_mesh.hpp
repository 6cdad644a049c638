#pragma once

// Triangles in glTF files.

#include <lightswitch/load/gltf_accessor.hpp>

#if LIGHTSWITCH_HAS_GLTF

namespace lightswitch::detail {

/// Reads the primitives of one glTF file.
class GltfMeshes {
public:
    explicit GltfMeshes(GltfFile& file) : file_(file) {}

    /// The triangles of a primitive, in the mesh's own coordinates, or nothing where it has none.
    std::optional<Mesh> read(const tinygltf::Primitive& primitive, const Origin& where) {
        const auto has = [&](const char* name) { return primitive.attributes.contains(name); };
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode < TINYGLTF_MODE_TRIANGLES) return skipped(where, "points and lines are skipped");
        if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
            fail(where, "has the mode " + std::to_string(mode) + ", which glTF does not have");
        if (!has("POSITION")) return skipped(where, "a primitive without positions is skipped");
        if (has("COLOR_0")) file_.notices().add(where, "colours of vertices are ignored");
        if (!primitive.targets.empty()) file_.notices().add(where, "morph targets are ignored");

        const auto attribute = [&](const char* name, int components) {
            return GltfAccessor(file_, primitive.attributes.at(name), components, where);
        };
        const GltfAccessor positions = attribute("POSITION", 3);
        const std::vector<std::uint32_t> corners = corners_of(primitive, positions.count(), where);
        Mesh mesh;
        mesh.triangles = triangles(corners, mode, where);
        if (mesh.triangles.empty()) return skipped(where, "a primitive without triangles is skipped");
        const std::vector<std::uint32_t> used = take_used(mesh, positions.count());
        for (const std::uint32_t vertex : used) mesh.positions.push_back(positions.vec3(vertex));
        if (has("NORMAL")) {
            const GltfAccessor normals = attribute("NORMAL", 3);
            check_count(normals, positions);
            for (const std::uint32_t vertex : used) mesh.normals.push_back(normals.vec3(vertex));
            replace_missing_normals(mesh, where);
        }
        if (has("TEXCOORD_0")) {
            const GltfAccessor uvs = attribute("TEXCOORD_0", 2);
            check_count(uvs, positions);
            for (const std::uint32_t vertex : used) mesh.uvs.push_back(uvs.vec2(vertex));
        }
        return mesh;
    }

    /// Primitives may share accessors, so a few bytes could ask for any number of triangles.
    void spend(std::size_t corners, const Origin& where) {
        const std::size_t most = 2 * file_.used_bytes();
        if (corners > most - std::min(spent_, most))
            fail(where,
                 "has too many vertices or indices: all primitives together have more than twice as many as the "
                 "files have bytes");
        if (corners > 0xffffffff) fail(where, "has more than 2^32 vertices or indices");
        spent_ += corners;
    }

private:
    std::nullopt_t skipped(const Origin& where, std::string_view what) {
        file_.notices().add(where, what);
        return std::nullopt;
    }

    /// Vertices one after the other, as the mode takes them.
    std::vector<std::uint32_t> corners_of(const tinygltf::Primitive& primitive, std::size_t vertices,
                                          const Origin& where) {
        std::vector<std::uint32_t> corners;
        if (primitive.indices == -1) {
            spend(vertices, where);
            corners.resize(vertices);
            for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint32_t>(i);
            return corners;
        }
        const GltfAccessor indices(file_, primitive.indices, 1, where);
        if (!indices.is_unsigned()) fail(indices.origin(), "has numbers that are no indices");
        spend(indices.count(), where);
        corners.resize(indices.count());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = indices.index(i);
            if (corners[i] >= vertices)
                fail(indices.origin(), "names vertex " + std::to_string(corners[i]) + ", but there are " +
                                           std::to_string(vertices) + " (counted from 0)");
        }
        return corners;
    }

    std::vector<std::array<std::uint32_t, 3>> triangles(const std::vector<std::uint32_t>& corners, int mode,
                                                        const Origin& where) {
        std::vector<std::array<std::uint32_t, 3>> result;
        const std::size_t count = corners.size();
        if (mode == TINYGLTF_MODE_TRIANGLES) {
            result.reserve(count / 3);
            for (std::size_t i = 0; i + 3 <= count; i += 3)
                result.push_back({corners[i], corners[i + 1], corners[i + 2]});
            if (count % 3 != 0) file_.notices().add(where, "the corners after the last whole triangle are skipped");
            return result;
        }
        const bool strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        for (std::size_t i = 0; i + 3 <= count; ++i) {
            std::array<std::uint32_t, 3> t{corners[strip ? i : 0], corners[i + 1], corners[i + 2]};
            if (strip && i % 2 == 1) std::swap(t[1], t[2]);
            // Those that repeat a corner only turn a strip.
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.push_back(t);
        }
        return result;
    }

    /// The vertices that triangles use, in order; the triangles then count in them.
    static std::vector<std::uint32_t> take_used(Mesh& mesh, std::size_t vertices) {
        std::vector<std::uint32_t> used;
        used.reserve(3 * mesh.triangles.size());
        for (const auto& triangle : mesh.triangles) used.insert(used.end(), triangle.begin(), triangle.end());
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        if (used.size() < vertices)
            for (auto& triangle : mesh.triangles)
                for (std::uint32_t& corner : triangle)
                    corner =
                        static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
        used.shrink_to_fit();
        return used;
    }

    static void check_count(const GltfAccessor& accessor, const GltfAccessor& positions) {
        if (accessor.count() < positions.count())
            fail(accessor.origin(), "has " + std::to_string(accessor.count()) + " elements for " +
                                        std::to_string(positions.count()) + " positions");
    }

    /// Only the winding says which side is the front, unlike in other files.
    void replace_missing_normals(Mesh& mesh, const Origin& where) {
        Mesh computed;
        for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
            if (mesh.normals[i] != DVec3(0)) continue;
            if (computed.normals.empty()) {
                file_.notices().add(where, guessed_normal);
                computed = {.positions = mesh.positions, .normals = {}, .triangles = mesh.triangles};
                computed.smooth();
            }
            mesh.normals[i] = computed.normals[i];
        }
    }

    GltfFile& file_;
    std::size_t spent_ = 0;
};

}  // namespace lightswitch::detail

#endif
