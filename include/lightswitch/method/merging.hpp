#pragma once

// Density estimation from light path vertices nearby: what photon mapping and vertex merging share.

#include <lightswitch/method/connection.hpp>

#include <algorithm>
#include <vector>

namespace lightswitch {

/// Light that has arrived at a surface, in render space.
struct Photon {
    Vec3 position;
    Vec3 from;  ///< unit, where the light came from
    Rgb power;  ///< as the shading normal has it: times the cosine to that normal, over the cosine to the true one
    int edges;  ///< segments of its path from the light
};

/// What a light path leaves at its vertex. Where layers decide by chance what is there, those that are left stand for
/// the others, too: the camera path that gathers them draws its own chance.
inline Photon photon_at(const auto& scene, const auto& y) {
    const float true_cosine = std::abs(dot(y.point.normal, y.point.wo));
    const float cosine = std::abs(dot(y.point.shading_normal, y.point.wo));
    const Rgb power = y.throughput * (cosine / true_cosine);
    return {y.point.position, y.point.wo, power / scene.presence(y.point), y.edges};
}

/// The BSDF between the light that a photon brought and the direction that the camera path came from, with its
/// densities.
[[gnu::always_inline]] inline Turn photon_turn(const auto& scene, const auto& at, const Arrival& arrival,
                                               const Photon& photon) {
    Turn result = turn<Transport::radiance>(scene, at, arrival, photon.from);
    // The photon brings its cosine along.
    const float cosine = std::abs(dot(at.shading_normal, photon.from));
    result.value = cosine > 0 ? result.value / cosine : Rgb(0);
    return result;
}

/// A photon that also knows what its path counts against other strategies. A copy of what merging needs of a
/// `PathVertex`, so that all of it is in one place of memory.
struct WeighedPhoton : Photon {
    double last, merges;  ///< as in `PartialWeights`
};

/// The radius within which light is gathered, one for the whole image. It shrinks from iteration to iteration, slowly
/// enough that noise vanishes and fast enough that bias does (Knaus and Zwicker, "Progressive Photon Mapping: A
/// Probabilistic Approach", 2011).
struct MergeRadius {
    /// Of the first iteration, in widths of a pixel where the camera sees the scene (median over the image).
    float pixels = 1;
    /// In (0, 1): the area falls as iterations^(alpha - 1), so bias does, and the variance as iterations^-alpha.
    float alpha = 2 / 3.f;

    /// In render space. `footprint` is as from `pixel_footprint`.
    float at(std::uint64_t iteration, double footprint) const {
        return static_cast<float>(pixels * footprint * std::pow(double(iteration + 1), (double(alpha) - 1) / 2));
    }
};

/// The width of a pixel where the camera sees the scene, in render space: the median over a grid of rays. If they meet
/// nothing, what a pixel would be that had the scene's size as its share.
double pixel_footprint(const auto& scene) {
    constexpr int side = 64;
    const auto& camera = connectable_camera(scene.camera());
    std::vector<double> widths;
    for (int i = 0; i < side * side; ++i) {
        const Vec2 at((static_cast<float>(i % side) + 0.5f) / side, (static_cast<float>(i / side) + 0.5f) / side);
        const Ray ray = camera.ray(at * Vec2(camera.width(), camera.height()), Vec2(0.5f));
        if (const auto hit = scene.intersect(ray))
            widths.push_back(1 / std::sqrt(camera.density(hit->position, ray.direction)));
    }
    if (widths.empty()) return 2.0 / std::max(camera.width(), camera.height());
    const auto middle = widths.begin() + std::ptrdiff_t(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    return *middle;
}

/// How merging within that radius weighs against connecting, and 0 for a radius of 0, which means no merging.
inline MergeWeights merge_weights(double light_paths, double radius) {
    if (!(radius > 0)) return {};
    const double merges = light_paths * double(pi) * radius * radius;
    return {.merges = merges, .merge = heuristic(merges), .connect = heuristic(1 / merges)};
}

/// The photon `y`, taken as if it had arrived at the vertex `z` of a camera path; to be summed over all within the
/// radius.
[[gnu::always_inline]] inline Contribution merge(const auto& scene, const WeighedPhoton& y, const auto& z,
                                                 const Arrival& at_z, const MergeWeights& weights) {
    const Turn at = photon_turn(scene, z.point, at_z, y);
    if (is_black(at.value)) return {};
    const double fewer = y.last * weights.connect + y.merges * heuristic(at.pdf);
    const double more = z.weights.last * weights.connect + z.weights.merges * heuristic(at.reverse_pdf);
    return {z.throughput * at.value * y.power * static_cast<float>(1 / weights.merges), strategy_weight(fewer, more)};
}

}  // namespace lightswitch
