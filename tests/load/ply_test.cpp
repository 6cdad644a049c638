#include "load/files.hpp"

#include <lightswitch/load/ply.hpp>

#include <bit>
#include <cstring>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

Mesh parse(std::string_view bytes, FileNormals normals = FileNormals::use) {
    const Folder folder;
    return load_ply(folder.write("mesh.ply", bytes), normals);
}

using Triangle = std::array<std::uint32_t, 3>;

/// Appends a number in either byte order.
template <class T>
void put(std::string& bytes, T value, bool big_endian) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

/// A square of one quad, stored in the given types, with properties and elements that nobody needs.
template <class Coordinate, class Count, class Index>
std::string binary(const char* coordinate, const char* count, const char* index, bool big_endian) {
    std::string bytes = std::string("ply\r\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\ncomment any text at all\nelement camera 1\nproperty list uchar double matrix\n"
                        "element vertex 4\nproperty uchar red\n";
    for (const char* axis : {"x", "y", "z"}) bytes += std::string("property ") + coordinate + " " + axis + "\n";
    bytes += std::string("property double quality\nelement face 1\nproperty list ") + count + " " + index +
             " vertex_indices\nproperty list uchar float texcoord\nend_header\n";
    put<std::uint8_t>(bytes, 2, big_endian);
    put(bytes, 1.0, big_endian);
    put(bytes, 2.0, big_endian);
    for (int i = 0; i < 4; ++i) {
        put<std::uint8_t>(bytes, 255, big_endian);
        put(bytes, static_cast<Coordinate>(i == 1 || i == 2 ? -3 : 0), big_endian);
        put(bytes, static_cast<Coordinate>(i >= 2 ? 100 : 0), big_endian);
        put(bytes, static_cast<Coordinate>(i), big_endian);
        put(bytes, std::numeric_limits<double>::quiet_NaN(), big_endian);
    }
    put(bytes, static_cast<Count>(4), big_endian);
    for (int i = 0; i < 4; ++i) put(bytes, static_cast<Index>(i), big_endian);
    put<std::uint8_t>(bytes, 1, big_endian);
    put(bytes, 0.5f, big_endian);
    return bytes;
}

const std::string head =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_index\nend_header\n";

}  // namespace

TEST_CASE("an ASCII PLY is read with its normals") {
    const Mesh mesh = parse(
        "ply\nformat ascii 1.0\nobj_info none\nelement vertex 4\nproperty float nx\nproperty float ny\nproperty float "
        "nz\n"
        "property double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uchar int "
        "vertex_index\n"
        "end_header\n0 0 1 10000000.123456789 0 0\n0 0 2 1 0 0\n0 0 1 1 1 0\n0 0 0 7 7 7\n3 2 1 0\n \n");
    CHECK(mesh.positions[0] == DVec3(10000000.123456789, 0, 0));
    // A normal that no face uses may be 0 in the file.
    CHECK(mesh.normals == std::vector<DVec3>{{0, 0, 1}, {0, 0, 2}, {0, 0, 1}, {1, 0, 0}});
    // The winding of the file would face along +z here and the normals agree.
    CHECK(mesh.triangles == std::vector<Triangle>{{2, 1, 0}});
}

TEST_CASE("the normals of a PLY file decide the front, unless they are ignored") {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
        "nx\n"
        "property float ny\nproperty float nz\n" +
        faces + "0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n";
    CHECK(parse(text).triangles == std::vector<Triangle>{{0, 2, 1}});
    CHECK(parse(text, FileNormals::ignore).triangles == std::vector<Triangle>{{0, 1, 2}});
    CHECK(parse(text, FileNormals::ignore).normals.empty());
}

TEST_CASE("binary PLY files are read in both byte orders and all types") {
    std::vector<std::string> files;
    for (const bool big : {false, true}) {
        files.push_back(binary<float, std::uint8_t, std::int32_t>("float", "uchar", "int", big));
        files.push_back(binary<double, std::int8_t, std::uint8_t>("float64", "char", "uint8", big));
        files.push_back(binary<std::int8_t, std::uint16_t, std::int16_t>("int8", "ushort", "short", big));
        files.push_back(binary<std::int16_t, std::int16_t, std::uint16_t>("int16", "int16", "uint16", big));
        files.push_back(binary<std::int32_t, std::uint32_t, std::uint32_t>("int32", "uint32", "uint", big));
        files.push_back(binary<float, std::int32_t, std::int8_t>("float32", "int32", "char", big));
    }
    for (const std::string& file : files) {
        const Mesh mesh = parse(file);
        CHECK(mesh.positions == std::vector<DVec3>{{0, 0, 0}, {-3, 0, 1}, {-3, 100, 2}, {0, 100, 3}});
        CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    }
    // Cut anywhere, a file is refused: no byte is optional.
    for (std::size_t size = 0; size < files[0].size(); ++size)
        CHECK(message_of([&] { parse(files[0].substr(0, size)); }) != "no error");
    CHECK(contains(message_of([&] { parse(files[0] + "x"); }), "mesh.ply: the file goes on after its last element"));
    CHECK(contains(message_of([&] { parse(files[0].substr(0, files[0].size() - 1)); }),
                   "face 0: the file ends too early"));
}

