#pragma once

// The trade between time and accuracy: every method under equal time on one scene.

#include <lightswitch/sweep/measurement.hpp>
#include <lightswitch/sweep/pilot.hpp>
#include <lightswitch/sweep/sweep_options.hpp>

#include <lightswitch/core/sampler.hpp>

#include <memory>

namespace lightswitch {

namespace detail {

/// One run of a sweep: the clock starts when it is made.
class Sweeping {
public:
    Sweeping(std::span<const Contender> contenders, const SweepOptions& options)
        : contenders_(contenders), options_(options) {
        if (contenders_.empty()) throw Error("a sweep needs a method");
        if (!(options_.seconds > 0)) throw Error("the seconds of a sweep must be positive");
        if (!(options_.reference_seconds >= 0)) throw Error("the seconds of a reference must be positive, or 0");
        if (options_.seeds < 1) throw Error("a sweep needs a seed at least");
        for (const Contender& c : contenders_)
            if (c.kind == Kind::heuristic)
                throw Error(c.name + " is heuristic: it makes a picture of the scene, and has no error");
        total_ = double(options_.seeds) * double(contenders_.size()) * options_.seconds;
    }

    /// Two pilots of every candidate, and then most of the time for the best; a quarter of it for the second, or for
    /// other seeds of the same where there is no second.
    std::optional<Reference> make_reference() {
        const double seconds = reference_seconds();
        total_ += seconds;
        what_ = "pilots";
        const std::vector<std::size_t> candidates = reference_candidates(contenders_);
        if (candidates.empty())
            throw Error("no method is unbiased, so that none can make a reference: give one, or a method more");
        std::vector<Pilot> pilots;
        const double share = 0.1 * seconds / double(candidates.size());
        for (const std::size_t c : candidates) {
            pilots.push_back({.contender = c, .images = {}, .seconds = 0});
            for (int i = 0; i < 2; ++i) {
                TimedSession session(contenders_[c], settings(next_reference_seed()), options_.clock);
                if (!advance(session, share)) return {};
                pilots.back().images.add(session.session().image());
                pilots.back().seconds += session.seconds() / 2;
            }
        }
        const auto order = by_inefficiency(pilots);
        what_ = "reference";
        const std::size_t first = pilots[order[0]].contender,
                          second = pilots[order[order.size() > 1 ? 1 : 0]].contender;
        const auto a = images(first, 0.6 * seconds), b = images(second, 0.2 * seconds);
        if (a.size() < 2 || b.size() < 2) return {};
        Reference reference = join(a, b);
        reference.first = contenders_[first].name;
        reference.second = contenders_[second].name;
        reference.missing = contenders_[first].missing;
        return reference;
    }

    Sweep measure(Reference reference) {
        Sweep result;
        result.seconds = options_.seconds;
        std::vector<Course> courses(contenders_.size());
        for (int i = 0; i < options_.seeds && !options_.stop.stop_requested(); ++i) {
            const double seeds_left = double(options_.seeds - 1 - i);
            replicate(reference, courses, i);
            // Later seeds may take less than was planned.
            done_ = std::max(done_, total_ - seeds_left * double(contenders_.size()) * options_.seconds);
            result.seeds += options_.stop.stop_requested() ? 0 : 1;
        }
        result.stopped = options_.stop.stop_requested();
        judge(reference, result, courses);
        for (std::size_t m = 0; m < courses.size(); ++m)
            if (!courses[m].points.empty())
                result.methods.push_back(
                    finish(contenders_[m], std::move(courses[m]), reference, 0.1 * reference.relmse));
        result.reference = std::move(reference);
        return result;
    }

private:
    static constexpr int doublings = 10;

    /// What one method did.
    struct Course {
        std::vector<SweepPoint> points;
        std::vector<int> left;  // of each point: how often its time can be doubled
        Image image;            // of the first seed
        ImageMoments images;    // the last of every seed
        double seconds = 0, rays = 0;
    };

    double reference_seconds() const {
        return options_.reference_seconds > 0 ? options_.reference_seconds : 12 * options_.seconds;
    }
    /// Seeds that no image of the sweep itself has.
    std::uint64_t next_reference_seed() { return mix64(mix64(options_.seed) + ++reference_seeds_); }

