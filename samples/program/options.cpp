#include "options.hpp"

#include "denoising.hpp"
#include "method_notes.hpp"
#include "scene_files.hpp"
#include "values.hpp"

#include <lightswitch/scene/stock.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lightswitch::program {
namespace {

Size parse_size(std::string_view option, std::string_view text) {
    const std::size_t x = text.find('x');
    long long width = 0, height = 0;
    try {
        if (x == std::string_view::npos) throw Error("");
        width = parse_integer_option("", text.substr(0, x), 1, unlimited);
        height = parse_integer_option("", text.substr(x + 1), 1, unlimited);
    } catch (const Error&) {
        throw Error(fmt::format("{}: \"{}\" is not WIDTHxHEIGHT in pixels, such as 640x480", option, text));
    }
    try {
        Image::check_size(width, height);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", option, error.what()));
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

/// Names separated by commas; one that is there already is passed over.
void add_extra_outputs(std::vector<ExtraOutput>& outputs, std::string_view text) {
    static const std::vector<std::string_view> known = [] {
        std::vector<std::string_view> names;
        for (const ExtraOutput& output : extra_outputs()) names.push_back(output_name(output));
        return names;
    }();
    while (true) {
        const std::string_view name = text.substr(0, text.find(','));
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Error(fmt::format("--aov: there is no output \"{}\"{}; known are {}", name, suggestion(name, known),
                                    list(known)));
        if (std::none_of(outputs.begin(), outputs.end(), [&](const auto& o) { return output_name(o) == name; }))
            outputs.push_back(output_by_name(name));
        if (name.size() == text.size()) return;
        text.remove_prefix(name.size() + 1);
    }
}

}  // namespace

int parse_max_depth(std::string_view text) {
    const int depth = parse_int("--max-depth", text, -1);
    if (depth == 0)
        throw Error(
            "--max-depth: 0 would show nothing; 1 is emission seen directly, 2 adds direct light, -1 is unlimited");
    return depth;
}

void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const std::string& help) {
    add_values(
        app, "-o,--output", "FILE",
        [&](const std::string& text) {
            if (text.empty()) throw Error("--output: the name is empty");
            outputs.emplace_back(text);
        },
        help);
}

void add_scene_options(CLI::App& app, SceneOptions& options) {
    app.add_option("SCENE", options.scene,
                   "a scene file, which ends in\n" + scene_endings() + ",\nor one of " + list(stock::names))
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
    add_values(
        app, "--path", "DIR",
        [&](const std::string& text) {
            if (text.empty()) throw Error("--path: the name is empty");
            options.search_paths.emplace_back(text);
        },
        "where the files that a Mitsuba scene names are looked for besides;\nmay be repeated");
    add_name(app, "--sensor", "ID", options.sensor,
             "which of the scene's cameras: its id, or its number from 0\n(default: the first)");
    app.add_flag(
        "--lenient", options.lenient,
        "stand-ins for what the scene file asks for and is not supported,\neach with a warning; \"info\" lists "
        "them");
    add_value(
        app, "--size", "WxH", [&](const std::string& text) { options.size = parse_size("--size", text); },
        "image size in pixels, instead of the scene's");
    add_value(
        app, "--filter", "NAME", [&](const std::string& text) { options.filter = parse_filter(text); },
        "pixel filter, instead of the scene's: box, tent (radius 1 pixel),\ngaussian (standard deviation 0.5 pixels)");
    app.add_option("--embree", options.build.embree_config,
                   "Embree's device configuration, such as\n\"isa=sse4.2,verbose=1\"")
        ->type_name("CONFIG");
    app.add_flag("--robust", options.build.robust, "watertight edges between triangles (slower)");
}

void add_path_options(CLI::App& app, std::optional<int>& max_depth, std::optional<int>& rr_depth, Sampling& sampling) {
    add_value(
        app, "--max-depth", "D", [&](const std::string& text) { max_depth = parse_max_depth(text); },
        "path length: 1 is emission seen directly, 2 adds direct light,\n-1 is unlimited (default: the scene's, or "
        "-1)");
    add_value(
        app, "--rr-depth", "D", [&](const std::string& text) { rr_depth = parse_int("--rr-depth", text, 0); },
        "bounces before Russian roulette begins (default: the scene's, or 5)");
    add_value(
        app, "--sampler", "NAME", [&](const std::string& text) { sampling = parse_sampling(text); },
        "sobol (default: less noise) or independent");
}

void add_render(CLI::App& app, RenderOptions& options) {
    add_scene_options(app, options.scene);
    add_name(app, "-m,--method", "NAME", options.method,
             "rendering method:\n" + list(known_methods) + "\n(default: path-nee; see \"lightswitch methods\")");
    add_outputs(app, options.outputs,
                "image to write, by extension: .exr, .pfm, .hdr (linear) or .png\n(exposure, sRGB); may be repeated");
    add_values(
        app, "--aov", "LIST", [&](const std::string& text) { add_extra_outputs(options.extra, text); },
        "what the camera sees beside light, as layers of the .exr files:\n" + output_names() +
            ",\nseparated by commas");
    add_value(
        app, "--spp", "N", [&](const std::string& text) { options.budget.samples = parse_int("--spp", text, 1); },
        "samples per pixel (default: what the scene asks for, or 64)");
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { options.budget.seconds = parse_number_option("--seconds", text, 0, true); },
        "seconds of rendering; one sample per pixel is always made");
    add_value(
        app, "--error", "E",
        [&](const std::string& text) { options.budget.error = parse_number_option("--error", text, 0, true); },
        "estimated root mean square error of a pixel as a fraction of the\nimage's mean (0.01 is 1 %), judged from 16 "
        "samples on.\nAlone it ends an image that stays black after 256 samples");
    add_value(
        app, "--denoise", "NAME",
        [&](const std::string& text) {
            if (std::find(denoiser_names.begin(), denoiser_names.end(), text) == denoiser_names.end())
                throw Error(
                    fmt::format("--denoise: there is no denoiser \"{}\"; known are {}", text, list(denoiser_names)));
            options.denoise = text;
        },
        "take noise out, as far as the samples do not object: oidn (Open\nImage Denoise 2, where it is installed), "
        "own, "
        "or auto: oidn if it is\nthere. --error is then that of the result");
    add_seed(app, options.seed, "another seed gives other noise (default: 0)");
    add_threads(app, options.threads, ".\nThe image is the same for any number");
    add_path_options(app, options.max_depth, options.rr_depth, options.sampling);
    add_value(
        app, "--exposure", "STOPS",
        [&](const std::string& text) {
            options.auto_exposure = text == "auto";
            if (!options.auto_exposure)
                options.exposure = parse_float("--exposure", text, std::numeric_limits<double>::lowest(), false);
        },
        "brightness of .png: radiance times 2^STOPS, or auto: what the\nimage shows on average is a middle grey "
        "(default: "
        "what the scene\nasks for, or auto)");
    add_name(app, "--stats", "FILE.json", options.stats, "write the render's numbers as JSON; - is standard output");
    app.add_flag("-q,--quiet", options.quiet, "no progress, no notices on scene and mesh files, no summary");
    add_long_options(app, options);
    add_method_options(app, options.of_method);
    app.footer(
        "Of --spp, --seconds and --error the limit that is met first ends the render. Ctrl-C, SIGTERM and SIGHUP end\n"
        "it too: the image so far is written; a second Ctrl-C ends the program at once.\n\n"
        "Exit status: 0 done, 2 an error of which one line on standard error tells, 130 cancelled.\n\n"
        "Layers (--aov) are the channels albedo.R .G .B, normal.X .Y .Z (shading normal, facing the viewer),\n"
        "depth.Z (distance from the camera), position.X .Y .Z, shape.I and primitive.I (numbers from 1, of what the\n"
        "pixel's centre sees). Albedo, which looks through mirrors and glass, and normal guide denoisers. They are\n"
        "rendered before the image, by the same camera rays, 16 to 64 per pixel; 0 is where nothing is seen.\n\n"
        "--denoise renders half of the samples with another seed, denoises and mixes the result with the samples, so\n"
        "that the error goes on falling as they grow. .exr files get the layers error.Y (estimated, of each pixel),\n"
        "from_samples.Y (0 to 1) and samples.R .G .B (the image without denoising). The environment variable\n"
        "LIGHTSWITCH_OIDN may name the library of Open Image Denoise.\n\n"
        "Examples:\n"
        "  lightswitch render cornell-box --output box.png\n"
        "  lightswitch render cornell-box --aov albedo,normal,depth --output box.exr\n"
        "  lightswitch render room.xml --method path --spp 256 --output room.exr --output room.png\n"
        "  lightswitch render room.xml --error 0.02 --seconds 60 --size 640x360 --output room.png\n"
        "  lightswitch render cornell-spheres --method photon --radius 3 --photon-paths 2 --output caustic.png\n"
        "  lightswitch render cornell-box --spp 16 --stats - --quiet\n"
        "  lightswitch render room.xml --spp 100000 --checkpoint room.lsw --write-every 60 --output room.exr\n"
        "  lightswitch render cornell-box --spp 16 --denoise auto --output box.exr --output box.png\n\n"
        "Keys of --stats: method, kind, scene, scene_type, width, height, samples_per_pixel, seconds (rendering\n"
        "only), rays, shadow_rays, rays_per_second, samples_per_second, threads, seed, sampler, max_depth,\n"
        "rr_depth, stand_ins, mean, estimated_error, non_finite, first_non_finite, splats, paths, triangles, spheres, "
        "lights,\n"
        "build_seconds, embree_bytes, scene_bytes, camera, embree_version, lightswitch_version, cancelled.\n"
        "--denoise adds denoiser, denoise_seconds, estimated_error_of_samples, estimated_error_of_denoised (unmixed)\n"
        "and detail_from_samples.\n"
        "Methods add their settings (initial_radius_pixels, alpha, paths_per_pixel, final_gather, bootstrap,\n"
        "mutations_per_pixel, refine) and what they counted, in the last iteration (photons, photon_map_bytes,\n"
        "light_vertices, radius_pixels) or in all (chains, mutations, acceptance_rate, chain_length,\n"
        "chain_energy, chain_share, coverage).");
}

