#include "run.hpp"

namespace lightswitch::program {

Rendered run(const AnyScene& any_scene, const AnyMethod& any_method, const Job& job) {
    return std::visit(
        [&](const auto& scene, const auto& method) -> Rendered {
            const RenderStatistics* statistics = nullptr;
            Settings settings = job.settings;
            settings.observer = [&](const Progress& progress) { job.observer(progress, *statistics); };
            Session session(scene, method, settings);
            statistics = &session.statistics();
            session.run(job.budget);
            return {session.image(), session.statistics(), session.film().relative_error()};
        },
        any_scene, any_method);
}

Estimator make_estimator(const AnyScene& any_scene, const AnyMethod& any_method, const Settings& settings) {
    return std::visit([&](const auto& scene, const auto& method) { return estimator(scene, method, settings); },
                      any_scene, any_method);
}

}  // namespace lightswitch::program
