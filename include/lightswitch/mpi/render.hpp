#pragma once

// One render by all ranks of an MPI job: its image is that of one process, to the last bit.

#include <lightswitch/mpi/ranked_render.hpp>

#include <cstdint>
#include <string>
#include <utility>

namespace lightswitch {

/// Makes the iterations of `budget` on all ranks, each of which has a session of the same render; afterwards that of
/// rank 0 holds all, as if it had made them, and those of the others nothing. Where the session of rank 0 goes on from
/// a state, the others begin with nothing.
///
/// The image is, to the last bit, that of one process which makes the same iterations, for any number of ranks and
/// threads: those of a number of samples or of an error; only which iterations a time allows depends on the machines.
/// An error is judged after 16 iterations and then where it is likely to be met. Methods whose iterations go on from
/// one another (`Session::has_history`) need a seed of its own on every rank (`rank_settings`), and the image is the
/// mean over them. Throws the same `Error` on all ranks when those differ in what they render, or one of them fails.
/// Stops on all ranks when the stop token of one asks for it.
///
/// Rounds take from a quarter of a second to ten; after each, ranks tell how far they got, and get shares of the next
/// one in proportion to their speed.
template <class SceneType, class M, Executor E>
RankReport run_on_ranks(Ranks& ranks, Session<SceneType, M, E>& session, const Budget& budget,
                        const RankOptions& options = {}) {
    return detail::RankedRender(ranks, detail::rank_session(session), budget, options).run();
}

/// The settings of a rank: as many threads as are its own, where none are asked for, and a seed of its own if the
/// method needs that. Collective.
template <class SceneType, class M>
Settings rank_settings(const Ranks& ranks, Settings settings) {
    const int threads = ranks.fair_threads();
    if (settings.threads == 0) settings.threads = threads;
    if (Session<SceneType, M>::has_history()) settings.seed += static_cast<std::uint64_t>(ranks.rank());
    return settings;
}

/// Renders on all ranks of the communicator; the image is on rank 0, and black elsewhere. As `render` otherwise.
template <class SceneType, class M>
Image render_on_ranks(MPI_Comm communicator, const SceneType& scene, const M& method, const Budget& budget = {},
                      const Settings& settings = {}) {
    Ranks ranks(communicator);
    Session<SceneType, M> session(scene, method, rank_settings<SceneType, M>(ranks, settings));
    run_on_ranks(ranks, session, budget);
    return session.image();
}

}  // namespace lightswitch
