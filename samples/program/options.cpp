#include "options.hpp"

#include "method_notes.hpp"
#include "text.hpp"

#include <lightswitch/scene/stock.hpp>

#include <fmt/format.h>

namespace lightswitch::program {
namespace {

constexpr long long unlimited = std::numeric_limits<long long>::max();
constexpr int most_threads = 1024;

/// A value that is given at most once and that `set(text)` checks and stores.
template <class Set>
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type, Set set,
                       const std::string& help) {
    return app.add_option_function<std::string>(name, std::function<void(const std::string&)>(set), help)
        ->type_name(type);
}

/// A value that may be given several times, one at a time.
template <class Set>
void add_values(CLI::App& app, const std::string& name, const std::string& type, Set set, const std::string& help) {
    app.add_option_function<std::vector<std::string>>(
           name,
           [set](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) set(text);
           },
           help)
        ->type_name(type)
        ->allow_extra_args(false);
}

void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const std::string& help) {
    add_values(
        app, "-o,--output", "FILE",
        [&](const std::string& text) {
            if (text.empty()) throw Error("--output: the file has no name");
            outputs.emplace_back(text);
        },
        help);
}

Size parse_size(std::string_view text) {
    const std::size_t x = text.find('x');
    long long width = 0, height = 0;
    try {
        if (x == std::string_view::npos) throw Error("");
        width = parse_integer_option("", text.substr(0, x), 1, unlimited);
        height = parse_integer_option("", text.substr(x + 1), 1, unlimited);
    } catch (const Error&) {
        throw Error(fmt::format("--size: \"{}\" is not WIDTHxHEIGHT in pixels, such as 640x480", text));
    }
    try {
        Image::check_size(width, height);
    } catch (const Error& error) {
        throw Error(fmt::format("--size: {}", error.what()));
    }
    return {static_cast<int>(width), static_cast<int>(height)};
}

Filter parse_filter(std::string_view text) {
    if (text == "box") return Filter::box();
    if (text == "tent") return Filter::tent();
    if (text == "gaussian") return Filter::gaussian();
    throw Error(fmt::format("--filter: there is no filter \"{}\"; known are box, tent, gaussian", text));
}

Sampling parse_sampling(std::string_view text) {
    for (const Sampling sampling : {Sampling::sobol, Sampling::independent})
        if (text == name(sampling)) return sampling;
    throw Error(fmt::format("--sampler: there is no sampler \"{}\"; known are sobol, independent", text));
}

int parse_max_depth(std::string_view text) {
    const auto depth = static_cast<int>(parse_integer_option("--max-depth", text, -1, std::numeric_limits<int>::max()));
    if (depth == 0)
        throw Error(
            "--max-depth: 0 would show nothing; 1 is emission seen directly, 2 adds direct light, -1 is unlimited");
    return depth;
}

float parse_float(std::string_view option, std::string_view text, double least, bool above) {
    const auto value = static_cast<float>(parse_number_option(option, text, least, above));
    if (!is_finite(value) || (above && !(static_cast<double>(value) > least)))
        throw Error(fmt::format("{}: \"{}\" is beyond the range of single precision", option, text));
    return value;
}

}  // namespace

void add_scene_options(CLI::App& app, SceneOptions& options) {
    app.add_option("SCENE", options.scene, "a Mitsuba 3 scene file (ends in .xml), or one of\n" + list(stock::names))
        ->type_name("");
    add_values(
        app, "-D,--define", "NAME=VALUE",
        [&](const std::string& text) {
            const std::size_t equals = text.find('=');
            if (equals == 0 || equals == std::string::npos)
                throw Error(fmt::format("--define: \"{}\" is not NAME=VALUE", text));
            options.defines[text.substr(0, equals)] = text.substr(equals + 1);
        },
        "value of $NAME in the scene file; may be repeated");
    add_value(
        app, "--size", "WxH", [&](const std::string& text) { options.size = parse_size(text); },
        "image size in pixels, instead of the scene's");
    add_value(
        app, "--filter", "NAME", [&](const std::string& text) { options.filter = parse_filter(text); },
        "pixel filter, instead of the scene's: box, tent (radius 1 pixel),\ngaussian (standard deviation 0.5 pixels)");
    app.add_option("--embree", options.build.embree_config,
                   "Embree's device configuration, such as\n\"isa=sse4.2,verbose=1\"")
        ->type_name("CONFIG");
    app.add_flag("--robust", options.build.robust, "watertight edges between triangles (slower)");
}

