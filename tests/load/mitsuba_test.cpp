#include "../support/relative.hpp"
#include "load/files.hpp"
#include "support/paths.hpp"

#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/load/spectrum.hpp>

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

AnyMaterial bsdf(const std::string& text) {
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
    const std::filesystem::path folder = std::filesystem::path(test::folder()) / "data/cbox";
    const auto box = load_mitsuba(folder / "cbox.xml");
    CHECK(box.name == "cbox");
    CHECK(box.shapes.size() == 5);
    CHECK(box.materials.size() == 5);  // white serves two shapes, and there is the inside of the two-sided one
    CHECK(box.shapes[1].material == box.shapes[4].material);
    CHECK(box.shapes[0].emission == Rgb(18.387f, 13.9873f, 6.75357f));
    CHECK(box.materials[0].bsdf.as<Lambert>().reflectance == Rgb(0.885809f, 0.698859f, 0.666422f));
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
    CHECK(spheres.materials[spheres.shapes[4].material].bsdf.as<Dielectric>().eta == 1.5f);
    CHECK(spheres.materials[spheres.shapes[5].material].bsdf.as<Conductor>().reflectance == Rgb(0.9f));

    const auto mis = load_mitsuba(folder / "veach-mis.xml");
    CHECK(mis.shapes.size() == 10);
    CHECK(mis.materials[mis.shapes[5].material].bsdf.as<RoughConductor>().alpha_u == 0.005f);
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

    CHECK(bsdf("").as<Lambert>().reflectance == Rgb(0.5f));
    CHECK(bsdf("<bsdf type=\"diffuse\"/>").as<Lambert>().reflectance == Rgb(0.5f));
    // A light without a BSDF is black.
    const auto light = scene("<shape type=\"rectangle\"/><shape type=\"rectangle\"><emitter type=\"area\"/></shape>");
    CHECK(light.materials[light.shapes[0].material].bsdf.as<Lambert>().reflectance == Rgb(0.5f));
    CHECK(light.materials[light.shapes[1].material].bsdf.as<Lambert>().reflectance == Rgb(0));
    CHECK(light.shapes[1].emission == Rgb(1));
    CHECK_FALSE(light.shapes[0].emission);
    CHECK(bsdf("<bsdf type=\"dielectric\"/>").as<Dielectric>().eta == relative(1.50418, 1e-5));
    const auto metal = bsdf("<bsdf type=\"conductor\"/>").as<Conductor>();
    CHECK(metal.eta == Rgb(0));
    CHECK(metal.k == Rgb(1));
    CHECK(metal.reflectance == Rgb(1));
    CHECK(bsdf("<bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"GGX\"/></bsdf>")
              .as<RoughConductor>()
              .alpha_u == 0.1f);
    const auto sampler = parse("<sensor type=\"perspective\"><sampler type=\"multijitter\"/></sensor>");
    CHECK(sampler.samples == 4);
}

