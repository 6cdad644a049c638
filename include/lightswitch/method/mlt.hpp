#pragma once

#include <lightswitch/method/brightness_guide.hpp>
#include <lightswitch/method/connection.hpp>
#include <lightswitch/method/coverage.hpp>
#include <lightswitch/method/primary_path.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// What `Mlt` is right by.
struct ChainRules {
    /// The share of a contribution of luminance `light` that counts as bidirectional path tracing finds it; the rest of
    /// it is left to chains. A continuous function, so that what chains walk on has no edge.
    static double kept(double light, double limit) { return light > limit ? limit / light : 1; }
    static double left(double light, double limit) { return 1 - kept(light, limit); }

    /// Of a step (Metropolis et al. 1953).
    static double acceptance(double current, double proposed) {
        return current > 0 ? std::min(1.0, proposed / current) : 1;
    }

    /// How many chains start at a path, and what each carries: together, on the average over `u` in [0, 1), `energy`.
    struct Start {
        int chains = 0;
        double energy = 0;
    };
    static Start start(double energy, double of_chain, double u) {
        const double chains = energy / of_chain;
        if (chains < 1) return {u < chains, of_chain};
        const double whole = std::ceil(std::min(chains, double(most)));
        return {static_cast<int>(whole), energy / whole};
    }
    static constexpr int most = 32;  ///< chains at one path, so that none takes the rest of a render
};

