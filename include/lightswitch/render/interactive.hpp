#pragma once

// Rendering in the background while somebody looks: methods are switched, the camera moves, and nobody waits.

#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/film/film_description.hpp>
#include <lightswitch/render/any_session.hpp>
#include <lightswitch/render/coarse.hpp>
#include <lightswitch/render/snapshot.hpp>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace lightswitch {

/// Renders on a thread of its own by the methods that are shown, and keeps what each has made until the camera moves.
/// `SceneType` is a scene, or a `std::variant` of scenes such as `AnyScene`, which is shared and never copied whole.
///
/// After a move the first pictures are coarse, so that something is there within a moment, whatever the image's size.
/// Every image is what `render` makes of as many samples, bit for bit, however often methods were switched in between.
/// All members may be called from any thread; none of them waits for the renderer but `wait` and the destructor, which
/// ends the iteration that is under way. It can be neither copied nor moved.
template <class SceneType>
class InteractiveRender {
public:
    /// `camera` is the one that the scene has, as long as nobody moves it. `updated` is called on the rendering thread
    /// whenever a snapshot has changed. Of the settings `stop` and `observer` are not used.
    InteractiveRender(SceneType scene, const CameraDescription& camera, const Settings& settings = {},
                      std::function<void()> updated = {})
        : settings_(settings),
          updated_(std::move(updated)),
          scene_(std::make_shared<const SceneType>(std::move(scene))),
          camera_(camera) {
        settings_.observer = {};
        thread_ = std::jthread([this] { work(); });
    }
    ~InteractiveRender() {
        change(Interruption::abandon, [&] { ending_ = true; });
    }

    /// A further method, or `std::variant` of methods, which is not shown yet; returns its number, counted from 0.
    /// `coarse` makes the coarse pictures.
    template <class M, class Coarse>
    std::size_t add(const M& method, const Coarse& coarse) {
        Track track;
        track.make = maker(method);
        track.make_coarse = maker(coarse);
        const std::lock_guard lock(mutex_);
        tracks_.push_back(std::move(track));
        return tracks_.size() - 1;
    }
    template <class M>
    std::size_t add(const M& method) {
        return add(method, method);
    }

    /// Renders by these methods from now on, in turns that give each the same time; by none when the list is empty.
    void show(std::vector<std::size_t> methods) {
        change(Interruption::pause, [&] {
            for (const std::size_t method : methods) tracks_.at(method).turn = 0;
            shown_ = std::move(methods);
            forget_older();
        });
    }
    void show(std::size_t method) { show(std::vector<std::size_t>{method}); }

    /// Looks from elsewhere: everything begins anew. Throws `Error` for a camera or film that is impossible, and then
    /// nothing changes.
    void move(const CameraDescription& camera, const FilmDescription& film) {
        auto moved = std::make_shared<const SceneType>(seen_by(*scene(), camera, film));
        change(Interruption::abandon, [&] {
            scene_ = std::move(moved);
            camera_ = camera;
            ++view_;
            moved_ = true;
            forget_older();
        });
    }

    /// Each method rests when it has made so many iterations; 0, as at first, is no limit.
    void limit(std::uint64_t iterations) {
        change(Interruption::none, [&] { limit_ = iterations; });
    }

    /// What the method has made; nothing before its first picture. After a move, of a method that is shown it is of the
    /// view before until there is something newer, so that nothing flashes.
    std::shared_ptr<const Snapshot> snapshot(std::size_t method) const {
        const std::lock_guard lock(mutex_);
        return tracks_.at(method).snapshot;
    }

    /// The scene as it is seen now.
    std::shared_ptr<const SceneType> scene() const {
        const std::lock_guard lock(mutex_);
        return scene_;
    }

    /// Waits until nothing is left to do for the shown methods: never without a limit, unless they fail.
    void wait() const {
        std::unique_lock lock(mutex_);
        at_rest_.wait(lock, [&] { return resting_; });
    }

private:
    using Clock = std::chrono::steady_clock;
    using Maker = std::function<detail::AnySession(const SceneType&, const Settings&)>;
    enum class Interruption { none, pause, abandon };

