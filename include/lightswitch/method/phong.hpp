#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/render/method.hpp>
#include <lightswitch/render/recording.hpp>
#include <lightswitch/scene/scene.hpp>

namespace lightswitch {

/// Local illumination after Phong ("Illumination for Computer Generated Pictures", CACM 1975): ambient, diffuse and
/// specular terms from the scene's own materials, with one shadow ray to one point of each light. No randomness but the
/// pixel filter.
///
/// Each luminous shape acts as a light at its centroid, with hard shadows; an environment only brightens everything.
struct Phong {
    static constexpr std::string_view name = "phong";
    static constexpr Kind kind = Kind::heuristic;

    float ambient =
        0.5f;  ///< ambient light, as a fraction of what the lights would give if spread over the whole scene

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const {
        const auto hit = scene.intersect(ray);
        if (!hit) {
            const Rgb found = scene.environment(ray.direction);
            tell(scene, Contributed{Finding::environment_met, 0, 2, 1, found});
            return found;
        }
        const Vec3 wo = -ray.direction;
        const PhongTerms terms = scene.with_bsdf(*hit, [](const auto& bsdf) {
            if constexpr (requires { bsdf.phong(); }) return bsdf.phong();
            else return PhongTerms{};
        });
        // Both sides of a surface are lit: a picture shows more than a hole.
        const Vec3 normal = dot(hit->shading_normal, wo) < 0 ? -hit->shading_normal : hit->shading_normal;
        Rgb sum = scene.emitted(*hit, wo);
        tell(scene, Contributed{Finding::light_met, 0, 2, 1, sum});
        for (const Emitter& emitter : scene.emitters()) {
            const Rgb everywhere = terms.diffuse * inv_pi * ambient_irradiance(emitter);
            tell(scene, Contributed{.how = Finding::ambient, .value = everywhere});
            sum += everywhere;
            if (emitter.kind == Emitter::Kind::environment) continue;
            const Arrival light = arrival(scene, emitter, *hit);
            const float cosine = dot(light.wi, normal);
            if (!(cosine > 0) || is_black(light.irradiance) || !visible(scene, emitter, light)) continue;
            const Vec3 mirrored = 2 * cosine * normal - light.wi;
            const float highlight = std::pow(std::max(dot(mirrored, wo), 0.0f), terms.shininess);
            const Rgb found = light.irradiance * inv_pi *
                              (terms.diffuse * cosine + terms.specular * (highlight * (terms.shininess + 2) / 2));
            tell(scene, Contributed{Finding::light_sampled, 1, 2, 1, found});
            sum += found;
        }
        return sum;
    }

private:
    struct Arrival {
        Vec3 wi;         // unit, towards the light
        Rgb irradiance;  // on a surface that faces the light
        Ray visibility;  // to the light; of a surface, to its centroid
    };

    static Arrival arrival(const auto& scene, const Emitter& emitter, const SurfacePoint& at) {
        if (emitter.kind == Emitter::Kind::directional)
            return {emitter.direction, emitter.strength, at.spawn(emitter.direction)};
        if (emitter.kind == Emitter::Kind::other) {
            const LightSample light = scene.with_light(scene.light_of_number(emitter.first_light),
                                                       [&](const auto& l) { return l.sample(at, Vec2(0.5f)); });
            return {light.wi, light.radiance, light.visibility};
        }
        const Vec3 to_light = emitter.position - at.position;
        const float distance2 = length_squared(to_light);
        if (!(distance2 > 0)) return {Vec3(0), Rgb(0), {}};
        const Vec3 wi = to_light / std::sqrt(distance2);
        const float facing = emitter.kind == Emitter::Kind::point ? 1.0f : projected_area(emitter, wi);
        return {wi, emitter.strength * (facing / distance2), at.segment_to(at.position + to_light)};
    }

    /// The area of an emitter as seen along `wi`: exact for flat ones, and a quarter of the surface for closed convex
    /// ones (Cauchy), whose vector area vanishes.
    static float projected_area(const Emitter& emitter, const Vec3& wi) {
        const bool closed = length_squared(emitter.vector_area) < square(0.1f * emitter.area);
        return closed ? emitter.area / 4 : std::max(-dot(emitter.vector_area, wi), 0.0f);
    }

    /// The light's flux spread evenly over a sphere of radius 1, which holds the scene: its order of magnitude is right
    /// for any scene, and no unit enters.
    Rgb ambient_irradiance(const Emitter& emitter) const {
        switch (emitter.kind) {
            case Emitter::Kind::environment: return pi * emitter.strength;
            case Emitter::Kind::directional: return ambient / 4 * emitter.strength;
            case Emitter::Kind::point: return ambient * emitter.strength;
            case Emitter::Kind::surface: return ambient / 4 * emitter.area * emitter.strength;
            default: return Rgb(0);  // nothing is known of its flux
        }
    }

    static bool visible(const auto& scene, const Emitter& emitter, const Arrival& light) {
        if (emitter.kind != Emitter::Kind::surface) return !scene.occluded(light.visibility);
        // The centroid of a curved light lies inside it: meeting the light itself is no shadow.
        const auto blocker = scene.intersect(light.visibility);
        return !blocker || (blocker->light && belongs(scene.light_number(blocker->light), emitter));
    }

    static bool belongs(std::size_t number, const Emitter& emitter) {
        return number >= emitter.first_light && number < emitter.first_light + emitter.light_count;
    }
};

}  // namespace lightswitch