void add_view(CLI::App& app, ViewOptions& options) {
    add_scene_options(app, options.scene);
    add_name(app, "-m,--method", "NAME", options.method,
             "the method that is shown first:\n" + list(known_methods) + "\n(default: path-nee)");
    add_name(app, "-a,--against", "NAME", options.against,
             "the method that it is compared with, which renders in the\nbackground (default: none; Shift and a digit "
             "choose one)");
    add_value(
        app, "--spp", "N", [&](const std::string& text) { options.samples = parse_int("--spp", text, 1); },
        "samples per pixel after which a method rests (default: it goes on)");
    add_path_options(app, options.max_depth, options.rr_depth, options.sampling);
    add_seed(app, options.seed, "another seed gives other noise (default: 0)");
    add_threads(app, options.threads);
    add_value(
        app, "--exposure", "STOPS",
        [&](const std::string& text) {
            options.exposure = parse_float("--exposure", text, std::numeric_limits<double>::lowest(), false);
        },
        "brightness: radiance times 2^STOPS (default: what the scene asks\nfor, or chosen by the first picture)");
    add_value(
        app, "--window", "WxH", [&](const std::string& text) { options.window = parse_size("--window", text); },
        "size of the window (default: 1280x800)");
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { options.seconds = parse_number_option("--seconds", text, 0, true); },
        "close the window after so long, without asking");
    add_name(app, "--stats", "FILE.json", options.stats,
             "when it closes, write what was rendered and how often the window\nwas drawn; - is standard output");
    app.add_flag("-q,--quiet", options.quiet, "no notices on scene and mesh files");
    add_method_options(app, options.of_methods);
    app.footer(
        "Keys 0 to 8 switch the method at once, Shift and a digit choose what it is compared with, F2 to F11 the\n"
        "view: image, side by side, split, flicker, difference, relative difference, significance, albedo, normal,\n"
        "depth. The mouse turns (left), moves (right) and zooms (wheel); ? shows all keys. Each method keeps what it\n"
        "has rendered until the camera moves; after N samples the image is that of \"render --spp N\", bit for bit.\n"
        "A file that is dropped on the window is opened.\n\n"
        "Examples:\n"
        "  lightswitch view cornell-box\n"
        "  lightswitch view room.xml --method bdpt --against path-nee --size 640x360");
}

