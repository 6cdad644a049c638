#pragma once

#include <lightswitch/method/connection.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Light tracing (Arvo 1986; particle tracing): paths start at the lights, one for every pixel of the film, and each of
/// their vertices is splatted to the pixel that sees it. Lights themselves are seen by a ray through each pixel. Sharp
/// caustics are its strength; what is seen in a mirror or through glass stays black, because no light path meets the
/// camera by chance.
struct LightTracer {
    static constexpr std::string_view name = "light";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr Dependence dependence = Dependence::iteration;
    static constexpr PathClasses cannot_make{.mirrored_dirac_caustic = true, .mirrored = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;

    struct State {};
    State start(auto&) const { return {}; }

    void iterate(auto& frame, State&) const {
        if (max_depth == 0) return;
        const auto& scene = frame.scene();
        see_lights(frame);
        const std::uint64_t light_paths = frame.area();
        frame.paths(light_paths, [&](std::uint64_t, auto& sampler, auto& splatter) {
            const auto alone = [](const Contribution& contribution, int, int) { return contribution.value; };
            splat_light_subpath(scene, sampler, splatter, {{max_depth, rr_depth}}, double(light_paths), {}, alone,
                                [](const auto&) {});
        });
    }
};

}  // namespace lightswitch
