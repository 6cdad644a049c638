// A surface model of one's own, in a scene type that holds it and Lambert's and nothing else: the library's files stay
// as they are, and no code is compiled for materials that the scene does not have.

#include <lightswitch/lightswitch.hpp>

#include <cstdio>

namespace ls = lightswitch;

/// A deep layer of dust in which light scatters once (the law of Lommel and Seeliger; Hapke, "Theory of Reflectance and
/// Emittance Spectroscopy", chapter 8). The full moon looks so: a flat disk, as bright at its limb as in the middle.
/// Reciprocal; it reflects at most half of `albedo`.
struct Dust {
    static constexpr bool specular = false;

    ls::Rgb albedo{0.5f};  ///< of one grain, each component 0 to 1

    ls::BsdfValue evaluate(const ls::Vec3& wo, const ls::Vec3& wi, ls::Transport) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        return {albedo * (0.25f * ls::inv_pi / (wo.z + wi.z)), pdf};
    }

    // Directions are uniform over the hemisphere, so that no sample weighs more than half the albedo.
    ls::Maybe<ls::BsdfSample> sample(const ls::Vec3& wo, const ls::Vec3& u, ls::Transport transport) const {
        if (!(wo.z > 0)) return {};
        ls::Vec3 wi = ls::uniform_sphere(ls::Vec2(u));
        wi.z = std::abs(wi.z);
        return ls::BsdfSample{.wi = wi, .weight = evaluate(wo, wi, transport).value * (wi.z / pdf.value), .pdf = pdf};
    }

    std::string problem() const { return ls::reflectance_problem("albedo", albedo); }

private:
    static constexpr ls::SolidAnglePdf pdf{0.5f * ls::inv_pi};
};

int main() try {
    // Two spheres, as bright as each other in the middle, lit from behind the camera: Lambert's on the left.
    ls::LibraryDescription moons;
    moons.name = "moons";
    const auto plaster = moons.add(ls::Lambert{ls::Rgb(0.12f)}), dust = moons.add(Dust{ls::Rgb(0.96f)});
    const auto black = moons.add(ls::Lambert{ls::Rgb(0)});
    moons.add(ls::Sphere{{-1.1, 0, 0}}, plaster);
    moons.add(ls::Sphere{{1.1, 0, 0}}, dust);
    moons.add(ls::quad({-1, 1, 20}, {1, 1, 20}, {1, -1, 20}, {-1, -1, 20}), black, ls::Rgb(1200));
    moons.camera.to_world = ls::CameraDescription::look_at({0, 0, 12}, {0, 0, 0}, {0, 1, 0});
    moons.camera.fov = 24;
    moons.film.width = 512;
    moons.film.height = 288;

    const auto scene = ls::build_scene<ls::Bsdfs<ls::Lambert, Dust>, ls::Lights<ls::TriangleLight>>(moons);
    ls::save("moons.png", ls::render(scene, ls::PathTracerNee{}, {.samples = 64}));
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
