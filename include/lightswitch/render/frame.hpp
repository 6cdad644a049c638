#pragma once

// One iteration as a method sees it: the scene, and two verbs that run in parallel.

#include <lightswitch/camera/camera.hpp>
#include <lightswitch/core/parallel.hpp>
#include <lightswitch/core/sampler.hpp>
#include <lightswitch/film/film.hpp>
#include <lightswitch/geometry/ray.hpp>
#include <lightswitch/render/splatter.hpp>

#include <algorithm>
#include <atomic>
#include <concepts>
#include <stop_token>
#include <type_traits>
#include <vector>

namespace lightswitch {

/// Light paths of `Frame::paths` with consecutive numbers from a multiple of this one on are traced in order by one
/// thread.
inline constexpr std::uint64_t paths_per_unit = 1024;

namespace detail {

/// Pixels are sampled in squares of that side.
inline constexpr int tile_side = 16;
inline constexpr std::uint32_t pixel_stream = 0, path_stream = 1;

/// The random numbers of one call of `pixels` (even numbers) or `paths` (odd ones) in an iteration. Pass 0 is the first
/// call of `pixels`, whatever else a method does: so all methods see the same camera rays.
inline IterationPoints points_of_pass(Sampling sampling, std::uint64_t seed, std::uint64_t iteration,
                                      std::uint64_t pass) {
    return {sampling, pass == 0 ? seed : mix64(seed + pass * 0x9e3779b97f4a7c15u), iteration};
}

/// A ray from the camera through a point of a pixel's filter, and that point.
struct PixelRay {
    Vec2 film;
    Ray ray;
};
[[gnu::always_inline]] inline PixelRay pixel_ray(const auto& camera, const Filter& filter, int x, int y,
                                                 Sampler& sampler) {
    const Vec2 u = sampler.next_2d();
    const Vec2 offset = filter.kind() == Filter::Kind::box ? u - 0.5f : filter.sample(u);
    const Vec2 film(static_cast<float>(x) + 0.5f + offset.x, static_cast<float>(y) + 0.5f + offset.y);
    return {film, camera.ray(film, camera.has_lens() ? sampler.next_2d() : Vec2(0.5f))};
}

}  // namespace detail

/// What a method that wants more than a ray is told about the pixel at hand.
struct PixelContext {
    std::size_t index;   ///< row * width + column
    Splatter& splatter;  ///< for contributions to other pixels
};

/// What an iteration is made of. What it refers to must outlive the frame.
template <class SceneType, Executor E>
struct FrameContext {
    const SceneType& scene;
    Film& film;
    const E& executor;
    Sampling sampling;
    std::uint64_t seed, iteration;
    std::stop_token stop;
    RenderCounts& counts;
};

/// The view that a method has of a render: one iteration of it. Made by the loop.
template <class SceneType, Executor E>
class Frame {
public:
    explicit Frame(const FrameContext<SceneType, E>& context)
        : scene_(context.scene),
          film_(context.film),
          executor_(context.executor),
          filter_(context.scene.film().filter),
          sampling_(context.sampling),
          seed_(context.seed),
          iteration_(context.iteration),
          stop_(context.stop),
          counts_(context.counts) {}

    /// The iteration number of the frame that `start` is given: what it draws belongs to no iteration.
    static constexpr std::uint64_t before_the_first = ~std::uint64_t{0};

    const SceneType& scene() const { return scene_; }
    int width() const { return film_.width(); }
    int height() const { return film_.height(); }
    /// Number of pixels.
    std::size_t area() const { return film_.area(); }
    std::uint64_t iteration() const { return iteration_; }
    const E& executor() const { return executor_; }
    /// True when the loop has been asked to end; the iteration's result is then thrown away, so a method may return
    /// early.
    bool stopped() const {
        if (!stop_.stop_requested()) [[likely]]
            return false;
        told_to_stop_.store(true, std::memory_order_relaxed);
        return true;
    }
    /// Whether `stopped()` was true once, so that something may be missing: what comes after the last time that anybody
    /// asked breaks nothing off.
    bool broken_off() const { return told_to_stop_.load(std::memory_order_relaxed); }

    /// Calls `fn(ray, sampler)` once for every pixel and adds the `Rgb` that it returns to the pixel. The ray comes
    /// from the camera through a point of the pixel's filter. `fn` may take a third argument, the `PixelContext`,
    /// through which it can splat to other pixels.
    ///
    /// Every call of `pixels` or `paths` in an iteration is given random numbers of its own, independent of the other
    /// calls'.
    template <class F>
    void pixels(const F& fn) {
        static_assert(can_splat<F> ? std::is_invocable_r_v<Rgb, const F&, const Ray&, Sampler&, const PixelContext&>
                                   : std::is_invocable_r_v<Rgb, const F&, const Ray&, Sampler&>,
                      "frame.pixels needs a function `Rgb (const Ray& ray, auto& sampler)` or `Rgb (const Ray& ray, "
                      "auto& sampler, "
                      "const PixelContext& pixel)`; it is called from several threads at once, so a lambda must not be "
                      "`mutable`");
        const IterationPoints points = points_of_pass(2 * pixel_passes_++);
        const int columns = (width() + tile - 1) / tile, rows = (height() + tile - 1) / tile;
        const auto work = [&](std::uint64_t unit, Splatter& splatter, detail::UnitReport& report) {
            const int x0 = static_cast<int>(unit) % columns * tile, y0 = static_cast<int>(unit) / columns * tile;
            sample_tile(points, x0, y0, fn, splatter, report);
        };
        const std::uint64_t units = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
        run_units(units, can_splat<F> ? units_per_wave : units, work);
    }

