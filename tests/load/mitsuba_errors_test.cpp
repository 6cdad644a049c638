#include "load/files.hpp"

#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/scene/check.hpp>

#include <chrono>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// The error of a whole file; it must come soon, on slow machines, too.
std::string error_of(const std::string& text) {
    const Folder folder;
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("broken.obj", "v 0 0 0\nv 1 0 x\n");
    folder.write("broken.ply", "ply\nformat ascii 1.0\n");
    std::filesystem::create_directory(folder.path() / "directory.obj");
    const auto path = folder.write("room.xml", text);
    const auto start = std::chrono::steady_clock::now();
    const std::string message = message_of([&] { load_mitsuba(path); });
    CHECK_MESSAGE(std::chrono::steady_clock::now() - start < std::chrono::seconds(10), message);
    CHECK_MESSAGE((message == "no error" || contains(message, "room.xml")), message);
    return message;
}

struct Case {
    std::string text;
    std::string message;
};

void check(const Case& c, const std::string& before, const std::string& after) {
    const std::string message = error_of(before + c.text + after);
    CHECK_MESSAGE(contains(message, c.message), c.text.substr(0, 200), "\ngives   ", message, "\nwithout ", c.message);
}

/// Line 1 and 2; what follows begins in line 3.
const std::string head = "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n";

}  // namespace

