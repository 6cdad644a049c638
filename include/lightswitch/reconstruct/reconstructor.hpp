#pragma once

// What makes a better image of a noisy one: the concept of it, what goes in and what comes out.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/parallel.hpp>
#include <lightswitch/film/image.hpp>

#include <concepts>
#include <string>
#include <string_view>

namespace lightswitch {

/// Images without noise, or with little, that show where edges are: of `Albedo` (0 to 1) and `ShadingNormal` (-1 to 1).
/// Either may be empty.
struct Guides {
    Image albedo, normal;
};

/// What is to be reconstructed. All images that are not empty have the size of the first.
struct NoisyImage {
    const Image& image;     ///< radiance, finite
    const Image& variance;  ///< of its pixels, see `Film::variance`; empty: not known
    const Guides& guides;
};

/// A reconstructor has a `name` and makes one image of another, on the threads of the executor. The same result for any
/// number of them. Its expected image may be wrong in any way: `mix` finds out by the samples.
template <class R>
concept Reconstructor = requires(const R reconstructor, const NoisyImage& noisy, const TbbExecutor& executor) {
    { R::name } -> std::convertible_to<std::string_view>;
    { reconstructor.reconstruct(noisy, executor) } -> std::same_as<Image>;
};

namespace detail {

/// Throws `Error` unless `image` has the size of `first`, or is empty where it may be.
inline void check_same_size(const Image& image, const Image& first, const char* what, bool may_be_empty = false) {
    if (may_be_empty && image.empty()) return;
    if (image.width() != first.width() || image.height() != first.height())
        throw Error(std::string("the ") + what + " has " + std::to_string(image.width()) + " x " +
                    std::to_string(image.height()) + " pixels, but the image " + std::to_string(first.width()) + " x " +
                    std::to_string(first.height()));
}

/// Throws `Error` unless the parts fit together and all pixels are finite.
inline void check(const NoisyImage& noisy) {
    if (noisy.image.empty()) throw Error("an image without pixels cannot be reconstructed");
    check_same_size(noisy.variance, noisy.image, "variance", true);
    check_same_size(noisy.guides.albedo, noisy.image, "albedo", true);
    check_same_size(noisy.guides.normal, noisy.image, "image of normals", true);
    for (const Image* image : {&noisy.image, &noisy.variance, &noisy.guides.albedo, &noisy.guides.normal})
        if (const auto place = image->first_not_finite())
            throw Error("what is to be reconstructed is not finite in pixel (" + std::to_string(place->first) + ", " +
                        std::to_string(place->second) + ")");
}

/// The power of two by which the image is multiplied for its mean magnitude to be between 1 and 2; 1 for a black one.
/// Then no square overflows: no pixel is above the mean by more than the number of pixels.
inline double unit_scale(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels())
        sum += std::abs(double(pixel.x)) + std::abs(double(pixel.y)) + std::abs(double(pixel.z));
    return sum > 0 ? std::ldexp(1.0, -std::ilogb(sum / (3 * double(image.pixels().size())))) : 1;
}

/// Calls `work(row)` for every row of an image, some rows at a time.
void for_each_row(int height, const Executor auto& executor, const auto& work) {
    constexpr int rows = 8;
    executor.for_each(static_cast<std::size_t>((height + rows - 1) / rows), [&](std::size_t band) {
        const int begin = static_cast<int>(band) * rows;
        for (int y = begin; y < std::min(begin + rows, height); ++y) work(y);
    });
}

}  // namespace detail

}  // namespace lightswitch
