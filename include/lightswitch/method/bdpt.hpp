#pragma once

#include <lightswitch/method/connection.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

#include <optional>
#include <vector>

namespace lightswitch {

/// One strategy of bidirectional path tracing, for looking at it alone.
struct Strategy {
    int light_vertices = 0;   ///< s: 0 when the camera path meets the light by chance
    int camera_vertices = 2;  ///< t, with the one on the lens: 1 when the light path is seen by the camera
    bool weighted = true;     ///< by multiple importance sampling; otherwise as if there were no other strategy
};

/// Bidirectional path tracing (Lafortune and Willems 1993; Veach 1997, chapter 10): for every pixel a path from the
/// camera and one from a light, and all ways to join them, weighed by the power heuristic. Light paths that the camera
/// sees are splatted to the film.
struct Bdpt {
    static constexpr std::string_view name = "bdpt";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr Dependence dependence = Dependence::pixel;
    static constexpr PathClasses cannot_make{.mirrored_dirac_caustic = true};
    static constexpr PathClasses can_leave_out{.dirac_light = true, .dirac_caustic = true, .mirrored = true};

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;    ///< of whole paths: each of the two that make one counts half as many
    std::optional<Strategy> only =
        {};                     ///< this strategy alone; the weighted images of all strategies add up to the image
    PathClasses left_out = {};  ///< paths that are not made

    struct State {};
    State start(auto&) const { return {}; }

    void iterate(auto& frame, State&) const {
        if (max_depth == 0) return;
        const auto& scene = frame.scene();
        const PathLimits limits{{max_depth, rr_depth / 2}, left_out};
        const double light_paths = double(frame.area());
        const auto count = [this](const Contribution& contribution, int s, int t) {
            return counted(contribution, s, t);
        };
        frame.pixels([&](const Ray& ray, auto& sampler, const PixelContext& pixel) {
            using Vertex = PathVertex<point_of<decltype(scene)>>;
            static thread_local std::vector<Vertex> light_path;  // kept, so that it need not be allocated again
            light_path.clear();
            auto light_sampler = sampler.split();
            splat_light_subpath(scene, light_sampler, pixel.splatter, limits, light_paths, {}, count,
                                [&](const Vertex& y) { light_path.push_back(y); });
            return gather_camera_subpath(scene, ray, sampler, light_path, limits, light_paths, {}, count,
                                         [](const Vertex&, const Arrival&) { return Rgb(0); });
        });
    }

private:
    Rgb counted(const Contribution& contribution, int s, int t) const {
        if (only) {
            if (only->light_vertices != s || only->camera_vertices != t) return Rgb(0);
            if (!only->weighted) return contribution.value;
        }
        return contribution.value * contribution.weight;
    }
};

}  // namespace lightswitch
