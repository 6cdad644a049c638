// What the program says of mesh files that hold what it skips or guesses.

#include "program/process.hpp"
#include "support/relative.hpp"

#include <lightswitch/film/image_io.hpp>

using namespace lightswitch::test;

TEST_CASE("notices on mesh files are warnings, once each, unless --quiet") {
    const Folder workspace;
    workspace.write("a.obj", "l 1 1\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n");
    // The second one hides behind the first.
    const std::string shape =
        "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/><transform name=\"to_world\"><translate "
        "z=\"-1\"/></transform></shape>";
    workspace.write(
        "s.xml",
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
        "<transform name=\"to_world\"><lookat origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
        "<film type=\"hdrfilm\"><integer name=\"width\" value=\"24\"/><integer name=\"height\" value=\"24\"/>"
        "<rfilter type=\"box\"/></film></sensor><shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/>"
        "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.8\"/></bsdf></shape>" +
            shape + "<emitter type=\"directional\"><vector name=\"direction\" value=\"0,0,-1\"/></emitter></scene>");
    const std::string warnings =
        "lightswitch: warning: a.obj:1: the statement \"l\" is skipped\n"
        "lightswitch: warning: a.obj:8: the corner has no normal or one of length 0: it is computed from the triangles "
        "around it (3 times)\n";

    const Ended ended = run(workspace, {"render", "s.xml", "--spp", "4", "--output", "a.pfm"});
    CHECK(ended.status == 0);
    CHECK(ended.err == warnings);
    CHECK(lightswitch::load_image(workspace / "a.pfm").mean().x == lightswitch::test::relative(0.09284, 1e-4));
    const Ended info = run(workspace, {"info", "s.xml"});
    CHECK(info.status == 0);
    CHECK(info.err == warnings);

    const Ended quiet = run(workspace, {"render", "s.xml", "--spp", "4", "--output", "b.pfm", "--quiet"});
    CHECK(quiet.status == 0);
    CHECK(quiet.err == "");
    CHECK(read_text(workspace / "a.pfm") == read_text(workspace / "b.pfm"));
}
