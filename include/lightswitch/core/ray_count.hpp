#pragma once

#include <lightswitch/core/floating_point.hpp>

#include <cstdint>

namespace lightswitch {

/// Numbers of rays traced by the calling thread since it started; read them before and after, and subtract.
struct RayCount {
    std::uint64_t intersect = 0;
    std::uint64_t occluded = 0;
    std::uint64_t refused = 0;  ///< among both, see `embree::Accelerator`
};
inline constinit thread_local RayCount ray_count{};

}  // namespace lightswitch