void add_compare(CLI::App& app, CompareOptions& options) {
    app.add_option("IMAGES", options.images,
                   "two or more images of one size: .exr, .hdr or .pfm. The last one\nis the reference, unless "
                   "--reference names it")
        ->type_name("");
    add_name(app, "-r,--reference", "FILE", options.reference, "what all images are compared with");
    add_outputs(
        app, options.outputs,
        ".png: the first image less the reference in false colours, red\nwhere it is brighter, with a legend; .exr or "
        ".pfm: the\ndifference itself; may be repeated");
    add_name(
        app, "--report", "FILE.html", options.report,
        "a page to look at them: slider, flip, exposure, zoom, difference\nand FLIP maps, table of metrics. Needs no "
        "network");
    app.add_flag("--absolute", options.absolute, "write the magnitude of the difference instead");
    add_value(
        app, "--scale", "S", [&](const std::string& text) { options.scale = parse_float("--scale", text, 0, true); },
        "difference at the ends of the colour map (default: the 99th\npercentile, rounded up)");
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
    add_name(
        app, "-r,--reference", "NAME", command.reference,
        "what to verify them against, which must be unbiased (default:\npath-nee; path where that is in question; bdpt "
        "where the others\nlack paths, or path-nee does)");
    add_names("--images", "FILES", command.images,
              "instead of methods: independent renders (different seeds) of the\nscene by any renderer, such as "
              "'mine/*.exr'");
    add_names("--against", "FILES", command.against, "with --images: the same by another renderer, instead of a scene");
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { command.options.seconds = parse_number_option("--seconds", text, 0, true); },
        "on the clock, in all, but at least three images of each\n(default: 60). It ends as soon as every question is "
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
        [&](const std::string& text) { command.options.path_lengths = parse_int("--lengths", text, 0, 64); },
        "path lengths that are compared one by one (default: 5; longer\nones together)");
    add_value(
        app, "--max-depth", "D", [&](const std::string& text) { command.max_depth = parse_max_depth(text); },
        "path length of the image, as for render");
    add_seed(app, command.options.seed, "another seed draws other samples (default: 0)");
    add_threads(app, command.options.threads);
    add_name(
        app, "--report", "FILE.html", command.report,
        "a page with images, maps of differences and p-values, error over\ntime and all numbers. Needs no network");
    add_name(app, "--json", "FILE.json", command.json, "write the verdicts as JSON; - is standard output");
    app.add_flag("-q,--quiet", command.quiet, "no progress, no notices on scene and mesh files, no text");
    add_method_options(app, command.of_methods);
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

