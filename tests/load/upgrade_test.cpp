#include "load/files.hpp"

#include <lightswitch/load/metals.hpp>
#include <lightswitch/load/mitsuba_upgrade.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/scene/check.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

LibraryDescription load_version(const std::string& version, const std::string& text, Notices* notices = nullptr) {
    const Folder folder;
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("grey.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\0?\0\0\0?\0\0\0?", 12));
    return load_mitsuba(folder.write("room.xml", "<scene version=\"" + version + "\">\n" + text + "</scene>"),
                        MitsubaOptions{.notices = notices});
}

/// A scene of version 0.6.0.
LibraryDescription old(const std::string& text) { return load_version("0.6.0", text); }

AnyMaterial old_bsdf(const std::string& text) {
    const auto result = old("<shape type=\"rectangle\">" + text + "</shape>");
    return result.materials.at(result.shapes.at(0).material).bsdf;
}

/// The texture of the reflectance, with these parameters.
Texture old_texture(const std::string& type, const std::string& inside) {
    const auto result = old("<shape type=\"rectangle\"><bsdf type=\"mask\"><texture name=\"opacity\" type=\"" + type +
                            "\">" + inside + "</texture><bsdf type=\"diffuse\"/></bsdf></shape>");
    return std::get<Mask>(*result.materials.at(result.shapes.at(0).material).layer).opacity;
}

}  // namespace

TEST_CASE("names in camel case become those of Mitsuba 3") {
    using detail::with_underscores;
    for (const auto& [from, to] :
         std::map<std::string, std::string>{{"toWorld", "to_world"},
                                            {"intIOR", "int_ior"},
                                            {"fovAxis", "fov_axis"},
                                            {"alphaU", "alpha_u"},
                                            {"sigmaA", "sigma_a"},
                                            {"principalPointOffsetX", "principal_point_offset_x"},
                                            {"reflectance", "reflectance"},
                                            {"p0", "p0"},
                                            {"IOR", "IOR"},
                                            {"", ""}})
        CHECK(with_underscores(from) == to);
}

TEST_CASE("a scene of version 0.6 is read in the words of 3") {
    Notices notices;
    const auto result = load_version(
        "0.6.0",
        "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"7\"/><integer name=\"rrDepth\" value=\"3\"/>"
        "<boolean name=\"strictNormals\" value=\"true\"/></integrator>"
        "<sensor type=\"thinlens\"><float name=\"apertureRadius\" value=\"0.5\"/><float name=\"focusDistance\" "
        "value=\"4\"/>"
        "<float name=\"fov\" value=\"30\"/><string name=\"fovAxis\" value=\"y\"/><float name=\"nearClip\" value=\"2\"/>"
        "<float name=\"shutterOpen\" value=\"0\"/>"
        "<transform name=\"toWorld\"><lookAt origin=\"1 2 3\" target=\"1 2 4\" up=\"0 1 0\"/></transform>"
        "<sampler type=\"ldsampler\"><integer name=\"sampleCount\" value=\"128\"/></sampler>"
        "<film type=\"ldrfilm\"><integer name=\"width\" value=\"64\"/><string name=\"pixelFormat\" value=\"rgb\"/>"
        "<boolean name=\"highQualityEdges\" value=\"true\"/><float name=\"gamma\" value=\"2.2\"/></film></sensor>"
        "<shape type=\"obj\"><string name=\"filename\" value=\"triangle.obj\"/><boolean name=\"faceNormals\" "
        "value=\"true\"/>"
        "<boolean name=\"flipNormals\" value=\"true\"/><transform name=\"toWorld\"><rotate y=\"2\" angle=\"180\"/>"
        "</transform></shape>"
        "<luminaire type=\"constant\"><spectrum name=\"radiance\" value=\"1 2 3\"/><float name=\"samplingWeight\" "
        "value=\"2\"/></luminaire>",
        &notices);
    CHECK(result.max_depth == 7);
    CHECK(result.rr_depth == 3);
    CHECK(result.samples == 128);
    CHECK(result.camera.aperture_radius == 0.5);
    CHECK(result.camera.focus_distance == 4);
    CHECK(result.camera.fov_axis == CameraDescription::FovAxis::y);
    CHECK(result.camera.near_clip == 2);
    CHECK(result.camera.to_world[3] == glm::dvec4(1, 2, 3, 1));
    CHECK(result.camera.to_world[2] == glm::dvec4(0, 0, 1, 0));
    CHECK(result.film.width == 64);
    CHECK(result.sources.at(0).source.get<EnvironmentSource>()->radiance == Rgb(1, 2, 3));
    const auto& mesh = std::get<Mesh>(result.shapes.at(0).geometry);
    CHECK(glm::length(mesh.positions[1] - DVec3(-1, 0, 0)) < 1e-12);
    REQUIRE(notices.size() == 1);
    CHECK(contains(notices[0], "room.xml: is upgraded from version 0.6.0 of the format"));
    // The same words in a file of version 3 mean nothing.
    CHECK(contains(message_of([&] {
                       load_version("3.0.0",
                                    "<sensor type=\"perspective\"><transform name=\"toWorld\"/>"
                                    "</sensor>");
                   }),
                   "room.xml:2: <sensor type=\"perspective\">: unknown parameter \"toWorld\""));
}

