#pragma once

// What a verification says in the end, in words.

#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/verify/subject.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace lightswitch::detail {

/// Such as "40 seconds" or "3 hours".
inline std::string rounded_duration(double seconds) {
    if (seconds < 120) return format("%.0f seconds", seconds);
    if (seconds < 7200) return format("%.0f minutes", seconds / 60);
    if (seconds < 172800) return format("%.0f hours", seconds / 3600);
    return format("%.0f days", seconds / 86400);
}

/// The shortest length whose image differs, at a level that is not divided among looks: that there is a
/// difference is known. 0 when there is none.
inline int first_wrong_length(const Verdict& v, double confidence) {
    for (const Verdict::Part& part : v.parts)
        if (part.length > 0 && (part.disagrees || part.p < 1 - confidence)) return part.length;
    return 0;
}

/// Whether the lengths before the first wrong one are known well enough: a bias of theirs as large, in
/// proportion, would show.
inline bool localised(const Verdict& v, double confidence) {
    if (v.parts.size() == 1) return true;
    const int first = first_wrong_length(v, confidence);
    if (first == 0) return false;
    const Verdict::Part& wrong = v.parts[static_cast<std::size_t>(first)];
    const auto c = static_cast<std::size_t>(wrong.worst_channel);
    const double relative = wrong.share[c] > 0 ? std::min(1.0, std::abs(wrong.bias[c]) / wrong.share[c]) : 1;
    return std::all_of(v.parts.begin() + 1, v.parts.begin() + first, [&](const Verdict::Part& part) {
        return part.interval[c].high - part.interval[c].low <= relative * part.share[c] || part.share[c] == 0;
    });
}

inline std::string disagreement(const Subject& s) {
    const Verdict& v = s.verdict;
    if (s.history) return "Its bias does not shrink as the samples grow.";
    if (v.first_wrong_length == 0) return "The expected images differ.";
    std::string text = "The expected images differ from path length " + std::to_string(v.first_wrong_length) + " on";
    text += s.where_is_known ? "." : " at the latest.";
    if (!v.parts.front().disagrees && v.parts.front().p > 0.5)
        text +=
            " All lengths together show no difference: errors may cancel, or max_depth may not mean what "
            "`PathLength` says.";
    return text;
}

/// Sets the answer and its reason.
inline void answer(Subject& s, const VerifyOptions& options) {
    using Answer = Verdict::Answer;
    Verdict& v = s.verdict;
    v.answer = Answer::undecided;
    v.first_wrong_length = 0;
    const auto any = [&](auto property) { return std::any_of(v.parts.begin(), v.parts.end(), property); };
    const bool alarm = any([](const auto& part) { return part.disagrees; });
    const bool lasts = any([](const auto& part) { return part.disagrees && part.p < 0.01; });
    const double tolerance = options.tolerance > 0 ? options.tolerance : VerifyOptions{}.tolerance;
    if (v.parts.empty()) {
        v.reason = "There are too few images to compare: at least 3 of each are needed.";
    } else if (alarm && !lasts) {
        v.reason = "A difference that was found after " + std::to_string(s.alarm_at) +
                   " images did not last: rare bright paths?";
    } else if (alarm) {
        v.answer = Answer::disagrees;
        if (!s.history) v.first_wrong_length = first_wrong_length(v, options.confidence);
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
        v.reason = format("A bias of more than %.3g %% is ruled out, with a confidence of %.6g %%.",
                          100 * std::max(s.needed_tolerance, 1e-5), 100 * v.confidence);
    } else if (v.method_lacks.any() || v.reference_lacks.any()) {
        v.reason = "No difference was found in what both can make, and more cannot be said: ";
        const auto lack = [&](const std::string& who, const PathClasses& classes) {
            if (classes.any())
                v.reason += (v.reason.ends_with(": ") ? "" : "; ") + who + " cannot make " + describe(classes);
        };
        lack(v.method, v.method_lacks);
        lack(v.reference, v.reference_lacks);
        v.reason +=
            s.reference->estimator().can_leave_out.any() ? "." : ". A reference that can leave them out is bdpt.";
    } else {
        v.reason = s.needed_tolerance < 1 ? format("A bias of %.3g %% cannot be ruled out: ", 100 * s.needed_tolerance)
                                          : std::string("Nothing can be said yet of a bias below 100 %: ");
        const bool fixed = is_fixed(s.replicas) || is_fixed(*s.reference);
        v.reason += s.rare  ? "the images rest on few rare bright paths."
                    : fixed ? "more images are needed."
                            : "more time is needed.";
        if (!fixed && v.seconds_to_decide > 0)
            v.reason += " About " + rounded_duration(v.seconds_to_decide) + " in all would probably do.";
        if (s.stuck) {
            const Verdict::Part& whole = v.parts.front();
            v.reason += format(
                " In columns %d to %d, rows %d to %d, its bias has not shrunk so far (%.4g instead of %.4g): an error "
                "there, or light or edges finer than its radius.",
                whole.worst.x0, whole.worst.x1 - 1, whole.worst.y0, whole.worst.y1 - 1, whole.ours, whole.theirs);
        }
    }
}

/// The verdict as it is handed out.
inline Verdict conclude(Subject& s, const VerifyOptions& options) {
    Verdict& v = s.verdict;
    v.method = s.replicas.estimator().name;
    const Replicas& reference = *s.reference;
    v.reference = reference.estimator().name;
    v.confidence = options.confidence;
    v.tolerance = options.tolerance;
    v.seconds = s.replicas.seconds();
    v.reference_seconds = reference.seconds();
    v.reference_images = reference.count();
    v.reference_samples = reference.samples_drawn();
    v.non_finite = s.replicas.non_finite();
    v.reference_non_finite = reference.non_finite();
    if (v.parts.empty()) {
        v.images = s.replicas.count();
        v.samples = s.replicas.samples_drawn();
        if (v.images > 0) v.image = s.replicas.image();
    }
    if (v.reference_images > 0) v.reference_image = reference.image();
    v.curve.erase(v.curve.begin(), v.curve.end() - std::ptrdiff_t(s.snapshots.size()));
    for (std::size_t i = 0; i < s.snapshots.size(); ++i)
        v.curve[i].error = std::sqrt(relmse(s.snapshots[i], v.reference_image));
    answer(s, options);
    if (v.left_out.any())
        v.reason += " Outside the comparison, because only one of them makes it: " + describe(v.left_out) + ".";
    return v;
}

}  // namespace lightswitch::detail
