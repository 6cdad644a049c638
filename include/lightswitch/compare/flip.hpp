#pragma once

// FLIP: how different two images look when one flips between them.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/flip_color.hpp>
#include <lightswitch/compare/flip_filter.hpp>
#include <lightswitch/core/parallel.hpp>
#include <lightswitch/film/image.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch {

/// The exposures at which `hdr_flip` compares: `count` of them, evenly from `start` to `stop`, in stops.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 1;
};

/// How FLIP looks at images.
struct FlipOptions {
    /// Of visual angle, in [1, 500]. The default is a display 3840 pixels and 0.7 m wide, seen from 0.7 m.
    double pixels_per_degree = 3840 * 3.14159265358979323846 / 180;
    std::optional<FlipExposures> exposures{};  ///< of `hdr_flip`; otherwise `flip_exposures` chooses them
    int threads = 0;                           ///< 0: as many as the machine has; the result does not depend on it
};

namespace detail::flip {

inline void refuse_non_finite(const Image& image, const std::string& name) {
    if (const auto at = image.first_not_finite())
        throw Error("FLIP needs finite pixels, but in the " + name + " the pixel in column " +
                    std::to_string(at->first) + ", row " + std::to_string(at->second) +
                    " (from 0, top left) is NaN or infinite: replace it first");
}

/// Throws unless the images show the same thing and have only finite pixels.
inline void refuse_unusable(const Image& image, const Image& reference) {
    refuse_unless_comparable(image, reference);
    refuse_non_finite(image, "image");
    refuse_non_finite(reference, "reference");
}

/// From the luminances of one image, or nothing when it is black.
inline std::optional<FlipExposures> exposures_of(const Image& image) {
    std::vector<double> luminances;
    luminances.reserve(image.pixels().size());
    for (const Rgb& p : image.pixels())
        luminances.push_back(glm::dot(glm::max(DVec3(p), 0.0), DVec3(0.2126, 0.7152, 0.0722)));
    const auto median = [&] {
        const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
        std::nth_element(luminances.begin(), middle, luminances.end());
        return *middle;
    };
    const double brightest = *std::max_element(luminances.begin(), luminances.end());
    if (!(brightest > 0)) return {};
    double typical = median();
    if (!(typical > 0)) {
        std::erase_if(luminances, [](double value) { return !(value > 0); });
        typical = median();
    }
    // The first exposure brings the brightest pixel to 0.85 on the display, the last one the median.
    const double exposed = inverse_aces(0.85);
    const int count = std::max(2, static_cast<int>(std::ceil(std::log2(brightest / typical))));
    return FlipExposures{std::log2(exposed / brightest), std::log2(exposed / typical), count};
}

/// FLIP of pixel `x` of a row, filtered down in both pictures: the more its edges or its points differ, the more
/// visible is the difference of its colours (Andersson et al. 2020).
inline float error(const ColorSpaces& colors, const std::vector<float>& a, const std::vector<float>& b,
                   std::size_t width, std::size_t x) {
    using Rows = FilteredRows;
    const auto color = [&](const std::vector<float>& row) {
        return Vec3(row[Rows::y * width + x], row[Rows::cx * width + x], row[Rows::cz * width + x]);
    };
    const auto contrast = [&](Rows::Result across, Rows::Result down) {
        const auto magnitude = [&](const std::vector<float>& row) {
            const float u = row[across * width + x], v = row[down * width + x];
            return std::sqrt(u * u + v * v);
        };
        return std::abs(magnitude(a) - magnitude(b)) / 116;  // Y of black and white differ by 116
    };
    const float strongest =
        std::max(contrast(Rows::edge_across, Rows::edge_down), contrast(Rows::point_across, Rows::point_down));
    const float feature = std::min(std::sqrt(strongest * std::sqrt(0.5f)), 1.0f);
    return std::pow(colors.difference(color(a), color(b)), 1 - feature);
}

/// The largest FLIP of all `displays`, functions from radiance to linear RGB in [0,1].
template <class Display>
Image largest_error(const Image& image, const Image& reference, const FlipOptions& options,
                    const std::vector<Display>& displays) {
    if (!(options.pixels_per_degree >= 1 && options.pixels_per_degree <= 500))
        throw Error("the pixels per degree of FLIP must be from 1 to 500");
    Image result = absolute_difference(image, reference);  // for its metadata: what both images have in common
    std::fill(result.pixels().begin(), result.pixels().end(), Rgb(0));
    const int width = image.width(), height = image.height();
    const Filters filters(options.pixels_per_degree);
    const ColorSpaces colors;

    constexpr int band = 64;  // rows: much more than the filters reach, so that little is filtered across twice
    const auto bands = static_cast<std::size_t>((height + band - 1) / band);
    TbbExecutor(options.threads).for_each(bands, [&](std::size_t index) {
        const int first = static_cast<int>(index) * band, last = std::min(first + band, height);
        std::vector<float> a, b;
        for (const Display& display : displays) {
            const auto filtered = [&](const Image& source) {
                return FilteredRows(width, height, first, last, filters,
                                    [&](int x, int y) { return colors.ycxcz(display(source(x, y))); });
            };
            const FilteredRows image_rows = filtered(image), reference_rows = filtered(reference);
            for (int y = first; y < last; ++y) {
                image_rows.filter_down(y, a);
                reference_rows.filter_down(y, b);
                for (int x = 0; x < width; ++x) {
                    const auto column = static_cast<std::size_t>(x);
                    result(x, y) = glm::max(result(x, y), error(colors, a, b, static_cast<std::size_t>(width), column));
                }
            }
        }
    });
    return result;
}

}  // namespace detail::flip

