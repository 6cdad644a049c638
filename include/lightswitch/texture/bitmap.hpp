#pragma once

// Pictures that surfaces wear: texels kept as small as they were stored, and their look-up.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/film/tonemap.hpp>
#include <lightswitch/texture/half.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lightswitch {

/// What lies between the centres of texels: a bilinear blend of the four around, or the texel itself.
enum class TextureFilter { bilinear, nearest };

/// What lies outside of the unit square: the picture again, its mirror image, or the texels at its edge.
enum class TextureWrap { repeat, mirror, clamp };

/// How a texture is looked up.
struct TextureLookup {
    TextureFilter filter = TextureFilter::bilinear;
    TextureWrap wrap = TextureWrap::repeat;
};

/// What 8-bit texels mean: the value of the sRGB curve, or the value itself as a fraction of 255.
enum class TexelEncoding { srgb, linear };

namespace detail {

/// What the 256 bytes stand for, as floats.
inline const float* byte_values(TexelEncoding encoding) {
    static const auto tables = [] {
        std::array<std::array<float, 256>, 2> both{};
        for (std::size_t i = 0; i < 256; ++i) {
            both[0][i] = static_cast<float>(i) / 255;
            both[1][i] = srgb_decode(both[0][i]);
        }
        return both;
    }();
    return tables[encoding == TexelEncoding::srgb ? 1 : 0].data();
}

}  // namespace detail

/// A rectangle of texels, looked up as linear RGB at uv coordinates.
///
/// Conventions are those of Mitsuba 3: uv = (0, 0) is the *upper left* corner of the picture, u grows to the right and
/// v *downwards*, in the order in which image files are stored: nothing is flipped. (Loaders of meshes whose v grows
/// upwards, such as OBJ, turn it over.) The texel in column x and row y covers [x, x + 1) / width and
/// [y, y + 1) / height; its centre is at half integers. sRGB is decoded texel by texel, before blending.
///
/// Any uv gives a finite blend of texels, also infinities and NaN, for which it is unspecified which; beyond 2^30
/// texels from the origin all coordinates of an axis are the same. Copying copies the texels; reading from several
/// threads is safe.
class Bitmap {
public:
    /// One or three numbers per texel, row by row from the top.
    using Texels = std::variant<std::vector<std::uint8_t>, std::vector<Half>, std::vector<float>>;

    /// `width` x `height` texels, grey or RGB as the number of values says. Throws `Error` for a size that is no
    /// image's (see `Image::check_size`), another number of values, and sRGB that is not in bytes.
    Bitmap(int width, int height, Texels texels, TexelEncoding encoding, TextureLookup lookup = {})
        : width_(width), height_(height), lookup_(lookup), texels_(std::move(texels)) {
        Image::check_size(width, height);
        const auto area = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        const std::size_t count = std::visit([](const auto& values) { return values.size(); }, texels_);
        if (count != area && count != 3 * area)
            throw Error("a bitmap of " + std::to_string(width) + " x " + std::to_string(height) +
                        " texels needs one or three values per texel, not " + std::to_string(count) + " altogether");
        if (encoding == TexelEncoding::srgb && !std::holds_alternative<std::vector<std::uint8_t>>(texels_))
            throw Error("only bitmaps of 8 bits can be encoded in sRGB; decode the values first");
        grey_ = count == area;
        byte_values_ = detail::byte_values(encoding);
        summarize();
    }

    int width() const { return width_; }
    int height() const { return height_; }
    /// 1 (grey) or 3.
    int channels() const { return grey_ ? 1 : 3; }
    /// Memory that the texels take.
    std::size_t bytes() const {
        return std::visit([](const auto& values) { return values.size() * sizeof values[0]; }, texels_);
    }

    /// Linear RGB at `uv`.
    Rgb at(const Vec2& uv) const {
        return with_texels([&](const auto* texels) {
            if (lookup_.filter == TextureFilter::nearest) {
                const int x = floor(uv.x * static_cast<float>(width_));
                const int y = floor(uv.y * static_cast<float>(height_));
                return fetch(texels, wrapped(x, width_), wrapped(y, height_));
            }
            const Pair x = around(uv.x, width_), y = around(uv.y, height_);
            const Rgb upper = blend(fetch(texels, x.first, y.first), fetch(texels, x.second, y.first), x.weight);
            const Rgb lower = blend(fetch(texels, x.first, y.second), fetch(texels, x.second, y.second), x.weight);
            return blend(upper, lower, y.weight);
        });
    }

    /// How fast the luminance grows with u and v, of the bilinear blend, whatever the filter, when the texels are
    /// multiplied by `factor`.
    Vec2 gradient(const Vec2& uv, const Rgb& factor = Rgb(1)) const {
        return with_texels([&](const auto* texels) {
            const Pair x = around(uv.x, width_), y = around(uv.y, height_);
            const auto value = [&](int column, int row) { return luminance(factor * fetch(texels, column, row)); };
            const float a = value(x.first, y.first), b = value(x.second, y.first), c = value(x.first, y.second),
                        d = value(x.second, y.second);
            const float along_u = (b - a) + y.weight * ((d - c) - (b - a));
            const float along_v = (c - a) + x.weight * ((d - b) - (c - a));
            return Vec2(along_u * static_cast<float>(width_), along_v * static_cast<float>(height_));
        });
    }

