#include "load/files.hpp"
#include "support/paths.hpp"

#include <lightswitch/load/serialized.hpp>

#include <chrono>

#if LIGHTSWITCH_HAS_ZLIB
#include <zlib.h>
#endif

using namespace lightswitch;
using namespace lightswitch::test;

#if LIGHTSWITCH_HAS_ZLIB

namespace {

using Triangle = std::array<std::uint32_t, 3>;

template <class T>
std::string number(T value) {
    std::string bytes;
    if constexpr (std::is_same_v<T, float>) detail::put_little_endian(bytes, std::bit_cast<std::uint32_t>(value));
    else if constexpr (std::is_same_v<T, double>) detail::put_little_endian(bytes, std::bit_cast<std::uint64_t>(value));
    else detail::put_little_endian(bytes, value);
    return bytes;
}

std::string packed(const std::string& text) {
    uLongf size = compressBound(text.size());
    std::string result(size, '\0');
    REQUIRE(compress(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                     text.size()) == Z_OK);
    result.resize(size);
    return result;
}

/// A triangle in a file of its own, with what a test wants to be different.
struct File {
    std::uint16_t format = 0x041c, version = 4;
    std::uint32_t flags = 0x1000;
    std::string name = "name";
    std::uint64_t vertices = 3, triangles = 1;
    std::string body = reals({0, 0, 0, 1, 0, 0, 0, 1, 0});
    std::array<std::uint32_t, 3> corners{0, 1, 2};
    std::string more{};

    static std::string reals(std::initializer_list<float> values) {
        std::string bytes;
        for (const float value : values) bytes += number(value);
        return bytes;
    }
    std::string content() const {
        std::string text = number(flags);
        if (version != 3) text += name + '\0';
        text += number(vertices) + number(triangles) + body;
        for (const std::uint32_t corner : corners) text += number(corner);
        return text + more;
    }
    std::string mesh() const { return number(format) + number(version) + packed(content()); }
    std::string bytes() const {
        return mesh() + (version == 3 ? number(std::uint32_t{0}) : number(std::uint64_t{0})) + number(std::uint32_t{1});
    }
};

Mesh read(std::string_view bytes, int shape = 0, FileNormals normals = FileNormals::use, Notices* notices = nullptr) {
    const Folder folder;
    return load_serialized(folder.write("a.serialized", bytes), shape, normals, notices);
}

std::string error_of(std::string_view bytes, int shape = 0) {
    return message_of([&] { read(bytes, shape); });
}

}  // namespace

TEST_CASE("files that Mitsuba reads give the same meshes") {
    for (const char* name : {"two.serialized", "old.serialized"}) {
        CAPTURE(name);
        const auto path = std::filesystem::path(test::folder()) / "data/mesh-files" / name;
        const Mesh quad = load_serialized(path);
        CHECK(quad.positions == std::vector<DVec3>{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0.5}});
        CHECK(quad.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
        REQUIRE(quad.normals.size() == 4);
        CHECK(quad.normals[1] == DVec3(0, 0.6f, 0.8f));
        CHECK(quad.normals[3] == DVec3(0, 0, 1));
        CHECK(quad.uvs == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 0.25}, {0, 0.25}});

        const Mesh flat = load_serialized(path, 0, FileNormals::ignore);
        CHECK(flat.normals.empty());
        CHECK(flat.uvs == quad.uvs);
        CHECK(flat.triangles == quad.triangles);

        const Mesh tip = load_serialized(path, 1);
        CHECK(tip.positions == std::vector<DVec3>{{0, 0, 0}, {1, 0, 0}, {0, 1e-9, 1}});  // doubles
        CHECK(tip.normals.empty());
        CHECK(tip.uvs.empty());
        CHECK(contains(message_of([&] { load_serialized(path, 2); }), "mesh 2: does not exist: there are 2"));
        CHECK(contains(message_of([&] { load_serialized(path, -1); }), "mesh -1: does not exist"));
    }
}

