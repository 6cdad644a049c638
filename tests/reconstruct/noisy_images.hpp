#pragma once

// Images whose truth is known, with noise, and reconstructors that cheat.

#include <lightswitch/reconstruct/mix.hpp>

#include <random>
#include <string_view>

namespace lightswitch::test {

/// Edges, ramps, texture, dark parts and a lamp.
inline Image true_image(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float value = 0.2f + 0.6f * static_cast<float>(x) / static_cast<float>(width);
            if (y > height / 2) value *= 0.2f;
            if (x < width / 3 && (x + y) % 4 < 2) value *= 1.5f;
            if (x > width - 8 && y < 8) value = 15;
            image(x, y) = value * Rgb(1, 0.8f, 0.5f);
        }
    return image;
}

/// With log-normal noise whose standard deviation is that many times each pixel's value, or, where `tail` is above 1,
/// with values that are that many times too large once in as many pixels and else 0.
inline Image with_noise(const Image& truth, double relative, unsigned seed, double tail = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double sigma = std::sqrt(std::log1p(relative * relative));
    Image image = truth;
    for (Rgb& pixel : image.pixels())
        pixel *= static_cast<float>(tail > 1 ? (uniform(random) * tail < 1 ? tail : 0)
                                             : std::exp(sigma * normal(random) - sigma * sigma / 2));
    return image;
}

inline Image mean_of(const Image& a, const Image& b) {
    Image image = a;
    for (std::size_t i = 0; i < image.pixels().size(); ++i) image.pixels()[i] = 0.5f * (a.pixels()[i] + b.pixels()[i]);
    return image;
}

/// Reconstructors, or what pretends to be some. Where truth is known, `right` has a tenth of the noise.
enum class Cheat { right, blurs, clamps, same_image, black, identity, enormous, not_a_number };
inline constexpr Cheat all_cheats[] = {Cheat::right, Cheat::blurs,    Cheat::clamps,   Cheat::same_image,
                                       Cheat::black, Cheat::identity, Cheat::enormous, Cheat::not_a_number};
inline constexpr std::string_view cheat_names[] = {"right", "blurs",    "clamps",   "same image",
                                                   "black", "identity", "enormous", "not a number"};

inline Image cheat(Cheat which, const Image& image, const Image& truth) {
    Image result = image;
    const int width = image.width(), height = image.height();
    const Rgb mean(image.mean());
    switch (which) {
        case Cheat::right:
            for (std::size_t i = 0; i < result.pixels().size(); ++i)
                result.pixels()[i] = 0.9f * truth.pixels()[i] + 0.1f * image.pixels()[i];
            break;
        case Cheat::blurs:
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    Rgb sum(0);
                    for (int j = y - 4; j <= y + 4; ++j)
                        for (int i = x - 4; i <= x + 4; ++i)
                            sum += image(std::clamp(i, 0, width - 1), std::clamp(j, 0, height - 1));
                    result(x, y) = sum / 81.0f;
                }
            break;
        case Cheat::clamps:
            for (Rgb& pixel : result.pixels()) pixel = min(pixel, 0.5f * mean);
            break;
        case Cheat::same_image:
            for (std::size_t i = 0; i < result.pixels().size(); ++i)
                result.pixels()[i] = Rgb(0.3f + 0.2f * std::sin(0.05f * static_cast<float>(i % 997)));
            break;
        case Cheat::black:
            for (Rgb& pixel : result.pixels()) pixel = Rgb(0);
            break;
        case Cheat::identity: break;
        case Cheat::enormous:
            for (Rgb& pixel : result.pixels()) pixel = Rgb(1e30f);
            break;
        case Cheat::not_a_number:
            for (Rgb& pixel : result.pixels()) pixel = Rgb(std::numeric_limits<float>::quiet_NaN());
            break;
    }
    return result;
}

/// What `mix` makes of two noisy images and a reconstructor.
struct MixOfNoise {
    Image a, b, samples, denoised;
    Mixed mixed;

    MixOfNoise(const Image& truth, double relative_noise, Cheat which, unsigned seed, double tail = 1)
        : a(with_noise(truth, relative_noise, 2 * seed, tail)),
          b(with_noise(truth, relative_noise, 2 * seed + 1, tail)),
          samples(mean_of(a, b)),
          denoised(cheat(which, samples, truth)) {
        const Image of_a = cheat(which, a, truth), of_b = cheat(which, b, truth);
        mixed = mix({.a = a, .b = b, .denoised_a = of_a, .denoised_b = of_b, .denoised = denoised}, SerialExecutor{});
    }
};

}  // namespace lightswitch::test
