#include "load/gltf_files.hpp"

#include <lightswitch/load/gltf_file.hpp>
#include <lightswitch/load/scene_file.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

#if LIGHTSWITCH_HAS_GLTF

namespace {

constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126;

LibraryDescription load(std::string_view bytes, Notices* notices = nullptr, const char* name = "a.gltf") {
    const Folder folder;
    return load_gltf(folder.write(name, bytes), notices);
}
LibraryDescription load(const GltfText& file, Notices* notices = nullptr) { return load(file.json(), notices); }
std::string error_of(std::string_view bytes) {
    return message_of([&] { load(bytes); });
}
std::string error_of(const GltfText& file) { return error_of(file.json()); }
std::string joined(const Notices& notices) {
    std::string all;
    for (const std::string& notice : notices) all += notice + "; ";
    return all;
}
std::string notices_of(const GltfText& file) {
    Notices notices;
    load(file, &notices);
    return joined(notices);
}

const Mesh& mesh_of(const LibraryDescription& scene, std::size_t shape = 0) {
    return std::get<Mesh>(scene.shapes.at(shape).geometry);
}
bool near(const DVec3& a, const DVec3& b, double tolerance = 1e-9) { return glm::length(a - b) <= tolerance; }
bool near(const Rgb& a, const Rgb& b) { return glm::length(a - b) <= 1e-6f; }

/// The positions of a triangle of a mesh, one after the other.
std::vector<DVec3> corners(const Mesh& mesh, std::size_t triangle = 0) {
    std::vector<DVec3> result;
    for (const std::uint32_t corner : mesh.triangles.at(triangle)) result.push_back(mesh.positions.at(corner));
    return result;
}
bool same(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](auto& x, auto& y) { return near(x, y); });
}

/// A textured triangle whose material is `material`, with the images, samplers and textures of `more`.
GltfText with_material(const std::string& material, const std::string& more = "") {
    GltfText file = gltf_triangle();
    file.accessor(floats({0, 0, 1, 0, 0, 1}), f32, 3, "VEC2");
    file.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]})";
    file.more = R"(, "materials": [)" + material + "]" + more;
    return file;
}
/// The textures 0, 1, ... of these images.
std::string images(const std::vector<std::string>& uris, const std::string& members = "") {
    std::string images, textures;
    for (std::size_t i = 0; i < uris.size(); ++i) {
        images += (i > 0 ? ", " : "") + (R"({"uri": ")" + uris[i] + "\"}");
        textures += (i > 0 ? ", " : "") + (R"({"source": )" + std::to_string(i) + members + "}");
    }
    return R"(, "images": [)" + images + R"(], "textures": [)" + textures + "]";
}

/// The surface model below all layers.
const LibraryDescription::NamedMaterial& surface_model(const LibraryDescription& scene) {
    std::size_t number = scene.shapes.at(0).material;
    while (scene.materials.at(number).layer) number = detail::below(*scene.materials[number].layer)[0];
    return scene.materials[number];
}
Principled principled(const LibraryDescription& scene, const Vec2& uv = {}) {
    const auto& bsdf = surface_model(scene).bsdf;
    if (const auto* plain = bsdf.get<Principled>()) return *plain;
    const SurfacePoint point{};
    return bsdf.as<Textured<Principled>>().at({uv, point});
}
template <class Layer>
const Layer* layer_of(const LibraryDescription& scene) {
    const auto& layer = scene.materials.at(scene.shapes.at(0).material).layer;
    return layer ? std::get_if<Layer>(&*layer) : nullptr;
}

// Centres of the texels of a 2 x 2 image; v grows downwards.
const Vec2 upper_left(0.25f, 0.25f), upper_right(0.75f, 0.25f), lower_left(0.25f, 0.75f), lower_right(0.75f, 0.75f);

}  // namespace