TEST_CASE("BSDFs are read with their parameters") {
    CHECK(bsdf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1, .2 0.3\"/></bsdf>")
              .as<Lambert>()
              .reflectance == Rgb(0.1f, 0.2f, 0.3f));
    for (const char* grey :
         {"<rgb name=\"reflectance\" value=\"0.25\"/>", "<float name=\"reflectance\" value=\" 0.25 \"/>",
          "<spectrum name=\"reflectance\" value=\"0.25\"/>"})
        CHECK(bsdf(std::string("<bsdf type=\"diffuse\">") + grey + "</bsdf>").as<Lambert>().reflectance == Rgb(0.25f));
    const auto glass = bsdf(
                           "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"Water Ice\"/><float "
                           "name=\"ext_ior\" value=\"1\"/>"
                           "<rgb name=\"specular_reflectance\" value=\"0.5\"/><rgb name=\"specular_transmittance\" "
                           "value=\"0.25\"/></bsdf>")
                           .as<Dielectric>();
    CHECK(glass.eta == 1.31f);
    CHECK(glass.reflectance == Rgb(0.5f));
    CHECK(glass.transmittance == Rgb(0.25f));
    const auto rough =
        bsdf(
            "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"ggx\"/>"
            "<float name=\"alpha_u\" value=\"0.3\"/><float name=\"alpha_v\" value=\"0.3\"/><rgb name=\"eta\" "
            "value=\"1,2,3\"/>"
            "<float name=\"k\" value=\"4\"/><boolean name=\"sample_visible\" value=\"false\"/></bsdf></bsdf>")
            .as<RoughConductor>();
    CHECK(rough.alpha_u == 0.3f);
    CHECK(rough.eta == Rgb(1, 2, 3));
    CHECK(rough.k == Rgb(4));
    CHECK(bsdf("<bsdf type=\"twosided\"><bsdf type=\"conductor\"/></bsdf>").get<Conductor>());
    // A number that is given as a colour is its mean, as in Mitsuba.
    const auto tinted = bsdf("<bsdf type=\"principled\"><rgb name=\"spec_tint\" value=\"0.25 0.5 0.9\"/></bsdf>");
    CHECK(tinted.as<Principled>().spec_tint == relative(0.55, 1e-6));
    // Mitsuba raises a roughness of 0, in a texture, too.
    CHECK(
        bsdf("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0\"/></bsdf>").as<RoughConductor>().alpha_v ==
        1e-4f);
    const auto patches = bsdf(
        "<bsdf type=\"roughdielectric\"><texture type=\"checkerboard\" name=\"alpha\"><float name=\"color0\" "
        "value=\"0\"/><float name=\"color1\" value=\"0.3\"/></texture></bsdf>");
    const auto alpha = [&](float u) {
        return patches.as<Textured<RoughDielectric>>().at({Vec2(u, 0.1f), SurfacePoint{}}).alpha_u;
    };
    CHECK(std::min(alpha(0.1f), alpha(0.6f)) == 1e-4f);
    CHECK(std::max(alpha(0.1f), alpha(0.6f)) == 0.3f);
}

TEST_CASE("filters of polarized light let a part of the light through, as in Mitsuba's variants without polarization") {
    const auto opacity = [](const std::string& type, const std::string& inside) {
        const auto result =
            scene("<shape type=\"rectangle\"><bsdf type=\"" + type + "\">" + inside + "</bsdf></shape>");
        const auto& mask = std::get<Mask>(*result.materials[result.shapes[0].material].layer);
        CHECK(result.materials[mask.inner].bsdf.as<Lambert>().reflectance == Rgb(0));
        CHECK(mask.opacity.least() == mask.opacity.most());
        return mask.opacity.most().x;
    };
    const std::string part = "<spectrum name=\"transmittance\" value=\"0.5\"/>";
    CHECK(opacity("polarizer", "<float name=\"theta\" value=\"45\"/>") == 0.5f);
    CHECK(opacity("polarizer", part + "<boolean name=\"polarizing\" value=\"false\"/>") == 0.75f);
    CHECK(opacity("circular", part + "<boolean name=\"left_handed\" value=\"true\"/>") == 0.75f);
    CHECK(opacity("retarder", "<float name=\"delta\" value=\"90\"/>") == 0);
    CHECK(opacity("retarder", part) == 0.5f);
}

TEST_CASE("a texture of type rawconstant is one number, or three as they are") {
    const auto reflectance = [](const std::string& value) {
        return bsdf("<bsdf type=\"diffuse\"><texture type=\"rawconstant\" name=\"reflectance\">" + value +
                    "</texture></bsdf>")
            .as<Textured<Lambert>>()
            .at({Vec2(0.3f), SurfacePoint{}})
            .reflectance;
    };
    CHECK(reflectance("<float name=\"value\" value=\"0.25\"/>") == Rgb(0.25f));
    CHECK(reflectance("<vector name=\"value\" value=\"0.25 0.5 1\"/>") == Rgb(0.25f, 0.5f, 1));
    CHECK(contains(message_of([&] { reflectance(""); }), "the parameter \"value\" is missing"));
}

