#pragma once

// Cameras and lights in glTF files.

#include <lightswitch/load/gltf_texture.hpp>

#if LIGHTSWITCH_HAS_GLTF

#include <lightswitch/scene/library.hpp>

#include <numbers>

namespace lightswitch::detail {

/// A film of that aspect whose longer side has 1280 pixels.
inline FilmDescription gltf_film(double aspect, const Origin& origin) {
    constexpr int longer = 1280;
    const int shorter = std::max(static_cast<int>(std::lround(longer * std::min(aspect, 1 / aspect))), 1);
    return {.width = aspect >= 1 ? longer : shorter,
            .height = aspect >= 1 ? shorter : longer,
            .filter = Filter::gaussian(),
            .origin = origin};
}

/// Puts the camera of that number into `scene`, seen from a node; glTF's look along -z. A scale of the node does not
/// count.
inline void read_gltf_camera(const GltfFile& file, int number, const DMat4& to_world, const Origin& node,
                             LibraryDescription& scene) {
    const auto& read = file.element(file.model().cameras, number, "cameras", node);
    const Origin where = file.origin("cameras", static_cast<std::size_t>(number));
    const auto positive = [&](double value, const char* name) {
        if (!(value > 0) || !is_finite(value)) fail(where, std::string("has a ") + name + " that is not above 0");
        return value;
    };
    CameraDescription camera;
    camera.origin = where;
    camera.to_world =
        at_place(node, [&] { return CameraDescription::look_at(DVec3(0), -DVec3(to_world[2]), DVec3(to_world[1])); });
    camera.to_world[3] = to_world[3];
    double aspect = 16.0 / 9, near = 0, far = 0;
    if (read.type == "perspective") {
        camera.fov = positive(read.perspective.yfov, "yfov") * 180 / std::numbers::pi;
        camera.fov_axis = CameraDescription::FovAxis::y;
        if (camera.fov >= 180) fail(where, "has a yfov of half a turn or more");
        if (read.perspective.aspectRatio != 0) aspect = positive(read.perspective.aspectRatio, "aspectRatio");
        near = read.perspective.znear, far = read.perspective.zfar;
    } else if (read.type == "orthographic") {
        camera.projection = CameraDescription::Projection::orthographic;
        camera.half_width = positive(std::abs(read.orthographic.xmag), "xmag");
        aspect = camera.half_width / positive(std::abs(read.orthographic.ymag), "ymag");
        near = read.orthographic.znear, far = read.orthographic.zfar;
    } else {
        fail(where, "has the type " + quote(read.type) + ": it must be perspective or orthographic");
    }
    camera.near_clip = std::max(near, 0.0);
    if (far > camera.near_clip) camera.far_clip = far;
    scene.camera = camera;
    scene.film = gltf_film(aspect, where);
}

/// Adds the light of that number (KHR_lights_punctual), which shines from a node along -z. Candela and lux are taken as
/// W/sr and W/m^2.
inline void read_gltf_light(const GltfFile& file, int number, const DMat4& to_world, const Origin& node,
                            LibraryDescription& scene) {
    const auto& light = file.element(file.model().lights, number, "lights", node);
    const Origin where = file.origin("lights", static_cast<std::size_t>(number));
    Rgb strength(static_cast<float>(light.intensity));
    for (int c = 0; c < 3 && light.color.size() == 3; ++c)
        strength[c] = static_cast<float>(light.intensity * light.color[static_cast<std::size_t>(c)]);
    if (light.range > 0) file.notices().add(where, "the range of a light is ignored");
    const DVec3 position(to_world[3]), direction(-to_world[2]);
    const double degrees = 180 / std::numbers::pi;
    std::optional<Source> source;
    if (light.type == "point") source = PointSource{.position = position, .intensity = strength};
    else if (light.type == "directional") source = DirectionalSource{.direction = direction, .irradiance = strength};
    else if (light.type == "spot")
        source = SpotSource{.position = position,
                            .direction = direction,
                            .intensity = strength,
                            .cutoff_angle = light.spot.outerConeAngle * degrees,
                            .beam_width = light.spot.innerConeAngle * degrees};
    else fail(where, "has the type " + quote(light.type) + ": it must be point, spot or directional");
    if (const std::string problem = source->problem(); !problem.empty()) fail(where, problem);
    scene.add(std::move(*source), where);
}

}  // namespace lightswitch::detail

#endif
