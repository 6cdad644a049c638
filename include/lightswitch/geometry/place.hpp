#pragma once

#include <lightswitch/geometry/surface_point.hpp>

namespace lightswitch {

/// Where on its shape a point lies, for materials that differ from place to place.
struct Place {
    Vec2 uv;                    ///< the shape's texture coordinates
    const SurfacePoint& point;  ///< in render space; its light is not to be relied on
};

}  // namespace lightswitch