TEST_CASE("references go forward, and into other objects") {
    const auto forward = scene(
        "<shape type=\"rectangle\"><ref id=\"later\"/></shape><shape type=\"disk\"><ref name=\"bsdf\" "
        "id=\"inner\"/></shape>"
        "<bsdf type=\"twosided\" id=\"later\"><bsdf type=\"diffuse\" id=\"inner\"><float name=\"reflectance\" "
        "value=\"0.7\"/></bsdf>"
        "</bsdf>");
    CHECK(forward.materials[forward.shapes[0].material].bsdf.as<Lambert>().reflectance == Rgb(0.7f));
    CHECK(forward.materials[forward.shapes[1].material].bsdf.as<Lambert>().reflectance == Rgb(0.7f));
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
    CHECK(result.materials.at(result.shapes[0].material).bsdf.as<Lambert>().reflectance == Rgb(0.7f));
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
    // Also with an axis that is no unit vector, which is no rotation then.
    const auto stretched = scene(
        "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"2\" angle=\"90\"/></transform></shape>");
    const auto& positions = std::get<Mesh>(stretched.shapes[0].geometry).positions;
    CHECK(glm::length(positions[2] - DVec3(0, 4, -2)) < 1e-12);
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

    // Rays of Mitsuba 3.9.1 with this scale begin at z = 3 and end 99 farther on; its image is 3 wide.
    const auto parallel = sensor(
        "<float name=\"near_clip\" value=\"1\"/><float name=\"far_clip\" value=\"100\"/>"
        "<transform name=\"to_world\"><scale x=\"1.5\" y=\"1.5\" z=\"-3\"/></transform>",
        "orthographic");
    CHECK(parallel.half_width == 1.5);
    CHECK(parallel.near_clip == 3);
    CHECK(parallel.far_clip == 102);
    check_close(parallel.to_world, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 1}}, 0);
    CHECK(sensor("<transform name=\"to_world\"><scale value=\"7\"/></transform>", "orthographic").far_clip ==
          std::numeric_limits<double>::infinity());

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
    CHECK(result.materials[0].bsdf.as<Lambert>().reflectance == Rgb(0.25f, 0.5f, 0.25f));
    const auto defined = scene("<default name=\"five\" value=\"5\"/>" + text, {{"r", "1"}});
    CHECK(defined.materials[0].bsdf.as<Lambert>().reflectance == Rgb(1, 0.5f, 1));
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

TEST_CASE("colours are read in every form") {
    const auto reflectance = [](const std::string& color) {
        return bsdf("<bsdf type=\"diffuse\">" + color + "</bsdf>").as<Lambert>().reflectance;
    };
    // Mitsuba 0.6 and 2 take hexadecimal digits of <rgb> for linear values.
    CHECK(reflectance("<rgb name=\"reflectance\" value=\"#ff8000\"/>") == Rgb(1, 128.0f / 255, 0));
    CHECK(reflectance("<srgb name=\"reflectance\" value=\" #ff8000 \"/>") == Rgb(1, srgb_decode(128.0f / 255), 0));
    CHECK(reflectance("<srgb name=\"reflectance\" value=\"0.5\"/>") == Rgb(srgb_decode(0.5f)));
    CHECK(reflectance("<integer name=\"reflectance\" value=\"1\"/>") == Rgb(1));
    CHECK(reflectance("<spectrum name=\"reflectance\" value=\"0.25\"/>") == Rgb(0.25f));
    CHECK(reflectance("<rgb name=\"reflectance\" value=\"0.25\" intent=\"reflectance\"/>") == Rgb(0.25f));
    const auto black_body = scene(
        "<emitter type=\"constant\"><blackbody name=\"radiance\" temperature=\"5000K\" "
        "scale=\"2\"/></emitter>");
    CHECK(black_body.sources[0].source.get<EnvironmentSource>()->radiance == 2.0f * blackbody_to_rgb(5000));
}