TEST_CASE("a triangle loads from .gltf and .glb, with a camera and a sky that notices tell of") {
    const GltfText file = gltf_triangle();
    for (const bool binary : {false, true}) {
        Notices notices;
        const auto scene = load(binary ? file.glb() : file.json(), &notices, "thing.gltf");
        CHECK(scene.name == "thing");
        REQUIRE(scene.shapes.size() == 1);
        CHECK(same(corners(mesh_of(scene)), {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
        CHECK(mesh_of(scene).normals.empty());
        CHECK(scene.sources.size() == 1);
        CHECK(contains(joined(notices), "there is no camera"));
        CHECK(contains(joined(notices), "a sky is added"));
        CHECK_NOTHROW(detail::check(scene));
        const DVec3 eye(scene.camera.to_world[3]), forward(scene.camera.to_world[2]);
        CHECK(glm::dot(glm::normalize(DVec3(0.5, 1, 0) - eye), forward) > 0.999);
    }
}

TEST_CASE("buffers and images come from files beside the scene, also with escapes in their names") {
    const Folder folder;
    GltfText file =
        with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})", images({"some%20image.png"}));
    std::string text = file.json();
    const std::size_t uri = text.find("data:"), end = text.find('"', uri);
    text.replace(uri, end - uri, "the%20buffer.bin");
    folder.write("the buffer.bin", file.buffer);
    folder.write("some image.png", sample_png(8, 2));
    const auto scene = load_gltf(folder.write("a.gltf", text));
    CHECK(scene.files.size() == 3);
    CHECK(same(corners(mesh_of(scene)), {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
    std::filesystem::remove(folder.path() / "the buffer.bin");
    CHECK(contains(message_of([&] { load_gltf(folder.path() / "a.gltf"); }), "a.gltf: buffers[0]: "));
}

TEST_CASE("an image file is read once, however it is used") {
    const Folder folder;
    folder.write("image.png", "an image");
    const auto path = folder.write("a.gltf", R"({"asset": {"version": "2.0"}, "images": [{"uri": "image.png"}]})");
    detail::FileNotices notices;
    detail::GltfFile file(path, notices);
    CHECK(file.image(0) == "an image");
    const std::size_t bytes = file.used_bytes();
    std::filesystem::remove(folder.path() / "image.png");
    CHECK(file.image(0) == "an image");
    CHECK(file.used_bytes() == bytes);
}

TEST_CASE("indices of every size, strips and fans give the triangles of the specification") {
    const std::string square = floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 5, 5, 5});
    const DVec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
    const auto indexed = [&](std::string_view bytes, int type, int mode) {
        GltfText file;
        file.accessor(square, f32, 5, "VEC3");
        file.accessor(bytes, type, 4, "SCALAR");
        file.meshes =
            R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": )" + std::to_string(mode) + "}]}";
        return load(file);
    };
    const std::string words("\0\0\0\0\1\0\0\0\2\0\0\0\3\0\0\0", 16);
    for (const auto& [bytes, type] :
         {std::pair{std::string("\0\1\2\3", 4), u8}, {shorts({0, 1, 2, 3}), u16}, {words, u32}}) {
        const auto strip = indexed(bytes, type, 5);
        REQUIRE(mesh_of(strip).triangles.size() == 2);
        CHECK(same(corners(mesh_of(strip), 0), {a, b, c}));
        CHECK(same(corners(mesh_of(strip), 1), {b, d, c}));
        CHECK(mesh_of(strip).positions.size() == 4);  // the fifth is not used
        const auto fan = indexed(bytes, type, 6);
        REQUIRE(mesh_of(fan).triangles.size() == 2);
        CHECK(same(corners(mesh_of(fan), 0), {a, b, c}));
        CHECK(same(corners(mesh_of(fan), 1), {a, c, d}));
        CHECK(mesh_of(indexed(bytes, type, 4)).triangles.size() == 1);
    }
    GltfText late;  // 16-bit indices above 255
    std::string many;
    for (int i = 0; i < 300; ++i) many += floats({float(i), 0, float(i % 7)});
    late.accessor(many, f32, 300, "VEC3");
    late.accessor(shorts({298, 1, 259}), u16, 3, "SCALAR");
    late.meshes = R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]})";
    CHECK(same(corners(mesh_of(load(late))), {{298, 0, 4}, {1, 0, 1}, {259, 0, 0}}));
}

TEST_CASE("normalized integers, strides and sparse accessors") {
    GltfText file;
    // Positions as signed bytes, one every 4 bytes; -128 counts as -1.
    file.accessor(std::string("\x7f\0\0\xee\0\x7f\0\xee\0\0\x80\xee", 12), i8, 3, "VEC3", R"(, "normalized": true)",
                  R"(, "byteStride": 4)");
    file.accessor(shorts({32767, 0, 0, 0, 0, -32767, 0, 0, 0, 0, 16384, 0}), i16, 3, "VEC3", R"(, "normalized": true)",
                  R"(, "byteStride": 8)");
    file.accessor(shorts({0, 65535, 13107, 0, 65535, 65535}), u16, 3, "VEC2", R"(, "normalized": true)");
    file.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]})";
    const Mesh mesh = mesh_of(load(file));
    CHECK(same(mesh.positions, {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}));
    CHECK(same(mesh.normals, {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}));
    REQUIRE(mesh.uvs.size() == 3);
    CHECK(mesh.uvs[0] == Vec2(0, 1));
    CHECK(mesh.uvs[1] == Vec2(0.2f, 0));
    CHECK(mesh.uvs[2] == Vec2(1, 1));

    GltfText sparse;
    const int base = sparse.view(floats({0, 0, 0, 1, 0, 0, 0, 2, 0}));
    const int indices = sparse.view(shorts({2, 0})), values = sparse.view(floats({7, 8, 9, 4, 5, 6}));
    const auto members = R"(, "sparse": {"count": 2, "indices": {"bufferView": )" + std::to_string(indices) +
                         R"(, "componentType": 5123}, "values": {"bufferView": )" + std::to_string(values) + "}}";
    sparse.accessor_of(base, f32, 3, "VEC3", members);
    CHECK(same(mesh_of(load(sparse)).positions, {{4, 5, 6}, {1, 0, 0}, {7, 8, 9}}));
    GltfText zeros = sparse;
    zeros.accessors = "";
    zeros.accessor_of(-1, f32, 3, "VEC3", members);
    CHECK(same(mesh_of(load(zeros)).positions, {{4, 5, 6}, {0, 0, 0}, {7, 8, 9}}));
}

