#pragma once

// Paths of bidirectional path tracing as functions of points in the space of random numbers: all strategies by fresh
// numbers, and one of them by a chain's.

#include <lightswitch/method/connection.hpp>
#include <lightswitch/method/primary_space.hpp>

#include <optional>
#include <vector>

namespace lightswitch {

/// Where camera paths may begin: a filter that is wider than a pixel also sees what is just outside of the film.
struct FilmArea {
    float margin;
    Vec2 size;         ///< in pixels, with margins
    double area;       ///< of it
    float per_sample;  ///< area over the number of pixels, which is that of an iteration's samples

    explicit FilmArea(const auto& frame)
        : margin(std::max(frame.scene().film().filter.radius() - 0.5f, 0.0f)),
          size(Vec2(frame.width(), frame.height()) + 2 * margin),
          area(double(size.x) * double(size.y)),
          per_sample(static_cast<float>(area / double(frame.area()))) {}

    Vec2 pixel(const Vec2& on_film) const { return on_film * size - margin; }
};

/// A contribution of strategy (s, t).
struct FoundPath {
    Vec2 pixel{0};     ///< where the camera sees it
    Rgb value{0};      ///< as it counts in an iteration of one sample per pixel
    float chance = 1;  ///< see `Contribution`
    int s = 0, t = 2;

    double light() const { return double(luminance(value)); }
};

/// Random numbers of a path from either side come in pairs, at most so many for each vertex.
enum PrimaryStream : std::size_t { camera_stream, light_stream };
inline constexpr int pairs_per_vertex = 3;

/// Roulette of the paths here, each of which is one of the two that make a whole.
inline constexpr int primary_rr_depth = PathLength{}.rr_depth / 2;

/// Calls a function for every splat.
template <class F>
struct SplatTo {
    const F& function;
    void splat(const Vec2& pixel, const Rgb& value) const { function(pixel, value); }
};

/// The paths of `Bdpt` for one sample of the film at `on_film` in [0, 1)^2, but for lights seen directly.
/// `count(found)` gives the share of each that is splatted where it was found. Values that are not finite are splatted,
/// so that they are told, without being asked for.
void trace_all_strategies(const auto& frame, int max_depth, const Vec2& on_film, auto& sampler, auto& light_sampler,
                          auto& splatter, const auto& count) {
    const auto& scene = frame.scene();
    const auto& camera = connectable_camera(scene.camera());
    const FilmArea film(frame);
    const PathLimits limits{{max_depth, primary_rr_depth}, {}};
    const auto counted = [&](const FoundPath& found) {
        if (is_black(found.value) || !is_finite(found.value)) return found.value;
        return found.value * static_cast<float>(count(found));
    };
    using Vertex = PathVertex<point_of<decltype(scene)>>;
    static thread_local std::vector<Vertex> light_path;  // kept, so that it need not be allocated again
    light_path.clear();
    FoundPath seen;
    const auto show = [&](const Vec2& pixel, const Rgb& value) {
        seen.pixel = pixel;
        seen.value = value;
        const Rgb counts = counted(seen);
        if (!is_black(counts)) splatter.splat(pixel, counts);
    };
    const SplatTo at_camera{show};
    splat_light_subpath(
        scene, light_sampler, at_camera, limits, film.area, {},
        [&](const Contribution& found, int s, int t) {
            seen.s = s;
            seen.t = t;
            return found.value * found.weight * film.per_sample;
        },
        [&](const Vertex& y) { light_path.push_back(y); });

    const Vec2 pixel = film.pixel(on_film), lens = camera.has_lens() ? sampler.next_2d() : Vec2(0.5f);
    const Rgb sum = gather_camera_subpath(
        scene, camera.ray(pixel, lens), sampler, light_path, limits, film.area, {},
        [&](const Contribution& found, int s, int t) {
            if (s == 0 && t == 2) return Rgb(0);
            return counted({pixel, found.value * found.weight * film.per_sample, found.chance, s, t});
        },
        [](const Vertex&, const Arrival&) { return Rgb(0); });
    if (!is_black(sum)) splatter.splat(pixel, sum);
}

/// The contribution of strategy (s, t) by the numbers of `sample`: the same as of `trace_all_strategies` by the same
/// ones. Black where it makes no path.
FoundPath trace_strategy(const auto& frame, PrimarySample& sample, int s, int t) {
    const auto& scene = frame.scene();
    const auto& camera = connectable_camera(scene.camera());
    const FilmArea film(frame);
    PrimarySample::Reader on_camera(sample, camera_stream), on_light(sample, light_stream);
    FoundPath result{.s = s, .t = t};
    Connection found;
    const auto finished = [&](const Contribution& contribution) {
        result.value = contribution.value * contribution.weight * film.per_sample;
        return result;
    };
    Vec2 lens(0.5f);
    std::optional<LightSubpath<point_of<decltype(scene)>>> y;
    if (s > 1) {
        y.emplace(scene, on_light, MergeWeights{});
        if (is_black(y->carried())) return result;
        for (int edges = 1;; ++edges) {
            if (!y->advance(scene)) return result;
            const bool can_end = connectable(scene, y->vertex().point);
            if (edges == s - 1 && !can_end) return result;
            if (can_end && camera.has_lens()) lens = on_light.next_2d();
            if (edges == s - 1) break;
            const Vec2 direction = on_light.next_2d(), choices = on_light.next_2d();
            if (!y->scatter(scene, direction, choices, primary_rr_depth)) return result;
        }
    }
    if (t == 1) {
        const auto view = camera.view(y->vertex().point, lens);
        if (!view) return result;
        result.pixel = view->pixel;
        found = connect_to_camera(scene, y->vertex(), *view, film.area, {});
        return visible(scene, found) ? finished(found) : result;
    }
    result.pixel = film.pixel(on_camera.next_2d());
    if (camera.has_lens()) lens = on_camera.next_2d();
    on_camera.skip();  // roulette of connections
    CameraSubpath<point_of<decltype(scene)>> z(camera.ray(result.pixel, lens), film.area, {});
    for (int edges = 1; edges < t; ++edges) {
        const bool last = edges == t - 1;
        if (!z.advance(scene)) return last && s == 0 ? finished(meet_environment(scene, z)) : result;
        if (last) break;
        const Vec2 direction = on_camera.next_2d(), choices = on_camera.next_2d();
        on_camera.skip();  // a place on a light
        if (!z.scatter(scene, direction, choices, primary_rr_depth)) return result;
    }
    if (s == 0) return finished(meet_light(scene, z));
    if (!connectable(scene, z.vertex().point)) return result;
    const Arrival at_z(z.vertex().point);
    if (s == 1) {
        on_camera.skip();
        const float choice = on_camera.next_1d();
        found = connect_to_light(scene, z.vertex(), at_z, choice, on_camera.next_2d(), {});
    } else {
        found = connect(scene, y->vertex(), z.vertex(), at_z, {});
    }
    return visible(scene, found) ? finished(found) : result;
}

}  // namespace lightswitch
