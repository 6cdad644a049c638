#include "run.hpp"

#include <lightswitch/render/replay.hpp>

namespace lightswitch::program {

PathReplay run_replay(const AnyScene& any_scene, const AnyMethod& any_method, const Settings& settings,
                      const ReplayedPixel& at, const ReplayOptions& options) {
    return std::visit(
        [&](const auto& scene, const auto& method) {
            return replay(scene, method, settings, at.x, at.y, at.iteration, options);
        },
        any_scene, any_method);
}

BrightestSample run_brightest(const AnyScene& any_scene, const AnyMethod& any_method, const Settings& settings,
                              const ReplayedPixel& at, std::uint64_t iterations, const ReplayOptions& options) {
    return std::visit(
        [&](const auto& scene, const auto& method) {
            return brightest_sample(scene, method, settings, at.x, at.y, iterations, options);
        },
        any_scene, any_method);
}

}  // namespace lightswitch::program