TEST_CASE("a mesh is found through the table, whatever lies between") {
    const File plain;
    File other;
    other.body = File::reals({5, 0, 0, 6, 0, 0, 5, 1, 0});
    const std::string first = plain.mesh(), gap = "anything", second = other.mesh();
    const std::string file = first + gap + second + number(std::uint64_t{0}) +
                             number(std::uint64_t{first.size() + gap.size()}) + number(std::uint32_t{2});
    CHECK(read(file, 1).positions[0] == DVec3(5, 0, 0));
    CHECK(read(first).positions[0] == DVec3(0));  // the first needs no table
    CHECK(contains(error_of(first + gap + second + number(std::uint64_t{0}) + number(std::uint64_t{1} << 60) +
                                number(std::uint32_t{2}),
                            1),
                   "the table at the end of the file is damaged"));
    CHECK(contains(error_of(first + gap + second + number(std::uint64_t{0}) + number(std::uint64_t{first.size()}) +
                                number(std::uint32_t{2}),
                            1),
                   "does not begin with 1c 04"));
    CHECK(contains(error_of(first + number(0xffffffffu), 1), "the table at the end of the file is damaged"));
    CHECK(contains(error_of(first + number(std::uint64_t{first.size() + 10}) + number(std::uint32_t{1}), 1),
                   "does not exist: there are 1 (counted from 0)"));
}

TEST_CASE("numbers lie across the ends of the pieces in which data is unpacked") {
    for (const std::string name : {"", "a", "ab", "abc"}) {
        constexpr std::uint32_t count = 20000;
        File file;
        file.name = name;
        file.vertices = count;
        file.body.clear();
        for (std::uint32_t i = 0; i < count; ++i)
            file.body += File::reals({static_cast<float>(i), 0.5f * static_cast<float>(i), -1});
        file.corners = {0, 1, count - 1};
        const Mesh mesh = read(file.bytes());
        REQUIRE(mesh.positions.size() == count);
        bool same = true;
        for (std::uint32_t i = 0; i < count; ++i) same = same && mesh.positions[i] == DVec3(i, 0.5 * i, -1);
        CHECK(same);
        CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, count - 1}});
    }
}

TEST_CASE("normals of a .serialized mesh decide the front, and missing ones are computed") {
    File file;
    file.flags |= 1;
    file.body += File::reals({0, 0, -1, 0, 0, -2, 0, 0, -1});
    CHECK(read(file.bytes()).triangles == std::vector<Triangle>{{0, 2, 1}});
    CHECK(read(file.bytes(), 0, FileNormals::ignore).triangles == std::vector<Triangle>{{0, 1, 2}});
    file.body = File::reals({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1});
    Notices notices;
    CHECK(read(file.bytes(), 0, FileNormals::use, &notices).normals[1] == DVec3(0, 0, 1));
    REQUIRE(notices.size() == 1);
    CHECK(contains(notices[0], "a.serialized: mesh 0: the corner has no normal"));
}

