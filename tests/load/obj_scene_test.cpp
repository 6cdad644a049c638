// OBJ files with materials as scenes, and bare meshes.

#include "load/files.hpp"
#include "support/paths.hpp"

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/load/mtl.hpp>
#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/load/texture_memory.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <chrono>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr std::string_view a_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
constexpr std::string_view face = "f 1/1 2/2 3/3 4/4\n";

/// A square with the material `m` of that file; the folder has an image of 2 x 1 texels, `Two.pfm`.
class Loaded {
public:
    explicit Loaded(std::string_view mtl, std::string_view obj = {}) {
        folder_.write("a.mtl", mtl);
        Image two(2, 1);
        two.pixels() = {Rgb(0.25f), Rgb(0.5f, 0.75f, 1)};
        save(folder_.path() / "Two.pfm", two);
        Image normals(1, 1);
        normals.pixels() = {Rgb(0.5f, 0.5f, 1)};
        save(folder_.path() / "normals.pfm", normals);
        std::string text = "mtllib a.mtl\n" + std::string(a_square) + "usemtl m\n" + std::string(face);
        if (!obj.empty()) text = obj;
        path_ = folder_.write("scene.obj", text);
        scene = load_obj_scene(path_, &notices);
        // Notices about camera and sky have a test of their own.
        notices.erase(std::remove_if(notices.begin(), notices.end(),
                                     [](const std::string& n) { return n.ends_with("is added"); }),
                      notices.end());
        CHECK_NOTHROW(detail::check(scene));
    }

    const LibraryDescription::NamedMaterial& material(std::size_t shape = 0) const {
        return scene.materials[scene.shapes.at(shape).material];
    }
    template <class B>
    const B* model(const LibraryDescription::NamedMaterial& of) const {
        return of.layer ? nullptr : of.bsdf.template get<B>();
    }
    template <class B>
    const B* model() const {
        return model<B>(material());
    }
    template <class L>
    const L* layer() const {
        return material().layer ? std::get_if<L>(&*material().layer) : nullptr;
    }
    bool noticed(std::string_view what) const {
        return std::any_of(notices.begin(), notices.end(), [&](const std::string& n) { return contains(n, what); });
    }
    const std::filesystem::path& folder() const { return folder_.path(); }

    LibraryDescription scene;
    Notices notices;

private:
    Folder folder_;
    std::filesystem::path path_;
};

std::string with(std::string_view statements) { return "newmtl m\n" + std::string(statements); }

/// The model of a textured material at a place.
template <class B>
B at(const LibraryDescription::NamedMaterial& material, const Vec2& uv) {
    const auto* textured = material.bsdf.template get<Textured<B>>();
    REQUIRE(textured);
    const SurfacePoint point{};
    return textured->at({uv, point});
}

std::string refusal(std::string_view mtl) {
    return message_of([&] { Loaded{mtl}; });
}

}  // namespace

