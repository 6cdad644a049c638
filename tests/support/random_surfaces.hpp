#pragma once

// Small random scenes of every surface model, textured or not, under layers, some of them in instances.

#include "support/chi_square.hpp"

#include <lightswitch/scene/stock.hpp>

namespace lightswitch::test {

/// Materials at random, with parameters that a path tracer can find its way through.
class RandomMaterials {
public:
    RandomMaterials(LibraryDescription& scene, Random& random) : scene_(scene), random_(random) {}

    /// A material with layers over it, perhaps; masked only if `masks`.
    std::size_t any(bool masks = true) {
        switch (below(8)) {
            case 0: return scene_.add(Blend{model(), model(), pattern()});
            case 1: return masks ? scene_.add(Mask{model(), pattern()}) : model();
            case 2: {
                const bool flips = below(2) == 0;
                return scene_.add(BumpMap{model(), bitmap(false), float(number(0.05, 0.2)), flips, below(2) == 0});
            }
            case 3: {
                const bool flips = below(2) == 0;
                return scene_.add(NormalMap{model(), bitmap(true), flips, below(2) == 0});
            }
            case 4: return scene_.add(BothSides{opaque(), opaque()});
            default: return model();
        }
    }

    /// A material under a coat: perhaps a blend, perhaps all under a map.
    std::size_t coated() {
        Coat coat{.eta = float(number(0.8, 1.8))};
        coat.specular_reflectance = color(0.5, 1);
        coat.sigma_a = color(0, 0.4);
        coat.thickness = float(number(0, 2));
        const bool is_rough = below(2) == 0;
        if (is_rough) {  // few of them, as each costs a table, and over no mirror
            coat.eta = 1.5f;
            coat.alpha = 0.4f;
            coat.distribution = facets();
        }
        const auto inner = [&] {
            if (!is_rough) return model();
            if (below(2) == 0) return add(Lambert{color(0.1, 0.9)}, "reflectance");
            return add(RoughConductor{facets(), 0.3f, 0.5f, color(0.1, 2), color(1, 4), color(0.5, 1)}, "alpha_u");
        };
        std::size_t below_coat = inner();
        if (below(3) == 0) below_coat = scene_.add(Blend{below_coat, inner(), pattern()});
        const std::size_t coating = scene_.add(Coating{below_coat, coat});
        return below(4) == 0 ? scene_.add(NormalMap{coating, bitmap(true)}) : coating;
    }

    int below(int n) { return static_cast<int>(random_.next() * static_cast<float>(n)); }
    double number(double low, double high) { return low + (high - low) * double(random_.next()); }
    Rgb color(double low, double high) {
        const double r = number(low, high), g = number(low, high);
        return Rgb(DVec3(r, g, number(low, high)));
    }

private:
    float fraction() { return float(number(0, 1)); }
    Facets facets() { return below(2) == 0 ? Facets::ggx : Facets::beckmann; }
    float alpha() { return float(number(0.2, 0.7)); }

    Texture pattern() {
        return Texture(Checkerboard{Rgb(fraction()), Rgb(fraction())}, {.u = {3, 0.5, 0}, .v = {-0.5, 4, 0.2}});
    }
    Texture bitmap(bool normals) {
        std::vector<float> texels;
        for (int i = 0; i < 64; ++i) {
            if (!normals) {
                texels.push_back(fraction());
            } else {
                // One after the other: compilers differ in the order of a call's arguments.
                const float y = fraction() - 0.5f, x = fraction() - 0.5f;
                const Vec3 n = normalize(Vec3(x, y, 0.6f)) * 0.5f + 0.5f;
                texels.insert(texels.end(), {n.x, n.y, n.z});
            }
        }
        return Texture(Bitmap(8, 8, texels, TexelEncoding::linear), {.u = {2, 0, 0}, .v = {0, 2, 0}});
    }

    template <class B>
    std::size_t add(const B& bsdf, const char* parameter) {
        if (below(2) == 0) return scene_.add(bsdf);
        return scene_.add(Textured<B>(bsdf).set(
            parameter, Texture(Checkerboard{Rgb(0.3f), color(0.3, 0.8)}, {.u = {4, 0, 0}, .v = {0, 4, 0}})));
    }
    std::size_t both_sides(std::size_t material) {
        if (below(2) == 0) scene_.materials[material].two_sided = true;
        return material;
    }

