#include "camera_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightswitch::program {
namespace {

DVec3 column(const CameraDescription& camera, int i) { return DVec3(camera.to_world[i]); }

DVec3 turned(const DVec3& v, const DVec3& axis, double angle) {
    // Rodrigues' formula.
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * (glm::dot(axis, v) * (1 - std::cos(angle)));
}

}  // namespace

CameraControl::CameraControl(const CameraDescription& start, double pivot_distance)
    : start_(start), camera_(start), start_distance_(pivot_distance), distance_(pivot_distance) {
    const DVec3 up = column(start, 1);
    int largest = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(up[i]) > std::abs(up[largest]) + 1e-9) largest = i;
    upwards_ = DVec3(0);
    upwards_[largest] = up[largest] < 0 ? -1 : 1;
}

DVec3 CameraControl::pivot() const { return column(camera_, 3) + distance_ * column(camera_, 2); }

double CameraControl::width_at_pivot() const {
    if (camera_.projection == CameraDescription::Projection::orthographic) return 2 * camera_.half_width;
    return 2 * distance_ * std::tan(glm::radians(camera_.fov) / 2);
}

/// Looks along `forward` at the pivot, with the world's axis upwards and the handedness that there was.
void CameraControl::turn_to(const DVec3& forward, const DVec3& pivot) {
    const double hand = glm::dot(glm::cross(column(camera_, 0), column(camera_, 1)), column(camera_, 2)) < 0 ? -1 : 1;
    const DVec3 ahead = glm::normalize(forward);
    const DVec3 left = glm::normalize(glm::cross(upwards_, ahead));
    camera_.to_world = {glm::dvec4(hand * left, 0), glm::dvec4(glm::cross(ahead, left), 0), glm::dvec4(ahead, 0),
                        glm::dvec4(pivot - distance_ * ahead, 1)};
    ++changes_;
}

void CameraControl::orbit(double left, double up) {
    const DVec3 center = pivot();
    DVec3 forward = turned(column(camera_, 2), upwards_, -left);
    // What is left of the way to the poles, but for a degree.
    const double height = std::asin(std::clamp(-glm::dot(forward, upwards_), -1.0, 1.0));
    constexpr double most = std::numbers::pi / 2 - std::numbers::pi / 180;
    const double rise = std::clamp(height + up, -most, most) - height;
    const DVec3 side = glm::cross(upwards_, forward);
    if (glm::length(side) > 1e-9) forward = turned(forward, glm::normalize(side), rise);
    else forward = turned(forward, column(camera_, 0), 0.02);
    turn_to(forward, center);
}

void CameraControl::pan(double right, double down) {
    const double width = width_at_pivot();
    camera_.to_world[3] += glm::dvec4(width * (down * column(camera_, 1) + right * column(camera_, 0)), 0);
    ++changes_;
}

void CameraControl::dolly(double factor) {
    if (!(factor > 0)) return;
    // Far beyond these there is nothing to see, and numbers end.
    constexpr double most = 1e6;
    const auto scaled = [&](double length, double at_first) {
        return std::clamp(length * factor, at_first / most, at_first * most);
    };
    if (camera_.projection == CameraDescription::Projection::orthographic) {
        camera_.half_width = scaled(camera_.half_width, start_.half_width);
    } else {
        const DVec3 center = pivot();
        distance_ = scaled(distance_, start_distance_);
        camera_.to_world[3] = glm::dvec4(center - distance_ * column(camera_, 2), 1);
    }
    ++changes_;
}

void CameraControl::fly(double right, double up, double forward) {
    const DVec3 step = -right * column(camera_, 0) + up * column(camera_, 1) + forward * column(camera_, 2);
    camera_.to_world[3] += glm::dvec4(distance_ * step, 0);
    ++changes_;
}

void CameraControl::widen(double factor) {
    if (camera_.projection == CameraDescription::Projection::orthographic) return dolly(factor);
    const double tangent = std::tan(glm::radians(camera_.fov) / 2) * factor;
    camera_.fov = std::clamp(glm::degrees(2 * std::atan(tangent)), 1.0, 170.0);
    ++changes_;
}

void CameraControl::reset() {
    camera_ = start_;
    distance_ = start_distance_;
    ++changes_;
}

