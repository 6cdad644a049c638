#pragma once

// How bright the rarest event of a render can be: what has not been seen yet may be as bright.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/sampler.hpp>
#include <lightswitch/scene/scene.hpp>

namespace lightswitch {

namespace detail {

/// The radiance of the brightest place that a point or directional light makes: next to the lamp, or in the highlight
/// of a glossy surface; over the probability of choosing the light. Found by rays from the lights, which are as dense
/// as their light is: a place that is missed gets less than about a ten-thousandth of it.
Rgb brightest_under_dirac_lights(const auto& scene) {
    Rgb brightest(0);
    for (std::uint64_t i = 0; i < 65536; ++i) {
        RandomSequence random(mix64(i));
        const auto next = [&] { return to_unit_float(static_cast<std::uint32_t>(random.next() * 0x1p32)); };
        const float choice = next();
        const Vec2 place(next(), next()), direction(next(), next());
        const LightEmission emission = scene.sample_emission(choice, place, direction);
        if (!emission.dirac || is_black(emission.weight)) continue;
        const auto hit = scene.intersect(emission.ray);
        if (!hit) continue;
        const float spread = scene.spread(emission.light, *hit, hit->wo, emission.ray.origin);
        const Vec3 wi = hit->shading_frame().to_local(hit->wo);
        const Rgb peak = scene.with_bsdf(*hit, [&](const auto& bsdf) {
            const Rgb highlight = bsdf.evaluate(Vec3(-wi.x, -wi.y, wi.z), wi, Transport::radiance).value;
            const Rgb above = bsdf.evaluate(Vec3(0, 0, wi.z < 0 ? -1 : 1), wi, Transport::radiance).value;
            return glm::max(highlight, above) * std::abs(wi.z);
        });
        if (spread > 0) brightest = glm::max(brightest, emission.weight * peak / spread);
    }
    return brightest;
}

}  // namespace detail

/// The largest radiance per channel that one sample can find by chance on the way: that of the brightest lamp that rays
/// can meet, or of the brightest place under one that they cannot. Black when the lights cannot tell (`EmittingLight`).
template <class BsdfList, class... L, class CameraList>
Rgb brightest_event(const Scene<BsdfList, Lights<L...>, CameraList>& scene) {
    Rgb brightest(0);
    bool dirac = false;
    for (const Emitter& emitter : scene.emitters()) {
        if (emitter.dirac()) {
            dirac = true;
            continue;
        }
        brightest =
            glm::max(brightest, scene.with_light(scene.light_of_number(emitter.first_light), [&](const auto& light) {
                if constexpr (requires { light.brightest(); }) return light.brightest();
                else return emitter.strength;
            }));
    }
    if constexpr ((EmittingLight<L> && ...))
        if (dirac) brightest = glm::max(brightest, detail::brightest_under_dirac_lights(scene));
    return brightest;
}

}  // namespace lightswitch
