#pragma once

// Which images a verification makes next, and when its time is up.

#include <lightswitch/verify/subject.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <utility>
#include <vector>

namespace lightswitch::detail {

/// Draws the images of all sides. The clock starts when it is made.
class Schedule {
public:
    /// Chooses the samples of the images. Refers to all that it is given.
    Schedule(const VerifyOptions& options, std::deque<Replicas>& references, std::vector<Subject>& subjects)
        : options_(options), references_(references), subjects_(subjects) {
        for (Replicas& r : references_) prepare(r);
        for (Subject& s : subjects_) {
            prepare(s.replicas);
            // Whether bias shrinks shows over many doublings.
            if (s.history && options_.samples == 0) s.replicas.restart(0.125);
            s.begun_with = s.replicas.samples();
        }
    }

    double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

    /// Whether time is up, or would be when so many more seconds were spent.
    bool over(double more = 0) const {
        return options_.stop.stop_requested() || (options_.seconds > 0 && elapsed() + more >= options_.seconds);
    }

    /// Whether there are as many images as there may be.
    bool exhausted() const {
        return std::all_of(subjects_.begin(), subjects_.end(), [&](const Subject& s) {
            if (s.decided) return true;
            // A consistent method's images count as many as the first ones that would have taken as long.
            const double as_many = s.images * double(s.replicas.samples()) / s.begun_with;
            return s.history ? as_many >= double(most(s.replicas)) && double(s.replicas.count()) >= s.images
                             : s.reference->count() >= most(*s.reference) && s.replicas.count() >= most(s.replicas);
        });
    }

    /// Whether this is the time for the only look at a fixed number of images: the other side adds little to their
    /// noise.
    bool worth_the_only_look(const Replicas& a, const Replicas& b) const {
        const auto noise = [](const Replicas& r) { return r.estimates(0, 0)[0][1].variance; };
        return (is_fixed(a) || noise(a) <= 0.05 * noise(b)) && (is_fixed(b) || noise(b) <= 0.05 * noise(a)) &&
               a.count() >= (is_fixed(a) ? most(a) : first_look) && b.count() >= (is_fixed(b) ? most(b) : first_look);
    }

    /// Sets how many images everything is to have at this look: as many as take the time of `target` of each, divided
    /// so that the differences have the least variance. False when they are there already.
    bool set_goals(int look, double target) {
        goals_.clear();
        for (const Subject& s : subjects_) {
            if (s.decided) continue;
            const auto [ours, theirs] = divide(s, look, target);
            goals_[&s.replicas] = ours;
            goals_[s.reference] = std::max(goals_[s.reference], theirs);
        }
        return std::any_of(goals_.begin(), goals_.end(),
                           [](const auto& goal) { return goal.first->count() < goal.second; });
    }

    /// Draws what is missing, a few images of each in turn, so that all have their share when time runs out.
    void draw() {
        for (;;) {
            Replicas* next = nullptr;
            double least = 1;
            const auto consider = [&](Replicas& r, bool seen) {
                const auto goal = goals_.find(&r);
                if (goal == goals_.end() || r.count() >= goal->second) return;
                const double done = double(r.count()) / double(goal->second);
                const double seconds = r.seconds_per_image() * double(std::min(r.batch(), goal->second - r.count()));
                if (done >= least || ((seen || r.usable()) && over(seconds))) return;
                least = done;
                next = &r;
            };
            for (Replicas& r : references_) consider(r, false);
            for (Subject& s : subjects_) consider(s.replicas, !s.verdict.parts.empty());
            if (!next || !next->draw(goals_[next] - next->count(), options_.stop, executor_)) return;
            if (options_.observer) options_.observer(progress(*next));
        }
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double seconds_per_image = 0.02;  // short enough to find what is plain to see within a second

    std::uint64_t most(const Replicas& r) const {
        if (r.estimator().available > 0) return r.estimator().available;
        return options_.images > 0 ? static_cast<std::uint64_t>(options_.images)
                                   : std::numeric_limits<std::uint64_t>::max();
    }

    void prepare(Replicas& r) {
        // An image with all its parts is to be rendered ten times at least.
        const double too_long = options_.seconds > 0
                                    ? options_.seconds / (10 * double(subjects_.size() + references_.size()))
                                    : std::numeric_limits<double>::infinity();
        if (options_.samples > 0) r.set_samples(options_.samples);
        else if (r.estimator().available == 0) r.choose_samples(seconds_per_image, too_long, options_.stop);
    }

    /// The images of a method and of its reference.
    std::pair<std::uint64_t, std::uint64_t> divide(const Subject& s, int look, double target) const {
        const Replicas &us = s.replicas, &them = *s.reference;
        // Without a limit of time the course of the run must not depend on how fast the machine is.
        const bool timed = options_.seconds > 0 && us.seconds_per_image() > 0 && them.seconds_per_image() > 0;
        const auto sharing = std::count_if(subjects_.begin(), subjects_.end(), [&](const Subject& other) {
            return !other.decided && other.reference == s.reference;
        });
        const double our_cost = timed ? us.seconds_per_image() : 1;
        const double their_cost = (timed ? them.seconds_per_image() : 1) / double(sharing);
        double ours = s.history ? s.images : target, theirs = target;
        if (look > 1 && us.usable() && them.usable()) {
            const double a = us.variance_per_image(), b = them.variance_per_image();
            if (s.history) {
                if (a > 0) theirs = ours * std::sqrt(b / a * our_cost / their_cost);
            } else if (a + b > 0) {
                const double scale =
                    target * (our_cost + their_cost) / (std::sqrt(a * our_cost) + std::sqrt(b * their_cost));
                ours = scale * std::sqrt(a / our_cost);
                theirs = scale * std::sqrt(b / their_cost);
            }
        }
        const auto images = [&](const Replicas& r, double wanted) {
            // The variances are estimates: no side is neglected.
            const double enough = std::max({wanted, target / 8, double(first_look)});
            return is_fixed(r) || !(enough < double(most(r))) ? most(r) : static_cast<std::uint64_t>(enough);
        };
        return {s.history ? static_cast<std::uint64_t>(ours) : images(us, ours), images(them, theirs)};
    }

    VerifyProgress progress(const Replicas& last) const {
        VerifyProgress result{.seconds = elapsed(), .method = last.estimator().name, .images = last.count()};
        if (options_.seconds > 0) result.fraction = std::min(1.0, result.seconds / options_.seconds);
        for (const Subject& s : subjects_)
            if (!s.decided) result.seconds_to_decide = std::max(result.seconds_to_decide, s.verdict.seconds_to_decide);
        return result;
    }

    const VerifyOptions& options_;
    std::deque<Replicas>& references_;
    std::vector<Subject>& subjects_;
    TbbExecutor executor_{options_.threads};
    std::map<const Replicas*, std::uint64_t> goals_;
    Clock::time_point begin_ = Clock::now();
};

}  // namespace lightswitch::detail
