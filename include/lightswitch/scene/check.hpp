#pragma once

// What can be wrong with a scene description, said in words.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/dispatch.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/scene/description.hpp>

#include <cstdio>

namespace lightswitch::detail {

/// Coordinates beyond this would overflow when they are squared.
inline constexpr double largest_coordinate = 1e100;

inline void check_position(const DVec3& p, const Origin& origin, const std::string& what) {
    if (!is_finite(p)) fail(origin, what + " is not a finite number");
    if (glm::any(glm::greaterThan(glm::abs(p), DVec3(largest_coordinate)))) fail(origin, what + " is beyond 1e100");
}

inline void check_radiance(const Rgb& value, const Origin& origin, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        if (!is_finite(value[c])) fail(origin, what + " is not a finite number");
        if (value[c] < 0) fail(origin, what + " is negative");
        if (value[c] > 1e30f) fail(origin, what + " is above 1e30");
    }
}

inline void check(const Mesh& mesh, const Origin& origin) {
    if (mesh.triangles.empty()) fail(origin, "the mesh has no triangles");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        fail(origin, "the mesh has " + std::to_string(mesh.positions.size()) + " vertices but " +
                         std::to_string(mesh.normals.size()) + " normals");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        check_position(mesh.positions[i], origin, "vertex " + std::to_string(i));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        if (!is_finite(mesh.normals[i]) || !(glm::length(mesh.normals[i]) > 0))
            fail(origin, "normal " + std::to_string(i) + " is not a direction");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t index : mesh.triangles[i])
            if (index >= mesh.positions.size())
                fail(origin, "triangle " + std::to_string(i) + " uses vertex " + std::to_string(index) +
                                 ", but there are " + std::to_string(mesh.positions.size()) + " (counted from 0)");
}

inline void check(const Sphere& sphere, const Origin& origin) {
    check_position(sphere.center, origin, "the sphere's centre");
    if (!is_finite(sphere.radius) || !(sphere.radius > 0) || sphere.radius > largest_coordinate)
        fail(origin, "the sphere's radius of " + number_text(sphere.radius) + " is not a positive length");
}

inline void check(const PointSource& source, const Origin& origin) {
    check_position(source.position, origin, "the light's position");
    check_radiance(source.intensity, origin, "the light's intensity");
}
inline void check(const DirectionalSource& source, const Origin& origin) {
    if (!is_finite(source.direction) || !(glm::length(source.direction) > 0))
        fail(origin, "the light's direction is not a direction");
    check_radiance(source.irradiance, origin, "the light's irradiance");
}
inline void check(const EnvironmentSource& source, const Origin& origin) {
    check_radiance(source.radiance, origin, "the environment's radiance");
}

inline void check(const CameraDescription& camera) {
    const Origin& origin = camera.origin;
    if (!(camera.fov > 0 && camera.fov < 180))
        fail(origin, "a field of view of " + number_text(camera.fov) + " degrees is not between 0 and 180");
    for (int column = 0; column < 4; ++column)
        check_position(DVec3(camera.to_world[column]), origin, "the camera's transform");
    for (int i = 0; i < 3; ++i) {
        const DVec3 a(camera.to_world[i]), b(camera.to_world[(i + 1) % 3]);
        if (std::abs(glm::length(a) - 1) > 1e-3) fail(origin, "the camera's transform must not contain a scale");
        if (std::abs(glm::dot(a, b)) > 1e-3) fail(origin, "the camera's transform must not contain a shear");
    }
    if (!(camera.aperture_radius >= 0) || !is_finite(camera.aperture_radius))
        fail(origin, "the aperture radius of " + number_text(camera.aperture_radius) + " is not a length");
    if (!(camera.focus_distance > 0) || !is_finite(camera.focus_distance))
        fail(origin, "the focus distance of " + number_text(camera.focus_distance) + " is not a positive length");
    if (!(camera.near_clip >= 0) || !(camera.far_clip > camera.near_clip))
        fail(origin, "near_clip must not be negative, and far_clip must be larger");
}

template <class Material>
void check(const SceneDescription<Material>& scene) {
    check(scene.camera);
    try {
        Image::check_size(scene.film.width, scene.film.height);
    } catch (const Error& error) {
        fail(scene.film.origin, error.what());
    }
    if (const std::string problem = scene.film.filter.problem(); !problem.empty()) fail(scene.film.origin, problem);
    for (const auto& material : scene.materials) {
        std::string problem;
        if constexpr (Bsdf<Material>) problem = material.bsdf.problem();
        else problem = std::visit([](const auto& bsdf) -> std::string { return bsdf.problem(); }, material.bsdf);
        if (!problem.empty()) fail(material.origin, problem);
    }
    for (const auto& shape : scene.shapes) {
        if (shape.material >= scene.materials.size()) fail(shape.origin, "the shape's material does not exist");
        std::visit([&](const auto& geometry) { check(geometry, shape.origin); }, shape.geometry);
        if (shape.emission) check_radiance(*shape.emission, shape.origin, "the light's radiance");
    }
    bool has_environment = false;
    for (const auto& source : scene.sources) {
        std::visit([&](const auto& s) { check(s, source.origin); }, source.source);
        if (!std::holds_alternative<EnvironmentSource>(source.source)) continue;
        if (has_environment)
            fail(source.origin, "the scene has a second environment: give one with the sum of their radiances");
        has_environment = true;
    }
}

/// What the element after `count` others of its type is known by; throws when there is no number left.
inline TypedIndex checked_index(std::size_t kind, std::size_t count, const Origin& origin, const std::string& what) {
    if (count > TypedIndex::max_position)
        fail(origin,
             "the scene has more than " + std::to_string(TypedIndex::max_position + 1) + " " + what + " of one kind");
    return {kind, count};
}

/// Corners of the box around all shapes; both at the camera when there are none.
struct Bounds {
    DVec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
    void include(const DVec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
};

template <class Material>
Bounds find_bounds(const SceneDescription<Material>& scene) {
    Bounds bounds;
    for (const auto& shape : scene.shapes) {
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            for (const auto& corners : mesh->triangles)
                for (const std::uint32_t index : corners) bounds.include(mesh->positions[index]);
        } else {
            const auto& sphere = std::get<Sphere>(shape.geometry);
            bounds.include(sphere.center - sphere.radius);
            bounds.include(sphere.center + sphere.radius);
        }
    }
    if (scene.shapes.empty()) bounds.include(DVec3(scene.camera.to_world[3]));
    return bounds;
}

/// A text by which images of different cameras can be told apart: a hash of all that the camera and film say.
template <class Camera, class Film>
std::string camera_id(const Camera& camera, const Film& film) {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a over the values
    const auto mix = [&](double value) {
        auto bits = std::bit_cast<std::uint64_t>(value);
        for (int byte = 0; byte < 8; ++byte, bits >>= 8) hash = (hash ^ (bits & 0xff)) * 0x100000001b3u;
    };
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) mix(camera.to_world[column][row] + 0.0);
    for (const double value : {camera.fov, double(static_cast<int>(camera.fov_axis)), camera.aperture_radius,
                               camera.focus_distance, camera.near_clip, camera.far_clip})
        mix(value);
    mix(double(film.width) / film.height);
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

}  // namespace lightswitch::detail