    Settings settings(std::uint64_t seed) {
        return {.seed = seed, .threads = options_.threads, .stop = options_.stop, .observer = [this](const Progress&) {
                    tell();
                }};
    }

    void tell() {
        if (!options_.observer) return;
        const double seconds = now(TimeOf::wall) - begin_;
        fraction_ = std::max(fraction_, std::min((done_ + under_way()) / total_, 1.0));
        options_.observer({seconds, fraction_, detail::seconds_left(seconds, fraction_), what_});
    }

    /// What is being spent on the session at work, and was planned.
    double under_way() const { return current_ ? std::min(current_->seconds(), planned_) - before_ : 0; }
    /// Work on a session that is to take no more than `planned` seconds in all.
    bool work(const TimedSession& session, double planned, auto&& f) {
        current_ = &session;
        planned_ = planned;
        before_ = std::min(session.seconds(), planned);
        const bool whole = f();
        done_ += under_way();
        current_ = nullptr;
        return whole;
    }
    bool advance(TimedSession& session, double seconds) {
        return work(session, seconds, [&] { return session.advance_to(seconds); });
    }

    /// Eight of one method in so many seconds.
    std::vector<Image> images(std::size_t contender, double seconds) {
        constexpr int count = 8;
        std::vector<Image> result;
        for (int i = 0; i < count; ++i) {
            TimedSession session(contenders_[contender], settings(next_reference_seed()), options_.clock);
            if (!advance(session, seconds / count)) break;
            result.push_back(session.session().image());
        }
        return result;
    }

    /// One image of every method, in turn: each time until all have had twice as much, so that a machine which slows
    /// down is slower for all. The first seed finds out how many iterations fit; the others make as many.
    void replicate(const Reference& reference, std::vector<Course>& courses, int seed) {
        const auto stopped = [&] { return options_.stop.stop_requested(); };
        std::vector<std::unique_ptr<TimedSession>> sessions;
        for (const Contender& c : contenders_) {
            if (stopped()) break;
            what_ = c.name;
            sessions.push_back(std::make_unique<TimedSession>(
                c, settings(options_.seed + static_cast<std::uint64_t>(seed)), options_.clock));
            done_ += std::min(sessions.back()->seconds(), options_.seconds);
            refuse_unless_comparable(sessions.back()->session().image(), reference.image);
        }
        std::vector<std::size_t> looks(sessions.size());
        for (int left = doublings; left >= 0; --left)
            for (std::size_t m = 0; m < sessions.size() && !stopped(); ++m) {
                what_ = contenders_[m].name;
                TimedSession& session = *sessions[m];
                Course& course = courses[m];
                bool whole = false;
                if (seed == 0) {
                    const double until = std::ldexp(options_.seconds, -left);
                    if (session.seconds() >= until && (left > 0 || session.iterations() > 0)) continue;
                    whole = work(session, options_.seconds, [&] { return session.advance_to(until); });
                    if (whole) {
                        course.points.push_back({.iterations = session.iterations()});
                        course.left.push_back(left);
                    }
                } else if (looks[m] < course.left.size() && course.left[looks[m]] == left) {
                    whole = work(session, options_.seconds,
                                 [&] { return session.advance_to_iteration(course.points[looks[m]].iterations); });
                }
                if (!whole) continue;
                SweepPoint& point = course.points[looks[m]++];
                point.errors.push_back(relmse(session.session().film().image(), reference.image));
                point.seconds += (session.seconds() - point.seconds) / double(point.errors.size());
            }
        for (std::size_t m = 0; m < sessions.size(); ++m) {
            if (sessions[m]->iterations() == 0) continue;
            Course& course = courses[m];
            const AnySession& session = sessions[m]->session();
            const Image image = session.image();
            if (seed == 0) course.image = image;
            if (!course.points.empty() && sessions[m]->iterations() == course.points.back().iterations)
                course.images.add(image);
            course.seconds += sessions[m]->seconds();
            course.rays += double(session.statistics().counts.rays);
        }
    }

