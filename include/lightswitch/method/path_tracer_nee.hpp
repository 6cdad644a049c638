#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/method/sampled_light.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Path tracing with next event estimation: at every vertex one point of one light is connected directly, and joined
/// with the directions that the BSDF samples by multiple importance sampling (Veach and Guibas 1995; power heuristic).
struct PathTracerNee {
    static constexpr std::string_view name = "path-nee";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr PathClasses cannot_make{.dirac_caustic = true, .mirrored_dirac_caustic = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;

    Rgb radiance(const auto& scene, Ray ray, auto& sampler) const {
        Rgb sum(0), throughput(1);
        if (max_depth == 0) return sum;
        float eta = 1;
        SampledLight sampled;
        for (int depth = 1;; ++depth) {
            const auto hit = scene.intersect(ray);
            if (!hit) {
                const Rgb radiance = scene.environment(ray.direction);
                const float weight = sampled.weight_of_environment(scene, ray.direction);
                const Rgb found = throughput * radiance * weight;
                tell(scene, Contributed{Finding::environment_met, 0, depth + 1, weight, found});
                sum += found;
                break;
            }
            const Vec3 wo = -ray.direction;
            if (hit->light) {
                const Rgb radiance = scene.emitted(*hit, wo);
                if (!is_black(radiance)) {
                    const float weight = sampled.weight(scene, *hit);
                    const Rgb found = throughput * radiance * weight;
                    tell(scene, Contributed{Finding::light_met, 0, depth + 1, weight, found});
                    sum += found;
                }
            }
            if (depth == max_depth) break;

            const Basis basis = hit->shading_frame();
            const Vec3 local_wo = basis.to_local(wo);
            // One number chooses the light and the lobe: they enter different terms of the sum, so nothing correlates.
            const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d(), on_light = sampler.next_2d();
            const bool specular = scene.with_bsdf(*hit, [](const auto& bsdf) { return bsdf.specular; });
            LightSample light;
            if (!specular) light = scene.sample_light(*hit, choices.x, on_light);
            const Vec3 local_wi = basis.to_local(light.wi);
            BsdfValue scattering;
            const auto scattered = scene.with_bsdf(
                *hit, [&](const auto& bsdf) __attribute__((always_inline)) {
                    if constexpr (!std::remove_cvref_t<decltype(bsdf)>::specular)
                        scattering = bsdf.evaluate(local_wo, local_wi, Transport::radiance);
                    return bsdf.sample(local_wo, Vec3(direction, choices.x), Transport::radiance);
                });
            // Traced after both directions are known: the processor works on the next ray meanwhile.
            if (is_positive(light.pdf) && !is_black(scattering.value) && !scene.occluded(light.visibility)) {
                const float weight = light.dirac ? 1 : power_heuristic(light.pdf, scattering.pdf);
                const Rgb found =
                    throughput * scattering.value * light.radiance * (std::abs(local_wi.z) / light.pdf * weight);
                tell(scene, Contributed{Finding::light_sampled, 1, depth + 1, weight, found});
                sum += found;
            }
            if (!scattered) break;
            throughput *= scattered->weight;
            eta *= scattered->eta;
            tell_bounce(scene, *scattered, basis.to_world(scattered->wi), throughput, eta, depth, rr_depth, choices.y);
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) break;
            sampled.leave(*hit, scattered->pdf, !scattered->specular);
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
        return sum;
    }
};

}  // namespace lightswitch