TEST_CASE("the lists of a PLY file are of any type") {
    for (const bool big : {false, true}) {
        const std::string files[] = {binary<float, std::uint8_t, float>("float", "uchar", "float", big),
                                     binary<float, float, double>("float", "float", "double", big),
                                     binary<double, double, std::uint8_t>("double", "float64", "uchar", big)};
        for (const std::string& file : files)
            CHECK(parse(file).triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    }
}

TEST_CASE("the faces of a PLY file may come before the vertices, and lines may end in CR") {
    for (const std::string order : {"fv", "vf"})
        for (const std::string end : {"\n", "\r\n", "\r"})
            for (const bool is_binary : {false, true}) {
                std::string text =
                    "\xef\xbb\xbfply\nformat " + std::string(is_binary ? "binary_little_endian" : "ascii") + " 1.0\n";
                std::string data;
                for (const char element : order) {
                    text += element == 'f' ? "element face 1\nproperty list uchar uchar vertex_index\n"
                                           : "element vertex 4\nproperty uchar x\nproperty uchar y\nproperty uchar z\n";
                    // The first byte of binary data may look like the end of a line.
                    if (is_binary)
                        data +=
                            element == 'f' ? std::string("\3\0\1\3", 4) : std::string("\n\0\0\1\n\0\1\1\0\0\1\1", 12);
                    else data += element == 'f' ? "3 0 1 3\n" : "10 0 0\n1 10 0\n1 1 0\n0 1 1\n";
                }
                text += "end_header\n";
                if (!is_binary) text += data;
                for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
                    text.replace(at, 1, end);
                if (is_binary) text += data;
                const Mesh mesh = parse(text);
                CHECK(mesh.positions == std::vector<DVec3>{{10, 0, 0}, {1, 10, 0}, {1, 1, 0}, {0, 1, 1}});
                CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 3}});
            }
}

TEST_CASE("the strips of a PLY file become triangles that face one way") {
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string data = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";
    const std::string strips = "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
    CHECK(parse(vertices + strips + data + "7 2 1 0 -1 2 3 1\n3 4 3 2\n").triangles ==
          std::vector<Triangle>{{2, 1, 0}, {2, 3, 1}, {4, 3, 2}});
    CHECK(parse(vertices + strips + data + "6 0 2 1 3 -1 -1\n4 2 4 3 5\n").triangles ==
          std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}});
    // A repeated corner turns the strip.
    CHECK(parse(vertices + strips + data + "0\n6 0 2 1 1 3 2\n").triangles ==
          std::vector<Triangle>{{0, 2, 1}, {3, 1, 2}});
}

TEST_CASE("what a PLY file holds besides is skipped, with a notice for each element") {
    const Folder folder;
    const auto path = folder.write(
        "mesh.ply", head +
                        "property uchar red\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nelement "
                        "nothing 0\nproperty int a\n" +
                        faces + "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 1\n1 2\n3 0 1 2\n");
    Notices notices;
    CHECK(load_ply(path, FileNormals::use, &notices).triangles.size() == 1);
    CHECK(notices == Notices{path.string() + ":8: the element \"edge\" is skipped"});
}

TEST_CASE("a normal of length 0 in a PLY file is computed from the triangles around it") {
    const Folder folder;
    const auto path = folder.write("mesh.ply", head + "property float nx\nproperty float ny\nproperty float nz\n" +
                                                   faces + "0 0 0 0 0 0\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n");
    Notices notices;
    const Mesh mesh = load_ply(path, FileNormals::use, &notices);
    CHECK(mesh.normals == std::vector<DVec3>(3, DVec3(0, 0, -1)));
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 2, 1}});
    REQUIRE(notices.size() == 1);
    CHECK_MESSAGE(contains(notices[0], "mesh.ply:16: face 0: the corner has no normal or one of length 0"), notices[0]);
    CHECK(load_ply(path, FileNormals::ignore, &notices).normals.empty());
    CHECK(notices.size() == 1);
}

