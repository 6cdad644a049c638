#include "method_notes.hpp"
#include "options.hpp"
#include "values.hpp"

#include <fmt/format.h>

namespace lightswitch::program {
namespace {

PixelAt parse_pixel(std::string_view text) {
    const std::size_t comma = text.find(',');
    try {
        if (comma == std::string_view::npos) throw Error("");
        return {parse_int("", text.substr(0, comma), 0), parse_int("", text.substr(comma + 1), 0)};
    } catch (const Error&) {
        throw Error(fmt::format("--pixel: \"{}\" is not X,Y, counted from 0 at the top left, such as 120,34", text));
    }
}

std::uint64_t parse_count(std::string_view option, std::string_view text, int least) {
    return static_cast<std::uint64_t>(parse_integer_option(option, text, least, unlimited));
}

}  // namespace

void add_replay(CLI::App& app, ReplayCommand& command) {
    add_scene_options(app, command.scene);
    add_name(app, "-m,--method", "NAME", command.method,
             "rendering method:\n" + list(known_methods) + "\n(default: path-nee)");
    add_value(
        app, "--pixel", "X,Y", [&](const std::string& text) { command.pixel = parse_pixel(text); },
        "which pixel, counted from 0 at the top left");
    CLI::Option* iteration = add_value(
        app, "--iteration", "K",
        [&](const std::string& text) { command.iteration = parse_count("--iteration", text, 0); },
        "which of its samples, counted from 0 (default: 0)");
    add_value(
        app, "--brightest", "N",
        [&](const std::string& text) { command.brightest = parse_count("--brightest", text, 1); },
        "the brightest of its first N samples")
        ->excludes(iteration);
    add_seed(app, command.seed, "that of the render (default: 0)");
    add_threads(app, command.threads);
    add_path_options(app, command.max_depth, command.rr_depth, command.sampling);
    app.add_flag("--own", command.own,
                 "without what paths of other pixels splat here: with bdpt no more\nthan the pixel's own paths are "
                 "traced");
    add_name(app, "--json", "FILE.json", command.json, "write what happened as JSON; - is standard output");
    app.add_flag("-q,--quiet", command.quiet, "no notices on scene and mesh files, no text");
    add_method_options(app, command.of_method);
    app.footer(
        "Makes the sample that the pixel got in that iteration of a render with the same options once more, to the\n"
        "bit, and lists what happened: where its paths went, with which densities and roulette, and every "
        "contribution\n"
        "with its strategy (s vertices from the light, t from the camera) and weight. z0 is the camera, y0 a light.\n"
        "For light, photon and vcm, and for what others splat with bdpt, a whole iteration is made; for path-guided\n"
        "what it learns before that one; for mlt all up to that one, and its splats are told without their paths, as\n"
        "each chain's walk is one long path.\n\n"
        "Exit status: 0 done, 2 an error of which one line on standard error tells, 130 cancelled.\n\n"
        "Examples:\n"
        "  lightswitch replay cornell-box --pixel 100,120\n"
        "  lightswitch replay room.xml --method bdpt --pixel 3,5 --brightest 256 --own\n"
        "  lightswitch replay room.xml --pixel 3,5 --iteration 17 --seed 4 --json sample.json");
}

}  // namespace lightswitch::program
