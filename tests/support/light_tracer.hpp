#pragma once

// A light tracer of a page, as a user would write one: the image method of the tests.

#include <lightswitch/core/warp.hpp>
#include <lightswitch/render/method.hpp>
#include <lightswitch/scene/stock.hpp>

namespace lightswitch::test {

/// A pinhole camera turned around: where on the film a point in render space is seen, and how much it counts there.
///
/// A pixel is the average of the radiance over its area A on the film. On a film at distance 1 from the pinhole, a
/// surface element dS at distance d fills the film area dS cos(at the surface) / d^2 / cos^3, with the cosine to the
/// optical axis: one because the film is tilted against the ray, two because it is 1 / cos away. So flux that would
/// leave the element as radiance counts as W = 1 / (A cos^3) times the geometry cos(at the surface) / d^2.
class Pinhole {
public:
    Pinhole(const CameraDescription& camera, const FilmDescription& film, const RenderSpace& space)
        : width_(film.width),
          height_(film.height),
          half_width_(std::tan(glm::radians(camera.fov) / 2)),
          left_(camera.to_world[0]),
          up_(camera.to_world[1]),
          forward_(camera.to_world[2]),
          position_(space.point(DVec3(camera.to_world[3]))) {}

    struct View {
        Vec2 film{-1};          // columns and rows from the top left; off the film when behind
        double importance = 0;  // W
    };

    View view(const Vec3& point) const {
        const DVec3 to_point = DVec3(point) - position_;
        const double depth = glm::dot(to_point, forward_), cosine = depth / glm::length(to_point);
        if (!(depth > 0)) return {};
        const double pixel = 2 * half_width_ / width_;  // pixels are square
        return {Vec2(DVec2(0.5 * width_ - glm::dot(to_point, left_) / depth / pixel,
                           0.5 * height_ - glm::dot(to_point, up_) / depth / pixel)),
                1 / (pixel * pixel * cosine * cosine * cosine)};
    }
    Vec3 position() const { return Vec3(position_); }

private:
    double width_, height_, half_width_;
    DVec3 left_, up_, forward_, position_;
};

/// Emission seen directly (slots), and light paths of `bounces` surface points, each connected to the camera (splats):
/// what a path tracer sees up to depth `bounces` + 1. For scenes of one-sided diffuse surfaces and luminous triangles,
/// with a box filter.
struct PlainLightTracer {
    static constexpr std::string_view name = "light-tracer";
    static constexpr Kind kind = Kind::unbiased;

    Pinhole camera;
    int bounces = 1;
    std::uint64_t paths = 4096;

    struct State {
        int iterations = 0;
    };
    State start(auto&) const { return {}; }

    void iterate(auto& frame, State& state) const {
        ++state.iterations;
        const auto& scene = frame.scene();
        frame.pixels([&](const Ray& ray, auto&) {
            const auto hit = scene.intersect(ray);
            return hit ? scene.emitted(*hit, -ray.direction) : Rgb(0);
        });
        frame.paths(paths, [&](std::uint64_t, auto& sampler, auto& splatter) { trace(scene, sampler, splatter); });
    }

private:
    void trace(const DiffuseScene& scene, auto& sampler, auto& splatter) const {
        const auto count = static_cast<float>(scene.light_count());
        const auto number = std::min(static_cast<std::size_t>(sampler.next_1d() * count), scene.light_count() - 1);
        const TriangleLight light = scene.with_light(TypedIndex(0, number), [](const TriangleLight& l) { return l; });
        const Vec2 on_light = uniform_triangle(sampler.next_2d());
        Vec3 direction = Basis(light.normal).to_world(cosine_hemisphere(sampler.next_2d()));
        Ray ray{
            .origin = light.corner + on_light.x * light.edge1 + on_light.y * light.edge2 + light.offset * light.normal,
            .direction = direction};
        // Density of the ray: 1 / count over lights, 1 / area, cosine / pi. The cosine of emission cancels.
        Rgb flux = light.emission * (pi * count / light.density.value / static_cast<float>(paths));
        for (int bounce = 0; bounce < bounces; ++bounce) {
            const auto hit = scene.intersect(ray);
            if (!hit) return;
            const Basis basis = hit->shading_frame();
            const Vec3 local_wo = basis.to_local(-ray.direction);
            connect(scene, *hit, basis, local_wo, flux, splatter);
            const Vec2 u = sampler.next_2d();
            const auto scattered = scene.with_bsdf(
                *hit, [&](const auto& bsdf) { return bsdf.sample(local_wo, Vec3(u, 0), Transport::importance); });
            if (!scattered) return;
            flux *= scattered->weight;
            ray = hit->spawn(basis.to_world(scattered->wi));
        }
    }

    void connect(const auto& scene, const SurfacePoint& at, const Basis& basis, const Vec3& local_wo, const Rgb& flux,
                 auto& splatter) const {
        const auto view = camera.view(at.position);
        const Vec3 to_camera = camera.position() - at.position;
        const Vec3 wi = normalize(to_camera);
        const BsdfValue scattering = scene.with_bsdf(
            at, [&](const auto& bsdf) { return bsdf.evaluate(local_wo, basis.to_local(wi), Transport::importance); });
        if (is_black(scattering.value) || scene.occluded(at.segment_to(camera.position()))) return;
        const double geometry = double(std::abs(dot(wi, at.shading_normal))) / double(length_squared(to_camera));
        splatter.splat(view.film, flux * scattering.value * static_cast<float>(geometry * view.importance));
    }
};

/// The Cornell box on a small film.
inline LibraryDescription small_box(int width = 48, int height = 32) {
    LibraryDescription scene = stock::describe_cornell_box();
    scene.film.width = width;
    scene.film.height = height;
    return scene;
}

inline PlainLightTracer light_tracer_for(const LibraryDescription& description, const DiffuseScene& scene) {
    return {.camera = Pinhole(description.camera, description.film, scene.space())};
}

}  // namespace lightswitch::test
