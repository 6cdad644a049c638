#pragma once

// A frame that makes of an iteration no more than one pixel's sample takes, and listens.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>
#include <lightswitch/render/recording.hpp>

#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// Which sample, and how to make it.
struct ReplayTask {
    int x = 0, y = 0;
    Sampling sampling = Sampling::sobol;
    std::uint64_t seed = 0, iteration = 0;
    std::stop_token stop;
    Dependence dependence = Dependence::history;
    bool others = true;   ///< look for splats in other pixels' functions, too
    bool listen = false;  ///< note what happens, not only the values
};

/// What the pixel got.
struct ReplaySums {
    Rgb slot{0};
    DVec3 splatted{0};
    std::uint64_t dropped = 0;  ///< values that were not finite, and rays of the pixel's own paths
    std::vector<RawEvent> events;
};

/// What a method sees of an iteration that is made again for one pixel: as `Frame`.
template <class SceneType>
class ReplayFrame {
public:
    /// What it refers to must outlive it.
    ReplayFrame(const RecordingScene<SceneType>& scene, const TbbExecutor& executor, const ReplayTask& task,
                ReplaySums& sums)
        : scene_(scene),
          executor_(executor),
          task_(task),
          sums_(sums),
          filter_(scene.film().filter),
          target_(static_cast<std::size_t>(task.y) * static_cast<std::size_t>(width()) +
                  static_cast<std::size_t>(task.x)) {}

    static constexpr std::uint64_t before_the_first = ~std::uint64_t{0};

    const RecordingScene<SceneType>& scene() const { return scene_; }
    int width() const { return scene_.camera().width(); }
    int height() const { return scene_.camera().height(); }
    std::size_t area() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
    std::uint64_t iteration() const { return task_.iteration; }
    const TbbExecutor& executor() const { return executor_; }
    bool stopped() const { return task_.stop.stop_requested(); }

    template <class F>
    void pixels(const F& fn) {
        const IterationPoints points = points_of_pass(2 * pixel_passes_++);
        if (!(task_.dependence == Dependence::history ||
              (task_.dependence == Dependence::pixel && task_.others && can_splat<F>))) {
            Unit unit(*this);
            sample(points, task_.x, task_.y, fn, unit);
            return add(unit.found);
        }
        const int columns = (width() + tile_side - 1) / tile_side, rows = (height() + tile_side - 1) / tile_side;
        const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        run_units(count, [&](std::size_t number, Unit& unit) {
            const int x0 = static_cast<int>(number) % columns * tile_side;
            const int y0 = static_cast<int>(number) / columns * tile_side;
            for (int y = y0; y < std::min(y0 + tile_side, height()); ++y)
                for (int x = x0; x < std::min(x0 + tile_side, width()); ++x) sample(points, x, y, fn, unit);
        });
    }

    template <class F>
    void paths(std::uint64_t n, const F& fn, std::uint64_t per_unit = paths_per_unit) {
        const IterationPoints points = points_of_pass(2 * path_passes_++ + 1);
        if (task_.dependence == Dependence::pixel && !task_.others) return;
        run_units(static_cast<std::size_t>((n + per_unit - 1) / per_unit), [&](std::size_t number, Unit& unit) {
            for (std::uint64_t i = number * per_unit; i < std::min((number + 1) * per_unit, n); ++i) {
                // Of a path whose sample is made of many, as a Markov chain's is, only the splats are told.
                unit.begin(task_.dependence != Dependence::history, true);
                Sampler sampler(points, path_stream, i);
                fn(i, sampler, unit.splatter);
                unit.end(i, false);
            }
        });
    }

    void uncounted(const auto& prepare) { prepare(); }

private:
    template <class F>
    static constexpr bool can_splat = std::invocable<const F&, const Ray&, Sampler&, const PixelContext&>;

    /// What a unit of work found out.
    struct Found {
        Rgb slot{0};
        std::vector<Rgb> splats;  // at the pixel, in order
        std::uint64_t dropped = 0;
        std::vector<RawEvent> events;
    };

    /// What one thread works at.
    struct Unit {
        explicit Unit(const ReplayFrame& f)
            : frame(f),
              scope(report),
              splatter(splats, report, f.width(), f.height(), f.filter_, f.task_.iteration, f.task_.seed) {}
        ~Unit() { recorder = nullptr; }
        Unit(const Unit&) = delete;
        Unit& operator=(const Unit&) = delete;

