#pragma once

// From linear radiance to the 8-bit values of a screen.

#include <lightswitch/core/math.hpp>
#include <lightswitch/film/image.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace lightswitch {

/// The sRGB curve (IEC 61966-2-1): linear light in [0,1] to the encoded value in [0,1]. Not clamped.
inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// The inverse of `srgb_encode`.
inline float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// The linear RGB of an 8-bit sRGB colour: `srgb(255, 0, 255)` is magenta.
inline Rgb srgb(int red, int green, int blue) {
    const auto channel = [](int value) { return srgb_decode(static_cast<float>(value) / 255); };
    return {channel(red), channel(green), channel(blue)};
}

/// True for a NaN.
inline bool is_nan(float x) { return (std::bit_cast<std::uint32_t>(x) & 0x7fffffffu) > 0x7f800000u; }

/// What a picture shows where there is no number (NaN): magenta, which no tone mapped radiance should ever look like.
inline constexpr Rgb not_a_number_color{1, 0, 1};

/// Scales radiance by 2^`stops` and clamps each channel to [0,1]; still linear. A NaN in any channel gives
/// `not_a_number_color`; infinities clamp like any other value.
inline Rgb expose(const Rgb& radiance, float stops) {
    if (is_nan(radiance.x) || is_nan(radiance.y) || is_nan(radiance.z)) return not_a_number_color;
    const float scale = std::exp2(stops);
    const auto channel = [scale](float value) { return value > 0 ? std::min(value * scale, 1.0f) : 0.0f; };
    return {channel(radiance.x), channel(radiance.y), channel(radiance.z)};
}

/// Stops that make the image's middle brightness a middle grey: the geometric mean of the pixels' luminance becomes
/// 0.18 (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, section 3). Pixels that are black
/// or not finite do not count, nor do the darkest and the brightest percent of the others, which may be noise. To a
/// tenth of a stop, so that what a program prints says all of it; 0 for an image in which nothing counts.
float auto_exposure(const Image& image);

/// 8-bit sRGB of linear RGB in [0,1], rounded to the nearest.
inline std::array<std::uint8_t, 3> to_srgb8(const Rgb& linear) {
    const auto channel = [](float value) { return static_cast<std::uint8_t>(srgb_encode(value) * 255 + 0.5f); };
    return {channel(linear.x), channel(linear.y), channel(linear.z)};
}

/// The image as 8-bit sRGB, three bytes per pixel, row by row from the top: `expose`, the sRGB curve, rounding.
inline std::string tone_map(const Image& image, float stops) {
    std::string bytes;
    bytes.reserve(image.pixels().size() * 3);
    for (const Rgb& pixel : image.pixels())
        for (const std::uint8_t value : to_srgb8(expose(pixel, stops))) bytes += static_cast<char>(value);
    return bytes;
}

inline float auto_exposure(const Image& image) {
    std::vector<float> brightness;
    for (const Rgb& pixel : image.pixels())
        if (const float value = luminance(pixel); is_finite(pixel) && value > 0) brightness.push_back(std::log2(value));
    if (brightness.empty()) return 0;
    std::sort(brightness.begin(), brightness.end());
    const auto cut = static_cast<std::ptrdiff_t>(brightness.size() / 100);
    double sum = 0;
    for (auto value = brightness.begin() + cut; value != brightness.end() - cut; ++value) sum += *value;
    const double mean = sum / static_cast<double>(std::ssize(brightness) - 2 * cut);
    return static_cast<float>(std::round(10 * (std::log2(0.18) - mean)) / 10) + 0.0f;  // no -0
}

}  // namespace lightswitch
