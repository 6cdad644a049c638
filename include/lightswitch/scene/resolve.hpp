#pragma once

// From a material that differs from place to place to the surface model at a point: texture coordinates, layers.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/scene/locate.hpp>

#include <bit>

namespace lightswitch::detail {

/// The texture coordinates of a hit on a triangle mesh; without any in the description the barycentric weights of the
/// second and third corner.
inline Vec2 uv_on_triangle(const auto& data, const embree::Hit& hit) {
    const std::uint32_t first = data.first_uvs[hit.geometry];
    if (first == MeshRecord::flat) return {hit.u, hit.v};
    const auto& corners = data.uvs[first + hit.primitive];
    return (1 - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2];
}

/// A direction from the centre of a sphere to a point on it, in the sphere's own axes.
inline Vec3 on_unit_sphere(const auto& data, std::uint32_t sphere, const Vec3& normal) {
    return data.sphere_axes[sphere] * (data.spheres[sphere].side * normal);
}

/// The same on a sphere: u goes around its z axis, from x over y, v from the top to the bottom.
inline Vec2 uv_on_sphere(const Vec3& local) {
    const float around = std::atan2(local.y, local.x) * (0.5f * inv_pi);
    return {around < 0 ? around + 1 : around, std::acos(std::clamp(local.z, -1.0f, 1.0f)) * inv_pi};
}

/// How the position grows with u and with v; 0 where texture coordinates say nothing of it.
struct Tangents {
    Vec3 u{0}, v{0};
};

/// `corners` are those of the triangle that was hit.
inline Tangents tangents_on_triangle(const auto& data, const embree::Hit& hit, const std::array<Vec3, 3>& corners) {
    const std::uint32_t first = data.first_uvs[hit.geometry];
    if (first == MeshRecord::flat) return {};
    const auto& uv = data.uvs[first + hit.primitive];
    const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const float determinant = d1.x * d2.y - d1.y * d2.x;
    if (determinant == 0) return {};
    const Vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
    const float inverse = 1 / determinant;
    const Tangents result{(d2.y * edge1 - d1.y * edge2) * inverse, (d1.x * edge2 - d2.x * edge1) * inverse};
    return is_finite(result.u) && is_finite(result.v) ? result : Tangents{};
}

inline Tangents tangents_on_sphere(const auto& data, std::uint32_t sphere, const Vec3& local) {
    const Mat3 to_world = glm::transpose(data.sphere_axes[sphere]);
    const float radius = data.spheres[sphere].radius;
    const float sine = std::sqrt(local.x * local.x + local.y * local.y);
    const Vec2 around = sine > 0 ? Vec2(local.x, local.y) / sine : Vec2(1, 0);
    return {2 * pi * radius * (to_world * Vec3(-local.y, local.x, 0)),
            pi * radius * (to_world * Vec3(local.z * around.x, local.z * around.y, -sine))};
}

/// Numbers in [0, 1) by which layers decide, drawn from where a ray meets the surface: so every method, and a shadow
/// ray too, decides for a path with the same probability.
class LayerChoices {
public:
    explicit LayerChoices(const SurfacePoint& point) {
        const auto add = [&](float value) { state_ = mix64(state_ ^ std::bit_cast<std::uint32_t>(value)); };
        for (int c = 0; c < 3; ++c) add(point.position[c]);
        for (int c = 0; c < 3; ++c) add(point.wo[c]);
    }

