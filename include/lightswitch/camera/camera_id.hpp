#pragma once

#include <lightswitch/camera/camera.hpp>
#include <lightswitch/camera/camera_description.hpp>
#include <lightswitch/film/film_description.hpp>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

namespace lightswitch::detail {

/// FNV-1a over numbers.
class NumberHash {
public:
    void mix(double value) {
        auto bits = std::bit_cast<std::uint64_t>(value);
        for (int byte = 0; byte < 8; ++byte, bits >>= 8) hash_ = (hash_ ^ (bits & 0xff)) * 0x100000001b3u;
    }
    std::string text() const {
        char text[20];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
        return text;
    }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// A text by which images of different cameras can be told apart: a hash of all that the camera and film say.
inline std::string camera_id(const CameraDescription& camera, const FilmDescription& film) {
    NumberHash hash;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) hash.mix(camera.to_world[column][row] + 0.0);
    for (const double value : {camera.fov, double(static_cast<int>(camera.fov_axis)), camera.aperture_radius,
                               camera.focus_distance, camera.near_clip, camera.far_clip})
        hash.mix(value);
    hash.mix(double(film.width) / film.height);
    // Of what most cameras do not have nothing is mixed in: their images of earlier versions keep their camera.
    if (camera.projection != CameraDescription::Projection::perspective) hash.mix(camera.half_width);
    if (camera.principal_point_offset != DVec2(0))
        for (int i = 0; i < 2; ++i) hash.mix(camera.principal_point_offset[i] + 0.0);
    if (const auto [width, height] = film.full_size(); width != film.width || height != film.height)
        for (const int value : {film.crop_x, film.crop_y, film.width, width, height}) hash.mix(value);
    return hash.text();
}

/// The same for a camera that nothing is known of: by the rays through some places of its film and lens.
std::string camera_id(const Camera auto& camera) {
    NumberHash hash;
    for (const float x : {0.1f, 0.5f, 0.9f})
        for (const float y : {0.1f, 0.5f, 0.9f}) {
            const Ray ray = camera.ray(Vec2(x, y) * Vec2(camera.width(), camera.height()), Vec2(y, x));
            for (int i = 0; i < 3; ++i) {
                hash.mix(double(ray.origin[i]));
                hash.mix(double(ray.direction[i]));
            }
            hash.mix(double(ray.near));
            hash.mix(double(ray.far));
        }
    return hash.text();
}

}  // namespace lightswitch::detail
