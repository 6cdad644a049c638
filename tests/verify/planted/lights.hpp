#pragma once

// Lights with one mistake. A scene builds its lights itself; `Relit` is such a scene with the light members replaced.

#include <lightswitch/core/table.hpp>
#include <lightswitch/light/sphere_light.hpp>
#include <lightswitch/light/triangle_light.hpp>

#include <array>
#include <utility>
#include <vector>

namespace lightswitch::test {

enum class LightMistake {
    none,
    weighted_uniformly,  ///< chosen by power, but with the probability of a uniform choice
    last_never_chosen,   ///< a uniform choice among one light less
    // of triangles
    area_density,               ///< taken for a density per solid angle
    root_missing,               ///< in the map from the square to the triangle
    emits_backwards,            ///< where a ray meets its back
    samples_backwards,          ///< towards points behind it
    emits_by_shading_normal,    ///< the side is told by the interpolated normal
    density_by_shading_normal,  ///< the cosine of a light that is met is that of the interpolated normal
    // of spheres
    area_sample_cone_density,  ///< uniform on the sphere, with the density of uniform directions to it
    cone_too_narrow,           ///< sampled and believed: a tenth less of the solid angle
};

/// `Base`, a scene with one kind of light, whose lights are chosen by power (or uniformly), with a mistake.
template <class Base>
class Relit : public Base {
public:
    Relit(Base scene, LightMistake mistake) : Base(std::move(scene)), mistake_(mistake) {
        std::vector<double> weights;
        for (std::size_t i = 0; i < this->light_count(); ++i)
            weights.push_back(this->with_light(TypedIndex(0, i), [](const auto& light) { return light.power(); }));
        if (mistake == LightMistake::last_never_chosen) {
            weights.assign(weights.size(), 1);
            weights.back() = 0;
        }
        choice_ = DiscreteDistribution(weights);
    }

    LightSample sample_light(const SurfacePoint& from, float choice, const Vec2& u) const {
        const std::size_t number = choice_.sample(choice);
        LightSample result =
            this->with_light(TypedIndex(0, number), [&](const auto& light) { return sample(light, from, u); });
        result.pdf = result.pdf * probability(number);
        return result;
    }

    SolidAnglePdf light_pdf(const Vec3& from, const Vec3&, const Vec3& wi, const SurfacePoint& hit) const {
        return this->with_light(hit.light, [&](const auto& light) { return pdf(light, from, wi, hit); }) *
               probability(hit.light.position());
    }

    Rgb emitted(const SurfacePoint& point, const Vec3& direction) const {
        if (!point.light) return Rgb(0);
        return this->with_light(point.light, [&](const auto& light) {
            if (mistake_ == LightMistake::emits_backwards) return light.emission;
            if (mistake_ == LightMistake::emits_by_shading_normal)
                return dot(point.shading_normal, direction) > 0 ? light.emission : Rgb(0);
            return light.emitted(point, direction);
        });
    }

private:
    float probability(std::size_t number) const {
        if (mistake_ == LightMistake::weighted_uniformly || mistake_ == LightMistake::last_never_chosen)
            return 1 / static_cast<float>(choice_.size());
        return choice_.probability(number);
    }

    LightSample sample(const TriangleLight& light, const SurfacePoint& from, const Vec2& u) const {
        Vec2 b = uniform_triangle(u);
        if (mistake_ == LightMistake::root_missing) b = {1 - u.x, u.y * u.x};
        const Vec3 position = light.corner + b.x * light.edge1 + b.y * light.edge2;
        const Vec3 to_light = position - from.position;
        const float distance2 = length_squared(to_light);
        const Vec3 wi = to_light * (1 / std::sqrt(distance2));
        float cosine = -dot(wi, light.normal);
        if (mistake_ == LightMistake::samples_backwards) cosine = std::abs(cosine);
        if (!(cosine > 0)) return {};
        const SolidAnglePdf density = mistake_ == LightMistake::area_density
                                          ? SolidAnglePdf{light.density.value}
                                          : to_solid_angle(light.density, distance2, cosine);
        return {.wi = wi,
                .radiance = light.emission,
                .pdf = density,
                .dirac = false,
                .visibility = from.segment_to(position, light.normal, light.offset)};
    }

