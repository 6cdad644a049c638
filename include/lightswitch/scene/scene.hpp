#pragma once

// The built scene: what rays meet, what surfaces are made of, and what shines. Its type says which surface models and
// which lights it can hold, so that code is compiled only for what is there.

#include <lightswitch/camera/camera_id.hpp>
#include <lightswitch/camera/make_camera.hpp>
#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/locate.hpp>
#include <lightswitch/scene/resolve.hpp>
#include <lightswitch/scene/scene_data.hpp>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace lightswitch {

template <class BsdfList, class LightList, class CameraList = AllCameras>
class Scene;

/// An immutable scene; see `build_scene` for how to make one. All members are safe to call from several threads. Copies
/// share everything but the camera; those made by `with_instance` share everything but the camera and the places of
/// instances.
///
/// Positions and distances that it takes and gives are in render space (`RenderSpace`); `length` converts the user's
/// units.
template <class... B, class... L, class... C>
class Scene<Bsdfs<B...>, Lights<L...>, Cameras<C...>> {
public:
    static_assert(sizeof...(B) < TypedIndex::kinds, "a scene type holds at most 30 kinds of surface models");
    static_assert(sizeof...(L) <= TypedIndex::kinds, "a scene type holds at most 31 kinds of lights");

    using Data = detail::SceneData<Bsdfs<B...>, Lights<L...>>;
    /// The camera's type: the only one in the list, or an `AnyCamera`.
    using CameraType = typename detail::CameraOf<Cameras<C...>>::type;
    /// What rays find: a `SurfacePoint`, and more where a material differs from place to place.
    using Point = detail::PointOf<B...>;
    static constexpr bool placed = !std::same_as<Point, SurfacePoint>;
    static constexpr bool has_environment = (EnvironmentLight<L> || ...);

    /// Made by `build_scene`. Throws `Error` for a camera that cannot see the scene from where it is.
    Scene(Data data, detail::Placement placement, const CameraDescription& camera, const FilmDescription& film)
        : Scene(std::make_shared<const Contents>(std::move(data)),
                std::make_shared<const detail::Placement>(std::move(placement)), camera, film) {}

    // --- cameras

    /// The same scene seen by another camera, which gets a `camera_id` of its own. Takes microseconds: the rest is
    /// shared. Throws `Error` for a camera that is impossible or has no place in the scene's type.
    Scene with_camera(const CameraDescription& camera, const FilmDescription& film) const {
        detail::check(camera);
        detail::check(film);
        return Scene(contents_, placement_, camera, film);
    }
    Scene with_camera(const CameraDescription& camera) const { return with_camera(camera, film()); }

    /// The same scene seen by any `Camera` in render space, such as one of one's own. Methods that connect light paths
    /// to it need a `ConnectableCamera`. `id` tells apart its images from those of others; when empty, its rays do.
    template <Camera One>
    Scene<Bsdfs<B...>, Lights<L...>, Cameras<One>> with_camera(One camera, std::string id = {}) const {
        const FilmDescription own{
            .width = camera.width(), .height = camera.height(), .filter = film().filter, .origin = film().origin};
        if (id.empty()) id = detail::camera_id(camera);
        return {contents_, placement_, std::move(camera), own, std::move(id)};
    }

    // --- instances

    /// How many there are; their numbers are those of the description.
    std::size_t instance_count() const { return data().statistics.instances; }

    /// The same scene with one instance in another place. Everything else is shared: only the structure over the
    /// instances is built again. Throws `Error` when there is no such instance, when its group has lights, or when it
    /// would leave the sphere of `radius` around the scene, in which lights beyond the scene shine: then build again.
    Scene with_instance(std::size_t number, const DMat4& to_world) const {
        Scene result = *this;
        result.placement_ = std::make_shared<const detail::Placement>(
            placement_->moved(data().groups, space(), radius(), number, to_world));
        return result;
    }

    // --- rays

    /// The closest surface along `ray`, or nothing.
    [[gnu::always_inline]] Maybe<Point> intersect(const Ray& ray) const {
        // Filled in place: copying a point costs more than finding it on a small mesh.
        Maybe<Point> point;
        embree::Hit hit;
        if (accelerator().intersect(ray, hit)) {
            detail::locate(data(), *placement_, ray, hit, point.emplace());
            if constexpr (placed)
                if (point->material.varies() && !detail::resolve(data(), *placement_, hit, *point)) [[unlikely]]
                    detail::go_on(data(), *placement_, ray, point);
        }
        return point;
    }

    /// Whether any surface lies on the ray between `near` and `far`.
    [[gnu::always_inline]] bool occluded(const Ray& ray) const {
        const bool result = accelerator().occluded(ray);
        if constexpr (placed)
            if (result && data().masked) [[unlikely]]
                return static_cast<bool>(intersect(ray));
        return result;
    }

