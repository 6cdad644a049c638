#pragma once

// The built scene: what rays meet, what surfaces are made of, and what shines. Its type says which surface models and
// which lights it can hold, so that code is compiled only for what is there.

#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/core/maybe.hpp>
#include <lightswitch/embree/accelerator.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/scene/camera.hpp>
#include <lightswitch/scene/scene_data.hpp>

#include <string>
#include <tuple>
#include <vector>

namespace lightswitch {

template <class BsdfList, class LightList>
class Scene;

/// An immutable scene; see `build_scene` for how to make one. All members are safe to call from several threads.
///
/// Positions and distances that it takes and gives are in render space (`RenderSpace`); `length` converts the user's
/// units.
template <class... B, class... L>
class Scene<Bsdfs<B...>, Lights<L...>> {
public:
    static_assert(sizeof...(B) <= TypedIndex::kinds, "a scene type holds at most 31 kinds of surface models");
    static_assert(sizeof...(L) <= TypedIndex::kinds, "a scene type holds at most 31 kinds of lights");

    using Data = detail::SceneData<Bsdfs<B...>, Lights<L...>>;
    static constexpr bool has_environment = (EnvironmentLight<L> || ...);

    Scene(Data data, Camera camera, embree::Accelerator accelerator)
        : data_(std::move(data)), camera_(std::move(camera)), accelerator_(std::move(accelerator)) {}

    // --- rays

    /// The closest surface along `ray`, or nothing.
    [[gnu::always_inline]] Maybe<SurfacePoint> intersect(const Ray& ray) const {
        // Filled in place: copying a point costs more than finding it on a small mesh.
        Maybe<SurfacePoint> point;
        embree::Hit hit;
        if (accelerator_.intersect(ray, hit)) {
            if (hit.geometry < data_.meshes.size()) [[likely]]
                locate_on_triangle(ray, hit, point.emplace());
            else locate_on_sphere(ray, hit, point.emplace());
        }
        return point;
    }

    /// Whether any surface lies on the ray between `near` and `far`.
    [[gnu::always_inline]] bool occluded(const Ray& ray) const { return accelerator_.occluded(ray); }

    // --- surfaces

    /// Calls `f(bsdf)` with the surface model at `point`, as its concrete type, and returns what it returns.
    template <class F>
    [[gnu::always_inline]] decltype(auto) with_bsdf(const SurfacePoint& point, F&& f) const {
        return dispatch<sizeof...(B)>(
            point.material.kind(), [&](auto kind) __attribute__((always_inline))->decltype(auto) {
                return f(std::get<kind>(data_.bsdfs)[point.material.position()]);
            });
    }

    /// Whether the scene has a material that is a mirror or clear glass: one whose lobes are all Dirac distributions.
    bool has_specular() const {
        return [&]<std::size_t... I>(std::index_sequence<I...>) {
            return ((B::specular && !std::get<I>(data_.bsdfs).empty()) || ...);
        }
        (std::index_sequence_for<B...>{});
    }

    // --- lights

    /// Radiance that the surface at `point` emits along `direction` (unit, away from the surface).
    [[gnu::always_inline]] Rgb emitted(const SurfacePoint& point, const Vec3& direction) const {
        if (!point.light) return Rgb(0);
        return with_light(
            point.light, [&](const auto& light) __attribute__((always_inline)) {
                if constexpr (is_area<decltype(light)>) return light.emitted(point, direction);
                else return Rgb(0);
            });
    }

    /// Radiance that arrives from beyond the scene out of `direction`.
    Rgb environment(const Vec3& direction) const {
        Rgb sum(0);
        for_each_environment([&](std::size_t, const auto& light) { sum += light.radiance(direction); });
        return sum;
    }

    /// A direction towards a light that `choice` in [0, 1) selects (half by power, half evenly among the emitters) and
    /// on which `u` selects a place; the density includes the selection. Black when there is no light.
    [[gnu::always_inline]] LightSample sample_light(const SurfacePoint& from, float choice, const Vec2& u) const {
        if (data_.light_choice.empty()) return {};
        const std::size_t number = data_.light_choice.sample(choice);
        LightSample sample = with_light(
            locate(number), [&](const auto& light) __attribute__((always_inline)) { return light.sample(from, u); });
        sample.pdf = sample.pdf * data_.light_choice.probability(number);
        return sample;
    }

