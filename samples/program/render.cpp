#include "cancellation.hpp"
#include "denoising.hpp"
#include "keeping.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "method_options.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "run.hpp"
#include "statistics.hpp"
#include "warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lightswitch::program {
namespace {

Outputs checked_outputs(const RenderOptions& options) {
    if (options.outputs.empty() && options.stats.empty() && options.checkpoint.empty())
        throw Error("nothing would be kept: name a file with --output (.png, .exr, .hdr or .pfm)");
    if (options.write_every > 0 && options.outputs.empty())
        throw Error("--write-every: there is no image to write: name one with --output");
    if (!options.denoise.empty() && (!options.checkpoint.empty() || options.write_every > 0))
        throw Error("--denoise: of a denoised render neither states nor images are written meanwhile: leave out " +
                    std::string(options.checkpoint.empty() ? "--write-every" : "--checkpoint"));
    Outputs outputs;
    for (const auto& output : options.outputs) outputs.add_image("--output", output);
    outputs.add_text("--stats", options.stats);
    outputs.add_file("--checkpoint", options.checkpoint);
    if (!options.extra.empty() && std::none_of(options.outputs.begin(), options.outputs.end(), can_hold_layers))
        throw Error("--aov: only .exr files hold layers: name one with --output");
    return outputs;
}

Budget budget(const RenderOptions& options, const SceneSummary& summary) {
    Budget result = options.budget;
    if (result.samples == 0 && result.seconds == 0 && result.error == 0) result.samples = summary.samples.value_or(64);
    return result;
}

/// The extra outputs, if any, with as many samples as the image, within limits: with fewer they would be noisy guides,
/// and more show nothing new.
std::vector<Layer> render_extra(const RenderOptions& options, const LoadedScene& loaded, const Budget& limits,
                                const Cancellation& cancellation, ProgressLine& line) {
    std::vector<ExtraOutput> wanted = options.extra;
    if (!options.denoise.empty())
        for (const char* guide : {"albedo", "normal"})
            if (std::none_of(wanted.begin(), wanted.end(), [&](const auto& o) { return output_name(o) == guide; }))
                wanted.push_back(output_by_name(guide));
    if (wanted.empty()) return {};
    const int samples = limits.samples == 0 ? 64 : std::clamp(limits.samples, 16, 64);
    const auto tell = [&](const Progress& progress) {
        line.update(progress.seconds,
                    fmt::format("{:3.0f} %  extra outputs, before the image", 100 * progress.fraction));
    };
    std::vector<Layer> layers = run_outputs(loaded.scene, wanted, samples,
                                            {.seed = options.seed,
                                             .threads = options.threads,
                                             .sampling = options.sampling,
                                             .stop = cancellation.token(),
                                             .observer = tell});
    line.restart();
    return layers;
}

/// Stops for the pictures among the outputs; nothing when there are none.
std::optional<float> exposure_of_pictures(const RenderOptions& options, const SceneSummary& summary,
                                          const Image& image) {
    if (std::none_of(options.outputs.begin(), options.outputs.end(), is_picture)) return {};
    if (options.exposure) return *options.exposure;
    if (summary.exposure && !options.auto_exposure) return *summary.exposure;
    return auto_exposure(image);
}

std::string summary_line(const AnyMethod& method, const Rendered& rendered, const RenderOptions& options,
                         const Denoising& denoising, const std::optional<float>& exposure) {
    const RenderStatistics& statistics = rendered.statistics;
    std::string text =
        fmt::format("{} ({}): {} samples per pixel in {:.3f} s, {:.2f} Mrays/s", method_name(method),
                    name(method_kind(method)), statistics.iterations, statistics.seconds,
                    statistics.seconds > 0 ? 1e-6 * double(statistics.counts.rays) / statistics.seconds : 0);
    if (std::isfinite(rendered.estimated_error))
        text += fmt::format(", estimated error {:.2g} %", 100 * rendered.estimated_error);
    if (!denoising.denoiser.empty())
        text += fmt::format(" (of the samples {:.2g} %), denoised by {}, {:.0f} % of the detail from samples",
                            100 * denoising.mixed.relative_error_of_samples, denoising.denoiser,
                            100 * denoising.mixed.detail_from_samples);
    if (rendered.sharing.ranks > 1)
        text += fmt::format(", {} processes, which waited {:.2g} % of the time", rendered.sharing.ranks,
                            100 * rendered.sharing.most_seconds_waited / statistics.seconds);
    if (exposure) text += fmt::format(", exposure {:.4g} stops", *exposure);
    for (std::size_t i = 0; i < options.outputs.size(); ++i)
        text += (i == 0 ? "; wrote " : ", ") + options.outputs[i].string();
    return text + "\n";
}

/// What a rank of a job that is not the first does of a command: its share of the iterations, and nothing else.
RenderOptions of_this_rank(RenderOptions options) {
    if (is_root()) return options;
    options.outputs.clear();
    options.extra.clear();
    options.stats.clear();
    options.checkpoint.clear();
    options.quiet = true;
    return options;
}

void check_for_ranks(const RenderOptions& options, const AnyMethod& method) {
    if (rank_count() == 1) return;
    if (!options.denoise.empty())
        throw Error("--denoise: the halves of a render that is denoised are not shared by processes of an MPI job");
    if (!options.checkpoint.empty() && has_history(method))
        throw Error(
            fmt::format("--checkpoint: each iteration of {} goes on from the one before, in every process of the job; "
                        "leave it out, or render with --checkpoint and a --seed of its own per process and merge",
                        method_name(method)));
}

/// In the rounds of a job: not longer than half of what is to be done from time to time.
double longest_round(const RenderOptions& options) {
    double longest = 10;
    if (!options.checkpoint.empty()) longest = std::min(longest, options.every / 2);
    if (options.write_every > 0) longest = std::min(longest, options.write_every / 2);
    return longest;
}

}  // namespace

