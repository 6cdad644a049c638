#include "../support/relative.hpp"
#include "load/files.hpp"

#include <lightswitch/load/mitsuba.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr std::string_view camera = "<sensor type=\"perspective\"/>";

LibraryDescription parse(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    const Folder folder;
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("downward.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
    folder.write("triangle.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                 "z\nelement face 1\n"
                 "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    return load_mitsuba(folder.write("room.xml", "<scene version=\"3.0.0\">\n" + text + "</scene>"), defines);
}

/// A scene of a default camera and `text`.
LibraryDescription scene(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    return parse(std::string(camera) + text, defines);
}

LibraryBsdf bsdf(const std::string& text) {
    const auto result = scene("<shape type=\"rectangle\">" + text + "</shape>");
    return result.materials.at(result.shapes.at(0).material).bsdf;
}

DMat4 transform(const std::string& text) {
    return parse("<sensor type=\"perspective\"><transform name=\"to_world\">" + text + "</transform></sensor>")
        .camera.to_world;
}

CameraDescription sensor(const std::string& text, const std::string& type = "perspective") {
    return parse("<sensor type=\"" + type + "\">" + text + "</sensor>").camera;
}

FilmDescription film(const std::string& text) {
    return parse("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + text + "</film></sensor>").film;
}

/// The z coordinate of the front of a shape, which lies in a plane of constant z: +1 or -1. By winding and, if there
/// are any, by normals, which must agree.
double front(const std::string& type, const std::string& inside) {
    const auto result = scene("<shape type=\"" + type + "\">" + inside + "</shape>");
    const auto& mesh = std::get<Mesh>(result.shapes.at(0).geometry);
    const auto [a, b, c] = mesh.triangles[0];
    const double winding =
        glm::normalize(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a])).z;
    for (const DVec3& n : mesh.normals) CHECK(n.z == relative(winding, 1e-5));
    return winding;
}

const std::string mirror_x = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
const std::string mirror_z = "<transform name=\"to_world\"><scale z=\"-1\"/></transform>";
const std::string flip = "<boolean name=\"flip_normals\" value=\"true\"/>";
const std::string flat = "<boolean name=\"face_normals\" value=\"true\"/>";

std::string file(const std::string& name) { return "<string name=\"filename\" value=\"" + name + "\"/>"; }

void check_close(const DMat4& a, const DMat4& b, double tolerance) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) CHECK(std::abs(a[c][r] - b[c][r]) <= tolerance);
}

}  // namespace

TEST_CASE("the reference scenes load with their values") {
    const std::filesystem::path folder = std::filesystem::path(LIGHTSWITCH_TESTS_DIR) / "data/cbox";
    const auto box = load_mitsuba(folder / "cbox.xml");
    CHECK(box.name == "cbox");
    CHECK(box.shapes.size() == 5);
    CHECK(box.materials.size() == 4);  // white serves two shapes
    CHECK(box.shapes[1].material == box.shapes[4].material);
    CHECK(box.shapes[0].emission == Rgb(18.387f, 13.9873f, 6.75357f));
    CHECK(std::get<Lambert>(box.materials[0].bsdf).reflectance == Rgb(0.885809f, 0.698859f, 0.666422f));
    CHECK(box.shapes[4].origin.line == 18);
    CHECK(box.shapes[4].origin.element == "<shape type=\"obj\">");
    CHECK(std::get<Mesh>(box.shapes[4].geometry).normals.empty());
    CHECK(box.camera.fov == 39.3077);
    CHECK(box.camera.near_clip == 0.001);
    CHECK(box.camera.far_clip == 1000);
    CHECK(box.camera.to_world[3] == glm::dvec4(0, 0, 3.9, 1));
    CHECK(box.camera.to_world[2] == glm::dvec4(0, 0, -1, 0));
    CHECK(box.camera.origin.line == 3);
    CHECK(box.film.width == 256);
    CHECK(box.film.filter.kind() == Filter::Kind::box);
    CHECK(box.samples == 64);
    CHECK(box.max_depth == -1);
    CHECK(box.rr_depth == 5);

    const auto spheres = load_mitsuba(folder / "cbox-spheres.xml");
    const auto& glass = std::get<Sphere>(spheres.shapes[4].geometry);
    CHECK(glass.center == DVec3(0.42, -0.62, 0.35));
    CHECK(glass.radius == 0.38);
    CHECK(std::get<Dielectric>(spheres.materials[spheres.shapes[4].material].bsdf).eta == 1.5f);
    CHECK(std::get<Conductor>(spheres.materials[spheres.shapes[5].material].bsdf).reflectance == Rgb(0.9f));

    const auto mis = load_mitsuba(folder / "veach-mis.xml");
    CHECK(mis.shapes.size() == 10);
    CHECK(std::get<RoughConductor>(mis.materials[mis.shapes[5].material].bsdf).alpha_u == 0.005f);
}

