#pragma once

// The loop over pixels, with one mistake.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/verify/estimator.hpp>

#include <memory>
#include <vector>

namespace lightswitch::test {

enum class PixelMistake {
    none,
    half_pixel,        ///< pixel centres at whole numbers: the image is shifted by half a pixel across and down
    neighbours_alike,  ///< two neighbouring pixels share a stream of random numbers
    corner_too_dark,   ///< 5 %, in one of 64 tiles
};

/// What `render` makes of a pixel method, without a filter of its own: a box of one pixel.
template <class SceneType, class M>
Image planted_pixels(const SceneType& scene, const M& method, PixelMistake mistake, const Estimator::Request& request) {
    const auto& camera = scene.camera();
    const int width = camera.width(), height = camera.height();
    std::vector<DVec3> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), DVec3(0));
    const TbbExecutor executor;
    int made = 0;
    for (; made < request.iterations && !request.stop.stop_requested(); ++made) {
        const IterationPoints points(Sampling::sobol, request.seed, static_cast<std::uint64_t>(made));
        executor.for_each(static_cast<std::size_t>(height), [&](std::size_t y) {
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
                const std::size_t pixel = y * static_cast<std::size_t>(width) + x;
                Sampler sampler(points, 0, mistake == PixelMistake::neighbours_alike ? pixel / 2 : pixel);
                Vec2 position = Vec2(static_cast<float>(x), static_cast<float>(y)) + sampler.next_2d();
                if (mistake == PixelMistake::half_pixel) position -= 0.5f;
                const Ray ray = camera.ray(position, camera.has_lens() ? sampler.next_2d() : Vec2(0.5f));
                sums[pixel] += DVec3(method.radiance(scene, ray, sampler));
            }
        });
    }
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const DVec3 sum =
                sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
            image(x, y) = Rgb(sum / double(std::max(made, 1)));
            if (mistake == PixelMistake::corner_too_dark && x >= width - width / 8 && y >= height - height / 8)
                image(x, y) *= 0.95f;
        }
    return image;
}

/// As `estimator`, with the mistake.
template <class SceneType, class M>
Estimator planted_estimator(std::shared_ptr<const SceneType> scene, const M& method, PixelMistake mistake) {
    Estimator result = estimator(scene, method);
    result.name = "planted-pixels";
    result.render = [scene, method, mistake](const Estimator::Request& request) {
        M limited = method;
        if (request.max_depth >= 0 && (method.max_depth < 0 || request.max_depth < method.max_depth))
            limited.max_depth = request.max_depth;
        return planted_pixels(*scene, limited, mistake, request);
    };
    return result;
}

}  // namespace lightswitch::test
