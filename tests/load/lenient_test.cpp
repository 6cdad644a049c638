#include "load/files.hpp"

#include <lightswitch/load/mitsuba_camera.hpp>
#include <lightswitch/load/scene_file.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

struct Read {
    LibraryDescription scene;
    Problems problems;
};

/// A scene of a default camera and `text`, which begins in line 2, read leniently. It must be fit to be built.
Read lenient(const std::string& text, const std::string& version = "3.0.0", const std::string& sensor = "") {
    const Folder folder;
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("broken.obj", "v 0 0 0\nv 1 0 x\n");
    for (const char* name : {"broken.hdr", "broken.png", "broken.spd"}) folder.write(name, "what");
    folder.write("grey.spd", "400 0.5\n700 0.5\n");
    folder.write("parts.xml", "<scene version=\"3.0.0\"/>");
    const auto path = folder.write(
        "room.xml", "<scene version=\"" + version + "\"><sensor type=\"perspective\"/>\n" + text + "</scene>");
    Read result;
    result.scene = load_mitsuba(
        path, MitsubaOptions{.strictness = Strictness::lenient, .sensor = sensor, .problems = &result.problems});
    CHECK_NOTHROW(detail::check(result.scene));
    for (const Problem& problem : result.problems) {
        CHECK(contains(problem.text, "room.xml"));
        CHECK(problem.text.find('\n') == std::string::npos);
        CHECK_FALSE(problem.instead.empty());
    }
    return result;
}

/// The material of a rectangle, and what was done for it, which must be one thing.
LibraryDescription::NamedMaterial material(const std::string& bsdf, const std::string& instead) {
    const Read read = lenient("<shape type=\"rectangle\">" + bsdf + "</shape>");
    CHECK_MESSAGE(read.problems.size() == 1, bsdf);
    if (read.problems.size() == 1) CHECK(read.problems[0].instead == instead);
    return read.scene.materials.at(read.scene.shapes.at(0).material);
}

const std::string metal = "<bsdf type=\"conductor\"/>";

}  // namespace

TEST_CASE("a strict reading tells all problems of a file, in the order of reading") {
    const Folder folder;
    const auto path = folder.write("room.xml",
                                   "<scene version=\"3.0.0\">\n"
                                   "<bsdf type=\"hair\" id=\"fur\"/>\n"
                                   "<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>\n"
                                   "<shape type=\"cube\"><ref id=\"fur\"/><float name=\"size\" value=\"1\"/></shape>\n"
                                   "<emitter type=\"sun\"/>\n</scene>");
    Problems told;
    try {
        load_mitsuba(path, MitsubaOptions{.problems = &told});
        FAIL("no error");
    } catch (const UnsupportedScene& error) {
        REQUIRE(error.problems().size() == 4);  // the bsdf once, though it is used
        CHECK(error.what() == error.problems()[0].text);
        const char* const places[] = {"room.xml:2: <bsdf type=\"hair\">: ", "room.xml:3: <shape type=\"obj\">: ",
                                      "room.xml:4: <shape type=\"cube\">: ", "room.xml:5: <emitter type=\"sun\">: "};
        const char* const instead[] = {"it is diffuse", "it is left out", "it is ignored", "it is left out"};
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(contains(error.problems()[i].text, places[i]));
            CHECK(error.problems()[i].instead == instead[i]);
            CHECK(told[i].text == error.problems()[i].text);
        }
    }
    CHECK_THROWS_AS(load_mitsuba(path), UnsupportedScene);
}

TEST_CASE("surface models that are not known are the one inside, or diffuse") {
    const std::string inside = "the bsdf inside takes its place", diffuse = "it is diffuse";
    CHECK(material("<bsdf type=\"hair\"/>", diffuse).bsdf.as<Lambert>().reflectance == Rgb(0.5f));
    CHECK(material("<bsdf type=\"hk\"><rgb name=\"reflectance\" value=\"0.1 0.2 0.3\"/></bsdf>", diffuse)
              .bsdf.as<Lambert>()
              .reflectance == Rgb(0.1f, 0.2f, 0.3f));
    for (const char* type : {"varnish", "sssbrdf"})
        CHECK(material("<bsdf type=\"" + std::string(type) + "\">" + metal + "</bsdf>", inside).bsdf.get<Conductor>());
    const Read both = lenient("<shape type=\"cube\"><bsdf type=\"lacquer\"><bsdf type=\"varnish\">" + metal +
                              "</bsdf></bsdf></shape>");
    CHECK(both.problems.size() == 2);
    CHECK(both.scene.materials[both.scene.shapes[0].material].bsdf.get<Conductor>());
}

