#pragma once

// Groups of shapes in coordinates of their own, and where they are placed: what a built scene keeps of them.

#include <lightswitch/core/error.hpp>
#include <lightswitch/embree/accelerator.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/rounding.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace lightswitch::detail {

/// Shapes that share an accelerator.
struct GroupRecord {
    std::uint32_t first_mesh, mesh_count;  ///< its meshes; in its accelerator the spheres come after them
    std::uint32_t first_sphere;
    RenderSpace space;
    Bounds bounds;  ///< in the group's own coordinates
    std::shared_ptr<const embree::Accelerator> accelerator;
};

/// An affine map of float vectors.
struct AffineMap {
    Mat3 linear{1};
    Vec3 shift{0};

    Vec3 point(const Vec3& p) const { return linear * p + shift; }
    /// Bound of what is added up for the image of a point, by component.
    Vec3 largest(const Vec3& p) const { return absolute(linear) * glm::abs(p) + glm::abs(shift); }

    static Mat3 absolute(const Mat3& m) { return Mat3(glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])); }
};

/// Where a group is placed: from its space to that of the scene and back.
struct InstanceRecord {
    std::size_t group = 0;
    AffineMap to_scene{}, to_group{};
    float rounding = 0;     ///< bound on what rounding of the matrices moves the group by, in its space
    bool in_place = false;  ///< of the shapes that belong to no group: nothing is transformed
    bool luminous = false;  ///< the group has lights, which are kept apart

    /// The instance of a `group` under `to_world`. Throws `Error` for one that has no inverse, or is too small.
    static InstanceRecord make(std::size_t number, const GroupRecord& group, const RenderSpace& scene,
                               const DMat4& to_world, const Origin& origin) {
        const double ratio = scene.scale() / group.space.scale();
        const DMat3 linear = DMat3(to_world) * ratio;
        const DVec3 shift = scene.point(DVec3(to_world * glm::dvec4(group.space.center(), 1)));
        const DMat3 inverse = glm::inverse(linear);
        const double squeezed = squeeze(linear);
        if (const std::string problem = squeeze_problem(squeezed); !problem.empty()) fail(origin, problem);
        if (!(largest_entry(linear) > smallest_shape))
            fail(origin, "the instance is too small to be seen beside the rest of the scene");
        // Embree inverts the matrix in single precision.
        return {.group = number,
                .to_scene = {Mat3(linear), Vec3(shift)},
                .to_group = {Mat3(inverse), Vec3(-(inverse * shift))},
                .rounding = gamma_bound(8) * float(9 * squeezed)};
    }

    /// As Embree takes it.
    std::array<Vec3, 4> columns() const {
        return {to_scene.linear[0], to_scene.linear[1], to_scene.linear[2], to_scene.shift};
    }
};

/// The scene that rays are traced through: the shapes themselves, or, where there are instances, nothing but these.
struct Placement {
    embree::Accelerator accelerator;
    std::vector<InstanceRecord> instances;  ///< by Embree's number

    /// All groups where the records place them.
    static Placement make(const std::vector<GroupRecord>& groups, std::vector<InstanceRecord> instances) {
        embree::Accelerator accelerator(groups.front().accelerator->device());
        for (const InstanceRecord& instance : instances)
            accelerator.add_instance(*groups[instance.group].accelerator, instance.columns());
        accelerator.commit(false);
        return {std::move(accelerator), std::move(instances)};
    }

    /// The same with the instance of that number (of the description) in another place; see `Scene::with_instance`.
    Placement moved(const std::vector<GroupRecord>& groups, const RenderSpace& space, double radius, std::size_t number,
                    const DMat4& to_world) const {
        const std::size_t index = number + 1;  // after the shapes that belong to no group
        if (index >= instances.size())
            throw Error("there is no instance " + std::to_string(number) + "; the scene has " +
                        std::to_string(instances.empty() ? 0 : instances.size() - 1));
        std::vector<InstanceRecord> result = instances;
        InstanceRecord& instance = result[index];
        if (instance.luminous) throw Error("an instance with lights cannot be moved: build the scene again");
        const GroupRecord& group = groups[instance.group];
        Bounds bounds;
        bounds.include(group.bounds, to_world);
        for (const DVec3& corner : {bounds.lower, bounds.upper})
            if (!(glm::length(space.point(corner)) <= 1.01 * radius))
                throw Error("the instance would leave the sphere around the scene: build the scene again");
        instance = InstanceRecord::make(instance.group, group, space, to_world, {});
        return make(groups, std::move(result));
    }
};

}  // namespace lightswitch::detail
