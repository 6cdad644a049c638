#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "progress.hpp"
#include "run.hpp"
#include "statistics.hpp"
#include "text.hpp"

#include <lightswitch/film/image_io.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lightswitch::program {
namespace {

/// Everything that can be known to be unwritable before the work begins.
void check_outputs(const RenderOptions& options) {
    if (options.outputs.empty() && options.stats.empty())
        throw Error("nothing would be kept: name a file with --output (.png, .exr, .hdr or .pfm)");
    for (const auto& output : options.outputs) check_writable(output);
    if (options.stats.empty() || options.stats == "-") return;
    check_file_writable(options.stats);
    if (std::find(options.outputs.begin(), options.outputs.end(), options.stats) != options.outputs.end())
        throw Error("--stats and --output name the same file, " + options.stats);
}

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

void warn_about_scene(const LoadedScene& loaded, const AnyMethod& method, const RenderOptions& options) {
    const SceneSummary& summary = loaded.summary;
    const std::string_view name = method_name(method);
    const std::size_t dirac = summary.point_lights + summary.directional_lights;
    if (dirac > 0 && !notes_on(name).sees_dirac_lights)
        print_warning(
            fmt::format("the method {} cannot see the scene's {} point and directional lights: what they light "
                        "stays dark; use {}",
                        name, dirac, PathTracerNee::name));
    const bool dark = std::visit([](const auto& scene) { return scene.statistics().lights == 0; }, loaded.scene);
    if (dark && name != Silhouette::name) print_warning("the scene has no light: the image will be black");
    const bool has_depth = std::visit(
        [](const auto& m) {
            return requires { m.max_depth; };
        },
        method);
    if (!has_depth && (options.max_depth || options.rr_depth))
        print_warning(fmt::format("the method {} has no path length: --max-depth and --rr-depth change nothing", name));
    warn_about_clipping(loaded);
}

void warn_about_values(const RenderCounts& counts, const Image& image) {
    if (counts.non_finite == 0 || counts.first_non_finite.empty()) return;
    const NonFinite& first = counts.first_non_finite.front();
    const auto width = static_cast<std::uint32_t>(image.width());
    print_warning(fmt::format(
        "{} contributions were not finite and count as black; the first in pixel ({}, {}), "
        "iteration {}; to meet it again: --seed {} --spp {}",
        counts.non_finite, first.pixel % width, first.pixel / width, first.iteration, first.seed, first.iteration + 1));
}

Budget budget(const RenderOptions& options, const SceneSummary& summary) {
    Budget result = options.budget;
    if (result.samples == 0 && result.seconds == 0 && result.error == 0) result.samples = summary.samples.value_or(64);
    return result;
}

std::string summary_line(const AnyMethod& method, const Rendered& rendered, const RenderOptions& options) {
    const RenderStatistics& statistics = rendered.statistics;
    std::string text =
        fmt::format("{} ({}): {} samples per pixel in {:.3f} s, {:.2f} Mrays/s", method_name(method),
                    name(method_kind(method)), statistics.iterations, statistics.seconds,
                    statistics.seconds > 0 ? 1e-6 * double(statistics.counts.rays) / statistics.seconds : 0);
    if (std::isfinite(rendered.estimated_error))
        text += fmt::format(", estimated error {:.2g} %", 100 * rendered.estimated_error);
    for (std::size_t i = 0; i < options.outputs.size(); ++i)
        text += (i == 0 ? "; wrote " : ", ") + options.outputs[i].string();
    return text + "\n";
}

}  // namespace

int render(const RenderOptions& options) {
    AnyMethod method = find_method(options.method, "--method");
    check_outputs(options);
    const LoadedScene loaded = load_scene(options.scene);
    warn_about_scene(loaded, method, options);
    set_path_length(method, path_length(loaded.summary, options.max_depth, options.rr_depth));

    const Cancellation cancellation;
    ProgressLine line(!options.quiet);
    const Job job{.budget = budget(options, loaded.summary),
                  .settings = {.seed = options.seed,
                               .threads = options.threads,
                               .sampling = options.sampling,
                               .stop = cancellation.token()},
                  .observer = [&](const Progress& progress, const RenderStatistics& statistics) {
                      line.update(progress, statistics.counts.rays);
                  }};
    const Rendered rendered = std::visit([&](const auto& m) { return run(loaded.scene, m, job); }, method);
    line.clear();

    const RenderStatistics& statistics = rendered.statistics;
    if (statistics.iterations == 0) {
        print_note("cancelled before the first sample was complete: nothing is written");
        return Status::cancelled;
    }
    warn_about_values(statistics.counts, rendered.image);
    for (const auto& output : options.outputs) save(output, rendered.image, {.exposure = options.exposure});
    if (!options.stats.empty()) {
        const std::string json = statistics_json(loaded.scene, method, options, rendered);
        if (options.stats == "-") fmt::print("{}", json);
        else write_file_atomically(options.stats, json);
    }
    // Whoever reads the statistics from standard output wants nothing else there.
    if (!options.quiet)
        fmt::print(options.stats == "-" ? stderr : stdout, "{}", summary_line(method, rendered, options));
    if (!statistics.cancelled) return success;
    print_note(fmt::format("cancelled: the image holds {} samples per pixel", statistics.iterations));
    return Status::cancelled;
}

}  // namespace lightswitch::program