TEST_CASE("layers that cannot be are left out") {
    const std::string inside = "the bsdf inside takes its place";
    CHECK(material("<bsdf type=\"twosided\"><bsdf type=\"dielectric\"/></bsdf>", inside).bsdf.get<Dielectric>());
    CHECK(material("<bsdf type=\"twosided\"><bsdf type=\"twosided\">" + metal + "</bsdf></bsdf>", inside).two_sided);
    CHECK(material("<bsdf type=\"normalmap\"><texture name=\"normalmap\" type=\"bitmap\"><string name=\"filename\" "
                   "value=\"no.png\"/></texture>" +
                       metal + "</bsdf>",
                   inside)
              .bsdf.get<Conductor>());
    CHECK(material("<bsdf type=\"mask\"><rgb name=\"opacity\" value=\"3\"/>" + metal + "</bsdf>", inside)
              .bsdf.get<Conductor>());
    // Two that contain each other end in grey.
    const Read loop = lenient(
        "<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"
        "<shape type=\"cube\"><ref id=\"a\"/></shape>");
    CHECK(loop.scene.materials[loop.scene.shapes[0].material].bsdf.get<Lambert>());
}

TEST_CASE("values out of range are the nearest, or the default") {
    CHECK(material("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1.5 0.5 0.5\"/></bsdf>", "it is 1")
              .bsdf.as<Lambert>()
              .reflectance == Rgb(1, 0.5f, 0.5f));
    CHECK(material("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"-1\"/></bsdf>", "it is 0.0001")
              .bsdf.as<RoughConductor>()
              .alpha_u == 1e-4f);
    CHECK(material("<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"7\"/></bsdf>", "it is 1")
              .bsdf.as<RoughPlastic>()
              .alpha == 1);
    CHECK(material("<bsdf type=\"conductor\"><rgb name=\"k\" value=\"1 0 1\"/></bsdf>", "it reflects everything there")
              .bsdf.as<Conductor>()
              .k == Rgb(1));
    CHECK(material("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"x\"/></bsdf>", "it is ignored")
              .bsdf.as<RoughConductor>()
              .alpha_u == 0.1f);
    CHECK(material("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"jelly\"/></bsdf>", "it is \"bk7\"")
              .bsdf.as<Dielectric>()
              .eta > 1.5f);
    const auto phong =
        material(
            "<bsdf type=\"phong\"><texture type=\"checkerboard\" name=\"diffuse_reflectance\"><rgb name=\"color0\" "
            "value=\"0.9\"/></texture><rgb name=\"specular_reflectance\" value=\"0.4\"/></bsdf>",
            "its lobe is darkened")
            .bsdf.as<Textured<ModifiedPhong>>();
    CHECK(phong.problem().empty());
}

TEST_CASE("textures that are not known or not there are middle grey") {
    for (const char* texture :
         {"<texture name=\"reflectance\" type=\"wood\"/>", "<ref name=\"reflectance\" id=\"none\"/>",
          "<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
          "value=\"no.png\"/></texture>"}) {
        const auto read = material("<bsdf type=\"diffuse\">" + std::string(texture) + "</bsdf>", "it is middle grey");
        CHECK(read.bsdf.as<Textured<Lambert>>().at({Vec2(0.3f), SurfacePoint{}}).reflectance == Rgb(0.5f));
    }
}

TEST_CASE("shapes that cannot be read are left out, and instances of nothing, too") {
    const Read read = lenient(
        "<shape type=\"cube\"/><shape type=\"heightfield\"/><shape type=\"obj\"><string name=\"filename\" "
        "value=\"broken.obj\"/></shape>"
        "<shape type=\"disk\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape>"
        "<shape type=\"shapegroup\" id=\"g\"><shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>"
        "</shape><shape type=\"instance\"><ref id=\"g\"/></shape><shape type=\"sphere\"/>");
    CHECK(read.scene.shapes.size() == 2);
    CHECK(read.scene.groups.empty());
    CHECK(read.scene.instances.empty());
    CHECK(read.problems.size() == 5);  // three shapes, the mesh in the group, and the group; the instance says the same
}

