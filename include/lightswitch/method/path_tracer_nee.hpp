#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Path tracing with next event estimation: at every vertex one point of one light is connected directly, and joined with the
/// directions that the BSDF samples by multiple importance sampling (Veach and Guibas 1995; power heuristic).
struct PathTracerNee {
    static constexpr std::string_view name = "path-nee";
    static constexpr Kind kind = Kind::unbiased;

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;

    Rgb radiance(const auto& scene, Ray ray, auto& sampler) const {
        Rgb sum(0), throughput(1);
        float eta = 1;
        // What light sampling at the vertex before could have found is met with this density, from there; weight 1 when it
        // could not: at the camera and after a specular bounce.
        bool light_sampled = false;
        SolidAnglePdf pdf;
        Vec3 from(0);
        for (int depth = 1;; ++depth) {
            const auto hit = scene.intersect(ray);
            if (!hit) {
                const Rgb radiance = scene.environment(ray.direction);
                const float weight =
                    light_sampled ? power_heuristic(pdf, scene.environment_pdf(ray.direction)) : 1;
                sum += throughput * radiance * weight;
                break;
            }
            const Vec3 wo = -ray.direction;
            if (hit->light) {
                const Rgb radiance = scene.emitted(*hit, wo);
                if (!is_black(radiance)) {
                    const float weight =
                        light_sampled ? power_heuristic(pdf, scene.light_pdf(from, ray.direction, *hit)) : 1;
                    sum += throughput * radiance * weight;
                }
            }
            if (depth == max_depth) break;

            const Basis basis = hit->shading_frame();
            const Vec3 local_wo = basis.to_local(wo);
            // One number chooses the light and the lobe: they enter different terms of the sum, so nothing correlates.
            const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d(), on_light = sampler.next_2d();
            Connection connection;
            const auto scattered = scene.with_bsdf(*hit, [&](const auto& bsdf) __attribute__((always_inline)) {
                if constexpr (!std::remove_cvref_t<decltype(bsdf)>::specular)
                    connection = connect(scene, *hit, basis, local_wo, bsdf, choices.x, on_light);
                return bsdf.sample(local_wo, Vec3(direction, choices.x), Transport::radiance);
            });
            if (!is_black(connection.contribution) && !scene.occluded(connection.visibility))
                sum += throughput * connection.contribution;
            if (!scattered) break;
            throughput *= scattered->weight;
            eta *= scattered->eta;
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) break;
            light_sampled = !scattered->specular;
            pdf = scattered->pdf;
            from = hit->position;
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
        return sum;
    }

private:
    struct Connection {
        Rgb contribution{0};  // if nothing is in between
        Ray visibility;
    };

    /// One sampled point of one light, weighted against meeting it by sampling the BSDF.
    [[gnu::always_inline]] static Connection connect(const auto& scene, const SurfacePoint& at, const Basis& basis,
                                                     const Vec3& local_wo, const auto& bsdf, float which_light,
                                                     const Vec2& on_light) {
        const LightSample light = scene.sample_light(at, which_light, on_light);
        if (!(light.pdf.value > 0)) return {};
        const Vec3 local_wi = basis.to_local(light.wi);
        const BsdfValue scattering = bsdf.evaluate(local_wo, local_wi, Transport::radiance);
        const float weight = light.dirac ? 1 : power_heuristic(light.pdf, scattering.pdf);
        return {.contribution = scattering.value * light.radiance * (std::abs(local_wi.z) / light.pdf.value * weight),
                .visibility = light.visibility};
    }
};

}  // namespace lightswitch
