#pragma once

// Path tracing, with and without next event estimation, with one mistake.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/method/mlt.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch::test {

enum class PathMistake {
    none,
    roulette_not_compensated,
    roulette_compensated_twice,
    first_weight_forgotten,  ///< the throughput misses the weight of the first bounce
    indirect_light_clamped,  ///< against fireflies
    direction_reused,        ///< one pair of numbers for the directions of all bounces
};

/// `PathTracer` with a mistake.
struct PlantedPath {
    static constexpr std::string_view name = "planted-path";
    static constexpr Kind kind = Kind::unbiased;

    PathMistake mistake = PathMistake::none;
    int max_depth = PathLength{}.max_depth;
    int rr_depth = PathLength{}.rr_depth;

    Rgb radiance(const auto& scene, Ray ray, auto& sampler) const {
        Rgb sum(0), throughput(1);
        if (max_depth == 0) return sum;
        float eta = 1;
        Vec2 first_direction(0);
        for (int depth = 1;; ++depth) {
            const auto add = [&](const Rgb& radiance) {
                Rgb value = throughput * radiance;
                if (mistake == PathMistake::indirect_light_clamped && depth > 2) value = min(value, Rgb(2));
                sum += value;
            };
            const auto hit = scene.intersect(ray);
            if (!hit) {
                add(scene.environment(ray.direction));
                break;
            }
            const Vec3 wo = -ray.direction;
            add(scene.emitted(*hit, wo));
            if (depth == max_depth) break;

            Vec2 direction = sampler.next_2d();
            const Vec2 choices = sampler.next_2d();
            if (depth == 1) first_direction = direction;
            if (mistake == PathMistake::direction_reused) direction = first_direction;
            const Basis basis = hit->shading_frame();
            const auto scattered = scene.with_bsdf(*hit, [&](const auto& bsdf) {
                return bsdf.sample(basis.to_local(wo), Vec3(direction, choices.x), Transport::radiance);
            });
            if (!scattered) break;
            if (!(mistake == PathMistake::first_weight_forgotten && depth == 1)) throughput *= scattered->weight;
            eta *= scattered->eta;
            const Rgb before = throughput;
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) break;
            if (mistake == PathMistake::roulette_not_compensated) throughput = before;
            if (mistake == PathMistake::roulette_compensated_twice)
                throughput *= max_component(throughput) / max_component(before);
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
        return sum;
    }
};

enum class NeeMistake {
    none,
    cosine_missing,               ///< of the surface, at direct light
    geometric_cosine,             ///< at direct light, where the BSDF has that of the shading normal
    light_counted_twice,          ///< no multiple importance sampling: lights are sampled, and count when met as well
    sky_counted_twice,            ///< the same for the environment alone
    met_lights_ignored,           ///< although light sampling has only its share of the weight
    met_density_unselected,       ///< of a light that is met: without the probability of having selected it
    met_density_ten_percent_off,  ///< of a light that is met; the weights add up to more than 1
    bsdf_density_swapped,         ///< in the weight of light sampling: that of `wo` for `wi`
    emission_lost_after_mirror,   ///< light sampling is believed to have found it
    emission_lost_at_camera,
    shadow_ray_from_inside,  ///< the origin is moved off the surface to the wrong side
    shadow_ray_skips,        ///< occluders nearer than 0.05 scene units
    one_bounce_more,         ///< than `max_depth` allows
    light_point_reused,      ///< it is chosen by the pair that has led to this vertex
    light_too_strong,        ///< sampled light counts 0.2 % too much
    blue_too_strong,         ///< blue of sampled light counts 1 % too much
};

/// `PathTracerNee` with a mistake.
struct PlantedNee {
    static constexpr std::string_view name = "planted-nee";
    static constexpr Kind kind = Kind::unbiased;

    NeeMistake mistake = NeeMistake::none;
    int max_depth = PathLength{}.max_depth;
    int rr_depth = PathLength{}.rr_depth;

