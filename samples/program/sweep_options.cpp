#include "options.hpp"
#include "values.hpp"

#include <fmt/format.h>

namespace lightswitch::program {

void add_sweep(CLI::App& app, SweepCommand& command) {
    add_scene_options(app, command.scene);
    app.add_option("-m,--methods", command.methods,
                   "what to measure, separated by commas, or all (default: all but\nheuristic ones)")
        ->type_name("NAMES")
        ->delimiter(',')
        ->allow_extra_args(false);
    add_value(
        app, "--seconds", "S",
        [&](const std::string& text) { command.options.seconds = parse_number_option("--seconds", text, 0, true); },
        "for each method and seed, where the curves end (default: 0.25).\nAll takes S times methods times seeds, and "
        "the reference");
    add_value(
        app, "--seeds", "N",
        [&](const std::string& text) { command.options.seeds = parse_int("--seeds", text, 1, 1000); },
        "independent images of each method (default: 4); of one there are\nno bands, no variance and no interval of "
        "the bias");
    add_name(app, "-r,--reference", "FILE", command.reference,
             "an image to measure errors against: .exr, .hdr or .pfm (default:\none is made, by the methods that are "
             "best at it)");
    add_value(
        app, "--reference-seconds", "S",
        [&](const std::string& text) {
            command.options.reference_seconds = parse_number_option("--reference-seconds", text, 0, true);
        },
        "for making one (default: 12 times --seconds)");
    add_value(
        app, "--max-depth", "D", [&](const std::string& text) { command.max_depth = parse_max_depth(text); },
        "path length, as for render");
    add_seed(app, command.options.seed, "of the first images; the others have the next ones (default: 0)");
    add_threads(app, command.options.threads);
    add_name(app, "--report", "FILE.html", command.report,
             "a page with error over time, the best method at each time, and\nimages at equal time. Needs no network");
    add_name(app, "--csv", "FILE.csv", command.csv, "write the curves as a table; - is standard output");
    app.add_flag("-q,--quiet", command.quiet, "no progress, no notices on scene and mesh files, no text");
    add_method_options(app, command.of_methods);
    app.footer(
        "Measures the error of each method (relMSE: mean squared error over squared reference + 0.01) whenever its\n"
        "time has doubled, in images of several seeds. Methods take turns, so that a machine that slows down is\n"
        "slower for all; preparation counts. The reference is made by the unbiased method whose short pilots were\n"
        "best, and checked by the second best; how good it is is printed, its part is taken off the errors, and\n"
        "curves stop where they are lost in it. Scenes are rendered with at most 128 pixels a side, unless --size\n"
        "says more: seconds are those of that size.\n\n"
        "Columns: relMSE, mean over seeds, and from the smallest to the largest; typical, the median of 8 x 8 tiles,\n"
        "which single bright pixels do not move; seconds to a relMSE of 1e-2 and 1e-3; var x s, relative variance\n"
        "times seconds: of two methods the one with half as much needs half the time; bias of the image's mean.\n\n"
        "Ctrl-C ends it, and keeps what was measured. Exit status: 0 done, 2 an error of which one line on standard\n"
        "error tells, 130 cancelled.\n\n"
        "Examples:\n"
        "  lightswitch sweep cornell-box --report sweep.html\n"
        "  lightswitch sweep room.xml --methods path-nee,bdpt,vcm --seconds 5 --size 640x360 --csv curves.csv\n"
        "  lightswitch sweep room.xml --reference truth.exr --seconds 2");
}

}  // namespace lightswitch::program