TEST_CASE("malformed .serialized files are errors that say what is wrong") {
    const auto with = [](auto change) {
        File file;
        change(file);
        return file.bytes();
    };
    const std::string good = File().bytes();
    CHECK(error_of(good) == "no error");
    CHECK(contains(error_of(""), "a.serialized: mesh 0: the file is cut off"));
    CHECK(contains(error_of(good.substr(0, 3)), "the file is cut off"));
    CHECK(contains(error_of(good.substr(0, 4)), "the compressed data is cut off"));
    CHECK(contains(error_of(File().mesh().substr(0, 30)), "the compressed data is cut off"));
    CHECK(contains(error_of(with([](File& f) { f.format = 0x1c04; })), "does not begin with 1c 04"));
    CHECK(contains(error_of(with([](File& f) { f.version = 5; })), "has version 5; known are 3 and 4"));
    CHECK(contains(error_of(with([](File& f) { f.corners[1] = 3; })),
                   "triangle 0: vertex 3 does not exist: there are 3"));
    CHECK(contains(error_of(with([](File& f) { f.triangles = 0; })), "contains no triangles"));
    CHECK(contains(error_of(with([](File& f) { f.vertices = 0; })), "contains no triangles"));
    CHECK(contains(error_of(with([](File& f) { f.triangles = 2; })), "the compressed data ends too early"));
    CHECK(contains(error_of(with([](File& f) { f.more = "x"; })), "goes on after its last triangle"));
    CHECK(contains(error_of(with([](File& f) { f.name = std::string(70000, 'a'); })), "more than 65536 characters"));
    for (const float bad : {infinity, std::nanf("")})
        CHECK(contains(error_of(with([&](File& f) {
                           f.body = File::reals({0, 0, 0, 1, bad, 0, 0, 1, 0});
                       })),
                       "the position of vertex 1 is not finite"));

    // Not the value, only the checksum after it is wrong.
    std::string damaged = File().mesh();
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    CHECK(contains(error_of(damaged), "the compressed data is damaged: incorrect data check"));
}

#if LIGHTSWITCH_MAPS_FILES

TEST_CASE("of a large file with many meshes only the one that is asked for is read") {
    const File file;
    const Folder folder;
    // A hole of half a GiB between the mesh and the table.
    const auto path = folder.write("a.serialized", file.mesh());
    std::filesystem::resize_file(path, std::uintmax_t(1) << 29);
    std::ofstream(path, std::ios::binary | std::ios::app) << number(std::uint64_t{0}) << number(std::uint32_t{1});
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) CHECK(load_serialized(path).triangles.size() == 1);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
}

#endif

TEST_CASE("counts that the file cannot hold cost no memory") {
    const auto counts = [](std::uint64_t vertices, std::uint64_t triangles) {
        File file;
        file.vertices = vertices;
        file.triangles = triangles;
        return error_of(file.bytes());
    };
    const std::uint64_t huge = ~std::uint64_t{0};
    for (const auto& [v, t] :
         {std::pair(huge, huge), std::pair(huge, std::uint64_t{1}), std::pair(std::uint64_t{3}, huge),
          std::pair(huge / 12 + 2, std::uint64_t{1}), std::pair(std::uint64_t{80000000}, std::uint64_t{80000000})})
        CHECK(contains(counts(v, t), "are more than is read (1 GiB)"));
    CHECK(contains(counts(80000000, 1), "cannot be in the"));
    CHECK(contains(counts(3, 80000000), "cannot be in the"));
}

TEST_CASE("damaged .serialized files give an error or a mesh") {
    File file;
    file.flags |= 3;
    file.body += File::reals({0, 0, -1, 0, 0, -2, 0, 0, -1, 0, 0, 1, 0, 0, 1});
    const std::string whole = file.mesh() + file.mesh() + number(std::uint64_t{0}) +
                              number(std::uint64_t{file.mesh().size()}) + number(std::uint32_t{2});
    const std::string content = file.content();
    int errors = 0;
    for (std::uint32_t seed = 0; seed < 3000; ++seed) {
        // Half of the damage is under the compression, where no checksum tells of it.
        const std::string bytes = seed % 2 == 0
                                      ? mutated(whole, seed)
                                      : number(file.format) + number(file.version) + packed(mutated(content, seed));
        try {
            const Mesh mesh =
                detail::SerializedReader(bytes, "a", seed % 4 == 0 ? 1 : 0, FileNormals::use).read(nullptr);
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t corner : triangle) CHECK(corner < mesh.positions.size());
        } catch (const Error&) {
            ++errors;
        }
    }
    CHECK(errors > 1500);
    CHECK(errors < 3000);
}

#else

TEST_CASE("without zlib a .serialized mesh is an error that says so") {
    CHECK(contains(message_of([] { load_serialized("a.serialized"); }),
                   "a.serialized: this program was built without zlib"));
}

#endif