    /// A method. The rendering thread alone uses what is not about snapshots and turns.
    struct Track {
        Maker make, make_coarse;
        std::shared_ptr<const SceneType> scene;  // that the session refers to
        std::optional<detail::AnySession> session;
        int coarse = 0;                // how many times smaller the last coarse picture was; 0 before the first
        double seconds_per_pixel = 0;  // of an iteration, or of the last coarse picture
        Clock::duration copying{};     // what the last snapshot cost
        Clock::time_point copied{};
        std::uint64_t copied_iterations = 0;
        bool failed = false;
        double turn = 0;  // seconds since it is shown
        std::shared_ptr<const Snapshot> snapshot;
    };

    /// What the rendering thread does next, and by what.
    struct Task {
        std::shared_ptr<const SceneType> scene;
        CameraDescription camera;  // of the scene
        std::uint64_t view, limit;
        std::stop_token pause, abandon;
    };

    template <class M>
    static Maker maker(const M& method) {
        return [method](const SceneType& any_scene, const Settings& settings) {
            return detail::visit_any(
                [&](const auto& scene) {
                    return detail::visit_any(
                        [&](const auto& m) { return detail::AnySession::make(scene, m, settings); }, method);
                },
                any_scene);
        };
    }

    void change(Interruption interruption, const auto& apply) {
        {
            const std::lock_guard lock(mutex_);
            apply();
            resting_ = false;
            if (interruption == Interruption::abandon) abandon_.request_stop();
            if (interruption != Interruption::none) pause_.request_stop();
        }
        wake_.notify_one();
    }

    void work() {
        std::unique_lock lock(mutex_);
        while (!ending_) {
            pause_ = {};
            if (moved_) begin_anew();
            Track* const track = next();
            if (!track) {
                resting_ = true;
                at_rest_.notify_all();
                wake_.wait(lock, [&] { return ending_ || !resting_; });
                continue;
            }
            const Task task{scene_, camera_, view_, limit_, pause_.get_token(), abandon_.get_token()};
            lock.unlock();
            const auto begin = Clock::now();
            std::shared_ptr<const Snapshot> made;
            try {
                made = advance(*track, task);
            } catch (const std::exception& error) {
                track->failed = true;
                made = std::make_shared<const Snapshot>(Snapshot{.view = task.view, .failure = error.what()});
            }
            lock.lock();
            track->turn += seconds_since(begin);
            if (!made || moved_) continue;
            track->snapshot = std::move(made);
            if (updated_) {
                lock.unlock();
                updated_();
                lock.lock();
            }
        }
    }

    /// The shown method that is to go on: of those that are not done, the one that had the least time. Called locked.
    Track* next() {
        Track* best = nullptr;
        for (const std::size_t number : shown_) {
            Track& track = tracks_[number];
            const bool done =
                track.failed || (limit_ > 0 && track.session && track.session->film().iterations() >= limit_ &&
                                 track.copied_iterations == track.session->film().iterations());
            if (!done && (!best || track.turn < best->turn)) best = &track;
        }
        return best;
    }

    /// Pictures of earlier views, but of what is shown. Called locked.
    void forget_older() {
        for (std::size_t i = 0; i < tracks_.size(); ++i)
            if (auto& kept = tracks_[i].snapshot;
                kept && kept->view != view_ && std::find(shown_.begin(), shown_.end(), i) == shown_.end())
                kept.reset();
    }

    /// Called locked.
    void begin_anew() {
        moved_ = false;
        abandon_ = {};
        for (Track& track : tracks_) {
            track.session.reset();
            track.scene.reset();
            track.coarse = 0;
            track.copied_iterations = 0;
            track.failed = false;
        }
    }

