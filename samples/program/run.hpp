#pragma once

// One render by one method, whichever scene and method were chosen.

#include <lightswitch/compiled.hpp>
#include <lightswitch/method/any_method.hpp>
#include <lightswitch/method/extra_outputs.hpp>
#include <lightswitch/render/path_replay.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>
#include <lightswitch/verify/estimator.hpp>

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
Rendered run(const AnyScene& scene, const AnyMethod& method, const Job& job);

/// Renders extra outputs; none when the stop token asks for an end.
std::vector<Layer> run_outputs(const AnyScene& scene, const std::vector<ExtraOutput>& outputs, int samples,
                               const Settings& settings);

/// Which sample to make again.
struct ReplayedPixel {
    int x = 0, y = 0;
    std::uint64_t iteration = 0;
};
PathReplay run_replay(const AnyScene& scene, const AnyMethod& method, const Settings& settings, const ReplayedPixel& at,
                      const ReplayOptions& options);
/// Of the first `iterations` of that pixel.
BrightestSample run_brightest(const AnyScene& scene, const AnyMethod& method, const Settings& settings,
                              const ReplayedPixel& at, std::uint64_t iterations, const ReplayOptions& options);

/// The method on the scene as a side of `verify`. The scene must outlive it.
Estimator make_estimator(const AnyScene& scene, const AnyMethod& method, const Settings& settings);

}  // namespace lightswitch::program
