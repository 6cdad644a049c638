#pragma once

#include <lightswitch/core/pdf.hpp>
#include <lightswitch/geometry/surface_point.hpp>

namespace lightswitch {

/// What next event estimation at the vertex before could have found: the weight of light that a path then meets by
/// chance (power heuristic). 1 where nothing was sampled, as at the camera and after a specular bounce.
class SampledLight {
public:
    /// The path leaves `at` along a direction of that density; `sampled` says whether light was sampled there that it
    /// could meet.
    [[gnu::always_inline]] void leave(const SurfacePoint& at, SolidAnglePdf pdf, bool sampled) {
        sampled_ = sampled;
        pdf_ = pdf;
        from_ = at.position;
        from_normal_ = at.lit_normal();
    }

    /// Of the light that is met at `hit`.
    [[gnu::always_inline]] float weight(const auto& scene, const SurfacePoint& hit) const {
        return sampled_ ? power_heuristic(pdf_, scene.light_pdf(from_, from_normal_, -hit.wo, hit)) : 1;
    }
    /// Of the environment, met along `direction`.
    [[gnu::always_inline]] float weight_of_environment(const auto& scene, const Vec3& direction) const {
        return sampled_ ? power_heuristic(pdf_, scene.environment_pdf(from_normal_, direction)) : 1;
    }

private:
    bool sampled_ = false;
    SolidAnglePdf pdf_;
    Vec3 from_{0}, from_normal_{0};
};

}  // namespace lightswitch
