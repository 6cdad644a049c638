#pragma once

// What run.hpp declares, for the translation unit of one method to instantiate.

#include "run.hpp"

namespace lightswitch::program {

template <class M>
Rendered run(const AnyScene& any_scene, const M& method, const Job& job) {
    return std::visit(
        [&](const auto& scene) -> Rendered {
            const RenderStatistics* statistics = nullptr;
            Settings settings = job.settings;
            settings.observer = [&](const Progress& progress) { job.observer(progress, *statistics); };
            Session session(scene, method, settings);
            statistics = &session.statistics();
            session.run(job.budget);
            return {session.image(), session.statistics(), session.film().relative_error()};
        },
        any_scene);
}

template <class M>
Estimator make_estimator(const AnyScene& any_scene, const M& method, const Settings& settings) {
    return std::visit([&](const auto& scene) { return estimator(scene, method, settings); }, any_scene);
}

}  // namespace lightswitch::program
