#pragma once

// How long and how strictly `verify` works.

#include <lightswitch/core/floating_point.hpp>

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

namespace lightswitch {

struct Verdict;

/// What an observer of `verify` is told.
struct VerifyProgress {
    double seconds = 0;
    double fraction = 0;  ///< of the time that it may take, 0 to 1: it may well end before
    double seconds_to_decide =
        0;               ///< when everything will probably be decided, from the beginning; 0 when that is not known yet
    std::string method;  ///< that just made an image
    std::uint64_t images = 0;
};

/// How `verify` works; the defaults are right for most uses.
struct VerifyOptions {
    /// On the clock, in all, but at least three images of each; it ends as soon as every question is decided.
    double seconds = 20;
    /// A method that agrees is said to disagree with a probability of at most 1 - confidence, if no lamp, or no
    /// sample of an image without a scene, is much brighter than what is known of (see `Estimator::brightest`).
    double confidence = 0.999;
    /// The smallest bias of the whole image that matters, as a fraction: it agrees when a larger one is ruled out, and
    /// also one of any quarter or sixteenth of the image that by itself would change the mean by so much. 0: use all
    /// the time to look for any difference, and hold it to 0.01 at the end.
    double tolerance = 0.01;
    int path_lengths = 5;  ///< compared one by one; 0: only all together
    std::uint64_t seed = 0;
    /// At most, per method; 0: as many as there is time for. Of a consistent method, whose samples are doubled at every
    /// look, an image counts as many as its samples are times those of the first.
    int images = 0;
    int samples = 0;            ///< per pixel of each image; 0: chosen by the time that they take
    int threads = 0;            ///< 0: as many as the machine has
    std::stop_token stop = {};  ///< ends the run early, with a verdict on what there is
    std::function<void(const VerifyProgress&)> observer = {};  ///< called as images are made
    /// Called after every look at a method, with what would be its verdict if the run ended then.
    std::function<void(const Verdict&)> looked = {};
};

}  // namespace lightswitch