    /// The density with which `sample_light` at the position `from` chooses the direction `wi` to `hit`, a point on a
    /// light.
    [[gnu::always_inline]] SolidAnglePdf light_pdf(const Vec3& from, const Vec3& wi, const SurfacePoint& hit) const {
        if (data_.light_choice.empty()) return {};  // there are lights, but all are black
        const SolidAnglePdf pdf = with_light(
            hit.light, [&](const auto& light) __attribute__((always_inline)) {
                if constexpr (is_area<decltype(light)>) return light.pdf(from, wi, hit);
                else return SolidAnglePdf{};
            });
        return pdf * data_.light_choice.probability(light_number(hit.light));
    }

    /// The density with which `sample_light`, at a point whose `facing_normal()` is `normal`, chooses the direction
    /// `wi` through the environment.
    SolidAnglePdf environment_pdf(const Vec3& normal, const Vec3& wi) const {
        if (data_.light_choice.empty()) return {};
        SolidAnglePdf sum;
        for_each_environment([&](std::size_t number, const auto& light) __attribute__((always_inline)) {
            sum.value += light.pdf(normal, wi).value * data_.light_choice.probability(number);
        });
        return sum;
    }

    /// A ray that leaves a light: `choice` in [0, 1) selects the light as in `sample_light`, `place` and `direction`
    /// the ray. The weight and the density include the selection. Black when there is no light.
    [[gnu::always_inline]] LightEmission sample_emission(float choice, const Vec2& place, const Vec2& direction) const {
        static_assert((EmittingLight<L> && ...),
                      "methods that trace light need lights with `emit` and `spread` (EmittingLight)");
        if (data_.light_choice.empty()) return {};
        const std::size_t number = data_.light_choice.sample(choice);
        const float probability = data_.light_choice.probability(number);
        const TypedIndex light = locate(number);
        LightEmission emission = with_light(
            light, [&](const auto& l) __attribute__((always_inline)) { return l.emit(place, direction); });
        emission.weight /= probability;
        emission.pdf = emission.pdf * probability;
        emission.light = light;
        return emission;
    }

    /// The density with which `sample_emission` starts a path at `hit`, a point on a light, along `direction`.
    [[gnu::always_inline]] EmissionPdf emission_pdf(const SurfacePoint& hit, const Vec3& direction) const {
        if (data_.light_choice.empty()) return {};
        const EmissionPdf pdf = with_light(
            hit.light, [&](const auto& light) __attribute__((always_inline)) {
                if constexpr (is_area<decltype(light)>) return light.emission_pdf(dot(direction, hit.normal));
                else return EmissionPdf{};
            });
        return pdf * data_.light_choice.probability(light_number(hit.light));
    }

    /// The density with which `sample_emission` starts a path that arrives from beyond the scene in any direction.
    EmissionPdf environment_emission_pdf() const {
        EmissionPdf sum;
        if (data_.light_choice.empty()) return sum;
        for_each_environment([&](std::size_t number, const auto& light) {
            sum.value += light.emission_pdf().value * data_.light_choice.probability(number);
        });
        return sum;
    }

    /// `EmittingLight::spread` of that light.
    [[gnu::always_inline]] float spread(TypedIndex light, const SurfacePoint& at, const Vec3& wi,
                                        const Vec3& place) const {
        return with_light(
            light, [&](const auto& l) __attribute__((always_inline)) { return l.spread(at, wi, place); });
    }
    /// Whether that light is beyond the scene.
    [[gnu::always_inline]] bool infinite(TypedIndex light) const {
        return with_light(
            light,
            [](const auto& l) __attribute__((always_inline)) { return std::remove_cvref_t<decltype(l)>::infinite; });
    }

    /// Lights are numbered by kind in the order of the list, then by position.
    std::size_t light_number(TypedIndex light) const { return first_light_[light.kind()] + light.position(); }
    std::size_t light_count() const { return first_light_[sizeof...(L)]; }

    /// Calls `f(light)` with that light as its concrete type, and returns what it returns.
    template <class F>
    [[gnu::always_inline]] decltype(auto) with_light(TypedIndex light, F&& f) const {
        return dispatch<sizeof...(L)>(
            light.kind(), [&](auto kind) __attribute__((always_inline))->decltype(auto) {
                return f(std::get<kind>(data_.lights)[light.position()]);
            });
    }

