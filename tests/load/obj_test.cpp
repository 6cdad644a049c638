#include "load/files.hpp"
#include "support/paths.hpp"

#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

Mesh parse(std::string_view text, FileNormals normals = FileNormals::use) {
    const Folder folder;
    return load_obj(folder.write("mesh.obj", text), normals);
}

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::string_view corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("an OBJ polygon becomes a fan around its first corner") {
    const Mesh mesh = parse(std::string(corners) + "v 0 .5 0\nf 1 2 3 4 5\n");
    CHECK(mesh.positions.size() == 5);
    CHECK(mesh.positions[2] == DVec3(1, 1, 0));
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    CHECK(mesh.normals.empty());
}

TEST_CASE("OBJ numbers keep double precision") {
    const Mesh mesh = parse("v 10000000.123456789 +1e-3 -2E2\nv 1 0 0\nv 0 1 0\nf 1 2 3");
    CHECK(mesh.positions[0] == DVec3(10000000.123456789, 1e-3, -200));
}

TEST_CASE("negative OBJ indices count back from the last definition") {
    const Mesh mesh = parse("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -2 -1");
    CHECK(mesh.positions[0] == DVec3(0));
    CHECK(mesh.positions[3] == DVec3(5, 5, 5));
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("all forms of OBJ corners are read") {
    const std::string head = std::string(corners) + "vt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 0 2\n";
    CHECK(parse(head + "f 1/1 2/2 3/1").positions.size() == 3);
    CHECK(parse(head + "f 1/ 2// 3/1/").positions.size() == 3);
    CHECK(parse(head + "f 1/1/ 2/1/ 3/1/").normals.empty());
    CHECK(parse(head + "f 1//1 2//1 3//2").normals == std::vector<DVec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 2}});
    CHECK(parse(head + "f 1/1/1 2/2/1 3/1/-1").normals[2] == DVec3(0, 0, 2));
    // One position with two texture coordinates or normals is two vertices, unless normals are ignored.
    CHECK(parse(head + "f 1/1 2/1 3/1\nf 1/2 3/1 4/1").positions.size() == 5);
    CHECK(parse(head + "f 1//1 2//1 3//1\nf 1//2 3//1 4//1").positions.size() == 5);
    const Mesh flat = parse(head + "f 1/1/1 2/1/1 3/1/1\nf 1/2/2 3 4/1/1", FileNormals::ignore);
    CHECK(flat.positions.size() == 6);
    CHECK(flat.uvs.size() == 6);
    CHECK(flat.normals.empty());
}

TEST_CASE("corners at a position with many texture coordinates and normals are told apart") {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 2\n";
    constexpr std::uint32_t uvs = 200;
    for (std::uint32_t i = 0; i < uvs; ++i) text += "vt " + std::to_string(i) + " 0\n";
    // Each corner of the first vertex comes up three times.
    for (int round = 0; round < 3; ++round)
        for (std::uint32_t i = 1; i <= uvs; ++i)
            for (const char* normal : {"/1", "/2"}) text += "f 1/" + std::to_string(i) + normal + " 2/1/1 3/1/1\n";
    const Mesh mesh = parse(text);
    REQUIRE(mesh.triangles.size() == 6 * uvs);
    CHECK(mesh.positions.size() == 2 * uvs + 2);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t vertex = mesh.triangles[t][0];
        REQUIRE(mesh.uvs[vertex].x == static_cast<float>(t / 2 % uvs));
        REQUIRE(mesh.normals[vertex].z == 1 + t % 2);
        REQUIRE(vertex == mesh.triangles[t % (2 * uvs)][0]);
    }
}

TEST_CASE("OBJ files larger than a piece of what is read at a time keep their line numbers") {
    // Lines of all kinds, among them continued ones, lie across the ends of pieces.
    std::string text = std::string(corners);
    int line = 4;
    while (text.size() < 2000000) {
        text += "f 1 2 3\nf 1 \\\n 2 4 # here\n# \\\nv 0.25 1e3 -7\n\n";
        line += 6;
    }
    const Mesh mesh = parse(text);
    CHECK(mesh.triangles.size() == static_cast<std::size_t>(line - 4) / 3);
    CHECK(mesh.positions.size() == 4);
    CHECK(contains(message_of([&] { parse(text + "f 1 2 x"); }), "mesh.obj:" + std::to_string(line + 1) + ": \"x\""));
}

