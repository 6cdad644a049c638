#include "warnings.hpp"

#include "messages.hpp"
#include "method_notes.hpp"

#include <lightswitch/scene/coincident_lights.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lightswitch::program {
namespace {

void warn_about_clipping(const LoadedScene& loaded) {
    const auto box = bounds(loaded.scene);
    if (!box) return;
    const CameraDescription& camera = loaded.summary.camera;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (int corner = 0; corner < 8; ++corner) {
        const DVec3 point(corner & 1 ? box->upper.x : box->lower.x, corner & 2 ? box->upper.y : box->lower.y,
                          corner & 4 ? box->upper.z : box->lower.z);
        const double depth = glm::dot(point - DVec3(camera.to_world[3]), DVec3(camera.to_world[2]));
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    if (farthest <= 0) print_warning("all surfaces lie behind the camera");
    else if (nearest > camera.far_clip || farthest < camera.near_clip)
        print_warning(
            fmt::format("the camera's near_clip {:.6g} and far_clip {:.6g} cut everything away: along its axis "
                        "the surfaces lie from {:.6g} to {:.6g}",
                        camera.near_clip, camera.far_clip, nearest, farthest));
}

/// Where the emitters of a scene come from, in their order.
std::vector<Origin> origins_of_emitters(const LibraryDescription& description) {
    std::vector<Origin> origins;
    for (const auto& source : description.sources) origins.push_back(source.origin);
    const auto add = [&](const auto& shapes) {
        for (const auto& shape : shapes)
            if (shape.emission) origins.push_back(shape.origin);
    };
    add(description.shapes);
    for (const auto& instance : description.instances) add(description.groups[instance.group].shapes);
    return origins;
}

}  // namespace

void warn_about_coincident_lights(const AnyScene& scene, const LibraryDescription& description) {
    const auto found = std::visit([](const auto& built) { return coincident_lights(built); }, scene);
    if (found.empty()) return;
    const std::vector<Origin> origins = origins_of_emitters(description);
    const auto emitters = std::visit([](const auto& built) { return built.emitters().size(); }, scene);
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(found.size(), most); ++i) {
        // A lamp of nothing but triangles without area is no emitter.
        const bool known = origins.size() == emitters;
        print_warning(
            fmt::format("{}about {:.0f} % of this light lies in another surface, so that rounding decides where it is "
                        "seen, and methods differ: move it off by a thousandth of its size",
                        known ? origins[found[i].emitter].prefix() : fmt::format("light {}: ", found[i].emitter + 1),
                        100 * found[i].share));
    }
    if (found.size() > most) print_warning(fmt::format("and so do {} more lights", found.size() - most));
}

void warn_about_scene(const LoadedScene& loaded, std::string_view method) {
    const std::size_t dirac =
        loaded.summary.point_lights + loaded.summary.spot_lights + loaded.summary.directional_lights;
    if (dirac > 0 && cannot_make(method).dirac_light)
        print_warning(
            fmt::format("the method {} cannot see the scene's {} point and directional lights: what they light "
                        "stays dark; use {}",
                        method, dirac, PathTracerNee::name));
    const bool dark = std::visit([](const auto& scene) { return scene.statistics().lights == 0; }, loaded.scene);
    if (dark && method != Silhouette::name) print_warning("the scene has no light: the image will be black");
    warn_about_clipping(loaded);
}

void warn_about_depths(const AnyMethod& method, const std::optional<int>& max_depth,
                       const std::optional<int>& rr_depth) {
    const auto [has_depth, has_roulette] = std::visit(
        [](const auto& m) {
            return std::pair(
                requires { m.max_depth; }, requires { m.rr_depth; });
        },
        method);
    if (!has_depth && (max_depth || rr_depth))
        print_warning(fmt::format("the method {} has no path length: --max-depth and --rr-depth change nothing",
                                  method_name(method)));
    else if (!has_roulette && rr_depth)
        print_warning(
            fmt::format("the method {} has no Russian roulette: --rr-depth changes nothing", method_name(method)));
}

void warn_about_values(const RenderCounts& counts, const Image& image) {
    if (counts.non_finite == 0 || counts.first_non_finite.empty()) return;
    const NonFinite& first = counts.first_non_finite.front();
    const auto width = static_cast<std::uint32_t>(image.width());
    print_warning(fmt::format(
        "{} contributions were not finite and count as black; the first in pixel ({}, {}), "
        "iteration {}; to see how it came about: lightswitch replay, with --pixel {},{} --iteration {} --seed {} and "
        "else the same options",
        counts.non_finite, first.pixel % width, first.pixel / width, first.iteration, first.pixel % width,
        first.pixel / width, first.iteration, first.seed));
}

void warn_about_coverage(const RenderStatistics& statistics) {
    for (const auto& [key, value] : statistics.of_method)
        if (key == "coverage" && value < 0.95)
            print_warning(fmt::format(
                "{:.0f} % of the light rests on few rare paths: its brightness is not known yet, nor is the "
                "error there; more samples tell",
                100 * (1 - value)));
}

void warn_about_black(std::uint64_t samples) {
    print_warning(fmt::format(
        "the image is black after {} samples per pixel, so its error is not known and --error cannot be met; --spp or "
        "--seconds beside it say how long to look",
        samples));
}

}  // namespace lightswitch::program
