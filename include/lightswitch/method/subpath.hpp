#pragma once

// Paths from the lights and from the camera, which the bidirectional methods join, with the weights of multiple
// importance sampling in a form that is carried along the path: a vertex knows all that a weight needs of the path
// before it (Georgiev, "Implementing Vertex Connection and Merging", 2012; the names there are d^VCM, d^VC and d^VM).
//
// Densities are compared by the power heuristic with exponent 2. Sums are in double: they are products of many
// densities.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/camera/camera.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/method/roulette.hpp>
#include <lightswitch/render/path_classes.hpp>

namespace lightswitch {

/// Which paths are made.
struct PathLimits : PathLength {
    PathClasses left_out = {};
};

/// How merging (of camera path vertices with the light path vertices around them) is weighed against connecting. Both 0
/// for a method that only connects. With n light paths per iteration and radius r, merging has n pi r^2 times the
/// density of a connection.
struct MergeWeights {
    double merges = 0;   ///< n pi r^2
    double merge = 0;    ///< heuristic(merges)
    double connect = 0;  ///< heuristic(1 / merges)
};

/// Sums over all strategies that make the path before a vertex otherwise, each as a ratio of densities (through
/// `heuristic`), without the factors that depend on how the path goes on.
struct PartialWeights {
    double last = 0;         ///< the strategy that connects at the vertex before
    double connections = 0;  ///< all that connect further back
    double merges = 0;       ///< the same sums as they stand against merging at the vertex
};

/// What `intersect` of a type of scene, or reference to one, finds: a `SurfacePoint` or more.
template <class SceneType>
using point_of = std::remove_cvref_t<decltype(*std::declval<SceneType>().intersect(Ray()))>;

/// A vertex of a path, and what the path has carried to it.
template <class Point>
struct PathVertex {
    Point point;        ///< `wo` is where the path comes from
    Rgb throughput{0};  ///< importance or power that arrives, over the density of the path
    PartialWeights weights;
    int edges = 0;  ///< segments from the start of the path to here
};

/// Where a path comes from, in the frame of the surface: worked out once for all the ways in which the path could go
/// on.
struct Arrival {
    Basis basis;
    Vec3 from;

    [[gnu::always_inline]] explicit Arrival(const auto& at) : basis(at.shading_frame()), from(basis.to_local(at.wo)) {}
};

/// A BSDF evaluated between the direction that a path comes from and one that it could leave by.
struct Turn {
    Rgb value{0};                 ///< the BSDF times the cosine that belongs to it, see `turn`
    SolidAnglePdf pdf{};          ///< of going there
    SolidAnglePdf reverse_pdf{};  ///< of coming the other way
};

/// The cosine that the BSDF is multiplied by where a path leaves along `out`. Interpolated normals make it differ:
/// radiance takes the cosine of the incident light to the shading normal; light, which travels the other way, must take
/// the same one, over the cosine to the true surface by which its power was spread there (Veach 1997, section 5.3.2).
template <Transport transport>
[[gnu::always_inline]] inline float cosine_factor(const SurfacePoint& at, const Vec3& out) {
    if constexpr (transport == Transport::radiance) {
        return std::abs(dot(at.shading_normal, out));
    } else {
        const float spread = std::abs(dot(at.normal, at.wo));
        return spread > 0 ? std::abs(dot(at.normal, out) * dot(at.shading_normal, at.wo)) / spread : 0;
    }
}

/// `Turn` of the path at `at` towards `out` (unit). Black at a specular surface.
template <Transport transport>
[[gnu::always_inline]] inline Turn turn(const auto& scene, const auto& at, const Arrival& arrival, const Vec3& out) {
    const Vec3 from = arrival.from, to = arrival.basis.to_local(out);
    return scene.with_bsdf(
        at, [&](const auto& bsdf) __attribute__((always_inline)) {
            Turn result;
            if constexpr (!std::remove_cvref_t<decltype(bsdf)>::specular) {
                const BsdfValue scattering = bsdf.evaluate(from, to, transport);
                if (!is_black(scattering.value)) {
                    result = {.value = scattering.value * cosine_factor<transport>(at, out),
                              .pdf = scattering.pdf,
                              .reverse_pdf = bsdf.evaluate(to, from, reversed(transport)).pdf};
                }
            }
            return result;
        });
}

/// A path as it grows from a light (`Transport::importance`) or from the camera (`Transport::radiance`). `advance` and
/// `scatter` take turns: after `advance` the vertex at hand is complete, and `scatter` chooses how the path leaves it.
template <Transport transport, class Point>
class Subpath {
public:
    /// From the camera, along a ray of `Camera::ray`; `light_paths` is how many light paths an iteration has.
    Subpath(const Ray& camera_ray, double light_paths,
            const MergeWeights& merge_weights) requires(transport == Transport::radiance)
        : ray_(camera_ray), merge_weights_(merge_weights), light_paths_(light_paths) {}

    /// From a light that `sampler` chooses. The path carries nothing when there is no light.
    Subpath(const auto& scene, auto& sampler,
            const MergeWeights& merge_weights) requires(transport == Transport::importance)
        : merge_weights_(merge_weights) {
        const float choice = sampler.next_1d();
        const Vec2 place = sampler.next_2d(), direction = sampler.next_2d();
        emission_ = scene.sample_emission(choice, place, direction);
        tell(scene, emission_);
        ray_ = emission_.ray;
        start_ = emission_.weight;
    }

