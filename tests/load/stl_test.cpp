#include "load/files.hpp"

#include <lightswitch/load/stl.hpp>

#include <bit>
#include <limits>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

using Corners = std::array<DVec3, 3>;
using Triangle = std::array<std::uint32_t, 3>;

Mesh parse(std::string_view bytes, Notices* notices = nullptr) {
    const Folder folder;
    return load_stl(folder.write("mesh.stl", bytes), FileNormals::use, notices);
}

void put(std::string& bytes, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

/// A binary file that begins with `name`.
std::string binary(std::string name, const std::vector<Corners>& facets) {
    name.resize(80, ' ');
    put(name, static_cast<std::uint32_t>(facets.size()));
    for (const Corners& corners : facets) {
        for (int c = 0; c < 3; ++c) put(name, 0x7fc00000u);  // the normals are not looked at
        for (const DVec3& corner : corners)
            for (int c = 0; c < 3; ++c) put(name, std::bit_cast<std::uint32_t>(static_cast<float>(corner[c])));
        name += "ab";
    }
    return name;
}

std::string ascii(const std::vector<Corners>& facets) {
    std::string text = "solid a name, facet\n";
    for (const Corners& corners : facets) {
        text += " facet normal 0 nan -0\n  outer loop\n";
        for (const DVec3& p : corners)
            text += "   vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid a name, facet\n";
}

const std::vector<Corners> pair{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}}}, {{{1, 1, 0.5}, {0, 1, -3}, {0, 0, 0}}}};

const std::string vertices = "vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 ";
const std::string facet = "facet normal 0 0 1 outer loop " + vertices + "endloop endfacet ";

}  // namespace

TEST_CASE("an STL file is read as text and as binary, whatever a binary one begins with") {
    for (const std::string& bytes : {ascii(pair), binary("", pair), binary("solid facet", pair)}) {
        const Mesh mesh = parse(bytes);
        CHECK(mesh.positions == std::vector<DVec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, -3}});
        CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 3, 0}});
        CHECK(mesh.normals.empty());
        CHECK(mesh.uvs.empty());
    }
}

TEST_CASE("corners of an STL file are one vertex only when they are equal to the last bit") {
    const double next = std::nextafter(1.0f, 2.0f);
    const Mesh mesh = parse(binary("", {{{{-0.0, 0, 1}, {1, 0, -0.0}, {0, 1, 0}}},
                                        {{{0, 0, 1}, {next, 0, 0}, {-0.0, 1, 0}}},
                                        {{{0, 0, next}, {1, 0, 0}, {0, 1, 0}}}}));
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}, {4, 1, 2}});
    CHECK_FALSE(std::signbit(mesh.positions[0].x));

    // Many, so that the table of vertices grows: a strip in which each corner but the outer ones occurs three times.
    constexpr std::uint32_t count = 30000;
    std::vector<Corners> strip;
    for (std::uint32_t i = 0; i < count; ++i)
        strip.push_back({DVec3(i, i % 2, 0), DVec3(i + 1, (i + 1) % 2, 0), DVec3(i + 2, i % 2, 0)});
    strip.push_back(strip[0]);
    const Mesh long_mesh = parse(binary("", strip));
    REQUIRE(long_mesh.positions.size() == count + 2);
    bool in_order = true;
    for (std::uint32_t i = 0; i < count; ++i)
        in_order = in_order && long_mesh.triangles[i] == Triangle{i, i + 1, i + 2};
    CHECK(in_order);
    CHECK(long_mesh.triangles.back() == Triangle{0, 1, 2});
}

TEST_CASE("text in an STL file may be written in capitals, with any white space, and hold several solids") {
    const std::string solid =
        "SOLID\r\n Facet NORMAL 0 0 1\touter\r\nLOOP vertex 0 0 +0 VERTEX 1e0 0 0\n\nvertex 0 .1e1 "
        "-0 EndLoop\rendfacet\r\nEndSolid\r\n";
    CHECK(parse("\xef\xbb\xbf" + solid + "\n" + solid).triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}});
    CHECK(parse("solid " + std::string(200, 'n') + "\n" + facet + "endsolid").triangles.size() == 1);
}

