#pragma once

// Mitsuba's own format of meshes, where the build has zlib.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/inflate.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/text.hpp>

#include <filesystem>

namespace lightswitch {

/// Reads the mesh number `shape`, counted from 0, of a .serialized file of at most 1 GiB (versions 3 and 4, single or
/// double precision). Mesh 0 is the one at the beginning; the others are found through the table at the end.
///
/// Where the file's normals point is the front; one of length 0 in use is replaced by what `Mesh::smooth` computes.
/// Names, colours and the flag for face normals are skipped, the last as Mitsuba 3.9.1 does.
///
/// `notices` gets a line for normals of length 0 in use.
///
/// Throws `Error` when there is no such mesh, for anything malformed (a file that is cut off or damaged, also where
/// only the checksum tells; a mesh that is shorter or longer than it says; a number that is not finite; a corner out of
/// range), for a mesh of more than 1 GiB, when it has no triangles, and when the program was built without zlib. Thread
/// safe.
Mesh load_serialized(const std::filesystem::path& path, int shape = 0, FileNormals normals = FileNormals::use,
                     Notices* notices = nullptr);

namespace detail {

#if LIGHTSWITCH_HAS_ZLIB

/// One mesh of a file whose bytes are `bytes`. The format is described in Mitsuba's documentation of its shape plugins.
class SerializedReader {
public:
    SerializedReader(std::string_view bytes, std::string file, int shape, FileNormals use)
        : where_{std::move(file), 0, "mesh " + std::to_string(shape)}, bytes_(bytes), use_(use) {
        version_ = read_version(0);
        offset_ = shape == 0 ? 0 : find(shape);
        // The version that counts is that of the file; Mitsuba does not look at the others either.
        if (offset_ > 0) read_version(offset_);
    }

    Mesh read(Notices* notices) {
        const std::string_view packed = bytes_.substr(offset_ + 4);
        Inflate data(packed, where_);
        flags_ = data.number<std::uint32_t>();
        if (version_ == 4) skip_name(data);
        const auto vertices = data.number<std::uint64_t>(), triangles = data.number<std::uint64_t>();
        check_counts(vertices, triangles, packed.size());

        Mesh mesh;
        read_array(data, vertices, "position", mesh.positions);
        if (has(normals)) {
            if (use_ == FileNormals::use) read_array(data, vertices, "normal", mesh.normals);
            else skip_array(data, vertices, 3);
        }
        if (has(uvs)) read_array(data, vertices, "texture coordinate", mesh.uvs);
        if (has(colors)) skip_array(data, vertices, 3);
        read_triangles(data, triangles, mesh);
        if (!data.at_end()) fail(where_, "goes on after its last triangle");

        finish_normals(mesh);
        notices_.report(notices);
        return mesh;
    }

private:
    enum Flag : std::uint32_t { normals = 0x1, uvs = 0x2, colors = 0x8, double_precision = 0x2000 };
    bool has(Flag flag) const { return (flags_ & flag) != 0; }

    /// The version in the header of the mesh at `offset`.
    int read_version(std::size_t offset) const {
        if (offset > bytes_.size() || bytes_.size() - offset < 4) fail(where_, "the file is cut off");
        const auto format = get_little_endian<std::uint16_t>(bytes_.data() + offset),
                   version = get_little_endian<std::uint16_t>(bytes_.data() + offset + 2);
        if (format != 0x041c) fail(where_, "is no .serialized mesh: it does not begin with 1c 04");
        if (version != 3 && version != 4)
            fail(where_, "has version " + std::to_string(version) + "; known are 3 and 4");
        return version;
    }

    /// Where the mesh begins, as the table at the end says: an offset for each mesh, then how many there are.
    std::size_t find(int shape) const {
        const std::size_t count = bytes_.size() < 4 ? 0 : get_little_endian<std::uint32_t>(&bytes_[bytes_.size() - 4]);
        const std::size_t entry = version_ == 4 ? 8 : 4;
        if (count > (bytes_.size() - 4) / entry) fail(where_, "the table at the end of the file is damaged");
        if (shape < 0 || static_cast<std::size_t>(shape) >= count)
            fail(where_, "does not exist: there are " + std::to_string(count) + " (counted from 0)");
        const char* place = &bytes_[bytes_.size() - 4 - entry * (count - static_cast<std::size_t>(shape))];
        const std::uint64_t offset =
            version_ == 4 ? get_little_endian<std::uint64_t>(place) : get_little_endian<std::uint32_t>(place);
        if (offset > bytes_.size()) fail(where_, "the table at the end of the file is damaged");
        return static_cast<std::size_t>(offset);
    }

