#pragma once

// Numbers as colours, with the legend that makes them numbers again.

#include <lightswitch/compare/label.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace lightswitch {

/// How `false_color` draws.
struct FalseColorOptions {
    /// `diverging` shows the sign: blue below 0, white at 0, red above. `sequential` shows the magnitude: dark violet
    /// at 0 to yellow.
    enum class Map { diverging, sequential };

    Map map = Map::diverging;
    float scale = 0;          ///< the value at the end of the map; 0 takes it from `percentile`, and rounds it up
    float percentile = 99;    ///< of the pixels' magnitudes, in (0, 100]: larger values are clamped
    bool black_zero = false;  ///< a diverging map through black instead of white
    bool legend = true;       ///< a colour bar with numbers below the picture
    std::string caption{};    ///< what the numbers are, written below the bar (ASCII)
    int letter_size = 0;      ///< pixels per dot of the legend's letters; 0 chooses by the width of the picture
};

namespace detail {

/// Linear RGB of a colour in Oklab, clamped to the gamut (Ottosson 2020, "A perceptual color space for image
/// processing"): equal steps in it look about equal.
inline Rgb from_oklab(float lightness, float a, float b) {
    const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    return glm::clamp(Rgb(4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
                          -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
                          -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3),
                      0.0f, 1.0f);
}

inline Rgb from_oklch(float lightness, float chroma, float hue_degrees) {
    const float hue = hue_degrees * pi / 180;
    return from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

/// Colour of `t` in [-1,1]: lightness and chroma change linearly with |t|, the sign chooses the hue.
inline Rgb diverging_color(float t, bool black_zero) {
    const float magnitude = std::abs(t), hue = t < 0 ? 262.0f : 27.0f;
    const float lightness = black_zero ? 0.72f * magnitude : 0.98f - 0.5f * magnitude;
    return from_oklch(lightness, 0.19f * magnitude, hue);
}

/// Colour of `t` in [0,1]: lightness rises linearly while the hue turns from violet through green to yellow.
inline Rgb sequential_color(float t) { return from_oklch(0.22f + 0.70f * t, 0.10f + 0.07f * t * t, 310 - 205 * t); }

/// The channel of largest magnitude, with its sign, so that errors of opposite sign in two channels do not cancel.
inline float dominant_channel(const Rgb& p) {
    float value = p.x;
    for (int c = 0; c < 3; ++c) {
        if (is_nan(p[c])) return p[c];
        if (std::abs(p[c]) > std::abs(value)) value = p[c];
    }
    return value;
}

/// The given percentile of the magnitudes that are finite; 1 when there is none above 0.
inline float magnitude_percentile(const Image& image, float percentile) {
    std::vector<float> magnitudes;
    magnitudes.reserve(image.pixels().size());
    for (const Rgb& p : image.pixels())
        if (const float value = dominant_channel(p); is_finite(value)) magnitudes.push_back(std::abs(value));
    if (magnitudes.empty()) return 1;
    const auto last = static_cast<double>(magnitudes.size() - 1);
    const auto rank = magnitudes.begin() + static_cast<std::ptrdiff_t>(std::ceil(last * percentile / 100));
    std::nth_element(magnitudes.begin(), rank, magnitudes.end());
    // Nearly every pixel may be exact: then the few others set the scale.
    const float value = *rank > 0 ? *rank : *std::max_element(magnitudes.begin(), magnitudes.end());
    return value > 0 ? value : 1;
}

inline Rgb map_color(float value, float scale, const FalseColorOptions& options) {
    if (is_nan(value)) return not_a_number_color;
    const float t = std::clamp(value / scale, -1.0f, 1.0f);
    return options.map == FalseColorOptions::Map::diverging ? diverging_color(t, options.black_zero)
                                                            : sequential_color(std::abs(t));
}

/// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8 and 10, times a power of ten, that is not below a positive `value`: its
/// half and its quarters are round, too.
inline float round_up(float value) {
    const double power = std::pow(10, std::floor(std::log10(static_cast<double>(value))));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (const auto round = static_cast<float>(digit * power); value <= round) return round;
    return static_cast<float>(10 * power);
}

/// A colour bar with tick labels and a caption, `width` pixels wide, or more where the labels need it.
inline Image legend(int width, float scale, const FalseColorOptions& options) {
    const bool diverging = options.map == FalseColorOptions::Map::diverging;
    const int dot = options.letter_size > 0 ? options.letter_size : std::max(1, width / 250);
    const int margin = 6 * dot, bar = 10 * dot, line = 10 * dot;
    const int steps = width >= 240 * dot ? 4 : 2;

    std::vector<std::string> labels;
    int widest = 0;
    for (int i = 0; i <= steps; ++i) {
        const float at = static_cast<float>(i) / static_cast<float>(steps);
        std::array<char, 24> text{};
        std::snprintf(text.data(), text.size(), "%.3g", static_cast<double>(scale * (diverging ? 2 * at - 1 : at)));
        labels.emplace_back(text.data());
        widest = std::max(widest, text_width(labels.back(), dot));
    }
    width = std::max(
        {width, steps * (widest + 3 * dot) + widest + 2 * margin, text_width(options.caption, dot) + 2 * margin});
    const int bar_left = margin + widest / 2, bar_width = width - 2 * bar_left;
    Image image(width, 2 * margin + bar + line + (options.caption.empty() ? 0 : line + dot));
    const Rgb paper = srgb(255, 255, 255), ink = srgb(20, 20, 20);
    fill_rectangle(image, 0, 0, image.width(), image.height(), paper);

    fill_rectangle(image, bar_left - 1, margin - 1, bar_width + 2, bar + 2, ink);
    for (int x = 0; x < bar_width; ++x) {
        const float at = static_cast<float>(x) / static_cast<float>(bar_width - 1);
        fill_rectangle(image, bar_left + x, margin, 1, bar, map_color(diverging ? 2 * at - 1 : at, 1, options));
    }
    for (int i = 0; i <= steps; ++i) {
        const std::string& label = labels[static_cast<std::size_t>(i)];
        const int x = bar_left + i * (bar_width - 1) / steps;
        fill_rectangle(image, x, margin + bar, dot, 2 * dot + 1, ink);
        draw_text(image, x - text_width(label, dot) / 2, margin + bar + 3 * dot + 1, label, ink, dot);
    }
    draw_text(image, (width - text_width(options.caption, dot)) / 2, margin + bar + 3 * dot + line + 2, options.caption,
              ink, dot);
    return image;
}

/// `picture` with its legend below.
inline Image with_legend(const Image& picture, float scale, const FalseColorOptions& options) {
    const Image below = legend(picture.width(), scale, options);
    Image image(below.width(), picture.height() + below.height());
    fill_rectangle(image, 0, 0, image.width(), image.height(), srgb(255, 255, 255));
    paste(image, (image.width() - picture.width()) / 2, 0, picture);
    paste(image, 0, picture.height(), below);
    return image;
}

inline void check(const FalseColorOptions& options) {
    if (!(options.percentile > 0 && options.percentile <= 100))
        throw Error("the percentile of a false colour scale must be above 0 and at most 100");
    if (!is_finite(options.scale) || options.scale < 0)
        throw Error("the scale of false colours must be positive, or 0 to choose it from the image");
    if (options.letter_size < 0 || options.letter_size > 64)
        throw Error("the letters of a legend must have 1 to 64 pixels per dot, or 0 to choose it by the width");
}

}  // namespace detail

/// A picture of an image of numbers (a `difference`, say): each pixel's channel of largest magnitude through a colour
/// map that is uniform to the eye, symmetric about 0. NaN is magenta; infinities clamp to the ends.
///
/// The result is linear RGB like every image: saving it as PNG at exposure 0 gives the colours. Throws `Error` for
/// an empty image and for options out of their range.
inline Image false_color(const Image& values, const FalseColorOptions& options = {}) {
    if (values.empty()) throw Error("an image without pixels has no false colours");
    detail::check(options);
    const float scale =
        options.scale > 0 ? options.scale : detail::round_up(detail::magnitude_percentile(values, options.percentile));
    Image picture(values.width(), values.height());
    for (std::size_t i = 0; i < values.pixels().size(); ++i)
        picture.pixels()[i] = detail::map_color(detail::dominant_channel(values.pixels()[i]), scale, options);
    return options.legend ? detail::with_legend(picture, scale, options) : picture;
}

/// The legend of such pictures by itself, for a sheet of several that share `options.scale`: about `width` pixels wide.
/// Throws `Error` when the scale is not given, and for options out of their range.
inline Image color_bar(int width, const FalseColorOptions& options) {
    detail::check(options);
    if (!(options.scale > 0)) throw Error("a colour bar by itself needs a scale");
    Image::check_size(width, 1);
    return detail::legend(width, options.scale, options);
}

}  // namespace lightswitch