TEST_CASE("nodes: translation, rotation and scale, in that order, or a matrix, below each other") {
    GltfText file = gltf_triangle();
    // A quarter turn around z takes x to y.
    file.nodes = R"({"children": [1], "translation": [10, 20, 30]},
                    {"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [2, 3, 4],
                     "translation": [1, 0, 0]})";
    CHECK(same(corners(mesh_of(load(file))), {{11, 20, 30}, {11, 22, 30}, {5, 20, 30}}));
    file.nodes = R"({"children": [1], "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}, {"mesh": 0})";
    CHECK(same(corners(mesh_of(load(file))), {{5, 6, 7}, {5, 7, 7}, {3, 6, 7}}));
    // Double precision: a float would lose the tenth.
    file.nodes = R"({"mesh": 0, "translation": [100000000.1, 0, 0]})";
    CHECK(near(mesh_of(load(file)).positions[0], {100000000.1, 0, 0}, 1e-7));
}

TEST_CASE("normals follow the inverse transpose; a reflection keeps the front where it was") {
    GltfText file;
    file.accessor(floats({0, 0, 0, 1, -1, 0, 0, 0, 1}), f32, 3, "VEC3");
    file.accessor(floats({1, 1, 0, 1, 1, 0, 1, 1, 0}), f32, 3, "VEC3");
    file.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]})";
    file.nodes = R"({"mesh": 0, "scale": [4, 1, 1]})";
    const Mesh stretched = mesh_of(load(file));
    CHECK(near(stretched.normals[0], glm::normalize(DVec3(0.25, 1, 0))));
    for (const char* scale : {"[4, 1, 1]", "[-4, 1, 1]", "[1, -2, -3]", "[-1, -1, -1]"}) {
        file.nodes = R"({"mesh": 0, "scale": )" + std::string(scale) + "}";
        const Mesh mesh = mesh_of(load(file));
        const auto t = corners(mesh);
        CHECK(glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), mesh.normals[0]) *
                  glm::dot(glm::cross(DVec3(1, -1, 0), DVec3(0, 0, 1)), DVec3(1, 1, 0)) >
              0);
    }
    // The winding decides, not the normals, as long as there are some.
    GltfText against;
    against.accessor(floats({0, 0, 0, 1, -1, 0, 0, 0, 1}), f32, 3, "VEC3");
    against.accessor(floats({-1, -1, 0, -1, -1, 0, 0, 0, 0}), f32, 3, "VEC3");
    against.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]})";
    const Mesh mesh = mesh_of(load(against));
    CHECK(same(corners(mesh), {{0, 0, 0}, {1, -1, 0}, {0, 0, 1}}));
    CHECK(contains(notices_of(against), "normal or one of length 0"));
}

TEST_CASE("a mesh that several nodes use becomes a group with instances") {
    GltfText file = gltf_triangle();
    file.nodes =
        R"({"mesh": 0, "translation": [1, 2, 3]}, {"mesh": 0, "scale": [-1, 1, 1]}, {"mesh": 0, "scale": [0, 1, 1]})";
    file.scene = "0, 1, 2";
    Notices notices;
    const auto scene = load(file, &notices);
    CHECK(scene.shapes.empty());
    REQUIRE(scene.groups.size() == 1);
    REQUIRE(scene.instances.size() == 2);
    CHECK(near(DVec3(scene.instances[0].to_world[3]), {1, 2, 3}));
    CHECK(scene.instances[1].to_world[0][0] == -1);
    CHECK(contains(joined(notices), "nodes[2]: a mesh that is scaled to nothing is skipped"));
    CHECK_NOTHROW(detail::check(scene));
    // What is squeezed much is no instance; alone, a mesh never is one.
    file.nodes = R"({"mesh": 0, "translation": [1, 2, 3]}, {"mesh": 0, "scale": [5000, 1, 1]})";
    file.scene = "0, 1";
    const auto both = load(file);
    CHECK(both.instances.size() == 1);
    REQUIRE(both.shapes.size() == 1);
    CHECK(near(mesh_of(both).positions[1], {5000, 0, 0}));
}