TEST_CASE("what a scene leaves out has Mitsuba's defaults") {
    const auto empty = scene("");
    CHECK(empty.film.width == 768);
    CHECK(empty.film.height == 576);
    CHECK(empty.film.filter.kind() == Filter::Kind::gaussian);
    CHECK(empty.film.filter.radius() == 2);
    CHECK(empty.camera.to_world == DMat4(1));
    CHECK(empty.camera.fov == relative(46.7929, 1e-5));  // 50 mm
    CHECK(empty.camera.fov_axis == CameraDescription::FovAxis::diagonal);
    CHECK(empty.camera.near_clip == 0);
    CHECK(empty.camera.far_clip == std::numeric_limits<double>::infinity());
    CHECK_FALSE(empty.max_depth);
    CHECK_FALSE(empty.samples);
    const auto path = scene("<integrator type=\"path\"/>");
    CHECK(path.max_depth == -1);
    CHECK(path.rr_depth == 5);

    CHECK(std::get<Lambert>(bsdf("")).reflectance == Rgb(0.5f));
    CHECK(std::get<Lambert>(bsdf("<bsdf type=\"diffuse\"/>")).reflectance == Rgb(0.5f));
    // A light without a BSDF is black.
    const auto light = scene("<shape type=\"rectangle\"/><shape type=\"rectangle\"><emitter type=\"area\"/></shape>");
    CHECK(std::get<Lambert>(light.materials[light.shapes[0].material].bsdf).reflectance == Rgb(0.5f));
    CHECK(std::get<Lambert>(light.materials[light.shapes[1].material].bsdf).reflectance == Rgb(0));
    CHECK(light.shapes[1].emission == Rgb(1));
    CHECK_FALSE(light.shapes[0].emission);
    CHECK(std::get<Dielectric>(bsdf("<bsdf type=\"dielectric\"/>")).eta == relative(1.50418, 1e-5));
    const auto metal = std::get<Conductor>(bsdf("<bsdf type=\"conductor\"/>"));
    CHECK(metal.eta == Rgb(0));
    CHECK(metal.k == Rgb(1));
    CHECK(metal.reflectance == Rgb(1));
    CHECK(std::get<RoughConductor>(
              bsdf("<bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"GGX\"/></bsdf>"))
              .alpha_u == 0.1f);
    const auto sampler = parse("<sensor type=\"perspective\"><sampler type=\"multijitter\"/></sensor>");
    CHECK(sampler.samples == 4);
}

TEST_CASE("BSDFs are read with their parameters") {
    CHECK(std::get<Lambert>(bsdf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1, .2 0.3\"/></bsdf>"))
              .reflectance == Rgb(0.1f, 0.2f, 0.3f));
    for (const char* grey :
         {"<rgb name=\"reflectance\" value=\"0.25\"/>", "<float name=\"reflectance\" value=\" 0.25 \"/>",
          "<spectrum name=\"reflectance\" value=\"0.25\"/>"})
        CHECK(std::get<Lambert>(bsdf(std::string("<bsdf type=\"diffuse\">") + grey + "</bsdf>")).reflectance ==
              Rgb(0.25f));
    const auto glass = std::get<Dielectric>(bsdf(
        "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"Water Ice\"/><float name=\"ext_ior\" value=\"1\"/>"
        "<rgb name=\"specular_reflectance\" value=\"0.5\"/><rgb name=\"specular_transmittance\" "
        "value=\"0.25\"/></bsdf>"));
    CHECK(glass.eta == 1.31f);
    CHECK(glass.reflectance == Rgb(0.5f));
    CHECK(glass.transmittance == Rgb(0.25f));
    const auto rough = std::get<RoughConductor>(
        bsdf("<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"ggx\"/>"
             "<float name=\"alpha_u\" value=\"0.3\"/><float name=\"alpha_v\" value=\"0.3\"/><rgb name=\"eta\" "
             "value=\"1,2,3\"/>"
             "<float name=\"k\" value=\"4\"/><boolean name=\"sample_visible\" value=\"false\"/></bsdf></bsdf>"));
    CHECK(rough.alpha_u == 0.3f);
    CHECK(rough.eta == Rgb(1, 2, 3));
    CHECK(rough.k == Rgb(4));
    CHECK(std::holds_alternative<Conductor>(bsdf("<bsdf type=\"twosided\"><bsdf type=\"conductor\"/></bsdf>")));
}

