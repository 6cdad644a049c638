#pragma once

// A camera and light for what has none, such as a bare mesh.

#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/description.hpp>

#include <algorithm>
#include <memory>
#include <numbers>

namespace lightswitch {

/// Gives the scene a camera that sees all of its shapes, in groups, too, from their right, front (+z) and above (+y),
/// 40 degrees wide along the longer side of the film, which stays as it is. The box around the shapes fills 9 tenths of
/// the film's width or height. The view is from another side where from there one would see little but edges, as of a
/// flat thing that lies along the view.
///
/// Sizes count beside each other only, so that any unit of length will do. Throws `Error` for shapes of which no scene
/// can be built.
template <class Material>
void frame_scene(SceneDescription<Material>& scene);

/// Whether anything lights the scene: a source, or a shape that is seen and has an emission. Textures of emission up to
/// 1 are no light: they are the glowing parts of objects, made for programs where such parts light nothing.
template <class Material>
bool has_light(const SceneDescription<Material>& scene);

/// Adds a soft sky: brightest above to the left and front, so that shapes show, and dim below the horizon. White paper
/// that lies on the ground has a radiance of about 1.
template <class Material>
void add_default_sky(SceneDescription<Material>& scene);

namespace detail {

/// How much of the shapes' area faces which way: the sum of area * n n^T over their pieces. `lengths` is the unit of
/// length, which keeps numbers within range.
class Facing {
public:
    explicit Facing(double lengths) : unit_(lengths > 0 ? lengths : 1) {}

    void add(const Mesh& mesh) {
        for (const auto& t : mesh.triangles) {
            const DVec3& a = mesh.positions[t[0]];
            const DVec3 cross =
                glm::cross((mesh.positions[t[1]] - a) / unit_, (mesh.positions[t[2]] - a) / unit_) * 0.5;
            const double area = glm::length(cross);
            if (area > 0) sum_ += glm::outerProduct(cross / area, cross);
        }
    }
    void add(const Sphere& sphere) {
        const double radius = sphere.radius / unit_;
        sum_ += DMat3(4 * std::numbers::pi / 3 * radius * radius);
    }
    void add(const std::variant<Mesh, Sphere>& geometry) {
        std::visit([&](const auto& shape) { add(shape); }, geometry);
    }
    /// `other` under a matrix: exact when that is a similarity, and otherwise right in which directions are missing.
    void add(const Facing& other, const DMat4& matrix) {
        const DMat3 m = DMat3(matrix) * (other.unit_ / unit_);
        const DMat3 turn(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        const double scale =
            std::sqrt((glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2])) / 3);
        if (scale > 0) sum_ += turn * other.sum_ * glm::transpose(turn) * (1 / scale);
    }

    /// The mean squared cosine between the surfaces' normals and a unit direction.
    double seen_from(const DVec3& direction) const {
        const double area = sum_[0][0] + sum_[1][1] + sum_[2][2];
        return area > 0 ? glm::dot(direction, sum_ * direction) / area : 0;
    }

private:
    double unit_;
    DMat3 sum_{0};
};

inline double extent(const Bounds& bounds) {
    const DVec3 size = bounds.upper - bounds.lower;
    return std::max({size.x, size.y, size.z});
}

/// Unit vector from the scene to the viewer.
template <class Material>
DVec3 pleasant_view(const SceneDescription<Material>& scene, const Bounds& bounds) {
    Facing facing(extent(bounds));
    for (const auto& shape : scene.shapes) facing.add(shape.geometry);
    std::vector<std::optional<Facing>> of_groups(scene.groups.size());
    for (const auto& instance : scene.instances) {
        auto& group = of_groups[instance.group];
        if (!group) {
            Bounds box;
            for (const auto& shape : scene.groups[instance.group].shapes) box.include(shape.geometry);
            group.emplace(extent(box));
            for (const auto& shape : scene.groups[instance.group].shapes) group->add(shape.geometry);
        }
        facing.add(*group, instance.to_world);
    }

    // In no plane together, so nothing flat is hidden from all three. The first will do at 15 degrees to a plane.
    const DVec3 views[] = {{0.5, 0.4, 0.8}, {-0.5, 0.4, 0.8}, {0.3, 0.9, 0.3}};
    constexpr double enough = 0.067;
    DVec3 best(0);
    double most = -1;
    for (const DVec3& view : views) {
        const DVec3 direction = glm::normalize(view);
        const double seen = facing.seen_from(direction);
        if (seen > most) best = direction, most = seen;
        if (seen > enough) break;
    }
    return best;
}

}  // namespace detail

