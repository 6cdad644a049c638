#pragma once

#include <lightswitch/light/triangle_light.hpp>
#include <lightswitch/texture/texture.hpp>

#include <array>
#include <memory>

namespace lightswitch {

/// A triangle whose radiance differs from place to place: `emission` times a texture. Sampled by area, like one that is
/// even.
struct TexturedTriangleLight : TriangleLight {
    std::array<Vec2, 3> uvs;  ///< of the corner, and where the edges from it end
    std::shared_ptr<const Texture> texture;

    TexturedTriangleLight(const TriangleLight& even, const std::array<Vec2, 3>& uvs_,
                          std::shared_ptr<const Texture> texture_)
        : TriangleLight(even), uvs(uvs_), texture(std::move(texture_)), mean_(find_mean()) {}

    /// Of the mean radiance; where that is small, of a part of the greatest, so that no bright texel is never chosen.
    double power() const {
        const double seen = double(luminance(mean_)), most = double(luminance(texture->most()));
        return TriangleLight::power() * (most > 0 ? std::max(seen, 0.02 * most) : 0.0);
    }
    LightBounds bounds() const {
        LightBounds result = TriangleLight::bounds();
        result.intensity = power() / double(pi);
        return result;
    }
    /// The largest radiance of any place.
    Rgb brightest() const { return emission * texture->most(); }
    /// The mean radiance, nearly.
    Rgb mean() const { return emission * mean_; }

    Rgb emitted(const SurfacePoint& at, const Vec3& direction) const {
        return TriangleLight::emitted(at, direction) * value_at(weights(at.position));
    }

    LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        LightSample result = TriangleLight::sample(from, u);
        if (result.pdf.value > 0) result.radiance *= value_at(uniform_triangle(u));
        return result;
    }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        LightEmission result = TriangleLight::emit(place, direction);
        result.weight *= value_at(uniform_triangle(place));
        return result;
    }

private:
    /// The weights of the second and third corner at a point of the triangle.
    Vec2 weights(const Vec3& point) const {
        const Vec3 offset_in_plane = point - corner;
        const Vec3 area = cross(edge1, edge2);
        const float inverse = 1 / length_squared(area);
        return {dot(cross(offset_in_plane, edge2), area) * inverse, dot(cross(edge1, offset_in_plane), area) * inverse};
    }
    Rgb value_at(const Vec2& b) const { return (*texture)((1 - b.x - b.y) * uvs[0] + b.x * uvs[1] + b.y * uvs[2]); }
    Rgb find_mean() const {
        constexpr int steps = 8;
        Rgb sum(0);
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j)
                sum += value_at(uniform_triangle((Vec2(float(i), float(j)) + 0.5f) / float(steps)));
        return sum / float(steps * steps);
    }

    Rgb mean_;
};

}  // namespace lightswitch