    /// Goes to the next surface and returns true, or returns false when there is none.
    [[gnu::always_inline]] bool advance(const auto& scene) {
        const auto hit = scene.intersect(ray_);
        ++vertex_.edges;
        if (!hit) return false;
        vertex_.point = *hit;
        vertex_.throughput = start_ * beta_;
        const double cosine = std::abs(dot(ray_.direction, hit->normal));
        PartialWeights& w = vertex_.weights;
        if (vertex_.edges > 1) {
            w.last *= heuristic(square(hit->distance));
        } else if constexpr (transport == Transport::radiance) {
            w.last =
                heuristic(light_paths_ / connectable_camera(scene.camera()).density(hit->position, ray_.direction));
        } else {
            w.last = heuristic(scene.spread(emission_.light, *hit, hit->wo, ray_.origin));
            if (!emission_.dirac) w.connections = heuristic(emission_.cosine / emission_.pdf);
            w.merges = w.connections * merge_weights_.connect;
        }
        const double per_area = 1 / heuristic(cosine);
        w.last *= per_area;
        w.connections *= per_area;
        w.merges *= per_area;
        return cosine > 0;
    }

    /// Chooses the direction in which the path leaves the vertex; false when it ends there. `direction` and `choices.x`
    /// select the direction, `choices.y` is for Russian roulette after `rr_depth` bounces.
    [[gnu::always_inline]] bool scatter(const auto& scene, const Vec2& direction, const Vec2& choices, int rr_depth) {
        const Point& at = vertex_.point;
        const Arrival arrival(at);
        SolidAnglePdf reverse;
        const auto scattered = scene.with_bsdf(
            at, [&](const auto& bsdf) __attribute__((always_inline)) {
                const auto result = bsdf.sample(arrival.from, Vec3(direction, choices.x), transport);
                if constexpr (!std::remove_cvref_t<decltype(bsdf)>::specular)
                    if (result && !result->specular)
                        reverse = bsdf.evaluate(result->wi, arrival.from, reversed(transport)).pdf;
                return result;
            });
        if (!scattered) return false;
        const Vec3 out = arrival.basis.to_world(scattered->wi);
        beta_ *= scattered->weight;
        if constexpr (transport == Transport::importance) {
            const float cosine = std::abs(scattered->wi.z);
            if (cosine > 0) beta_ *= cosine_factor<transport>(at, out) / cosine;
        } else {
            eta_ *= scattered->eta;
        }
        tell_bounce(scene, *scattered, out, beta_, eta_, vertex_.edges, rr_depth, choices.y, start_);
        if (!survives_roulette(beta_, eta_, vertex_.edges, rr_depth, choices.y)) return false;

        const double cosine = std::abs(dot(at.normal, out));
        PartialWeights& w = vertex_.weights;
        left_specularly_ = scattered->specular;
        if (scattered->specular) {  // nothing can connect or merge here; the densities of both directions cancel
            const double back = heuristic(cosine * double(scattered->reversal));
            w = {.last = 0, .connections = w.connections * back, .merges = w.merges * back};
        } else {
            const double forward = heuristic(cosine / scattered->pdf), back = heuristic(reverse);
            w = {.last = heuristic(1.0 / scattered->pdf),
                 .connections = forward * (w.connections * back + w.last + merge_weights_.merge),
                 .merges = forward * (w.merges * back + w.last * merge_weights_.connect + 1)};
        }
        previous_ = at.position;
        previous_normal_ = at.lit_normal();
        ray_ = at.spawn(out);
        return true;
    }

    const PathVertex<Point>& vertex() const { return vertex_; }
    const Ray& ray() const { return ray_; }
    /// Where the vertex before stands, and its `lit_normal()`.
    const Vec3& previous() const { return previous_; }
    const Vec3& previous_normal() const { return previous_normal_; }
    /// Whether the path starts at a point or directional light.
    bool from_dirac_light() const { return emission_.dirac; }
    /// Whether it left the vertex at hand by a Dirac lobe.
    bool left_specularly() const { return left_specularly_; }
    /// What the path carries along its ray.
    Rgb carried() const { return start_ * beta_; }

private:
    Ray ray_;
    PathVertex<Point> vertex_;
    Rgb start_{1}, beta_{1};
    bool left_specularly_ = false;
    float eta_ = 1;  // product of the relative indices of refraction crossed, for roulette
    Vec3 previous_{0}, previous_normal_{0};
    MergeWeights merge_weights_;
    double light_paths_ = 0;
    LightEmission emission_;
};

template <class Point>
using CameraSubpath = Subpath<Transport::radiance, Point>;
template <class Point>
using LightSubpath = Subpath<Transport::importance, Point>;

/// Whether connections can end at the point.
inline bool connectable(const auto& scene, const auto& at) {
    return !scene.with_bsdf(at, [](const auto& bsdf) { return std::remove_cvref_t<decltype(bsdf)>::specular; });
}

/// Traces a path from a light, calls `visit(vertex)` at each vertex to which something can be connected, and ends it
/// when no path of the allowed length could come of it.
void trace_light_subpath(const auto& scene, auto& sampler, const PathLimits& limits, const MergeWeights& merge_weights,
                         const auto& visit) {
    LightSubpath<point_of<decltype(scene)>> path(scene, sampler, merge_weights);
    if (is_black(path.carried()) || (limits.left_out.dirac_light && path.from_dirac_light())) return;
    const bool caustic = !(limits.left_out.dirac_caustic && path.from_dirac_light());
    while ((limits.max_depth < 0 || path.vertex().edges + 2 <= limits.max_depth) && path.advance(scene)) {
        if (connectable(scene, path.vertex().point)) visit(path.vertex());
        const Vec2 direction = sampler.next_2d(), choices = sampler.next_2d();
        if (!path.scatter(scene, direction, choices, limits.rr_depth)) return;
        if (!caustic && path.vertex().edges == 1 && path.left_specularly()) return;
    }
}

}  // namespace lightswitch