    /// Linear RGB of the texel in column `x` (from the left) and row `y` (from the top); unchecked.
    Rgb texel(int x, int y) const {
        return with_texels([&](const auto* texels) { return fetch(texels, x, y); });
    }

    /// Mean of all texels, linear: the mean of look-ups over the unit square, whatever the filter and the wrap.
    const Rgb& mean() const { return mean_; }
    /// Least and greatest value of each channel. Look-ups leave this range by rounding at most.
    const Rgb& least() const { return least_; }
    const Rgb& most() const { return most_; }

    /// Says that a texel is infinite or NaN, and which; an empty string when all are finite.
    std::string problem() const {
        if (is_finite(mean_)) return {};  // one that is not finite makes the mean so
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                if (!is_finite(texel(x, y)))
                    return "the texel in column " + std::to_string(x) + " and row " + std::to_string(y) +
                           " of the texture is not a finite number";
        return {};
    }

private:
    /// Two neighbouring texels of an axis, and how much of the second is seen.
    struct Pair {
        int first, second;
        float weight;
    };

    // Not std::visit, which may call through a table of functions: look-ups are made for every vertex of a path.
    template <class F>
    std::invoke_result_t<const F&, const float*> with_texels(const F& f) const {
        if (const auto* bytes = std::get_if<0>(&texels_)) return f(bytes->data());
        if (const auto* halves = std::get_if<1>(&texels_)) return f(halves->data());
        return f(std::get_if<2>(&texels_)->data());
    }

    float decoded(std::uint8_t value) const { return byte_values_[value]; }
    float decoded(Half value) const { return static_cast<float>(value); }
    float decoded(float value) const { return value; }

    template <class T>
    Rgb fetch(const T* texels, int x, int y) const {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        if (grey_) return Rgb(decoded(texels[i]));
        return {decoded(texels[3 * i]), decoded(texels[3 * i + 1]), decoded(texels[3 * i + 2])};
    }

    /// `a` itself where both are equal: a uniform bitmap has one value everywhere.
    static Rgb blend(const Rgb& a, const Rgb& b, float weight) { return a + weight * (b - a); }

    static float limited(float position) {
        constexpr float limit = 0x1p30f;
        position = position > -limit ? position : -limit;  // so written, a NaN becomes a number
        return position < limit ? position : limit;
    }
    static int floor(float position) {
        const float inside = limited(position);
        const int truncated = static_cast<int>(inside);
        return truncated - (static_cast<float>(truncated) > inside ? 1 : 0);
    }

    Pair around(float u, int size) const {
        const float position = limited(u * static_cast<float>(size) - 0.5f);
        const int first = floor(position);
        return {wrapped(first, size), wrapped(first + 1, size), position - static_cast<float>(first)};
    }

    /// The index in [0, size) that stands for any other one.
    int wrapped(int i, int size) const {
        if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) [[likely]]
            return i;
        if (lookup_.wrap == TextureWrap::clamp) return i < 0 ? 0 : size - 1;
        const int period = lookup_.wrap == TextureWrap::mirror ? 2 * size : size;
        const int rest = i % period;
        const int inside = rest < 0 ? rest + period : rest;
        return inside < size ? inside : period - 1 - inside;
    }

    void summarize() {
        DVec3 sum(0);
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const Rgb value = texel(x, y);
                sum += DVec3(value);
                least_ = glm::min(least_, value);
                most_ = glm::max(most_, value);
            }
        mean_ = Rgb(sum / (static_cast<double>(width_) * static_cast<double>(height_)));
    }

    int width_, height_;
    TextureLookup lookup_;
    Texels texels_;
    bool grey_ = false;
    const float* byte_values_ = nullptr;  ///< what bytes mean
    Rgb mean_{0}, least_{std::numeric_limits<float>::infinity()}, most_{-std::numeric_limits<float>::infinity()};
};

/// How many bits a bitmap made from floats keeps of each.
enum class TexelPrecision { float32, half };

/// The image as a bitmap, of one channel when red, green and blue are the same everywhere. Throws `Error` for an empty
/// image, and when a finite value exceeds 65504, the largest `half`.
inline Bitmap make_bitmap(const Image& image, TexelPrecision precision = TexelPrecision::float32,
                          TextureLookup lookup = {}) {
    const std::vector<Rgb>& pixels = image.pixels();
    const bool grey = std::all_of(pixels.begin(), pixels.end(), [](const Rgb& c) { return c.x == c.y && c.y == c.z; });
    const auto collect = [&](auto values) -> Bitmap {
        using Value = typename decltype(values)::value_type;
        values.reserve(pixels.size() * (grey ? 1 : 3));
        for (const Rgb& pixel : pixels)
            for (int c = 0; c < (grey ? 1 : 3); ++c) {
                values.push_back(Value(pixel[c]));
                if (is_finite(pixel[c]) && !is_finite(static_cast<float>(values.back())))
                    throw Error("has a value of " + number_text(static_cast<double>(pixel[c])) +
                                ", beyond the 65504 that 16 bits hold; keep 32 bits");
            }
        return Bitmap(image.width(), image.height(), std::move(values), TexelEncoding::linear, lookup);
    };
    if (precision == TexelPrecision::half) return collect(std::vector<Half>());
    return collect(std::vector<float>());
}

}  // namespace lightswitch