/// Metropolis light transport in primary sample space (Kelemen et al. 2002) that leaves to bidirectional path tracing
/// what it does well, and redistributes the rest (Cline, Talbot and Egbert, "Energy Redistribution Path Tracing",
/// 2005).
///
/// An iteration makes the paths of `Bdpt`. Of a contribution that is much brighter than its part of the image, what
/// exceeds a limit is not put where it was found: Markov chains start there, which walk through the random numbers of
/// that strategy in proportion to what exceeds the limit, and spread it over where it could have been found. They start
/// at paths that are found in that proportion, so no step has to be thrown away (Veach 1997, section 11.3.1), and every
/// iteration is unbiased: nothing that is found is lost, however short the chains. Rare finds get long chains, frequent
/// ones short ones. Lights that are seen directly are left to a ray per pixel.
struct Mlt {
    static constexpr std::string_view name = "mlt";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr PathClasses cannot_make{.mirrored_dirac_caustic = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int bootstrap = 32768;                   ///< paths that tell beforehand how bright the image is, above 0
    float mutations = 0.5f;                  ///< at most, per pixel and iteration: fewer where little is left to chains
    bool refine = true;  ///< plan chains by all iterations before, not by the first paths alone; no bias either way

    class State {
    public:
        std::vector<std::pair<std::string, double>> statistics() const {
            return {{"chains", double(all.chains)},
                    {"mutations", double(all.mutations)},
                    {"acceptance_rate", all.accepted / std::max(double(all.mutations), 1.0)},
                    {"chain_length", double(plan.length)},
                    {"chain_energy", plan.energy},
                    {"chain_share", all.light > 0 ? all.left / all.light : 0},
                    {"coverage", all.covered()}};
        }

        /// What `start` does not find again (render/archive.hpp).
        void keep(auto& archive) { archive(all, plan); }

    private:
        friend Mlt;
        /// What paths found, and what chains did.
        struct Tally : Coverage {
            std::uint64_t paths = 0, chains = 0, mutations = 0;
            double accepted = 0;

            void operator+=(const Tally& other) {
                Coverage::operator+=(other);
                paths += other.paths;
                chains += other.chains;
                mutations += other.mutations;
                accepted += other.accepted;
            }
            void keep(auto& archive) {
                Coverage::keep(archive);
                archive(paths, chains, mutations, accepted);
            }
        };
        /// Of an iteration: the steps of each chain, and the light over the guide that it carries.
        struct Plan {
            int length = 1;
            double energy = 0;

            void keep(auto& archive) { archive(length, energy); }
        };

        BrightnessGuide guide;
        double mean = 0;  // luminance of the image
        Tally before, all;
        Plan plan;
    };

    State start(auto& frame) const { return start_by(frame, ChainRules()); }
    void iterate(auto& frame, State& state) const { iterate_by(frame, state, ChainRules()); }

    /// `start` and `iterate` by other rules than `ChainRules`.
    State start_by(auto& frame, const auto& rules) const {
        State state;
        if (max_depth == 0 || max_depth == 1) return state;
        state.guide = BrightnessGuide(frame.width(), frame.height());
        struct Bright {
            Vec2 pixel{0};
            double target = 0;
        };
        const std::size_t n = static_cast<std::size_t>(std::max(bootstrap / 2, 1)),
                          units = (n + per_unit - 1) / per_unit;
        std::vector<std::vector<Bright>> found(units);
        look(frame, n, [&](std::size_t unit, const FoundPath& f) { found[unit].push_back({f.pixel, f.light()}); });
        std::vector<Bright> all;
        double sum = 0;
        for (const auto& unit : found) all.insert(all.end(), unit.begin(), unit.end());
        for (const Bright& bright : all) sum += bright.target;
        state.guide.learn(all);
        state.mean = sum / double(n);

        // How much is left to chains is told by other paths than those that made the guide.
        std::vector<typename State::Tally> tallies(units);
        look(frame, n, [&](std::size_t unit, const FoundPath& f) {
            note(tallies[unit], frame, state, f, rules.left(f.light() * double(f.chance), limit(state, f)));
        });
        for (const auto& tally : tallies) state.before += tally;
        state.before.paths = n;
        return state;
    }

    void iterate_by(auto& frame, State& state, const auto& rules) const {
        if (max_depth == 0) return;
        see_lights(frame);
        if (!(state.mean > 0)) return;
        const std::uint64_t n = frame.area(), columns = static_cast<std::uint64_t>(frame.width());
        const auto plan = planned(state);
        std::vector<typename State::Tally> tallies((n + per_unit - 1) / per_unit);
        frame.paths(
            n,
            [&](std::uint64_t index, auto& sampler, auto& splatter) {
                auto& tally = tallies[index / per_unit];
                ++tally.paths;
                auto light_sampler = sampler.split();
                auto camera_begin = sampler;
                const auto light_begin = light_sampler;
                const Vec2 cell(static_cast<float>(index % columns), static_cast<float>(index / columns));
                const Vec2 within = sampler.next_2d();
                const Vec2 on_film =
                    glm::min((cell + within) / Vec2(frame.width(), frame.height()), Vec2(1 - 0x1p-24f));
                static thread_local std::vector<FoundPath> bright;  // kept, so that it need not be allocated again
                bright.clear();
                trace_all_strategies(frame, max_depth, on_film, sampler, light_sampler, splatter,
                                     [&](const FoundPath& f) {
                                         const double light = f.light() * double(f.chance), most = limit(state, f);
                                         const double left = rules.left(light, most);
                                         note(tally, frame, state, f, left);
                                         if (left > 0) bright.push_back(f);
                                         return rules.kept(light, most);
                                     });
                if (bright.empty()) return;
                RandomSequence random(sampler.next_2d());
                camera_begin.next_2d();  // where on the film it begins is known
                for (const FoundPath& f : bright) {
                    const double left = rules.left(f.light() * double(f.chance), limit(state, f));
                    const auto start =
                        rules.start(f.light() * left / double(state.guide(f.pixel)), plan.energy, random.next());
                    for (int i = 0; i < start.chains; ++i) {
                        PrimarySample sample(static_cast<std::uint64_t>(random.next() * 0x1p53));
                        sample.begin_at(camera_stream, on_film);
                        begin(sample, camera_stream, camera_begin, f.t);
                        if (f.s > 1) begin(sample, light_stream, light_begin, f.s);
                        ++tally.chains;
                        walk(frame, rules, state, sample, f, plan.length, start.energy, tally, splatter);
                    }
                }
            },
            per_unit);
        if (frame.stopped()) return;
        state.plan = plan;
        for (const auto& tally : tallies) state.all += tally;
    }

private:
    static constexpr std::uint64_t per_unit = 256;
    static constexpr double brightest = 4;  // that is not left to chains, over its part of the image
    static constexpr double few = 0.05;     // of the light, below which chains are given less time
    static constexpr double least = 0.002;  // that is planned for: a first find must not find a plan for nothing
    static constexpr double chains_per_find = 4;
    static constexpr int shortest = 8, longest = 4096;

    struct Sample {
        Vec2 pixel{0};
        Rgb value{0};
        double target = 0;  // what the chain's density is proportional to
    };

    /// Paths whose light is put nowhere: `see(unit, found)`.
    void look(auto& frame, std::size_t n, const auto& see) const {
        frame.paths(
            n,
            [&](std::uint64_t index, auto& sampler, auto& splatter) {
                auto light_sampler = sampler.split();
                const Vec2 on_film = sampler.next_2d();
                trace_all_strategies(frame, max_depth, on_film, sampler, light_sampler, splatter,
                                     [&](const FoundPath& f) {
                                         see(index / per_unit, f);
                                         return 0.0;
                                     });
            },
            per_unit);
    }

    /// The luminance beyond which a contribution is not put where it was found.
    static double limit(const State& state, const auto& found) {
        return brightest * state.mean * double(state.guide(found.pixel));
    }

    static void note(auto& tally, const auto& frame, const State& state, const FoundPath& found, double left) {
        const double light = found.light() / double(state.guide(found.pixel));
        tally.add(found.pixel / Vec2(frame.width(), frame.height()), found.s + found.t - 1, light, light * left);
    }

    /// Mutations are worth their time where much is left to them: the more paths tell of it, the shorter the chains.
    State::Plan planned(const State& state) const {
        const auto& known = refine && state.all.paths > 0 ? state.all : state.before;
        const double paths = double(known.paths), share = std::clamp(known.left / (paths * state.mean), least, 1.0);
        const double per_path = std::max(double(mutations), 1e-6) * std::min(1.0, std::sqrt(share / few));
        const double length = per_path * paths / std::max(chains_per_find * known.paths_left(), 1.0);
        State::Plan plan;
        plan.length = static_cast<int>(std::clamp(length, double(shortest), double(longest)));
        plan.energy = share * state.mean * double(plan.length) / per_path;
        return plan;
    }

    /// The numbers by which a path was found.
    static void begin(PrimarySample& sample, PrimaryStream stream, auto numbers, int vertices) {
        for (int i = 0; i < vertices * pairs_per_vertex; ++i) sample.begin_at(stream, numbers.next_2d());
    }

    static void walk(const auto& frame, const auto& rules, const State& state, PrimarySample& sample,
                     const FoundPath& from, int length, double energy, auto& tally, auto& splatter) {
        const double share = energy / double(length);
        const auto splat = [&](const Sample& at, double weight) {
            if (weight > 0 && at.target > 0)
                splatter.splat(at.pixel, at.value * static_cast<float>(weight * share / at.target));
        };
        const auto evaluate = [&](bool tell) {
            const FoundPath found = trace_strategy(frame, sample, from.s, from.t);
            if (!is_finite(found.value)) {
                if (tell) splatter.splat(found.pixel, found.value);
                return Sample{};
            }
            const double left = rules.left(found.light(), limit(state, found));
            return Sample{found.pixel, found.value * static_cast<float>(left),
                          found.light() * left / double(state.guide(found.pixel))};
        };
        Sample current = evaluate(false);
        double stayed = 0;  // the weight that the current state has gathered
        for (int i = 0; i < length; ++i) {
            sample.propose();
            const Sample proposed = evaluate(true);
            const double acceptance = rules.acceptance(current.target, proposed.target);
            // Both states count, by how likely each is taken: less noise than counting the one that is.
            stayed += 1 - acceptance;
            tally.accepted += acceptance;
            if (sample.random().next() < acceptance) {
                splat(current, stayed);
                current = proposed;
                stayed = acceptance;
            } else {
                splat(proposed, acceptance);
                sample.reject();
            }
        }
        tally.mutations += static_cast<std::uint64_t>(length);
        splat(current, stayed);
    }
};

}  // namespace lightswitch