TEST_CASE("facets of an STL file without area are dropped with a notice") {
    const std::vector<Corners> facets{
        pair[0], {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}}, pair[1], {{{0, 0, 0}, {7, 7, 7}, {2, 2, 2}}}};
    for (const bool is_binary : {false, true}) {
        Notices notices;
        const Mesh mesh = parse(is_binary ? binary("", facets) : ascii(facets), &notices);
        CHECK(mesh.triangles.size() == 2);
        CHECK(mesh.positions.size() == 4);
        REQUIRE(notices.size() == 1);
        CHECK_MESSAGE(contains(notices[0], std::string("mesh.stl:") + (is_binary ? " facet 1" : "9") +
                                               ": the facet has no area and is dropped (2 times)"),
                      notices[0]);
    }
    CHECK(contains(message_of([&] { parse(binary("", {facets[1]})); }), "mesh.stl: contains no facets with an area"));
}

TEST_CASE("malformed STL files are refused with the line or the facet") {
    const std::string good = binary("solid", pair);
    // Cut anywhere, a file is refused: no byte is optional.
    for (std::size_t size = 0; size < good.size(); ++size)
        CHECK(message_of([&] { parse(good.substr(0, size)); }) != "no error");
    CHECK(contains(message_of([&] { parse(good + "x"); }), "2 facets has 184 bytes, not 185"));
    std::string infinite = good;
    infinite.replace(84 + 50 + 12 + 4 * 8, 4, std::string("\0\0\x80\x7f", 4));
    CHECK(contains(message_of([&] { parse(infinite); }), "mesh.stl: facet 1: a number is not finite"));
    std::string many = binary("", pair);
    many.replace(80, 4, "\xff\xff\xff\xff");
    CHECK(contains(message_of([&] { parse(many); }), "4294967295 facets has 214748364834 bytes, not 184"));

    struct Case {
        std::string text;
        std::string_view message;
    };
    const Case cases[] = {
        {"", "mesh.stl: is not an STL file: it does not begin with \"solid\""},
        {"ply\n", "mesh.stl: is not an STL file"},
        {std::string(84, '\0'), "mesh.stl: contains no facets"},
        {"solid", "mesh.stl:1: the file ends too early: \"endsolid\" is missing"},
        {"solid a\nendsolid\n", "mesh.stl: contains no facets"},
        {"solid\n" + facet, "mesh.stl:2: the file ends too early: \"endsolid\" is missing"},
        {"solid\nfacet\n", "mesh.stl:3: the file ends too early"},
        {"solid\nfacet normal 0 0", "mesh.stl:2: the file ends too early"},
        {"solid\nfacet normal 0 0 1\nouter loop\n" + vertices + "vertex 1 1 1 endloop",
         "mesh.stl:4: \"vertex\" instead of \"endloop\""},
        {"solid\nfacet normal 0 0 1\nouter loop\nvertex 1 1 1 endloop",
         "mesh.stl:4: \"endloop\" instead of \"vertex\""},
        {"solid\nfacet normal 0 0 1 outer loop\nvertex 1 nan 1", "mesh.stl:3: \"nan\" is not a finite number"},
        {"solid\r\nfacet normal 0 0 1 outer loop\rvertex 1 1 1e999", "mesh.stl:3: \"1e999\" is not a finite number"},
        {"solid\nfacet normal 0 0 1 outer loop\nvertex 1 1", "mesh.stl:3: the file ends too early"},
        {"solid\n" + facet + "solid\n", "mesh.stl:2: \"solid\" instead of \"facet\" or \"endsolid\""},
        {"solid\n" + facet + "endsolid\n" + facet, "mesh.stl:3: \"facet\" instead of \"solid\""},
        {"solid\n" + facet + "endsolid\n\n<\xff\n", "mesh.stl:4: \"<?\" instead of \"solid\""},
    };
    for (const Case& c : cases) {
        const std::string message = message_of([&] { parse(c.text); });
        CHECK_MESSAGE(contains(message, c.message), message);
    }
}

TEST_CASE("changed STL files load or are refused") {
    for (const std::string& file : {ascii(pair), binary("solid", pair)}) {
        int loaded = 0;
        for (std::uint32_t seed = 0; seed < 700; ++seed) {
            try {
                const Mesh mesh = parse(mutated(file, seed));
                ++loaded;
                bool in_range = true;
                for (const Triangle& triangle : mesh.triangles)
                    for (const std::uint32_t corner : triangle) in_range = in_range && corner < mesh.positions.size();
                CHECK(in_range);
            } catch (const Error&) {
            }
        }
        CHECK_MESSAGE((loaded > 7 && loaded < 700), loaded);
    }
}