void add_render(CLI::App& app, RenderOptions& options) {
    add_scene_options(app, options.scene);
    app.add_option("-m,--method", options.method,
                   "rendering method: " + list(known_methods) + "\n(default: path-nee; see \"lightswitch methods\")")
        ->type_name("NAME");
    add_outputs(app, options.outputs,
                "image to write, by extension: .exr, .pfm, .hdr (linear) or .png\n(exposure, sRGB); may be repeated");
    add_value(
        app, "--spp", "N",
        [&](const std::string& text) {
            options.budget.samples =
                static_cast<int>(parse_integer_option("--spp", text, 1, std::numeric_limits<int>::max()));
        },
        "samples per pixel (default: what the scene asks for, or 64)");
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { options.budget.seconds = parse_number_option("--seconds", text, 0, true); },
        "seconds of rendering; one sample per pixel is always made");
    add_value(
        app, "--error", "E",
        [&](const std::string& text) { options.budget.error = parse_number_option("--error", text, 0, true); },
        "estimated root mean square error of a pixel as a fraction of the\nimage's mean (0.01 is 1 %), judged from 16 "
        "samples on");
    add_value(
        app, "--seed", "K",
        [&](const std::string& text) {
            options.seed = static_cast<std::uint64_t>(parse_integer_option("--seed", text, 0, unlimited));
        },
        "another seed gives other noise (default: 0)");
    add_value(
        app, "--threads", "T",
        [&](const std::string& text) {
            options.threads = static_cast<int>(parse_integer_option("--threads", text, 0, most_threads));
        },
        "rendering threads; 0, the default, is one per processor.\nThe image is the same for any number");
    add_value(
        app, "--max-depth", "D", [&](const std::string& text) { options.max_depth = parse_max_depth(text); },
        "path length: 1 is emission seen directly, 2 adds direct light,\n-1 is unlimited (default: the scene's, or "
        "-1)");
    add_value(
        app, "--rr-depth", "D",
        [&](const std::string& text) {
            options.rr_depth =
                static_cast<int>(parse_integer_option("--rr-depth", text, 0, std::numeric_limits<int>::max()));
        },
        "bounces before Russian roulette begins (default: the scene's, or 5)");
    add_value(
        app, "--sampler", "NAME", [&](const std::string& text) { options.sampling = parse_sampling(text); },
        "sobol (default: less noise) or independent");
    add_value(
        app, "--exposure", "STOPS",
        [&](const std::string& text) {
            options.exposure = parse_float("--exposure", text, std::numeric_limits<double>::lowest(), false);
        },
        "brightness of .png: radiance times 2^STOPS (default: 0)");
    app.add_option("--stats", options.stats, "write the render's numbers as JSON; - is standard output")
        ->type_name("FILE.json");
    app.add_flag("-q,--quiet", options.quiet, "no progress and no summary");
    app.footer(
        "Of --spp, --seconds and --error the limit that is met first ends the render. Ctrl-C ends it too:\n"
        "the image so far is written; a second Ctrl-C ends the program at once.\n\n"
        "Exit status: 0 done, 2 an error of which one line on standard error tells, 130 cancelled.\n\n"
        "Examples:\n"
        "  lightswitch render cornell-box --output box.png\n"
        "  lightswitch render room.xml --method path --spp 256 --output room.exr --output room.png\n"
        "  lightswitch render room.xml --error 0.02 --seconds 60 --size 640x360 --output room.png\n"
        "  lightswitch render cornell-box --spp 16 --stats - --quiet\n\n"
        "Keys of --stats: method, kind, scene, scene_type, width, height, samples_per_pixel, seconds (rendering\n"
        "only), rays, shadow_rays, rays_per_second, samples_per_second, threads, seed, sampler, max_depth,\n"
        "rr_depth, mean, estimated_error, non_finite, first_non_finite, splats, paths, triangles, spheres, lights,\n"
        "build_seconds, embree_bytes, scene_bytes, camera, embree_version, lightswitch_version, cancelled.");
}

void add_compare(CLI::App& app, CompareOptions& options) {
    app.add_option("IMAGES", options.images,
                   "two or more images of one size: .exr, .hdr or .pfm. The last one\nis the reference, unless "
                   "--reference names it")
        ->type_name("");
    add_value(
        app, "-r,--reference", "FILE", [&](const std::string& text) { options.reference = text; },
        "what all images are compared with");
    add_outputs(
        app, options.outputs,
        ".png: the first image less the reference in false colours, red\nwhere it is brighter, with a legend; .exr or "
        ".pfm: the\ndifference itself; may be repeated");
    add_value(
        app, "--report", "FILE.html", [&](const std::string& text) { options.report = text; },
        "a page to look at them: slider, flip, exposure, zoom, difference\nand FLIP maps, table of metrics. Needs no "
        "network");
    app.add_flag("--absolute", options.absolute, "write the magnitude of the difference instead");
    add_value(
        app, "--scale", "S", [&](const std::string& text) { options.scale = parse_float("--scale", text, 0, true); },
        "difference at the ends of the colour map (default: the 99th\npercentile)");
    app.footer(
        "Prints the means, their ratio, MSE, RMSE, relMSE (squared error over squared reference + 0.01), MAPE, SMAPE\n"
        "and the largest difference. Images of different scenes, cameras or sizes are refused.\n\n"
        "Examples:\n"
        "  lightswitch compare bdpt.exr path.exr --output difference.png --scale 0.1\n"
        "  lightswitch compare a.exr b.exr c.exr --reference truth.exr --report report.html");
}