TEST_CASE("metallic-roughness: factors, and textures whose first row is at v = 0") {
    auto scene =
        load(with_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor":
        0.25, "roughnessFactor": 0.75}, "doubleSided": true})"));
    CHECK(principled(scene).base_color == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(principled(scene).metallic == 0.25f);
    CHECK(principled(scene).roughness == 0.75f);
    CHECK(principled(scene).eta == 1.5f);
    CHECK(surface_model(scene).two_sided);
    scene = load(gltf_triangle());
    CHECK(principled(scene).base_color == Rgb(1));
    CHECK(principled(scene).metallic == 1);
    CHECK(principled(scene).roughness == 1);
    CHECK_FALSE(surface_model(scene).two_sided);

    const std::string colors = png_uri(2, {{255, 0, 0, 0, 255, 0}, {0, 0, 255, 188, 188, 188}});
    const std::string rough = png_uri(2, {{9, 51, 102, 9, 51, 204}, {9, 255, 102, 9, 255, 204}});
    scene = load(with_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.25, 1], "metallicFactor": 0.5,
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}})",
                               images({colors, rough})));
    CHECK(near(principled(scene, upper_left).base_color, Rgb(0.5f, 0, 0)));
    CHECK(near(principled(scene, upper_right).base_color, Rgb(0, 1, 0)));
    CHECK(near(principled(scene, lower_left).base_color, Rgb(0, 0, 0.25f)));
    CHECK(near(principled(scene, lower_right).base_color, Rgb(0.5f, 1, 0.25f) * srgb_decode(188 / 255.0f)));
    CHECK(std::abs(principled(scene, upper_left).roughness - 0.2f) < 1e-6f);
    CHECK(std::abs(principled(scene, upper_left).metallic - 0.2f) < 1e-6f);
    CHECK(std::abs(principled(scene, lower_right).roughness - 1.0f) < 1e-6f);
    CHECK(std::abs(principled(scene, lower_right).metallic - 0.4f) < 1e-6f);
    CHECK_NOTHROW(detail::check(scene));
}

TEST_CASE("samplers and the transform of texture coordinates") {
    const std::string image = png_uri(2, {{255, 0, 0, 0, 255, 0}, {0, 0, 255, 255, 255, 255}});
    const auto color = [&](const std::string& sampler, const std::string& transform, const Vec2& uv) {
        const std::string info = R"({"index": 0, "extensions": {"KHR_texture_transform": {)" + transform + "}}}";
        return principled(
                   load(with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": )" + info + "}}",
                                      images({image}, R"(, "sampler": 0)") + R"(, "samplers": [{)" + sampler + "}]")),
                   uv)
            .base_color;
    };
    const Rgb red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);
    CHECK(color(R"("magFilter": 9728)", "", {0.45f, 0.45f}) == red);
    CHECK(color("", "", {0.45f, 0.45f}) != red);
    CHECK(color(R"("magFilter": 9728)", "", {1.3f, 0.3f}) == red);
    CHECK(color(R"("magFilter": 9728, "wrapS": 33648, "wrapT": 33648)", "", {1.3f, 0.3f}) == green);
    CHECK(color(R"("magFilter": 9728, "wrapS": 33071, "wrapT": 33071)", "", {7.3f, -2}) == green);
    CHECK(color(R"("magFilter": 9728)", R"("offset": [0.5, 0])", {0.25f, 0.25f}) == green);
    CHECK(color(R"("magFilter": 9728)", R"("scale": [1, 3])", {0.25f, 0.25f}) == blue);
    // The specification's example: the lower left quarter of the image, by a quarter turn.
    const std::string quarter = R"("offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5])";
    for (const Vec2 uv : {Vec2(0.1f, 0.1f), Vec2(0.9f, 0.1f), Vec2(0.1f, 0.9f), Vec2(0.9f, 0.9f)})
        CHECK(color(R"("magFilter": 9728)", quarter, uv) == blue);
    CHECK(color(R"("magFilter": 9728)", R"("rotation": 1.57079632679)", {0.75f, 0.25f}) == red);
}

