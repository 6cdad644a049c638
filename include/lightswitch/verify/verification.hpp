#pragma once

// The statistical test behind `verify`: when to look, when to stop, and what is known then.

#include <lightswitch/verify/conclusion.hpp>
#include <lightswitch/verify/schedule.hpp>
#include <lightswitch/verify/test_of_parts.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

namespace lightswitch {

/// Compares methods with one reference, in one run.
///
/// Every method renders independent images. Their means over tiles of all sizes, from the whole to a few pixels, are
/// compared with the reference's by Welch's t-test (Jung, Hanika and Dachsbacher 2020, "Detecting Bias in Monte Carlo
/// Renderers using Welch's t-test"), for all path lengths together and one by one. Beyond that paper:
///
/// - Rare bright paths: p-values and intervals are corrected for the skewness of the side that may have missed some
///   (`welch_p`), so that few of them give "undecided" and not a false alarm.
/// - Sequential: looks are taken at 16, 24, 36, ... images. The k-th may use up 1 / (k (k + 1)) of the rate of false
///   alarms; these sum to 1, so the rate holds over the whole run, however it ends. `TestOfParts` says how it is
///   shared within a look. Files, which are as many as they are, are looked at once, when the other side's noise is
///   small beside theirs.
/// - After the first look time is spent where the noise is: n images of variance v that take c seconds each are made in
///   proportion to sqrt(v / c), which gives the difference the least variance for its time.
/// - A consistent method is rendered with twice the samples at every look, and its bias must fall: see
///   `TestOfParts` and `BiasHistory`.
/// - Paths that only one side can make (`Estimator::missing`) are left out by the other, if it can
///   (`Estimator::can_leave_out`); or else a side is not accused of being the darker one where they may be.
/// - Pixels whose errors are correlated although the method renders them one by one are found, too.
class Verification {
public:
    /// Throws `Error` for what cannot be compared: heuristic methods, a reference that is not unbiased, options out
    /// of range.
    Verification(const Estimator& reference, const std::vector<Estimator>& methods, const VerifyOptions& options)
        : options_(options) {
        if (!(options.confidence > 0 && options.confidence < 1))
            throw Error("the confidence must be between 0 and 1, such as 0.999");
        if (!(options.tolerance >= 0)) throw Error("the tolerance must be 0 or a positive fraction, such as 0.01");
        if (!(options.seconds > 0) && options.images <= 0)
            throw Error("verify needs a limit: seconds, or a number of images");
        if (reference.kind != Kind::unbiased)
            throw Error("the reference must be unbiased: " + reference.name + " is " +
                        std::string(name(reference.kind)));
        for (const Estimator& method : methods) {
            if (method.kind == Kind::heuristic)
                throw Error(method.name +
                            " is heuristic: it makes a picture of the scene, not of its light transport, and has "
                            "no expected image that it could share with " +
                            reference.name);
            if (method.kind == Kind::consistent && method.available > 0)
                throw Error(method.name +
                            " is consistent: images of one number of samples do not show whether its bias shrinks");
            add(method, reference);
        }
        if (subjects_.empty()) throw Error("there is no method to verify");
    }
    /// Methods refer to their references in here.
    Verification(const Verification&) = delete;
    Verification& operator=(const Verification&) = delete;

    /// One verdict per method, in their order. Throws `Error` for images of different sizes, and what rendering throws.
    std::vector<Verdict> run() {
        detail::Schedule schedule(options_, references_, subjects_);
        double target = detail::first_look;
        for (int look = 1;; ++look, target *= 1.5) {
            while (!schedule.set_goals(look, target) && !schedule.exhausted()) target *= 1.5;
            schedule.draw();
            const bool last = schedule.over() || schedule.exhausted();
            for (Subject& s : subjects_) {
                if (s.decided) continue;
                judge(s, look, last, schedule);
                if (options_.looked) options_.looked(detail::conclude(s, options_));
            }
            if (last || std::all_of(subjects_.begin(), subjects_.end(), [](const Subject& s) { return s.decided; }))
                break;
        }
        std::vector<Verdict> verdicts;
        for (Subject& s : subjects_) verdicts.push_back(detail::conclude(s, options_));
        return verdicts;
    }

private:
    using Subject = detail::Subject;
    // 200 MB; of larger images the latest are kept.
    static constexpr std::size_t most_snapshot_pixels = std::size_t{1} << 24;

