#include "run.hpp"

#include <lightswitch/render/checkpoint.hpp>
#if LIGHTSWITCH_HAS_MPI
#include <lightswitch/mpi/render.hpp>
#endif

#include <algorithm>

namespace lightswitch::program {
namespace {

template <class SceneType, class M>
Settings settings_of_rank([[maybe_unused]] const SceneType& scene, [[maybe_unused]] const M& method,
                          const Settings& settings) {
#if LIGHTSWITCH_HAS_MPI
    if (ranks()) return rank_settings<SceneType, M>(*ranks(), settings);
#endif
    return settings;
}

/// Returns whether there is a job, which then has made the iterations.
template <class SceneType, class M>
bool run_by_job([[maybe_unused]] Session<SceneType, M>& session, [[maybe_unused]] const Job& job,
                [[maybe_unused]] const Halt& halt, [[maybe_unused]] Sharing& sharing) {
#if LIGHTSWITCH_HAS_MPI
    if (!ranks()) return false;
    const RankReport report =
        run_on_ranks(*ranks(), session, job.budget,
                     {.longest_round = job.longest_round,
                      .gather_when = job.due,
                      .observer = job.progress,
                      .gathered = [&](const Progress& progress) { job.observer(progress, halt); }});
    sharing = {report.ranks, report.gatherings, report.most_bytes_sent, report.most_seconds_waited};
    return true;
#else
    return false;
#endif
}

}  // namespace

Rendered run(const AnyScene& any_scene, const AnyMethod& any_method, Job job) {
    return std::visit(
        [&](const auto& scene, const auto& method) -> Rendered {
            std::function<void(const Progress&)> observe;
            Settings settings = settings_of_rank(scene, method, job.settings);
            if (!ranks()) settings.observer = [&](const Progress& progress) { observe(progress); };
            std::vector<RenderState::Trace> traces;
            Session session = together([&] {
                Session made(scene, method, settings);
                if (job.from) {
                    traces = job.from->traces;
                    at_place(job.from_where, [&] { resume(made, std::move(*job.from), job.content); });
                }
                return made;
            });
            const Halt halt{.statistics = session.statistics(),
                            .state =
                                [&] {
                                    RenderState state = state_of(session, job.content, traces);
                                    traces = state.traces;
                                    return state;
                                },
                            .image = [&] { return session.image(); }};
            observe = [&](const Progress& progress) {
                if (progress.iterations == 1 && !job.content.empty()) traces = {trace_of(session)};
                job.progress(progress, session.statistics().counts.rays);
                job.observer(progress, halt);
            };
            Sharing sharing;
            if (!run_by_job(session, job, halt, sharing)) {
                Budget left = job.budget;
                left.seconds = std::max(left.seconds - session.statistics().seconds, 0.0);
                const bool none_left = job.budget.seconds > 0 && left.seconds == 0 && session.film().iterations() > 0;
                if (!none_left) session.run(left);
            }
            if (session.film().iterations() > 0) job.end(halt);
            return {session.image(), session.statistics(), session.film().relative_error(), sharing};
        },
        any_scene, any_method);
}

bool has_history(const AnyMethod& any_method) {
    return std::visit([]<class M>(const M&) { return Session<DiffuseScene, M>::has_history(); }, any_method);
}

Estimator make_estimator(const AnyScene& any_scene, const AnyMethod& any_method, const Settings& settings) {
    return std::visit([&](const auto& scene, const auto& method) { return estimator(scene, method, settings); },
                      any_scene, any_method);
}

}  // namespace lightswitch::program
