#pragma once

// Makes the sample that a pixel got in an iteration once more, and tells how it came about. Includes no method; what is
// compiled for a method and a scene type is beside that of `render`, and only where this is called.

#include <lightswitch/bsdf/any_material.hpp>
#include <lightswitch/core/error.hpp>
#include <lightswitch/render/path_replay.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/render/replay_frame.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lightswitch {

namespace detail {

/// The name of a type as it is written, without this namespace.
template <class T>
constexpr std::string_view type_name() {
    std::string_view text = __PRETTY_FUNCTION__;
    text.remove_prefix(text.find("T = ") + 4);
    text = text.substr(0, text.find_first_of(";]"));
    constexpr std::string_view here = "lightswitch::";
    if (text.starts_with(here)) text.remove_prefix(here.size());
    return text;
}

template <class SceneType>
class EventFinisher {
public:
    explicit EventFinisher(const SceneType& scene) : scene_(scene) {}

    /// The event with all that can be found out about it, in scene units. Rays are traced once more.
    PathEvent operator()(const RawEvent& raw) const {
        using Kind = PathEvent::Kind;
        PathEvent event = raw.event;
        event.from = to_scene(raw.ray.origin);
        const DVec3 way(raw.ray.direction);
        const double length = glm::length(way);
        event.direction = length > 0 ? way / length : DVec3(0);
        event.position = event.from;
        if (event.kind == Kind::surface) {
            find_surface(raw.ray, event);
        } else if (event.kind == Kind::escape || event.kind == Kind::shadow) {
            const double far = raw.ray.far < infinity ? double(raw.ray.far) : length > 0 ? 4 / length : 0;
            event.position = to_scene(DVec3(raw.ray.origin) + far * way);
            if (event.blocked) find_surface(raw.ray, event);
        } else if (event.kind == Kind::light) {
            event.light = light_name(raw.light);
        }
        return event;
    }

private:
    DVec3 to_scene(const DVec3& position) const {
        if constexpr (requires { scene_.space().scene_point(position); }) return scene_.space().scene_point(position);
        else return position;
    }

    std::string_view light_name(TypedIndex light) const {
        if constexpr (requires { scene_.with_light(light, [](const auto&) { return std::string_view(); }); })
            if (light)
                return scene_.with_light(light, []<class L>(const L&) -> std::string_view { return type_name<L>(); });
        return {};
    }

    void find_surface(const Ray& ray, PathEvent& event) const {
        const auto hit = scene_.intersect(ray);
        if (!hit) return;
        if constexpr (requires { hit->position; }) {
            event.position = to_scene(DVec3(hit->position));
            event.normal = DVec3(hit->normal);
        }
        if constexpr (requires { hit->light; }) event.light = light_name(hit->light);
        if constexpr (requires { scene_.with_bsdf(*hit, [](const auto&) { return std::string_view(); }); })
            event.surface = scene_.with_bsdf(*hit, []<class B>(const B&) -> std::string_view {
                if constexpr (Material<B>)
                    if (!model_name<B>().empty()) return model_name<B>();
                return type_name<B>();
            });
        if constexpr (requires { scene_.identify(ray)->geometry; }) {
            // What a mask lets through is met, but is not what was found.
            const auto numbers = scene_.identify(ray);
            if (!numbers || numbers->distance != hit->distance) return;
            event.shape = std::uint64_t{numbers->geometry} + 1;
            event.primitive = std::uint64_t{numbers->primitive} + 1;
        }
    }