    SolidAnglePdf pdf(const TriangleLight& light, const Vec3& from, const Vec3& wi, const SurfacePoint& hit) const {
        if (mistake_ == LightMistake::area_density) return {light.density.value};
        if (mistake_ == LightMistake::density_by_shading_normal)
            return to_solid_angle(light.density, length_squared(hit.position - from),
                                  std::abs(dot(wi, hit.shading_normal)));
        return light.pdf(from, wi, hit);
    }

    LightSample sample(const SphereLight& light, const SurfacePoint& from, const Vec2& u) const {
        if (mistake_ == LightMistake::cone_too_narrow) return narrowed(light).sample(from, u);
        LightSample result = light.sample(from, u);
        if (mistake_ == LightMistake::area_sample_cone_density && result.pdf.value > 0) {
            const Vec3 normal = uniform_sphere(u);
            const Vec3 position = light.center + light.radius * normal;
            result.wi = normalize(position - from.position);
            result.visibility = from.segment_to(light.center + (light.radius + light.offset) * normal);
        }
        return result;
    }

    SolidAnglePdf pdf(const SphereLight& light, const Vec3& from, const Vec3& wi, const SurfacePoint& hit) const {
        return (mistake_ == LightMistake::cone_too_narrow ? narrowed(light) : light).pdf(from, wi, hit);
    }

    /// A smaller sphere, whose points stand off it so far that they are outside of the real one.
    static SphereLight narrowed(const SphereLight& light) {
        SphereLight narrow = light;
        narrow.radius *= shrink;
        narrow.offset += 2 * (light.radius - narrow.radius);
        return narrow;
    }
    static constexpr float shrink = 0.9487f;  // the square root of 0.9

    LightMistake mistake_;
    DiscreteDistribution choice_;
};

enum class TreeMistake {
    none,
    met_density_of_level_above,  ///< the density of a light that is met lacks the choice at the last node
    branch_probability_swapped,  ///< at the root, that of the other child
};

/// `Base`, a scene with 2^n luminous triangles, chosen by a binary tree over their numbers: at each node by power over
/// the squared distance to the mean of the corners, as the library's `LightTree` does it with better bounds.
template <class Base>
class ByTree : public Base {
public:
    ByTree(Base scene, TreeMistake mistake) : Base(std::move(scene)), mistake_(mistake) {
        const std::size_t count = this->light_count();
        nodes_.resize(2 * count);
        for (std::size_t i = 0; i < count; ++i)
            this->with_light(TypedIndex(0, i), [&](const TriangleLight& light) {
                nodes_[count + i] = {static_cast<float>(light.power()), light.corner};
            });
        for (std::size_t i = count; i-- > 1;)
            nodes_[i] = {nodes_[2 * i].power + nodes_[2 * i + 1].power,
                         0.5f * (nodes_[2 * i].middle + nodes_[2 * i + 1].middle)};
    }

    LightSample sample_light(const SurfacePoint& from, float choice, const Vec2& u) const {
        std::size_t node = 1;
        float probability = 1;
        while (node < this->light_count()) {
            const float left = left_share(node, from.position);
            const bool goes_left = choice < left;
            choice = std::min(goes_left ? choice / left : (choice - left) / (1 - left), 0x1.fffffep-1f);
            node = 2 * node + !goes_left;
            probability *= believed(node, from.position);
        }
        LightSample result = this->with_light(TypedIndex(0, node - this->light_count()),
                                              [&](const auto& light) { return light.sample(from, u); });
        result.pdf = result.pdf * probability;
        return result;
    }

    SolidAnglePdf light_pdf(const Vec3& from, const Vec3&, const Vec3& wi, const SurfacePoint& hit) const {
        std::size_t node = this->light_count() + hit.light.position();
        float probability = 1;
        if (mistake_ == TreeMistake::met_density_of_level_above) node /= 2;
        for (; node > 1; node /= 2) probability *= believed(node, from);
        return this->with_light(hit.light, [&](const auto& light) { return light.pdf(from, wi, hit); }) * probability;
    }

private:
    struct Node {
        float power = 0;
        Vec3 middle{0};
    };