TEST_CASE("an OBJ scene has a shape for each material in use, in order") {
    const std::string obj = "mtllib a.mtl\n" + std::string(a_square) +
                            "f 1 2 3\nusemtl blue\nf 1/1 2/2 3/3\nusemtl red\nf 3/3 4/4 1/1\nusemtl blue\nf 2 3 "
                            "4\nusemtl unused\nusemtl red\n";
    const Loaded loaded("newmtl red\nKd 1 0 0\nnewmtl unused\nmap_Kd none.png\nnewmtl blue\nKd 0 0 1\n", obj);
    CHECK(loaded.notices.empty());
    REQUIRE(loaded.scene.shapes.size() == 3);
    CHECK(loaded.model<Lambert>(loaded.material(0))->reflectance == Rgb(0, 0, 1));
    CHECK(loaded.model<Lambert>(loaded.material(1))->reflectance == Rgb(1, 0, 0));
    CHECK(loaded.model<Lambert>(loaded.material(2))->reflectance == Rgb(0.5f));
    const auto& blue = std::get<Mesh>(loaded.scene.shapes[0].geometry);
    REQUIRE(blue.triangles.size() == 2);
    CHECK(blue.positions.size() == 6);
    CHECK(blue.uvs.size() == 6);
    CHECK(blue.uvs[blue.triangles[0][1]] == Vec2(1, 0));
    CHECK(blue.positions[blue.triangles[1][2]] == DVec3(0, 1, 0));
    const auto& red = std::get<Mesh>(loaded.scene.shapes[1].geometry);
    CHECK(red.positions == std::vector<DVec3>{{1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
    for (const auto& shape : loaded.scene.shapes) CHECK(loaded.scene.materials[shape.material].two_sided);
    CHECK(contains(loaded.scene.shapes[1].origin.prefix(), "scene.obj:13: material \"red\": "));
    CHECK(loaded.scene.files.size() == 2);
    CHECK(loaded.scene.name == "scene");
}

TEST_CASE("the same triangles come out of an OBJ scene and an OBJ mesh") {
    const auto path = std::filesystem::path(test::folder()) / "data/mesh-files/mixed_normals.obj";
    const LibraryDescription scene = load_obj_scene(path);
    const Mesh mesh = load_obj(path), part = std::get<Mesh>(scene.shapes.at(0).geometry);
    CHECK(part.positions == mesh.positions);
    CHECK(part.normals == mesh.normals);
    CHECK(part.triangles == mesh.triangles);
}

TEST_CASE("material statements decide the model") {
    CHECK(Loaded(with("Kd 0.1 0.2 0.3")).model<Lambert>()->reflectance == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(Loaded(with("KD 0.25\r\n")).model<Lambert>()->reflectance == Rgb(0.25f));
    CHECK(Loaded(with("Kd 2 -1 0.5")).model<Lambert>()->reflectance == Rgb(1, 0, 0.5f));
    CHECK(Loaded(with("Kd 0.5\nKs 0.5\nNs 100\nillum 1")).model<Lambert>());

    const Loaded glossy(with("Kd 0.2\nKs 0.25 0.5 0.75\nNs 100\nillum 2"));
    const auto* plastic = glossy.model<RoughPlastic>();
    REQUIRE(plastic);
    CHECK(std::abs(plastic->alpha / std::sqrt(2.0f / 102) - 1) < 0.022f);
    CHECK(plastic->diffuse_reflectance == Rgb(0.2f));
    CHECK(plastic->specular_reflectance == Rgb(0.5f, 1, 1));
    CHECK(glossy.material().two_sided);

    const Loaded mirror(with("Kd 0\nKs 0.9\nNs 500\nillum 3"));
    CHECK(mirror.model<Conductor>()->reflectance == Rgb(0.9f));
    CHECK(mirror.material().two_sided);
    CHECK(Loaded(with("Kd 0.4\nKs 0.9\nillum 5")).model<Plastic>());

    const Loaded half(with("Kd 0.4 0.2 0.1\nKs 0.3\nillum 3"));
    const auto* blend = half.layer<Blend>();
    REQUIRE(blend);
    const float weight = blend->weight.mean().x;
    const Rgb diffuse = half.model<Lambert>(half.scene.materials[blend->first])->reflectance * (1 - weight);
    const Rgb specular = half.model<Conductor>(half.scene.materials[blend->second])->reflectance * weight;
    CHECK(max_component(glm::abs(diffuse - Rgb(0.4f, 0.2f, 0.1f))) < 1e-6f);
    CHECK(max_component(glm::abs(specular - Rgb(0.3f))) < 1e-6f);
    CHECK(half.material().two_sided);

    const Loaded physical(with("Kd 0.3\nPr 0.2\nPm 0.75\nPs 0.1\nPc 0.5\nPcr 0.25\nKs 0.5\nNs 10"));
    const auto* principled = physical.model<Principled>();
    REQUIRE(principled);
    CHECK(principled->base_color == Rgb(0.3f));
    CHECK(principled->roughness == 0.2f);
    CHECK(principled->metallic == 0.75f);
    CHECK(principled->sheen == 0.1f);
    CHECK(principled->clearcoat == 0.5f);
    CHECK(principled->clearcoat_gloss == 0.75f);
    CHECK(physical.material().two_sided);
}

TEST_CASE("glass is what lets light through and refracts it") {
    const Loaded glass(with("Kd 0\nKs 1\nTf 0.9 1 0.9\nNi 1.33\nillum 7"));
    const auto* dielectric = glass.model<Dielectric>();
    REQUIRE(dielectric);
    CHECK(dielectric->eta == 1.33f);
    CHECK(dielectric->transmittance == Rgb(0.9f, 1, 0.9f));
    CHECK(!glass.material().two_sided);
    CHECK(Loaded(with("d 0.1\nillum 6")).model<Dielectric>()->eta == 1.5f);
    CHECK(Loaded(with("d 0.1\nNi 1.6\nillum 4")).model<Dielectric>()->eta == 1.6f);
    CHECK(Loaded(with("Tr 0.9\nNi 1.6\nillum 4\nPr 0.5")).model<RoughDielectric>()->alpha_u == 0.25f);
    // What some programs write for everything.
    CHECK(Loaded(with("Kd 0.5\nTf 1 1 1\nNi 1\nillum 4")).model<Lambert>());
    CHECK(Loaded(with("Kd 0.5\nTf 1 1 1\nNi 1.5\nillum 2")).model<Lambert>());
    CHECK(Loaded(with("Kd 0.5\nTf 1 1 1\nd 1\nillum 7")).model<Lambert>());
}

TEST_CASE("dissolved materials are masked") {
    for (const char* text :
         {"Kd 0.5\nd 0.25", "Kd 0.5\nTr 0.75", "Kd 0.5\nd 0.25\nTr 0.5", "Kd 0.5\nd 0.25\nillum 4"}) {
        const Loaded loaded(with(text));
        const auto* mask = loaded.layer<Mask>();
        REQUIRE_MESSAGE(mask, text);
        CHECK(mask->opacity.mean() == Rgb(0.25f));
        CHECK(loaded.scene.materials[mask->inner].two_sided);
    }
    const Loaded image(with("map_d two.pfm\nd 0.5"));
    CHECK(image.layer<Mask>()->opacity({0.25f, 0}) == Rgb(0.125f));
    CHECK(Loaded(with("map_d two.pfm\nd 0")).layer<Mask>()->opacity({0.25f, 0}) == Rgb(0.25f));
    CHECK(Loaded(with("d 0")).noticed("a.mtl:1: the material is invisible"));
    const Loaded alpha(with("map_Kd two.pfm\nmap_d two.pfm"));
    CHECK(!alpha.layer<Mask>());
    CHECK(alpha.noticed("a.mtl:3: the opacity is in the alpha"));
    const Loaded lamp(with("Ke 1\nd 0.5"));
    CHECK(!lamp.layer<Mask>());
    CHECK(lamp.noticed("a.mtl:1: the material shines and cannot be transparent"));
}

TEST_CASE("images of materials lie as OBJ means it, times their colour") {
    const Loaded loaded(with("Kd 0.5 1 1\nmap_Kd two.pfm"));
    CHECK(loaded.notices.empty());
    CHECK(at<Lambert>(loaded.material(), {0.75f, 0.3f}).reflectance == Rgb(0.25f, 0.75f, 1));
    CHECK(loaded.material().two_sided);
    CHECK(loaded.scene.files.size() == 3);
    const Loaded black(with("Kd 0 0 0\nmap_Kd two.pfm"));
    CHECK(at<Lambert>(black.material(), {0.25f, 0}).reflectance == Rgb(0.25f));
    CHECK(black.noticed("a.mtl:3: the image multiplies black"));
    // Scale, offset and clamping: the right texel of two begins at u = 1/2.
    const auto right = [](std::string_view options, float u) {
        const Loaded file(with("map_Kd " + std::string(options) + " two.pfm"));
        return at<Lambert>(file.material(), {u, 0}).reflectance.y;
    };
    CHECK(right("", 0.75f) == 0.75f);
    CHECK(right("-s 2 1 1", 0.375f) == 0.75f);
    CHECK(right("-s 2", 0.375f) == 0.75f);
    CHECK(right("-o 0.5 0 0", 0.25f) == 0.75f);
    CHECK(right("-o 0.5 -s 0.5 1", 0.5f) == 0.75f);
    CHECK(right("", 1.25f) == 0.25f);
    CHECK(right("-clamp on", 1.25f) == 0.75f);
    CHECK(right("-mm 0.5 0.5", 0.25f) == 0.625f);
    CHECK(right("-mm 0.5 2", 0.25f) == 1);

    const Loaded shiny(with("Ks 0.25\nmap_Ks two.pfm\nNs 20"));
    CHECK(at<RoughPlastic>(shiny.material(), {0.75f, 0}).specular_reflectance == Rgb(0.25f, 0.375f, 0.5f));
    const Loaded physical(with("map_Pr two.pfm\nmap_Pm two.pfm\nPr 0.1"));
    CHECK(at<Principled>(physical.material(), {0.25f, 0}).roughness == 0.25f);
    CHECK(at<Principled>(physical.material(), {0.25f, 0}).metallic == 0.25f);
    const Loaded shared(with("map_Kd two.pfm\nnewmtl n\nmap_Kd two.pfm\n"));
    CHECK(shared.scene.files.size() == 3);
}

TEST_CASE("the first row of an image is at v = 1") {
    const Folder folder;
    Image image(1, 2);
    image(0, 0) = Rgb(0.75f);
    image(0, 1) = Rgb(0.25f);
    save(folder.path() / "rows.pfm", image);
    folder.write("a.mtl", with("map_Kd rows.pfm"));
    const auto path =
        folder.write("a.obj", "mtllib a.mtl\n" + std::string(a_square) + "usemtl m\n" + std::string(face));
    const LibraryDescription scene = load_obj_scene(path);
    const auto& material = scene.materials[scene.shapes[0].material];
    CHECK(at<Lambert>(material, {0, 0.75f}).reflectance == Rgb(0.75f));
    CHECK(at<Lambert>(material, {0, 0.25f}).reflectance == Rgb(0.25f));
}

TEST_CASE("what shines is a light") {
    const Loaded lamp(with("Ke 3 2 1"));
    CHECK(*lamp.scene.shapes[0].emission == Rgb(3, 2, 1));
    CHECK(!lamp.scene.shapes[0].emission_texture);
    CHECK(lamp.scene.sources.empty());
    const Loaded picture(with("map_Ke two.pfm"));
    CHECK(*picture.scene.shapes[0].emission == Rgb(1));
    CHECK((*picture.scene.shapes[0].emission_texture)({0.25f, 0}) == Rgb(0.25f));
    CHECK(!Loaded(with("Ke 0 0 0")).scene.shapes[0].emission);
    CHECK(!Loaded(with("map_Ke none.png")).scene.shapes[0].emission);
}

TEST_CASE("maps of heights and normals lie between the model and its second side") {
    const Loaded bump(with("Kd 0.5\nmap_Bump -bm 0.25 two.pfm"));
    const auto* map = bump.layer<BumpMap>();
    REQUIRE(map);
    CHECK(map->scale == 0.25f);
    CHECK(bump.material().two_sided);
    CHECK(!bump.scene.materials[map->inner].two_sided);
    CHECK(Loaded(with("bump two.pfm")).layer<BumpMap>()->scale == 1);
    CHECK(Loaded(with("norm normals.pfm")).layer<NormalMap>());
    CHECK(Loaded(with("norm normals.pfm\nbump two.pfm")).layer<NormalMap>());
    const Loaded bluish(with("bump normals.pfm"));
    CHECK(bluish.layer<NormalMap>());
    CHECK(bluish.noticed("a.mtl:2: the image looks like a map of normals"));
    const Loaded glass(with("Ni 1.5\nd 0\nillum 7\nbump two.pfm"));
    CHECK(glass.layer<BumpMap>());
    CHECK(!glass.material().two_sided);
    const Loaded all(with("bump two.pfm\nKd 0.4\nKs 0.3\nillum 3\nd 0.5"));
    const auto* mask = all.layer<Mask>();
    REQUIRE(mask);
    CHECK(all.scene.materials[mask->inner].two_sided);
    CHECK_NOTHROW(build_any(all.scene));
}

TEST_CASE("files are found by names of other systems") {
    const auto found = [](const std::string& name) { return Loaded(with("map_Kd " + name)).notices.empty(); };
    for (const char* name : {"Two.pfm", "TWO.PFM", "two.pfm  ", "\"Two.pfm\"", ".\\two.pfm",
                             "C:\\Users\\me\\maps\\two.pfm", "maps/two.pfm", "/nowhere/Two.pfm"})
        CHECK_MESSAGE(found(name), name);
    for (const char* name : {"three.pfm", "\"\"", ".", "..", "/", "two.pfm/two.pfm/.", "\x80\xff"})
        CHECK_MESSAGE(!found(name), name);

    const Folder folder;
    std::filesystem::create_directory(folder.path() / "Sub Folder");
    Image image(1, 1);
    image.pixels() = {Rgb(0.5f)};
    save(folder.path() / "Sub Folder/My Image.pfm", image);
    folder.write("Sub Folder/My Materials.mtl", with("map_Kd my image.pfm"));
    Notices notices;
    const auto path = folder.write(
        "a.obj", "mtllib sub folder\\my materials.mtl\n" + std::string(a_square) + "usemtl m\n" + std::string(face));
    const LibraryDescription scene = load_obj_scene(path, &notices);
    CHECK(scene.files.size() == 3);
    CHECK_MESSAGE(notices.size() == 2, notices.back());
    // Several files in one statement; of two materials with one name the first counts.
    folder.write("1.mtl", "newmtl m\nKd 0.125\n");
    folder.write("2.mtl", "newmtl n\nKd 0.25\nnewmtl m\nKd 0.75\n");
    const auto two = folder.write(
        "b.obj", "mtllib 1.mtl 2.mtl 1.mtl\n" + std::string(a_square) + "usemtl m\nf 1 2 3\nusemtl n\nf 1 3 4\n");
    notices.clear();
    const LibraryDescription both = load_obj_scene(two, &notices);
    CHECK(both.materials[both.shapes[0].material].bsdf.as<Lambert>().reflectance == Rgb(0.125f));
    CHECK(both.materials[both.shapes[1].material].bsdf.as<Lambert>().reflectance == Rgb(0.25f));
    CHECK(contains(notices.at(0), "2.mtl:3: a material of that name is known already"));
}

TEST_CASE("an image that is damaged is among the files that were opened") {
    const Folder folder;
    folder.write("broken.png", "what");
    folder.write("a.mtl", with("map_Kd broken.png"));
    const auto path =
        folder.write("a.obj", "mtllib a.mtl\n" + std::string(a_square) + "usemtl m\n" + std::string(face));
    CHECK(load_obj_scene(path).files.back() == (folder.path() / "broken.png").string());
}

TEST_CASE("what is missing is noticed") {
    const Loaded loaded("", "mtllib none.mtl\n" + std::string(a_square) + "usemtl m m\nf 1 2 3\nl 1 2\n");
    CHECK(loaded.noticed("scene.obj:1: there is no material file \"none.mtl\""));
    CHECK(loaded.noticed("scene.obj:10: there is no material \"m m\": it is grey"));
    CHECK(loaded.noticed("scene.obj:12: the statement \"l\" is skipped"));
    CHECK(loaded.model<Lambert>()->reflectance == Rgb(0.5f));
    CHECK(Loaded(with("map_Kd none.png")).noticed("a.mtl:2: there is no image \"none.png\""));
    CHECK(Loaded(with("map_Kd a.mtl")).noticed("a.mtl:2: the material does without an image: "));
    CHECK(Loaded(with("sparkle 3")).noticed("a.mtl:2: \"sparkle\" is skipped"));
    CHECK(Loaded(with("Kd xyz 1 1 1")).noticed("a.mtl:2: \"kd xyz\" is skipped"));
    CHECK(Loaded(with("Kd spectral a.rfl 1")).noticed("\"kd spectral\" is skipped"));
    CHECK(Loaded(with("d -halo 0.5")).noticed("\"-halo\" is skipped"));
    CHECK(Loaded(with("map_Kd -blendu on two.pfm")).noticed("the option \"-blendu\" is skipped"));
    CHECK(Loaded(with("map_Kd two.pfm"), "mtllib a.mtl\n" + std::string(a_square) + "usemtl m\nf 1 2 3\n")
              .noticed("scene.obj: has no texture coordinates"));

    std::string many;
    for (int i = 0; i < 5000; ++i) many += "word" + std::to_string(i) + " 1\n";
    CHECK(Loaded(with(many)).notices.size() < 300);
}

TEST_CASE("files that are not there are looked for once, and not without end") {
    const Folder folder;
    for (int i = 0; i < 2000; ++i) folder.write("a file of a long name " + std::to_string(i), "");
    std::string libraries, different, materials;
    for (int i = 0; i < 2000; ++i) {
        const std::string name = std::to_string(i);
        libraries += "mtllib none.mtl\n";
        different += "mtllib none" + name + ".mtl\n";
        materials += "newmtl m" + name + "\nmap_Kd none.png\n";
    }
    folder.write("a.mtl", materials);
    std::string used = "mtllib a.mtl\n" + std::string(a_square);
    for (int i = 0; i < 2000; ++i) used += "usemtl m" + std::to_string(i) + "\n" + std::string(face);
    const auto timed = [&](const std::string& text) {
        const auto file = folder.write("a.obj", text);
        Notices notices;
        const auto start = std::chrono::steady_clock::now();
        load_obj_scene(file, &notices);
        CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
        return notices.at(0);
    };
    CHECK(contains(timed(libraries + std::string(a_square) + std::string(face)),
                   "a.obj:1: there is no material file \"none.mtl\""));
    CHECK(contains(timed(used), "there is no image \"none.png\": the material does without it (2000 times)"));
    const Folder other;
    const auto path = other.write("a.obj", different + std::string(a_square) + std::string(face));
    CHECK(contains(message_of([&] { load_obj_scene(path); }), "asks for more than 1000 searches for material files"));
}

TEST_CASE("the textures of a scene have an end") {
    detail::TextureMemory memory;
    const Origin where{"a.xml", 7, {}};
    memory.add(std::size_t{15} << 30, where);
    CHECK(contains(message_of([&] { memory.add((std::size_t{1} << 30) + 1, where); }),
                   "a.xml:7: the textures of the scene take more than 16 GiB"));
    CHECK_NOTHROW(memory.add(std::size_t{1} << 30, where));  // what was refused does not count
    CHECK_THROWS_AS(memory.add(1, where), Error);
}

TEST_CASE("malformed material files are refused with file and line") {
    struct Case {
        std::string_view text, message;
    };
    const Case cases[] = {{"Kd 1 1 1", "a.mtl:1: \"kd\" comes before the first \"newmtl\""},
                          {"newmtl\n", "a.mtl:1: a material needs a name"},
                          {"newmtl m\nKd 1 x 1", "a.mtl:2: \"x\" is not a finite number"},
                          {"newmtl m\nKd 1 1", "a.mtl:2: \"\" is not a finite number"},
                          {"newmtl m\n\rKd", "a.mtl:3: \"\" is not a finite number"},
                          {"newmtl m\nKe nan nan nan", "a.mtl:2: \"nan\" is not a finite number"},
                          {"newmtl m\nKe 1e31", "a.mtl:2: \"1e31\" is beyond 1e30"},
                          {"newmtl m\nNs", "a.mtl:2: \"\" is not a finite number"},
                          {"newmtl m\nmap_Kd", "a.mtl:2: names no image"},
                          {"newmtl m\nmap_Kd -s 1 1", "a.mtl:2: names no image"},
                          {"newmtl m\nmap_Kd -s x two.pfm", "a.mtl:2: \"x\" is not a finite number"},
                          {"newmtl m\nmap_Kd -wrong two.pfm", "a.mtl:2: unknown option \"-wrong\""},
                          {"newmtl m\nbump -bm two.pfm", "a.mtl:2: \"two.pfm\" is not a finite number"}};
    for (const Case& c : cases) {
        const std::string message = refusal(c.text);
        CHECK_MESSAGE(contains(message, c.message), message);
    }
    CHECK(contains(refusal(std::string(detail::max_mtl_bytes + 1, '\n')), "a.mtl: has 16777217 bytes"));
}

TEST_CASE("scenes get a camera, and a sky if they have no light") {
    const Folder folder;
    const std::string text = "mtllib a.mtl\n" + std::string(a_square) + "usemtl m\n" + std::string(face);
    const auto obj = folder.write("a.obj", text);
    folder.write("a.mtl", with("Kd 0.5"));
    Notices notices;
    const LibraryDescription dark = load_obj_scene(obj, &notices);
    REQUIRE(notices.size() == 2);
    CHECK(contains(notices[0], "a.obj: has no camera"));
    CHECK(contains(notices[1], "a.obj: has no light"));
    CHECK(dark.sources.size() == 1);
    CHECK(dark.camera.to_world[3].z > 0);
    CHECK_NOTHROW(build_any(dark));
    folder.write("a.mtl", with("Ke 0.5"));
    notices.clear();
    CHECK(load_obj_scene(obj, &notices).sources.empty());
    CHECK(notices.size() == 1);
}

TEST_CASE("a bare mesh is a grey object under the sky") {
    const Folder folder;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const std::string stl =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid\n";
    for (const auto& path : {folder.write("a.PLY", ply), folder.write("a.stl", stl),
                             folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}) {
        Notices notices;
        const LibraryDescription scene = load_mesh_scene(path, &notices);
        CHECK(notices.size() == 2);
        REQUIRE(scene.shapes.size() == 1);
        CHECK(std::get<Mesh>(scene.shapes[0].geometry).triangles.size() == 1);
        const auto& material = scene.materials[scene.shapes[0].material];
        CHECK(material.bsdf.as<Lambert>().reflectance == Rgb(0.5f));
        CHECK(material.two_sided);
        CHECK(scene.files == std::vector{path.string()});
        CHECK_NOTHROW(build_any(scene));
    }
    CHECK(contains(message_of([&] { load_mesh_scene(folder.write("a.txt", ply)); }), "a.txt: is not called"));
    CHECK(contains(message_of([&] { load_mesh_scene(folder.path() / "b.ply"); }), "b.ply: no such file"));
}