    /// The numbers of the closest surface along `ray`, also where it is masked: of the scene's own meshes and spheres,
    /// wherever instances place them.
    Maybe<embree::Hit> identify(const Ray& ray) const { return detail::identify(data(), *placement_, ray); }

    // --- surfaces

    /// Calls `f(bsdf)` with the surface model at `point`, as its concrete type, and returns what it returns.
    template <class F>
    [[gnu::always_inline]] decltype(auto) with_bsdf(const Point& point, F&& f) const {
        return dispatch<sizeof...(B)>(
            point.material.kind(), [&](auto kind) __attribute__((always_inline))->decltype(auto) {
                const auto& list = std::get<kind>(data().bsdfs);
                if constexpr (placed) return f(detail::model_at<kind>(point, list));
                else return f(list[point.material.position()]);
            });
    }

    /// How probable it is that layers lead a path that comes to the point to a model that is not specular.
    float presence(const Point& point) const { return detail::presence(data(), point); }

    /// Whether a material has a lobe that is a Dirac distribution: a mirror, clear glass, smooth plastic.
    bool has_specular() const { return detail::any_dirac_lobe(data()); }

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

    /// A direction towards a light that `choice` in [0, 1) selects (half by power, half evenly among the emitters; of
    /// many by a `LightTree`) and a place on it that `u` does; the density includes both. Black without lights.
    [[gnu::always_inline]] LightSample sample_light(const SurfacePoint& from, float choice, const Vec2& u) const {
        if (data().light_choice.empty()) return {};
        const auto chosen = data().light_choice.at(from, choice);
        LightSample sample = with_light(
            light_of_number(chosen.number), [&](const auto& light)
                                                __attribute__((always_inline)) { return light.sample(from, u); });
        sample.pdf = sample.pdf * chosen.probability;
        sample.spread *= data().light_choice.over_start(chosen);
        return sample;
    }

    /// The density with which `sample_light`, at a point at `from` whose `lit_normal()` is `normal`, chooses the
    /// direction `wi` to `hit`, a point on a light.
    [[gnu::always_inline]] SolidAnglePdf light_pdf(const Vec3& from, const Vec3& normal, const Vec3& wi,
                                                   const SurfacePoint& hit) const {
        if (data().light_choice.empty()) return {};  // there are lights, but all are black
        const SolidAnglePdf pdf = with_light(
            hit.light, [&](const auto& light) __attribute__((always_inline)) {
                if constexpr (is_area<decltype(light)>) return light.pdf(from, wi, hit);
                else return SolidAnglePdf{};
            });
        return pdf * data().light_choice.probability_at(from, normal, light_number(hit.light));
    }

    /// The density with which `sample_light`, at a point whose `lit_normal()` is `normal`, chooses the direction
    /// `wi` through the environment.
    SolidAnglePdf environment_pdf(const Vec3& normal, const Vec3& wi) const {
        if (data().light_choice.empty()) return {};
        SolidAnglePdf sum;
        for_each_environment([&](std::size_t number, const auto& light) __attribute__((always_inline)) {
            sum.value += light.pdf(normal, wi).value * data().light_choice.start_probability(number);
        });
        return sum;
    }

    /// A ray that leaves a light: `choice` in [0, 1) selects the light as `sample_light` of few, `place` and
    /// `direction` the ray. The weight and the density include the selection. Black when there is no light.
    [[gnu::always_inline]] LightEmission sample_emission(float choice, const Vec2& place, const Vec2& direction) const {
        static_assert((EmittingLight<L> && ...),
                      "methods that trace light need lights with `emit` and `spread` (EmittingLight)");
        if (data().light_choice.empty()) return {};
        const std::size_t number = data().light_choice.start(choice);
        const float probability = data().light_choice.start_probability(number);
        const TypedIndex light = light_of_number(number);
        LightEmission emission = with_light(
            light, [&](const auto& l) __attribute__((always_inline)) { return l.emit(place, direction); });
        emission.weight /= probability;
        emission.pdf = emission.pdf * probability;
        emission.light = light;
        return emission;
    }

    /// The density with which `sample_emission` starts a path at `hit`, a point on a light, along `direction`.
    [[gnu::always_inline]] EmissionPdf emission_pdf(const SurfacePoint& hit, const Vec3& direction) const {
        if (data().light_choice.empty()) return {};
        const EmissionPdf pdf = with_light(
            hit.light, [&](const auto& light) __attribute__((always_inline)) {
                if constexpr (is_area<decltype(light)>) return light.emission_pdf(hit, direction);
                else return EmissionPdf{};
            });
        return pdf * data().light_choice.start_probability(light_number(hit.light));
    }