    float left_share(std::size_t node, const Vec3& from) const {
        const auto importance = [&](const Node& child) { return child.power / length_squared(child.middle - from); };
        const float left = importance(nodes_[2 * node]), right = importance(nodes_[2 * node + 1]);
        return left / (left + right);
    }
    /// The probability of that node once its parent is chosen.
    float believed(std::size_t node, const Vec3& from) const {
        const float left = left_share(node / 2, from);
        const bool swapped = mistake_ == TreeMistake::branch_probability_swapped && node / 2 == 1;
        return (node % 2 == 0) != swapped ? left : 1 - left;
    }

    TreeMistake mistake_;
    std::vector<Node> nodes_;  // the root is 1, the children of i are 2 i and 2 i + 1, lights come last
};

/// A sky in rings and sectors of latitude and longitude around the y axis, bright towards the zenith and towards +x.
class GradientSky {
public:
    explicit GradientSky(bool sine_missing) : sine_missing_(sine_missing) {
        std::vector<double> weights;
        for (int ring = 0; ring < rings; ++ring)
            for (int sector = 0; sector < sectors; ++sector)
                weights.push_back(double(cell(ring, sector)) * std::sin((ring + 0.5) * double(pi) / rings));
        choice_ = DiscreteDistribution(weights);
    }

    Rgb radiance(const Vec3& wi) const {
        const auto [ring, sector] = locate(wi);
        return cell(ring, sector) * Rgb(0.6f, 0.8f, 1);
    }

    LightSample sample(const SurfacePoint& from, float choice, const Vec2& u) const {
        const int number = static_cast<int>(choice_.sample(choice));
        const float theta = pi * (static_cast<float>(number / sectors) + u.x) / rings;
        const float phi = 2 * pi * (static_cast<float>(number % sectors) + u.y) / sectors;
        const float sine = std::sin(theta);
        const Vec3 wi(sine * std::cos(phi), std::cos(theta), sine * std::sin(phi));
        return {.wi = wi, .radiance = radiance(wi), .pdf = pdf(wi), .dirac = false, .visibility = from.spawn(wi)};
    }

    SolidAnglePdf pdf(const Vec3& wi) const {
        const auto [ring, sector] = locate(wi);
        const float per_angles =
            choice_.probability(static_cast<std::size_t>(ring * sectors + sector)) * (rings * sectors) / (2 * pi * pi);
        return {sine_missing_ ? per_angles : per_angles / std::max(safe_sqrt(1 - wi.y * wi.y), 1e-6f)};
    }

private:
    static constexpr int rings = 16, sectors = 8;

    static float cell(int ring, int sector) {
        const float height = 1 - (static_cast<float>(ring) + 0.5f) / rings;
        return (0.2f + 1.8f * height * height) * (sector == 0 || sector == sectors - 1 ? 2.0f : 1.0f);
    }

    static std::pair<int, int> locate(const Vec3& wi) {
        const float theta = std::acos(std::clamp(wi.y, -1.0f, 1.0f));
        const float turns = std::atan2(wi.z, wi.x) * (0.5f * inv_pi);
        return {std::min(static_cast<int>(theta * inv_pi * rings), rings - 1),
                std::min(static_cast<int>((turns < 0 ? turns + 1 : turns) * sectors), sectors - 1)};
    }

    bool sine_missing_;
    DiscreteDistribution choice_;
};

/// `Base`, a scene without lights, under a `GradientSky`.
template <class Base>
class UnderSky : public Base {
public:
    static constexpr bool has_environment = true;

    UnderSky(Base scene, bool sine_missing) : Base(std::move(scene)), sky_(sine_missing) {}

    Rgb environment(const Vec3& wi) const { return sky_.radiance(wi); }
    SolidAnglePdf environment_pdf(const Vec3&, const Vec3& wi) const { return sky_.pdf(wi); }
    LightSample sample_light(const SurfacePoint& from, float choice, const Vec2& u) const {
        return sky_.sample(from, choice, u);
    }

private:
    GradientSky sky_;
};

}  // namespace lightswitch::test