void add_verify(CLI::App& app, VerifyCommand& command) {
    add_scene_options(app, command.scene);
    const auto add_names = [&](const std::string& name, const std::string& type, std::vector<std::string>& names,
                               const std::string& help) { return app.add_option(name, names, help)->type_name(type); };
    add_names("-m,--methods", "NAMES", command.methods,
              "what to verify, separated by commas (default: all that have an\nexpected image, but the reference)")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("-r,--reference", command.reference,
                   "what to verify them against (default: path; path-nee for scenes\nwith point or directional lights)")
        ->type_name("NAME");
    add_names("--images", "FILES", command.images,
              "instead of methods: independent renders (different seeds) of the\nscene by any renderer, such as "
              "'mine/*.exr'");
    add_names("--against", "FILES", command.against, "with --images: the same by another renderer, instead of a scene");
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { command.options.seconds = parse_number_option("--seconds", text, 0, true); },
        "of rendering, in all, but at least three images of each\n(default: 60). It ends as soon as every question is "
        "decided");
    add_value(
        app, "--confidence", "C",
        [&](const std::string& text) {
            command.options.confidence = parse_number_option("--confidence", text, 0, true);
            if (command.options.confidence >= 1) throw Error("--confidence: it must be below 1, such as 0.999");
        },
        "a right method is called wrong with a probability of at most\n1 - C (default: 0.999); of files, if none of "
        "their samples is much\nbrighter than what they show");
    add_value(
        app, "--tolerance", "T",
        [&](const std::string& text) {
            command.options.tolerance = parse_number_option("--tolerance", text, 0, false);
        },
        "smallest bias of the image's mean that matters, as a fraction\n(default: 0.01). 0: look for any, until the "
        "time is over");
    add_value(
        app, "--lengths", "N",
        [&](const std::string& text) {
            command.options.path_lengths = static_cast<int>(parse_integer_option("--lengths", text, 0, 64));
        },
        "path lengths that are compared one by one (default: 5; longer\nones together)");
    add_value(
        app, "--max-depth", "D", [&](const std::string& text) { command.max_depth = parse_max_depth(text); },
        "path length of the image, as for render");
    add_value(
        app, "--seed", "K",
        [&](const std::string& text) {
            command.options.seed = static_cast<std::uint64_t>(parse_integer_option("--seed", text, 0, unlimited));
        },
        "another seed draws other samples (default: 0)");
    add_value(
        app, "--threads", "T",
        [&](const std::string& text) {
            command.options.threads = static_cast<int>(parse_integer_option("--threads", text, 0, most_threads));
        },
        "rendering threads; 0, the default, is one per processor");
    add_value(
        app, "--report", "FILE.html", [&](const std::string& text) { command.report = text; },
        "a page with images, maps of differences and p-values, error over\ntime and all numbers. Needs no network");
    app.add_option("--json", command.json, "write the verdicts as JSON; - is standard output")->type_name("FILE.json");
    app.add_flag("-q,--quiet", command.quiet, "no progress and no text");
    app.footer(
        "Renders independent images by each method and compares them with the reference's by Welch's t-test: all\n"
        "tiles from the whole image down to a few pixels, all path lengths together and one by one. Scenes are\n"
        "rendered with at most 128 pixels a side, unless --size says more: tiles need no more.\n\n"
        "Verdicts: agrees (a bias beyond the tolerance is ruled out), disagrees (the expected images differ: where,\n"
        "by how much, and from which path length on; or values are not finite; or pixels share random numbers),\n"
        "undecided (more time is needed, or the image rests on so few rare bright paths that nothing can be said).\n\n"
        "Exit status: 0 all agree, 1 one disagrees, 3 undecided, 2 an error of which one line on standard error\n"
        "tells, 130 cancelled.\n\n"
        "Examples:\n"
        "  lightswitch verify cornell-box --methods path-nee --report verdict.html\n"
        "  lightswitch verify room.xml --images 'mine/*.exr' --reference path-nee --tolerance 0.005\n"
        "  lightswitch verify --images 'a/*.exr' --against 'b/*.exr' --json verdict.json");
}

}  // namespace lightswitch::program