TEST_CASE("emission: factor, texture and strength") {
    auto scene = load(with_material(R"({"emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0}, "extensions":
        {"KHR_materials_emissive_strength": {"emissiveStrength": 20}}})",
                                    images({png_uri(1, {{255, 0, 0}, {0, 255, 0}})})));
    REQUIRE(scene.shapes[0].emission);
    CHECK(*scene.shapes[0].emission == Rgb(20, 10, 0));
    REQUIRE(scene.shapes[0].emission_texture);
    CHECK((*scene.shapes[0].emission_texture)({0.5f, 0.25f}) == Rgb(1, 0, 0));
    CHECK(scene.sources.empty());
    CHECK_NOTHROW(detail::check(scene));
    scene = load(with_material(R"({"emissiveFactor": [0, 0, 0], "emissiveTexture": {"index": 0}})",
                               images({png_uri(1, {{255, 0, 0}})})));
    CHECK_FALSE(scene.shapes[0].emission);
    // Glowing parts are no lamp.
    scene = load(with_material(R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}})",
                               images({png_uri(1, {{255, 0, 0}, {0, 0, 0}})})));
    CHECK(scene.shapes[0].emission);
    CHECK(scene.sources.size() == 1);
    CHECK(load(with_material(R"({"emissiveFactor": [1, 1, 1]})")).sources.empty());

    Notices notices;
    scene = load(with_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1]},
        "extensions": {"KHR_materials_unlit": {}}})"),
                 &notices);
    CHECK(*scene.shapes[0].emission == Rgb(1, 0.5f, 0.25f));
    CHECK(surface_model(scene).bsdf.as<Lambert>().reflectance == Rgb(0));
    CHECK(contains(joined(notices), "unlit"));
}

TEST_CASE("opacity: cut off, blended, and of what shines none") {
    const std::string image = png_uri(2, {{9, 9, 9, 255, 9, 9, 9, 102}, {9, 9, 9, 101, 9, 9, 9, 0}}, true);
    const auto opacity = [&](const std::string& members, const std::string& factor) {
        const auto scene = load(with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
            "baseColorFactor": [1, 1, 1, )" + factor +
                                                  "]}, " + members + "}",
                                              images({image})));
        CHECK_NOTHROW(detail::check(scene));
        const Mask* mask = layer_of<Mask>(scene);
        std::vector<float> values;
        for (const Vec2& uv : {upper_left, upper_right, lower_left, lower_right})
            values.push_back(mask ? mask->opacity(uv).x : -1);
        return values;
    };
    CHECK(opacity(R"("alphaMode": "OPAQUE")", "0.5") == std::vector<float>{-1, -1, -1, -1});
    CHECK(opacity(R"("alphaMode": "MASK", "alphaCutoff": 0.4)", "1") == std::vector<float>{1, 1, 0, 0});
    CHECK(opacity(R"("alphaMode": "MASK")", "1") == std::vector<float>{1, 0, 0, 0});
    CHECK(opacity(R"("alphaMode": "MASK", "alphaCutoff": 0.4)", "0.5") == std::vector<float>{1, 0, 0, 0});
    CHECK(opacity(R"("alphaMode": "MASK")", "0.25") == std::vector<float>{0, 0, 0, 0});
    const auto blended = opacity(R"("alphaMode": "BLEND")", "0.5");
    CHECK(std::abs(blended[0] - 0.5f) < 1e-6f);
    CHECK(std::abs(blended[1] - 0.2f) < 1e-6f);
    CHECK(blended[3] == 0);
    const std::string opaque = R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})";
    CHECK_FALSE(layer_of<Mask>(load(with_material(opaque, images({png_uri(1, {{1, 2, 3}})})))));
    const GltfText lamp = with_material(R"({"alphaMode": "BLEND", "emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})");
    CHECK_NOTHROW(detail::check(load(lamp)));
    CHECK(contains(notices_of(lamp), "shines, so that it is taken as opaque"));
}

TEST_CASE("normal maps, glass, coats and indices of refraction") {
    auto scene = load(with_material(R"({"normalTexture": {"index": 0, "scale": 0.5}, "doubleSided": true})",
                                    images({png_uri(1, {{255, 128, 128}, {51, 102, 255}})})));
    const NormalMap* map = layer_of<NormalMap>(scene);
    REQUIRE(map);
    CHECK(map->scale == 0.5f);
    CHECK(map->against_v);
    CHECK(near(map->normals({0.5f, 0.75f}), Rgb(0.2f, 0.4f, 1)));  // not decoded from sRGB
    CHECK(surface_model(scene).two_sided);

    Notices notices;
    scene =
        load(with_material(R"({"doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0}}}})",
                           images({png_uri(1, {{51, 9, 9}, {255, 9, 9}})})),
             &notices);
    CHECK(principled(scene).spec_trans == 0.5f);
    CHECK(principled(scene).eta == 1.25f);
    CHECK(std::abs(principled(scene, {0.5f, 0.25f}).clearcoat - 0.1f) < 1e-6f);
    CHECK(principled(scene).clearcoat_gloss == 1);
    CHECK_FALSE(surface_model(scene).two_sided);
    CHECK(contains(joined(notices), "refracts here"));
    CHECK_NOTHROW(detail::check(scene));
}