// All of these throw as `refuse_unless_comparable`, for options out of their range, and for pixels that are not finite,
// with the place of the first one. Negative radiance counts as 0.

/// The exposures that suit the reference: from the one that shows its brightest pixel to the one that shows its median
/// just below white, about one stop apart (Andersson et al. 2021). When more than half of it is black, the
/// median of the rest. For a black reference those of the image, and a single one at 0 stops when both are black.
inline FlipExposures flip_exposures(const Image& image, const Image& reference) {
    detail::flip::refuse_unusable(image, reference);
    if (const auto exposures = detail::flip::exposures_of(reference)) return *exposures;
    return detail::flip::exposures_of(image).value_or(FlipExposures{});
}

/// LDR-FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"): for each pixel how visible
/// the difference is, from 0 to 1, the same in all three channels. Symmetric in its images.
///
/// Both images are linear RGB, as always, and clamped to [0,1]: what a PNG at exposure 0 shows. (Implementations that
/// read sRGB files decode them to this first.)
inline Image ldr_flip(const Image& image, const Image& reference, const FlipOptions& options = {}) {
    detail::flip::refuse_unusable(image, reference);
    const auto display = [](const Rgb& radiance) { return glm::clamp(radiance, 0.0f, 1.0f); };
    return detail::flip::largest_error(image, reference, options, std::vector{display});
}

/// HDR-FLIP (Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images"): the largest LDR-FLIP
/// of each pixel over a range of exposures, each shown through the tone curve of ACES. The reference chooses them.
inline Image hdr_flip(const Image& image, const Image& reference, const FlipOptions& options = {}) {
    const FlipExposures chosen = flip_exposures(image, reference), range = options.exposures.value_or(chosen);
    if (!(range.start >= -300 && range.start <= range.stop && range.stop <= 300 && range.count >= 1 &&
          range.count <= 1000))
        throw Error(
            "the exposures of FLIP must be 1 to 1000, within -300 and 300 stops, and not stop before they start");
    const auto display_at = [](double stops) {
        return [scale = std::exp2(stops)](const Rgb& radiance) {
            // Far beyond white, and before a float overflows.
            const DVec3 exposed = glm::clamp(DVec3(radiance) * scale, 0.0, 100.0);
            const Rgb x(exposed);
            return Rgb(detail::flip::aces(x.x), detail::flip::aces(x.y), detail::flip::aces(x.z));
        };
    };
    std::vector<decltype(display_at(0))> displays;
    for (int i = 0; i < range.count; ++i) {
        const double at = range.count > 1 ? static_cast<double>(i) / (range.count - 1) : 0;
        displays.push_back(display_at(range.start + at * (range.stop - range.start)));
    }
    return detail::flip::largest_error(image, reference, options, displays);
}

/// Mean of `ldr_flip` over all pixels.
inline double mean_ldr_flip(const Image& image, const Image& reference, const FlipOptions& options = {}) {
    return ldr_flip(image, reference, options).mean().x;
}

/// Mean of `hdr_flip` over all pixels.
inline double mean_hdr_flip(const Image& image, const Image& reference, const FlipOptions& options = {}) {
    return hdr_flip(image, reference, options).mean().x;
}

}  // namespace lightswitch