    float next() {
        state_ = mix64(state_ + 0x9e3779b97f4a7c15u);
        return static_cast<float>(state_ >> 40) * 0x1p-24f;
    }

private:
    std::uint64_t state_ = 0x2545f4914f6cdd1du;
};

/// The shading normal after a bump map: that of the surface raised along the normal `n` by a height with that `slope`
/// along u and v.
inline Vec3 bumped_normal(const SurfacePoint& point, const Tangents& tangents, const Vec2& slope) {
    const Vec3 n = point.shading_normal;
    const auto raised = [&](const Vec3& tangent, float rise) { return tangent + n * (rise - dot(n, tangent)); };
    const Vec3 normal = cross(raised(tangents.u, slope.x), raised(tangents.v, slope.y));
    const float squared = length_squared(normal);
    if (!(squared > 0) || !(squared < infinity)) return n;
    const Vec3 unit = normal * (1 / std::sqrt(squared));
    return dot(unit, point.normal) < 0 ? -unit : unit;
}

/// The shading normal that a normal map gives at `uv`.
inline Vec3 mapped_normal(const SurfacePoint& point, const Tangents& tangents, const LayerRecord& map, const Vec2& uv) {
    const Vec3 stored = 2.0f * map.texture(uv) - Vec3(1);
    const bool mirrored = map.against_v && dot(cross(tangents.u, tangents.v), point.shading_normal) > 0;
    const Vec3 local(map.scale * stored.x, (mirrored ? -map.scale : map.scale) * stored.y, stored.z);
    const float squared = length_squared(local);
    if (!(squared > 0)) return point.shading_normal;
    return Basis(point.shading_normal, tangents.u).to_world(local * (1 / std::sqrt(squared)));
}

/// The probability with which the layers lead from a material to a model that is not specular. `behind` is whether the
/// surface is seen from the back.
template <class Data>
float presence(const Data& data, MaterialIndex material, const Vec2& uv, bool behind) {
    if (material.kind() < Data::is_specular.size()) return Data::is_specular[material.kind()] ? 0.0f : 1.0f;
    const LayerRecord& layer = data.layers[material.position()];
    if (layer.certain) return 1;
    const auto below = [&](int i) { return presence(data, layer.inner[static_cast<std::size_t>(i)], uv, behind); };
    switch (layer.kind) {
        case LayerRecord::Kind::blend: {
            const float second = std::clamp(luminance(layer.texture(uv)), 0.0f, 1.0f);
            return (1 - second) * below(0) + second * below(1);
        }
        case LayerRecord::Kind::mask: return std::clamp(luminance(layer.texture(uv)), 0.0f, 1.0f) * below(0);
        case LayerRecord::Kind::both_sides: return below(behind ? 1 : 0);
        default: return below(0);
    }
}

/// The same at a point; 1 where a scene type has no layers.
float presence(const auto&, const SurfacePoint&) { return 1; }
template <class... M>
float presence(const auto& data, const PlacedPoint<M...>& point) {
    return presence(data, point.outermost, point.uv, point.behind);
}

/// What layers do to the model below them.
struct Overlay {
    MappedNormal map;                  ///< all but the normal before, for which the frame must be known
    const CoatOptics* coat = nullptr;  ///< if there is one
};

/// Goes down the layers over a point until a surface model is reached, which becomes the point's material; false where
/// the surface is not there. `tangents()` is asked when a layer needs them.
template <std::size_t layers>
bool resolve_layers(const auto& data, const Vec2& uv, SurfacePoint& point, Overlay& over, const auto& tangents) {
    LayerChoices choices(point);
    const Vec3 before = point.shading_normal;
    const bool behind = dot(point.wo, before) < 0;
    bool two_sided = point.material.two_sided();
    const auto take = [&](const LayerRecord& layer, const Vec3& normal) {
        // Under a two-sided layer that is seen from behind the map lies on the mirrored surface.
        const bool mirrored = two_sided && behind;
        point.shading_normal = mirrored ? normal - 2 * dot(normal, before) * before : normal;
        two_sided = false;
        over.map = {.active = true, .flips = layer.flips, .shadows = layer.shadows};
    };
    MaterialIndex next = point.material;
    while (next.kind() == layers) {
        const LayerRecord& layer = data.layers[next.position()];
        switch (layer.kind) {
            case LayerRecord::Kind::blend:
                next = layer.inner[choices.next() < luminance(layer.texture(uv)) ? 1 : 0];
                break;
            case LayerRecord::Kind::mask:
                if (choices.next() >= luminance(layer.texture(uv))) return false;
                next = layer.inner[0];
                break;
            case LayerRecord::Kind::bump_map:
                take(layer, bumped_normal(point, tangents(), layer.scale * layer.texture.gradient(uv)));
                next = layer.inner[0];
                break;
            case LayerRecord::Kind::normal_map:
                take(layer, mapped_normal(point, tangents(), layer, uv));
                next = layer.inner[0];
                break;
            case LayerRecord::Kind::both_sides:
                next = layer.inner[behind ? 1 : 0];
                two_sided = true;
                break;
            case LayerRecord::Kind::coat:
                over.coat = &data.coats[layer.coat];
                next = layer.inner[0];
                break;
        }
        two_sided = two_sided || next.two_sided();
    }
    if (over.map.active && two_sided) {  // below the map: which side is seen, the surface before the map says
        if (behind) point.shading_normal = -point.shading_normal;
        two_sided = false;
    }
    // The point keeps its model, even of a material that is the same everywhere. A turned normal says little about
    // where light comes from.
    const std::size_t flags = (two_sided ? MaterialIndex::both_sides : 0) | MaterialIndex::varying |
                              (next.lit_through() || over.map.active ? MaterialIndex::through : 0);
    point.material = MaterialIndex(next.kind(), next.position(), flags);
    return true;
}

/// The instance that was hit, if it changes anything.
inline const InstanceRecord* instance_of(const Placement& placement, const embree::Hit& hit) {
    if (hit.instance == embree::Hit::no_instance || placement.instances[hit.instance].in_place) return nullptr;
    return &placement.instances[hit.instance];
}

/// `hit` as `locate` left it; `local` is where a sphere was hit, from its centre and in its own axes.
inline Tangents find_tangents(const auto& data, const Placement& placement, const embree::Hit& hit, const Vec3& local) {
    const InstanceRecord* const instance = instance_of(placement, hit);
    Tangents result;
    if (hit.geometry >= data.meshes.size()) {
        result = tangents_on_sphere(data, hit.primitive, local);
    } else if (hit.instance == embree::Hit::no_instance) {
        result = tangents_on_triangle(data, hit, placement.accelerator.corners(hit.geometry, hit.primitive));
    } else {
        const GroupRecord& group = data.groups[placement.instances[hit.instance].group];
        result =
            tangents_on_triangle(data, hit, group.accelerator->corners(hit.geometry - group.first_mesh, hit.primitive));
    }
    if (instance) result = {instance->to_scene.linear * result.u, instance->to_scene.linear * result.v};
    return result;
}

/// Finds the surface model at a `PlacedPoint` whose material varies, and its material, texture coordinates and tangent;
/// false where the surface is not there. `hit` as `locate` left it.
template <class Point>
[[gnu::noinline]] bool resolve(const auto& data, const Placement& placement, const embree::Hit& hit, Point& point) {
    constexpr std::size_t kinds = std::tuple_size_v<decltype(data.bsdfs)>;
    const bool on_sphere = hit.geometry >= data.meshes.size();
    Vec3 local(0);
    if (on_sphere) {
        const InstanceRecord* const instance = instance_of(placement, hit);
        local = on_unit_sphere(
            data, hit.primitive,
            instance ? normalize(glm::transpose(instance->to_scene.linear) * point.normal) : point.normal);
    }
    const auto tangents = [&] { return find_tangents(data, placement, hit, local); };
    point.uv = on_sphere ? uv_on_sphere(local) : uv_on_triangle(data, hit);
    point.tangent = Vec3(0);
    const Vec3 normal_before = point.shading_normal;
    Overlay over;
    point.outermost = point.material;
    point.behind = dot(point.wo, normal_before) < 0;
    if (point.material.kind() == kinds && !resolve_layers<kinds>(data, point.uv, point, over, tangents)) return false;
    dispatch<kinds>(point.material.kind(), [&](auto kind) {
        const auto& material = std::get<kind>(data.bsdfs)[point.material.position()];
        using Model = model_of<std::remove_cvref_t<decltype(material)>>;
        // Made in one piece: a model's defaults may be dear to find.
        Mapped<Model>& model = [&]() -> Mapped<Model>& {
            if constexpr (std::same_as<Model, std::remove_cvref_t<decltype(material)>>)
                return point.model.template emplace<kind>(Mapped<Model>{material, {}});
            else return point.model.template emplace<kind>(Mapped<Model>{material.at(Place{point.uv, point}), {}});
        }();
        if (!is_isotropic(model)) point.tangent = tangents().u;
        if (over.map.active) {
            const Vec3 before = point.shading_frame().to_local(normal_before);
            over.map.before = before.z < 0 ? -before : before;
            model.map = over.map;
        }
        if (over.coat) {
            model.coat = over.coat;
            model.map.active = true;
        }
    });
    return true;
}

/// Follows a ray from a point where the surface is not there to the first one where it is, if there is one. Only where
/// the ray begins is moved: it ends where it did, just before a light perhaps.
template <class Point>
[[gnu::noinline]] void go_on(const auto& data, const Placement& placement, Ray ray, Maybe<Point>& point) {
    for (;;) {
        ray.near = point->distance + point->offset / std::abs(dot(point->normal, ray.direction));
        point = {};
        embree::Hit hit;
        if (!(ray.near < ray.far) || !placement.accelerator.intersect(ray, hit)) return;
        locate(data, placement, ray, hit, point.emplace());
        if (!point->material.varies() || resolve(data, placement, hit, *point)) return;
    }
}

}  // namespace lightswitch::detail