TEST_CASE("surface models of version 0.6") {
    CHECK(old_bsdf("<bsdf type=\"lambertian\"><srgb name=\"diffuseReflectance\" "
                   "value=\"#ffffff\"/></bsdf>")
              .as<Lambert>()
              .reflectance == Rgb(1));
    CHECK(old_bsdf("<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"2\"/><float "
                   "name=\"extIOR\" value=\"1\"/><string name=\"distribution\" "
                   "value=\"ggx\"/></bsdf>")
              .as<Dielectric>()
              .eta == 2);
    const auto rough = old_bsdf(
                           "<bsdf type=\"roughglass\"><float name=\"alphaU\" value=\"0.2\"/><float "
                           "name=\"alphaV\" value=\"0.3\"/></bsdf>")
                           .as<RoughDielectric>();
    CHECK(rough.alpha_u == 0.2f);
    CHECK(rough.alpha_v == 0.3f);
    // A metal is copper unless it has a name; "none" is a mirror.
    CHECK(old_bsdf("<bsdf type=\"conductor\"/>").as<Conductor>().eta == metal_by_name("Cu")->eta);
    CHECK(old_bsdf("<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>").as<Conductor>().k ==
          Rgb(1));
    CHECK(old_bsdf("<bsdf type=\"mirror\"/>").as<Conductor>().eta == Rgb(0));
    CHECK(old_bsdf("<bsdf type=\"roughmetal\"/>").as<RoughConductor>().eta == metal_by_name("Cu")->eta);
    const auto in_water =
        old_bsdf(
            "<bsdf type=\"conductor\"><rgb name=\"eta\" value=\"2\"/><rgb name=\"k\" value=\"4\"/><float "
            "name=\"extEta\" value=\"2\"/></bsdf>")
            .as<Conductor>();
    CHECK(in_water.eta == Rgb(1));
    CHECK(in_water.k == Rgb(2));
    // What reflects more than all light is darkened as a whole.
    const auto phong = old_bsdf(
                           "<bsdf type=\"phong\"><rgb name=\"diffuseReflectance\" value=\"1.0\"/><rgb "
                           "name=\"specularReflectance\" value=\"0.5\"/></bsdf>")
                           .as<ModifiedPhong>();
    CHECK(std::abs(phong.diffuse_reflectance.x - 0.66f) < 1e-6f);
    CHECK(std::abs(phong.specular_reflectance.x - 0.33f) < 1e-6f);
}

TEST_CASE("a mixture is a chain of blends") {
    const auto result =
        old("<shape type=\"rectangle\"><bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"0.2, 0.3, 0.5\"/>"
            "<bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/><bsdf type=\"dielectric\"/></bsdf></shape>");
    const auto& outer = std::get<Blend>(*result.materials[result.shapes[0].material].layer);
    CHECK(outer.weight.most() == Rgb(0.5f));
    CHECK(result.materials[outer.second].bsdf.get<Dielectric>());
    const auto& inner = std::get<Blend>(*result.materials[outer.first].layer);
    CHECK(std::abs(inner.weight.most().x - 0.6f) < 1e-6f);
    CHECK(result.materials[inner.first].bsdf.get<Lambert>());
    CHECK(result.materials[inner.second].bsdf.get<Conductor>());
}

