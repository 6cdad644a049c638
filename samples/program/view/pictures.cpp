#include "pictures.hpp"

#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/compare/flip_color.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lightswitch::program {
namespace {

/// `to_srgb8` by a table, as a window does it many times a second: the code at the begin of a small cell, from which
/// the exact one is few steps away.
class SrgbCodes {
public:
    SrgbCodes() {
        for (int i = 0; i <= cells; ++i) first_[static_cast<std::size_t>(i)] = exact(float(i) / cells);
        // The smallest number of each code.
        for (int code = 1; code < 256; ++code) {
            std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(1.0f);
            while (low < high) {
                const std::uint32_t middle = low + (high - low) / 2;
                if (exact(std::bit_cast<float>(middle)) >= code) high = middle;
                else low = middle + 1;
            }
            begin_[static_cast<std::size_t>(code)] = std::bit_cast<float>(low);
        }
        begin_[256] = 2;
    }

    /// Of a number in [0, 1].
    std::uint8_t operator()(float linear) const {
        std::size_t code = first_[static_cast<std::size_t>(linear * cells)];
        while (linear >= begin_[code + 1]) ++code;
        return static_cast<std::uint8_t>(code);
    }

private:
    static constexpr int cells = 4096;
    static std::uint8_t exact(float linear) { return to_srgb8(Rgb(linear)).front(); }

    std::array<std::uint8_t, cells + 1> first_{};
    std::array<float, 257> begin_{};
};

template <class Color>
Picture paint(const Image& image, const Color& color) {
    static const SrgbCodes code;
    Picture picture{image.width(), image.height(), std::vector<std::uint8_t>(4 * image.pixels().size())};
    std::uint8_t* out = picture.rgba.data();
    for (const Rgb& pixel : image.pixels()) {
        const Rgb linear = color(pixel);
        for (int c = 0; c < 3; ++c) *out++ = code(linear[c]);
        *out++ = 255;
    }
    return picture;
}

Rgb one_channel(const Rgb& pixel, Channel channel) {
    switch (channel) {
        case Channel::red: return Rgb(pixel.x);
        case Channel::green: return Rgb(pixel.y);
        case Channel::blue: return Rgb(pixel.z);
        case Channel::luminance: return Rgb(luminance(pixel));
        case Channel::all: break;
    }
    return pixel;
}

}  // namespace

std::string_view name(ToneCurve curve) { return curve == ToneCurve::clamp ? "clamp" : "filmic"; }

std::string_view name(Channel channel) {
    constexpr std::string_view names[] = {"all channels", "red", "green", "blue", "luminance"};
    return names[static_cast<int>(channel)];
}

Picture picture_of(const Image& image, const Display& display) {
    if (display.curve == ToneCurve::clamp)
        return paint(image,
                     [&](const Rgb& pixel) { return expose(one_channel(pixel, display.channel), display.stops); });
    const float scale = std::exp2(display.stops);
    return paint(image, [&](const Rgb& pixel) {
        const Rgb value = one_channel(pixel, display.channel);
        if (is_nan(value.x) || is_nan(value.y) || is_nan(value.z)) return not_a_number_color;
        Rgb mapped;
        for (int c = 0; c < 3; ++c)
            mapped[c] = std::clamp(detail::flip::aces(std::clamp(value[c] * scale, 0.0f, 1e4f)), 0.0f, 1.0f);
        return mapped;
    });
}

Image difference_of(Difference difference, const Snapshot& a, const Snapshot& b) {
    Image result(a.image.width(), a.image.height());
    const DVec3 mean = b.image.mean();
    const float floor = static_cast<float>((mean.x + mean.y + mean.z) / 300);
    for (std::size_t i = 0; i < result.pixels().size(); ++i) {
        const Rgb d = a.image.pixels()[i] - b.image.pixels()[i];
        Rgb& value = result.pixels()[i];
        if (difference == Difference::absolute) {
            value = d;
        } else if (difference == Difference::relative) {
            for (int c = 0; c < 3; ++c) {
                const float scale = std::abs(b.image.pixels()[i][c]) + floor;
                value[c] = scale > 0 ? d[c] / scale : d[c];
            }
        } else {
            const Rgb variance = a.variance.pixels()[i] + b.variance.pixels()[i];
            for (int c = 0; c < 3; ++c) {
                const float z = variance[c] > 0 ? d[c] / std::sqrt(variance[c]) : 0;
                value[c] = std::abs(z) >= least_significance ? z : 0;
            }
        }
    }
    return result;
}

float scale_of(Difference difference, const Image& numbers) {
    if (difference == Difference::significance) return 2 * least_significance;
    return detail::round_up(detail::magnitude_percentile(numbers, 99));
}

Picture picture_of_numbers(const Image& numbers, float scale) {
    const FalseColorOptions options{.scale = scale};
    return paint(numbers,
                 [&](const Rgb& value) { return detail::map_color(detail::dominant_channel(value), scale, options); });
}

std::string_view legend_of(Difference difference) {
    constexpr std::string_view legends[] = {"difference, W/(m2 sr)", "relative difference",
                                            "standard errors; below 4 hidden"};
    return legends[static_cast<int>(difference)];
}

Picture picture_of_output(std::string_view output, const Image& values) {
    if (output == "normal")
        return paint(values, [](const Rgb& n) { return glm::clamp(0.5f * (n + 1.0f), 0.0f, 1.0f); });
    if (output != "depth") return paint(values, [](const Rgb& value) { return glm::clamp(value, 0.0f, 1.0f); });
    float near = std::numeric_limits<float>::infinity(), far = 0;
    for (const Rgb& depth : values.pixels())
        if (depth.x > 0) {
            near = std::min(near, depth.x);
            far = std::max(far, depth.x);
        }
    return paint(values, [&](const Rgb& depth) {
        return depth.x > 0 ? Rgb(far > near ? 1 - 0.9f * (depth.x - near) / (far - near) : 1) : Rgb(0);
    });
}

}  // namespace lightswitch::program