TEST_CASE("the normals of an OBJ file decide the front") {
    const std::string text = std::string(corners) + "vn 0 0 -1\nf 1//1 2//1 3//1\n";
    CHECK(parse(text).triangles == std::vector<Triangle>{{0, 2, 1}});
    CHECK(parse(text, FileNormals::ignore).triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("OBJ comments, CRLF, continued lines and statements without geometry are passed over") {
    const Mesh mesh = parse(
        "# made by hand\r\nmtllib a.mtl\r\no thing\r\ng part\r\ns off\r\nusemtl red\r\n\r\n"
        "v 0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\nv 0 1 0 0.5 0.5 0.5\r\nv 0 0 1 1\r\nl 1 2\r\np 1\r\n  f 1\\\r\n 2 3");
    CHECK(mesh.positions.size() == 3);
    CHECK(mesh.positions[1] == DVec3(1, 0, 0));
    CHECK(mesh.triangles.size() == 1);
}

TEST_CASE("mesh files of other programs are all the same square") {
    struct Case {
        const char* file;
        std::vector<std::string> notices;
    };
    const std::string normal = "the corner has no normal or one of length 0";
    const Case cases[] = {
        {"bom.obj", {}},
        {"call.obj", {":1: the statement \"call\" is skipped"}},
        {"cr.obj", {}},
        {"faces_first.ply", {}},
        {"float_list.ply", {}},
        {"mixed_normals.obj", {":7: " + normal}},
        {"slash_empty.obj", {}},
        {"slash_tex_trail.obj", {}},
        {"usemap.obj", {":5: the statement \"maplib\"", ":6: the statement \"c_i", ":7: the statement \"d_i"}},
        {"zero_normal.obj", {":6: " + normal}},
    };
    for (const Case& c : cases)
        for (const FileNormals use : {FileNormals::use, FileNormals::ignore}) {
            const auto path = std::filesystem::path(test::folder()) / "data/mesh-files" / c.file;
            Notices notices;
            const Mesh mesh =
                path.extension() == ".obj" ? load_obj(path, use, &notices) : load_ply(path, use, &notices);
            DVec3 area(0);
            for (const auto& [i, j, k] : mesh.triangles)
                area += 0.5 * glm::cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
            CHECK_MESSAGE(area == DVec3(0, 0, 4), c.file);
            CHECK(mesh.triangles.size() == 2);
            for (const DVec3& p : mesh.positions) CHECK(glm::abs(p) == DVec3(1, 1, 0));
            for (const DVec3& n : mesh.normals) CHECK(n == DVec3(0, 0, 1));
            if (use == FileNormals::ignore && contains(c.file, "normal")) {
                CHECK(notices.empty());
                continue;
            }
            REQUIRE_MESSAGE(notices.size() == c.notices.size(), c.file);
            for (std::size_t i = 0; i < notices.size(); ++i)
                CHECK_MESSAGE(contains(notices[i], c.file + c.notices[i]), notices[i]);
        }
}

TEST_CASE("OBJ statements without use are skipped, with one notice for each kind") {
    Notices notices;
    const Folder folder;
    const std::string unused =
        "vp 0.5\ncstype rat bspline\ndeg 3\nbmat u 1 0 0 1\nstep 1\np 1\nl 1 2\ncurv 0 1 1 2\ncurv2 1 2\nsurf 0 1 0 1 "
        "1 2\nparm u 0 1\ntrim 0 1 1\nhole 0 1 1\nscrv 0 1 1\nsp 1\nend\ncon 1 0 1 1 2 0 1 1\nmg 1 0.5\nbevel "
        "on\nc_interp on\nd_interp on\nlod 1\nusemap off\nmaplib a\nshadow_obj a\ntrace_obj a\nctech cparm "
        "1\nstech cspace 1\ncall a.obj\ncsh -echo\nbsp 1\nbzp 1\ncdc 1\ncdp 1\nres 1 1\n";
    const auto kinds = static_cast<std::size_t>(std::count(unused.begin(), unused.end(), '\n'));
    const Mesh mesh = load_obj(folder.write("mesh.obj", std::string(corners) + unused + unused +
                                                            "o a\ng a\ns 1\nmtllib a\nusemtl "
                                                            "a\nfo 1 2 3\n"),
                               FileNormals::use, &notices);
    CHECK(mesh.triangles.size() == 1);
    CHECK(notices.size() == kinds);
    for (const std::string& notice : notices) CHECK_MESSAGE(notice.ends_with("\" is skipped (2 times)"), notice);
    CHECK_MESSAGE(contains(notices.at(6), "mesh.obj:11: the statement \"l\""), notices[6]);
}

TEST_CASE("OBJ lines end in LF, CRLF or CR") {
    const std::string lines[] = {"\xef\xbb\xbfv 0 0 0", "v 1 0 \\", "0", "", "v 0 1 0 # corner", "f 1 2 3"};
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const std::string& line : lines) text += line + end;
        const Mesh mesh = parse(text);
        CHECK(mesh.positions == std::vector<DVec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(contains(message_of([&] { parse(text + "f 1 2 9"); }), "mesh.obj:7: vertex 9 does not exist"));
    }
    CHECK(parse("v 0 0 0\nv 1 0 0\rv 0 1 0\r\nf 1 2 3\r").triangles.size() == 1);
}

TEST_CASE("OBJ corners without a normal get one from the triangles around them") {
    // Two squares that meet at a right angle in the y axis; the second one has no normals, or some of length 0.
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nvn 0 0 1\nvn 0 0 0\nf 1//1 2//1 3//1 4//1\n";
    const Mesh without = parse(text + "f 5 1 4 6\n"), zero = parse(text + "f 5//2 1//2 4//2 6//2\n");
    CHECK(without.positions.size() == 8);
    for (const Mesh& mesh : {without, zero})
        for (std::size_t i = 0; i < 8; ++i)
            CHECK(glm::length(mesh.normals[i] - (i < 4 ? DVec3(0, 0, 1) : DVec3(1, 0, 0))) < 1e-15);
    // The normals that there are still decide the front.
    const Mesh turned = parse(std::string(corners) + "vn 0 0 -1\nf 1//1 2 3\n");
    CHECK(turned.triangles == std::vector<Triangle>{{0, 2, 1}});
    CHECK(turned.normals == std::vector<DVec3>(3, DVec3(0, 0, -1)));
}

TEST_CASE("malformed OBJ files are refused with the line") {
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    struct Case {
        std::string text;
        std::string_view message;
    };
    const Case cases[] = {
        {"", "mesh.obj: contains no faces"},
        {v, "mesh.obj: contains no faces"},
        {v + "f 1 2", "mesh.obj:4: a face needs at least 3 corners, not 2"},
        {v + "f 1 2 4", "mesh.obj:4: vertex 4 does not exist: 3 are defined above"},
        {v + "f 1 2 0", "mesh.obj:4: vertex 0 does not exist"},
        {v + "f 1 2 -4", "mesh.obj:4: vertex -4 does not exist"},
        {v + "f 1 2 99999999999999999999", "mesh.obj:4: \"99999999999999999999\" is not an index"},
        {v + "f 1 2 3x", "mesh.obj:4: \"3x\" is not an index"},
        {v + "f 1 2 3///", "mesh.obj:4: \"3///\" is not a corner"},
        {v + "f 1 2 //", "mesh.obj:4: \"//\" is not a corner"},
        {v + "f 1 2 3/1", "mesh.obj:4: texture coordinate 1 does not exist: 0 are"},
        {v + "f 1 2 3//1", "mesh.obj:4: normal 1 does not exist"},
        {v + "f 1 2 /1/1", "is not a corner"},
        {v + "vn 0 0 1\nf 1/1/1/1 2 3", "mesh.obj:5: "},
        {v + "vt 1\nvn 0 0 1\nf 1/1/1/1 2 3", "mesh.obj:6: \"1/1/1/1\" is not a corner"},
        {"v 0 0\n", "mesh.obj:1: \"v\" takes 3 to 7 numbers, not 2"},
        {"v 0 0 nan\n", "mesh.obj:1: \"nan\" is not a finite number"},
        {"v 0 0 inf\n", "mesh.obj:1: \"inf\" is not a finite number"},
        {"v 0 0 1e999\n", "mesh.obj:1: \"1e999\" is not a finite number"},
        {"v 0 0 1.5.2\n", "mesh.obj:1: \"1.5.2\" is not a finite number"},
        {"v 0 0 1,5\n", "mesh.obj:1: \"1,5\" is not a finite number"},
        {"v 0 0 0\n\nv \\\n 1 \\\n 2\nv 1 2 z", "mesh.obj:3: \"v\" takes 3 to 7 numbers, not 2"},
        {"v 0 0 0\nv 1 \\\n 2 3\nv 1 2 z", "mesh.obj:4: \"z\" is not"},
        {"vn 1 2 3 4\n", "mesh.obj:1: \"vn\" takes 3 numbers, not 4"},
        {"v 0 0 0\rv 1 0 x\r", "mesh.obj:2: \"x\" is not a finite number"},
        {"cstype bezier\n", "mesh.obj: contains no faces"},
        {"CSTYPE bezier\n", "mesh.obj:1: unknown statement \"CSTYPE\""},
        {std::string("\x7f"
                     "ELF\x02\x01\0\0",
                     8),
         "mesh.obj:1: unknown statement \"?ELF????\""},
    };
    for (const Case& c : cases) {
        const std::string message = message_of([&] { parse(c.text); });
        CHECK_MESSAGE(contains(message, c.message), message);
    }
}

TEST_CASE("an OBJ that is no file is refused") {
    const Folder folder;
    CHECK(contains(message_of([&] { load_obj(folder.path() / "none.obj"); }), "none.obj: no such file"));
    CHECK(contains(message_of([&] { load_obj(folder.path()); }), "is a directory"));
}