TEST_CASE("cameras look along -z of their node, whose scale does not count") {
    GltfText file = gltf_triangle();
    file.nodes = R"({"mesh": 0}, {"camera": 1, "translation": [1, 2, 3], "scale": [2, 2, 2]}, {"camera": 0})";
    file.scene = "0, 1, 2";
    file.more =
        R"(, "cameras": [{"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 6, "znear": 0, "zfar": 9}},
        {"type": "perspective", "perspective": {"yfov": 1.0471975511965976, "aspectRatio": 2, "znear": 0.5}}])";
    auto scene = load(file);
    CHECK(near(DVec3(scene.camera.to_world[3]), {1, 2, 3}));
    CHECK(near(DVec3(scene.camera.to_world[2]), {0, 0, -1}));
    CHECK(near(DVec3(scene.camera.to_world[1]), {0, 1, 0}));
    CHECK(near(DVec3(scene.camera.to_world[0]), {-1, 0, 0}));
    CHECK(std::abs(scene.camera.fov - 60) < 1e-9);
    CHECK(scene.camera.fov_axis == CameraDescription::FovAxis::y);
    CHECK(scene.film.width == 1280);
    CHECK(scene.film.height == 640);
    CHECK(scene.camera.near_clip == 0.5);
    CHECK(scene.camera.far_clip == std::numeric_limits<double>::infinity());
    CHECK_NOTHROW(detail::check(scene));
    file.nodes = R"({"mesh": 0}, {"camera": 0, "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]})";
    file.scene = "0, 1";
    scene = load(file);
    CHECK(scene.camera.projection == CameraDescription::Projection::orthographic);
    CHECK(near(DVec3(scene.camera.to_world[2]), {-1, 0, 0}));  // a quarter turn around y takes -z to -x
    CHECK(scene.camera.half_width == 3);
    CHECK(scene.film.width == 640);
    CHECK(scene.film.height == 1280);
    CHECK_NOTHROW(detail::check(scene));
}

TEST_CASE("punctual lights shine along -z of their node") {
    GltfText file = gltf_triangle();
    const auto light = [](int number) {
        return R"({"translation": [1, 2, 3], "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476], "extensions":
            {"KHR_lights_punctual": {"light": )" +
               std::to_string(number) + "}}}";
    };
    file.nodes = R"({"mesh": 0}, )" + light(0) + ", " + light(1) + ", " + light(2);
    file.scene = "0, 1, 2, 3";
    file.more = R"(, "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1, 0.5, 0.25], "intensity": 40, "range": 5},
        {"type": "directional", "intensity": 3},
        {"type": "spot", "spot": {"innerConeAngle": 0.5235987755982988, "outerConeAngle": 1.0471975511965976}}]}})";
    Notices notices;
    const auto scene = load(file, &notices);
    REQUIRE(scene.sources.size() == 3);
    const auto* point = scene.sources[0].source.get<PointSource>();
    REQUIRE(point);
    CHECK(point->position == DVec3(1, 2, 3));
    CHECK(point->intensity == Rgb(40, 20, 10));
    const auto* sun = scene.sources[1].source.get<DirectionalSource>();
    REQUIRE(sun);
    CHECK(near(sun->direction, {0, 1, 0}));  // a quarter turn around x takes -z to y
    CHECK(sun->irradiance == Rgb(3));
    const auto* spot = scene.sources[2].source.get<SpotSource>();
    REQUIRE(spot);
    CHECK(near(spot->direction, {0, 1, 0}));
    CHECK(std::abs(spot->cutoff_angle - 60) < 1e-9);
    CHECK(std::abs(spot->beam_width - 30) < 1e-9);
    CHECK(contains(joined(notices), "lights[0]: the range of a light is ignored"));
}

