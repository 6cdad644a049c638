#pragma once

// A colour that varies over a surface.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/texture/bitmap.hpp>
#include <lightswitch/texture/checkerboard.hpp>

#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace lightswitch {

/// An affine map of uv coordinates: the upper two rows of a 3 x 3 matrix M. (u, v) goes to the first two parts of
/// M (u, v, 1), as Mitsuba 3 applies `to_uv`: scaling by 2 makes a pattern half as large. The identity by default.
struct UvTransform {
    Vec3 u{1, 0, 0}, v{0, 1, 0};  ///< rows: factors of u and of v, and what is added

    Vec2 operator()(const Vec2& uv) const { return {u.x * uv.x + u.y * uv.y + u.z, v.x * uv.x + v.y * uv.y + v.z}; }
};

/// A pattern and where it lies on the surface. A value: copies share a bitmap. Look-ups call nothing through a pointer,
/// are safe for any uv, and may come from several threads.
class Texture {
public:
    explicit Texture(const Checkerboard& pattern, const UvTransform& to_uv = {}) : pattern_(pattern), to_uv_(to_uv) {}
    /// The same value everywhere.
    explicit Texture(const Rgb& value) : pattern_(Checkerboard{value, value}) {}
    /// Throws `Error` when there is no bitmap.
    explicit Texture(std::shared_ptr<const Bitmap> bitmap, const UvTransform& to_uv = {})
        : pattern_(std::move(bitmap)), to_uv_(to_uv) {
        if (!*std::get_if<SharedBitmap>(&pattern_)) throw Error("a texture needs a bitmap, but was given none");
    }
    explicit Texture(Bitmap bitmap, const UvTransform& to_uv = {})
        : Texture(std::make_shared<const Bitmap>(std::move(bitmap)), to_uv) {}

    /// The same with all values multiplied by `factor`, of any sign; the bitmap stays shared.
    Texture scaled(const Rgb& factor) const {
        Texture result = *this;
        result.factor_ *= factor;
        return result;
    }

    /// Linear RGB at the surface's `uv`.
    Rgb operator()(const Vec2& uv) const {
        const Vec2 position = to_uv_(uv);
        return factor_ * on_pattern([&](const auto& pattern) { return pattern.at(position); });
    }

    /// How fast the luminance grows with the surface's u and v. 0 everywhere on a checkerboard.
    Vec2 gradient(const Vec2& uv) const {
        const auto* bitmap = std::get_if<SharedBitmap>(&pattern_);
        if (!bitmap) return Vec2(0);
        const Vec2 slope = (*bitmap)->gradient(to_uv_(uv), factor_);
        return {slope.x * to_uv_.u.x + slope.y * to_uv_.v.x, slope.x * to_uv_.u.y + slope.y * to_uv_.v.y};
    }

    /// Mean over the pattern's own unit square, which is the mean over the surface when `to_uv` maps it onto whole
    /// copies of that.
    Rgb mean() const {
        return factor_ * on_pattern([](const auto& pattern) { return pattern.mean(); });
    }

    /// Bounds of what look-ups return, channel by channel; rounding in a bilinear blend may leave them by an ulp.
    Rgb least() const { return glm::min(factor_ * unscaled_least(), factor_ * unscaled_most()); }
    Rgb most() const { return glm::max(factor_ * unscaled_least(), factor_ * unscaled_most()); }

    /// Why the texture is impossible (values or a `to_uv` that are not finite), or an empty string.
    std::string problem() const {
        if (!is_finite(to_uv_.u) || !is_finite(to_uv_.v)) return "the texture's to_uv has a value that is not finite";
        if (!is_finite(factor_)) return "the texture's factor is not finite";
        if (const auto* bitmap = std::get_if<SharedBitmap>(&pattern_)) return (*bitmap)->problem();
        const Checkerboard& pattern = *std::get_if<Checkerboard>(&pattern_);
        if (!is_finite(pattern.color0) || !is_finite(pattern.color1))
            return "the checkerboard has a colour that is not finite";
        return {};
    }

private:
    using SharedBitmap = std::shared_ptr<const Bitmap>;

    Rgb unscaled_least() const {
        return on_pattern([](const auto& pattern) { return pattern.least(); });
    }
    Rgb unscaled_most() const {
        return on_pattern([](const auto& pattern) { return pattern.most(); });
    }

    // Not std::visit, which may call through a table of functions.
    template <class F>
    Rgb on_pattern(const F& f) const {
        if (const auto* bitmap = std::get_if<SharedBitmap>(&pattern_)) return f(**bitmap);
        return f(*std::get_if<Checkerboard>(&pattern_));
    }

    std::variant<Checkerboard, SharedBitmap> pattern_;
    UvTransform to_uv_;
    Rgb factor_{1};
};

}  // namespace lightswitch