TEST_CASE("lamps that cannot be are left out, and masks on them") {
    const Read read = lenient(
        "<emitter type=\"projector\"/><emitter type=\"constant\"/><emitter type=\"constant\"/><emitter type=\"spot\">"
        "<float name=\"cutoff_angle\" value=\"-4\"/></emitter>"
        "<shape type=\"cube\"><emitter type=\"directionalarea\"/></shape>"
        "<shape type=\"disk\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"-1\"/></emitter></shape>"
        "<shape type=\"disk\"><emitter type=\"area\"/><bsdf type=\"mask\"><bsdf type=\"conductor\"/></bsdf></shape>"
        "<shape type=\"sphere\"><emitter type=\"area\"><texture name=\"radiance\" type=\"checkerboard\"><rgb "
        "name=\"color0\" value=\"1\"/><rgb name=\"color1\" value=\"0\"/></texture></emitter></shape>");
    CHECK(read.scene.sources.size() == 1);
    REQUIRE(read.scene.shapes.size() == 4);
    CHECK_FALSE(read.scene.shapes[0].emission);
    CHECK_FALSE(read.scene.shapes[1].emission);
    CHECK(read.scene.shapes[2].emission == Rgb(1));
    CHECK(read.scene.materials[read.scene.shapes[2].material].bsdf.get<Conductor>());
    CHECK(read.scene.shapes[3].emission == Rgb(0.5f));
    CHECK(read.problems.size() == 7);
    const Read sky = lenient("<emitter type=\"sunsky\"><float name=\"turbidity\" value=\"3\"/></emitter>");
    CHECK(sky.scene.sources.at(0).source.get<EnvironmentSource>()->radiance == Rgb(1));
}

TEST_CASE("cameras, films and filters that are not known are the usual ones") {
    const Folder folder;
    Problems problems;
    const auto path = folder.write(
        "room.xml",
        "<scene version=\"3.0.0\"><sensor type=\"fisheye\"><float name=\"fov\" value=\"30\"/><transform "
        "name=\"to_world\"><scale value=\"3\"/><translate x=\"1\"/></transform><film type=\"specfilm\"><integer "
        "name=\"width\" value=\"64\"/><integer name=\"height\" value=\"-2\"/><rfilter "
        "type=\"windowed\"/></film></sensor>"
        "</scene>");
    const auto scene = load_mitsuba(path, MitsubaOptions{.strictness = Strictness::lenient, .problems = &problems});
    CHECK(scene.camera.fov == 30);
    CHECK(scene.camera.to_world == DMat4{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 0, 1}});
    CHECK(scene.film.width == 64);
    CHECK(scene.film.height == 576);
    CHECK(scene.film.filter.kind() == Filter::Kind::gaussian);
    CHECK(problems.size() == 5);
    // A camera keeps its side when its scale is taken out.
    const DMat4 mirrored{{-2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {1, 2, 3, 1}};
    CHECK(detail::without_scale(mirrored) == DMat4{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1, 2, 3, 1}});
}

TEST_CASE("what has no type, but needs one, is left out or the usual one") {
    for (const char* bsdf : {"<bsdf/>", "<bsdf><rgb name=\"reflectance\" value=\"0.1\"/></bsdf>"}) {
        const auto read = material(bsdf, "it is diffuse");
        CHECK(read.bsdf.as<Lambert>().reflectance == Rgb(0.5f));
    }
    CHECK(material("<bsdf>" + metal + "</bsdf>", "the bsdf inside takes its place").bsdf.get<Conductor>());
    const Read integrator = lenient("<integrator><integer name=\"max_depth\" value=\"7\"/></integrator>");
    REQUIRE(integrator.problems.size() == 1);
    CHECK(contains(integrator.problems[0].text, "<integrator>: the attribute \"type\" is missing"));
    CHECK(integrator.problems[0].instead == "it is ignored");
    CHECK_FALSE(integrator.scene.max_depth);

    const Read sampler = lenient(
        "<sensor type=\"perspective\" id=\"seen\"><float name=\"fov\" value=\"30\"/><sampler><integer "
        "name=\"sample_count\" value=\"7\"/></sampler></sensor>",
        "3.0.0", "seen");
    REQUIRE(sampler.problems.size() == 1);
    CHECK(contains(sampler.problems[0].text, "<sampler>: the attribute \"type\" is missing"));
    CHECK(sampler.problems[0].instead == "it is ignored");
    CHECK(sampler.scene.camera.fov == 30);
    CHECK_FALSE(sampler.scene.samples);
}