    void skip_name(Inflate& data) const {
        constexpr int longest = 1 << 16;
        for (int i = 0; data.number<std::uint8_t>() != 0; ++i)
            if (i == longest) fail(where_, "has a name of more than " + std::to_string(longest) + " characters");
    }

    /// Refuses what cannot be in the file, before memory is spent on it.
    void check_counts(std::uint64_t vertices, std::uint64_t triangles, std::size_t packed_bytes) const {
        constexpr std::uint64_t most = max_mesh_bytes;
        if (vertices == 0 || triangles == 0) fail(where_, "contains no triangles");
        const std::uint64_t real = has(double_precision) ? 8 : 4;
        const std::uint64_t vertex_bytes =
            real * (3 + (has(normals) ? 3u : 0u) + (has(uvs) ? 2u : 0u) + (has(colors) ? 3u : 0u));
        const std::string counts =
            std::to_string(vertices) + " vertices and " + std::to_string(triangles) + " triangles";
        if (vertices > most / vertex_bytes || triangles > most / 12 || vertices * vertex_bytes + triangles * 12 > most)
            fail(where_, counts + " are more than is read (1 GiB)");
        // Deflate makes no more than 1032 bytes of one: pairs of bits that each stand for 258.
        if (vertices * vertex_bytes + triangles * 12 > 1032 * std::uint64_t(packed_bytes))
            fail(where_, counts + " cannot be in the " + std::to_string(packed_bytes) + " bytes that follow");
    }

    double real(Inflate& data) const { return has(double_precision) ? data.float64() : data.float32(); }

    template <class Vector>
    void read_array(Inflate& data, std::uint64_t count, const char* what, std::vector<Vector>& result) {
        result.reserve(count);
        for (std::uint64_t i = 0; i < count; ++i) {
            Vector v;
            for (int c = 0; c < Vector::length(); ++c) {
                v[c] = static_cast<typename Vector::value_type>(real(data));
                if (!lightswitch::is_finite(v[c]))
                    fail(where_, std::string("the ") + what + " of vertex " + std::to_string(i) + " is not finite");
            }
            result.push_back(v);
        }
    }

    void skip_array(Inflate& data, std::uint64_t count, std::uint64_t components) const {
        for (std::uint64_t i = 0; i < count * components; ++i) real(data);
    }

    void read_triangles(Inflate& data, std::uint64_t count, Mesh& mesh) {
        mesh.triangles.reserve(count);
        for (std::uint64_t i = 0; i < count; ++i) {
            std::array<std::uint32_t, 3> corners;
            for (std::uint32_t& corner : corners) {
                corner = data.number<std::uint32_t>();
                if (corner >= mesh.positions.size())
                    fail(where_, "triangle " + std::to_string(i) + ": vertex " + std::to_string(corner) +
                                     " does not exist: there are " + std::to_string(mesh.positions.size()) +
                                     " (counted from 0)");
                if (!mesh.normals.empty() && mesh.normals[corner] == DVec3(0)) notices_.add(where_, guessed_normal);
            }
            mesh.triangles.push_back(corners);
        }
    }

    Origin where_;
    std::string_view bytes_;
    FileNormals use_;
    int version_ = 0;
    std::size_t offset_ = 0;
    std::uint32_t flags_ = 0;
    FileNotices notices_;
};

#endif

}  // namespace detail

inline Mesh load_serialized(const std::filesystem::path& path, [[maybe_unused]] int shape,
                            [[maybe_unused]] FileNormals normals, [[maybe_unused]] Notices* notices) {
#if LIGHTSWITCH_HAS_ZLIB
    // Of a large file only the mesh itself is read.
    const FileBytes bytes(path, detail::max_mesh_bytes);
    return detail::SerializedReader(bytes.view(), path.string(), shape, normals).read(notices);
#else
    fail(detail::file_origin(path), "this program was built without zlib: build it with zlib, or use .ply");
#endif
}

}  // namespace lightswitch
