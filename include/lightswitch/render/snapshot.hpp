#pragma once

#include <lightswitch/render/render.hpp>

#include <cstdint>
#include <limits>
#include <string>

namespace lightswitch {

/// What a method has made so far of one view: a copy that nothing changes any more.
struct Snapshot {
    std::uint64_t view = 0;        ///< how often the camera had been moved
    std::uint64_t iterations = 0;  ///< 0: a coarse picture, whose `image` is smaller than the film
    Image image{};                 ///< as of `Session::image()`, bit for bit what `render` makes of so many samples
    Image variance{};              ///< of its pixels, see `Film::variance`; empty for a coarse picture
    double error = std::numeric_limits<double>::infinity();  ///< see `Film::relative_error`
    RenderStatistics statistics{};
    std::string failure{};  ///< what the method threw, after which it rests until the camera moves; usually empty
};

}  // namespace lightswitch