    /// Finds out what can be compared, and with which images of the reference.
    void add(const Estimator& method, const Estimator& reference) {
        Subject& s = subjects_.emplace_back(method, options_, subjects_.size() + 1);
        const PathClasses ours = method.missing - reference.missing, theirs = reference.missing - method.missing;
        const PathClasses by_reference = ours & reference.can_leave_out, by_us = theirs & method.can_leave_out;
        s.replicas.leave_out(by_us);
        s.verdict.left_out = by_reference | by_us;
        s.verdict.method_lacks = ours - by_reference;
        s.verdict.reference_lacks = theirs - by_us;
        for (const detail::Replicas& r : references_)
            if (r.left_out() == by_reference) s.reference = &r;
        if (s.reference) return;
        // A stream of its own, which no method has.
        s.reference =
            &references_.emplace_back(reference, options_.path_lengths, options_.seed, references_.size() << 32);
        references_.back().leave_out(by_reference);
    }

    void judge(Subject& s, int look, bool last, const detail::Schedule& schedule) {
        Verdict& v = s.verdict;
        const detail::Replicas& reference = *s.reference;
        if (!reference.usable() || !s.replicas.usable()) return;
        if (s.history && double(s.replicas.count()) < s.images && s.replicas.count() <= v.images)
            return;  // the look before says more
        const Image image = s.replicas.image();
        refuse_unless_comparable(image, reference.image());
        const bool only = detail::is_fixed(s.replicas) || detail::is_fixed(reference);
        if (only && !last && !schedule.worth_the_only_look(s.replicas, reference)) return;
        const double alpha = 1 - options_.confidence, level = only ? alpha : alpha / (look * (look + 1.0));
        const detail::OneSided one_sided{v.method_lacks, v.reference_lacks};
        const detail::TestOfParts test(s.replicas, reference, 0.95 * level, one_sided,
                                       s.history ? &*s.history : nullptr);

        v.parts = test.parts;
        v.p_values = test.p_values;
        v.events = test.events;
        v.images = s.replicas.count();
        v.samples = s.replicas.samples_drawn();
        v.image = image;
        s.needed_tolerance = one_sided.any() ? std::numeric_limits<double>::infinity() : test.needed_tolerance;
        s.rare = test.needed_tolerance > 1.5 * test.plain_tolerance;
        s.stuck = test.stuck_somewhere;
        s.alarms.resize(v.parts.size(), false);
        for (std::size_t i = 0; i < s.alarms.size(); ++i)
            v.parts[i].disagrees = s.alarms[i] = s.alarms[i] || v.parts[i].disagrees;
        v.correlated_pixels = v.correlated_pixels || s.replicas.pixel_correlation_p() < 0.05 * level;
        v.curve.push_back({s.replicas.seconds(), v.samples, 0});
        s.snapshots.push_back(image);
        while (s.snapshots.size() > 1 && s.snapshots.size() * image.pixels().size() > most_snapshot_pixels)
            s.snapshots.erase(s.snapshots.begin());

        const bool biased = std::find(s.alarms.begin(), s.alarms.end(), true) != s.alarms.end();
        if (biased || v.correlated_pixels) {
            // The length at which it begins may take longer to see than the whole.
            if (s.alarm_at == 0) {
                s.alarm_at = s.replicas.count();
                v.found_after = schedule.elapsed();
            }
            s.where_is_known = detail::localised(v, options_.confidence);
            s.decided = s.history || s.where_is_known || s.replicas.count() >= (biased ? 16 : 2) * s.alarm_at;
        } else {
            s.decided = options_.tolerance > 0 && s.needed_tolerance <= options_.tolerance;
        }
        s.decided = s.decided || only;
        v.seconds_to_decide = s.decided || biased ? 0 : expected_seconds(s, schedule.elapsed());
        if (s.history && !s.decided && !last) prepare_next_look(s, test, schedule);
    }

    /// More images make noise less, more samples of each the bias of a consistent method.
    void prepare_next_look(Subject& s, const detail::TestOfParts& test, const detail::Schedule& schedule) {
        const bool noisy = options_.tolerance > 0 && test.observed_bias < 0.45 * test.needed_tolerance;
        // Of the time of one of today's. Against noise a few more are worth having, as many as there is time for.
        const double images_needed = noisy ? 1 : 2 * s.images;
        if (schedule.over(images_needed * s.replicas.seconds_per_image())) {
            s.decided = true;  // as far as it can be: the next look would not be ready in time
        } else if (noisy) {
            s.images = std::ceil(1.5 * s.images);
        } else {
            s.history->add(double(s.replicas.samples()), test.differences());
            s.replicas.restart(2);
        }
    }

    /// When the tolerance will be met, from the beginning, if things go on as they are: noise falls as the root of the
    /// time, what may be missing as the time. 0 when nothing can be said.
    double expected_seconds(const Subject& s, double elapsed) const {
        if (!(options_.tolerance > 0) || !(s.needed_tolerance < 1e6)) return 0;
        const double ratio = s.needed_tolerance / options_.tolerance;
        return elapsed * (s.rare ? ratio : ratio * ratio);
    }

    VerifyOptions options_;
    std::deque<detail::Replicas> references_;  // one, unless methods call for different paths to be left out
    std::vector<Subject> subjects_;
};

}  // namespace lightswitch
