#pragma once

// The loop: iterations until the budget is spent, and nothing else.

#include <lightswitch/core/error.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/method.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace lightswitch {

/// When to stop: at whichever limit is met first. A limit of 0 is no limit; without any, 64 samples. Limits are numbers
/// and not negative.
struct Budget {
    int samples = 0;     ///< iterations, which for most methods are samples per pixel
    double seconds = 0;  ///< of rendering; at least one iteration is made
    /// Estimated error of the image, see `Film::relative_error`; judged from 16 iterations on. That of a black image is
    /// unknown: where there may be no light at all, set another limit, too.
    double error = 0;
};

/// What an observer is told after every iteration.
struct Progress {
    std::uint64_t iterations = 0;
    double seconds = 0;       ///< spent rendering
    double fraction = 0;      ///< of the budget that is spent, 0 to 1; never falls
    double seconds_left = 0;  ///< estimated
    const Film& film;
};

/// How to render; the defaults are right for most uses.
struct Settings {
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: as many as the machine has
    Sampling sampling = Sampling::sobol;
    std::stop_token stop = {};                           ///< ends the render early; whole iterations are kept
    std::function<void(const Progress&)> observer = {};  ///< called on the rendering thread after every iteration
};

/// What a render did.
struct RenderStatistics {
    std::uint64_t iterations = 0;
    double seconds = 0;  ///< rendering only, steady clock
    int threads = 0;
    bool cancelled = false;
    RenderCounts counts;
    std::vector<std::pair<std::string, double>> of_method;  ///< what the method's state says, by name
};

namespace detail {

/// Makes an image method of a pixel method, so that the loop knows only one kind.
template <class M>
struct PerPixel {
    const M& method;

    struct Nothing {};
    Nothing start(auto&) const { return {}; }
    void iterate(auto& frame, Nothing&) const {
        frame.pixels([&](const Ray& ray, Sampler& sampler) { return method.radiance(frame.scene(), ray, sampler); });
    }
};

template <class FrameType, class SceneType, class M>
decltype(auto) as_image_method(const M& method) {
    if constexpr (ImageMethod<M, FrameType>) {
        return (method);
    } else {
        static_assert(
            PixelMethod<M, SceneType>,
            "a rendering method needs `static constexpr std::string_view name`, `static constexpr Kind kind`, and "
            "either `Rgb radiance(const auto& scene, const Ray&, auto& sampler) const` or "
            "`start(frame)` with `iterate(frame, state)` (std::visit gives the one in an `AnyMethod`)");
        return PerPixel<M>{method};
    }
}

/// What a method keeps from one iteration to the next.
template <class SceneType, class M, Executor E>
struct MethodState {
    using FrameType = Frame<SceneType, E>;
    using ImageMethod = decltype(as_image_method<FrameType, SceneType>(std::declval<const M&>()));

    decltype(std::declval<ImageMethod>().start(std::declval<FrameType&>())) value;
};

/// Throws `Error` when a limit is not one.
inline void check(const Budget& budget) {
    const auto check_limit = [](double limit, const char* what) {
        if (!(limit >= 0))
            throw Error(std::string("the budget of ") + what + " is " + number_text(limit) + ": give 0 for no limit");
    };
    check_limit(budget.samples, "samples");
    check_limit(budget.seconds, "seconds");
    check_limit(budget.error, "error");
}

}  // namespace detail

/// A render that can be continued: what it has accumulated is a pure function of (scene, method, seed, sampling, number
/// of iterations), whatever the threads and however often it was stopped in between. The scene must outlive it. It can
/// be moved, not copied.
///
/// The members that lead to the code of a method are outside the class, so that `compiled.hpp` can leave them to
/// another file.
template <class SceneType, class M, Executor E = TbbExecutor>
class Session {
    static_assert(detail::RequireScene<SceneType>::value);

public:
    Session(const SceneType& scene, const M& method,
            const Settings& settings = {}) requires std::same_as<E, TbbExecutor>
        : Session(scene, method, settings, TbbExecutor(settings.threads)) {}
    Session(const SceneType& scene, const M& method, const Settings& settings, E executor);
    Session(Session&&) noexcept;
    ~Session();

    /// The scene would be gone before the session is used.
    Session(const SceneType&& scene, const M& method, const Settings& settings = {}) = delete;
    Session(const SceneType&& scene, const M& method, const Settings& settings, E executor) = delete;

    /// Makes iterations until the budget is spent or the stop token asks for an end. Seconds count from this call;
    /// samples and error concern everything accumulated so far. What a method or an observer throws comes out of here;
    /// the whole iterations before it are kept. Throws `Error` when a limit is not one.
    void run(Budget budget) { run(budget, settings_.stop); }
    /// The same, but `pause` is what asks for an end, and another call can go on. Images are the same with and without.
    void run(Budget budget, const std::stop_token& pause);

    const Film& film() const { return film_; }
    const RenderStatistics& statistics() const { return statistics_; }
    /// The image so far, with metadata that says how it was made.
    Image image() const;

private:
    using State = detail::MethodState<SceneType, M, E>;