TEST_CASE("what is not honoured is told, what is required and unknown refused") {
    GltfText file = gltf_triangle();
    file.accessor(floats({1, 1, 1, 1, 1, 1, 1, 1, 1}), f32, 3, "VEC3");
    file.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "targets": [{"POSITION": 1}]},
                      {"attributes": {"POSITION": 0}, "mode": 1}]})";
    file.nodes = R"({"mesh": 0, "skin": 0})";
    file.more = R"(, "extensionsUsed": ["KHR_materials_specular", "KHR_texture_transform"], "skins": [{"joints": [0]}],
                    "animations": [{"channels": [], "samplers": []}], "scene": 0)";
    const std::string notices = notices_of(file);
    for (const char* part :
         {"KHR_materials_specular is ignored", "skins are ignored", "animations are ignored",
          "nodes[0]: a skin is ignored", "meshes[0]: colours of vertices", "morph targets", "lines are"})
        CHECK_MESSAGE(contains(notices, part), part << " in " << notices);
    CHECK_FALSE(contains(notices, "KHR_texture_transform"));
    file.more =
        R"(, "extensionsRequired": ["KHR_draco_mesh_compression", "KHR_mesh_quantization", "EXT_meshopt_compression"])";
    CHECK(contains(error_of(file), "not supported: KHR_draco_mesh_compression, EXT_meshopt_compression"));
}

TEST_CASE("damage is an error that names file and element") {
    const auto broken = [](const char* element, std::string_view what, const auto& change) {
        GltfText file = gltf_triangle();
        change(file);
        const std::string message = error_of(file);
        CHECK_MESSAGE(contains(message, std::string("a.gltf: ") + element), message);
        CHECK_MESSAGE(contains(message, what), message);
    };
    const std::string nothing;
    broken("accessors[0]: ", "more than are in its buffer view",
           [](auto& f) { f.accessors = R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"})"; });
    broken("accessors[0]: ", "more than are in its buffer view", [](auto& f) {
        f.accessors = R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "byteOffset": 4})";
    });
    broken("accessors[0]: ", "more than are in its buffer view", [](auto& f) {
        f.accessors = R"({"bufferView": 0, "componentType": 5126, "count": 2147483647, "type": "VEC3"})";
    });
    broken("accessors[0]: ", "without data",
           [](auto& f) { f.accessors = R"({"componentType": 5126, "count": 2000000000, "type": "VEC3"})"; });
    broken("accessors[0]: ", "elements of 2 numbers",
           [](auto& f) { f.accessors = R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"})"; });
    broken("accessors[0]: ", "type 5124",
           [](auto& f) { f.accessors = R"({"bufferView": 0, "componentType": 5124, "count": 3, "type": "VEC3"})"; });
    broken("accessors[0]: ", "names bufferViews[7]",
           [](auto& f) { f.accessors = R"({"bufferView": 7, "componentType": 5126, "count": 3, "type": "VEC3"})"; });
    broken("accessors[0]: ", "no whole number",
           [](auto& f) { f.accessors = R"({"bufferView": 0, "componentType": 5126, "count": -3, "type": "VEC3"})"; });
    broken("bufferViews[0]: ", "but buffers[0] has 36",
           [](auto& f) { f.views = R"({"buffer": 0, "byteOffset": 4, "byteLength": 33})"; });
    broken("bufferViews[0]: ", "names buffers[1]", [](auto& f) { f.views = R"({"buffer": 1, "byteLength": 36})"; });
    broken("nodes[0]: ", "names meshes[3]", [](auto& f) { f.nodes = R"({"mesh": 3})"; });
    broken("nodes[0]: ", "names nodes[9]", [](auto& f) { f.nodes = R"({"mesh": 0, "children": [9]})"; });
    broken("nodes[0]: ", "below itself",
           [](auto& f) { f.nodes = R"({"children": [1]}, {"children": [0], "mesh": 0})"; });
    broken("nodes[1]: ", "below two others", [](auto& f) { f.nodes = R"({"children": [1, 1]}, {"mesh": 0})"; });
    broken("nodes[0]: ", "wrong count", [](auto& f) { f.nodes = R"({"mesh": 0, "scale": [1, 2]})"; });
    broken("nodes[0]: ", "rotation that is none",
           [](auto& f) { f.nodes = R"({"mesh": 0, "rotation": [0, 0, 0, 0]})"; });
    broken("nodes[0]: ", "beyond 1e100", [](auto& f) {
        f.nodes = R"({"children": [1], "scale": [1e300, 1, 1]}, {"mesh": 0, "scale": [1e300, 1, 1]})";
    });
    broken("meshes[0]: ", "names accessors[5]",
           [](auto& f) { f.meshes = R"({"primitives": [{"attributes": {"POSITION": 5}}]})"; });
    broken("meshes[0]: ", "names accessors[5]",
           [](auto& f) { f.meshes = R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 5}]})"; });
    broken("meshes[0]: ", "names materials[0]",
           [](auto& f) { f.meshes = R"({"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]})"; });
    broken("accessors[1]: ", "names vertex 3, but there are 3", [](auto& f) {
        f.accessor(shorts({0, 1, 3}), u16, 3, "SCALAR");
        f.meshes = R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]})";
    });
    broken("accessors[1]: ", "no indices", [](auto& f) {
        f.accessor(floats({0, 1, 2}), f32, 3, "SCALAR");
        f.meshes = R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]})";
    });
    broken("accessors[1]: ", "2 elements for 3 positions", [](auto& f) {
        f.accessor(floats({0, 0, 1, 0, 0, 1}), f32, 2, "VEC3");
        f.meshes = R"({"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]})";
    });
    broken("accessors[1]: ", "not finite in element 2", [](auto& f) {
        f.accessor(floats({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}), f32, 3, "VEC3");
        f.meshes = R"({"primitives": [{"attributes": {"POSITION": 1}}]})";
    });
    for (const char* damaged :
         {R"(, "sparse": {"count": 4, "indices": {"bufferView": 0, "componentType": 5121},
                                   "values": {"bufferView": 0}})",
          R"(, "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 36, "componentType":
                                   5121}, "values": {"bufferView": 0}})",
          R"(, "sparse": {"count": 2, "indices": {"bufferView": 0, "componentType": 5121},
                                   "values": {"bufferView": 0, "byteOffset": 20}})",
          R"(, "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": -1, "componentType":
                                   5121}, "values": {"bufferView": 0}})"})
        broken("accessors[0]: ", "", [&](auto& f) {
            f.accessors =
                R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3")" + std::string(damaged) + "}";
        });
    broken("", "no triangles", [](auto& f) { f.nodes = "{}"; });
    broken("", "version \"1.0\"", [](auto& f) { f.version = "1.0"; });
    CHECK(contains(error_of("{"), "a.gltf: is no JSON"));
    CHECK(contains(error_of(""), "a.gltf: is no JSON"));
    CHECK(contains(error_of(R"({"asset": {"version": "2.0"}, "nodes": 7})"), "nodes is no array"));
    CHECK(contains(error_of(R"({"asset": {"version": "2.0"}, "extras": )" + std::string(100000, '[')), "64 levels"));
    std::string damaged = gltf_triangle().json();
    damaged.replace(damaged.find("base64,") + 9, 1, "*");
    CHECK(contains(error_of(damaged), "buffers[0]: has a data: uri"));
    const GltfText image = with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                                         images({"data:image/png;base64,AAAA"}));
    CHECK(contains(error_of(image), "a.gltf: images[0]: "));
    const GltfText missing = with_material(R"({"normalTexture": {"index": 4}})");
    CHECK(contains(error_of(missing), "materials[0]: names textures[4]"));
}