TEST_CASE("what does not change the image is accepted") {
    CHECK(film("<boolean name=\"sample_border\" value=\"true\"/><string name=\"pixel_format\" value=\"rgba\"/><boolean "
               "name=\"banner\" value=\"false\"/><boolean name=\"compensate\" value=\"true\"/><string "
               "name=\"component_format\" value=\"int8\"/><string name=\"file_format\" value=\"png\"/><boolean "
               "name=\"high_quality_edges\" value=\"true\"/><string name=\"metadata['author']\" value=\"x\"/>")
              .width == 768);
    CHECK(scene("<integrator type=\"path\"><boolean name=\"strict_normals\" value=\"true\"/></integrator>").max_depth ==
          -1);
    CHECK(scene("<integrator type=\"path\"><float name=\"max_depth\" value=\"5.0\"/></integrator>").max_depth == 5);
    CHECK(scene("<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><boolean name=\"flip_normals\" "
                "value=\"true\"/></shape>")
              .shapes.size() == 1);
    for (const char* type : {"sobol", "halton", "hammersley", "unheard_of"})
        CHECK(parse("<sensor type=\"perspective\"><sampler type=\"" + std::string(type) +
                    "\"><integer name=\"sample_count\" value=\"16\"/><integer name=\"scramble\" "
                    "value=\"-1\"/></sampler></sensor>")
                  .samples == 16);
    for (const char* type : {"mitchell", "catmullrom", "lanczos"})
        CHECK(film("<rfilter type=\"" + std::string(type) + "\"><integer name=\"lobes\" value=\"3\"/></rfilter>")
                  .filter.kind() == Filter::Kind::gaussian);
    const auto picture = parse(
        "<sensor type=\"perspective\"><film type=\"ldrfilm\"><float name=\"exposure\" value=\"1.5\"/><float "
        "name=\"gamma\" value=\"2.2\"/></film></sensor>");
    CHECK(picture.exposure == 1.5f);
    CHECK_FALSE(scene("").exposure);
}

TEST_CASE("what Mitsuba passes over is passed over with a notice") {
    const auto notices = [](const std::string& text) {
        const Folder folder;
        Notices result;
        load_mitsuba(folder.write("room.xml", text), {}, &result);
        std::string all;
        for (const std::string& notice : result) all += notice + '\n';
        return all;
    };
    const std::string head = "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n";
    CHECK(notices(head + "</scene>") == "");
    for (const std::string& text : {head + "words</scene>", head + "<![CDATA[words]]></scene>"})
        CHECK(contains(notices(text), "room.xml:1: <scene>: unexpected text \"words\" is ignored\n"));
    CHECK(contains(notices(head + "</scene>\ntrailing"), "unexpected text \"trailing\" is ignored\n"));
    CHECK(contains(notices(head + "<sampler type=\"independent\"/><film type=\"hdrfilm\" id=\"a\"/></scene>"),
                   "room.xml:3: <sampler type=\"independent\">: is in no sensor, and is ignored\n"));
    CHECK(
        contains(notices(head + "<shape type=\"cube\"><transform name=\"to_world\"><rotate y=\"2\" angle=\"9\"/>"
                                "</transform></shape></scene>"),
                 "room.xml:3: <rotate>: the rotation axis has length 2.000000: as in Mitsuba 3, this scales besides"));
    CHECK(contains(notices("<scene version=\"0.6.0\"><integrator type=\"path\"><integer name=\"maxPasses\" "
                           "value=\"3\"/></integrator></scene>"),
                   "is upgraded"));
}

TEST_CASE("integrators of any name say how long paths are") {
    const auto depth = [](const std::string& type, const std::string& inside) {
        return scene("<integrator type=\"" + type + "\">" + inside + "</integrator>").max_depth;
    };
    const std::string nine = "<integer name=\"max_depth\" value=\"9\"/>";
    for (const char* type : {"path", "volpath", "bdpt", "ptracer", "photonmapper", "prb", "unheard_of"})
        CHECK(depth(type, nine + (type == std::string("path") ? "" : "<float name=\"radius\" value=\"1\"/>")) == 9);
    CHECK(depth("direct", "<integer name=\"emitter_samples\" value=\"4\"/>") == 2);
    CHECK(depth("aov",
                "<string name=\"aovs\" value=\"d:depth\"/><integrator type=\"path\">" + nine + "</integrator>") == 9);
    CHECK_FALSE(depth("depth", "").has_value());
}

