#include "run.hpp"

#include <lightswitch/render/checkpoint.hpp>

#include <algorithm>

namespace lightswitch::program {

Rendered run(const AnyScene& any_scene, const AnyMethod& any_method, Job job) {
    return std::visit(
        [&](const auto& scene, const auto& method) -> Rendered {
            std::function<void(const Progress&)> observe;
            Settings settings = job.settings;
            settings.observer = [&](const Progress& progress) { observe(progress); };
            Session session(scene, method, settings);
            std::vector<RenderState::Trace> traces;
            if (job.from) {
                traces = job.from->traces;
                at_place(job.from_where, [&] { resume(session, std::move(*job.from), job.content); });
            }
            const Halt halt{.statistics = session.statistics(),
                            .state = [&] { return state_of(session, job.content, traces); },
                            .image = [&] { return session.image(); }};
            observe = [&](const Progress& progress) {
                if (progress.iterations == 1 && !job.content.empty()) traces = {trace_of(session)};
                job.observer(progress, halt);
            };
            Budget left = job.budget;
            left.seconds = std::max(left.seconds - session.statistics().seconds, 0.0);
            const bool none_left = job.budget.seconds > 0 && left.seconds == 0 && session.film().iterations() > 0;
            if (!none_left) session.run(left);
            if (session.film().iterations() > 0) job.end(halt);
            return {session.image(), session.statistics(), session.film().relative_error()};
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