    /// Calls `fn(index, sampler, splatter)` for every index in [0, n): typically one light path each. Splats are added
    /// to the film in the order of the index, whatever the number of threads. `per_unit` consecutive indices are the
    /// share of work that a thread takes.
    template <class F>
    void paths(std::uint64_t n, const F& fn, std::uint64_t per_unit = paths_per_unit) {
        static_assert(std::is_invocable_v<const F&, std::uint64_t&, Sampler&, Splatter&>,
                      "frame.paths needs a function `(std::uint64_t index, auto& sampler, auto& splatter)`; it is "
                      "called from several "
                      "threads at once, so a lambda must not be `mutable`");
        counts_.paths += n;
        const IterationPoints points = points_of_pass(2 * path_passes_++ + 1);
        const auto work = [&](std::uint64_t unit, Splatter& splatter, detail::UnitReport& report) {
            const std::uint64_t refused = ray_count.refused;
            trace_paths(points, unit * per_unit, std::min((unit + 1) * per_unit, n), fn, splatter);
            report.note({iteration_, seed_, 0}, ray_count.refused - refused);
        };
        run_units((n + per_unit - 1) / per_unit, units_per_wave, work);
    }

    /// Runs `prepare()`, which may call `paths`, and counts none of its rays and paths: for what every session makes
    /// again that goes on with a render or makes a part of it.
    void uncounted(const auto& prepare) {
        const RenderCounts before = counts_;
        prepare();
        counts_ = before;
    }

private:
    static constexpr int tile = detail::tile_side;
    static constexpr std::uint64_t units_per_wave =
        256;  // bounds the memory that splats take before they reach the film
    /// Whether the function of `pixels` can splat.
    template <class F>
    static constexpr bool can_splat = std::invocable<const F&, const Ray&, Sampler&, const PixelContext&>;

    IterationPoints points_of_pass(std::uint64_t pass) const {
        return detail::points_of_pass(sampling_, seed_, iteration_, pass);
    }

    /// Runs `work(unit, splatter, report)` for every unit, `per_wave` of them in parallel, and then folds, in the order
    /// of the units, what they leave.
    void run_units(std::uint64_t units, std::uint64_t per_wave, const auto& work) {
        for (std::uint64_t first = 0; first < units && !stopped(); first += per_wave) {
            const std::size_t wave = static_cast<std::size_t>(std::min<std::uint64_t>(per_wave, units - first));
            std::vector<detail::UnitReport> reports(wave);
            std::vector<std::vector<Splat>> splats(wave);
            executor_.for_each(wave, [&](std::size_t unit) {
                if (stopped()) return;
                const detail::UnitScope scope(reports[unit]);
                Splatter splatter(splats[unit], reports[unit], width(), height(), filter_, iteration_, seed_);
                work(first + unit, splatter, reports[unit]);
            });
            for (const auto& unit : splats) {
                film_.add(unit);
                counts_.splats += unit.size();
            }
            gather(reports);
        }
    }

    // The two inner loops stand alone, so that their machine code can be found and checked (tests/structure/hot_path).
    [[gnu::noinline]] void sample_tile(const IterationPoints& points, int x0, int y0, const auto& fn,
                                       Splatter& splatter, detail::UnitReport& report) {
        for (int y = y0; y < std::min(y0 + tile, height()); ++y)
            for (int x = x0; x < std::min(x0 + tile, width()); ++x) sample_pixel(points, x, y, fn, splatter, report);
    }
    [[gnu::noinline]] void trace_paths(const IterationPoints& points, std::uint64_t begin, std::uint64_t end,
                                       const auto& fn, Splatter& splatter) {
        for (std::uint64_t i = begin; i < end; ++i) {
            Sampler sampler(points, detail::path_stream, i);
            fn(i, sampler, splatter);
        }
    }

    template <class F>
    void sample_pixel(const IterationPoints& points, int x, int y, const F& fn, Splatter& splatter,
                      detail::UnitReport& report) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x);
        Sampler sampler(points, detail::pixel_stream, pixel);
        const Ray ray = detail::pixel_ray(scene_.camera(), filter_, x, y, sampler).ray;
        const std::uint64_t refused = ray_count.refused;
        Rgb value;
        if constexpr (can_splat<F>) value = fn(ray, sampler, PixelContext{pixel, splatter});
        else value = fn(ray, sampler);
        const bool finite = is_finite(value);
        if (finite) [[likely]]
            film_.slot(pixel) += value;
        report.note({iteration_, seed_, static_cast<std::uint32_t>(pixel)}, ray_count.refused - refused + !finite);
    }

    void gather(const std::vector<detail::UnitReport>& reports) {
        std::vector<NonFinite> where;
        for (const auto& report : reports) {
            counts_.rays += report.rays;
            counts_.shadow_rays += report.shadow_rays;
            counts_.non_finite += report.non_finite;
            where.insert(where.end(), report.where.begin(), report.where.end());
        }
        std::sort(where.begin(), where.end());
        auto& kept = counts_.first_non_finite;
        const std::size_t room = detail::max_noted - kept.size();
        kept.insert(kept.end(), where.begin(), where.begin() + std::ptrdiff_t(std::min(room, where.size())));
    }

    const SceneType& scene_;
    Film& film_;
    const E& executor_;
    Filter filter_;
    Sampling sampling_;
    std::uint64_t seed_, iteration_;
    std::uint64_t pixel_passes_ = 0, path_passes_ = 0;  // how many calls of `pixels` and `paths` there were
    std::stop_token stop_;
    mutable std::atomic<bool> told_to_stop_ = false;
    RenderCounts& counts_;
};

}  // namespace lightswitch