    static SceneType seen_by(const SceneType& any_scene, const CameraDescription& camera, const FilmDescription& film) {
        return detail::visit_any([&](const auto& scene) -> SceneType { return scene.with_camera(camera, film); },
                                 any_scene);
    }

    /// Makes the next coarse picture or iteration; returns a snapshot when it is time for one. Called unlocked.
    std::shared_ptr<const Snapshot> advance(Track& track, const Task& task) {
        if (!track.session) {
            const int divisor = detail::next_coarse(film_of(*task.scene), track.seconds_per_pixel, track.coarse);
            if (divisor > 1) return coarse_picture(track, task, divisor);
            auto session = track.make(*task.scene, settings(task));
            if (task.abandon.stop_requested()) return {};
            track.scene = task.scene;
            track.session = std::move(session);
        }
        const detail::AnySession& session = *track.session;
        const std::uint64_t before = session.film().iterations();
        if (task.limit == 0 || before < task.limit) {
            const auto begin = Clock::now();
            session.run({.samples = static_cast<int>(before + 1)}, task.pause);
            if (session.film().iterations() > before)
                track.seconds_per_pixel = seconds_since(begin) / double(session.film().area());
        }
        return copy_when_due(track, task);
    }

    Settings settings(const Task& task) const {
        Settings result = settings_;
        result.stop = task.abandon;
        return result;
    }

    /// A copy costs milliseconds, so it is made when it adds a few percent to the time at most, and of the first and
    /// the last iteration.
    static std::shared_ptr<const Snapshot> copy_when_due(Track& track, const Task& task) {
        const detail::AnySession& session = *track.session;
        const std::uint64_t iterations = session.film().iterations();
        const bool is_last = task.limit > 0 && iterations >= task.limit;
        const auto begin = Clock::now();
        const bool is_due =
            begin - track.copied > std::max<Clock::duration>(40 * track.copying, std::chrono::milliseconds(30));
        if (iterations == track.copied_iterations || (!is_due && !is_last && iterations > 1)) return {};
        auto snapshot = std::make_shared<Snapshot>(Snapshot{.view = task.view,
                                                            .iterations = iterations,
                                                            .image = session.image(),
                                                            .variance = session.film().variance(),
                                                            .error = session.film().relative_error(),
                                                            .statistics = session.statistics()});
        track.copied_iterations = iterations;
        track.copied = Clock::now();
        track.copying = track.copied - begin;
        return snapshot;
    }

    static FilmDescription film_of(const SceneType& any_scene) {
        return detail::visit_any([](const auto& scene) { return scene.film(); }, any_scene);
    }

    std::shared_ptr<const Snapshot> coarse_picture(Track& track, const Task& task, int divisor) const {
        FilmDescription film = film_of(*task.scene);
        film.resize(film.width / divisor, film.height / divisor);
        const SceneType small = seen_by(*task.scene, task.camera, film);
        const auto begin = Clock::now();
        const detail::AnySession session = track.make_coarse(small, settings(task));
        session.run({.samples = 1}, task.abandon);
        if (session.film().iterations() == 0) return {};
        track.coarse = divisor;
        track.seconds_per_pixel = seconds_since(begin) / double(session.film().area());
        return std::make_shared<const Snapshot>(
            Snapshot{.view = task.view, .image = session.image(), .statistics = session.statistics()});
    }

    static double seconds_since(Clock::time_point begin) {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    }

    Settings settings_;
    std::function<void()> updated_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    mutable std::condition_variable at_rest_;
    // What follows is used locked, but for what a track keeps for the rendering thread.
    std::shared_ptr<const SceneType> scene_;
    CameraDescription camera_;  // of `scene_`
    std::deque<Track> tracks_;  // a track stays where it is
    std::vector<std::size_t> shown_;
    std::uint64_t limit_ = 0, view_ = 0;
    bool moved_ = false, ending_ = false, resting_ = false;
    std::stop_source pause_, abandon_;
    std::jthread thread_;
};

}  // namespace lightswitch
