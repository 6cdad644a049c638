#pragma once

// Short renders by several methods, from which one is chosen.

#include <lightswitch/sweep/contender.hpp>
#include <lightswitch/sweep/image_moments.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// A few independent images of one method.
struct Pilot {
    std::size_t contender = 0;  ///< its place in the list
    ImageMoments images;
    double seconds = 0;  ///< of each image, on average
};

/// Whether some other pilot shows light that this one does not: in a tile of 4 x 4 it is darker by more than four
/// standard deviations. Such a method has yet to find the paths that carry most of the light there, and the spread of
/// its images says nothing.
inline bool lacks_light(const Pilot& pilot, std::span<const Pilot> others) {
    return std::any_of(others.begin(), others.end(), [&](const Pilot& other) {
        return largest_of_tiles(4, [&](int x, int y) {
                   return deviations(TileSum(other.images, 4, x, y), TileSum(pilot.images, 4, x, y));
               }) > 4;
    });
}

/// What errors are to be relative to when there is no reference yet: the brightness near each pixel, from all pilots
/// that lack no light, with weights in inverse proportion to their variances.
inline Image common_scale(std::span<const Pilot> pilots) {
    const Image any = pilots[0].images.mean();
    std::vector<DVec3> sum(any.pixels().size(), DVec3(0));
    double weights = 0;
    for (const Pilot& p : pilots) {
        if (lacks_light(p, pilots)) continue;
        const double weight = 1 / (p.images.mean_variance() + 1e-12);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * p.images.mean(i);
        weights += weight;
    }
    Image mean = any;
    if (weights > 0)
        for (std::size_t i = 0; i < sum.size(); ++i) mean.pixels()[i] = Rgb(sum[i] / weights);
    return blurred(mean);
}

/// The places of the pilots in the order of their inefficiency (variance, relative to what all see, times seconds),
/// the best first; those that lack light come last.
inline std::vector<std::size_t> by_inefficiency(std::span<const Pilot> pilots) {
    const Image scale = common_scale(pilots);
    std::vector<bool> dark;
    for (const Pilot& p : pilots) dark.push_back(lacks_light(p, pilots));
    std::vector<double> inefficiency;
    std::vector<std::size_t> order;
    for (const Pilot& p : pilots) {
        inefficiency.push_back(p.images.relative_variance(scale) * p.seconds);
        order.push_back(order.size());
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(bool(dark[a]), inefficiency[a]) < std::pair(bool(dark[b]), inefficiency[b]);
    });
    return order;
}

/// Which contenders a reference may be made of: unbiased, and of these the ones that miss the fewest classes of paths
/// that the scene may hold.
inline std::vector<std::size_t> reference_candidates(std::span<const Contender> contenders) {
    const auto misses = [](const PathClasses& m) {
        return 8 * m.dirac_light + 4 * m.mirrored + 2 * m.dirac_caustic + m.mirrored_dirac_caustic;
    };
    int fewest = 16;
    for (const Contender& c : contenders)
        if (c.kind == Kind::unbiased) fewest = std::min(fewest, misses(c.missing));
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < contenders.size(); ++i)
        if (contenders[i].kind == Kind::unbiased && misses(contenders[i].missing) == fewest) candidates.push_back(i);
    return candidates;
}

}  // namespace lightswitch::detail
