#include "load.hpp"

#include <fmt/format.h>

#include <vector>

namespace lightswitch::program {
namespace {

void line(std::string_view label, const std::string& text) { fmt::print("{:<12}{}\n", label, text); }

std::string vector_text(const DVec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

std::string bytes_text(double bytes) {
    if (bytes < 1024) return fmt::format("{} bytes", bytes);
    if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", bytes / 1024);
    return fmt::format("{:.1f} MiB", bytes / (1024 * 1024));
}

std::string count_text(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string camera_text(const CameraDescription& camera) {
    constexpr std::string_view axes[] = {"x", "y", "the diagonal", "the smaller side", "the larger side"};
    const bool orthographic = camera.projection == CameraDescription::Projection::orthographic;
    std::string text = orthographic ? fmt::format("orthographic, {:.6g} wide", 2 * camera.half_width)
                                    : fmt::format("{:.6g} degrees along {}", camera.fov,
                                                  axes[static_cast<std::size_t>(camera.fov_axis)]);
    text += fmt::format(", at {}, looking along {}", vector_text(DVec3(camera.to_world[3])),
                        vector_text(DVec3(camera.to_world[2])));
    if (camera.aperture_radius > 0)
        text += fmt::format(", lens radius {:.6g} focused at {:.6g}", camera.aperture_radius, camera.focus_distance);
    if (camera.near_clip > 0 || camera.far_clip < std::numeric_limits<double>::infinity())
        text += fmt::format(", clipped to {:.6g} ... {:.6g}", camera.near_clip, camera.far_clip);
    return text;
}

std::string requests_text(const SceneSummary& summary) {
    std::vector<std::string> wishes;
    if (summary.samples) wishes.push_back(fmt::format("{} samples per pixel", *summary.samples));
    if (summary.max_depth)
        wishes.push_back(*summary.max_depth < 0 ? "unlimited depth"
                                                : fmt::format("depth up to {}", *summary.max_depth));
    if (summary.rr_depth) wishes.push_back(fmt::format("Russian roulette after {} bounces", *summary.rr_depth));
    return wishes.empty() ? "nothing: the program's defaults apply" : fmt::format("{}", fmt::join(wishes, ", "));
}

std::string lights_text(const SceneSummary& summary, const SceneStatistics& statistics) {
    std::vector<std::string> kinds;
    const auto add = [&](std::size_t count, std::string_view one, std::string_view many) {
        if (count > 0) kinds.push_back(count_text(count, one, many));
    };
    add(summary.luminous_meshes, "luminous mesh", "luminous meshes");
    add(summary.luminous_spheres, "luminous sphere", "luminous spheres");
    add(summary.environments, "environment", "environments");
    add(summary.point_lights, "point light", "point lights");
    add(summary.spot_lights, "spot light", "spot lights");
    add(summary.directional_lights, "directional light", "directional lights");
    if (kinds.empty()) return "none: only the method silhouette shows anything";
    return fmt::format("{}; {} to sample, a mesh being one per triangle", fmt::join(kinds, ", "), statistics.lights);
}

}  // namespace

int info(const SceneOptions& options) {
    // Whatever is wrong with the file is said here, so it must be read to its end.
    SceneOptions to_the_end = options;
    to_the_end.lenient = true;
    const LoadedScene loaded = load_scene(to_the_end, false, StandIns::keep);
    const SceneSummary& summary = loaded.summary;
    std::visit(
        [&](const auto& scene) {
            const SceneStatistics& statistics = scene.statistics();
            line("scene", scene.name());
            line("served by", std::string(scene_type_name(loaded.scene)));
            line("film", fmt::format("{} x {} pixels, {} filter of radius {:.6g} pixels", scene.film().width,
                                     scene.film().height, scene.film().filter.name(), scene.film().filter.radius()));
            line("camera", camera_text(summary.camera));
            line("asks for", requests_text(summary));
            line("shapes", fmt::format("{} of {}, {}", count_text(summary.meshes, "mesh", "meshes"),
                                       count_text(statistics.triangles, "triangle", "triangles"),
                                       count_text(statistics.spheres, "sphere", "spheres")));
            if (statistics.instances > 0)
                line("instances",
                     count_text(statistics.instances, "instance of groups of them", "instances of groups of them"));
            if (statistics.robust) line("intersection", "watertight (asked for, or needed by needle-like triangles)");
            if (statistics.degenerate_triangles > 0)
                line("dropped",
                     count_text(statistics.degenerate_triangles, "triangle without area", "triangles without area"));
            if (const auto box = bounds(loaded.scene))
                line("extent", vector_text(box->lower) + " to " + vector_text(box->upper));
            std::vector<std::string> materials;
            for (const auto& [kind, count] : summary.materials) materials.push_back(fmt::format("{} {}", count, kind));
            line("materials", materials.empty() ? "none" : fmt::format("{}", fmt::join(materials, ", ")));
            line("lights", lights_text(summary, statistics));
            if (statistics.tree_lights > 0)
                line("light tree", fmt::format("of {} lights, {}, {:.3g} ms", statistics.tree_lights,
                                               bytes_text(double(statistics.light_tree_bytes)),
                                               statistics.light_tree_build_seconds * 1e3));
            line("memory", fmt::format("Embree {}, scene {}", bytes_text(double(statistics.embree_bytes)),
                                       bytes_text(double(statistics.scene_bytes))));
            line("build", fmt::format("Embree {:.3g} ms, all {:.3g} ms", statistics.embree_build_seconds * 1e3,
                                      statistics.build_seconds * 1e3));
        },
        loaded.scene);
    if (summary.stand_ins.empty()) return success;
    line("problems", fmt::format("{} not supported; with --lenient a render goes on like this:",
                                 count_text(summary.stand_ins.size(), "thing is", "things are")));
    for (const std::string& text : summary.stand_ins) line("", text);
    return success;
}

}  // namespace lightswitch::program
