#pragma once

// What the ranks of an MPI job need of a render, whatever its types.

#include <lightswitch/render/checkpoint.hpp>

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// How ranks share a render.
struct RankOptions {
    double longest_round = 10;  ///< seconds, about; a longer one costs less waiting
    /// Asked on rank 0 after every round: whether it is to get what all have made. It also gets that at the end, and
    /// where an error is to be judged.
    std::function<bool()> gather_when = {};
    /// Called on rank 0 after every round, with the rays of all ranks. The film in it holds what rank 0 has.
    std::function<void(const Progress&, std::uint64_t rays)> observer = {};
    /// Called on rank 0 whenever its session holds what all ranks have made.
    std::function<void(const Progress&)> gathered = {};
};

/// What sharing has cost.
struct RankReport {
    int ranks = 1;
    int gatherings = 0;
    std::uint64_t most_bytes_sent = 0;  ///< by any one rank
    double most_seconds_waited = 0;     ///< by any one rank, for the others
};

namespace detail {

/// What ranks need of a session, whatever its types.
struct RankSession {
    std::string name;  ///< of the method
    bool has_history = false;
    std::uint64_t seed = 0, first_iteration = 0;
    std::vector<RenderFact> facts;
    std::stop_token stop;
    std::function<const Film&()> film;
    std::function<const RenderStatistics&()> statistics;
    std::function<const IterationSet&()> made;
    std::function<void(std::uint64_t first, std::uint64_t count)> run;
    std::function<std::uint64_t(std::uint64_t iteration)> checksum;
    std::function<RenderState()> state;
    std::function<void(RenderState)> restore;
};

template <class SceneType, class M, Executor E>
RankSession rank_session(Session<SceneType, M, E>& session) {
    return {.name = std::string(M::name),
            .has_history = session.has_history(),
            .seed = session.settings().seed,
            .first_iteration = session.settings().first_iteration,
            .facts = facts_of(session, ""),
            .stop = session.settings().stop,
            .film = [&session]() -> const Film& { return session.film(); },
            .statistics = [&session]() -> const RenderStatistics& { return session.statistics(); },
            .made = [&session]() -> const IterationSet& { return session.made(); },
            .run =
                [&session](std::uint64_t first, std::uint64_t count) {
                    session.begin_at(first);
                    session.run({.samples = static_cast<int>(session.film().iterations() + count)});
                },
            .checksum = [&session](std::uint64_t iteration) { return detail::checksum_of(session.film_of(iteration)); },
            // Ranks make one render: nobody has to find out by a trace whether its iterations are those of another.
            .state =
                [&session] {
                    return state_of(session, "", {{session.settings().seed, 0, 0}});
                },
            .restore =
                [&session](RenderState state) {
                    session.restore(std::move(state.film), std::move(state.iterations), std::move(state.statistics),
                                    ByteReader(state.method_state, "the state of a rank"));
                }};
}

}  // namespace detail

}  // namespace lightswitch
