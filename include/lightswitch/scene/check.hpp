#pragma once

// What can be wrong with a scene description, said in words.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/core/problem.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/scene/check_layers.hpp>

namespace lightswitch::detail {

inline void check_position(const DVec3& p, const Origin& origin, const std::string& what) {
    if (const std::string problem = position_problem(p, what); !problem.empty()) fail(origin, problem);
}

inline void check(const Mesh& mesh, const Origin& origin) {
    if (mesh.triangles.empty()) fail(origin, "the mesh has no triangles");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        fail(origin, "the mesh has " + std::to_string(mesh.positions.size()) + " vertices but " +
                         std::to_string(mesh.normals.size()) + " normals");
    if (mesh.uvs.size() > mesh.positions.size())
        fail(origin, "the mesh has " + std::to_string(mesh.positions.size()) + " vertices but " +
                         std::to_string(mesh.uvs.size()) + " texture coordinates");
    for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
        if (!is_finite(mesh.uvs[i].x) || !is_finite(mesh.uvs[i].y))
            fail(origin, "texture coordinate " + std::to_string(i) + " is not a finite number");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (const DVec3 p = glm::abs(mesh.positions[i]);
            !(std::max({p.x, p.y, p.z}) <= largest_coordinate) || !is_finite(p))
            check_position(p, origin, "vertex " + std::to_string(i));
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
    if (!is_orthonormal(sphere.axes, 1e-3))
        fail(origin, "the sphere's axes must be of unit length and at right angles");
    if (!is_finite(sphere.radius) || !(sphere.radius > 0) || sphere.radius > largest_coordinate)
        fail(origin, "the sphere's radius of " + number_text(sphere.radius) + " is not a positive length");
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
    if (!(camera.half_width > 0) || !is_finite(camera.half_width))
        fail(origin, "the camera's half width of " + number_text(camera.half_width) + " is not a positive length");
    if (!is_finite(camera.principal_point_offset.x) || !is_finite(camera.principal_point_offset.y))
        fail(origin, "the camera's principal point offset is not a finite number");
    if (!(camera.near_clip >= 0) || !(camera.far_clip > camera.near_clip))
        fail(origin, "near_clip must not be negative, and far_clip must be larger");
}

inline void check(const FilmDescription& film) {
    at_place(film.origin, [&] { Image::check_size(film.width, film.height); });
    const auto [full_width, full_height] = film.full_size();
    if (film.crop_x < 0 || film.crop_y < 0 || film.crop_x > full_width - film.width ||
        film.crop_y > full_height - film.height)
        fail(film.origin, "the crop window is not within the film");
    if (const std::string problem = film.filter.problem(); !problem.empty()) fail(film.origin, problem);
}

template <class Material>
void check_shapes(const SceneDescription<Material>& scene, const auto& shapes) {
    for (const auto& shape : shapes) {
        if (shape.material >= scene.materials.size()) fail(shape.origin, "the shape's material does not exist");
        std::visit([&](const auto& geometry) { check(geometry, shape.origin); }, shape.geometry);
        if (!shape.emission) continue;
        const auto check_radiance = [&](const Rgb& factor) {
            if (const std::string problem = radiance_problem(*shape.emission * factor, "the light's radiance");
                !problem.empty())
                fail(shape.origin, problem);
        };
        check_radiance(Rgb(1));
        if (shape.emission_texture) {
            if (std::holds_alternative<Sphere>(shape.geometry))
                fail(shape.origin, "only meshes can have a texture for their radiance, and this is a sphere");
            if (const std::string problem = shape.emission_texture->problem(); !problem.empty())
                fail(shape.origin, problem);
            check_radiance(shape.emission_texture->least());
            check_radiance(shape.emission_texture->most());
        }
        // Light would come from it with that probability when it is met, but always when it is sampled.
        if (is_masked(scene, shape.material)) fail(shape.origin, "a surface that shines cannot be masked");
    }
}

inline bool is_affine(const DMat4& m) { return m[0].w == 0 && m[1].w == 0 && m[2].w == 0 && m[3].w == 1; }

/// How much the longest direction is stretched beside the shortest, to a factor of 9; not finite where there is no
/// inverse.
inline double squeeze(const DMat3& linear) { return largest_entry(linear) * largest_entry(glm::inverse(linear)); }

/// What that cannot be of an instance.
inline std::string squeeze_problem(double squeeze) {
    if (9 * squeeze < 1e4) return {};
    return "the instance's transform has no inverse, or squeezes the group by more than 1 : 1000";
}

/// What an instance's transform cannot be, wherever the instance is.
inline std::string instance_problem(const DMat4& to_world) {
    for (int column = 0; column < 4; ++column)
        if (std::string problem = position_problem(DVec3(to_world[column]), "the instance's transform");
            !problem.empty())
            return problem;
    if (!is_affine(to_world)) return "the instance's transform is not affine";
    return squeeze_problem(squeeze(DMat3(to_world)));
}

template <class Material>
void check_instances(const SceneDescription<Material>& scene) {
    for (const auto& group : scene.groups) {
        if (group.shapes.empty()) fail(group.origin, "the group has no shapes");
        check_shapes(scene, group.shapes);
    }
    for (const auto& instance : scene.instances) {
        if (instance.group >= scene.groups.size()) fail(instance.origin, "the instance's group does not exist");
        if (const std::string problem = instance_problem(instance.to_world); !problem.empty())
            fail(instance.origin, problem);
    }
}

template <class Material>
void check(const SceneDescription<Material>& scene) {
    check(scene.camera);
    check(scene.film);
    std::vector<int> depths(scene.materials.size(), unknown_depth);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const auto& material = scene.materials[i];
        std::string problem;
        if (material.layer) {
            layer_depth(scene, i, depths);
            problem = layer_problem(*material.layer);
            if (const auto* coating = std::get_if<Coating>(&*material.layer); coating && problem.empty())
                problem = coating_problem(scene, *coating);
            if (!problem.empty()) fail(material.origin, problem);
            continue;
        }
        if constexpr (requires { material.bsdf.problem(); }) problem = material.bsdf.problem();
        else problem = std::visit([](const auto& bsdf) -> std::string { return bsdf.problem(); }, material.bsdf);
        if (!problem.empty()) fail(material.origin, problem);
    }
    check_shapes(scene, scene.shapes);
    check_instances(scene);
    bool has_environment = false;
    for (const auto& source : scene.sources) {
        if (const std::string problem = source.source.problem(); !problem.empty()) fail(source.origin, problem);
        if (!source.source.is_environment()) continue;
        if (has_environment)
            fail(source.origin, "the scene has a second environment: give one with the sum of their radiances");
        has_environment = true;
    }
}

