#pragma once

// The statistical test behind `verify`: when to look, when to stop, and what to say.

#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/test_of_parts.hpp>
#include <lightswitch/compare/verdict.hpp>
#include <lightswitch/compare/verify_options.hpp>

#include <algorithm>
#include <limits>
#include <optional>
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
/// - A consistent method is rendered with twice the samples at every look, and its bias must fall: see
///   `ShrinkingBound`.
/// - Pixels whose errors are correlated although the method renders them one by one are found, too.
class Verification {
public:
    /// Throws `Error` for what cannot be compared: heuristic methods, a reference that is not unbiased, options out
    /// of range.
    Verification(const Estimator& reference, const std::vector<Estimator>& methods, const VerifyOptions& options)
        : options_(options), reference_(reference, options.path_lengths, options.seed, 0) {
        if (!(options.confidence > 0 && options.confidence < 1))
            throw Error("the confidence must be between 0 and 1, such as 0.999");
        if (!(options.tolerance >= 0)) throw Error("the tolerance must be 0 or a positive fraction, such as 0.01");
        if (options.seconds <= 0 && options.images <= 0)
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
            subjects_.emplace_back(method, options, subjects_.size() + 1);
        }
        if (subjects_.empty()) throw Error("there is no method to verify");
    }

    /// One verdict per method, in their order. Throws `Error` for images of different sizes, and what rendering throws.
    std::vector<Verdict> run() {
        begin_ = Clock::now();
        prepare(reference_);
        for (Subject& s : subjects_) prepare(s.replicas);
        double target = first_look;
        for (int look = 1;; ++look, target *= 1.5) {
            const auto wanted = static_cast<std::uint64_t>(target);
            draw(reference_, wanted);
            for (Subject& s : subjects_)
                if (!s.decided) draw(s.replicas, s.bound ? first_look : wanted);
            const bool last = over() || exhausted(wanted);
            for (Subject& s : subjects_)
                if (!s.decided) judge(s, look, last);
            if (last || std::all_of(subjects_.begin(), subjects_.end(), [](const Subject& s) { return s.decided; }))
                break;
        }
        std::vector<Verdict> verdicts;
        for (Subject& s : subjects_) verdicts.push_back(conclude(s));
        return verdicts;
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::uint64_t first_look = 16;
    // 200 MB; of larger images the latest are kept.
    static constexpr std::size_t most_snapshot_pixels = std::size_t{1} << 24;
    static constexpr double seconds_per_image = 0.02;  // short enough to find what is plain to see within a second

    struct Subject {
        Subject(const Estimator& method, const VerifyOptions& options, std::uint64_t stream)
            : replicas(method, options.path_lengths, options.seed, stream) {
            if (method.kind == Kind::consistent) bound.emplace();
        }

        detail::Replicas replicas;
        std::optional<detail::ShrinkingBound> bound;  // of a consistent method
        Verdict verdict;
        bool decided = false;
        std::uint64_t alarm_at = 0;  // number of images when a difference was first found
        std::vector<bool> alarms;    // by part
        std::vector<Image> snapshots;
        bool where_is_known = false;  // the lengths before the first wrong one are known to be right
        double needed_tolerance = std::numeric_limits<double>::infinity();
        bool rare = false;  // what may be missing counts for more than the noise
    };

    double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
    bool over() const {
        return options_.stop.stop_requested() || (options_.seconds > 0 && elapsed() >= options_.seconds);
    }
    std::uint64_t most(const detail::Replicas& r) const {
        if (r.estimator().available > 0) return r.estimator().available;
        return options_.images > 0 ? static_cast<std::uint64_t>(options_.images)
                                   : std::numeric_limits<std::uint64_t>::max();
    }
    bool exhausted(std::uint64_t wanted) const {
        return most(reference_) <= wanted && std::all_of(subjects_.begin(), subjects_.end(), [&](const Subject& s) {
                   return s.decided || most(s.replicas) <= wanted;
               });
    }

    void prepare(detail::Replicas& r) {
        if (options_.samples > 0) r.set_samples(options_.samples);
        else if (r.estimator().available == 0) r.choose_samples(seconds_per_image, too_long(), options_.stop);
    }

    /// An image with all its parts is to be rendered ten times at least.
    double too_long() const {
        return options_.seconds > 0 ? options_.seconds / (10 * double(subjects_.size() + 1))
                                    : std::numeric_limits<double>::infinity();
    }

    void draw(detail::Replicas& r, std::uint64_t wanted) {
        const std::uint64_t goal = std::min(wanted, most(r));
        while (r.count() < goal && !(over() && r.usable())) {
            if (!r.draw(goal - r.count(), options_.stop, executor_)) return;
            if (options_.observer)
                options_.observer({.seconds = elapsed(),
                                   .fraction = options_.seconds > 0 ? std::min(1.0, elapsed() / options_.seconds) : 0,
                                   .method = r.estimator().name,
                                   .images = r.count()});
        }
    }

    static bool is_fixed(const detail::Replicas& r) { return r.estimator().available > 0 && !r.exact(); }

    /// Whether this is the time for the only look at a fixed number of images: the other side adds little to their
    /// noise.
    bool worth_the_only_look(const detail::Replicas& a, const detail::Replicas& b) const {
        const auto noise = [](const detail::Replicas& r) { return r.estimates(0, 0)[0][1].variance; };
        return (is_fixed(a) || noise(a) <= 0.05 * noise(b)) && (is_fixed(b) || noise(b) <= 0.05 * noise(a)) &&
               a.count() >= (is_fixed(a) ? most(a) : first_look) && b.count() >= (is_fixed(b) ? most(b) : first_look);
    }

    void judge(Subject& s, int look, bool last) {
        Verdict& v = s.verdict;
        if (!reference_.usable() || !s.replicas.usable()) return;
        if (s.bound && s.replicas.count() < first_look && !v.parts.empty()) return;  // the look before says more
        const Image image = s.replicas.image();
        refuse_unless_comparable(image, reference_.image());
        const bool only = is_fixed(s.replicas) || is_fixed(reference_);
        if (only && !last && !worth_the_only_look(s.replicas, reference_)) return;
        const double alpha = 1 - options_.confidence, level = only ? alpha : alpha / (look * (look + 1.0));
        const detail::TestOfParts test(s.replicas, reference_, 0.95 * level, s.bound ? &*s.bound : nullptr);

        v.parts = test.parts;
        v.p_values = test.p_values;
        v.events = test.events;
        v.images = s.replicas.count();
        v.samples = s.replicas.samples_drawn();
        v.image = image;
        s.needed_tolerance = test.needed_tolerance;
        s.rare = test.needed_tolerance > 1.5 * test.plain_tolerance;
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
                v.found_after = elapsed();
            }
            s.where_is_known = localised(v);
            s.decided = s.bound || s.where_is_known || s.replicas.count() >= (biased ? 16 : 2) * s.alarm_at;
        } else {
            s.decided = options_.tolerance > 0 && s.needed_tolerance <= options_.tolerance;
        }
        s.decided = s.decided || only;
        if (s.bound && !s.decided && !last) {
            s.bound->learn(test);
            s.replicas.restart_with_twice_the_samples();
        }
    }

    /// The shortest length whose image differs, at a level that is not divided among looks: that there is a
    /// difference is known. 0 when there is none.
    int first_wrong_length(const Verdict& v) const {
        for (const Verdict::Part& part : v.parts)
            if (part.length > 0 && (part.disagrees || part.p < 1 - options_.confidence)) return part.length;
        return 0;
    }

    /// Whether the lengths before the first wrong one are known well enough: a bias of theirs as large, in
    /// proportion, would show.
    bool localised(const Verdict& v) const {
        if (v.parts.size() == 1) return true;
        const int first = first_wrong_length(v);
        if (first == 0) return false;
        const Verdict::Part& wrong = v.parts[static_cast<std::size_t>(first)];
        const auto c = static_cast<std::size_t>(wrong.worst_channel);
        const double relative = wrong.share[c] > 0 ? std::min(1.0, std::abs(wrong.bias[c]) / wrong.share[c]) : 1;
        return std::all_of(v.parts.begin() + 1, v.parts.begin() + first, [&](const Verdict::Part& part) {
            return part.interval[c].high - part.interval[c].low <= relative * part.share[c] || part.share[c] == 0;
        });
    }

    Verdict conclude(Subject& s) {
        Verdict& v = s.verdict;
        v.method = s.replicas.estimator().name;
        v.reference = reference_.estimator().name;
        v.confidence = options_.confidence;
        v.tolerance = options_.tolerance;
        v.seconds = s.replicas.seconds();
        v.reference_seconds = reference_.seconds();
        v.reference_images = reference_.count();
        v.reference_samples = reference_.samples_drawn();
        v.non_finite = s.replicas.non_finite();
        v.reference_non_finite = reference_.non_finite();
        if (v.parts.empty()) {
            v.images = s.replicas.count();
            v.samples = s.replicas.samples_drawn();
            if (v.images > 0) v.image = s.replicas.image();
        }
        if (v.reference_images > 0) v.reference_image = reference_.image();
        v.curve.erase(v.curve.begin(), v.curve.end() - std::ptrdiff_t(s.snapshots.size()));
        for (std::size_t i = 0; i < s.snapshots.size(); ++i)
            v.curve[i].error = std::sqrt(relmse(s.snapshots[i], v.reference_image));
        answer(s);
        return v;
    }

    void answer(Subject& s) {
        using Answer = Verdict::Answer;
        Verdict& v = s.verdict;
        const auto any = [&](auto property) { return std::any_of(v.parts.begin(), v.parts.end(), property); };
        const bool alarm = any([](const auto& part) { return part.disagrees; });
        const bool lasts = any([](const auto& part) { return part.disagrees && part.p < 0.01; });
        const double tolerance = options_.tolerance > 0 ? options_.tolerance : VerifyOptions{}.tolerance;
        if (v.parts.empty()) {
            v.reason = "There are too few images to compare: at least 3 of each are needed.";
        } else if (alarm && !lasts) {
            v.reason = "A difference that was found after " + std::to_string(s.alarm_at) +
                       " images did not last: rare bright paths?";
        } else if (alarm) {
            v.answer = Answer::disagrees;
            if (!s.bound) v.first_wrong_length = first_wrong_length(v);
            v.reason = disagreement(s);
        } else if (v.non_finite > 0) {
            v.answer = Answer::disagrees;
            v.reason =
                std::to_string(v.non_finite) + " of its contributions were not finite and are missing from the images.";
        } else if (v.correlated_pixels) {
            v.answer = Answer::disagrees;
            v.reason = "No bias was found, but pixels share random numbers: their errors move together.";
        } else if (v.reference_non_finite > 0) {
            v.reason = std::to_string(v.reference_non_finite) +
                       " contributions of the reference were not finite and are missing from it: nothing can be said.";
        } else if (s.needed_tolerance <= tolerance) {
            v.answer = Answer::agrees;
            v.reason = detail::format("A bias of more than %.3g %% is ruled out, with a confidence of %.6g %%.",
                                      100 * std::max(s.needed_tolerance, 1e-5), 100 * v.confidence);
        } else {
            v.reason = s.needed_tolerance < 1
                           ? detail::format("A bias of %.3g %% cannot be ruled out: ", 100 * s.needed_tolerance)
                           : std::string("Nothing can be said yet of a bias below 100 %: ");
            const bool fixed = is_fixed(s.replicas) || is_fixed(reference_);
            v.reason += s.rare    ? "the images rest on few rare bright paths."
                        : s.bound ? "whether it shrinks takes more time."
                        : fixed   ? "more images are needed."
                                  : "more time is needed.";
        }
    }

    std::string disagreement(const Subject& s) const {
        const Verdict& v = s.verdict;
        if (s.bound) return "Its bias does not shrink as the samples grow.";
        if (v.first_wrong_length == 0) return "The expected images differ.";
        std::string text =
            "The expected images differ from path length " + std::to_string(v.first_wrong_length) + " on";
        text += s.where_is_known ? "." : " at the latest.";
        if (!v.parts.front().disagrees && v.parts.front().p > 0.5)
            text +=
                " All lengths together show no difference: errors may cancel, or max_depth may not mean what "
                "`PathLength` says.";
        return text;
    }

    VerifyOptions options_;
    TbbExecutor executor_{options_.threads};
    detail::Replicas reference_;
    std::vector<Subject> subjects_;
    Clock::time_point begin_;
};

}  // namespace lightswitch