TEST_CASE("instances that cannot be built are left out, and others stay") {
    const auto instance = [](const std::string& scale) {
        return "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><scale " + scale +
               "/></transform></shape>";
    };
    const Read read =
        lenient("<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>" + instance("value=\"2\"") +
                instance("x=\"0.0001\"") + instance("y=\"0\"") + instance("value=\"1e-3\""));
    CHECK(read.scene.instances.size() == 2);
    REQUIRE(read.problems.size() == 2);
    CHECK(contains(read.problems[0].text, "squeezes the group by more than 1 : 1000"));
    CHECK(contains(read.problems[1].text, "cannot be inverted"));
    for (const Problem& problem : read.problems) CHECK(problem.instead == "it is left out");
}

TEST_CASE("all files that were opened are known, also those that are damaged") {
    const auto string = [](const std::string& name) { return "<string name=\"filename\" value=\"" + name + "\"/>"; };
    const auto read = lenient(
        "<shape type=\"obj\">" + string("broken.obj") + "</shape><emitter type=\"envmap\">" + string("broken.hdr") +
        "</emitter><shape type=\"obj\">" + string("triangle.obj") + "<bsdf type=\"diffuse\"><spectrum " +
        "name=\"reflectance\" filename=\"grey.spd\"/></bsdf></shape><shape type=\"obj\">" + string("triangle.obj") +
        "</shape><texture type=\"bitmap\">" + string("broken.png") + "</texture><bsdf type=\"diffuse\"><spectrum " +
        "name=\"reflectance\" filename=\"broken.spd\"/></bsdf><shape type=\"obj\">" + string("none.obj") +
        "</shape><include filename=\"parts.xml\"/>");
    std::multiset<std::string> names;
    for (const std::string& file : read.scene.files) names.insert(std::filesystem::path(file).filename().string());
    CHECK(names == std::multiset<std::string>{"broken.hdr", "broken.obj", "broken.png", "broken.spd", "grey.spd",
                                              "parts.xml", "room.xml", "triangle.obj"});
}

TEST_CASE("what is not understood in the file itself is passed over") {
    const Read read = lenient(
        "words <bsdf type=\"diffuse\" id=\"a\" colour=\"1\"/><bsdf type=\"conductor\" id=\"a\"/><default name=\"\" "
        "value=\"1\"/><alias id=\"nothing\" as=\"b\"/><include filename=\"none.xml\"/><path value=\"none\"/>"
        "<shape type=\"cube\"><ref id=\"a\"/><ref id=\"none\"/><fog density=\"1\"/></shape><float name=\"x\" "
        "value=\"1\"/>",
        "7");
    CHECK(read.scene.materials[read.scene.shapes.at(0).material].bsdf.get<Lambert>());
    CHECK(read.problems.size() == 10);
    CHECK(lenient("<shape type=\"cube\"><medium type=\"homogeneous\" name=\"interior\"><float name=\"albedo\" "
                  "value=\"1\"/></medium></shape>")
              .scene.shapes.size() == 1);
    const Read undefined = lenient("<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>");
    CHECK(std::get<Sphere>(undefined.scene.shapes.at(0).geometry).radius == 1);
}

TEST_CASE("a lenient reading fails only where there is no scene") {
    for (const char* text :
         {"", "<scene version=\"3.0.0\">", "<bsdf type=\"diffuse\"/>", "<!DOCTYPE a><scene version=\"3.0.0\"/>"}) {
        const Folder folder;
        const auto path = folder.write("room.xml", text);
        CHECK_THROWS_AS(load_mitsuba(path, MitsubaOptions{.strictness = Strictness::lenient}), Error);
    }
}
