#pragma once

// From images and their noise to what a window shows: 8-bit colours.

#include <lightswitch/film/image.hpp>
#include <lightswitch/render/interactive.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::program {

/// Red, green, blue, alpha for each pixel, row by row from the top.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

enum class ToneCurve { clamp, filmic };
enum class Channel { all, red, green, blue, luminance };

/// How radiance becomes colours.
struct Display {
    float stops = 0;
    ToneCurve curve = ToneCurve::clamp;
    Channel channel = Channel::all;

    friend bool operator==(const Display&, const Display&) = default;
};

std::string_view name(ToneCurve curve);
std::string_view name(Channel channel);

/// Radiance as it is seen: with `ToneCurve::clamp` and all channels, what a .png of it would hold.
Picture picture_of(const Image& image, const Display& display);

/// How two images differ.
enum class Difference {
    absolute,      ///< a - b
    relative,      ///< (a - b) / (|b| + a hundredth of b's mean)
    significance,  ///< (a - b) in standard errors, by both films' variances; 0 below 4 of them
};
inline constexpr float least_significance = 4;
/// Fewer iterations do not tell how much an image scatters.
inline constexpr std::uint64_t least_iterations = 16;

/// The signed numbers that `difference` means. Of one size.
Image difference_of(Difference difference, const Snapshot& a, const Snapshot& b);
/// The scale at the ends of the false colours of such numbers: round.
float scale_of(Difference difference, const Image& numbers);
/// In the library's false colours, of which -`scale` and `scale` are the ends.
Picture picture_of_numbers(const Image& numbers, float scale);
std::string_view legend_of(Difference difference);

/// The names that lengths, normals and albedo are drawn by: albedo as a colour, normals as (n + 1) / 2, depths from
/// near, white, to far, black.
Picture picture_of_output(std::string_view output, const Image& values);

}  // namespace lightswitch::program