TEST_CASE("one of several sensors is chosen; without any the whole is seen") {
    const Folder folder;
    const auto sensor_at = [](int x, const std::string& id) {
        return "<sensor type=\"perspective\" id=\"" + id + "\"><transform name=\"to_world\"><translate x=\"" +
               std::to_string(x) + "\"/></transform></sensor>";
    };
    const auto path = folder.write(
        "room.xml", "<scene version=\"3.0.0\">" + sensor_at(1, "left") + sensor_at(2, "right") + "</scene>");
    const auto x_of = [&](const std::string& sensor, Notices* notices = nullptr) {
        return load_mitsuba(path, MitsubaOptions{.sensor = sensor, .notices = notices}).camera.to_world[3].x;
    };
    Notices notices;
    CHECK(x_of("", &notices) == 1);
    REQUIRE(notices.size() == 1);
    CHECK(contains(notices[0], "<sensor type=\"perspective\">: is one of 2 sensors: the first is used"));
    CHECK(x_of("0") == 1);
    CHECK(x_of("1") == 2);
    CHECK(x_of("right") == 2);
    for (const char* wrong : {"2", "-1", "middle"})
        CHECK(contains(message_of([&] { x_of(wrong); }), "; known are 0 to 1, \"left\", \"right\""));

    const auto bare = folder.write("bare.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>");
    const auto framed = load_mitsuba(bare, MitsubaOptions{.notices = &notices});
    const DVec3 to_shape = -DVec3(framed.camera.to_world[3]);
    CHECK(glm::length(to_shape) > 1);
    CHECK(glm::dot(glm::normalize(to_shape), DVec3(framed.camera.to_world[2])) > 0.9);
    CHECK(contains(notices.back(), "there is no <sensor>"));
    CHECK(contains(message_of([&] { load_mitsuba(bare, MitsubaOptions{.sensor = "0"}); }), "there is no <sensor>"));
}

TEST_CASE("files are included, with their defaults, ids and versions") {
    const Folder folder;
    std::filesystem::create_directory(folder.path() / "parts");
    folder.write(
        "parts/shapes.xml",
        "<scene version=\"3.0.0\"><default name=\"grey\" value=\"0.75\"/><bsdf type=\"diffuse\" id=\"wall\"><float "
        "name=\"reflectance\" value=\"$grey\"/></bsdf><shape type=\"cube\"/></scene>");
    folder.write("parts/glass.xml",
                 "<bsdf version=\"0.6.0\" type=\"dielectric\"><float name=\"intIOR\" value=\"2\"/>"
                 "<float name=\"extIOR\" value=\"1\"/></bsdf>");
    const auto path = folder.write(
        "room.xml", "<scene version=\"3.0.0\">" + std::string(camera) +
                        "<include filename=\"parts/shapes.xml\"/><shape type=\"disk\"><ref id=\"wall\"/></shape>"
                        "<shape type=\"disk\"><include filename=\"parts\\glass.xml\"/></shape></scene>");
    const auto result = load_mitsuba(path);
    REQUIRE(result.shapes.size() == 3);
    CHECK(result.materials[result.shapes[1].material].bsdf.as<Lambert>().reflectance == Rgb(0.75f));
    CHECK(result.materials[result.shapes[2].material].bsdf.as<Dielectric>().eta == 2);
    CHECK(result.files.size() == 3);
    CHECK(contains(result.shapes[0].origin.file, "shapes.xml"));

    folder.write("loop.xml",
                 "<scene version=\"3.0.0\"><include filename=\"loop.xml\"/><include filename=\"loop.xml\"/>"
                 "</scene>");
    CHECK(contains(message_of([&] { load_mitsuba(folder.path() / "loop.xml"); }), "nested more than 64 deep"));
}

