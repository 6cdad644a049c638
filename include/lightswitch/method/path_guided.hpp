#pragma once

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/ray_count.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/method/guiding_field.hpp>
#include <lightswitch/method/guiding_path.hpp>
#include <lightswitch/method/guiding_trial.hpp>
#include <lightswitch/method/path_records.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/method/sampled_light.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// Path tracing with next event estimation that learns where light comes from (Müller, Gross and Novák, "Practical
/// Path Guiding for Efficient Light-Transport Simulation", 2017): directions are chosen by a mixture of the BSDF and of
/// what was learnt at the place (`GuidingField`), and weighed against light sampling by the density of the mixture.
/// Dirac lobes are left to the BSDF.
///
/// It learns from paths of its own, which add nothing to the image: every iteration is unbiased whatever they taught.
/// How many there have been before an iteration, and what they were, follows from its number alone, so that iterations
/// can be made in any order and parts. Some of them are pairs with and without the guide, which tell whether it pays
/// (`GuidingTrial`); where it does not, images are those of `PathTracerNee`, and learning goes on at a slower pace.
///
/// `Mixture` is a `GuidingMixture`, or one with a mistake for tests.
template <class Mixture = GuidingMixture>
struct BasicPathGuided {
    static constexpr std::string_view name = "path-guided";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr Dependence dependence = Dependence::iteration;
    static constexpr PathClasses cannot_make{.dirac_caustic = true, .mirrored_dirac_caustic = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;
    float first_training = 2;   ///< paths to learn from before the first iteration, over the number of pixels
    float training = 0.25f;     ///< and for each iteration, at most; a sixteenth of it where guiding does not pay
    bool always_guide = false;  ///< even where it does not pay

    /// A path to learn from, as its pixel sees it.
    struct Sample {
        double luminance = 0;
        std::uint64_t rays = 0;
    };

    class State {
    public:
        std::vector<std::pair<std::string, double>> statistics() const {
            return {{"training_paths", double(passed)},        {"guided", double(guides)},
                    {"guiding_regions", double(field.size())}, {"guiding_nodes", double(field.nodes())},
                    {"guiding_bytes", double(field.bytes())},  {"guided_share", guides ? field.guided_share() : 0}};
        }

    private:
        friend BasicPathGuided;
        GuidingField field;
        GuidingTrial trial;
        bool decided = false, pays = false;               // by the trial
        bool guides = false;                              // the last iteration
        std::uint64_t key = 0;                            // of the random numbers
        std::uint64_t passed = 0, trained = 0, size = 0;  // paths: before the pass at hand, in it, and at its end
        std::uint64_t iterations = 0;                     // that have added to
        double due = 0;                                   // the paths that may have been made
        PathRecords<GuidingRecord, paths_per_unit> paths;
        std::vector<GuidingRecord> records;
        std::vector<Sample> samples;
    };

    State start(auto& frame) const {
        State state;
        frame.paths(1, [&](std::uint64_t, auto& sampler, auto&) {
            const Vec2 a = sampler.next_2d(), b = sampler.next_2d();
            const auto bits = [](float u) { return static_cast<std::uint64_t>(u * 0x1p24f); };
            state.key = bits(a.x) | bits(a.y) << 24 | bits(b.x) << 48;
        });
        return state;
    }

    void iterate(auto& frame, State& state) const {
        if (max_depth == 0) return;
        if (max_depth != 1) frame.uncounted([&] { learn(frame, state); });
        if (frame.stopped()) return;
        state.guides = state.field.learnt() && (state.pays || always_guide);
        const GuidingField* field = state.guides ? &state.field : nullptr;
        frame.pixels([&](const Ray& ray, auto& sampler) { return trace(frame.scene(), ray, sampler, field, nullptr); });
    }

private:
    static constexpr std::uint64_t most_training = std::uint64_t{1} << 26, largest_pass = std::uint64_t{1} << 22;
    static constexpr std::uint64_t chunk = std::uint64_t{1} << 16;  // bounds the memory of records
    static constexpr std::uint64_t trial = 4;                       // one of so many pairs is made without the guide

    /// Makes the passes that belong before this iteration: each has twice the paths of the one before. Where it is
    /// broken off, the next call goes on.
    void learn(auto& frame, State& state) const {
        if (state.size == 0 || frame.iteration() < state.iterations) {
            const std::uint64_t key = state.key;
            state = {};
            state.key = key;
            state.size = std::max<std::uint64_t>(frame.area() / 16, 256);
            state.due = double(first_training) * double(frame.area());
        }
        for (;; ++state.iterations) {
            while (double(state.passed + state.size) <= state.due && state.passed + state.size <= most_training) {
                if (!make_pass(frame, state)) return;
                state.passed += state.size;
                state.trained = 0;
                state.size = std::min(2 * state.size, largest_pass);
            }
            if (state.iterations == frame.iteration()) return;
            const bool useless = state.decided && !state.pays && !always_guide;
            state.due += double(training) * (useless ? 1.0 / 16 : 1) * double(frame.area());
        }
    }

    /// False when it is broken off.
    bool make_pass(auto& frame, State& state) const {
        while (state.trained < state.size) {
            const std::uint64_t count = std::min(chunk, state.size - state.trained);
            const std::uint64_t first = state.passed + state.trained;
            make_paths(frame, state, first, count);
            if (frame.stopped()) return false;
            state.paths.list(state.records, frame.executor(), [](const GuidingRecord& record) { return record; });
            state.field.add(state.records, frame.executor());
            if (state.field.learnt())
                for (std::size_t i = 0; i + 1 < count; i += 2) {
                    const Sample &a = state.samples[i], &b = state.samples[i + 1];
                    const std::uint64_t pair = (first + i) / 2;
                    state.trial.add(pair % trial != 0, a.luminance - b.luminance, a.rays + b.rays);
                }
            state.trained += count;
        }
        if (const auto pays = state.trial.pays(state.pays)) {
            state.pays = *pays;
            state.decided = true;
        }
        state.trial.age();
        state.field.learn(frame.executor());
        return true;
    }

    void make_paths(auto& frame, State& state, std::uint64_t first, std::uint64_t count) const {
        const auto& scene = frame.scene();
        const GuidingField& field = state.field;
        const IterationPoints points(Sampling::independent, state.key, 0);
        state.paths.reset(count);
        state.samples.resize(static_cast<std::size_t>(count));
        frame.paths(count, [&](std::uint64_t index, auto&, auto&) {
            const std::uint64_t number = first + index, pair = number / 2;
            Sampler on_film(points, detail::pixel_stream, pair), sampler(points, detail::path_stream, number);
            const Vec2 at = on_film.next_2d() * Vec2(frame.width(), frame.height());
            const Ray ray = detail::pixel_ray(scene.camera(), scene.film().filter, static_cast<int>(at.x),
                                              static_cast<int>(at.y), sampler)
                                .ray;
            const bool guided = !field.learnt() || pair % trial != 0;
            const RayCount before = ray_count;
            GuidingPath path;
            const Rgb value = trace(scene, ray, sampler, guided ? &field : nullptr, guided ? &path : nullptr);
            Sample& sample = state.samples[static_cast<std::size_t>(index)];
            sample.luminance = is_finite(value) ? double(luminance(value)) : 0;
            sample.rays = ray_count.intersect + ray_count.occluded - before.intersect - before.occluded;
            state.paths.start(index);
            path.finish([&](const GuidingRecord& record) { state.paths.push(index, record); });
        });
    }

    /// The radiance that arrives along the ray, by paths that `field` guides, if it is given, and that tell `path`, if
    /// it is given, what they find.
    [[gnu::noinline]] Rgb trace(const auto& scene, Ray ray, auto& sampler, const GuidingField* field,
                                GuidingPath* path) const {
        Rgb sum(0), throughput(1);
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
                if (path) path->arrive(radiance * weight);
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
                    if (path) path->arrive(radiance * weight);
                }
            }
            if (depth == max_depth) break;

