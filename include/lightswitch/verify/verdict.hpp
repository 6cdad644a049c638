#pragma once

// What `verify` found out.

#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/compare/tiles.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/render/path_classes.hpp>

#include <array>
#include <cstdio>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch {

/// Whether a method has the expected image of its reference, and if not, where and from which path length on.
struct Verdict {
    enum class Answer {
        agrees,     ///< no difference was found, and one as large as the tolerance would have been
        disagrees,  ///< the expected images differ, or contributions are not finite, or pixels share random numbers
        undecided,  ///< too few samples, or too few of the rare bright paths, to tell
    };

    /// The comparison of one part of the image: all of it, or the paths of one length.
    struct Part {
        int length = 0;           ///< path length as in `PathLength`; 0: all lengths together
        bool and_longer = false;  ///< that length and all longer ones
        bool disagrees = false;
        /// The smallest p-value, multiplied by the number of tests in this part; by chance below x with probability x.
        double p = 1;
        PixelRectangle worst;         ///< where that is
        int worst_channel = 0;        ///< 0 red, 1 green, 2 blue
        double ours = 0, theirs = 0;  ///< radiance there
        /// Whole-image mean less the reference's, per channel, as a fraction of the reference's whole image (all
        /// lengths); in units of radiance where the reference is black.
        std::array<double, 3> bias{};
        std::array<Interval, 3> interval{};  ///< of the bias, valid whenever the run was stopped
        std::array<double, 3> share{};       ///< of the reference's whole image that these paths carry
    };

    /// The image so far, and what it cost.
    struct Moment {
        double seconds = 0;         ///< spent on this method
        std::uint64_t samples = 0;  ///< per pixel
        double error = 0;  ///< root of the relMSE to the reference's final image, whose own noise is part of it
    };

    std::string method, reference;
    Answer answer = Answer::undecided;
    std::string reason;          ///< in a sentence or two, with what is outside the comparison
    int first_wrong_length = 0;  ///< 0 when it is not known
    bool correlated_pixels = false;
    PathClasses left_out;  ///< paths that only one side makes, and which it left out for this comparison
    PathClasses method_lacks, reference_lacks;  ///< paths that only the other side makes, and could not leave out
    std::vector<Part> parts;  ///< all lengths first, then one by one; empty when nothing could be compared

    double confidence = 0, tolerance = 0;
    double seconds = 0, reference_seconds = 0;  ///< spent rendering
    double seconds_to_decide =
        0;  ///< of an undecided one: what the whole run would probably have to take; 0 when not known
    double found_after =
        0;  ///< seconds from the beginning of the run until a difference was found; 0 when there is none
    std::uint64_t images = 0, reference_images = 0;    ///< independent ones
    std::uint64_t samples = 0, reference_samples = 0;  ///< per pixel, in all; of a consistent method in the last look
    double events = 0;  ///< effective number of events that the image's mean rests on, of the side that has fewer
    std::uint64_t non_finite = 0, reference_non_finite = 0;  ///< contributions that were replaced by black

    Image image, reference_image;  ///< means of all images
    Image p_values;                ///< of the smallest tiles, all lengths: one pixel per tile, one channel per channel
    std::vector<Moment> curve;

    bool agrees() const { return answer == Answer::agrees; }
    bool disagrees() const { return answer == Answer::disagrees; }
};

constexpr std::string_view name(Verdict::Answer answer) {
    switch (answer) {
        case Verdict::Answer::agrees: return "agrees";
        case Verdict::Answer::disagrees: return "disagrees";
        default: return "undecided";
    }
}

/// "all lengths", "length 3", "length 6 and longer".
inline std::string name(const Verdict::Part& part) {
    if (part.length == 0) return "all lengths";
    return "length " + std::to_string(part.length) + (part.and_longer ? " and longer" : "");
}

namespace detail {

inline constexpr std::array<const char*, 3> channel_names{"red", "green", "blue"};

template <class... T>
std::string format(const char* pattern, T... values) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

/// The channel whose bias is surest.
inline int surest_channel(const Verdict::Part& part) {
    int best = 0;
    double most = -1;
    for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        const double half = 0.5 * (part.interval[i].high - part.interval[i].low);
        const double sure = half > 0 ? std::abs(part.bias[i]) / half : std::abs(part.bias[i]) > 0 ? 1e300 : 0;
        if (sure > most) most = sure, best = c;
    }
    return best;
}

inline std::string percent_interval(const Verdict::Part& part, int channel) {
    const auto i = static_cast<std::size_t>(channel);
    return format("%+.3g %% (%+.3g to %+.3g)", 100 * part.bias[i], 100 * part.interval[i].low,
                  100 * part.interval[i].high);
}

}  // namespace detail

/// Several lines: the answer with its reason, then one line per part.
inline std::ostream& operator<<(std::ostream& out, const Verdict& v) {
    out << v.method << " against " << v.reference << ": " << name(v.answer) << ". " << v.reason << '\n';
    for (const Verdict::Part& part : v.parts) {
        const int channel = detail::surest_channel(part);
        out << "  " << name(part) << ": " << (part.disagrees ? "disagrees" : "no difference found") << ", bias "
            << detail::percent_interval(part, channel) << " in "
            << detail::channel_names[static_cast<std::size_t>(channel)] << ", p " << detail::format("%.3g", part.p);
        if (part.disagrees)
            out << detail::format(", most in columns %d to %d, rows %d to %d: %.5g instead of %.5g (%s)", part.worst.x0,
                                  part.worst.x1 - 1, part.worst.y0, part.worst.y1 - 1, part.ours, part.theirs,
                                  detail::channel_names[static_cast<std::size_t>(part.worst_channel)]);
        out << '\n';
    }
    return out;
}

}  // namespace lightswitch
