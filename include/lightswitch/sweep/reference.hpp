#pragma once

// What errors are measured against, and how good it is.

#include <lightswitch/sweep/contender.hpp>
#include <lightswitch/sweep/image_moments.hpp>

#include <span>
#include <string>
#include <vector>

namespace lightswitch {

/// An image that stands for the truth.
struct Reference {
    Image image;
    Image noise;        ///< the part of relMSE that its own variance is expected to make, by pixel and channel
    double relmse = 0;  ///< the mean of `noise`: its own error
    Estimate level;     ///< mean of the image over pixels and channels

    std::string first, second;  ///< the methods that made it; empty for an image that was given
    PathClasses missing = {};   ///< that they do not make
    double ratio = 1;           ///< mean of the first's part over that of the second
    double deviations = 0;      ///< between these means
    double worst_tile = 0;      ///< the same of 4 x 4 tiles, the largest: up to 3 is chance

    /// Whether its two parts have one expectation, as far as they tell.
    bool consistent() const { return worst_tile <= 4; }

    /// Its own error is not known; `sweep` finds out. Throws `Error` for an image that is not finite.
    static Reference given(Image image) {
        if (const auto at = image.first_not_finite())
            throw Error("the reference is not finite in pixel (" + std::to_string(at->first) + ", " +
                        std::to_string(at->second) + "): nothing can be measured against it");
        Reference result;
        result.noise = Image(image.width(), image.height());
        result.level = Estimate::exact(detail::sum_of(image.mean()) / 3);
        result.image = std::move(image);
        return result;
    }
};

/// Joins independent images of two methods that have the same expectation, with weights in inverse proportion to their
/// variances over the whole image. Throws `Error` for fewer than two of each, and unless all are comparable.
inline Reference join(std::span<const Image> first, std::span<const Image> second) {
    using namespace detail;
    ImageMoments parts[2];
    int k = 0;
    for (const auto& images : {first, second}) {
        if (images.size() < 2) throw Error("a reference is made of two images by each of its methods at least");
        for (const Image& image : images) {
            refuse_unless_comparable(first[0], image);
            parts[k].add(image);
        }
        ++k;
    }
    const ImageMoments &a = parts[0], &b = parts[1];
    const double error_a = a.relative_variance(a.mean()) / double(a.count());
    const double error_b = b.relative_variance(b.mean()) / double(b.count());
    const double share = error_a + error_b > 0 ? error_b / (error_a + error_b) : 0.5;
    const auto weighted = [](Estimate e, double w) {
        return Estimate{w * e.mean, w * w * e.variance, e.freedom, w * w * w * e.third, 0};
    };

    Reference result;
    result.image = result.noise = Image(a.width(), a.height());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const DVec3 r = share * a.mean(i) + (1 - share) * b.mean(i);
        const DVec3 variance = share * share * a.variance(i) / double(a.count()) +
                               (1 - share) * (1 - share) * b.variance(i) / double(b.count());
        result.image.pixels()[i] = Rgb(r);
        result.noise.pixels()[i] = Rgb(variance / (r * r + metric_offset));
    }
    result.relmse = sum_of(result.noise.mean()) / 3;
    result.level = weighted(a.level(), share) - weighted(b.level(), share - 1);
    result.ratio = a.level().mean / b.level().mean;
    const auto by_tile = [&](int n) {
        return [&a, &b, n](int x, int y) { return std::abs(deviations(TileSum(a, n, x, y), TileSum(b, n, x, y))); };
    };
    result.deviations = by_tile(1)(0, 0);
    result.worst_tile = largest_of_tiles(4, by_tile(4));
    for (const char* key : {"scene", "camera"})
        if (const auto found = first[0].metadata.find(key); found != first[0].metadata.end())
            result.image.metadata.insert(*found);
    return result;
}

/// Images of other seeds, as many as there are in `seeds`, each of so many seconds. Fewer when the run is stopped.
inline std::vector<Image> independent_images(const Contender& contender, Settings settings, TimeOf clock,
                                             double seconds, std::span<const std::uint64_t> seeds) {
    std::vector<Image> images;
    for (const std::uint64_t seed : seeds) {
        settings.seed = seed;
        detail::TimedSession session(contender, settings, clock);
        if (!session.advance_to(seconds)) break;
        images.push_back(session.session().image());
    }
    return images;
}

}  // namespace lightswitch
