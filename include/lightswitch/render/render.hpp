#pragma once

// The loop: iterations until the budget is spent, and nothing else.

#include <lightswitch/render/archive.hpp>
#include <lightswitch/render/frame.hpp>
#include <lightswitch/render/iterations.hpp>
#include <lightswitch/render/method.hpp>
#include <lightswitch/render/settings.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace lightswitch {

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

template <class M>
constexpr bool depends_on_history() {
    if constexpr (requires { M::dependence; }) return M::dependence == Dependence::history;
    else return true;
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

    /// Makes iterations until the budget is spent or the stop token asks for an end: the first that have not been made,
    /// from `Settings::first_iteration` on. Seconds count from this call; samples and error concern everything
    /// accumulated so far. What a method or an observer throws comes out of here; the whole iterations before it are
    /// kept. Throws `Error` when a limit is not one.
    void run(Budget budget) { run(budget, settings_.stop); }
    /// The same, but `pause` is what asks for an end, and another call can go on. Images are the same with and without.
    void run(Budget budget, const std::stop_token& pause);

    const Film& film() const { return film_; }
    const RenderStatistics& statistics() const { return statistics_; }
    /// The image so far, with metadata that says how it was made.
    Image image() const;

    const SceneType& scene() const { return scene_; }
    const M& method() const { return method_; }
    const Settings& settings() const { return settings_; }
    /// The iterations that the film holds.
    const IterationSet& made() const { return made_; }

    /// Goes on from that iteration, or the first one behind it that has not been made: those between are left to
    /// others, as with `Settings::first_iteration`.
    void begin_at(std::uint64_t iteration) { settings_.first_iteration = iteration; }

    // What render/checkpoint.hpp is made of.
    /// What the method keeps from one iteration to the next, as bytes. Throws `Error` when it does not say.
    std::string method_state() const;
    /// Whether there may be any.
    static bool has_history();
    /// Goes on from there; `method_state` is empty where there is none.
    void restore(Film film, IterationSet made, RenderStatistics statistics, detail::ByteReader method_state);
    /// The film of that iteration alone, which this render neither counts nor keeps.
    Film film_of(std::uint64_t iteration);

private:
    using State = detail::MethodState<SceneType, M, E>;
    using StateValue = decltype(State::value);

    decltype(auto) image_method() const { return detail::as_image_method<Frame<SceneType, E>, SceneType>(method_); }

    Frame<SceneType, E> frame(std::uint64_t iteration, const std::stop_token& stop) {
        return frame(iteration, stop, film_, statistics_.counts);
    }
    Frame<SceneType, E> frame(std::uint64_t iteration, const std::stop_token& stop, Film& film, RenderCounts& counts) {
        return Frame<SceneType, E>({.scene = scene_,
                                    .film = film,
                                    .executor = executor_,
                                    .sampling = settings_.sampling,
                                    .seed = settings_.seed,
                                    .iteration = iteration,
                                    .stop = stop,
                                    .counts = counts});
    }
    void note_method() {
        if constexpr (requires { state_->value.statistics(); }) statistics_.of_method = state_->value.statistics();
    }

    static std::uint64_t wanted(const Budget& budget) { return static_cast<std::uint64_t>(budget.samples); }
    double spent(const Budget& budget, double seconds, std::uint64_t already) const;

    const SceneType& scene_;
    M method_;
    Settings settings_;
    E executor_;
    Film film_;
    RenderStatistics statistics_;
    IterationSet made_;
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
    const double seconds_before = statistics_.seconds;
    const auto spent_before = [&] {
        return (budget.samples > 0 && already >= wanted(budget)) ||
               (budget.error > 0 && already >= 16 && film_.relative_error() <= budget.error);
    };
    double fraction = spent_before() ? 1 : 0;
    while (!pause.stop_requested() && fraction < 1) {
        const std::uint64_t iteration = made_.next(settings_.seed, settings_.first_iteration);
        const RenderCounts counts_before = statistics_.counts;
        const auto forget = [&] {
            film_.discard(executor_);
            statistics_.counts = counts_before;
        };
        auto current = frame(iteration, pause);
        try {
            image_method().iterate(current, state_->value);
        } catch (...) {
            forget();
            throw;
        }
        if (current.broken_off()) {
            forget();
            break;
        }
        film_.commit(executor_);
        made_.add(settings_.seed, iteration);
        statistics_.iterations = film_.iterations();
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        statistics_.seconds = seconds_before + seconds;
        fraction = std::max(fraction, spent(budget, seconds, already));  // an estimated error may also grow
        if (settings_.observer) {
            note_method();
            settings_.observer({.iterations = film_.iterations(),
                                .seconds = seconds,
                                .fraction = fraction,
                                .seconds_left = detail::seconds_left(seconds, fraction),
                                .film = film_});
        }
    }
    statistics_.cancelled = pause.stop_requested();
    statistics_.seconds = seconds_before + std::chrono::duration<double>(Clock::now() - begin).count();
    if (film_.iterations() > already) note_method();
}

template <class SceneType, class M, Executor E>
bool Session<SceneType, M, E>::has_history() {
    return !std::is_empty_v<StateValue> && detail::depends_on_history<M>();
}

template <class SceneType, class M, Executor E>
std::string Session<SceneType, M, E>::method_state() const {
    std::string bytes;
    if constexpr (detail::Kept<StateValue, detail::ArchiveWriter>) detail::ArchiveWriter{bytes}(state_->value);
    else if (has_history())
        throw Error("the method " + std::string(M::name) +
                    " keeps something from one iteration to the next and does not say how to write it: its state needs "
                    "`keep(archive)`, or the method a `dependence` other than on its history");
    return bytes;
}

template <class SceneType, class M, Executor E>
void Session<SceneType, M, E>::restore(Film film, IterationSet made, RenderStatistics statistics,
                                       [[maybe_unused]] detail::ByteReader method_state) {
    if (film.width() != film_.width() || film.height() != film_.height() || made.count() != film.iterations())
        throw Error("that film is not of this render");
    if constexpr (detail::Kept<StateValue, detail::ArchiveReader>) detail::ArchiveReader{method_state}(state_->value);
    film_ = std::move(film);
    made_ = std::move(made);
    statistics.threads = statistics_.threads;
    statistics_ = std::move(statistics);
}

template <class SceneType, class M, Executor E>
Film Session<SceneType, M, E>::film_of(std::uint64_t iteration) {
    Film film(film_.width(), film_.height());
    RenderCounts counts;
    auto preparation = frame(Frame<SceneType, E>::before_the_first, {}, film, counts);
    State state{image_method().start(preparation)};
    film.discard(executor_);
    auto only = frame(iteration, {}, film, counts);
    image_method().iterate(only, state.value);
    film.commit(executor_);
    return film;
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
                       {"seed", made_.ranges().empty() ? std::to_string(settings_.seed) : made_.seeds()},
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
