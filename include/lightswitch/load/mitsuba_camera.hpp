#pragma once

// Camera, film, sampler and integrator in Mitsuba's scene files.

#include <lightswitch/load/xml_color.hpp>
#include <lightswitch/scene/check.hpp>
#include <lightswitch/scene/library.hpp>

namespace lightswitch::detail {

inline Filter read_filter(const XmlFile& file, pugi::xml_node node) {
    XmlElement element(file, node);
    const auto positive = [&](const std::string& name, double otherwise) {
        const double value = element.number(name, otherwise);
        if (value > 0 && value <= 1000) return static_cast<float>(value);
        element.problem(name, "must be above 0 and at most 1000 pixels", "it is " + number_text(otherwise));
        return static_cast<float>(otherwise);
    };
    const std::string type = element.type();
    Filter result = Filter::box();
    if (type == "tent") {
        result = Filter::tent(positive("radius", 1));
    } else if (type == "gaussian") {
        result = Filter::gaussian(positive("stddev", 0.5));
    } else if (type == "box") {
        if (element.number("radius", 0.5) != 0.5)
            element.problem("radius", "a box has a radius of 0.5 pixels here", "it has");
    } else {
        if (type != "mitchell" && type != "catmullrom" && type != "lanczos")
            element.unknown_type("box, tent and gaussian");
        // They differ from it by small negative lobes.
        file.log().notice(element.origin(), "there is no filter of this type: the nearest one, gaussian, is used");
        element.accept_rest();
        return Filter::gaussian();
    }
    element.finish();
    return result;
}

inline FilmDescription default_film(const Origin& origin) {
    return {.width = 768, .height = 576, .filter = Filter::gaussian(), .origin = origin};
}

/// The film, and the exposure of pictures that it asks for.
inline FilmDescription read_film(const XmlFile& file, pugi::xml_node node, std::optional<float>& exposure) {
    XmlElement element(file, node);
    const std::string type = element.type();
    if (type != "hdrfilm" && type != "ldrfilm")
        element.problem("", XmlElement::unknown(type, "hdrfilm and ldrfilm"), "it is read as hdrfilm");
    FilmDescription film = default_film(element.origin());
    film.width = element.integer("width", 1, 1 << 20).value_or(film.width);
    film.height = element.integer("height", 1, 1 << 20).value_or(film.height);
    if (const auto filter = element.object("rfilter"))
        film.filter = file.log().attempt(
            "it is gaussian", [&] { return read_filter(file, *filter); }, [] { return Filter::gaussian(); });

    film.crop_x = element.integer("crop_offset_x", 0).value_or(0);
    film.crop_y = element.integer("crop_offset_y", 0).value_or(0);
    const int width = element.integer("crop_width", 1).value_or(film.width),
              height = element.integer("crop_height", 1).value_or(film.height);
    if (film.crop_x > film.width - width || film.crop_y > film.height - height) {
        element.problem("", "the crop window is not within the film", "the whole is rendered");
        film.crop_x = film.crop_y = 0;
    } else if (width != film.width || height != film.height || film.crop_x != 0 || film.crop_y != 0) {
        film.full_width = std::exchange(film.width, width);
        film.full_height = std::exchange(film.height, height);
    }
    if (const auto stops = element.number("exposure")) exposure = static_cast<float>(*stops);
    // How Mitsuba would store the image, and what lies beside it, says nothing about what is in it.
    element.accept({"pixel_format", "component_format", "file_format", "banner", "compensate", "high_quality_edges",
                    "sample_border", "attach_log", "gamma", "tonemap_method", "key", "burn", "variable", "digits",
                    "channel_names"});
    if (element.is_old()) element.accept({"filename"});
    for (const char* prefix : {"metadata", "label"}) element.accept_beginning(prefix);
    element.finish();
    check(film);
    return film;
}

/// Samples per pixel. Which sampler draws them changes only the noise.
inline int read_sampler(const XmlFile& file, pugi::xml_node node) {
    XmlElement element(file, node);
    const int samples = element.integer("sample_count", 1).value_or(4);
    element.accept({"seed", "jitter", "strength", "scramble", "dimension"});
    element.finish();
    return samples;
}

inline void read_field_of_view(XmlElement& element, CameraDescription& camera) {
    const auto fov = element.number("fov");
    const auto focal_length = element.text("focal_length");
    if (fov && focal_length) element.problem("focal_length", "give either fov or focal_length", "it is ignored");
    if (!fov) {
        // As Mitsuba defines it: twice the diagonal of 35 mm film lies across the focal length.
        std::string_view length = focal_length ? std::string_view(*focal_length) : "50mm";
        if (length.ends_with("mm")) length.remove_suffix(2);
        const auto millimetres = parse_number(next_word(length));
        if (!millimetres || !(*millimetres > 0) || !next_word(length).empty())
            fail(element.origin("focal_length"), quote(*focal_length) + " is not a focal length such as \"50mm\"");
        camera.fov = 2 * std::atan(std::hypot(36.0, 24.0) / (2 * *millimetres)) * 180 / std::numbers::pi;
        camera.fov_axis = CameraDescription::FovAxis::diagonal;
        if (element.text("fov_axis")) element.problem("fov_axis", "has no meaning without fov", "it is ignored");
        return;
    }
    camera.fov = *fov;
    using enum CameraDescription::FovAxis;
    static const std::map<std::string, CameraDescription::FovAxis> axes{
        {"x", x}, {"y", y}, {"diagonal", diagonal}, {"smaller", smaller}, {"larger", larger}};
    camera.fov_axis = element.one_of("fov_axis", "x", axes);
}

/// The nearest matrix to speak of that has neither scale nor shear: it looks the same way, and up is in the same plane.
inline DMat4 without_scale(const DMat4& matrix) {
    const DVec3 forward = glm::normalize(DVec3(matrix[2]));
    const DVec3 side = glm::normalize(glm::cross(DVec3(matrix[1]), forward));
    const double mirror = linear_determinant(matrix) < 0 ? -1 : 1;
    return {glm::dvec4(mirror * side, 0), glm::dvec4(glm::cross(forward, side), 0), glm::dvec4(forward, 0), matrix[3]};
}

/// Reads a `<sensor>` into the camera, film and sample count of `scene`.
///
/// Clipping planes that the file does not give are at 0 and infinity, unlike Mitsuba's 0.01 and 10000, which depend on
/// the scale of the scene.
inline void read_sensor(const XmlFile& file, pugi::xml_node node, LibraryDescription& scene) {
    XmlElement element(file, node);
    const bool lens = element.type() == "thinlens", orthographic = element.type() == "orthographic";
    if (!lens && !orthographic && element.type() != "perspective")
        element.problem("", XmlElement::unknown(element.type(), "perspective, thinlens and orthographic"),
                        "it is read as perspective");

    CameraDescription camera;
    camera.origin = element.origin();
    if (orthographic) camera.projection = CameraDescription::Projection::orthographic;
    if (!orthographic) read_field_of_view(element, camera);
    double depth_scale = 1;
    if (auto to_world = element.transform("to_world")) {
        if (orthographic) {
            // The image shows what is within 1 of the axis in each direction, before it is scaled.
            camera.half_width = glm::length(DVec3((*to_world)[0]));
            depth_scale = glm::length(DVec3((*to_world)[2]));
            for (int i = 0; i < 2; ++i) (*to_world)[i] /= camera.half_width;
            (*to_world)[2] /= depth_scale;
        }
        camera.to_world = *to_world;
        // The same tolerance as in Mitsuba, for matrices written with few digits.
        if (!is_orthonormal(DMat3(*to_world), 1e-3)) {
            element.problem("to_world", "the transform of a camera must not contain a scale or shear",
                            "they are taken out");
            camera.to_world = without_scale(*to_world);
        }
    }

    const auto near_clip = element.number("near_clip"), far_clip = element.number("far_clip");
    if (near_clip && !(*near_clip > 0)) element.problem("near_clip", "must be above 0", "it is 0");
    else camera.near_clip = near_clip.value_or(camera.near_clip);
    if (far_clip && !(camera.near_clip < *far_clip))
        element.problem("", "near_clip must be smaller than far_clip", "far_clip is infinite");
    else camera.far_clip = far_clip.value_or(camera.far_clip);
    // As Mitsuba does it, a scale moves the nearer plane, but leaves both as far apart as they were.
    camera.far_clip += (depth_scale - 1) * camera.near_clip;
    camera.near_clip *= depth_scale;

    // Mitsuba's default is its far plane.
    const double focus = element.positive("focus_distance", std::isfinite(camera.far_clip) ? camera.far_clip : 10000);
    element.accept({"shutter_open", "shutter_close"});  // nothing moves
    element.refuse_media();
    if (lens) {
        const auto radius = element.number("aperture_radius");
        if (!radius) element.problem("", "the parameter \"aperture_radius\" is missing", "it is 0");
        if (radius && !(*radius >= 0)) element.problem("aperture_radius", "must not be negative", "it is 0");
        camera.aperture_radius = std::max(radius.value_or(0), 0.0);
        camera.focus_distance = focus;
    } else if (!orthographic) {
        // As Mitsuba 3.9 renders it, a positive offset moves what is seen to the left, or up.
        camera.principal_point_offset = {-element.number("principal_point_offset_x", 0),
                                         -element.number("principal_point_offset_y", 0)};
    }

    check(camera);
    scene.camera = camera;
    scene.film = default_film(element.origin());
    if (const auto film = element.object("film"))
        scene.film = file.log().attempt(
            "it is Mitsuba's default", [&] { return read_film(file, *film, scene.exposure); },
            [&] { return scene.film; });
    if (const auto sampler = element.object("sampler"))
        file.log().attempt("it is ignored", [&] { scene.samples = read_sampler(file, *sampler); });
    element.finish();
}

/// Reads the depths of an `<integrator>`, or of the first one inside that has some; which method renders is not the
/// file's choice.
inline void read_integrator(const XmlFile& file, pugi::xml_node node, LibraryDescription& scene) {
    constexpr int deepest = 64;
    for (int depth = 0; node; ++depth) {
        XmlElement element(file, node);
        if (depth == deepest)
            element.error("contains itself, or is in more than " + std::to_string(deepest) + " integrators");
        const std::string type = element.type();
        const auto inner = element.objects("integrator");
        node = {};
        if (type != "path")
            file.log().notice(element.origin(),
                              "which method renders is not the file's choice: only the path length counts");
        if (element.boolean("hide_emitters", false))
            file.log().notice(element.origin("hide_emitters"), "is not supported: lamps are seen");
        if (type == "direct") {
            scene.max_depth = 2;
        } else if (type == "path" || element.has("max_depth")) {
            scene.max_depth = element.integer("max_depth", -1).value_or(-1);
            scene.rr_depth = element.integer("rr_depth", 1).value_or(5);
        } else if (!inner.empty()) {
            node = inner[0];
        }
        element.accept({"strict_normals", "samples_per_pass", "block_size", "timeout"});
        // Mitsuba 0.x warns of what an integrator does not know, and goes on.
        if (type != "path" || element.is_old()) element.accept_rest();
        element.finish();
    }
}

}  // namespace lightswitch::detail
