#pragma once

// How a sample of a pixel comes about, told while it is made once more (`replay`): what methods tell, and a scene that
// listens. Ordinary scenes do not: then telling is no code at all.

#include <lightswitch/core/pdf.hpp>
#include <lightswitch/film/film.hpp>
#include <lightswitch/geometry/ray.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/render/path_event.hpp>

#include <type_traits>
#include <vector>

namespace lightswitch {

/// Told by a method: it has added `value` to the sample of the pixel (or, of `Finding::seen`, is about to splat it at
/// `film`).
struct Contributed {
    Finding how = Finding::other;
    int light_vertices = 0, camera_vertices = 0;  ///< s and t
    float weight = 1;                             ///< by multiple importance sampling, in `value` already
    Rgb value{0};
    Vec2 film{0};
};

/// Told by a method: its path leaves the vertex at hand.
struct Scattered {
    Vec3 direction;
    SolidAnglePdf pdf;  ///< of a Dirac lobe 0
    bool specular;
    Rgb throughput;  ///< before roulette
    float survival;  ///< probability of going on
    bool survived;
};

namespace detail {

/// An event in render space, with what the rest of it can be found by.
struct RawEvent {
    PathEvent event;
    Ray ray = {};
    TypedIndex light = {};
    std::size_t splats = 0;  // of this path before it
};

/// Listens to the paths of one thread.
class Recorder {
public:
    /// A new sample or light path, whose splats are gathered there. With `light_only` what is told of paths from the
    /// camera is passed over.
    void begin(const std::vector<Splat>& splats, bool light_only) {
        events.clear();
        splats_ = &splats;
        light_only_ = light_only;
        under_way_ = of_light_ = false;
        vertex_ = 0;
    }
    /// The ray of a pixel, through that point of the film. It is told where a path begins with it.
    void set_camera_ray(const Ray& ray, const Vec2& film) {
        camera_ray_ = ray;
        film_ = film;
    }

    void camera_path() {
        begin_path(false);
        add(PathEvent::Kind::camera, camera_ray_).film = DVec2(film_);
    }
    void light_path(const LightEmission& emission) {
        begin_path(true);
        add(PathEvent::Kind::light, emission.ray).throughput = emission.weight;
        if (!skipped()) events.back().light = emission.light;
    }

    /// A ray of a path, or a segment between two points (`SurfacePoint::segment_to`, which ends at 1).
    void intersected(const Ray& ray, bool hit) {
        if (!under_way_) camera_path();
        if (ray.far == 1) return occluded(ray, hit);
        if (hit) ++vertex_;
        add(hit ? PathEvent::Kind::surface : PathEvent::Kind::escape, ray);
    }
    void occluded(const Ray& ray, bool blocked) { add(PathEvent::Kind::shadow, ray).blocked = blocked; }

    void add(const Scattered& told) {
        PathEvent& event = add(PathEvent::Kind::scatter, {.origin = {}, .direction = told.direction});
        event.pdf = double(told.pdf.value);
        event.specular = told.specular;
        event.throughput = told.throughput;
        event.survival = told.survival;
        event.survived = told.survived;
    }
    void add(const Contributed& told) {
        const bool splat = told.how == Finding::seen;
        if (!splat && is_black(told.value)) return;  // adds nothing
        PathEvent& event = add(splat ? PathEvent::Kind::splat : PathEvent::Kind::contribution, {});
        event.how = told.how;
        event.light_vertices = told.light_vertices;
        event.camera_vertices = told.camera_vertices;
        event.weight = told.weight;
        event.value = told.value;
        event.film = DVec2(told.film);
    }

    std::vector<RawEvent> events;

private:
    bool skipped() const { return light_only_ && !of_light_; }
    void begin_path(bool of_light) {
        under_way_ = true;
        of_light_ = of_light;
        vertex_ = 0;
    }
    PathEvent& add(PathEvent::Kind kind, const Ray& ray) {
        if (skipped()) return nobody_;
        RawEvent& raw = events.emplace_back();
        raw.ray = ray;
        raw.splats = splats_->size();
        raw.event.kind = kind;
        raw.event.vertex = vertex_;
        raw.event.of_light = of_light_;
        return raw.event;
    }

    const std::vector<Splat>* splats_ = nullptr;
    bool light_only_ = false, under_way_ = false, of_light_ = false;
    int vertex_ = 0;
    Ray camera_ray_;
    Vec2 film_{0};
    PathEvent nobody_;
};

/// Of the calling thread; null while nobody listens.
inline constinit thread_local Recorder* recorder = nullptr;

}  // namespace detail

/// A copy of a scene that tells the thread's recorder, if there is one, of its rays and what methods say of them.
template <class SceneType>
class RecordingScene : public SceneType {
public:
    static constexpr bool is_recording = true;

    explicit RecordingScene(const SceneType& scene) : SceneType(scene) {}

    auto intersect(const Ray& ray) const {
        const auto hit = SceneType::intersect(ray);
        if (detail::recorder) detail::recorder->intersected(ray, static_cast<bool>(hit));
        return hit;
    }
    bool occluded(const Ray& ray) const {
        const bool blocked = SceneType::occluded(ray);
        if (detail::recorder) detail::recorder->occluded(ray, blocked);
        return blocked;
    }

    void tell(const Contributed& told) const {
        if (detail::recorder) detail::recorder->add(told);
    }
    void tell(const Scattered& told) const {
        if (detail::recorder) detail::recorder->add(told);
    }
    /// A path begins at a light.
    void tell(const LightEmission& emission) const {
        if (detail::recorder) detail::recorder->light_path(emission);
    }
    /// A path begins at the camera, after one from a light.
    void tell(const Ray&) const {
        if (detail::recorder) detail::recorder->camera_path();
    }
};

/// Whether a type of scene, or reference to one, listens.
template <class SceneType>
inline constexpr bool records = requires {
    requires std::remove_cvref_t<SceneType>::is_recording;
};

/// Tells a scene that listens what a method does: of `Contributed`, `Scattered`, where a path begins. To be called
/// right where a value is added to the sum that becomes the sample, in that order: then they add up to it, to the bit.
/// A method need not tell; what it does not, `replay` does not explain.
[[gnu::always_inline]] inline void tell([[maybe_unused]] const auto& scene, [[maybe_unused]] const auto& what) {
    if constexpr (records<decltype(scene)>) scene.tell(what);
}

}  // namespace lightswitch
