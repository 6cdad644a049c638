// Mistakes about surfaces, textures, layers, instances, lights and cameras that another description of the scene makes,
// too: a parameter that is read wrongly is a wrong parameter.

#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

namespace {

using Scene = LibraryDescription;

/// A material on a ball and on the floor below it, under a lamp and a dim sky.
Scene ball_on_floor(const std::function<std::size_t(Scene&)>& material) {
    auto scene = empty_view<AnyMaterial>("ball-on-floor", {0, 2, 4}, {0, 0.4, 0}, 40);
    const std::size_t surface = material(scene);
    scene.add(level({0, 0, 0}, 2, 2), scene.add(Lambert{Rgb(0.5f)}));
    scene.add(Sphere{.center = {-0.8, 0.7, 0}, .radius = 0.7}, surface);
    scene.add(quad({0.2, 0, 0.4}, {1.5, 0.2, 0.6}, {1.5, 1.4, -0.4}, {0.2, 1.2, -0.4}), surface);
    scene.add(level({0.5, 3, 1}, 0.8, 0.8, false), scene.add(Lambert{Rgb(0)}), Rgb(8, 7, 6));
    scene.add(EnvironmentSource{Rgb(0.3f, 0.35f, 0.4f)});
    return scene;
}

Texture checks(const Rgb& a, const Rgb& b, const UvTransform& to_uv = {.u = {2, 0, 0}, .v = {0, 2, 0}}) {
    return Texture(Checkerboard{a, b}, to_uv);
}

/// A bitmap that is nothing like its mirror images. `encoding` and `powers` are what a mistake about sRGB changes.
Texture picture(TexelEncoding encoding, const UvTransform& to_uv = {}, double power = 1) {
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 3; ++c) {
                const double value = double((x * 5 + y * 3 + c * 7) % 11) / 11;
                texels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::pow(value, power))));
            }
    return Texture(Bitmap(4, 4, texels, encoding), to_uv);
}

Texture heights(float sign) {
    std::vector<float> texels;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) texels.push_back(0.5f + sign * 0.04f * float((x * x + 3 * y) % 8));
    return Texture(Bitmap(8, 8, texels, TexelEncoding::linear));
}

Texture normals(float green) {
    std::vector<float> texels;
    for (int i = 0; i < 16; ++i) {
        const Vec3 n = normalize(Vec3(0.4f, green * 0.6f, 1)) * 0.5f + 0.5f;
        texels.insert(texels.end(), {n.x, n.y, n.z});
    }
    return Texture(Bitmap(4, 4, texels, TexelEncoding::linear));
}

Scene instances(const DMat4& to_world) {
    Scene scene = ball_on_floor([](Scene& s) { return s.add(Lambert{Rgb(0.5f)}); });
    Scene::Group group;
    group.shapes.push_back({.geometry = cube(), .material = 0, .emission = {}, .origin = {}});
    scene.groups.push_back(std::move(group));
    scene.instances.push_back({.group = 0, .to_world = to_world, .origin = {}});
    return scene;
}

Scene mapped_sky(bool mirrored) {
    Scene scene = ball_on_floor([](Scene& s) { return s.add(Lambert{Rgb(0.5f)}); });
    scene.sources.clear();
    std::vector<Rgb> texels;
    for (int i = 0; i < 32; ++i) texels.push_back(Rgb(float(i % 8 == 1), float(i % 8 == 3), 0.2f));
    EnvironmentMapSource sky{.map = std::make_shared<const EnvironmentMap>(texels, 8, 4)};
    if (mirrored) sky.to_world[0].x = -1;
    scene.add(sky);
    return scene;
}

}  // namespace