    /// What the reference's own error is if it was given: what the best unbiased method's variance does not explain.
    void judge(Reference& reference, Sweep& result, const std::vector<Course>& courses) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < courses.size(); ++m) {
            const Course& course = courses[m];
            const Contender& c = contenders_[m];
            if (c.kind != Kind::unbiased || (c.missing - reference.missing).any() || course.images.count() < 2)
                continue;
            const double variance = course.images.relative_variance(reference.image);
            if (variance >= least) continue;
            least = variance;
            result.seen_noise = std::max(0.0, course.points.back().error() - variance);
        }
        if (reference.first.empty()) reference.relmse = result.seen_noise.value_or(0);
    }

    SweptMethod finish(const Contender& contender, Course&& course, const Reference& reference, double least) const {
        SweptMethod method{.name = contender.name, .kind = contender.kind, .missing = contender.missing};
        for (SweepPoint& p : course.points)
            for (double& e : p.errors) e -= reference.relmse;
        method.last = course.points.back();
        const auto lost = [&](const SweepPoint& p) { return !(p.error() > 0 && p.error() >= least); };
        course.points.erase(std::find_if(course.points.begin(), course.points.end(), lost), course.points.end());
        method.curve = std::move(course.points);
        method.image = std::move(course.image);
        method.rays_per_second = course.seconds > 0 ? course.rays / course.seconds : 0;
        method.typical = median_of_tiles(method.image, reference);
        const Estimate level = course.images.level();
        if (reference.level.mean > 0) {
            method.bias = level.mean / reference.level.mean - 1;
            if (course.images.count() > 1) {
                const Interval interval = welch_interval(level, reference.level, 0.01);
                method.bias_interval = {interval.low / reference.level.mean, interval.high / reference.level.mean};
            }
        }
        if (course.images.count() > 1) {
            method.variance = course.images.relative_variance(reference.image);
            method.inefficiency = method.variance * method.last.seconds;
        }
        return method;
    }

    static double median_of_tiles(const Image& image, const Reference& reference) {
        constexpr int n = 8;
        std::vector<double> tiles;
        for (int t = 0; t < n * n; ++t) {
            double pixels = 0;
            const double sum = over_tile(image.width(), image.height(), n, t % n, t / n, [&](std::size_t i) {
                ++pixels;
                const DVec3 r(reference.image.pixels()[i]), d = DVec3(image.pixels()[i]) - r;
                return sum_of(d * d / (r * r + metric_offset)) - sum_of(DVec3(reference.noise.pixels()[i]));
            });
            if (pixels > 0) tiles.push_back(sum / (3 * pixels));
        }
        std::nth_element(tiles.begin(), tiles.begin() + std::ptrdiff_t(tiles.size() / 2), tiles.end());
        return tiles[tiles.size() / 2];
    }

    std::span<const Contender> contenders_;
    SweepOptions options_;
    double begin_ = now(TimeOf::wall), total_ = 0, done_ = 0, fraction_ = 0;  // seconds of `SweepOptions::clock`
    std::uint64_t reference_seeds_ = 0;
    const TimedSession* current_ = nullptr;  // at work; what it has spent since `before_` is not in `done_` yet
    double before_ = 0, planned_ = 0;
    std::string what_;
};

}  // namespace detail

/// Measures the contenders against a reference. An empty result, with `stopped`, when the run ends before the first
/// iteration.
inline Sweep sweep(std::span<const Contender> contenders, Reference reference, const SweepOptions& options = {}) {
    return detail::Sweeping(contenders, options).measure(std::move(reference));
}
/// The same against an image whose own error is not known.
inline Sweep sweep(std::span<const Contender> contenders, Image reference, const SweepOptions& options = {}) {
    return sweep(contenders, Reference::given(std::move(reference)), options);
}
/// The same against a reference that two of them make: the unbiased one whose pilots are best, and the second, which
/// checks it. An empty result, with `stopped`, when the run ends before there is one.
inline Sweep sweep(std::span<const Contender> contenders, const SweepOptions& options = {}) {
    detail::Sweeping sweeping(contenders, options);
    if (auto reference = sweeping.make_reference()) return sweeping.measure(std::move(*reference));
    return {.stopped = true};
}

}  // namespace lightswitch
