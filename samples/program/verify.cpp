#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "method_options.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "run.hpp"
#include "scene_files.hpp"
#include "text.hpp"

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/report/verdict_report.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/verify/verify.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <glob.h>
#include <iostream>
#include <sstream>

namespace lightswitch::program {
namespace {

using Json = nlohmann::ordered_json;

/// The files that a pattern such as 'mine/*.exr' names, in order.
std::vector<std::string> expand(const std::vector<std::string>& patterns, std::string_view option) {
    std::vector<std::string> files;
    for (const std::string& pattern : patterns) {
        std::error_code ignored;
        if (std::filesystem::exists(pattern, ignored)) {
            files.push_back(pattern);
            continue;
        }
        glob_t found{};
        const int status = glob(pattern.c_str(), 0, nullptr, &found);
        for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
        globfree(&found);
        const bool scene = is_scene_file(pattern) ||
                           std::find(stock::names.begin(), stock::names.end(), pattern) != stock::names.end();
        if (status != 0)
            throw Error(fmt::format("{}: no file matches \"{}\"{}", option, pattern,
                                    scene ? "; name the scene before the files" : ""));
    }
    return files;
}

/// Independent renders of one scene. What makes them useless as such is an error that names the files.
std::vector<Image> load_replicas(const std::vector<std::string>& patterns, std::string_view option,
                                 std::vector<std::filesystem::path>& read) {
    const std::vector<std::string> files = expand(patterns, option);
    read.insert(read.end(), files.begin(), files.end());
    if (files.size() < 3)
        throw Error(fmt::format(
            "{}: {} file{} given; at least 3 independent renders (different seeds) are needed to know their "
            "noise, and 8 or more to see much",
            option, files.size(), files.size() == 1 ? " is" : "s are"));
    std::vector<Image> images;
    for (const std::string& file : files) {
        images.push_back(load_image(file));
        const Image& image = images.back();
        if (const auto at = image.first_not_finite())
            throw Error(fmt::format("{}: pixel ({}, {}) is not finite: nothing can be said of its mean", file,
                                    at->first, at->second));
        for (std::size_t i = 0; i + 1 < images.size(); ++i) {
            try {
                refuse_unless_comparable(images[i], image);
            } catch (const Error& error) {
                throw Error(fmt::format("{} and {}: {}", files[i], file, error.what()));
            }
            if (images[i].pixels() == image.pixels())
                throw Error(fmt::format("{} and {} are the same image: independent renders need different seeds",
                                        files[i], file));
        }
    }
    return images;
}

/// What a set of files is called.
std::string title_of(const std::vector<std::string>& patterns) {
    return patterns.size() == 1 ? patterns[0] : fmt::format("{} and {} more", patterns[0], patterns.size() - 1);
}

/// What stands on both sides, and what keeps it alive.
struct Contest {
    std::optional<LoadedScene> loaded;
    std::string title;
    std::vector<std::filesystem::path> files;  // that were read
    std::vector<Estimator> methods;
    std::optional<Estimator> reference;
};

PathClasses possible(const AnyScene& scene) {
    return std::visit([](const auto& s) { return possible_paths(s); }, scene);
}

/// The simplest reference that misses nothing, or that can leave out what the methods miss. Of files nothing is known:
/// most renderers' path tracers sample lights.
std::string chosen_reference(const VerifyCommand& command, const PathClasses& possible) {
    if (!command.reference.empty()) return command.reference;
    if (!command.images.empty() && possible.dirac_light) return std::string(PathTracerNee::name);
    const bool some_cannot = std::any_of(
        command.methods.begin(), command.methods.end(),
        [&](const std::string& method) { return ((cannot_make(method) - Bdpt::cannot_make) & possible).any(); });
    if (possible.dirac_caustic || some_cannot) return std::string(Bdpt::name);
    // Sampling lights makes far less noise than meeting them by chance; where it is itself in question, chance judges.
    const bool in_question =
        std::find(command.methods.begin(), command.methods.end(), PathTracerNee::name) != command.methods.end();
    return std::string(in_question && !possible.dirac_light ? PathTracer::name : PathTracerNee::name);
}

/// The methods that are asked for, or all that make what the reference makes or can leave out, and more than nothing.
std::vector<std::string> chosen_methods(const VerifyCommand& command, const PathClasses& possible,
                                        const std::string& reference) {
    if (!command.methods.empty()) return command.methods;
    const PathClasses can_leave_out = reference == Bdpt::name ? Bdpt::can_leave_out : PathClasses{};
    std::vector<std::string> names;
    for_each_method([&](const auto& m) {
        const PathClasses missing = cannot_make(m.name) & possible;
        const bool comparable = !(missing - cannot_make(reference) - can_leave_out).any() && !missing.dirac_light;
        if (m.kind != Kind::heuristic && m.name != reference && comparable) names.emplace_back(m.name);
    });
    if (names.empty())  // then at least with itself, which tests its noise
        names.push_back(reference);
    return names;
}

void load(Contest& contest, const VerifyCommand& command, const std::optional<Size>& images) {
    SceneOptions options = command.scene;
    if (images) {
        if (options.size && (options.size->width != images->width || options.size->height != images->height))
            throw Error(fmt::format("--size {}x{}: the images have {}x{} pixels, and so must the reference",
                                    options.size->width, options.size->height, images->width, images->height));
        options.size = images;
    } else if (!options.size) {
        options.shrink_to = 128;  // tiles say as much; and the time goes into samples
    }
    contest.loaded.emplace(load_scene(options, command.quiet));
}

Contest make_contest(const VerifyCommand& command, const std::stop_token& stop) {
    Contest contest;
    std::optional<Size> size;
    const bool from_files = !command.images.empty();
    std::vector<Image> images;
    if (from_files) {
        images = load_replicas(command.images, "--images", contest.files);
        size = {images[0].width(), images[0].height()};
        if (!command.methods.empty()) throw Error("--images are what is verified: leave out --methods");
        contest.methods.push_back(given(images, title_of(command.images)));
    }
    if (!command.against.empty()) {
        if (!from_files) throw Error("--against compares files: name the others with --images");
        if (!command.scene.scene.empty() || !command.reference.empty())
            throw Error("--against is the reference: leave out the scene and --reference");
        set_options({}, command.of_methods, 0);
        std::vector<Image> others = load_replicas(command.against, "--against", contest.files);
        for (const Image& image : images)
            for (const Image& other : others) {
                refuse_unless_comparable(image, other);
                if (image.pixels() == other.pixels())
                    throw Error("--images and --against share an image: both sides must be independent");
            }
        contest.reference = given(std::move(others), title_of(command.against));
        contest.title = title_of(command.images) + " against " + title_of(command.against);
        return contest;
    }
    if (command.scene.scene.empty())
        throw Error(fmt::format(
            "verify: name a scene (a file that ends in {}, or one of {}), or files with --images and --against",
            scene_endings(), list(stock::names)));
    load(contest, command, size);
    const SceneSummary& summary = contest.loaded->summary;
    contest.files.insert(contest.files.end(), summary.files.begin(), summary.files.end());
    contest.title = command.scene.scene;

    const PathClasses possible_here = possible(contest.loaded->scene);
    const std::string reference = chosen_reference(command, possible_here);
    const PathLength length = path_length(summary, command.max_depth, {});
    std::vector<AnyMethod> methods;
    const auto add = [&](const std::string& wanted, std::string_view option) {
        const bool file = wanted.find('.') != std::string::npos;
        methods.push_back(find_method(wanted, option, file ? "; files are named with --images and --against" : ""));
        set_path_length(methods.back(), length);
    };
    add(reference, "--reference");
    if (!from_files)
        for (const std::string& wanted : chosen_methods(command, possible_here, reference)) add(wanted, "--methods");
    set_options(methods, command.of_methods, std::size_t(summary.size.width) * std::size_t(summary.size.height));

    const Settings settings{.threads = command.options.threads, .stop = stop};
    for (const AnyMethod& method : methods)
        contest.methods.push_back(make_estimator(contest.loaded->scene, method, settings));
    // The reference came first; or second, after the files.
    const auto first = contest.methods.begin() + (from_files ? 1 : 0);
    contest.reference = *first;
    contest.methods.erase(first);
    if (from_files) {  // the lamps are known, and perhaps how many samples their light is averaged over
        const double samples = metadata_number(images[0], "samples");
        if (samples >= 1) contest.methods[0].brightest = contest.reference->brightest / static_cast<float>(samples);
    }
    return contest;
}

Json intervals(const std::array<Interval, 3>& of) {
    Json json = Json::array();
    for (const Interval& interval : of) json.push_back({interval.low, interval.high});
    return json;
}

Json part_json(const Verdict::Part& part) {
    return {{"length", part.length},
            {"and_longer", part.and_longer},
            {"disagrees", part.disagrees},
            {"p", part.p},
            {"bias", part.bias},
            {"bias_interval", intervals(part.interval)},
            {"share", part.share},
            {"worst",
             {{"columns", {part.worst.x0, part.worst.x1}},
              {"rows", {part.worst.y0, part.worst.y1}},
              {"channel", detail::channel_names[static_cast<std::size_t>(part.worst_channel)]},
              {"value", part.ours},
              {"reference", part.theirs}}}};
}

Json classes_json(const PathClasses& classes) { return classes.any() ? Json(describe(classes)) : Json(); }

Json verdict_json(const Verdict& v) {
    Json parts = Json::array(), tiles = Json::array();
    for (const Verdict::Part& part : v.parts) parts.push_back(part_json(part));
    for (int y = 0; y < v.p_values.height(); ++y) {
        Json row = Json::array();
        for (int x = 0; x < v.p_values.width(); ++x) row.push_back(min_component(v.p_values(x, y)));
        tiles.push_back(std::move(row));
    }
    return {{"method", v.method},
            {"reference", v.reference},
            {"verdict", name(v.answer)},
            {"reason", v.reason},
            {"first_wrong_length", v.first_wrong_length == 0 ? Json() : Json(v.first_wrong_length)},
            {"correlated_pixels", v.correlated_pixels},
            {"left_out", classes_json(v.left_out)},
            {"method_lacks", classes_json(v.method_lacks)},
            {"reference_lacks", classes_json(v.reference_lacks)},
            {"confidence", v.confidence},
            {"tolerance", v.tolerance},
            {"images", v.images},
            {"reference_images", v.reference_images},
            {"samples_per_pixel", v.samples},
            {"reference_samples_per_pixel", v.reference_samples},
            {"seconds", v.seconds},
            {"reference_seconds", v.reference_seconds},
            {"seconds_to_decide", v.seconds_to_decide > 0 ? Json(v.seconds_to_decide) : Json()},
            {"rare_events", v.events},
            {"non_finite", v.non_finite},
            {"reference_non_finite", v.reference_non_finite},
            {"parts", std::move(parts)},
            {"p_values", std::move(tiles)}};
}

int status_of(const std::vector<Verdict>& verdicts) {
    const auto any = [&](Verdict::Answer answer) {
        return std::any_of(verdicts.begin(), verdicts.end(), [&](const Verdict& v) { return v.answer == answer; });
    };
    return any(Verdict::Answer::disagrees)   ? Status::disagrees
           : any(Verdict::Answer::undecided) ? Status::undecided
                                             : success;
}

}  // namespace

int verify(const VerifyCommand& command) {
    Outputs outputs;
    outputs.add_file("--report", command.report);
    outputs.add_text("--json", command.json);
    const Cancellation cancellation;
    const Contest contest = make_contest(command, cancellation.token());
    outputs.refuse_inputs(contest.files);

    ProgressLine line(!command.quiet);
    VerifyOptions options = command.options;
    options.stop = cancellation.token();
    options.observer = [&](const VerifyProgress& progress) {
        const std::string forecast =
            progress.seconds_to_decide > 0
                ? fmt::format("; decided after about {}", detail::rounded_duration(progress.seconds_to_decide))
                : "";
        line.update(progress.seconds, fmt::format("{:.0f} s of at most {:.0f} s: {}, {} images{}", progress.seconds,
                                                  options.seconds, progress.method, progress.images, forecast));
    };
    const std::vector<Verdict> verdicts = Verification(*contest.reference, contest.methods, options).run();
    line.clear();

    std::ostringstream text;
    for (const Verdict& v : verdicts) text << v;
    if (!command.quiet) fmt::print(command.json == "-" ? stderr : stdout, "{}", text.str());
    if (!command.json.empty()) {
        Json json{{"scene", contest.title}, {"verdicts", Json::array()}};
        for (const Verdict& v : verdicts) json["verdicts"].push_back(verdict_json(v));
        write_text(command.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    }
    const bool drawn = std::none_of(verdicts.begin(), verdicts.end(),
                                    [](const Verdict& v) { return v.image.empty() || v.reference_image.empty(); });
    if (!command.report.empty() && drawn) write_report(command.report, verdict_report(contest.title, verdicts));
    if (!cancellation.token().stop_requested()) return status_of(verdicts);
    print_note(drawn ? "cancelled: the verdict is on the images so far"
                     : "cancelled before there was an image: no report is written");
    return Status::cancelled;
}

}  // namespace lightswitch::program
