#pragma once

// One render, compiled for one method: each method has a translation unit of its own, run_*.cpp, so that they build in
// parallel and the rest of the program never sees the loop.

#include <lightswitch/render/any_method.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <functional>

namespace lightswitch::program {

/// What to render, but for scene and method.
struct Job {
    Budget budget;
    Settings settings;
    /// Called on the rendering thread after every iteration, with the counts so far.
    std::function<void(const Progress&, const RenderStatistics&)> observer;
};

/// What came of it.
struct Rendered {
    Image image;  ///< black when there are no iterations
    RenderStatistics statistics;
    double estimated_error = 0;  ///< `Film::relative_error`
};

/// Renders until the budget is spent or the stop token asks for an end.
template <class M>
Rendered run(const AnyScene& scene, const M& method, const Job& job);

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

}  // namespace lightswitch::program
