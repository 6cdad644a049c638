#pragma once

// The ways in which a path from the camera and one from a light become a whole path: strategies, in Veach's words (s,
// t) with s vertices from the light and t from the camera.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/method/subpath.hpp>

namespace lightswitch {

/// What a strategy contributes by one path.
struct Contribution {
    Rgb value{0};      ///< the integrand over the density, as if there were no other strategy
    float weight = 0;  ///< by multiple importance sampling
    float chance = 1;  ///< with which it was counted at all: `value` has been divided by it
};

/// A contribution that depends on whether two points see each other.
struct Connection : Contribution {
    Ray visibility;  ///< must be free
};

/// 1 / (1 + what the strategies with fewer light vertices, and those with more of them, count beside this one).
inline float strategy_weight(double fewer, double more) { return static_cast<float>(1 / (1 + fewer + more)); }

/// s = 0: the camera path has met a light.
inline Contribution meet_light(const auto& scene, const auto& path) {
    const auto& z = path.vertex();
    if (!z.point.light) return {};
    const Rgb radiance = scene.emitted(z.point, z.point.wo);
    if (is_black(radiance)) return {};
    double more = 0;
    if (z.edges > 1) {
        const float distance2 = square(z.point.distance), cosine = std::abs(dot(z.point.wo, z.point.normal));
        const AreaPdf direct =
            to_area(scene.light_pdf(path.previous(), path.previous_normal(), -z.point.wo, z.point), distance2, cosine);
        more = heuristic(direct) * z.weights.last +
               heuristic(scene.emission_pdf(z.point, z.point.wo)) * z.weights.connections;
    }
    return {z.throughput * radiance, strategy_weight(0, more)};
}

/// s = 0: the camera path has left the scene.
inline Contribution meet_environment(const auto& scene, const auto& path) {
    const Vec3 direction = path.ray().direction;
    const Rgb radiance = scene.environment(direction);
    if (is_black(radiance)) return {};
    double more = 0;
    if (path.vertex().edges > 1) {
        // Places beyond the scene are directions: the weights have not been turned to area.
        const PartialWeights& w = path.vertex().weights;
        more = heuristic(scene.environment_pdf(path.previous_normal(), direction)) * w.last +
               heuristic(scene.environment_emission_pdf(direction)) * w.connections;
    }
    return {path.carried() * radiance, strategy_weight(0, more)};
}

/// s = 1: a point of a light, chosen from the vertex of the camera path (next event estimation).
[[gnu::always_inline]] inline Connection connect_to_light(const auto& scene, const auto& z, const Arrival& at_z,
                                                          float choice, const Vec2& place,
                                                          const MergeWeights& merge_weights,
                                                          const PathClasses& left_out = {}) {
    const LightSample light = scene.sample_light(z.point, choice, place);
    if (!is_positive(light.pdf) || (light.dirac && left_out.dirac_light)) return {};
    const Turn at_camera = turn<Transport::radiance>(scene, z.point, at_z, light.wi);
    if (is_black(at_camera.value)) return {};
    const double cosine = std::abs(dot(z.point.normal, light.wi));
    const double fewer = light.dirac ? 0 : heuristic(at_camera.pdf / light.pdf);
    const double more =
        heuristic(cosine / double(light.spread)) *
        (merge_weights.merge + z.weights.last + z.weights.connections * heuristic(at_camera.reverse_pdf));
    return {{z.throughput * at_camera.value * (light.radiance / light.pdf), strategy_weight(fewer, more)},
            light.visibility};
}

/// t = 1: the vertex of a light path, seen by the camera. `view` must be what the camera says of it.
[[gnu::always_inline]] inline Connection connect_to_camera(const auto& scene, const auto& y, const CameraView& view,
                                                           double light_paths, const MergeWeights& merge_weights) {
    const Turn at_light = turn<Transport::importance>(scene, y.point, Arrival(y.point), view.wi);
    if (is_black(at_light.value)) return {};
    const double cosine = std::abs(dot(y.point.normal, view.wi));
    const double fewer =
        heuristic(view.density * cosine / light_paths) *
        (merge_weights.merge + y.weights.last + y.weights.connections * heuristic(at_light.reverse_pdf));
    return {{y.throughput * at_light.value * static_cast<float>(view.density / light_paths), strategy_weight(fewer, 0)},
            view.visibility};
}

/// s, t >= 2: a vertex of each path.
[[gnu::always_inline]] inline Connection connect(const auto& scene, const auto& y, const auto& z, const Arrival& at_z,
                                                 const MergeWeights& merge_weights) {
    const Vec3 to_light = y.point.position - z.point.position;
    const double distance2 = length_squared(to_light);
    if (!(distance2 > 0)) return {};
    const Vec3 wi = to_light * static_cast<float>(1 / std::sqrt(distance2));
    const Turn at_camera = turn<Transport::radiance>(scene, z.point, at_z, wi);
    if (is_black(at_camera.value)) return {};
    const Turn at_light = turn<Transport::importance>(scene, y.point, Arrival(y.point), -wi);
    if (is_black(at_light.value)) return {};
    const double cosine_z = std::abs(dot(z.point.normal, wi)), cosine_y = std::abs(dot(y.point.normal, wi));
    const double fewer =
        heuristic_per_area(at_camera.pdf, distance2, cosine_y) *
        (merge_weights.merge + y.weights.last + y.weights.connections * heuristic(at_light.reverse_pdf));
    const double more =
        heuristic_per_area(at_light.pdf, distance2, cosine_z) *
        (merge_weights.merge + z.weights.last + z.weights.connections * heuristic(at_camera.reverse_pdf));
    return {{z.throughput * at_camera.value * at_light.value * y.throughput * static_cast<float>(1 / distance2),
             strategy_weight(fewer, more)},
            z.point.segment_to(y.point.position, y.point.normal, y.point.offset)};
}

/// What is told of a contribution that counts as `value`: so its weight is the one that the method has given it.
[[gnu::always_inline]] inline Contributed told(Finding how, const Contribution& found, const Rgb& value, int s, int t,
                                               const Vec2& film = Vec2(0)) {
    const float weight = max_component(value) / max_component(found.value);
    return {how, s, t, weight, value, film};
}

/// Adds the light that comes to the camera straight from lights: paths of length 1.
void see_lights(auto& frame) {
    const auto& scene = frame.scene();
    frame.pixels([&](const Ray& ray, auto&) {
        const auto hit = scene.intersect(ray);
        const Rgb found = hit ? scene.emitted(*hit, hit->wo) : scene.environment(ray.direction);
        tell(scene, Contributed{hit ? Finding::light_met : Finding::environment_met, 0, 2, 1, found});
        return found;
    });
}

/// Whether the connection contributes anything, which takes a ray if it may.
[[gnu::always_inline]] inline bool visible(const auto& scene, const Connection& connection) {
    return !is_black(connection.value) && connection.weight > 0 && !scene.occluded(connection.visibility);
}

/// Traces a path from a light and splats what the camera sees of it: `splatter` gets `count(contribution, s, t)`. Calls
/// `visit(vertex)` at each vertex to which a camera path can connect.
void splat_light_subpath(const auto& scene, auto& sampler, auto& splatter, const PathLimits& limits, double light_paths,
                         const MergeWeights& merge_weights, const auto& count, const auto& visit) {
    const auto& camera = connectable_camera(scene.camera());
    trace_light_subpath(scene, sampler, limits, merge_weights, [&](const auto& y) {
        visit(y);
        const auto view = camera.view(y.point, camera.has_lens() ? sampler.next_2d() : Vec2(0.5f));
        if (!view) return;
        const Connection seen = connect_to_camera(scene, y, *view, light_paths, merge_weights);
        if (!visible(scene, seen)) return;
        const Rgb value = count(seen, y.edges + 1, 1);
        tell(scene, told(Finding::seen, seen, value, y.edges + 1, 1, view->pixel));
        splatter.splat(view->pixel, value);
    });
}

/// Traces the path from the camera that `ray` starts, and returns the sum of `count(contribution, s, t)` over all ways
/// to join it with the lights and with the vertices of `light_path`, and of `at_vertex(z, arrival)` at each vertex
/// where something can be joined.
///
/// Most connections carry little. Whether one is worth its ray is left to Russian roulette: one that would add 1 % to
/// what the path has gathered is traced with probability 0.1, and counts ten times.
Rgb gather_camera_subpath(const auto& scene, const Ray& ray, auto& sampler, const auto& light_path,
                          const PathLimits& limits, double light_paths, const MergeWeights& merge_weights,
                          const auto& count, const auto& at_vertex) {
    constexpr float worth = 0.1f;
    Rgb sum(0);
    float gathered = 0;
    RandomSequence roulette(sampler.next_2d());
    tell(scene, ray);
    const auto add = [&](const Contribution& found, Finding how, int s, int t) __attribute__((always_inline)) {
        gathered += max_component(found.value) * found.weight;
        const Rgb value = count(found, s, t);
        tell(scene, told(how, found, value, s, t));
        sum += value;
    };
    const auto try_connection = [&](Connection connection, Finding how, int s, int t) {
        const float adds = max_component(connection.value) * connection.weight;
        if (adds < worth * gathered) {
            const float probability = adds / (worth * gathered);
            if (roulette.next_float() >= probability) return;
            connection.value /= probability;
            connection.chance = probability;
        }
        if (visible(scene, connection)) add(connection, how, s, t);
    };

    CameraSubpath<point_of<decltype(scene)>> path(ray, light_paths, merge_weights);
    const auto& z = path.vertex();
    for (;;) {
        if (!path.advance(scene)) {
            add(meet_environment(scene, path), Finding::environment_met, 0, z.edges + 1);
            return sum;
        }
        add(meet_light(scene, path), Finding::light_met, 0, z.edges + 1);
        if (z.edges == limits.max_depth) return sum;
        const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d(), on_light = sampler.next_2d();
        if (connectable(scene, z.point)) {
            // One number chooses the light and the lobe: they enter different terms of the sum.
            const Arrival at_z(z.point);
            try_connection(connect_to_light(scene, z, at_z, choices.x, on_light, merge_weights, limits.left_out),
                           Finding::light_sampled, 1, z.edges + 1);
            for (const auto& y : light_path) {
                if (limits.max_depth >= 0 && y.edges + 1 + z.edges > limits.max_depth) break;
                try_connection(connect(scene, y, z, at_z, merge_weights), Finding::connected, y.edges + 1, z.edges + 1);
            }
            const Rgb merged = at_vertex(z, at_z);
            tell(scene, Contributed{Finding::merged, 0, z.edges + 1, 1, merged});
            sum += merged;
        }
        if (!path.scatter(scene, direction, choices, limits.rr_depth)) return sum;
        if (limits.left_out.mirrored && z.edges == 1 && path.left_specularly()) return sum;
    }
}

}  // namespace lightswitch
