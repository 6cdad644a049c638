#pragma once

#include <lightswitch/light/constant_environment.hpp>
#include <lightswitch/light/directional_light.hpp>
#include <lightswitch/light/environment_map.hpp>
#include <lightswitch/light/point_light.hpp>
#include <lightswitch/light/sphere_light.hpp>
#include <lightswitch/light/spot_light.hpp>
#include <lightswitch/light/triangle_light.hpp>
#include <lightswitch/scene/scene_data.hpp>
#include <lightswitch/texture/textured_triangle_light.hpp>

namespace lightswitch {

/// Every kind of light that a description can ask for.
using AllLights = Lights<ConstantEnvironment, MappedEnvironment, DirectionalLight, PointLight, SpotLight, SphereLight,
                         TriangleLight, TexturedTriangleLight>;

}  // namespace lightswitch
