#pragma once

// How long a sweep works, and how.

#include <lightswitch/core/floating_point.hpp>

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

namespace lightswitch {

/// What seconds are.
enum class TimeOf {
    wall,       ///< time on the clock: what a user waits for
    processor,  ///< of this process: with one thread, what would pass if nothing else ran
};

/// What an observer of a sweep is told.
struct SweepProgress {
    double seconds = 0;       ///< since it began, on the clock
    double fraction = 0;      ///< of the work, 0 to 1; never falls
    double seconds_left = 0;  ///< estimated
    std::string what;         ///< is done now: "pilots", "reference", or the name of a method
};

/// How a sweep works.
struct SweepOptions {
    double seconds = 1;            ///< for each method and seed: where the curves end
    int seeds = 4;                 ///< independent images of each method; of one there are no bands
    double reference_seconds = 0;  ///< to make a reference, pilots included; 0: 12 times `seconds`
    TimeOf clock = TimeOf::wall;
    std::uint64_t seed = 0;                                   ///< of the first images; the others have the next ones
    int threads = 0;                                          ///< 0: as many as the machine has
    std::stop_token stop = {};                                ///< ends the run early; what there is is kept
    std::function<void(const SweepProgress&)> observer = {};  ///< called after every iteration of any method
};

}  // namespace lightswitch