TEST_CASE("nodes in a long chain, and few bytes that ask for many triangles, are refused") {
    GltfText file = gltf_triangle();
    file.nodes = "";
    for (int i = 0; i < 1100; ++i) file.nodes += R"({"children": [)" + std::to_string(i + 1) + "]}, ";
    file.nodes += R"({"mesh": 0})";
    CHECK(contains(error_of(file), "below more than 1024 others"));
    std::string primitives;
    for (int i = 0; i < 2000; ++i) primitives += std::string(i ? "," : "") + R"({"attributes":{"POSITION":1}})";
    GltfText many = gltf_triangle();
    many.accessor(std::string(12 * 3000, '\0'), f32, 3000, "VEC3");
    many.meshes = R"({"primitives": [)" + primitives + "]}";
    CHECK(contains(error_of(many), "meshes[0]: has too many vertices"));
}

TEST_CASE("cut and altered files load or are refused") {
    GltfText file =
        with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1,
        0.5]}, "alphaMode": "BLEND", "normalTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}}}})",
                      images({png_uri(1, {{1, 2, 3}})}));
    file.accessor(shorts({0, 1, 2}), u16, 3, "SCALAR");
    file.meshes =
        R"({"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": 5}]})";
    file.nodes =
        R"({"children": [1, 2]}, {"mesh": 0, "rotation": [0, 0, 0, 1]}, {"mesh": 0, "scale": [1, 2, 3], "camera": 0})";
    file.more += R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])";
    int loaded = 0;
    for (const bool binary : {false, true})
        for (std::uint32_t seed = 0; seed < 600; ++seed) {
            const std::string bytes = mutated(binary ? file.glb() : file.json(), seed);
            try {
                detail::check(load(bytes));
                ++loaded;
            } catch (const Error&) {
            }
        }
    CHECK(loaded > 100);
}

#else

TEST_CASE("without tinygltf a glTF file is an error that says so") {
    CHECK(contains(message_of([] { load_gltf("a.gltf"); }), "a.gltf: this program was built without tinygltf"));
}

#endif
