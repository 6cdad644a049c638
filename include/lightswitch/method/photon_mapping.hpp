#pragma once

#include <lightswitch/method/hash_grid.hpp>
#include <lightswitch/method/merging.hpp>
#include <lightswitch/method/path_records.hpp>
#include <lightswitch/method/sampled_light.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Photon mapping (Jensen 1996), progressive (Knaus and Zwicker 2011): light paths leave photons where they meet
/// surfaces that are not specular; paths from the camera go on to the first such surface and gather the photons around
/// (and go on if it has a Dirac lobe, too). What comes straight from a light is not left to photons, which would blur
/// shadows: there it is sampled by light and by BSDF, as by `PathTracerNee`.
/// Every iteration has photons of its own and a smaller radius, so that the mean over the iterations converges to the
/// exact image.
struct PhotonMapping {
    static constexpr std::string_view name = "photon";
    static constexpr Kind kind = Kind::consistent;
    static constexpr Dependence dependence = Dependence::iteration;

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;
    double paths_per_pixel =
        0.5;  ///< light paths of an iteration, over the number of pixels; at least one path is traced
    MergeRadius radius = {.pixels = 4};
    bool final_gather = false;  ///< one more bounce before photons are gathered

    class State {
    public:
        /// Of the last iteration.
        std::vector<std::pair<std::string, double>> statistics() const {
            return {{"photons", double(map.size())},
                    {"photon_map_bytes", double(map.bytes())},
                    {"radius_pixels", double(map.radius()) / footprint}};
        }

    private:
        friend PhotonMapping;
        double footprint = 0;
        PathRecords<Photon, paths_per_unit> paths;
        std::vector<Photon> photons;
        HashGrid<Photon> map;
    };

    State start(auto& frame) const {
        State state;
        state.footprint = pixel_footprint(frame.scene());
        return state;
    }

    void iterate(auto& frame, State& state) const {
        if (max_depth == 0) return;
        const auto& scene = frame.scene();
        const double wanted = paths_per_pixel * double(frame.area());
        const auto light_paths = static_cast<std::uint64_t>(std::max(wanted, 1.0));
        state.paths.reset(light_paths);
        frame.paths(light_paths, [&](std::uint64_t path, auto& sampler, auto&) {
            state.paths.start(path);
            trace_light_subpath(scene, sampler, {{max_depth, rr_depth}}, {}, [&](const auto& y) {
                if (y.edges > 1) state.paths.push(path, photon_at(scene, y));
            });
        });
        if (frame.stopped()) return;
        state.paths.list(state.photons, frame.executor(), [](const Photon& photon) { return photon; });
        state.map.build(state.photons, radius.at(frame.iteration(), state.footprint), frame.executor());
        frame.pixels([&](const Ray& ray, auto& sampler) {
            return radiance(scene, ray, sampler, state.map, 1 / static_cast<float>(light_paths));
        });
    }

private:
    Rgb radiance(const auto& scene, Ray ray, auto& sampler, const HashGrid<Photon>& map, float share) const {
        Rgb sum(0), throughput(1);
        float eta = 1;
        bool gather = !final_gather, last = false;
        SampledLight sampled;
        for (int depth = 1;; ++depth) {
            const auto hit = scene.intersect(ray);
            if (!hit) {
                const float weight = sampled.weight_of_environment(scene, ray.direction);
                const Rgb found = throughput * scene.environment(ray.direction) * weight;
                tell(scene, Contributed{Finding::environment_met, 0, depth + 1, weight, found});
                return sum + found;
            }
            if (hit->light) {
                const float weight = sampled.weight(scene, *hit);
                const Rgb found = throughput * scene.emitted(*hit, hit->wo) * weight;
                tell(scene, Contributed{Finding::light_met, 0, depth + 1, weight, found});
                sum += found;
            }
            if (depth == max_depth || last) return sum;
            const bool diffuse = connectable(scene, *hit);
            const bool gathers = diffuse && gather;
            if (gathers) {
                const Rgb found = throughput * estimate(scene, *hit, depth, map) * share;
                tell(scene, Contributed{Finding::merged, 0, depth + 1, 1, found});
                sum += found;
            }

            const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d();
            const Basis basis = hit->shading_frame();
            if (diffuse) {
                float weight = 1;
                const Rgb found = throughput * direct_light(scene, *hit, choices.x, sampler.next_2d(), weight);
                tell(scene, Contributed{Finding::light_sampled, 1, depth + 1, weight, found});
                sum += found;
                gather = true;
            }
            const auto scattered = scene.with_bsdf(*hit, [&](const auto& bsdf) {
                return bsdf.sample(basis.to_local(hit->wo), Vec3(direction, choices.x), Transport::radiance);
            });
            if (!scattered) return sum;
            // After photons were gathered, lights are looked for, and what a Dirac lobe shows beside smooth ones.
            last = gathers && !scattered->specular;
            throughput *= scattered->weight;
            eta *= scattered->eta;
            tell_bounce(scene, *scattered, basis.to_world(scattered->wi), throughput, eta, depth, rr_depth, choices.y);
            if (!survives_roulette(throughput, eta, depth, rr_depth, choices.y)) return sum;
            sampled.leave(*hit, scattered->pdf, diffuse && !scattered->specular);
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
    }

    /// Radiance that the photons around `at` bring towards `at.wo`, times the number of light paths.
    Rgb estimate(const auto& scene, const auto& at, int depth, const HashGrid<Photon>& map) const {
        Rgb sum(0);
        const Arrival arrival(at);
        map.for_each_near(at.position, [&](const Photon& photon) {
            if (max_depth >= 0 && depth + photon.edges > max_depth) return;
            sum += photon_turn(scene, at, arrival, photon).value * photon.power;
        });
        return map.radius() > 0 ? sum * (1 / (pi * square(map.radius()))) : Rgb(0);
    }

    /// With its weight.
    Rgb direct_light(const auto& scene, const auto& at, float choice, const Vec2& place, float& weight) const {
        const LightSample light = scene.sample_light(at, choice, place);
        if (!is_positive(light.pdf)) return Rgb(0);
        const Turn towards = turn<Transport::radiance>(scene, at, Arrival(at), light.wi);
        if (is_black(towards.value) || scene.occluded(light.visibility)) return Rgb(0);
        weight = light.dirac ? 1 : power_heuristic(light.pdf, towards.pdf);
        return towards.value * light.radiance * (weight / light.pdf);
    }
};

}  // namespace lightswitch