TEST_CASE("references go forward, and into other objects") {
    const auto forward = scene(
        "<shape type=\"rectangle\"><ref id=\"later\"/></shape><shape type=\"disk\"><ref name=\"bsdf\" "
        "id=\"inner\"/></shape>"
        "<bsdf type=\"twosided\" id=\"later\"><bsdf type=\"diffuse\" id=\"inner\"><float name=\"reflectance\" "
        "value=\"0.7\"/></bsdf>"
        "</bsdf>");
    CHECK(std::get<Lambert>(forward.materials[forward.shapes[0].material].bsdf).reflectance == Rgb(0.7f));
    CHECK(std::get<Lambert>(forward.materials[forward.shapes[1].material].bsdf).reflectance == Rgb(0.7f));
    CHECK(forward.materials[forward.shapes[0].material].two_sided);
    CHECK_FALSE(forward.materials[forward.shapes[1].material].two_sided);
    CHECK(forward.materials.size() == 2);
    CHECK(forward.materials[0].origin.line == 2);
    // Materials that nothing uses do not widen the scene.
    CHECK(scene("<bsdf type=\"dielectric\"/><shape type=\"cube\"/>").materials.size() == 1);
}

TEST_CASE("an alias is another id of an element above it") {
    const auto result = scene(
        "<bsdf type=\"diffuse\" id=\"white\"><float name=\"reflectance\" value=\"0.7\"/></bsdf>"
        "<alias id=\"white\" as=\"wall\"/><alias id=\"wall\" as=\"floor\"/>"
        "<shape type=\"cube\"><ref id=\"floor\"/></shape><shape type=\"disk\"><ref id=\"white\"/></shape>");
    CHECK(std::get<Lambert>(result.materials.at(result.shapes[0].material).bsdf).reflectance == Rgb(0.7f));
    CHECK(result.materials.size() == 1);
}

TEST_CASE("notices on mesh files are given once, however many shapes use the file") {
    const Folder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\nl 2 3\n");
    folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n");
    const auto shape = [](const std::string& inside) { return "<shape type=\"obj\">" + inside + "</shape>"; };
    const auto path =
        folder.write("room.xml", "<scene version=\"3.0.0\">" + std::string(camera) + shape(file("a.obj")) +
                                     shape(file("b.obj") + flat) + shape(file("a.obj") + flip) + "</scene>");
    Notices notices;
    CHECK(load_mitsuba(path, {}, &notices).shapes.size() == 3);
    REQUIRE(notices.size() == 1);  // what is wrong with normals does not matter where they are not used
    CHECK(notices[0] == (folder.path() / "a.obj").string() + ":4: the statement \"l\" is skipped (2 times)");
    CHECK(load_mitsuba(path).shapes.size() == 3);
}

