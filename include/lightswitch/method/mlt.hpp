#pragma once

#include <lightswitch/method/brightness_guide.hpp>
#include <lightswitch/method/connection.hpp>
#include <lightswitch/method/depth_choice.hpp>
#include <lightswitch/method/primary_space.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

#include <limits>
#include <string>
#include <utility>

namespace lightswitch {

/// Metropolis light transport in primary sample space (Kelemen et al. 2002), multiplexed (Hachisuka, Kaplanyan,
/// Dachsbacher, "Multiplexed Metropolis Light Transport", 2014): Markov chains walk through the random numbers of a
/// bidirectional path tracer and stay where the image gets its light from. A state holds one path of one length, made
/// by one strategy (s, t), which is a coordinate like any other. Lights that are seen directly are left to a ray per
/// pixel.
///
/// An iteration is about one mutation per pixel. Chains start from independent paths chosen in proportion to what they
/// carry, so no step has to be thrown away (Veach 1997, section 11.3.1), and the image's brightness is the mean over
/// those paths and all large steps before the iteration. With `refine` false it is the mean over the first ones alone:
/// then every iteration is unbiased, whereas refining adds a bias of about the relative variance of that mean, which
/// fades as chains forget where they began.
struct Mlt {
    static constexpr std::string_view name = "mlt";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr PathClasses cannot_make{.mirrored_dirac_caustic = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`; there is no roulette
    int chains = 1024;                       ///< fewer for images of fewer than 16 pixels per chain
    int bootstrap = 65536;                   ///< independent paths to start from
    float large_steps = 0.3f;                ///< probability of a mutation that forgets the state, in (0, 1]
    bool refine = true;                      ///< see above

    /// A path and where the camera sees it.
    struct Sample {
        Vec2 pixel{0};
        Rgb value{0};       ///< over its density: its mean over primary sample space is the sum over the pixels
        double target = 0;  ///< what the chain's density is proportional to

        void keep(auto& archive) { archive(pixel.x, pixel.y, value.x, value.y, value.z, target); }
    };

    class State {
    public:
        std::vector<std::pair<std::string, double>> statistics() const {
            const double n = std::max(double(steps), 1.0);
            return {{"chains", double(chains.size())},
                    {"mutations", double(steps)},
                    {"acceptance_rate", double(accepted) / n},
                    {"large_step_rate", double(large) / n},
                    {"normalization", normalization()}};
        }

        /// What `start` does not find again (render/archive.hpp).
        void keep(auto& archive) { archive(chains, sum, drawn, steps, accepted, large); }

    private:
        friend Mlt;
        struct Chain {
            PrimarySample sample;
            int depth = 2;
            Sample current;
            std::uint64_t steps = 0, accepted = 0, large = 0;  // of the last iteration
            double large_sum = 0;                              // of the targets of its large steps

            void keep(auto& archive) { archive(sample, depth, current); }
        };
        double normalization() const { return drawn > 0 ? sum / double(drawn) : 0; }

        DepthChoice depths;
        BrightnessGuide guide;
        std::vector<Chain> chains, next;
        double sum = 0;  // of the targets of `drawn` independent paths
        std::uint64_t drawn = 0;
        std::uint64_t steps = 0, accepted = 0, large = 0;
    };

    State start(auto& frame) const {
        State state;
        if (max_depth == 0 || max_depth == 1) return state;
        // The first paths tell which lengths matter and where the image is bright; they are not used for anything else.
        state.depths = DepthChoice(max_depth);
        state.guide = BrightnessGuide(frame.width(), frame.height());
        std::vector<double> power;
        const auto pilot = draw(frame, state, std::max(bootstrap / 2, 1));
        for (const Seed& seed : pilot) {
            const auto depth = static_cast<std::size_t>(seed.depth);
            if (depth >= power.size()) power.resize(depth + 1);
            power[depth] += seed.target;
        }
        state.depths.learn(power);
        state.guide.learn(pilot);

        const auto seeds = draw(frame, state, std::max(bootstrap, 1));
        for (const Seed& seed : seeds) state.sum += seed.target;
        state.drawn = seeds.size();
        if (frame.stopped() || !(state.sum > 0)) return state;
        state.chains.resize(
            std::clamp<std::size_t>(frame.area() / 16, 1, static_cast<std::size_t>(std::max(chains, 1))));
        // Evenly through the sum, from a random begin.
        const double step = state.sum / double(state.chains.size());
        double next = step * RandomSequence(~seeds[0].seed).next(), sum = 0;
        std::size_t filled = 0;
        for (const Seed& seed : seeds) {
            sum += seed.target;
            for (; filled < state.chains.size() && next < sum; next += step, ++filled) {
                auto& chain = state.chains[filled];
                chain = {.sample = PrimarySample(seed.seed), .depth = seed.depth, .current = {}};
                chain.current = evaluate(frame, chain.sample, state, chain.depth, nullptr);
                // Chains that begin alike must not go on alike.
                chain.sample.random() = RandomSequence(detail::mix64(seed.seed + filled));
            }
        }
        state.chains.resize(filled);
        return state;
    }

    void iterate(auto& frame, State& state) const {
        if (max_depth == 0) return;
        see_lights(frame);
        if (state.chains.empty()) return;
        const std::size_t n = state.chains.size();
        const std::uint64_t mutations = (frame.area() + n - 1) / n;
        // Splats add up to the image's sum over pixels: each step's share of it.
        const double share = state.normalization() / (double(mutations) * double(n));
        state.next.resize(n);
        frame.paths(
            n,
            [&](std::uint64_t index, auto&, auto& splatter) {
                auto& chain = state.next[index] = state.chains[index];
                chain.steps = chain.accepted = chain.large = 0;
                chain.large_sum = 0;
                walk(frame, state, chain, mutations, share, splatter);
            },
            1);
        if (frame.stopped()) return;
        state.chains.swap(state.next);
        for (const auto& chain : state.chains) {
            state.steps += chain.steps;
            state.accepted += chain.accepted;
            state.large += chain.large;
            if (!refine) continue;
            state.sum += chain.large_sum;
            state.drawn += chain.large;
        }
    }

private:
    enum Stream : std::size_t { strategy_stream, camera_stream, light_stream };

    /// A path that a chain could start from: made of its seed and length.
    struct Seed {
        std::uint64_t seed = 0;
        int depth = 2;
        Vec2 pixel{0};
        double target = 0;
    };

    std::vector<Seed> draw(auto& frame, const State& state, int n) const {
        std::vector<Seed> seeds(static_cast<std::size_t>(n));
        frame.paths(seeds.size(), [&](std::uint64_t index, auto& sampler, auto& splatter) {
            const Vec2 a = sampler.next_2d(), b = sampler.next_2d();
            const auto bits = [](float u) { return static_cast<std::uint64_t>(u * 0x1p24f); };
            Seed& seed = seeds[index];
            seed.seed = bits(a.x) | bits(a.y) << 24 | bits(b.x) << 48;
            seed.depth = state.depths.sample(double(b.y) + double(a.x) * 0x1p-24);
            PrimarySample sample(seed.seed);
            const Sample found = evaluate(frame, sample, state, seed.depth, &splatter);
            seed.pixel = found.pixel;
            seed.target = found.target;
        });
        return seeds;
    }

    void walk(const auto& frame, const State& state, auto& chain, std::uint64_t mutations, double share,
              auto& splatter) const {
        const auto splat = [&](const Sample& sample, double weight) {
            if (weight > 0 && sample.target > 0)
                splatter.splat(sample.pixel, sample.value * static_cast<float>(weight * share / sample.target));
        };
        double stayed = 0;  // the weight that the current state has gathered
        for (std::uint64_t i = 0; i < mutations; ++i) {
            const bool large = chain.sample.random().next() < double(large_steps);
            chain.sample.propose(large);
            const int depth = large ? state.depths.sample(chain.sample.random().next()) : chain.depth;
            const Sample proposed = evaluate(frame, chain.sample, state, depth, &splatter);
            const double acceptance =
                chain.current.target > 0 ? std::min(1.0, proposed.target / chain.current.target) : 1;
            ++chain.steps;
            if (large) {
                ++chain.large;
                chain.large_sum += proposed.target;
            }
            // Both states count, by how likely each is taken: less noise than counting the one that is.
            stayed += 1 - acceptance;
            if (chain.sample.random().next() < acceptance) {
                splat(chain.current, stayed);
                chain.sample.accept();
                chain.current = proposed;
                chain.depth = depth;
                stayed = acceptance;
                ++chain.accepted;
            } else {
                splat(proposed, acceptance);
                chain.sample.reject();
            }
        }
        splat(chain.current, stayed);
    }

    /// The path of `depth` segments that the random numbers describe. What is not finite is told to `splatter` and
    /// counts as black.
    Sample evaluate(const auto& frame, PrimarySample& sample, const State& state, int depth, Splatter* splatter) const {
        const auto& scene = frame.scene();
        const auto& camera = connectable_camera(scene.camera());
        PrimarySample::Reader control(sample, strategy_stream), on_camera(sample, camera_stream),
            on_light(sample, light_stream);
        const int strategies = depth + 1,
                  s = std::min(static_cast<int>(control.next_1d() * static_cast<float>(strategies)), depth);
        const int t = strategies - s;
        // A filter that is wider than a pixel also sees what is just outside of the film.
        const float margin = std::max(scene.film().filter.radius() - 0.5f, 0.0f);
        const Vec2 size = Vec2(frame.width(), frame.height()) + 2 * margin;
        const double area = double(size.x) * double(size.y);
        const Vec2 on_film = on_camera.next_2d();
        const Vec2 on_lens = camera.has_lens() ? on_camera.next_2d() : Vec2(0.5f);

        Sample result{.pixel = on_film * size - margin};
        CameraSubpath<point_of<decltype(scene)>> z(t > 1 ? camera.ray(result.pixel, on_lens) : Ray(), area, {});
        bool escaped = false;
        for (int edges = 1; edges < t; ++edges) {
            escaped = !z.advance(scene);
            if (escaped && !(s == 0 && edges == t - 1)) return {};
            if (edges < t - 1 && !scatter(scene, z, on_camera)) return {};
        }
        Connection found;
        if (s == 0) {
            static_cast<Contribution&>(found) = escaped ? meet_environment(scene, z) : meet_light(scene, z);
        } else if (t > 1 && !connectable(scene, z.vertex().point)) {
            return {};
        } else if (s == 1) {
            const float choice = on_light.next_1d();
            found = connect_to_light(scene, z.vertex(), Arrival(z.vertex().point), choice, on_light.next_2d(), {});
        } else {
            LightSubpath<point_of<decltype(scene)>> y(scene, on_light, {});
            if (is_black(y.carried())) return {};
            for (int edges = 1; edges < s; ++edges) {
                if (!y.advance(scene)) return {};
                if (edges < s - 1 && !scatter(scene, y, on_light)) return {};
            }
            if (!connectable(scene, y.vertex().point)) return {};
            if (t > 1) {
                found = connect(scene, y.vertex(), z.vertex(), Arrival(z.vertex().point), {});
            } else {
                const auto view = camera.view(y.vertex().point, on_lens);
                if (!view) return {};
                result.pixel = view->pixel;
                const Vec2 inside = view->pixel + margin;
                if (!(inside.x >= 0 && inside.y >= 0 && inside.x < size.x && inside.y < size.y)) return {};
                found = connect_to_camera(scene, y.vertex(), *view, area, {});
            }
        }
        if (s > 0 && !visible(scene, found)) return {};
        result.value = found.value *
                       static_cast<float>(double(found.weight) * area * strategies / state.depths.probability(depth));
        if (!is_finite(result.value)) {
            if (splatter) splatter->splat(result.pixel, result.value);
            return {};
        }
        result.target = double(luminance(result.value)) / double(state.guide(result.pixel));
        return result;
    }

    /// One bounce without roulette.
    static bool scatter(const auto& scene, auto& path, auto& numbers) {
        const Vec2 direction = numbers.next_2d();
        return path.scatter(scene, direction, Vec2(numbers.next_1d(), 0), std::numeric_limits<int>::max());
    }
};

}  // namespace lightswitch
