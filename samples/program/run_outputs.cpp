#include "run.hpp"

namespace lightswitch::program {

std::vector<Layer> run_outputs(const AnyScene& any_scene, const std::vector<ExtraOutput>& outputs, int samples,
                               const Settings& settings) {
    return std::visit([&](const auto& scene) { return render_outputs(scene, outputs, samples, settings); }, any_scene);
}

}  // namespace lightswitch::program
