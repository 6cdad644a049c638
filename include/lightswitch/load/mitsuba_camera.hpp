#pragma once

// Camera, film, sampler and integrator in Mitsuba's scene files.

#include <lightswitch/load/xml_element.hpp>
#include <lightswitch/scene/library.hpp>

namespace lightswitch::detail {

inline Filter read_filter(const XmlFile& file, pugi::xml_node node) {
    XmlElement element(file, node);
    const auto positive = [&](const std::string& name, double otherwise) {
        const double value = element.number(name, otherwise);
        if (!(value > 0 && value <= 1000)) fail(element.origin(name), "must be above 0 and at most 1000 pixels");
        return static_cast<float>(value);
    };
    Filter result = Filter::box();
    if (element.type() == "tent") result = Filter::tent(positive("radius", 1));
    else if (element.type() == "gaussian") result = Filter::gaussian(positive("stddev", 0.5));
    else if (element.type() != "box") element.unknown_type("box, tent and gaussian");
    element.finish();
    return result;
}

/// The one object with that tag inside `element`, or nothing. Throws when there are several.
inline std::optional<pugi::xml_node> at_most_one(XmlElement& element, std::string_view tag) {
    const auto found = element.objects({tag});
    if (found.size() > 1) fail(element.file().origin(found[1]), "is the second one in " + element.origin().element);
    if (found.empty()) return {};
    return found[0];
}

inline FilmDescription read_film(const XmlFile& file, pugi::xml_node node) {
    XmlElement element(file, node);
    if (element.type() != "hdrfilm") element.unknown_type("hdrfilm");
    FilmDescription film{.width = element.integer("width", 0).value_or(768),
                         .height = element.integer("height", 0).value_or(576),
                         .filter = Filter::gaussian(),
                         .origin = element.origin()};
    if (const auto filter = at_most_one(element, "rfilter")) film.filter = read_filter(file, *filter);

    const auto one_of = [&](const std::string& name, std::initializer_list<std::string_view> accepted) {
        const auto value = element.text(name);
        if (value && std::find(accepted.begin(), accepted.end(), lower_case(*value)) == accepted.end())
            fail(element.origin(name), quote(*value) + " is not supported: use " + quote(*accepted.begin()));
    };
    one_of("pixel_format", {"rgb"});
    // How Mitsuba would store the image says nothing about what is in it.
    one_of("component_format", {"float32", "float16", "uint32"});
    one_of("file_format", {"openexr", "exr", "pfm", "rgbe"});
    element.boolean("banner", false);
    element.boolean("compensate", false);

    film.crop_x = element.integer("crop_offset_x", 0).value_or(0);
    film.crop_y = element.integer("crop_offset_y", 0).value_or(0);
    const int width = element.integer("crop_width", 0).value_or(film.width),
              height = element.integer("crop_height", 0).value_or(film.height);
    if (width != film.width || height != film.height || film.crop_x != 0 || film.crop_y != 0) {
        if (film.crop_x > film.width - width || film.crop_y > film.height - height)
            element.error("the crop window is not within the film");
        film.full_width = std::exchange(film.width, width);
        film.full_height = std::exchange(film.height, height);
    }
    if (element.boolean("sample_border", false))
        fail(element.origin("sample_border"), "is not supported: set it to false");
    element.finish();
    return film;
}

/// Samples per pixel. Which sampler draws them changes only the noise.
inline int read_sampler(const XmlFile& file, pugi::xml_node node) {
    XmlElement element(file, node);
    const std::string type = element.type();
    const int samples = element.integer("sample_count", 1).value_or(4);
    element.integer("seed", 0);
    if (type == "stratified" || type == "multijitter" || type == "orthogonal") element.boolean("jitter", true);
    else if (type != "independent" && type != "ldsampler")
        element.unknown_type("independent, stratified, multijitter, orthogonal and ldsampler");
    if (type == "orthogonal") element.integer("strength", 0);
    element.finish();
    return samples;
}

inline void read_field_of_view(XmlElement& element, CameraDescription& camera) {
    const auto fov = element.number("fov");
    const auto focal_length = element.text("focal_length");
    if (fov && focal_length) element.error("give either fov or focal_length");
    if (!fov) {
        // As Mitsuba defines it: twice the diagonal of 35 mm film lies across the focal length.
        std::string_view length = focal_length ? std::string_view(*focal_length) : "50mm";
        if (length.ends_with("mm")) length.remove_suffix(2);
        const auto millimetres = parse_number(next_word(length));
        if (!millimetres || !(*millimetres > 0) || !next_word(length).empty())
            fail(element.origin("focal_length"), quote(*focal_length) + " is not a focal length such as \"50mm\"");
        camera.fov = 2 * std::atan(std::hypot(36.0, 24.0) / (2 * *millimetres)) * 180 / std::numbers::pi;
        camera.fov_axis = CameraDescription::FovAxis::diagonal;
        if (element.has("fov_axis")) fail(element.origin("fov_axis"), "has no meaning without fov");
        return;
    }
    camera.fov = *fov;
    const std::string axis = lower_case(element.text("fov_axis").value_or("x"));
    using enum CameraDescription::FovAxis;
    static const std::map<std::string, CameraDescription::FovAxis> axes{
        {"x", x}, {"y", y}, {"diagonal", diagonal}, {"smaller", smaller}, {"larger", larger}};
    const auto found = axes.find(axis);
    if (found == axes.end())
        fail(element.origin("fov_axis"), quote(axis) + " is not x, y, diagonal, smaller or larger");
    camera.fov_axis = found->second;
}

/// Reads a `<sensor>` into the camera, film and sample count of `scene`.
///
/// Clipping planes that the file does not give are at 0 and infinity, unlike Mitsuba's 0.01 and 10000, which depend on
/// the scale of the scene.
inline void read_sensor(const XmlFile& file, pugi::xml_node node, LibraryDescription& scene) {
    XmlElement element(file, node);
    const bool lens = element.type() == "thinlens", orthographic = element.type() == "orthographic";
    if (!lens && !orthographic && element.type() != "perspective")
        element.unknown_type("perspective, thinlens and orthographic");

    CameraDescription camera;
    camera.origin = element.origin();
    if (orthographic) camera.projection = CameraDescription::Projection::orthographic;
    if (!orthographic) read_field_of_view(element, camera);
    if (auto to_world = element.transform("to_world")) {
        if (orthographic) {
            // The image shows what is within 1 of the axis in each direction, before it is scaled.
            camera.half_width = glm::length(DVec3((*to_world)[0]));
            for (int i = 0; i < 3; ++i) (*to_world)[i] /= camera.half_width;
        }
        camera.to_world = *to_world;
        // The same tolerance as in Mitsuba, for matrices written with few digits.
        if (!is_orthonormal(DMat3(*to_world), 1e-3))
            fail(element.origin("to_world"), "the transform of a camera must not contain a scale or shear");
    }

    const auto near_clip = element.number("near_clip"), far_clip = element.number("far_clip");
    camera.near_clip = near_clip.value_or(camera.near_clip);
    camera.far_clip = far_clip.value_or(camera.far_clip);
    if (near_clip && !(*near_clip > 0)) fail(element.origin("near_clip"), "must be above 0");
    if (!(camera.near_clip < camera.far_clip)) element.error("near_clip must be smaller than far_clip");

    const auto focus = element.number("focus_distance");
    if (focus && !(*focus > 0)) fail(element.origin("focus_distance"), "must be above 0");
    if (lens) {
        const auto radius = element.number("aperture_radius");
        if (!radius) element.error("the parameter \"aperture_radius\" is missing");
        if (!(*radius >= 0)) fail(element.origin("aperture_radius"), "must not be negative");
        camera.aperture_radius = *radius;
        camera.focus_distance = focus.value_or(far_clip.value_or(10000));  // Mitsuba's default: the far plane
    } else if (!orthographic) {
        // As Mitsuba 3.9 renders it, a positive offset moves what is seen to the left, or up.
        camera.principal_point_offset = {-element.number("principal_point_offset_x", 0),
                                         -element.number("principal_point_offset_y", 0)};
    }

    scene.camera = camera;
    scene.film = FilmDescription{.width = 768, .height = 576, .filter = Filter::gaussian(), .origin = element.origin()};
    if (const auto film = at_most_one(element, "film")) scene.film = read_film(file, *film);
    if (const auto sampler = at_most_one(element, "sampler")) scene.samples = read_sampler(file, *sampler);
    element.finish();
}

/// Reads the depths of an `<integrator>`; which method renders is not the file's choice.
inline void read_integrator(const XmlFile& file, pugi::xml_node node, LibraryDescription& scene) {
    XmlElement element(file, node);
    if (element.type() != "path") element.unknown_type("path");
    scene.max_depth = element.integer("max_depth", -1).value_or(-1);
    scene.rr_depth = element.integer("rr_depth", 1).value_or(5);
    if (element.boolean("hide_emitters", false))
        fail(element.origin("hide_emitters"), "is not supported: set it to false");
    element.finish();
}

}  // namespace lightswitch::detail