    std::size_t opaque() {
        switch (below(9)) {
            case 0: return add(Lambert{color(0.1, 0.9)}, "reflectance");
            case 1: {
                const float u = alpha(), v = alpha();
                return add(RoughConductor{facets(), u, v, color(0.1, 2), color(1, 4), color(0.5, 1)}, "alpha_u");
            }
            case 2:
                return add(Plastic{.eta = float(number(1.2, 1.8)),
                                   .diffuse_reflectance = color(0.2, 0.9),
                                   .nonlinear = below(2) == 0},
                           "diffuse_reflectance");
            case 3: {
                // Few, as each roughness costs a table.
                const float rough = below(2) == 0 ? 0.3f : 0.6f;
                return add(
                    RoughPlastic{.distribution = Facets::ggx, .alpha = rough, .diffuse_reflectance = color(0.2, 0.9)},
                    "diffuse_reflectance");
            }
            case 4: return add(disney(0), "base_color");
            case 5: return add(RoughDiffuse{.alpha = fraction(), .reflectance = color(0.2, 0.9)}, "reflectance");
            case 6:
                return add(ModifiedPhong{.exponent = float(number(2, 30)),
                                         .diffuse_reflectance = color(0.1, 0.5),
                                         .specular_reflectance = color(0.1, 0.2)},
                           "diffuse_reflectance");
            case 7: {
                const float u = alpha(), v = alpha();
                return add(Ward{.alpha_u = u,
                                .alpha_v = v,
                                .diffuse_reflectance = color(0.1, 0.5),
                                .specular_reflectance = color(0.1, 0.2)},
                           "diffuse_reflectance");
            }
            default: return add(Conductor{color(0.1, 2), color(1, 4), color(0.5, 1)}, "specular_reflectance");
        }
    }

    std::size_t model() {
        switch (below(9)) {
            case 0: return scene_.add(Dielectric{.eta = float(number(1.2, 1.8))});
            case 1: return scene_.add(ThinDielectric{.eta = float(number(1.2, 1.8))});
            case 2: {
                const float u = alpha(), v = alpha();
                return add(RoughDielectric{facets(), u, v, float(number(0.6, 1.8)), color(0.5, 1), color(0.5, 1)},
                           "specular_transmittance");
            }
            case 3: return add(disney(float(number(0.3, 1))), "base_color");
            case 4:
                return add(PrincipledThin{.base_color = color(0.2, 0.8),
                                          .roughness = float(number(0.4, 0.9)),
                                          .spec_trans = fraction(),
                                          .eta = float(number(1.2, 1.8)),
                                          .diff_trans = float(number(0, 2))},
                           "base_color");
            default: return both_sides(opaque());
        }
    }

    Principled disney(float transmission) {
        Principled result{.base_color = color(0.2, 0.8)};
        result.roughness = float(number(0.45, 0.9));
        result.anisotropic = fraction();
        result.metallic = fraction();
        result.spec_trans = transmission;
        result.eta = float(number(1.2, 1.8));
        result.clearcoat = fraction();
        result.sheen = fraction();
        return result;
    }

    LibraryDescription& scene_;
    Random& random_;
};

/// A floor and a few objects of such materials, one of them in two instances, one under a coat, below a sky and a lamp
/// with a texture, all so large that a path tracer finds them. 16 x 16 pixels.
inline LibraryDescription random_surfaces(std::uint32_t seed) {
    Random random(seed);
    LibraryDescription scene;
    scene.name = "surfaces-" + std::to_string(seed);
    RandomMaterials materials(scene, random);
    const auto number = [&](double low, double high) { return materials.number(low, high); };
    const auto place = [&](double size) {
        DMat4 m(1);
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) m[c][r] = size * ((c == r ? 1 : 0) + number(-0.4, 0.4));
        m[3] = glm::dvec4(number(-1.5, 1.5), number(-0.6, 0.8), number(-1.5, 1.5), 1);
        return m;
    };
    scene.add(quad({-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}), materials.any(false));
    const std::size_t of_ball = materials.any();
    scene.add(Sphere{{number(-1.5, 1.5), number(-0.6, 0.6), number(-1.5, 1.5)}, number(0.3, 0.8)}, of_ball);
    const std::size_t of_block = materials.any();
    scene.add(cube(place(0.5)), of_block);
    LibraryDescription::Group group;
    group.shapes.push_back(
        {.geometry = stock::torus_knot(60, 8, 0.2), .material = materials.any(), .emission = {}, .origin = {}});
    group.shapes.push_back(
        {.geometry = Sphere{{0, 0.8, 0}, 0.4}, .material = materials.any(), .emission = {}, .origin = {}});
    scene.groups.push_back(std::move(group));
    for (int i = 0; i < 2; ++i) scene.instances.push_back({.group = 0, .to_world = place(0.6), .origin = {}});

    scene.add(EnvironmentSource{materials.color(0.3, 1)});
    LibraryDescription::Shape lamp{
        .geometry = quad({-1.5, 2.5, -1.5}, {1.5, 2.5, -1.5}, {1.5, 2.2, 1.5}, {-1.5, 2.5, 1.5}),
        .material = scene.add(Lambert{materials.color(0, 0.8)}),
        .emission = materials.color(1, 5),
        .origin = {}};
    lamp.emission_texture = Texture(Checkerboard{Rgb(1), Rgb(0.2f, 0, 0.5f)});
    scene.shapes.push_back(std::move(lamp));

    const double angle = number(0, 6.28), distance = number(2.5, 4);
    scene.camera.to_world = CameraDescription::look_at(
        {distance * std::cos(angle), number(-0.2, 1.5), distance * std::sin(angle)}, {0, -0.2, 0}, {0, 1, 0});
    scene.camera.fov = number(35, 70);
    scene.film.width = scene.film.height = 16;

    const std::size_t under_coat = materials.coated();
    scene.add(Sphere{{number(-1, 1), number(-0.5, 0.5), number(-1, 1)}, number(0.3, 0.6)}, under_coat);
    return scene;
}

}  // namespace lightswitch::test