int render(const RenderOptions& asked) {
    AnyMethod method = find_method(asked.method, "--method");
    const Outputs outputs = checked_outputs(asked);
    check_for_ranks(asked, method);
    const RenderOptions options = of_this_rank(asked);
    const LoadedScene loaded = load_scene(options.scene, options.quiet);
    outputs.refuse_inputs(loaded.summary.files);
    const Size size = loaded.summary.size;
    set_options({&method, 1}, options.of_method, std::size_t(size.width) * std::size_t(size.height));
    warn_about_scene(loaded, method_name(method));
    warn_about_depths(method, options.max_depth, options.rr_depth);
    set_path_length(method, path_length(loaded.summary, options.max_depth, options.rr_depth));

    Budget limits = budget(options, loaded.summary);
    const Span span = span_of(asked, limits, method);
    Checkpoint checkpoint(options, span);
    Denoising denoising;
    if (!options.denoise.empty()) denoising.denoiser = choose_denoiser(options.denoise);
    const bool denoised = !denoising.denoiser.empty();

    Now image_time(options.write_every);
    Cancellation cancellation;
    ProgressLine line(!options.quiet);
    const bool error_alone = limits.samples == 0 && limits.seconds == 0;
    bool stays_black = false;
    std::vector<Layer> layers = render_extra(options, loaded, limits, cancellation, line);
    limits.samples = span.samples;
    const auto write_images = [&](Image image) {
        keep_stand_ins(image, loaded.summary);
        const auto exposure = exposure_of_pictures(options, loaded.summary, image);
        for (const auto& output : options.outputs)
            write_image(output, image, {.exposure = exposure.value_or(0)}, layers);
        return exposure;
    };
    const auto write_meanwhile = [&](Image image) {
        try {
            write_images(std::move(image));
        } catch (const Error& error) {  // which may be gone the next time; at the end it is one
            print_warning(fmt::format("--write-every: {}", error.what()));
        }
        image_time.done();
    };
    Job job{.budget = limits,
            .settings = {.seed = options.seed,
                         .threads = options.threads,
                         .sampling = options.sampling,
                         .stop = cancellation.token(),
                         .first_iteration = span.begin},
            .progress = [&](const Progress& progress,
                            std::uint64_t rays) { line.update(progress, rays - checkpoint.rays_before()); },
            .observer =
                [&](const Progress& progress, const Halt& halt) {
                    stays_black = error_alone && progress.iterations >= most_black_samples &&
                                  std::isinf(progress.film.relative_error());
                    if (stays_black) cancellation.stop();
                    checkpoint.observe(halt);
                    if (image_time.due()) write_meanwhile(halt.image());
                },
            .due = [&] { return checkpoint.due() || image_time.due(); },
            .longest_round = longest_round(asked),
            .from = checkpoint.take(),
            .from_where = detail::file_origin(options.checkpoint),
            .content = options.checkpoint.empty() ? "" : content_of(options.scene, loaded.summary),
            .end = [&](const Halt& halt) { checkpoint.end(halt); }};
    meet();
    Rendered rendered = denoised ? run_denoised(loaded.scene, method, job, layers, denoising)
                                 : run(loaded.scene, method, std::move(job));
    line.clear();

    if (!is_root()) return success;
    RenderStatistics& statistics = rendered.statistics;
    if (stays_black) {
        statistics.cancelled = false;  // by nobody
        warn_about_black(statistics.iterations);
    }
    if (statistics.iterations == 0) {
        print_note("cancelled before the first sample was complete: nothing is written");
        return Status::cancelled;
    }
    warn_about_values(statistics.counts, rendered.image);
    warn_about_coverage(statistics);
    if (denoised) {
        warn_about_denoising(denoising, statistics.iterations);
        // Guides that nobody asked for are no layers.
        std::erase_if(layers, [&](const Layer& layer) {
            return std::none_of(options.extra.begin(), options.extra.end(),
                                [&](const auto& o) { return output_name(o) == layer.name; });
        });
        add_denoising_layers(layers, denoising);
    }
    const auto exposure = write_images(rendered.image);
    checkpoint.complain();
    if (!options.stats.empty())
        write_text(options.stats, statistics_json(loaded, method, options, rendered, denoising));
    // Whoever reads the statistics from standard output wants nothing else there.
    if (!options.quiet)
        fmt::print(options.stats == "-" ? stderr : stdout, "{}",
                   summary_line(method, rendered, options, denoising, exposure));
    if (!statistics.cancelled) return success;
    print_note(fmt::format("cancelled: the image holds {} samples per pixel", statistics.iterations));
    return Status::cancelled;
}

}  // namespace lightswitch::program
