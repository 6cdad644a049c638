#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "method_options.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "warnings.hpp"

#include <lightswitch/compiled.hpp>
#include <lightswitch/film/image_io.hpp>
#include <lightswitch/report/sweep_report.hpp>
#include <lightswitch/sweep/sweep.hpp>
#include <lightswitch/verify/conclusion.hpp>

#include <fmt/format.h>

#include <sstream>

namespace lightswitch::program {
namespace {

std::vector<AnyMethod> chosen_methods(const SweepCommand& command, const SceneSummary& summary) {
    std::vector<AnyMethod> methods;
    const auto is_there = [&](std::string_view name) {
        return std::any_of(methods.begin(), methods.end(), [&](const auto& m) { return method_name(m) == name; });
    };
    const auto add_all = [&] {
        for_each_method([&](const auto& m) {
            if (m.kind != Kind::heuristic && !is_there(m.name)) methods.emplace_back(m);
        });
    };
    for (const std::string& wanted : command.methods) {
        if (wanted == "all") {
            add_all();
            continue;
        }
        const AnyMethod method = find_method(wanted, "--methods", "; all are all of them but heuristic ones");
        if (method_kind(method) == Kind::heuristic)
            throw Error(
                fmt::format("--methods: {} is heuristic: it makes a picture of the scene, and has no error", wanted));
        if (!is_there(wanted)) methods.push_back(method);
    }
    if (command.methods.empty()) add_all();
    set_options(methods, command.of_methods, std::size_t(summary.size.width) * std::size_t(summary.size.height));
    for (AnyMethod& method : methods) set_path_length(method, path_length(summary, command.max_depth, {}));
    return methods;
}

/// Reads the reference, whose size is that of the images, and the scene.
LoadedScene load(const SweepCommand& command, std::optional<Image>& reference) {
    SceneOptions options = command.scene;
    if (!command.reference.empty()) {
        reference = load_image(command.reference);
        const Size size{reference->width(), reference->height()};
        if (options.size && (options.size->width != size.width || options.size->height != size.height))
            throw Error(fmt::format("--size {}x{}: the reference has {}x{} pixels, and so must the images",
                                    options.size->width, options.size->height, size.width, size.height));
        options.size = size;
    } else if (!options.size) {
        options.shrink_to = 128;
    }
    return load_scene(options, command.quiet);
}

/// What methods cannot show is part of their errors.
void print_missing(const Sweep& sweep) {
    for (const SweptMethod& m : sweep.methods)
        if ((m.missing - sweep.reference.missing).any())
            print_note(fmt::format("{} cannot show {}: that is part of its error", m.name, describe(m.missing)));
}

}  // namespace

int sweep(const SweepCommand& command) {
    Outputs outputs;
    outputs.add_file("--report", command.report);
    outputs.add_text("--csv", command.csv);
    const Cancellation cancellation;
    std::optional<Image> reference;
    const LoadedScene loaded = load(command, reference);
    outputs.refuse_inputs(loaded.summary.files);
    outputs.refuse_inputs({command.reference});
    std::vector<Contender> contenders;
    for (const AnyMethod& method : chosen_methods(command, loaded.summary))
        contenders.push_back(contender(loaded.scene, method));
    warn_about_scene(loaded, "");

    ProgressLine line(!command.quiet);
    SweepOptions options = command.options;
    options.stop = cancellation.token();
    options.observer = [&](const SweepProgress& progress) {
        line.update(progress.seconds,
                    fmt::format("{:3.0f} %  {}, about {} left", 100 * progress.fraction, progress.what,
                                lightswitch::detail::rounded_duration(progress.seconds_left)));
    };
    const Sweep result = reference ? lightswitch::sweep(contenders, std::move(*reference), options)
                                   : lightswitch::sweep(contenders, options);
    line.clear();
    if (result.methods.empty()) {
        print_note("cancelled before anything was measured: nothing is written");
        return Status::cancelled;
    }
    if (!command.quiet) {
        std::ostringstream text;
        text << result;
        fmt::print(command.csv == "-" ? stderr : stdout, "{}", text.str());
        print_missing(result);
    }
    if (!command.csv.empty()) write_text(command.csv, sweep_csv(result));
    if (!command.report.empty())
        write_report(command.report, sweep_report(command.scene.scene + ": error over time", result));
    if (!result.stopped) return success;
    print_note(fmt::format("cancelled: {} of {} seeds are whole", result.seeds, options.seeds));
    return Status::cancelled;
}

}  // namespace lightswitch::program