    decltype(auto) image_method() const { return detail::as_image_method<Frame<SceneType, E>, SceneType>(method_); }

    Frame<SceneType, E> frame(std::uint64_t iteration, const std::stop_token& stop) {
        return Frame<SceneType, E>({.scene = scene_,
                                    .film = film_,
                                    .executor = executor_,
                                    .sampling = settings_.sampling,
                                    .seed = settings_.seed,
                                    .iteration = iteration,
                                    .stop = stop,
                                    .counts = statistics_.counts});
    }

    static std::uint64_t wanted(const Budget& budget) { return static_cast<std::uint64_t>(budget.samples); }
    double spent(const Budget& budget, double seconds, std::uint64_t already) const;

    const SceneType& scene_;
    M method_;
    Settings settings_;
    E executor_;
    Film film_;
    RenderStatistics statistics_;
    std::unique_ptr<State> state_;
};

template <class SceneType, class M, Executor E>
Session<SceneType, M, E>::Session(const SceneType& scene, const M& method, const Settings& settings, E executor)
    : scene_(scene),
      method_(method),
      settings_(settings),
      executor_(std::move(executor)),
      film_(scene.camera().width(), scene.camera().height()) {
    statistics_.threads = executor_.threads();
    auto preparation = frame(Frame<SceneType, E>::before_the_first, settings_.stop);
    state_.reset(new State{image_method().start(preparation)});
    film_.discard(executor_);
}

template <class SceneType, class M, Executor E>
Session<SceneType, M, E>::Session(Session&&) noexcept = default;

template <class SceneType, class M, Executor E>
Session<SceneType, M, E>::~Session() = default;

template <class SceneType, class M, Executor E>
void Session<SceneType, M, E>::run(Budget budget, const std::stop_token& pause) {
    using Clock = std::chrono::steady_clock;
    detail::check(budget);
    if (budget.samples == 0 && budget.seconds == 0 && budget.error == 0) budget.samples = 64;
    const auto begin = Clock::now();
    const std::uint64_t already = film_.iterations();
    double fraction = 0;
    while (!pause.stop_requested() && !(budget.samples > 0 && film_.iterations() >= wanted(budget))) {
        auto current = frame(film_.iterations(), pause);
        try {
            image_method().iterate(current, state_->value);
        } catch (...) {
            film_.discard(executor_);
            throw;
        }
        if (current.broken_off()) {
            film_.discard(executor_);
            break;
        }
        film_.commit(executor_);
        statistics_.iterations = film_.iterations();
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        fraction = std::max(fraction, spent(budget, seconds, already));  // an estimated error may also grow
        if (settings_.observer) {
            settings_.observer({.iterations = film_.iterations(),
                                .seconds = seconds,
                                .fraction = fraction,
                                .seconds_left = fraction > 0 ? seconds * (1 / fraction - 1) : 0,
                                .film = film_});
        }
        if (fraction >= 1) break;
    }
    statistics_.cancelled = pause.stop_requested();
    statistics_.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    if constexpr (requires { state_->value.statistics(); }) statistics_.of_method = state_->value.statistics();
}

template <class SceneType, class M, Executor E>
Image Session<SceneType, M, E>::image() const {
    Image result = film_.image();
    result.metadata = {{"method", std::string(M::name)},
                       {"kind", std::string(name(M::kind))},
                       {"scene", scene_.name()},
                       {"camera", scene_.camera_id()},
                       {"samples", std::to_string(film_.iterations())},
                       {"seconds", std::to_string(statistics_.seconds)},
                       {"seed", std::to_string(settings_.seed)},
                       {"sampling", std::string(lightswitch::name(settings_.sampling))}};
    if (statistics_.counts.non_finite > 0)
        result.metadata["non_finite"] = std::to_string(statistics_.counts.non_finite);
    return result;
}

/// Fraction of the budget that is spent, by the limit that will be met first.
template <class SceneType, class M, Executor E>
double Session<SceneType, M, E>::spent(const Budget& budget, double seconds, std::uint64_t already) const {
    double fraction = 0;
    const double made = double(film_.iterations() - already);
    if (budget.samples > 0) fraction = std::max(fraction, made / double(wanted(budget) - already));
    if (budget.seconds > 0) fraction = std::max(fraction, seconds / budget.seconds);
    if (budget.error > 0 && film_.iterations() >= 16) {
        // The variance falls as one over the number of iterations.
        const double ratio = budget.error / film_.relative_error();
        fraction = std::max(fraction, ratio >= 1 ? 1.0 : ratio * ratio);
    }
    return std::min(fraction, 1.0);
}

/// Renders `scene` with `method` until `budget` is spent, and returns the image. Deterministic: equal arguments give
/// equal bits, for any number of threads, unless the budget is in seconds.
template <class SceneType, class M>
Image render(const SceneType& scene, const M& method, const Budget& budget = {}, const Settings& settings = {}) {
    Session<SceneType, M> session(scene, method, settings);
    session.run(budget);
    return session.image();
}

}  // namespace lightswitch