TEST_CASE("malformed PLY files are refused with the line") {
    const std::string data = "0 0 0\n1 0 0\n0 1 0\n";
    struct Case {
        std::string text;
        std::string_view message;
    };
    const Case cases[] = {
        {"", "mesh.ply:1: is not a PLY file"},
        {"solid stl\n", "mesh.ply:1: is not a PLY file"},
        {"ply\n", "mesh.ply:2: the file ends within the header"},
        {"ply\nend_header\n", "mesh.ply:2: the header names no format"},
        {"ply\nformat ascii 2.0\n", "mesh.ply:2: the format's version is \"2.0\""},
        {"ply\nformat text 1.0\n", "mesh.ply:2: \"text\" is not a PLY format"},
        {"ply\nformat ascii 1.0 x\n", "mesh.ply:2: unexpected \"x\""},
        {"ply\nformat ascii 1.0\nformat ascii 1.0\n", "mesh.ply:3: the format is given twice"},
        {"ply\nproperty float x\n", "mesh.ply:2: a property before any element"},
        {"ply\nelement vertex -1\n", "mesh.ply:2: an element needs a name and a count"},
        {"ply\nelement vertex 1\nelement vertex 1\n", "mesh.ply:3: the element \"vertex\" is given twice"},
        {"ply\nelement vertex 1\nproperty half x\n", "mesh.ply:3: \"half\" is not a PLY type"},
        {"ply\nelement vertex 1\nproperty float\n", "mesh.ply:3: the property has no name"},
        {"ply\nelement vertex 1\nproperty float x\nproperty float x\n",
         "mesh.ply:4: the property \"x\" is given twice"},
        {"ply\nfoo\n", "mesh.ply:2: unknown statement \"foo\""},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
         "mesh.ply:3: the vertices have no y"},
        {head + "end_header\n" + data, "mesh.ply: contains no faces"},
        {head + "element face 1\nend_header\n" + data,
         "mesh.ply:7: the element \"face\" has no list called \"vertex_indices\""},
        {head + "element face 1\nproperty int vertex_index\nend_header\n" + data,
         "mesh.ply:7: the element \"face\" has no list"},
        {"ply\nformat ascii 1.0\n" + faces + "3 0 1 2\n", "mesh.ply:3: there are no vertices"},
        {head + faces + data, "mesh.ply:13: face 0: the file ends too early"},
        {head + faces + data + "3 0 1\n", "mesh.ply:14: face 0: the file ends too early"},
        {head + faces + data + "3 0 1 3\n", "mesh.ply:13: face 0: vertex 3 does not exist: there are 3"},
        {head + faces + data + "3 0 1 -1\n", "mesh.ply:13: face 0: vertex -1 does not exist"},
        {head + faces + data + "3 0 1 1.5\n", "mesh.ply:13: face 0: \"1.5\" is not an integer"},
        {head + faces + data + "2 0 1\n", "mesh.ply:13: face 0: a face needs at least 3 corners, not 2"},
        {head + faces + data + "300 0 1 2\n", "\"300\" does not fit the type"},
        {head + faces + data + "3 0 1 2\nextra", "mesh.ply:14: the file goes on after its last element"},
        {head + faces + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "mesh.ply:11: vertex 1: \"nan\" is not a finite number"},
        {head + faces + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "mesh.ply:11: vertex 1: \"inf\" is not a finite number"},
        {head + "element face 1\nproperty list uchar float vertex_index\nend_header\n" + data + "3 0 1 1.5\n",
         "mesh.ply:13: face 0: vertex 1.5 does not exist"},
        {head + "element face 1\nproperty list uchar double vertex_index\nend_header\n" + data + "3 0 1 1e300\n",
         "mesh.ply:13: face 0: vertex 1e+300 does not exist"},
        {head + "element face 1\nproperty list float int vertex_index\nend_header\n" + data + "3.5 0 1 2\n",
         "mesh.ply:13: face 0: a list cannot have the length 3.5"},
        {head + "element face 1\nproperty list char int vertex_index\nend_header\n" + data + "-3 0 1 2\n",
         "mesh.ply:13: face 0: a list cannot have the length -3"},
        {"ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_index\nelement vertex 3\nproperty "
         "float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n3 0 1 3\n" +
             data,
         "mesh.ply:11: face 1: vertex 3 does not exist: there are 3"},
        {head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + data + "4 0 1 -1 2\n",
         "mesh.ply:13: tristrips 0: a face needs at least 3 corners, not 2"},
        {head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + data + "3 0 1 -2\n",
         "mesh.ply:13: tristrips 0: vertex -2 does not exist"},
        {"ply\rformat ascii 1.0\relement vertex 1\rproperty float x\rproperty float y\rproperty float z\r"
         "end_header\r0 0\ry\r",
         "mesh.ply:9: vertex 0: \"y\" is not a finite number"},
        {"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
         "z\n"
         "element face 1\nproperty list char int vertex_index\nend_header\n" +
             std::string(12, '\0') + '\x80' + std::string(512, '\0'),
         "mesh.ply: face 0: a list cannot have the length -128"},
        // Counts that would ask for terabytes.
        {"ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nproperty float y\nproperty float z\n" +
             faces + data,
         "mesh.ply:3: 999999999999 of the element \"vertex\" cannot be in the 18 bytes"},
        {"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
         "z\n"
         "element face 9000000000000000000\nproperty list int int vertex_index\nend_header\n" +
             std::string(40, '\0'),
         "mesh.ply:7: 9000000000000000000 of the element \"face\" cannot be in the 4 bytes"},
        {"ply\nformat ascii 1.0\nelement nothing 9000000000000000000\nelement vertex 0\nproperty float x\nproperty "
         "float y\n"
         "property float z\nend_header\n",
         "contains no faces"},
        {"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n" +
             faces + std::string("\0\0\0\0\x7f\xc0\0\0\0\0\0\0", 12) + std::string(4, '\0'),
         "mesh.ply: vertex 0: a number is not finite"},
    };
    for (const Case& c : cases) {
        const std::string message = message_of([&] { parse(c.text); });
        CHECK_MESSAGE(contains(message, c.message), message);
    }
}
