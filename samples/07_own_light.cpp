// A light of one's own: a struct that meets the concepts `LightSource` and `EmittingLight`, and a place in the scene's
// Lights<...>. Every method takes it, and `verify` says whether it is right.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/verify/verify.hpp>

#include <iostream>

namespace ls = lightswitch;

/// A spot light at a point: smooth from the full intensity, within the cosine `inner` of the axis, to nothing at
/// `outer`.
struct Spot {
    static constexpr bool infinite = false;

    ls::DVec3 at;       ///< in scene units
    ls::Vec3 axis;      ///< unit
    ls::Rgb intensity;  ///< W/sr
    float inner = 0.9f, outer = 0.8f;
    ls::Vec3 position{};  ///< in render space, of the light of a built scene

    /// As a source: what it is in render space.
    Spot light(const ls::RenderSpace& space, double) const {
        Spot built = *this;
        built.position = ls::Vec3(space.point(at));
        built.intensity *=
            float(space.scale() * space.scale());  // falls with the square of distances, which are scaled
        return built;
    }

    // As a light, for methods that look for it from surfaces.

    double power() const { return double(ls::luminance(intensity)) * 2 * double(ls::pi * (1 - outer)); }

    ls::LightSample sample(const ls::SurfacePoint& from, const ls::Vec2&) const {
        const ls::Vec3 to_light = position - from.position;
        const float distance2 = ls::length_squared(to_light);
        if (!(distance2 > 0)) return {};
        const ls::Vec3 wi = to_light / std::sqrt(distance2);
        return {.wi = wi,
                .radiance = intensity * falloff(-wi) / distance2,
                .pdf = {1},
                .dirac = true,
                .visibility = from.segment_to(position),
                .spread = distance2 / density()};
    }

    // For methods that start paths at lights.

    ls::LightEmission emit(const ls::Vec2&, const ls::Vec2& u) const {
        const ls::Vec3 direction = ls::Basis(axis).to_world(ls::uniform_cone(u, 1 - outer));
        return {.ray = {.origin = position, .direction = direction},
                .weight = intensity * (falloff(direction) / density()),
                .pdf = {density()},
                .dirac = true};
    }
    float spread(const ls::SurfacePoint& point, const ls::Vec3&, const ls::Vec3&) const {
        return ls::length_squared(position - point.position) / density();
    }

private:
    float density() const { return ls::uniform_cone_pdf(1 - outer).value; }
    float falloff(const ls::Vec3& direction) const {
        const float t = std::clamp((ls::dot(direction, axis) - outer) / (inner - outer), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    }
};

int main() try {
    ls::LibraryDescription room = ls::stock::describe_cornell_box();
    for (auto& shape : room.shapes) shape.emission.reset();
    room.add(Spot{.at = {0, 0.9, 0}, .axis = {0, -1, 0}, .intensity = ls::Rgb(5)});
    room.film.width = room.film.height = 128;

    const auto scene = ls::build_scene<ls::DiffuseBsdfs, ls::Lights<Spot>>(room);
    ls::save("own-light.png", ls::render(scene, ls::Bdpt{}, {.samples = 64}));
    // If the spot were sampled otherwise from one end than from the other, the two methods would differ.
    const ls::Verdict verdict =
        ls::verify(scene, ls::LightTracer{}, ls::PathTracerNee{}, {.seconds = 10, .tolerance = 0.05});
    std::cout << verdict;
    return verdict.disagrees() ? 1 : 0;
} catch (const ls::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