TEST_CASE("textures of version 0.6") {
    // As Mitsuba 3.9 upgrades them: the offset comes first.
    const Texture scaled = old_texture("checkerboard",
                                       "<float name=\"uscale\" value=\"4\"/><float name=\"vscale\" value=\"2\"/><float "
                                       "name=\"uoffset\" value=\"0.5\"/>");
    const Texture plain = old_texture("checkerboard", "");
    CHECK(plain(Vec2(0.2f, 0.1f)) != plain(Vec2(0.7f, 0.1f)));
    CHECK(scaled(Vec2(0.05f, 0.05f)) == plain(Vec2(0.2f, 0.1f)));
    CHECK(scaled(Vec2(0.15f, 0.05f)) == plain(Vec2(0.6f, 0.1f)));
    CHECK(scaled(Vec2(0.05f, 0.3f)) == plain(Vec2(0.2f, 0.6f)));
    const std::string file = "<string name=\"filename\" value=\"grey.pfm\"/>";
    for (const char* filter : {"ewa", "trilinear", "bilinear", "nearest"})
        CHECK(old_texture("bitmap", file + "<string name=\"filterType\" value=\"" + filter + "\"/>").most() ==
              Rgb(0.5f));
    CHECK(old_texture("bitmap", file + "<float name=\"gamma\" value=\"1\"/><float name=\"maxAnisotropy\" value=\"9\"/>")
              .most() == Rgb(0.5f));
    CHECK(contains(message_of([&] { old_texture("bitmap", file + "<float name=\"gamma\" value=\"1.8\"/>"); }),
                   "room.xml:2: <texture type=\"bitmap\">: unknown parameter \"gamma\""));

    const auto bump = old(
        "<shape type=\"rectangle\"><bsdf type=\"bumpmap\"><texture type=\"scale\"><float name=\"scale\" value=\"3\"/>"
        "<texture type=\"checkerboard\"/></texture><bsdf type=\"diffuse\"/></bsdf></shape>");
    CHECK(std::get<BumpMap>(*bump.materials[bump.shapes[0].material].layer).scale == 3);
}

TEST_CASE("coats of version 0.6") {
    const auto coat = [](const std::string& version, const std::string& text) {
        const auto scene = load_version(version, "<shape type=\"rectangle\">" + text + "</shape>");
        const auto& layer = scene.materials.at(scene.shapes.at(0).material).layer;
        REQUIRE(layer);
        const auto coating = std::get<Coating>(*layer);
        CHECK(scene.materials.at(coating.inner).bsdf.get<RoughConductor>());
        return coating.coat;
    };
    const std::string metal = "<bsdf type=\"roughconductor\"/></bsdf>";
    const Coat usual = coat("0.5.0", "<bsdf type=\"coating\">" + metal);
    CHECK(usual.eta == static_cast<float>(1.5046 / 1.000277));
    CHECK(usual.smooth());
    CHECK(usual.thickness == 1);
    CHECK(is_black(usual.sigma_a));
    CHECK(usual.specular_reflectance == Rgb(1));

    const Coat tinted = coat("0.5.0",
                             "<bsdf type=\"coating\"><string name=\"intIOR\" value=\"diamond\"/><float name=\"extIOR\" "
                             "value=\"1\"/><rgb name=\"sigmaA\" value=\"0.1 2 30\"/><float name=\"thickness\" "
                             "value=\"2\"/><spectrum name=\"specularReflectance\" value=\"0.5\"/>" +
                                 metal);
    CHECK(tinted.eta == 2.419f);
    CHECK(tinted.sigma_a == Rgb(0.1f, 2, 30));
    CHECK(tinted.thickness == 2);
    CHECK(tinted.specular_reflectance == Rgb(0.5f));

    const Coat rough =
        coat("3.0.0",
             "<bsdf type=\"roughcoating\"><float name=\"int_ior\" value=\"1.7\"/><float name=\"ext_ior\" "
             "value=\"1\"/><float name=\"alpha\" value=\"0.2\"/><string name=\"distribution\" "
             "value=\"ggx\"/><rgb name=\"sigma_a\" value=\"1\"/>" +
                 metal);
    CHECK(rough.eta == 1.7f);
    CHECK(rough.alpha == 0.2f);
    CHECK(rough.distribution == Facets::ggx);
    CHECK(rough.sigma_a == Rgb(1));
    const Coat usual_rough = coat("0.6.0", "<bsdf type=\"roughcoating\">" + metal);
    CHECK(usual_rough.alpha == 0.1f);
    CHECK(usual_rough.distribution == Facets::beckmann);
}