            const Basis basis = hit->shading_frame();
            const Vec3 local_wo = basis.to_local(wo);
            // One number chooses the light, and between guide and BSDF, and the lobe: see `PathTracerNee`.
            const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d(), on_light = sampler.next_2d();
            const bool specular = scene.with_bsdf(*hit, [](const auto& bsdf) { return bsdf.specular; });
            Mixture mixture;
            if (field) {
                const std::uint32_t region = field->find(hit->position, local_wo.z < 0 ? -basis.normal : basis.normal);
                if (!specular) mixture = Mixture{field->mixture(region)};
                if (path) path->visit(region, throughput);
            }
            const bool guided = mixture.chooses_guide(choices.x);
            Vec3 wi(0);
            if (guided) wi = mixture.sample(direction);
            LightSample light;
            if (!specular) light = scene.sample_light(*hit, choices.x, on_light);
            const Vec3 local_light = basis.to_local(light.wi);
            BsdfValue scattering;
            auto scattered = scene.with_bsdf(
                *hit, [&](const auto& bsdf) __attribute__((always_inline))->Maybe<BsdfSample> {
                    if constexpr (!std::remove_cvref_t<decltype(bsdf)>::specular) {
                        scattering = bsdf.evaluate(local_wo, local_light, Transport::radiance);
                        if (guided) {
                            const Vec3 local_wi = basis.to_local(wi);
                            const BsdfValue v = bsdf.evaluate(local_wo, local_wi, Transport::radiance);
                            if (is_black(v.value)) return {};
                            return BsdfSample{.wi = local_wi, .weight = v.value * std::abs(local_wi.z), .pdf = v.pdf};
                        }
                    }
                    return bsdf.sample(local_wo, Vec3(direction, mixture.rest(choices.x)), Transport::radiance);
                });
            if (is_positive(light.pdf) && !is_black(scattering.value) && !scene.occluded(light.visibility)) {
                float weight = 1;
                if (!light.dirac) {
                    SolidAnglePdf pdf = scattering.pdf;
                    if (mixture.bsdf_share < 1) pdf = mixture.density(pdf, mixture.guide(light.wi));
                    weight = power_heuristic(light.pdf, pdf);
                }
                const float factor = std::abs(local_light.z) / light.pdf * weight;
                const Rgb found = throughput * scattering.value * light.radiance * factor;
                tell(scene, Contributed{Finding::light_sampled, 1, depth + 1, weight, found});
                sum += found;
                if (path) path->direct(scattering.value * light.radiance * factor);
            }
            if (!scattered) break;
            if (!guided) wi = basis.to_world(scattered->wi);
            const SolidAnglePdf bsdf_pdf = scattered->pdf;
            const bool mixed = mixture.bsdf_share < 1;
            const SolidAnglePdf guide_pdf =
                !scattered->specular && (mixed || path) ? mixture.guide(wi) : SolidAnglePdf{};
            Rgb reflectance = scattered->weight;  // what the weight would be without the guide
            if (guided) reflectance = scattered->weight / bsdf_pdf;
            if (mixed && scattered->specular) {
                scattered->weight /= mixture.bsdf_share;
            } else if (mixed) {
                scattered->pdf = mixture.density(bsdf_pdf, guide_pdf);
                scattered->weight = guided ? scattered->weight / scattered->pdf
                                           : scattered->weight / static_cast<float>(scattered->pdf / bsdf_pdf);
            }
            throughput *= scattered->weight;
            eta *= scattered->eta;
            if (path) path->leave(wi, *scattered, bsdf_pdf, guide_pdf);
            // Where the guide leads to light the throughput is small and worth much: there each bounce survives by what
            // its own surface reflects.
            const float survival = is_black(throughput) ? 0
                                   : depth <= rr_depth  ? 1
                                   : field ? survival_probability(max_component(reflectance), scattered->eta)
                                           : survival_probability(max_component(throughput), eta);
            const bool survived = !(choices.y >= survival);
            if constexpr (records<decltype(scene)>)
                scene.tell(Scattered{wi, scattered->pdf, scattered->specular, throughput, survival, survived});
            if (!survived) break;
            throughput /= survival;
            if (path) path->survive(survival);
            sampled.leave(*hit, scattered->pdf, !scattered->specular);
            ray = hit->spawn(wi);
        }
        return sum;
    }
};

/// The method by its usual name.
using PathGuided = BasicPathGuided<>;

}  // namespace lightswitch