    Rgb radiance(const auto& scene, Ray ray, auto& sampler) const {
        const auto wrong = [this](NeeMistake m) { return mistake == m; };
        Rgb sum(0), throughput(1);
        if (max_depth == 0) return sum;
        const int last = max_depth < 0 ? -1 : max_depth + wrong(NeeMistake::one_bounce_more);
        float eta = 1;
        bool light_sampled = false;
        SolidAnglePdf pdf;
        Vec3 from(0), from_normal(0);
        Vec2 direction(0);
        for (int depth = 1;; ++depth) {
            const auto hit = scene.intersect(ray);
            if (!hit) {
                float weight =
                    light_sampled ? power_heuristic(pdf, scene.environment_pdf(from_normal, ray.direction)) : 1;
                if (wrong(NeeMistake::sky_counted_twice)) weight = 1;
                sum += throughput * scene.environment(ray.direction) * weight;
                break;
            }
            const Vec3 wo = -ray.direction;
            if (hit->light)
                sum += throughput * scene.emitted(*hit, wo) *
                       met_weight(scene, *hit, ray, depth, light_sampled, pdf, from, from_normal);
            if (depth == last) break;

            const Basis basis = hit->shading_frame();
            const Vec3 local_wo = basis.to_local(wo);
            const Vec2 earlier_direction = direction;
            direction = sampler.next_2d();
            const Vec2 choices = sampler.next_2d();
            Vec2 on_light = sampler.next_2d();
            if (wrong(NeeMistake::light_point_reused) && depth > 1) on_light = earlier_direction;

            const LightSample light = scene.sample_light(*hit, choices.x, on_light);
            const Vec3 local_wi = basis.to_local(light.wi);
            BsdfValue scattering;
            const auto scattered = scene.with_bsdf(*hit, [&](const auto& bsdf) {
                scattering = bsdf.evaluate(local_wo, local_wi, Transport::radiance);
                if (wrong(NeeMistake::bsdf_density_swapped))
                    scattering.pdf = bsdf.evaluate(local_wi, local_wo, Transport::radiance).pdf;
                return bsdf.sample(local_wo, Vec3(direction, choices.x), Transport::radiance);
            });
            if (light.pdf.value > 0 && !is_black(scattering.value) && !scene.occluded(shadow_ray(scene, *hit, light))) {
                float weight = light.dirac || wrong(NeeMistake::light_counted_twice)
                                   ? 1
                                   : power_heuristic(light.pdf, scattering.pdf);
                if (wrong(NeeMistake::light_too_strong)) weight *= 1.002f;
                float cosine = std::abs(local_wi.z);
                if (wrong(NeeMistake::cosine_missing)) cosine = 1;
                if (wrong(NeeMistake::geometric_cosine)) cosine = std::abs(dot(light.wi, hit->normal));
                const Rgb tint = wrong(NeeMistake::blue_too_strong) ? Rgb(1, 1, 1.01f) : Rgb(1);
                sum += throughput * scattering.value * light.radiance * tint * (cosine / light.pdf.value * weight);
            }
            if (!scattered) break;
            throughput *= scattered->weight;
            eta *= scattered->eta;
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) break;
            light_sampled = !scattered->specular || wrong(NeeMistake::emission_lost_after_mirror);
            pdf = scattered->pdf;
            from = hit->position;
            from_normal = hit->lit_normal();
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
        return sum;
    }

private:
    /// Of emission that a ray meets.
    float met_weight(const auto& scene, const SurfacePoint& hit, const Ray& ray, int depth, bool light_sampled,
                     SolidAnglePdf pdf, const Vec3& from, const Vec3& from_normal) const {
        if (mistake == NeeMistake::emission_lost_at_camera && depth == 1) return 0;
        if (!light_sampled || mistake == NeeMistake::light_counted_twice) return 1;
        if (mistake == NeeMistake::met_lights_ignored) return 0;
        SolidAnglePdf other = scene.light_pdf(from, from_normal, ray.direction, hit);
        if (mistake == NeeMistake::met_density_ten_percent_off) other.value *= 0.9f;
        if (mistake == NeeMistake::met_density_unselected)
            other = scene.with_light(hit.light, [&]<class L>(const L& light) {
                if constexpr (AreaLight<L>) return light.pdf(from, ray.direction, hit);
                else return SolidAnglePdf{};
            });
        return power_heuristic(pdf, other);
    }

    Ray shadow_ray(const auto& scene, const SurfacePoint& hit, const LightSample& light) const {
        Ray ray = light.visibility;
        if (mistake == NeeMistake::shadow_ray_skips)
            ray.near = scene.length(0.05) / std::sqrt(length_squared(ray.direction));
        if (mistake == NeeMistake::shadow_ray_from_inside) {
            const Vec3 end = ray.origin + ray.direction;
            ray.origin = hit.position_towards(-light.wi);
            if (ray.far == 1) ray.direction = end - ray.origin;
        }
        return ray;
    }
};

enum class ChainMistake {
    none,
    left_counted_twice,   ///< what chains carry is put where it was found as well
    every_step_accepted,  ///< whatever it finds: without the ratio
    energy_lost,          ///< of finds that carry less than a chain does, when one starts there
};

/// `Mlt` with a mistake, and with much more left to chains, so that it shows.
struct PlantedMlt {
    static constexpr std::string_view name = "planted-mlt";
    static constexpr Kind kind = Kind::unbiased;

    ChainMistake mistake = ChainMistake::none;
    int max_depth = PathLength{}.max_depth;

    struct Rules {
        ChainMistake mistake;

        double left(double light, double limit) const { return ChainRules::left(light, limit / 20); }
        double kept(double light, double limit) const {
            return mistake == ChainMistake::left_counted_twice ? 1 : ChainRules::kept(light, limit / 20);
        }
        double acceptance(double current, double proposed) const {
            if (mistake == ChainMistake::every_step_accepted) return 1;
            return ChainRules::acceptance(current, proposed);
        }
        ChainRules::Start start(double energy, double of_chain, double u) const {
            auto result = ChainRules::start(energy, of_chain, u);
            if (mistake == ChainMistake::energy_lost) result.energy = std::min(result.energy, energy);
            return result;
        }
    };

    auto start(auto& frame) const { return method().start_by(frame, Rules{mistake}); }
    void iterate(auto& frame, auto& state) const { method().iterate_by(frame, state, Rules{mistake}); }

private:
    Mlt method() const { return {.max_depth = max_depth, .bootstrap = 1024}; }
};

}  // namespace lightswitch::test