TEST_CASE("malformed and hostile XML is refused") {
    std::string deep, bomb = "<default name=\"a0\" value=\"" + std::string(1000, 'x') + "\"/>";
    for (int i = 0; i < 100'000; ++i) deep += "<bsdf type=\"twosided\">";
    for (int i = 1; i < 40; ++i) {
        const std::string previous = "$a" + std::to_string(i - 1);
        bomb += "<default name=\"b" + std::to_string(i) + "\" value=\"\"/><default name=\"a" + std::to_string(i) +
                "\" value=\"" + previous + " " + previous + " " + previous + "\"/>";
    }
    std::string closed = deep;
    for (int i = 0; i < 100'000; ++i) closed += "</bsdf>";
    const Case cases[] = {
        {"", "room.xml: contains no XML element"},
        {"just text", "contains no XML element"},
        {"<scene", "room.xml:1: malformed XML"},
        {head, "room.xml:2: malformed XML"},
        {head + "<shape type=\"cube\"></bsdf></scene>", "room.xml:3: malformed XML"},
        {head + "</scene>\n<scene version=\"3.0.0\"/>", "room.xml:4: <scene>: a second root element"},
        {"<!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol2 \"&lol;&lol;\">]>\n<scene "
         "version=\"3.0.0\">&lol2;</scene>",
         "room.xml:1: <!DOCTYPE>: a document type (DOCTYPE) is not allowed"},
        {std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "contains a zero byte"},
        {std::string("\xff\xfe<\0s\0", 6), "contains a zero byte"},
        {head + deep, "room.xml"},
        {head + closed + "</scene>", "room.xml:3: <bsdf type=\"twosided\">: elements are nested more than 64 deep"},
        {head + bomb + "</scene>", "replacing parameters makes the file longer than 16 MiB"},
        {head + "<default name=\"a\" value=\"$a\"/></scene>",
         "room.xml:3: <default name=\"a\">: the parameter \"$a\" is not defined"},
        {head + "<default name=\"a\" value=\"$b\"/><default name=\"b\" value=\"$a\"/></scene>",
         "the parameter \"$b\" is not defined"},
        {head + "<default name=\"\" value=\"1\"/></scene>", "the name must be 1 to 100 letters"},
        {head + "<default name=\"a\"/></scene>", "the attribute \"value\" is missing"},
        {"<bsdf type=\"diffuse\"/>", "room.xml:1: <bsdf type=\"diffuse\">: the root of a scene file must be <scene>"},
        {"<scene><sensor type=\"perspective\"/></scene>", "room.xml:1: <scene>: the attribute \"version\" is missing"},
        {"<scene version=\"4.0.0\"/>", "is of version 4.0.0, but only versions up to 3"},
        {"<scene version=\"three\"/>", "\"three\" is not a version"},
        {"<scene version=\"3.0.0\" version=\"3.0.0\"/>", "the attribute \"version\" is given twice"},
    };
    for (const Case& c : cases) check(c, "", "");
    const Folder folder;
    CHECK(contains(message_of([&] { load_mitsuba(folder.write("big.xml", std::string((16u << 20) + 1, ' '))); }),
                   "at most 16777216"));
    CHECK(contains(message_of([&] { load_mitsuba(folder.write("many.xml", std::string(8u << 20, '<'))); }),
                   "more than a million tags"));
    CHECK(contains(message_of([&] { load_mitsuba(folder.path()); }), "is a directory"));
    CHECK(contains(message_of([&] { load_mitsuba(folder.path() / "room.xml"); }), "room.xml: no such file"));
}

TEST_CASE("what a scene file cannot say is refused with file, line and element") {
    const std::string obj = "<string name=\"filename\" value=\"triangle.obj\"/>";
    const Case cases[] = {
        {"<include filename=\"x.xml\"/>", "x.xml: no such file"},
        {"<include/>", "room.xml:3: <include>: the attribute \"filename\" is missing"},
        {"<path value=\"nowhere\"/>", "nowhere\" is not a folder"},
        {"<medium type=\"homogeneous\"/>", "room.xml:3: <medium type=\"homogeneous\">: media are not"},
        {"<shape type=\"cube\"><medium type=\"homogeneous\" name=\"interior\"/></shape>",
         "room.xml:3: <medium type=\"homogeneous\">: media are not supported"},
        {"<shape type=\"cube\"><subsurface type=\"dipole\"/></shape>",
         "room.xml:3: <subsurface type=\"dipole\">: elements of this kind are not supported here"},
        {"<alias id=\"a\" as=\"b\"/><bsdf type=\"diffuse\" id=\"a\"/>",
         "room.xml:3: <alias id=\"a\">: there is no element with the id \"a\" above"},
        {"<bsdf type=\"diffuse\" id=\"a\"/>\n<alias id=\"a\" as=\"a\"/>",
         "room.xml:4: <alias id=\"a\">: the id \"a\" is already taken in line 3"},
        {"<bsdf type=\"diffuse\" id=\"a\"/>\n<alias id=\"a\"/>",
         "room.xml:4: <alias id=\"a\">: the attribute \"as\" is missing"},
        {"<bsdf type=\"diffuse\" id=\"a\"/>\n<alias id=\"a\" as=\"b\"/>\n<bsdf type=\"diffuse\" id=\"b\"/>",
         "room.xml:5: <bsdf type=\"diffuse\">: the id \"b\" is already taken in line 3"},
        {"<texture type=\"bitmap\"/>", "room.xml:3: <texture type=\"bitmap\">: the parameter \"filename\" is missing"},
        {"<float name=\"x\" value=\"1\"/>", "room.xml:3: <scene>: unknown parameter \"x\""},
        {"<shape type=\"cube\"><film type=\"hdrfilm\"/></shape>",
         "room.xml:3: <film type=\"hdrfilm\">: does not belong into <shape type=\"cube\">"},
        {"<integrator type=\"path\"><integer name=\"depth\" value=\"5\"/></integrator>", "unknown parameter \"depth\""},
        {"<integrator type=\"path\"/><integrator type=\"path\"/>", "is the second one in <scene>"},
        {"<integrator type=\"path\"><integer name=\"max_depth\" value=\"-2\"/></integrator>",
         "room.xml:3: <integer name=\"max_depth\">: -2 is not between -1 and 2147483647"},
        {"<integrator type=\"path\"><integer name=\"rr_depth\" value=\"0\"/></integrator>", "0 is not between 1"},
        {"<integrator type=\"path\"><integer name=\"max_depth\" value=\"99999999999999999999\"/></integrator>",
         "is not an integer"},
        {"<integrator type=\"path\"><integer name=\"max_depth\" value=\"5.0\"/></integrator>",
         "\"5.0\" is not an integer"},
        {"<integrator type=\"path\"><float name=\"max_depth\" value=\"5.5\"/></integrator>",
         "\"5.5\" is not an integer"},
        {"<integrator type=\"path\"><string name=\"max_depth\" value=\"5\"/></integrator>",
         "room.xml:3: <string name=\"max_depth\">: has the wrong type: \"max_depth\" of <integrator type=\"path\"> "
         "must "
         "be <integer> or <float>"},
        {"<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"1\"/></integrator>",
         "\"1\" is neither true nor false"},

        {"<shape/>", "room.xml:3: <shape>: the attribute \"type\" is missing"},
        {"<shape type=\"heightfield\"/>", "unknown type \"heightfield\"; known are rectangle"},
        {"<shape type=\"cylinder\"><point name=\"p1\" x=\"0\" y=\"0\" z=\"0\"/></shape>", "are the same point"},
        {"<shape type=\"cylinder\"><float name=\"radius\" value=\"0\"/></shape>",
         "room.xml:3: <float name=\"radius\">: must be above 0"},
        {"<shape type=\"serialized\"/>", "the parameter \"filename\" is missing"},
        {"<shape type=\"obj\">" + obj + "<float name=\"max_smooth_angle\" value=\"30\"/></shape>",
         "unknown parameter \"max_smooth_angle\""},
        {"<shape type=\"obj\">" + obj + "\n<rgb name=\"colour\" value=\"1\"/></shape>",
         "room.xml:4: <shape type=\"obj\">: unknown parameter \"colour\"; known are face_normals, filename, "
         "flip_normals, "
         "flip_tex_coords, to_world"},
        {"<shape type=\"obj\" colour=\"1\"/>", "room.xml:3: <shape type=\"obj\">: unknown attribute \"colour\""},
        {"<shape type=\"obj\"/>", "room.xml:3: <shape type=\"obj\">: the parameter \"filename\" is missing"},
        {"<shape type=\"obj\">" + obj + "<string name=\"filename\" value=\"other.obj\"/></shape>",
         "room.xml:3: <string name=\"filename\">: the parameter is given twice"},
        {"<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>", "<shape type=\"obj\">: "},
        {"<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>", "none.obj: no such file"},
        {"<shape type=\"obj\"><string name=\"filename\" value=\"directory.obj\"/></shape>",
         "directory.obj: is a directory"},
        {"<shape type=\"obj\"><string name=\"filename\" value=\"\"/></shape>", "is a directory"},
        {"<shape type=\"obj\"><string name=\"filename\" value=\"broken.obj\"/></shape>",
         "broken.obj:2: \"x\" is not a finite number"},
        {"<shape type=\"ply\"><string name=\"filename\" value=\"broken.ply\"/></shape>",
         "broken.ply:3: the file ends within"},
        {"<shape type=\"disk\"><boolean name=\"face_normals\" value=\"true\"/></shape>",
         "unknown parameter \"face_normals\""},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>",
         "<float name=\"radius\">: must be above 0"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>", "\"nan\" is not a finite number"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1e999\"/></shape>", "\"1e999\" is not a finite number"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1m\"/></shape>", "\"1m\" is not a finite number"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1 2\"/></shape>", "\"value\" needs 1 numbers, not 2"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"\"/></shape>", "\"value\" needs 1 numbers, not 0"},
        {"<shape type=\"sphere\"><float name=\"radius\"/></shape>",
         "<float name=\"radius\">: the attribute \"value\" is missing"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1\"><float name=\"x\" value=\"1\"/></float></shape>",
         "<float name=\"x\">: does not belong into <float name=\"radius\">"},
        {"<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\"/></shape>",
         "<point name=\"center\">: the attribute \"z\" is missing"},
        {"<shape type=\"sphere\"><point name=\"center\" value=\"1,2\"/></shape>", "needs 1 or 3 numbers, not 2"},
        {"<shape type=\"sphere\"><point name=\"center\" value=\"1\" x=\"2\"/></shape>",
         "give either \"value\" or x, y and z"},
        {"<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
         "<transform name=\"to_world\">: a sphere must stay one"},
        {"<shape type=\"cube\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/></shape>",
         "is the second one in <shape type=\"cube\">"},
        {"<shape type=\"cube\"><emitter type=\"area\"/><emitter type=\"area\"/></shape>",
         "is the second one in <shape type=\"cube\">"},
        {"<shape type=\"cube\"><emitter type=\"point\"/></shape>", "unknown type \"point\"; known are area"},
        {"<shape type=\"cube\"><sensor type=\"perspective\"/></shape>", "does not belong into <shape type=\"cube\">"},
        {"<shape type=\"cube\"><emitter type=\"area\"><transform name=\"to_world\"/></emitter></shape>",
         "an area light is where its shape is"},

        {"<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape>",
         "the transform cannot be inverted"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1e300\"/></transform></shape>",
         "the transform cannot be inverted"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><rotate angle=\"9\"/></transform></shape>",
         "the rotation axis has length 0"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><rotate x=\"1\"/></transform></shape>",
         "the attribute \"angle\" is missing"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><shear x=\"1\"/></transform></shape>",
         "<shear>: unknown transform"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 2 3\"/></transform></shape>",
         "needs 9 or 16 numbers, not 3"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.1 "
         "1\"/></transform></shape>",
         "the matrix is not affine"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><lookat origin=\"1 2 3\" target=\"1 2 "
         "3\"/></transform></shape>",
         "room.xml:3: <lookat>: \"target\" is at \"origin\": move one of them"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><lookat origin=\"0,0,0\" target=\"0,0,1\" "
         "up=\"0,0,2\"/></transform></shape>",
         "room.xml:3: <lookat>: \"up\" is parallel to the way from \"origin\" to \"target\": give another one"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><lookat origin=\"0,0\" "
         "target=\"0,0,1\"/></transform></shape>",
         "\"origin\" needs 3 numbers, not 2"},
        {"<shape type=\"cube\"><transform name=\"to_uv\"/></shape>", "unknown parameter \"to_uv\""},

        {"<bsdf type=\"hair\"/>", "room.xml:3: <bsdf type=\"hair\">: unknown type \"hair\"; known are diffuse"},
        {"<bsdf type=\"varnish\"><bsdf type=\"diffuse\"/></bsdf>", "unknown type \"varnish\""},
        {"<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>",
         "room.xml:4: <bsdf type=\"diffuse\">: the id \"a\" is already taken in line 3"},
        {"<shape type=\"cube\"><ref id=\"a\"/></shape>",
         "room.xml:3: <ref id=\"a\">: there is no element with the id \"a\""},
        {"<shape type=\"cube\" id=\"a\"><ref id=\"a\"/></shape>",
         "refers to <shape type=\"cube\">, which does not belong into"},
        {"<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>",
         "room.xml:3: <bsdf type=\"twosided\">: the bsdf contains itself"},
        {"<bsdf type=\"twosided\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></bsdf>",
         "a twosided bsdf cannot be inside another one"},
        {"<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref "
         "id=\"a\"/></bsdf>",
         "the bsdf contains itself"},
        {"<bsdf type=\"twosided\"/>", "needs one bsdf inside, for both sides, or two, not 0"},
        {"<bsdf type=\"twosided\"><bsdf type=\"dielectric\"/></bsdf>",
         "a bsdf that transmits light cannot be twosided"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"#ff00\"/></bsdf>",
         "\"#ff00\" is not a finite number"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"#ff00gg\"/></bsdf>",
         "\"#ff00gg\" is not a finite number"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1.5\"/></bsdf>",
         "room.xml:3: <rgb name=\"reflectance\">: 1.5, which is outside 0 to 1"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1 2\"/></bsdf>", "needs 1 or 3 numbers, not 2"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1e300\"/></bsdf>", "the colour is too large"},
        {"<bsdf type=\"diffuse\"><string name=\"reflectance\" value=\"1\"/></bsdf>",
         "has the wrong type: \"reflectance\""},
        {"<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"a.spd\"/></bsdf>", "a.spd: no such file"},
        {"<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"/></bsdf>",
         "<texture type=\"bitmap\">: the parameter \"filename\" is missing"},
        {"<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
         "value=\"no.png\"/></texture></bsdf>",
         "no.png: no such file"},
        {"<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"wood\"/></bsdf>",
         "unknown type \"wood\"; known are bitmap, checkerboard and rawconstant"},
        {"<bsdf type=\"diffuse\"><texture name=\"colour\" type=\"checkerboard\"/></bsdf>",
         "does not belong into <bsdf type=\"diffuse\">"},
        {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/><texture name=\"reflectance\" "
         "type=\"checkerboard\"/></bsdf>",
         "the parameter is given twice"},
        {"<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>", "there is no element with the id \"t\""},
        {"<bsdf type=\"diffuse\" id=\"t\"/><bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>",
         "but only a <texture> can be referred to"},
        {"<bsdf type=\"conductor\"><string name=\"material\" value=\"Gold\"/></bsdf>", "unknown metal \"Gold\""},
        {"<bsdf type=\"conductor\"><string name=\"material\" value=\"Au\"/><float name=\"k\" value=\"1\"/></bsdf>",
         "give either material, or eta and k"},
        {"<bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"phong\"/></bsdf>",
         "\"phong\" is not one of beckmann, ggx"},
        {"<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"0.1\"/></bsdf>",
         "give either alpha, or both alpha_u and alpha_v"},
        {"<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"-1\"/></bsdf>",
         "room.xml:3: <float name=\"alpha\">: -1, which is not above 0 and at most 1"},
        {"<bsdf type=\"polarizer\"><rgb name=\"transmittance\" value=\"0.5 0.5 0.4\"/></bsdf>",
         "only grey of one value is supported here"},
        {"<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1\"/></bsdf>", "has 1 weights for 0 bsdfs"},
        {"<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"0.5\"/><bsdf type=\"diffuse\"/></bsdf>",
         "the weights do not sum to 1 but to 0.5"},
        {"<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"glass\"/></bsdf>", "unknown medium \"glass\""},
        {"<bsdf type=\"dielectric\"><float name=\"ext_ior\" value=\"0\"/></bsdf>",
         "an index of refraction must be above 0"},

        {"<emitter type=\"area\"/>", "an area light must be inside a <shape>"},
        {"<emitter type=\"envmap\"/>", "the parameter \"filename\" is missing"},
        {"<emitter type=\"sunsky\"/>", "room.xml:3: <emitter type=\"sunsky\">: skies are not supported"},
        {"<emitter type=\"projector\"/>", "unknown type \"projector\"; known are point, spot"},
        {"<emitter type=\"point\"><point name=\"position\" value=\"1\"/><transform name=\"to_world\"/></emitter>",
         "give either position or to_world"},
        {"<emitter type=\"directional\"><vector name=\"direction\" value=\"1\"/><transform "
         "name=\"to_world\"/></emitter>",
         "give either direction"},
        {"<emitter type=\"constant\"/>\n<emitter type=\"constant\"/>",
         "room.xml:4: <emitter type=\"constant\">: is the second environment"},
    };
    for (const Case& c : cases) check(c, head, "</scene>");
}

TEST_CASE("what contains itself, or is in very many others, is refused and does not exhaust the stack") {
    const auto id = [](int i) { return "\"a" + std::to_string(i) + "\""; };
    const auto texture = [&](int i, int inner) {
        return "<texture type=\"scale\" id=" + id(i) + "><ref id=" + id(inner) + "/></texture>\n";
    };
    const auto integrator = [&](int i, int inner) {
        return "<integrator type=\"aov\" id=" + id(i) + "><ref id=" + id(inner) + "/></integrator>\n";
    };
    const auto mask = [&](int i) {
        return "<bsdf type=\"mask\" id=" + id(i) + "><ref id=" + id(i + 1) + "/></bsdf>\n";
    };
    const auto bump = [&](int i) {
        return "<bsdf type=\"bumpmap\" id=" + id(i) + "><texture type=\"checkerboard\"/><ref id=" + id(i + 1) +
               "/></bsdf>\n";
    };
    constexpr int many = 20'000;
    const auto last = "<bsdf type=\"diffuse\" id=" + id(many) + "/>\n";
    std::string textures, integrators, masks, bumps, upwards;
    for (int i = 0; i < 1000; ++i) textures += texture(i, i + 1);
    for (int i = 0; i < many; ++i) bumps += bump(i);
    for (int i = 0; i < many; ++i) masks += mask(i);
    for (int i = many; i-- > many - 65;) upwards += mask(i);
    const std::string height = "<bsdf type=\"bumpmap\"><ref id=" + id(0) + "/><bsdf type=\"diffuse\"/></bsdf>\n";
    const Case cases[] = {
        {texture(0, 0), "room.xml:3: <texture type=\"scale\">: contains itself"},
        {texture(0, 1) + texture(1, 0), "room.xml:4: <texture type=\"scale\">: contains itself"},
        {texture(1, 0) + texture(0, 1) + height, "room.xml:4: <texture type=\"scale\">: contains itself"},
        {textures + texture(1000, 0), "<texture type=\"scale\">: contains itself, or is in more than 64 textures"},
        {integrator(0, 0), "room.xml:3: <integrator type=\"aov\">: contains itself, or is in more than 64"},
        {"<integrator type=\"aov\"><integrator type=\"aov\" id=" + id(0) + "><ref id=" + id(0) +
             "/></integrator></integrator>",
         "room.xml:3: <integrator type=\"aov\">: contains itself"},
        {masks + last, "room.xml:68: <bsdf type=\"mask\">: is in more than 64 other bsdfs"},
        {bumps + last, "room.xml:68: <bsdf type=\"bumpmap\">: is in more than 64 other bsdfs"},
        {last + upwards, "room.xml:68: <bsdf type=\"mask\">: more than 64 materials lie over each other"},
    };
    for (const Case& c : cases) {
        check(c, head, "</scene>");
        const Folder folder;
        const auto path = folder.write("room.xml", head + c.text + "</scene>");
        LibraryDescription scene;
        CHECK_NOTHROW(scene = load_mitsuba(path, MitsubaOptions{.strictness = Strictness::lenient}));
        CHECK_NOTHROW(detail::check(scene));
    }
    std::string layers = last;
    for (int i = many; i-- > many - 64;) layers = mask(i) + layers;
    CHECK(error_of(head + layers + "</scene>") == "no error");
}

TEST_CASE("what a camera cannot be is refused") {
    const auto film = [](const std::string& inside) { return "<film type=\"hdrfilm\">" + inside + "</film>"; };
    const Case cases[] = {
        {"<float name=\"fov\" value=\"40\"/><string name=\"focal_length\" value=\"50mm\"/>",
         "give either fov or focal_length"},
        {"<string name=\"focal_length\" value=\"50cm\"/>",
         "<string name=\"focal_length\">: \"50cm\" is not a focal length"},
        {"<string name=\"focal_length\" value=\"-50mm\"/>", "is not a focal length"},
        {"<string name=\"fov_axis\" value=\"y\"/>", "has no meaning without fov"},
        {"<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"z\"/>",
         "\"z\" is not one of diagonal, larger, smaller, x, y"},
        {"<float name=\"near_clip\" value=\"0\"/>", "<float name=\"near_clip\">: must be above 0"},
        {"<float name=\"near_clip\" value=\"2\"/><float name=\"far_clip\" value=\"1\"/>",
         "near_clip must be smaller than far_clip"},
        {"<float name=\"focus_distance\" value=\"0\"/>", "must be above 0"},
        {"<float name=\"aperture_radius\" value=\"1\"/>", "unknown parameter \"aperture_radius\""},
        {"<float name=\"principal_point_offset_z\" value=\"0.1\"/>", "unknown parameter \"principal_point_offset_z\""},
        {"<transform name=\"to_world\"><scale value=\"2\"/></transform>", "must not contain a scale or shear"},
        {"<transform name=\"to_world\"><matrix value=\"1 .1 0 0 1 0 0 0 1\"/></transform>",
         "must not contain a scale or shear"},
        {film("") + film(""), "is the second one in <sensor type=\"perspective\">"},
        {"<film type=\"specfilm\"/>", "unknown type \"specfilm\"; known are hdrfilm"},
        {film("<integer name=\"width\" value=\"-5\"/>"), "-5 is not between 1 and 1048576"},
        {film("<integer name=\"width\" value=\"99999999999\"/>"), "99999999999 is not between"},
        {film("<integer name=\"crop_width\" value=\"5000\"/>"), "the crop window is not within the film"},
        {film("<integer name=\"crop_offset_x\" value=\"5\"/>"), "the crop window is not within the film"},
        {film("<integer name=\"widht\" value=\"5\"/>"), "unknown parameter \"widht\""},
        {film("<rfilter type=\"windowed\"/>"), "unknown type \"windowed\"; known are box, tent and gaussian"},
        {film("<rfilter type=\"tent\"><float name=\"radius\" value=\"0\"/></rfilter>"),
         "must be above 0 and at most 1000 pixels"},
        {film("<rfilter type=\"box\"><float name=\"radius\" value=\"1\"/></rfilter>"),
         "a box has a radius of 0.5 pixels here"},
        {"<sampler type=\"independent\"><integer name=\"sample_count\" value=\"0\"/></sampler>", "0 is not between 1"},
        {"<sampler type=\"independent\"><boolean name=\"shake\" value=\"true\"/></sampler>",
         "unknown parameter \"shake\""},
    };
    for (const Case& c : cases)
        check(c, "<scene version=\"3.0.0\">\n<sensor type=\"perspective\">", "</sensor></scene>");
    CHECK(contains(error_of("<scene version=\"3.0.0\"><sensor type=\"thinlens\"/></scene>"),
                   "\"aperture_radius\" is missing"));
    CHECK(contains(
        error_of(
            "<scene version=\"3.0.0\"><sensor type=\"thinlens\"><float name=\"aperture_radius\" value=\"-1\"/></sensor>"
            "</scene>"),
        "must not be negative"));
    CHECK(contains(error_of("<scene version=\"3.0.0\"><sensor type=\"fisheye\"/></scene>"),
                   "known are perspective, thinlens and orthographic"));
}
