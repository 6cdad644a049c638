#pragma once

// What the mesh loaders share.

#include <lightswitch/scene/mesh.hpp>

#include <cstdint>

namespace lightswitch {

/// What becomes of the vertex normals in a mesh file: `ignore` gives flat triangles whose winding says what is their
/// front.
enum class FileNormals { use, ignore };

namespace detail {

/// Larger mesh files are refused.
inline constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t(1) << 30;

}  // namespace detail
}  // namespace lightswitch