template <class Material>
void frame_scene(SceneDescription<Material>& scene) {
    detail::check_shapes(scene, scene.shapes);
    detail::check_instances(scene);
    const detail::Bounds bounds = detail::find_bounds(scene);
    const DVec3 center = bounds.lower + (bounds.upper - bounds.lower) * 0.5;
    const double magnitude = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    // Less than this is rounding errors; a scene that is one point at 0 is as large as one likes.
    const bool is_nothing = !(magnitude > 0) && !(detail::extent(bounds) > 0);
    const DVec3 half = glm::max((bounds.upper - bounds.lower) * 0.5, DVec3(is_nothing ? 1 : 0x1p-48 * magnitude));

    CameraDescription camera;
    camera.fov = 40;
    camera.fov_axis = CameraDescription::FovAxis::larger;
    const DVec3 backward = detail::pleasant_view(scene, bounds);
    const DMat4 turn = CameraDescription::look_at(DVec3(0), -backward, {0, 1, 0});

    // The nearest eye with that view for which the box is within a pyramid that is 9 tenths as wide as the film's. A
    // corner is within its left and right side when |x - eye.x| <= slope * (z - eye.z).
    const double longer = 0.9 * std::tan(glm::radians(camera.fov) / 2), aspect = scene.film.aspect();
    const DVec2 slope = aspect > 1 ? DVec2(longer, longer / aspect) : DVec2(longer * aspect, longer);
    DVec2 above(-std::numeric_limits<double>::infinity()), below = above;
    for (int corner = 0; corner < 8; ++corner) {
        const DVec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const DVec3 local = glm::transpose(DMat3(turn)) * (sign * half);
        above = glm::max(above, DVec2(local) - slope * local.z);
        below = glm::max(below, -DVec2(local) - slope * local.z);
    }
    const DVec2 side = (above - below) * 0.5, distance = (above + below) / (2.0 * slope);
    const DVec3 eye(side, -std::max(distance.x, distance.y));

    camera.to_world = turn;
    camera.to_world[3] = glm::dvec4(center + DMat3(turn) * eye, 1);
    camera.focus_distance = -eye.z;
    scene.camera = camera;
}

template <class Material>
bool has_light(const SceneDescription<Material>& scene) {
    const auto shines = [](const auto& shape) {
        if (!shape.emission || is_black(*shape.emission)) return false;
        const Rgb& emission = *shape.emission;
        return !shape.emission_texture || std::max({emission.x, emission.y, emission.z}) > 1;
    };
    const auto shines_in_group = [&](const auto& instance) {
        const auto& shapes = scene.groups.at(instance.group).shapes;
        return std::any_of(shapes.begin(), shapes.end(), shines);
    };
    return !scene.sources.empty() || std::any_of(scene.shapes.begin(), scene.shapes.end(), shines) ||
           std::any_of(scene.instances.begin(), scene.instances.end(), shines_in_group);
}

template <class Material>
void add_default_sky(SceneDescription<Material>& scene) {
    constexpr int width = 64, height = 33;
    const Vec3 glow = normalize(Vec3(-0.6f, 0.7f, 0.5f));
    std::vector<Rgb> texels;
    texels.reserve(std::size_t{width} * height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            // The directions of `EnvironmentMap`.
            const float around = 2 * pi * (static_cast<float>(column) + 0.5f) / width;
            const float down = pi * static_cast<float>(row) / (height - 1), across = std::sin(down);
            const Vec3 direction(across * std::sin(around), std::cos(down), -across * std::cos(around));
            const float up = direction.y, towards = std::max(dot(direction, glow), 0.0f);
            const Rgb horizon(0.55f, 0.57f, 0.6f), zenith(0.75f, 0.85f, 1), ground(0.2f, 0.19f, 0.18f);
            const Rgb gradient =
                up > 0 ? horizon + up * (zenith - horizon) : ground + (horizon - ground) * std::max(1 + 6 * up, 0.0f);
            texels.push_back(gradient + Rgb(1.6f, 1.5f, 1.3f) * square(square(towards)));
        }
    scene.add(
        Source(EnvironmentMapSource{.map = std::make_shared<const EnvironmentMap>(std::move(texels), width, height)}));
}

}  // namespace lightswitch