TEST_CASE("files are found in search paths, behind backslashes and in other capitals") {
    const Folder folder;
    for (const char* name : {"a", "b", "Meshes"}) std::filesystem::create_directory(folder.path() / name);
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("a/in_a.obj", triangle);
    folder.write("b/in_b.obj", triangle);
    folder.write("Meshes/Floor.OBJ", triangle);
    const auto load = [&](const std::string& before, const std::string& name, MitsubaOptions options) {
        const auto path = folder.write("room.xml", "<scene version=\"3.0.0\">" + std::string(camera) + before +
                                                       "<shape type=\"obj\">" + file(name) + "</shape></scene>");
        return load_mitsuba(path, options).files.back();
    };
    CHECK(load("<path value=\"a\"/>", "in_a.obj", {}) == (folder.path() / "a" / "in_a.obj").string());
    CHECK(load("", "in_b.obj", {.search_paths = {folder.path() / "b"}}) == (folder.path() / "b" / "in_b.obj").string());
    CHECK(load("", "a\\in_a.obj", {}) == (folder.path() / "a" / "in_a.obj").string());
    CHECK(load("", (folder.path() / "a" / "in_a.obj").string(), {}) == (folder.path() / "a" / "in_a.obj").string());
    Notices notices;
    CHECK(load("", "meshes\\floor.obj", {.notices = &notices}) == (folder.path() / "Meshes" / "Floor.OBJ").string());
    REQUIRE(notices.size() == 1);
    CHECK(contains(notices[0], "there is no \"meshes\\floor.obj\": \""));
    CHECK(contains(message_of([&] { load("", "in_c.obj", {}); }), "in_c.obj: no such file"));
}

TEST_CASE("cylinders have Mitsuba's place, front and texture coordinates") {
    const auto mesh = [](const std::string& inside) {
        return std::get<Mesh>(scene("<shape type=\"cylinder\">" + inside + "</shape>").shapes.at(0).geometry);
    };
    const auto area_and_front = [](const Mesh& m) {
        double area = 0, front = 0;
        for (const auto& [i, j, k] : m.triangles) {
            const DVec3 cross = glm::cross(m.positions[j] - m.positions[i], m.positions[k] - m.positions[i]);
            area += glm::length(cross) / 2;
            front += glm::dot(cross, m.normals[i]);
        }
        return std::pair(area, front);
    };
    const Mesh plain = mesh("");
    CHECK(area_and_front(plain).first == relative(2 * std::numbers::pi, 1e-12));
    CHECK(area_and_front(plain).second > 0);
    for (std::size_t i = 0; i < plain.positions.size(); ++i) {
        const DVec3 p = plain.positions[i];
        CHECK(plain.uvs[i].y == relative(p.z, 1e-6));
        const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi) - plain.uvs[i].x;
        CHECK(std::abs(turn - std::round(turn)) < 1e-6);
        CHECK(glm::dot(plain.normals[i], p) > 0);
    }
    const Mesh placed = mesh(
        "<point name=\"p0\" value=\"1, 2, 3\"/><point name=\"p1\" value=\"1, 7, 3\"/><float "
        "name=\"radius\" value=\"0.5\"/>");
    CHECK(area_and_front(placed).first == relative(5 * std::numbers::pi, 1e-12));
    for (const DVec3& p : placed.positions) {
        CHECK(std::hypot(p.x - 1, p.z - 3) == relative(0.5, 1e-4));
        CHECK((std::abs(p.y - 2) < 1e-12 || std::abs(p.y - 7) < 1e-12));
    }
    // Computed by Mitsuba 3.9.1: where u is 0 and 1/4.
    CHECK(glm::length(placed.positions[0] - DVec3(1.5, 2, 3)) < 1e-4);
    CHECK(glm::length(placed.positions[2 * 64] - DVec3(1, 2, 2.5)) < 1e-4);
    const auto outward = [&](const std::string& inside) {
        const Mesh m = mesh(inside);
        CHECK(area_and_front(m).second > 0);  // normals and winding agree
        return glm::dot(m.normals[0], DVec3(m.positions[0].x, m.positions[0].y, 0)) > 0;
    };
    CHECK(outward(mirror_x));
    CHECK(outward(mirror_z));
    CHECK_FALSE(outward(flip));
    CHECK_FALSE(outward(flip + mirror_x));
}

TEST_CASE("lamps are referred to, and media beside them") {
    const auto result = scene(
        "<emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" value=\"3\"/></emitter><shape type=\"disk\"><ref "
        "id=\"lamp\"/></shape>");
    CHECK(result.shapes[0].emission == Rgb(3));
    CHECK(result.sources.empty());
}
