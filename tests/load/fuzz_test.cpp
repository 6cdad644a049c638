// Changes valid files at random, with fixed seeds: every result must either load or throw `Error`. Run it under the
// address and undefined behaviour sanitizers to see more.

#include "load/files.hpp"

#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>
#include <lightswitch/load/scene_file.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

const std::string obj =
    "# box\nv 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 -2e-3\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0.6 0.8\no thing\n"
    "f 1/1/1 2/2/1 3/1/2 4/2/2\nf -4//-2 -3//1 -2//2\nf 1/1/1 3/1/2 \\\n 4/2/1\n";

const std::string obj_with_materials =
    "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 -2e-3\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1\nusemtl one\nf "
    "2 3 4\nusemtl two\nf 1 3 4\nf 1 2 4\nusemtl one\nf 1 2 3 4\nusemtl three\nf 4 3 2 1\nusemtl four\nf 1 2 3\n";

const std::string mtl =
    "# materials\nnewmtl one\nKa 0 0 0\nKd 0.8 0.7 0.6\nKs 0.5 0.5 0.5\nNs 96.078431\nNi 1.45\nd 0.5\nillum "
    "2\nmap_Kd -s 2 2 1 -o 0.5 0 0 -clamp on -mm 0.1 0.5 a.pfm\nmap_d a.pfm\nbump -bm 0.3 a.pfm\n\nnewmtl two\r\nKd "
    "0\r\nKs 0.9\r\nTf 0.9 1 0.9\r\nNi 1.5\r\nTr 0.9\r\nillum 7\r\nnorm a.pfm\nnewmtl three\nKe 3 2 1\nmap_Ke "
    "a.pfm\nPr 0.3\nPm 1\nmap_Pr \"b c.png\"\nmap_Pm .\\A.PFM\nnewmtl four\nKd 0.3\nKs 0.3\nillum 3\n";

const std::string pfm = "PF\n1 1\n-1\n" + std::string("\0\0\0\x3f\0\0\x80\x3e\0\0\x80\x3f", 12);

const std::string mixed_obj =
    "\xef\xbb\xbf"
    "call a\rv 0 -0.3 0\rv 1 -1 0\rv 0 1 0\rv -1 -1 0\rv 0 0 1\rvn 0 0 1\rvn 0 0 0\rvt 0 0\r"
    "f 2// 3/1/ 4 1//1\rl 1 2\rf 2//2 3//2 4//1 1\rf 1 2 3 3 4 5 2\rcurv 0 1 1 2\r";

const std::string ascii_ply =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty double "
    "z\nproperty uchar red\n"
    "element face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n"
    "0 0 0 255\n1 0 0 1\n1 1 0 2\n0 1 0.5 3\n4 0 1 2 3\n3 0 1 3\n7\n";

const std::string faces_first_ply =
    "ply\nformat ascii 1.0\nelement face 2\nproperty list float float vertex_indices\nelement tristrips 1\nproperty "
    "list "
    "int int vertex_indices\nelement edge 1\nproperty int a\nelement vertex 5\nproperty float x\nproperty float "
    "y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n4 1 2 3 0\n5 0 1 2 2 "
    "4\n9 0 1 2 3 -1 4 3 2 1\n7\n0 -0.3 0 0 0 1\n1 -1 0 0 0 0\n0 1 0 0 0 1\n-1 -1 0 0 0 1\n0 0 1 0 0 1\n";

const std::string binary_ply =
    "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty char y\nproperty uchar z\n"
    "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n" +
    std::string("\0\1\2\3\0\0\1\0\1\2\0\0\3\0\1\2", 16);

const std::string xml =
    "<?xml version=\"1.0\"?>\n<scene version=\"3.0.0\">\n<default name=\"r\" value=\"0.5\"/>\n<integrator "
    "type=\"path\">"
    "<integer name=\"max_depth\" value=\"8\"/></integrator>\n<sensor type=\"thinlens\"><float name=\"fov\" "
    "value=\"40\"/>"
    "<float name=\"aperture_radius\" value=\"0.1\"/><transform name=\"to_world\"><lookat origin=\"0, 1, 4\" "
    "target=\"0, 0, 0\" "
    "up=\"0, 1, 0\"/><rotate y=\"1\" angle=\"20\"/></transform><sampler type=\"independent\"/><film type=\"hdrfilm\">"
    "<integer name=\"width\" value=\"32\"/><rfilter type=\"tent\"/></film></sensor>\n<bsdf type=\"twosided\" id=\"a\">"
    "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"$r, 0.2, 0.3\"/></bsdf></bsdf>\n<shape type=\"sphere\">"
    "<point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/><ref id=\"a\"/><emitter type=\"area\"><spectrum name=\"radiance\" "
    "value=\"2\"/>"
    "</emitter></shape>\n<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 0 0 0 2 0 0 0 3\"/><scale "
    "x=\"2\"/>"
    "</transform><bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"water\"/></bsdf></shape>\n<emitter "
    "type=\"point\">"
    "<point name=\"position\" value=\"1\"/></emitter>\n<alias id=\"a\" as=\"b\"/><shape type=\"disk\"><ref "
    "id=\"b\"/></shape></scene>\n";