TEST_CASE("coats that cannot be are told, and read without") {
    const auto check = [](const std::string& bsdf, const std::string& problem, const std::string& instead) {
        CAPTURE(problem);
        const Folder folder;
        const std::string file =
            folder.write("room.xml", "<scene version=\"0.6.0\"><shape type=\"rectangle\">" + bsdf + "</shape></scene>");
        CHECK(contains(message_of([&] { load_mitsuba(file); }), problem));
        Problems problems;
        const auto scene = load_mitsuba(file, MitsubaOptions{.strictness = Strictness::lenient, .problems = &problems});
        CHECK_NOTHROW(detail::check(scene));
        REQUIRE(problems.size() == 1);
        CHECK(contains(problems[0].instead, instead));
        return scene.materials.at(scene.shapes.at(0).material);
    };
    const std::string grey = "<bsdf type=\"diffuse\"/>";
    CHECK_FALSE(check("<bsdf type=\"coating\"/>", "needs exactly one bsdf inside, not 0", "it is diffuse").layer);
    const auto masked = check("<bsdf type=\"coating\"><bsdf type=\"mask\">" + grey + "</bsdf></bsdf>",
                              "a coat cannot lie over another layer that is a mask", "the coat is left out");
    CHECK(std::holds_alternative<Mask>(masked.layer.value()));
    const auto mirror = check("<bsdf type=\"roughcoating\"><bsdf type=\"conductor\"/></bsdf>",
                              "a rough coat cannot lie over what is specular", "it is smooth");
    CHECK(std::get<Coating>(mirror.layer.value()).coat.smooth());
    check("<bsdf type=\"coating\"><float name=\"thickness\" value=\"-1\"/>" + grey + "</bsdf>",
          "<float name=\"thickness\">: -1, which is outside 0", "it is 0");
    check("<bsdf type=\"coating\"><texture name=\"sigmaA\" type=\"checkerboard\"/>" + grey + "</bsdf>",
          "does not belong into", "it is left out");
}

TEST_CASE("facets of Phong's model in version 0.6 are Beckmann's of the same roughness, and in version 3 a problem") {
    for (const char* name : {"phong", "as", "Phong"}) {
        const std::string shape =
            "<shape type=\"rectangle\"><bsdf type=\"roughconductor\"><string "
            "name=\"distribution\" value=\"" +
            std::string(name) + "\"/><float name=\"alpha\" value=\"0.25\"/></bsdf></shape>";
        Notices notices;
        const auto scene = load_version("0.6.0", shape, &notices);
        const auto metal = scene.materials.at(scene.shapes.at(0).material).bsdf.as<RoughConductor>();
        CHECK(metal.distribution == Facets::beckmann);
        CHECK(metal.alpha_u == 0.25f);
        CHECK(std::ranges::any_of(notices, [](const std::string& notice) {
            return contains(notice, "facets of Phong's model are taken for Beckmann's");
        }));
        CHECK(contains(message_of([&] { load_version("3.0.0", shape); }), "is not one of beckmann, ggx"));
    }
}

TEST_CASE("normals by angle: creases where triangles turn by more") {
    const Folder folder;
    // Two squares that meet at a right angle along the y axis, and one that goes on from the second, turned by 20
    // degrees.
    folder.write(
        "roof.obj",
        "v 0 0 0\nv 0 1 0\nv -1 1 0\nv -1 0 0\nv 0 0 -1\nv 0 1 -1\nv 0.34202 0 -1.93969\nv 0.34202 1 -1.93969\n"
        "vn 1 0 0\nf 1//1 2//1 3//1 4//1\nf 2//1 1//1 5//1 6//1\nf 6//1 5//1 7//1 8//1\n");
    const auto roof = [&](const std::string& angle) {
        const auto result = load_mitsuba(folder.write(
            "room.xml", "<scene version=\"0.6.0\"><shape type=\"obj\"><string name=\"filename\" value=\"roof.obj\"/>" +
                            angle + "</shape></scene>"));
        return std::get<Mesh>(result.shapes.at(0).geometry);
    };
    const auto normal_at = [](const Mesh& mesh, std::size_t triangle, std::size_t corner) {
        return mesh.normals.at(mesh.triangles[triangle][corner]);
    };
    const auto by_angle = [&](const char* degrees) {
        return roof("<float name=\"maxSmoothAngle\" value=\"" + std::string(degrees) + "\"/>");
    };
    const Mesh creased = by_angle("40");
    CHECK(creased.positions.size() == 10);
    CHECK(glm::length(normal_at(creased, 0, 0) - normal_at(creased, 1, 0)) < 1e-12);
    CHECK(glm::length(normal_at(creased, 0, 1) - DVec3(0, 0, 1)) < 1e-12);
    CHECK(glm::length(normal_at(creased, 2, 0) - DVec3(1, 0, 0)) < 1e-12);
    const DVec3 between = normal_at(creased, 3, 2);
    CHECK(std::abs(std::atan2(between.z, between.x) - 10 * 3.14159265358979 / 180) < 1e-5);
    CHECK(by_angle("10").positions.size() == 12);
    CHECK(by_angle("95").positions.size() == 8);
    CHECK(roof("").positions.size() == 8);
    CHECK(contains(
        message_of([&] {
            roof("<float name=\"maxSmoothAngle\" value=\"30\"/><boolean name=\"faceNormals\" value=\"true\"/>");
        }),
        "give either it or face_normals"));
}