TEST_CASE("transforms are applied in the order of the file") {
    check_close(transform("<translate x=\"1\" y=\"2\"/><rotate z=\"1\" angle=\"90\"/>"),
                {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {-2, 1, 0, 1}}, 1e-15);
    check_close(transform("<rotate value=\"0, 0.6 0.8\" angle=\"180\"/>"),
                {{-1, 0, 0, 0}, {0, -0.28, 0.96, 0}, {0, 0.96, 0.28, 0}, {0, 0, 0, 1}}, 1e-15);
    check_close(transform("<matrix value=\"0 1 0 5  1 0 0 6  0 0 1 7  0 0 0 1\"/>"),
                {{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {5, 6, 7, 1}}, 0);
    check_close(transform("<matrix value=\"0 0 1\n 1 0 0\n 0 1 0\"/>"),
                {{0, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}}, 0);
    check_close(transform("<translate value=\"3\"/><scale x=\"-1\"/>"),
                {{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-3, 3, 3, 1}}, 0);
    // Computed by Mitsuba 3.9.1: without an up vector.
    check_close(transform("<lookat origin=\"1,2,3\" target=\"0,0,0\"/>"),
                {{-0.0792865, 0.841427, -0.534522, 0},
                 {0.960357, -0.0792865, -0.267261, 0},
                 {-0.267261, -0.534522, -0.801784, 0},
                 {1, 2, 3, 1}},
                1e-6);
    const auto scaled =
        scene("<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"2\" y=\"3\"/></transform></shape>");
    CHECK(std::get<Mesh>(scaled.shapes[0].geometry).positions[2] == DVec3(2, 3, 0));
}

TEST_CASE("cameras are read with their parameters") {
    using Axis = CameraDescription::FovAxis;
    CHECK(sensor("<float name=\"fov\" value=\"40\"/>").fov_axis == Axis::x);
    CHECK(sensor("<integer name=\"fov\" value=\"40\"/>").fov == 40);
    CHECK(sensor("<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"Smaller\"/>").fov_axis ==
          Axis::smaller);
    CHECK(sensor("<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"larger\"/>").fov_axis ==
          Axis::larger);
    CHECK(sensor("<string name=\"focal_length\" value=\"35mm\"/>").fov == relative(63.4399, 1e-5));
    CHECK(sensor("<string name=\"focal_length\" value=\"35\"/>").fov_axis == Axis::diagonal);
    CHECK(sensor("<float name=\"near_clip\" value=\"2\"/>").near_clip == 2);

    const std::string aperture = "<float name=\"aperture_radius\" value=\"0.25\"/>";
    const auto lens = sensor(aperture + "<float name=\"focus_distance\" value=\"3\"/>", "thinlens");
    CHECK(lens.aperture_radius == 0.25);
    CHECK(lens.focus_distance == 3);
    // Mitsuba's default is its far plane.
    CHECK(sensor(aperture, "thinlens").focus_distance == 10000);
    CHECK(sensor(aperture + "<float name=\"far_clip\" value=\"7\"/>", "thinlens").focus_distance == 7);

    CHECK(film("<rfilter type=\"tent\"/>").filter.radius() == 1);
    CHECK(film("<rfilter type=\"tent\"><float name=\"radius\" value=\"1.5\"/></rfilter>").filter.radius() == 1.5f);
    CHECK(film("<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.25\"/></rfilter>").filter.radius() == 1);
    CHECK(film("<integer name=\"width\" value=\"12\"/><integer name=\"crop_width\" value=\"12\"/>").width == 12);
    CHECK(film("<string name=\"file_format\" value=\"PFM\"/><string name=\"component_format\" value=\"uint32\"/>")
              .height == 576);
    for (const char* type : {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"}) {
        const auto sampled = parse(
            "<sensor type=\"perspective\"><sampler type=\"" + std::string(type) +
            "\"><integer name=\"sample_count\" value=\"16\"/><integer name=\"seed\" value=\"3\"/></sampler></sensor>");
        CHECK(sampled.samples == 16);
    }
}

TEST_CASE("the front of each shape is Mitsuba's") {
    // What Mitsuba 3.9.1 says of the shading frame for a ray from above.
    for (const std::string type : {"rectangle", "disk"}) {
        CHECK(front(type, "") == 1);
        CHECK(front(type, mirror_x) == 1);
        CHECK(front(type, mirror_z) == -1);
        CHECK(front(type, flip) == -1);
        CHECK(front(type, flip + mirror_x) == -1);
        CHECK(front(type, flip + mirror_z) == 1);
    }
    for (const std::string& inside : {file("triangle.obj"), file("triangle.obj") + flat, file("downward.obj") + flat}) {
        CHECK(front("obj", inside) == 1);
        CHECK(front("obj", inside + mirror_x) == -1);
        CHECK(front("obj", inside + mirror_z) == 1);
        CHECK(front("obj", inside + flip) == -1);
        CHECK(front("obj", inside + flip + mirror_x) == 1);
    }
    CHECK(front("obj", file("downward.obj")) == -1);
    CHECK(front("obj", file("downward.obj") + mirror_x) == -1);
    CHECK(front("obj", file("downward.obj") + mirror_z) == 1);
    CHECK(front("obj", file("downward.obj") + flip) == 1);
    CHECK(front("ply", file("triangle.ply")) == 1);
    CHECK(front("ply", file("triangle.ply") + flip + mirror_z) == -1);

    const auto inward = [](const std::string& inside) {
        return std::get<Sphere>(scene("<shape type=\"sphere\">" + inside + "</shape>").shapes[0].geometry).inward;
    };
    CHECK_FALSE(inward(""));
    CHECK(inward(flip));
    CHECK(inward(mirror_x));
    CHECK_FALSE(inward(mirror_z + flip));
}

TEST_CASE("normals of mesh files are used, computed or left out") {
    const auto normals = [](const std::string& inside) {
        return std::get<Mesh>(scene("<shape type=\"obj\">" + inside + "</shape>").shapes[0].geometry).normals;
    };
    CHECK(normals(file("triangle.obj")) == std::vector<DVec3>(3, DVec3(0, 0, 1)));
    CHECK(normals(file("triangle.obj") + flat).empty());
    CHECK(normals(file("downward.obj")) == std::vector<DVec3>(3, DVec3(0, 0, -1)));
    CHECK(normals(file("downward.obj") + flat).empty());
    CHECK(normals(file("downward.obj") + "<boolean name=\"flip_tex_coords\" value=\"TRUE\"/>").size() == 3);
}

TEST_CASE("a sphere follows its transform") {
    const auto result = scene(
        "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/><float name=\"radius\" value=\"0.5\"/>"
        "<transform name=\"to_world\"><rotate y=\"1\" angle=\"90\"/><scale value=\"4\"/><translate "
        "x=\"1\"/></transform></shape>");
    const auto& sphere = std::get<Sphere>(result.shapes[0].geometry);
    CHECK(glm::length(sphere.center - DVec3(13, 8, -4)) < 1e-12);
    CHECK(sphere.radius == relative(2, 1e-14));
}

TEST_CASE("emitters are read with their parameters") {
    const auto result = scene(
        "<emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/><rgb name=\"intensity\" "
        "value=\"4\"/></emitter>"
        "<emitter type=\"point\"><transform name=\"to_world\"><translate y=\"7\"/></transform></emitter>"
        "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-2\" z=\"0\"/><float name=\"irradiance\" "
        "value=\"5\"/>"
        "</emitter><emitter type=\"directional\"/>"
        "<emitter type=\"directional\"><transform name=\"to_world\"><lookat origin=\"1,2,3\" target=\"9,2,3\" "
        "up=\"0,1,0\"/>"
        "</transform></emitter><emitter type=\"constant\"><spectrum name=\"radiance\" value=\"2\"/></emitter>");
    REQUIRE(result.sources.size() == 6);
    const PointSource point = *result.sources[0].source.get<PointSource>();
    CHECK(point.position == DVec3(1, 2, 3));
    CHECK(point.intensity == Rgb(4));
    CHECK(result.sources[0].origin.element == "<emitter type=\"point\">");
    CHECK(result.sources[1].source.get<PointSource>()->position == DVec3(0, 7, 0));
    CHECK(result.sources[2].source.get<DirectionalSource>()->direction == DVec3(0, -2, 0));
    CHECK(result.sources[2].source.get<DirectionalSource>()->irradiance == Rgb(5));
    CHECK(result.sources[3].source.get<DirectionalSource>()->direction == DVec3(0, 0, 1));
    CHECK(result.sources[4].source.get<DirectionalSource>()->direction == DVec3(1, 0, 0));
    // Computed by Mitsuba 3.9.1 (scalar_rgb).
    const Rgb white = result.sources[5].source.get<EnvironmentSource>()->radiance;
    CHECK(white.x == relative(2.40959, 1e-5));
    CHECK(white.y == relative(1.89658, 1e-5));
    CHECK(white.z == relative(1.81783, 1e-5));
}

TEST_CASE("parameters of the file are replaced") {
    const std::string text =
        "<default name=\"r\" value=\"0.25\"/><default name=\"r2\" value=\"0.$five\"/><default name=\"r\" value=\"9\"/>"
        "<shape type=\"cube\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"$r, $r2, $r\"/></bsdf></shape>";
    const auto result = scene("<default name=\"five\" value=\"5\"/>" + text);
    CHECK(std::get<Lambert>(result.materials[0].bsdf).reflectance == Rgb(0.25f, 0.5f, 0.25f));
    const auto defined = scene("<default name=\"five\" value=\"5\"/>" + text, {{"r", "1"}});
    CHECK(std::get<Lambert>(defined.materials[0].bsdf).reflectance == Rgb(1, 0.5f, 1));
    CHECK(contains(message_of([&] { scene("", {{"spp", "1"}}); }), "room.xml: the parameter \"spp\" is set, but"));
    CHECK(contains(message_of([&] { scene(text); }), "the parameter \"$five\" is not defined"));
    CHECK(contains(message_of([&] {
                       scene(
                           "<shape type=\"cube\" id=\"\\$x\"><float name=\"a\" value=\"1\"/></shape>"
                           "<shape type=\"cube\" id=\"$x\"/>",
                           {{"x", "$x"}});
                   }),
                   "the id \"$x\" is already taken in line 2"));
}