std::string camera_xml(const CameraDescription& camera, const FilmDescription& film) {
    const bool orthographic = camera.projection == CameraDescription::Projection::orthographic;
    const bool lens = !orthographic && camera.aperture_radius > 0;
    std::string text = fmt::format("<sensor type=\"{}\">\n", orthographic ? "orthographic"
                                                             : lens       ? "thinlens"
                                                                          : "perspective");
    const auto number = [&](std::string_view name, double value) {
        text += fmt::format("    <float name=\"{}\" value=\"{}\"/>\n", name, value);
    };
    if (!orthographic) {
        number("fov", camera.fov);
        constexpr std::string_view axes[] = {"x", "y", "diagonal", "smaller", "larger"};
        text += fmt::format("    <string name=\"fov_axis\" value=\"{}\"/>\n", axes[static_cast<int>(camera.fov_axis)]);
    }
    if (lens) {
        number("aperture_radius", camera.aperture_radius);
        number("focus_distance", camera.focus_distance);
    } else if (!orthographic && camera.principal_point_offset != DVec2(0)) {
        number("principal_point_offset_x", -camera.principal_point_offset.x);
        number("principal_point_offset_y", -camera.principal_point_offset.y);
    }
    if (camera.near_clip > 0) number("near_clip", camera.near_clip);
    if (std::isfinite(camera.far_clip)) number("far_clip", camera.far_clip);
    text += "    <transform name=\"to_world\">\n        <matrix value=\"";
    for (int row = 0; row < 4; ++row)
        for (int i = 0; i < 4; ++i) {
            const double scale = orthographic && i < 3 ? camera.half_width : 1;
            text += fmt::format("{}{}", row + i > 0 ? " " : "", camera.to_world[i][row] * scale + 0.0);
        }
    text += "\"/>\n    </transform>\n    <film type=\"hdrfilm\">\n";
    const auto whole = [&](std::string_view name, int value) {
        text += fmt::format("        <integer name=\"{}\" value=\"{}\"/>\n", name, value);
    };
    const auto [width, height] = film.full_size();
    whole("width", width);
    whole("height", height);
    if (width != film.width || height != film.height) {
        whole("crop_offset_x", film.crop_x);
        whole("crop_offset_y", film.crop_y);
        whole("crop_width", film.width);
        whole("crop_height", film.height);
    }
    const Filter& filter = film.filter;
    text += fmt::format("        <rfilter type=\"{}\">", filter.name());
    if (filter.kind() == Filter::Kind::tent)
        text += fmt::format("<float name=\"radius\" value=\"{}\"/>", filter.radius());
    if (filter.kind() == Filter::Kind::gaussian)
        text += fmt::format("<float name=\"stddev\" value=\"{}\"/>", filter.radius() / 4);
    return text + "</rfilter>\n    </film>\n</sensor>\n";
}

std::string camera_code(const CameraDescription& camera, const FilmDescription& film) {
    const CameraDescription usual;
    std::string text = "const lightswitch::CameraDescription camera{\n";
    const auto member = [&](std::string_view name, const std::string& value) {
        text += fmt::format("    .{} = {},\n", name, value);
    };
    if (camera.projection == CameraDescription::Projection::orthographic)
        member("projection", "lightswitch::CameraDescription::Projection::orthographic");
    std::string columns;
    for (int i = 0; i < 4; ++i) {
        const auto& c = camera.to_world[i];
        columns += fmt::format("{}\n                 {{{}, {}, {}, {}}}", i > 0 ? "," : "", c[0], c[1], c[2], c[3]);
    }
    member("to_world", "{" + columns + "}");
    member("fov", fmt::format("{}", camera.fov));
    constexpr std::string_view axes[] = {"x", "y", "diagonal", "smaller", "larger"};
    if (camera.fov_axis != usual.fov_axis)
        member("fov_axis",
               fmt::format("lightswitch::CameraDescription::FovAxis::{}", axes[static_cast<int>(camera.fov_axis)]));
    if (camera.half_width != usual.half_width) member("half_width", fmt::format("{}", camera.half_width));
    if (camera.principal_point_offset != DVec2(0))
        member("principal_point_offset",
               fmt::format("{{{}, {}}}", camera.principal_point_offset.x, camera.principal_point_offset.y));
    if (camera.aperture_radius > 0) member("aperture_radius", fmt::format("{}", camera.aperture_radius));
    if (camera.focus_distance != usual.focus_distance)
        member("focus_distance", fmt::format("{}", camera.focus_distance));
    if (camera.near_clip > 0) member("near_clip", fmt::format("{}", camera.near_clip));
    if (std::isfinite(camera.far_clip)) member("far_clip", fmt::format("{}", camera.far_clip));
    text +=
        fmt::format("}};\nconst lightswitch::FilmDescription film{{.width = {}, .height = {}", film.width, film.height);
    const Filter& filter = film.filter;
    if (filter.kind() == Filter::Kind::tent)
        text += fmt::format(", .filter = lightswitch::Filter::tent({}f)", filter.radius());
    if (filter.kind() == Filter::Kind::gaussian)
        text += fmt::format(", .filter = lightswitch::Filter::gaussian({}f)", filter.radius() / 4);
    if (const auto [width, height] = film.full_size(); width != film.width || height != film.height)
        text += fmt::format(", .crop_x = {}, .crop_y = {}, .full_width = {}, .full_height = {}", film.crop_x,
                            film.crop_y, width, height);
    return text + "};\n";
}

}  // namespace lightswitch::program