    /// The luminous shapes and sources, one entry each.
    const std::vector<Emitter>& emitters() const { return data_.emitters; }

    // --- the rest

    const Camera& camera() const { return camera_; }
    const FilmDescription& film() const { return data_.film; }
    const std::string& name() const { return data_.name; }
    /// A short text that differs between different cameras, for telling apart images of one scene.
    const std::string& camera_id() const { return data_.camera_id; }
    /// Scene units to render units.
    float length(double scene_units) const { return static_cast<float>(data_.space.length(scene_units)); }
    const RenderSpace& space() const { return data_.space; }
    const embree::Accelerator& accelerator() const { return accelerator_; }
    const SceneStatistics& statistics() const { return data_.statistics; }

private:
    [[gnu::always_inline]] void locate_on_triangle(const Ray& ray, const embree::Hit& hit, SurfacePoint& point) const {
        const detail::MeshRecord& mesh = data_.meshes[hit.geometry];
        const Vec3 step = hit.distance * ray.direction;
        point.position = ray.origin + step;
        // Twice the area long, at most 12: scaled so that its square neither overflows nor vanishes for the smallest
        // triangles.
        point.normal = normalize(hit.normal * 0x1p59f);
        point.shading_normal = point.normal;
        // Rounding of the sum above and of the distance, both across the surface, grows with what was added up.
        const Vec3 n = glm::abs(point.normal);
        point.offset =
            mesh.intersection_error + gamma_bound(6) * (dot(n, glm::abs(ray.origin)) + max_component(glm::abs(step)));
        point.wo = -ray.direction;
        point.distance = hit.distance;
        point.material = mesh.material;
        point.light = mesh.first_light ? mesh.first_light.next(hit.primitive) : TypedIndex();
        if (mesh.shading_normals != detail::MeshRecord::flat) {
            const auto& normals = data_.shading_normals[mesh.shading_normals + hit.primitive];
            const Vec3 sum = (1 - hit.u - hit.v) * normals[0] + hit.u * normals[1] + hit.v * normals[2];
            const float length2 = length_squared(sum);
            if (length2 > 0) point.shading_normal = sum * (1 / std::sqrt(length2));
        }
    }

    [[gnu::always_inline]] void locate_on_sphere(const Ray& ray, const embree::Hit& hit, SurfacePoint& point) const {
        const detail::SphereRecord& s = data_.spheres[hit.primitive];
        // Projected back onto the sphere, where the error no longer depends on how far the ray came.
        const Vec3 outward = normalize(ray.origin + hit.distance * ray.direction - s.center);
        point.position = s.center + s.radius * outward;
        point.normal = s.side * outward;
        point.shading_normal = point.normal;
        point.offset = s.offset;
        point.wo = -ray.direction;
        point.distance = hit.distance;
        point.material = s.material;
        point.light = s.light;
    }

    template <class T>
    static constexpr bool is_area = AreaLight<std::remove_cvref_t<T>>;

    template <class F>
    void for_each_environment([[maybe_unused]] F&& f) const {
        [&]<std::size_t... I>(std::index_sequence<I...>) { (visit_environments<I>(f), ...); }
        (std::index_sequence_for<L...>{});
    }

    template <std::size_t I, class F>
    void visit_environments([[maybe_unused]] F& f) const {
        if constexpr (EnvironmentLight<std::tuple_element_t<I, std::tuple<L...>>>) {
            const auto& lights = std::get<I>(data_.lights);
            for (std::size_t i = 0; i < lights.size(); ++i) f(first_light_[I] + i, lights[i]);
        }
    }

    TypedIndex locate(std::size_t number) const {
        std::size_t kind = 0;
        while (number >= first_light_[kind + 1]) ++kind;
        return {kind, number - first_light_[kind]};
    }

    std::array<std::size_t, sizeof...(L) + 1> count_lights() const {
        std::array<std::size_t, sizeof...(L) + 1> first{};
        [[maybe_unused]] std::size_t kind = 0;
        ((first[kind + 1] = first[kind] + std::get<std::vector<L>>(data_.lights).size(), ++kind), ...);
        return first;
    }

    Data data_;
    Camera camera_;
    embree::Accelerator accelerator_;
    std::array<std::size_t, sizeof...(L) + 1> first_light_ = count_lights();
};

}  // namespace lightswitch