void add_strategies(CLI::App& app, StrategiesCommand& command) {
    add_scene_options(app, command.scene);
    add_outputs(app, command.outputs,
                "picture of all strategies, by extension: .png, .exr, .hdr or .pfm;\nmay be repeated");
    add_name(app, "--directory", "DIR", command.directory, "write each strategy there as s2_t3.exr (linear)");
    add_value(
        app, "--max-depth", "D",
        [&](const std::string& text) { command.max_depth = parse_int("--max-depth", text, 1, most_strategy_depth); },
        fmt::format("longest path, and number of rows: 1 to {} (default: 5)", most_strategy_depth));
    add_value(
        app, "--spp", "N", [&](const std::string& text) { command.samples = parse_int("--spp", text, 1); },
        "samples per pixel of every strategy (default: 64)");
    add_seed(app, command.seed, "another seed gives other noise (default: 0)");
    add_threads(app, command.threads);
    app.add_flag("--unweighted", command.unweighted,
                 "every strategy as if there were no other: each finds by\nitself all light of its path length, or "
                 "none of it");
    app.add_flag("-q,--quiet", command.quiet, "no progress, no notices on scene and mesh files, no text");
    app.footer(
        "Bidirectional path tracing joins s vertices of a path from a light with t vertices of a path from the\n"
        "camera, the lens included. The picture has a row for every path length, s + t - 1, and in it the strategies\n"
        "by s, each times its weight of multiple importance sampling: they add up to the image of bdpt, and what is\n"
        "bright in one is what that strategy is best at (Veach 1997, figure 10.3). All tiles share one exposure: the\n"
        "brightest percent of their pixels is white. Scenes are rendered with at most 128 pixels a side, unless\n"
        "--size says more.\n\n"
        "Exit status: 0 done, 2 an error of which one line on standard error tells, 130 cancelled.\n\n"
        "Examples:\n"
        "  lightswitch strategies cornell-spheres --output pyramid.png\n"
        "  lightswitch strategies room.xml --max-depth 3 --spp 256 --unweighted --output alone.png --directory .");
}

}  // namespace lightswitch::program