    /// The density with which `sample_emission` starts a path that comes from beyond the scene out of `direction`.
    EmissionPdf environment_emission_pdf(const Vec3& direction) const {
        EmissionPdf sum;
        if (data().light_choice.empty()) return sum;
        for_each_environment([&](std::size_t number, const auto& light) {
            sum.value += light.emission_pdf(direction).value * data().light_choice.start_probability(number);
        });
        return sum;
    }

    /// `EmittingLight::spread`, times the probability that `sample_light` there selects the light over that of a start.
    [[gnu::always_inline]] float spread(TypedIndex light, const SurfacePoint& at, const Vec3& wi,
                                        const Vec3& place) const {
        return data().light_choice.over_start(at, light_number(light)) *
               with_light(
                   light, [&](const auto& l) __attribute__((always_inline)) { return l.spread(at, wi, place); });
    }
    /// Whether that light is beyond the scene.
    [[gnu::always_inline]] bool infinite(TypedIndex light) const {
        return with_light(
            light,
            [](const auto& l) __attribute__((always_inline)) { return std::remove_cvref_t<decltype(l)>::infinite; });
    }

    /// Lights are numbered by kind in the order of the list, then by position.
    std::size_t light_number(TypedIndex light) const { return contents_->first_light[light.kind()] + light.position(); }
    TypedIndex light_of_number(std::size_t number) const {
        std::size_t kind = 0;
        while (number >= contents_->first_light[kind + 1]) ++kind;
        return {kind, number - contents_->first_light[kind]};
    }
    std::size_t light_count() const { return contents_->first_light[sizeof...(L)]; }

    /// Calls `f(light)` with that light as its concrete type, and returns what it returns.
    template <class F>
    [[gnu::always_inline]] decltype(auto) with_light(TypedIndex light, F&& f) const {
        return dispatch<sizeof...(L)>(
            light.kind(), [&](auto kind) __attribute__((always_inline))->decltype(auto) {
                return f(std::get<kind>(data().lights)[light.position()]);
            });
    }

    /// The luminous shapes and sources, one entry each.
    const std::vector<Emitter>& emitters() const { return data().emitters; }

    const CameraType& camera() const { return camera_; }
    const FilmDescription& film() const { return film_; }
    const std::string& name() const { return data().name; }
    /// A short text that differs between different cameras, for telling apart images of one scene.
    const std::string& camera_id() const { return camera_id_; }
    /// Scene units to render units.
    float length(double scene_units) const { return static_cast<float>(space().length(scene_units)); }
    const RenderSpace& space() const { return data().space; }
    /// Of a sphere around the origin of render space that holds the scene.
    double radius() const { return data().radius; }
    /// Of the instances, where there are any.
    [[gnu::always_inline]] const embree::Accelerator& accelerator() const { return placement_->accelerator; }
    const SceneStatistics& statistics() const { return data().statistics; }

private:
    template <class, class, class>
    friend class Scene;

    using Contents = detail::SceneContents<Bsdfs<B...>, Lights<L...>>;
    using Shared = std::shared_ptr<const Contents>;
    using SharedPlacement = std::shared_ptr<const detail::Placement>;

    Scene(const Shared& contents, SharedPlacement placement, const CameraDescription& camera,
          const FilmDescription& film)
        : Scene(contents, std::move(placement),
                detail::make_camera<CameraType, C...>(camera, film, contents->data.space, contents->data.radius), film,
                detail::camera_id(camera, film)) {}
    Scene(Shared contents, SharedPlacement placement, CameraType camera, const FilmDescription& film, std::string id)
        : contents_(std::move(contents)),
          placement_(std::move(placement)),
          film_(film),
          camera_(std::move(camera)),
          camera_id_(std::move(id)) {}

    [[gnu::always_inline]] const Data& data() const { return contents_->data; }

    template <class T>
    static constexpr bool is_area = AreaLight<std::remove_cvref_t<T>>;

    void for_each_environment([[maybe_unused]] auto&& f) const {
        const auto visit = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
            if constexpr (EnvironmentLight<std::tuple_element_t<I, std::tuple<L...>>>) {
                const auto& lights = std::get<I>(data().lights);
                for (std::size_t i = 0; i < lights.size(); ++i) f(contents_->first_light[I] + i, lights[i]);
            }
        };
        [&]<std::size_t... I>(std::index_sequence<I...>) { (visit(std::integral_constant<std::size_t, I>()), ...); }
        (std::index_sequence_for<L...>{});
    }

    Shared contents_;
    SharedPlacement placement_;
    FilmDescription film_;
    CameraType camera_;
    std::string camera_id_;
};

}  // namespace lightswitch
