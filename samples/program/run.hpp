#pragma once

// One render by one method, whichever scene and method were chosen.

#include "ranks.hpp"

#include <lightswitch/compiled.hpp>
#include <lightswitch/method/any_method.hpp>
#include <lightswitch/method/extra_outputs.hpp>
#include <lightswitch/render/path_replay.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/render/render_state.hpp>
#include <lightswitch/scene/any_scene.hpp>
#include <lightswitch/verify/estimator.hpp>

#include <functional>

namespace lightswitch::program {

/// What can be had of a render between two iterations, or at its end.
struct Halt {
    const RenderStatistics& statistics;
    std::function<RenderState()> state;
    std::function<Image()> image;
};

/// What to render, but for scene and method.
struct Job {
    Budget budget;  ///< seconds count what was rendered before, too
    Settings settings;
    /// Called on the rendering thread after every iteration, with the number of rays; where ranks render together, on
    /// rank 0 after every round.
    std::function<void(const Progress&, std::uint64_t rays)> progress = [](const Progress&, std::uint64_t) {};
    /// Called then, or, where ranks render together, whenever rank 0 has all; that it gets when `due` says so.
    std::function<void(const Progress&, const Halt&)> observer = [](const Progress&, const Halt&) {};
    std::function<bool()> due = {};
    double longest_round = 10;  ///< seconds, of ranks
    /// From where to go on, if from anywhere, and what the scene holds, as a text.
    std::optional<RenderState> from{};
    Origin from_where{};
    std::string content{};
    /// Called at the end where there are iterations.
    std::function<void(const Halt&)> end = [](const Halt&) {};
};

/// What came of it.
struct Rendered {
    Image image;  ///< black when there are no iterations
    RenderStatistics statistics;
    double estimated_error = 0;  ///< `Film::relative_error`
    Sharing sharing{};
};

/// Renders until the budget is spent or the stop token asks for an end. Throws `Error` when the job cannot go on from
/// where it is to.
Rendered run(const AnyScene& scene, const AnyMethod& method, Job job);

/// Whether the method's iterations depend on those before.
bool has_history(const AnyMethod& method);

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