    const SceneType& scene_;
};

/// Whether the contributions and splats say all; see `PathReplay::explained`.
inline bool all_explained(const std::vector<PathEvent>& events) {
    const auto same = [](float a, float b) {
        return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
    };
    Rgb sum(0);
    for (const PathEvent& event : events) {
        if (event.kind == PathEvent::Kind::contribution) sum += event.value;
        if (event.kind == PathEvent::Kind::splat && event.here && event.how == Finding::other) return false;
        if (event.kind != PathEvent::Kind::sample) continue;
        for (int c = 0; c < 3; ++c)
            if (!same(sum[c], event.value[c])) return false;
        sum = Rgb(0);
    }
    return true;
}

/// Makes samples of one pixel again.
template <class SceneType, class M>
class Replayer {
    using FrameType = ReplayFrame<SceneType>;
    using Method = decltype(as_image_method<FrameType, RecordingScene<SceneType>>(std::declval<const M&>()));
    using State = decltype(std::declval<Method>().start(std::declval<FrameType&>()));

public:
    static constexpr Dependence dependence = [] {
        if constexpr (!ImageMethod<M, FrameType>) return Dependence::pixel;
        else if constexpr (requires { M::dependence; }) return M::dependence;
        else return Dependence::history;
    }();

    Replayer(const SceneType& scene, const M& method, const Settings& settings, int x, int y,
             const ReplayOptions& options)
        : scene_(scene), method_(method), executor_(settings.threads) {
        const int width = scene.camera().width(), height = scene.camera().height();
        if (x < 0 || y < 0 || x >= width || y >= height)
            throw Error("pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is outside of the image of " +
                        std::to_string(width) + " x " + std::to_string(height) + " pixels");
        task_ = {.x = x,
                 .y = y,
                 .sampling = settings.sampling,
                 .seed = settings.seed,
                 .stop = settings.stop,
                 .dependence = dependence,
                 .others = options.others};
    }

    /// Whether no more than the pixel's own paths are traced: fast, and iterations may be made at the same time.
    bool alone() const { return dependence == Dependence::pixel && (!ImageMethod<M, FrameType> || !task_.others); }
    bool stopped() const { return task_.stop.stop_requested(); }
    const TbbExecutor& executor() const { return executor_; }

    State start() const {
        ReplaySums forgotten;
        return make(FrameType::before_the_first, false, forgotten,
                    [&](FrameType& frame) { return method().start(frame); });
    }
    ReplaySums iterate(State& state, std::uint64_t iteration, bool listen) const {
        ReplaySums sums;
        make(iteration, listen, sums, [&](FrameType& frame) { method().iterate(frame, state); });
        return sums;
    }

private:
    decltype(auto) method() const { return as_image_method<FrameType, RecordingScene<SceneType>>(method_); }

    auto make(std::uint64_t iteration, bool listen, ReplaySums& sums, const auto& step) const {
        ReplayTask task = task_;
        task.iteration = iteration;
        task.listen = listen;
        FrameType frame(scene_, executor_, task, sums);
        return step(frame);
    }

    RecordingScene<SceneType> scene_;
    M method_;
    TbbExecutor executor_;
    ReplayTask task_;
};

/// Adds the samples of the iterations from `begin` to `end`, as far as they are made.
inline void add_samples(BrightestSample& brightest, DVec3& sum, std::uint64_t begin, std::uint64_t end,
                        const auto& make) {
    for (std::uint64_t iteration = begin; iteration < end; ++iteration) {
        const std::optional<ReplaySums> sums = make(iteration);
        if (!sums) return;
        const DVec3 value = DVec3(sums->slot) + sums->splatted;
        if (brightest.tried == 0 || luminance(value) > luminance(brightest.value)) {
            brightest.iteration = iteration;
            brightest.value = value;
        }
        if (sums->dropped > 0 && brightest.non_finite++ == 0) brightest.first_non_finite = iteration;
        ++brightest.tried;
        sum += value;
    }
}

/// Both together, of which `b` is of later iterations.
inline void merge(BrightestSample& a, const BrightestSample& b) {
    if (b.tried > 0 && (a.tried == 0 || luminance(b.value) > luminance(a.value))) {
        a.iteration = b.iteration;
        a.value = b.value;
    }
    if (!a.first_non_finite) a.first_non_finite = b.first_non_finite;
    a.non_finite += b.non_finite;
    a.tried += b.tried;
}

}  // namespace detail

/// What the sample of a pixel in an iteration depends on, by this method on scenes of this type: how much `replay` has
/// to make again.
template <class SceneType, class M>
inline constexpr Dependence dependence_of = detail::Replayer<SceneType, M>::dependence;