std::vector<PlantedBug> surface_bugs() {
    std::vector<PlantedBug> bugs;
    const auto add = [&](std::string_view name, const Scene& wrong, const Scene& right, int length = 2) {
        bugs.push_back(
            {name, "ball-on-floor", length, [=] { return std::pair(library_nee(wrong), library_nee(right)); }});
    };
    const auto material = [&](std::string_view name, const auto& wrong, const auto& right) {
        add(name, ball_on_floor([&](Scene& s) { return s.add(wrong); }),
            ball_on_floor([&](Scene& s) { return s.add(right); }));
    };

    material("plastic: internal scattering keeps hues", Plastic{.diffuse_reflectance = {0.9f, 0.4f, 0.1f}},
             Plastic{.diffuse_reflectance = {0.9f, 0.4f, 0.1f}, .nonlinear = true});
    material("plastic: index of the coat reversed", Plastic{.eta = 1 / 1.5f}, Plastic{.eta = 1.5f});
    material("rough plastic: roughness squared", RoughPlastic{.alpha = 0.09f}, RoughPlastic{.alpha = 0.3f});
    material("rough plastic: index of the coat reversed", RoughPlastic{.alpha = 0.3f, .eta = 1 / 1.5f},
             RoughPlastic{.alpha = 0.3f, .eta = 1.5f});
    const RoughConductor brushed{.distribution = Facets::ggx, .alpha_u = 0.1f, .alpha_v = 0.5f};
    const auto turned = [](auto model) {
        std::swap(model.alpha_u, model.alpha_v);
        return Textured(model);
    };
    material("rough conductor: roughness along and across exchanged", turned(brushed), Textured(brushed));
    material("rough conductor: Beckmann taken for GGX",
             RoughConductor{.distribution = Facets::ggx, .alpha_u = 0.4f, .alpha_v = 0.4f},
             RoughConductor{.alpha_u = 0.4f, .alpha_v = 0.4f});
    material("rough dielectric: index reversed", RoughDielectric{.alpha_u = 0.3f, .alpha_v = 0.3f, .eta = 1 / 1.5f},
             RoughDielectric{.alpha_u = 0.3f, .alpha_v = 0.3f});
    material("rough dielectric: smooth", Dielectric{}, RoughDielectric{.alpha_u = 0.5f, .alpha_v = 0.5f});
    material("thin dielectric: one face", ThinDielectric{.eta = 1.3f}, ThinDielectric{.eta = 1.5f});
    material("thin dielectric: refracts", Dielectric{}, ThinDielectric{});
    material("principled: roughness not squared", Principled{.roughness = std::sqrt(0.4f), .metallic = 1},
             Principled{.roughness = 0.4f, .metallic = 1});
    material("principled: metallic ignored", Principled{}, Principled{.metallic = 0.5f});
    material("principled: clear coat four times as strong", Principled{.clearcoat = 1}, Principled{.clearcoat = 0.25f});
    material("thin principled: diffuse transmission not halved", PrincipledThin{.diff_trans = 1},
             PrincipledThin{.diff_trans = 0.5f});
    material("thin principled: base colour not under a root",
             PrincipledThin{.base_color = Rgb(0.25f), .spec_trans = 0.9f},
             PrincipledThin{.base_color = Rgb(0.5f), .spec_trans = 0.9f});
    material("rough diffuse: roughness ignored", Lambert{Rgb(0.8f)},
             RoughDiffuse{.alpha = 0.6f, .reflectance = Rgb(0.8f)});
    material("rough diffuse: roughness in degrees", RoughDiffuse{.alpha = 0.02f, .reflectance = Rgb(0.8f)},
             RoughDiffuse{.alpha = 1, .reflectance = Rgb(0.8f)});
    const ModifiedPhong highlight{.exponent = 20, .diffuse_reflectance = Rgb(0.2f), .specular_reflectance = Rgb(0.6f)};
    material("Phong: twice the exponent", ModifiedPhong{40, Rgb(0.2f), Rgb(0.6f)}, highlight);
    material("Phong: diffuse and specular exchanged", ModifiedPhong{20, Rgb(0.6f), Rgb(0.2f)}, highlight);
    const Ward ward{
        .alpha_u = 0.1f, .alpha_v = 0.4f, .diffuse_reflectance = Rgb(0.1f), .specular_reflectance = Rgb(0.6f)};
    material("Ward: roughness along and across exchanged", turned(ward), Textured(ward));
    Ward unbalanced = ward;
    unbalanced.variant = WardVariant::ward;
    material("Ward: not balanced", Textured(unbalanced), Textured(ward));

    const auto layered = [&](std::string_view name, const auto& wrong, const auto& right, int length = 2) {
        const auto over = [](const auto& layer) {
            return ball_on_floor([&](Scene& s) {
                s.add(Lambert{{0.8f, 0.2f, 0.1f}});
                s.add(Lambert{{0.1f, 0.3f, 0.8f}});
                s.materials[0].two_sided = s.materials[1].two_sided = true;
                return s.add(layer);
            });
        };
        add(name, over(wrong), over(right), length);
    };
    layered("blend: weight of the other one", Blend{1, 0, Texture(Rgb(0.25f))}, Blend{0, 1, Texture(Rgb(0.25f))});
    layered("mask: opacity taken for transparency", Mask{0, Texture(Rgb(0.7f))}, Mask{0, Texture(Rgb(0.3f))}, 1);
    layered("mask: hides nothing from lamps", Mask{0, Texture(Rgb(1))}, Mask{0, checks(Rgb(1), Rgb(0))}, 1);
    layered("bump map: hollows for hills", BumpMap{0, heights(-1)}, BumpMap{0, heights(1)});
    layered("bump map: height in half the unit", BumpMap{0, heights(1), 2}, BumpMap{0, heights(1), 1});
    layered("normal map: green points down", NormalMap{0, normals(-1)}, NormalMap{0, normals(1)});
    layered("normal map: without shadows", NormalMap{0, normals(1), true, false}, NormalMap{0, normals(1)});
    layered("coat: index reversed", Coating{0, {.eta = 1 / 1.5f}}, Coating{0, {.eta = 1.5f}});
    layered("coat: smooth", Coating{0, {}}, Coating{0, {.alpha = 0.4f}});
    layered("two sides: exchanged", BothSides{1, 0}, BothSides{0, 1});

    const auto textured = [&](std::string_view name, const Texture& wrong, const Texture& right) {
        material(name, Textured<Lambert>(Lambert{}).set("reflectance", wrong),
                 Textured<Lambert>(Lambert{}).set("reflectance", right));
    };
    textured("texture: sRGB taken for linear", picture(TexelEncoding::linear), picture(TexelEncoding::srgb));
    textured("texture: sRGB decoded twice", picture(TexelEncoding::srgb, {}, 2.2), picture(TexelEncoding::srgb));
    textured("texture: v flipped", picture(TexelEncoding::srgb, {.u = {1, 0, 0}, .v = {0, -1, 1}}),
             picture(TexelEncoding::srgb));
    textured("texture: shifted by half a texel", picture(TexelEncoding::srgb, {.u = {1, 0, 0.125}, .v = {0, 1, 0.125}}),
             picture(TexelEncoding::srgb));
    textured("texture: squares exchanged", checks(Rgb(0.2f), Rgb(0.8f)), checks(Rgb(0.8f), Rgb(0.2f)));

    const DMat4 stretch({0.2, 0, 0.3, 0}, {0, 0.5, 0, 0}, {-0.1, 0, 0.3, 0}, {0.2, 0.6, 1.1, 1});
    DMat4 transposed = stretch;
    std::swap(transposed[0].z, transposed[2].x);
    add("instance: linear part transposed", instances(transposed), instances(stretch));

    const auto with_spot = [](double beam) {
        Scene scene = ball_on_floor([](Scene& s) { return s.add(Lambert{Rgb(0.5f)}); });
        scene.add(SpotSource{.position = {-1, 3, 2},
                             .direction = {0.3, -1, -0.6},
                             .intensity = Rgb(9),
                             .cutoff_angle = 30,
                             .beam_width = beam});
        return scene;
    };
    add("spot: no falloff", with_spot(30), with_spot(15));
    add("environment map: mirrored", mapped_sky(true), mapped_sky(false));
    const auto with_lamp = [](const Texture& texture) {
        Scene scene = ball_on_floor([](Scene& s) { return s.add(Lambert{Rgb(0.5f)}); });
        for (auto& shape : scene.shapes)
            if (shape.emission) shape.emission_texture = texture;
        return scene;
    };
    add("lamp with a texture: even", with_lamp(Texture(Rgb(1))), with_lamp(checks(Rgb(1), Rgb(0), {})));
    return bugs;
}

}  // namespace lightswitch::test
