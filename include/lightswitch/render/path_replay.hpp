#pragma once

// What `replay` and `brightest_sample` are asked and tell.

#include <lightswitch/render/path_event.hpp>

#include <optional>
#include <vector>

namespace lightswitch {

/// What `replay` looks at.
struct ReplayOptions {
    /// Splats of other pixels' paths, where a method has them. For them `bdpt` makes a whole iteration; without them it
    /// traces no more than the pixel's own paths.
    bool others = true;
};

/// How a sample of a pixel came about.
struct PathReplay {
    Rgb sample{0};                       ///< what the pixel's own function gave; black where that was not finite
    DVec3 splatted{0};                   ///< what was splatted at the pixel besides
    std::vector<PathEvent> events = {};  ///< in order; the pixel's own paths, and those whose splats it got
    /// Whether they say where every bit of the value comes from: between two samples the contributions add up to the
    /// later one, in single precision and in their order, and how each splat came about is told.
    bool explained = false;
    std::uint64_t dropped = 0;  ///< values at this pixel that were not finite, and such rays of its own paths
    bool cancelled = false;     ///< `Settings::stop` has asked for an end: the rest is not to be relied on

    /// What the film got, to the bit.
    DVec3 value() const { return DVec3(sample) + splatted; }
};

/// The brightest of the samples of a pixel.
struct BrightestSample {
    std::uint64_t iteration = 0;   ///< the first whose luminance is the greatest
    DVec3 value{0};                ///< of that one
    DVec3 mean{0};                 ///< of all
    std::uint64_t tried = 0;       ///< iterations
    std::uint64_t non_finite = 0;  ///< of them, those with values or rays that were not finite (`PathReplay::dropped`)
    std::optional<std::uint64_t> first_non_finite;  ///< the first of those
    bool cancelled = false;                         ///< `Settings::stop` has asked for an end: not all were tried
};

}  // namespace lightswitch