        void begin(bool listens, bool light_only) {
            splats.clear();
            report.where.clear();
            listener.begin(splats, light_only);
            recorder = frame.task_.listen && listens ? &listener : nullptr;
        }

        /// The path of that number is done: keeps what it brought to the pixel, and how, and all of one that is the
        /// pixel's own.
        void end(std::uint64_t path, bool own) {
            recorder = nullptr;
            for (const NonFinite& place : report.where) found.dropped += place.pixel == frame.target_;
            const std::size_t before = found.splats.size();
            for (const Splat& splat : splats)
                if (splat.pixel == frame.target_) found.splats.push_back(splat.value);
            if (frame.task_.listen && (own || found.splats.size() > before)) tell(path, own);
        }

        void tell(std::uint64_t path, bool own) {
            // Each splat belongs to what was told last before it.
            std::vector<RawEvent>& events = listener.events;
            std::size_t first = splats.size(), last_event = 0;
            for (std::size_t i = events.size(); i-- > 0;) {
                PathEvent& event = events[i].event;
                if (event.kind != PathEvent::Kind::splat) continue;
                event.here = false;
                for (std::size_t k = events[i].splats; k < first; ++k)
                    if (splats[k].pixel == frame.target_) {
                        event.here = true;
                        event.value = splats[k].value;
                        last_event = std::max(last_event, i + 1);
                    }
                first = events[i].splats;
            }
            if (own) last_event = events.size();
            const auto keep = [&](const RawEvent& raw) { found.events.emplace_back(raw).event.path = path; };
            const auto keep_untold = [&] {
                for (std::size_t k = 0; k < first; ++k)
                    if (splats[k].pixel == frame.target_)
                        keep({.event = {.kind = PathEvent::Kind::splat, .value = splats[k].value}});
            };
            const bool some_told = first < splats.size();
            if (some_told) keep_untold();
            for (std::size_t i = 0; i < last_event; ++i) {
                const PathEvent& event = events[i].event;
                const bool aside =
                    event.kind == PathEvent::Kind::shadow || (event.kind == PathEvent::Kind::splat && !event.here);
                if (own || !aside) keep(events[i]);
            }
            if (!some_told) keep_untold();
        }

        const ReplayFrame& frame;
        UnitReport report;
        UnitScope scope;
        std::vector<Splat> splats;
        Splatter splatter;
        Recorder listener;
        Found found;
    };

    void sample(const IterationPoints& points, int x, int y, const auto& fn, Unit& unit) const {
        using F = std::remove_cvref_t<decltype(fn)>;
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x);
        const bool own = pixel == target_;
        unit.begin(own || task_.dependence != Dependence::history, !own);
        Sampler sampler(points, pixel_stream, pixel);
        const PixelRay from = pixel_ray(scene_.camera(), filter_, x, y, sampler);
        unit.listener.set_camera_ray(from.ray, from.film);
        const std::uint64_t refused = ray_count.refused;
        Rgb value;
        if constexpr (can_splat<F>) value = fn(from.ray, sampler, PixelContext{pixel, unit.splatter});
        else value = fn(from.ray, sampler);
        unit.end(pixel, own);
        if (!own) return;
        const bool finite = is_finite(value);
        unit.found.dropped += ray_count.refused - refused + !finite;
        if (finite) unit.found.slot = value;
        if (task_.listen)
            unit.found.events.push_back(
                {.event = {.kind = PathEvent::Kind::sample, .path = pixel, .value = value, .here = finite}});
    }

    void run_units(std::size_t count, const auto& work) {
        std::vector<Found> results(count);
        executor_.for_each(count, [&](std::size_t number) {
            if (stopped()) return;
            Unit unit(*this);
            work(number, unit);
            results[number] = std::move(unit.found);
        });
        for (const Found& found : results) add(found);
    }

    /// In the order and precision of the film's own sums.
    void add(const Found& found) {
        sums_.slot += found.slot;
        for (const Rgb& splat : found.splats) sums_.splatted += DVec3(splat);
        sums_.dropped += found.dropped;
        sums_.events.insert(sums_.events.end(), found.events.begin(), found.events.end());
    }

    IterationPoints points_of_pass(std::uint64_t pass) const {
        return detail::points_of_pass(task_.sampling, task_.seed, task_.iteration, pass);
    }

    const RecordingScene<SceneType>& scene_;
    const TbbExecutor& executor_;
    ReplayTask task_;
    ReplaySums& sums_;
    Filter filter_;
    std::size_t target_;
    std::uint64_t pixel_passes_ = 0, path_passes_ = 0;
};

}  // namespace lightswitch::detail
