#pragma once

// A scene as data: what a file or a program says, before anything is checked, scaled or built.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/film/filter.hpp>
#include <lightswitch/scene/shapes.hpp>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lightswitch {

/// A light at a point: `intensity` in W/sr.
struct PointSource {
    DVec3 position{0};
    Rgb intensity{1};
};

/// A light from infinitely far away: light travels along `direction` (any length but 0) and brings `irradiance` (W/m^2)
/// to a surface that faces it.
struct DirectionalSource {
    DVec3 direction{0, 0, -1};
    Rgb irradiance{1};
};

/// The same radiance (W/(m^2 sr)) from every direction beyond the scene.
struct EnvironmentSource {
    Rgb radiance{1};
};

using Source = std::variant<PointSource, DirectionalSource, EnvironmentSource>;

/// A perspective camera, with a thin lens when `aperture_radius` is above 0.
///
/// In camera space it looks along +z, with +y up in the image and +x to the left (the convention of Mitsuba).
struct CameraDescription {
    enum class FovAxis { x, y, diagonal, smaller, larger };

    DMat4 to_world{1};     ///< rigid, reflections allowed
    double fov = 39.3077;  ///< full angle in degrees, strictly between 0 and 180
    FovAxis fov_axis = FovAxis::x;
    double aperture_radius = 0;  ///< in scene units
    double focus_distance = 1;   ///< along the optical axis, in scene units
    double near_clip = 0;        ///< along the optical axis, in scene units
    double far_clip = std::numeric_limits<double>::infinity();
    Origin origin;

    /// `to_world` of a camera at `eye` that looks at `target` with `up` upwards in the image: its columns are left, up,
    /// forward and `eye`. Throws `Error` when `target` is at `eye`, or `up` has no part across the view.
    static DMat4 look_at(const DVec3& eye, const DVec3& target, const DVec3& up);
};

inline DMat4 CameraDescription::look_at(const DVec3& eye, const DVec3& target, const DVec3& up) {
    const DVec3 view = target - eye;
    if (!(glm::length(view) > 0)) throw Error("the camera looks at its own position: move the target or the eye");
    const DVec3 forward = glm::normalize(view);
    const DVec3 across = glm::cross(up, forward);
    // Below this the direction would be made of rounding errors.
    if (!(glm::length(across) > 1e-12 * glm::length(up)))
        throw Error("the camera's up vector is parallel to its view: give another one");
    const DVec3 left = glm::normalize(across);
    return {glm::dvec4(left, 0), glm::dvec4(glm::cross(forward, left), 0), glm::dvec4(forward, 0), glm::dvec4(eye, 1)};
}

/// Size of the image and how samples become pixels.
struct FilmDescription {
    int width = 256, height = 256;
    Filter filter = Filter::box();
    Origin origin;
};

/// A scene whose surfaces are described by `Material`: one BSDF type, or a `std::variant` of several.
template <class Material>
struct SceneDescription {
    struct Shape {
        std::variant<Mesh, Sphere> geometry;
        std::size_t material = 0;     ///< index into `materials`
        std::optional<Rgb> emission;  ///< radiance that the front emits, W/(m^2 sr)
        Origin origin;
    };
    struct NamedMaterial {
        Material bsdf;
        Origin origin;
    };
    struct PlacedSource {
        Source source;
        Origin origin;
    };

    std::string name = "scene";
    std::vector<NamedMaterial> materials;
    std::vector<Shape> shapes;
    std::vector<PlacedSource> sources;
    CameraDescription camera;
    FilmDescription film;
    std::optional<int> max_depth;  ///< what the file asks of a method, if it does
    std::optional<int> rr_depth;
    std::optional<int> samples;      ///< samples per pixel that the file asks for
    std::vector<std::string> files;  ///< what was read: the scene's file and those of its meshes

    std::size_t add(Material bsdf, Origin origin = {}) {
        materials.push_back({std::move(bsdf), std::move(origin)});
        return materials.size() - 1;
    }
    void add(std::variant<Mesh, Sphere> geometry, std::size_t material, std::optional<Rgb> emission = {},
             Origin origin = {}) {
        shapes.push_back({std::move(geometry), material, emission, std::move(origin)});
    }
    void add(Source source, Origin origin = {}) { sources.push_back({source, std::move(origin)}); }
};

}  // namespace lightswitch