/// Makes the sample that pixel (x, y) got in `iteration` (from 0) of a render with these settings again. What comes of
/// it is what the film got, to the bit, if the compiler contracts no products and sums (-ffp-contract=off, or no fused
/// instructions in the target, as by default on x86-64).
///
/// What it takes is up to the method (`Dependence`): a path; an iteration; or, of a method that says nothing of it, all
/// iterations up to this one. The events tell of the rays of any method, and of contributions as far as the method
/// tells (`tell`), as the library's do; of `mlt`, where a chain's walk is one long path, only what it splatted and
/// which chain did. The observer is not called. Throws `Error` when there is no such pixel.
template <class SceneType, class M>
PathReplay replay(const SceneType& scene, const M& method, const Settings& settings, int x, int y,
                  std::uint64_t iteration, const ReplayOptions& options = {}) {
    static_assert(detail::RequireScene<SceneType>::value);
    const detail::Replayer<SceneType, M> replayer(scene, method, settings, x, y, options);
    auto state = replayer.start();
    if constexpr (replayer.dependence == Dependence::history)
        for (std::uint64_t before = 0; before < iteration && !replayer.stopped(); ++before)
            replayer.iterate(state, before, false);
    const detail::ReplaySums sums = replayer.iterate(state, iteration, true);
    PathReplay result{.sample = sums.slot, .splatted = sums.splatted, .dropped = sums.dropped};
    const FlushDenormals flush;
    const detail::EventFinisher<SceneType> finish(scene);
    for (const detail::RawEvent& raw : sums.events) result.events.push_back(finish(raw));
    result.explained = detail::all_explained(result.events);
    result.cancelled = replayer.stopped();
    return result;
}

/// Finds the brightest of the samples that pixel (x, y) gets in the iterations 0 to `iterations` - 1 of a render with
/// these settings: the one that made an outlier. Of pixel methods, and of `bdpt` without what others splat, only that
/// pixel is traced, many iterations at a time; of the rest one iteration after another is made, as `replay` does.
/// Throws `Error` when there is no such pixel.
template <class SceneType, class M>
BrightestSample brightest_sample(const SceneType& scene, const M& method, const Settings& settings, int x, int y,
                                 std::uint64_t iterations, const ReplayOptions& options = {}) {
    static_assert(detail::RequireScene<SceneType>::value);
    const detail::Replayer<SceneType, M> replayer(scene, method, settings, x, y, options);
    BrightestSample result;
    DVec3 sum(0);
    const auto make = [&](auto& state) {
        return [&](std::uint64_t iteration) -> std::optional<detail::ReplaySums> {
            if (replayer.stopped()) return {};
            auto sums = replayer.iterate(state, iteration, false);
            if (replayer.stopped()) return {};
            return sums;
        };
    };
    if (replayer.alone()) {
        constexpr std::uint64_t per_unit = 64, units_per_wave = 1024;  // bounds memory
        constexpr std::uint64_t per_wave = per_unit * units_per_wave;
        for (std::uint64_t first = 0; first < iterations && !replayer.stopped(); first += per_wave) {
            const std::uint64_t end = std::min(first + per_wave, iterations);
            std::vector<std::pair<BrightestSample, DVec3>> units((end - first + per_unit - 1) / per_unit);
            replayer.executor().for_each(units.size(), [&](std::size_t i) {
                auto state = replayer.start();
                const std::uint64_t begin = first + i * per_unit;
                units[i].second = DVec3(0);
                detail::add_samples(units[i].first, units[i].second, begin, std::min(begin + per_unit, end),
                                    make(state));
            });
            for (const auto& [unit, unit_sum] : units) {
                detail::merge(result, unit);
                sum += unit_sum;
            }
        }
    } else {
        auto state = replayer.start();
        detail::add_samples(result, sum, 0, iterations, make(state));
    }
    if (result.tried > 0) result.mean = sum / double(result.tried);
    result.cancelled = replayer.stopped();
    return result;
}

}  // namespace lightswitch