/// Throws when no number is left for one more element of a type, after `count` others.
inline void check_count(std::size_t count, std::size_t max_position, const Origin& origin, const std::string& what) {
    if (count > max_position)
        fail(origin, "the scene has more than " + std::to_string(max_position + 1) + " " + what + " of one kind");
}

/// Whether the triangle has an area in render space, before its corners become floats.
inline bool has_area(const RenderSpace& space, const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const DVec3 a = space.point(mesh.positions[t[0]]), b = space.point(mesh.positions[t[1]]);
    return glm::length(glm::cross(b - a, space.point(mesh.positions[t[2]]) - a)) > 0;
}

/// Corners of the box around all shapes; both at the camera when there are none.
struct Bounds {
    DVec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
    void include(const DVec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    void include(const Mesh& mesh) {
        for (const auto& corners : mesh.triangles)
            for (const std::uint32_t index : corners) include(mesh.positions[index]);
    }
    void include(const Sphere& sphere) {
        include(sphere.center - sphere.radius);
        include(sphere.center + sphere.radius);
    }
    void include(const std::variant<Mesh, Sphere>& geometry) {
        std::visit([&](const auto& shape) { include(shape); }, geometry);
    }
    /// The box of `other` under that matrix.
    void include(const Bounds& other, const DMat4& matrix) {
        for (int corner = 0; corner < 8; ++corner)
            include(DVec3(matrix * glm::dvec4(corner & 1 ? other.lower.x : other.upper.x,
                                              corner & 2 ? other.lower.y : other.upper.y,
                                              corner & 4 ? other.lower.z : other.upper.z, 1)));
    }
    /// Of the sphere around the origin of render space that holds the box.
    double radius(const RenderSpace& space) const {
        return glm::length(glm::max(glm::abs(space.point(lower)), glm::abs(space.point(upper))));
    }
};

/// The boxes around all shapes and instances, in scene units.
template <class Material>
std::vector<Bounds> bounds_of_parts(const SceneDescription<Material>& scene) {
    std::vector<Bounds> parts;
    parts.reserve(scene.shapes.size() + scene.instances.size());
    for (const auto& shape : scene.shapes) parts.emplace_back().include(shape.geometry);
    std::vector<Bounds> of_groups(scene.groups.size());
    for (std::size_t i = 0; i < of_groups.size(); ++i)
        for (const auto& shape : scene.groups[i].shapes) of_groups[i].include(shape.geometry);
    for (const auto& instance : scene.instances)
        parts.emplace_back().include(of_groups[instance.group], instance.to_world);
    return parts;
}

/// The box around all of them; of a scene without any, around the camera's place.
inline Bounds bounds_around(const std::vector<Bounds>& parts, const CameraDescription& camera) {
    Bounds bounds;
    for (const Bounds& part : parts) bounds = {glm::min(bounds.lower, part.lower), glm::max(bounds.upper, part.upper)};
    if (parts.empty()) bounds.include(DVec3(camera.to_world[3]));
    return bounds;
}

template <class Material>
Bounds find_bounds(const SceneDescription<Material>& scene) {
    return bounds_around(bounds_of_parts(scene), scene.camera);
}

/// Render space for parts within `bounds`. Its middle is that of the bounds; but where that is so far from some part
/// that rounding would spoil its form, such as of a room under a sun at its true distance, it is that of the part that
/// would suffer most, if that helps.
inline RenderSpace choose_render_space(const std::vector<Bounds>& parts, const Bounds& bounds) {
    // Where the part lies, in its own sizes: how many of them are lost for every digit of its form.
    const auto distance_in_sizes = [](const Bounds& part, const DVec3& center) {
        const DVec3 far = glm::max(glm::abs(part.lower - center), glm::abs(part.upper - center));
        const DVec3 size = part.upper - part.lower;
        return std::max({far.x, far.y, far.z}) / std::max({size.x, size.y, size.z});
    };
    const auto farthest = [&](const DVec3& center) {
        std::pair<double, const Bounds*> most{0, nullptr};
        for (const Bounds& part : parts)
            if (const double distance = distance_in_sizes(part, center);
                std::isfinite(distance) && distance > most.first)
                most = {distance, &part};
        return most;
    };
    const RenderSpace usual(bounds.lower, bounds.upper);
    const auto [distance, part] = farthest(usual.center());
    constexpr double tolerable = 0x1p18;  // a float has 2^24 steps
    if (distance <= tolerable) return usual;
    const DVec3 center = part->lower + (part->upper - part->lower) * 0.5;
    if (farthest(center).first >= distance) return usual;
    return {bounds.lower, bounds.upper, center};
}

}  // namespace lightswitch::detail
