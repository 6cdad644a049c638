#pragma once

#include <lightswitch/core/math.hpp>

namespace lightswitch {

/// A ray in render space. Distances are in multiples of `direction`, which need not be a unit vector for a shadow ray.
struct Ray {
    Vec3 origin{0};
    Vec3 direction{0, 0, 1};
    float near = 0;
    float far = infinity;
};

}  // namespace lightswitch
