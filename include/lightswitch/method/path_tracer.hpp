#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Path tracing as the rendering equation says it (Kajiya 1986): directions are sampled from the BSDF alone and light
/// counts where a path happens to meet it. Nothing can be forgotten or counted twice, which makes it the ground truth;
/// it cannot see point or directional lights, and small lights are noisy.
struct PathTracer {
    static constexpr std::string_view name = "path";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr PathClasses cannot_make{
        .dirac_light = true, .dirac_caustic = true, .mirrored_dirac_caustic = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;

    Rgb radiance(const auto& scene, Ray ray, auto& sampler) const {
        Rgb sum(0), throughput(1);
        if (max_depth == 0) return sum;
        float eta = 1;
        for (int depth = 1;; ++depth) {
            const auto hit = scene.intersect(ray);
            if (!hit) {
                const Rgb found = throughput * scene.environment(ray.direction);
                tell(scene, Contributed{Finding::environment_met, 0, depth + 1, 1, found});
                sum += found;
                break;
            }
            const Vec3 wo = -ray.direction;
            const Rgb found = throughput * scene.emitted(*hit, wo);
            tell(scene, Contributed{Finding::light_met, 0, depth + 1, 1, found});
            sum += found;
            if (depth == max_depth) break;

            const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d();
            const Basis basis = hit->shading_frame();
            const auto scattered = scene.with_bsdf(*hit, [&](const auto& bsdf) {
                return bsdf.sample(basis.to_local(wo), Vec3(direction, choices.x), Transport::radiance);
            });
            if (!scattered) break;
            throughput *= scattered->weight;
            eta *= scattered->eta;
            tell_bounce(scene, *scattered, basis.to_world(scattered->wi), throughput, eta, depth, rr_depth, choices.y);
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) break;
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
        return sum;
    }
};

}  // namespace lightswitch