const std::string old_xml =
    "<scene version=\"0.5.0\"><sensor type=\"perspective\"><transform name=\"toWorld\"><lookAt origin=\"0,1,4\" "
    "target=\"0,0,0\" up=\"0,1,0\"/></transform></sensor><bsdf type=\"bumpmap\" id=\"b\"><texture type=\"scale\">"
    "<float name=\"scale\" value=\"2\"/><texture type=\"checkerboard\"><float name=\"uscale\" value=\"4\"/><float "
    "name=\"voffset\" value=\"4\"/></texture></texture><bsdf type=\"phong\"><srgb name=\"diffuseReflectance\" "
    "value=\"#abcdef\"/></bsdf></bsdf><shape type=\"cylinder\"><point name=\"p0\" x=\"1\" y=\"2\" z=\"3\"/><ref "
    "id=\"b\"/></shape><shape type=\"disk\"><bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"0.5,0.5\"/>"
    "<bsdf type=\"mask\"><bsdf type=\"conductor\"/></bsdf><bsdf type=\"twosided\"><ref id=\"b\"/></bsdf></bsdf>"
    "</shape><luminaire type=\"constant\"><blackbody name=\"radiance\" temperature=\"5000K\"/></luminaire></scene>\n";

/// A lenient reading, which is fit to be built.
void load_leniently(const std::filesystem::path& path) {
    const auto scene = load_mitsuba(path, MitsubaOptions{.strictness = Strictness::lenient});
    CHECK_NOTHROW(detail::check(scene));
}

/// Loads `count` changed versions of `text`, and returns how many of them loaded.
template <class Load>
int fuzz(const std::string& text, const std::string& name, std::uint32_t count, const Load& load) {
    const Folder folder;
    const auto attempt = [&](const std::string& bytes) {
        const auto path = folder.write(name, bytes);
        try {
            load(path);
            return 1;
        } catch (const Error&) {
            return 0;
        }
    };
    CHECK(attempt(text) == 1);
    int loaded = 0;
    for (std::uint32_t seed = 0; seed < count; ++seed) loaded += attempt(mutated(text, seed));
    return loaded;
}

}  // namespace

TEST_CASE("changed files load or are refused") {
    // Both must happen, or the changes are too rough or too gentle to test anything.
    const auto both = [](int loaded, int count) {
        CHECK_MESSAGE((loaded > count / 100 && loaded < count), loaded, " of ", count);
    };
    both(fuzz(obj, "a.obj", 700, [](const auto& path) { load_obj(path); }), 700);
    both(fuzz(mixed_obj, "a.obj", 700, [](const auto& path) { load_obj(path); }), 700);
    both(fuzz(faces_first_ply, "a.ply", 700, [](const auto& path) { load_ply(path); }), 700);
    both(fuzz(ascii_ply, "a.ply", 500, [](const auto& path) { load_ply(path); }), 500);
    both(fuzz(binary_ply, "a.ply", 500, [](const auto& path) { load_ply(path); }), 500);
    const auto with_materials = [](const std::filesystem::path& path) {
        const auto beside = [&](const char* name, const std::string& text) {
            const auto other = path.parent_path() / name;
            if (!std::filesystem::exists(other)) std::ofstream(other, std::ios::binary) << text;
            return other;
        };
        beside("a.pfm", pfm);
        beside("a.mtl", mtl);
        detail::check(load_obj_scene(beside("a.obj", obj_with_materials)));
    };
    both(fuzz(mtl, "a.mtl", 2000, with_materials), 2000);
    both(fuzz(obj_with_materials, "a.obj", 700, with_materials), 700);
    both(fuzz(xml, "a.xml", 1000, [](const auto& path) { load_mitsuba(path); }), 1000);
    both(fuzz(old_xml, "a.xml", 1000, [](const auto& path) { load_mitsuba(path); }), 1000);
    both(fuzz(xml, "a.xml", 1000, load_leniently), 1000);
    both(fuzz(old_xml, "a.xml", 1000, load_leniently), 1000);
}
