#pragma once

#include <lightswitch/method/hash_grid.hpp>
#include <lightswitch/method/merging.hpp>
#include <lightswitch/method/path_records.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

namespace lightswitch {

/// Vertex connection and merging (Georgiev, Krivanek, Davidovic, Slusallek, "Light Transport Simulation with Vertex
/// Connection and Merging", 2012): bidirectional path tracing whose camera paths also gather the vertices of all light
/// paths around them, all weighed against each other. What connections cannot find, such as a caustic seen in a mirror,
/// merging does.
struct Vcm {
    static constexpr std::string_view name = "vcm";
    static constexpr Kind kind = Kind::consistent;
    static constexpr Dependence dependence = Dependence::iteration;

    int max_depth = PathLength{}.max_depth;  ///< see `PathLength`
    int rr_depth = PathLength{}.rr_depth;    ///< of whole paths: each of the two that make one counts half as many
    MergeRadius radius = {};                 ///< with 0 pixels nothing is merged: bidirectional path tracing

    /// Between iterations. `Point` is what a ray finds in the scene.
    template <class Point>
    class State {
    public:
        /// Of the last iteration.
        std::vector<std::pair<std::string, double>> statistics() const {
            return {{"light_vertices", double(paths.size())}, {"radius_pixels", double(map.radius()) / footprint}};
        }

    private:
        friend Vcm;
        double footprint = 0;
        PathRecords<PathVertex<Point>, paths_per_unit> paths;
        std::vector<WeighedPhoton> photons;
        HashGrid<WeighedPhoton> map;
    };

    auto start(auto& frame) const {
        State<point_of<decltype(frame.scene())>> state;
        state.footprint = pixel_footprint(frame.scene());
        return state;
    }

    template <class Point>
    void iterate(auto& frame, State<Point>& state) const {
        if (max_depth == 0) return;
        const auto& scene = frame.scene();
        const PathLimits limits{{max_depth, rr_depth / 2}};
        const std::uint64_t light_paths = frame.area();
        const double n = double(light_paths);
        const float r = radius.at(frame.iteration(), state.footprint);
        const MergeWeights weights = merge_weights(n, r);
        const auto count = [](const Contribution& contribution, int, int) {
            return contribution.value * contribution.weight;
        };

        state.paths.reset(light_paths);
        frame.paths(light_paths, [&](std::uint64_t path, auto& sampler, auto& splatter) {
            state.paths.start(path);
            splat_light_subpath(scene, sampler, splatter, limits, n, weights, count,
                                [&](const PathVertex<Point>& y) { state.paths.push(path, y); });
        });
        if (frame.stopped()) return;
        if (r > 0) {
            state.paths.list(state.photons, frame.executor(), [&](const PathVertex<Point>& y) {
                return WeighedPhoton{photon_at(scene, y), y.weights.last, y.weights.merges};
            });
            state.map.build(state.photons, r, frame.executor());
        }
        frame.pixels([&](const Ray& ray, auto& sampler, const PixelContext& pixel) {
            const auto merge_around = [&](const PathVertex<Point>& z, const Arrival& at_z) {
                Rgb sum(0);
                state.map.for_each_near(z.point.position, [&](const WeighedPhoton& y) {
                    if (max_depth >= 0 && y.edges + z.edges > max_depth) return;
                    sum += count(merge(scene, y, z, at_z, weights), 0, 0);
                });
                return sum;
            };
            return gather_camera_subpath(scene, ray, sampler, state.paths.of(pixel.index), limits, n, weights, count,
                                         merge_around);
        });
    }
};

}  // namespace lightswitch
