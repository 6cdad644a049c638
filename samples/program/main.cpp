// The program `lightswitch`: renders scenes with any of the library's methods, and compares the images.

#include "messages.hpp"
#include "method_notes.hpp"
#include "program.hpp"
#include "text.hpp"

#include <lightswitch/embree/api.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/version.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <cstdio>
#include <new>

namespace lightswitch::program {
namespace {

constexpr std::array<std::string_view, 4> commands{"render", "compare", "methods", "info"};
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

/// CLI11's help, with a usage line that shows what must be given.
class Help : public CLI::Formatter {
public:
    std::string make_usage(const CLI::App* app, std::string) const override {
        const std::string command = app->get_name();
        if (command == "render") return usage("render SCENE --output FILE [OPTIONS]");
        if (command == "compare") return usage("compare A B [OPTIONS]");
        if (command == "info") return usage("info SCENE [OPTIONS]");
        if (command == "methods") return usage("methods");
        return usage("COMMAND [OPTIONS]");
    }

private:
    static std::string usage(const char* arguments) { return fmt::format("Usage: lightswitch {}\n", arguments); }
};

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
    app.add_option("A", options.a, "the image: .exr, .hdr or .pfm")->type_name("");
    app.add_option("B", options.b, "its reference, of the same size")->type_name("");
    add_outputs(app, options.outputs,
                ".png: A - B in false colours, red where A is brighter, with a\nlegend; .exr or .pfm: the difference "
                "itself; may be "
                "repeated");
    app.add_flag("--absolute", options.absolute, "write |A - B| instead");
    add_value(
        app, "--scale", "S", [&](const std::string& text) { options.scale = parse_float("--scale", text, 0, true); },
        "difference at the ends of the colour map (default: the 99th\npercentile)");
    app.footer(
        "Prints the means, their ratio, MSE, RMSE, relMSE (squared error over squared reference + 0.01) and the\n"
        "largest difference. Images of different scenes, cameras or sizes are refused.\n\n"
        "Example:\n"
        "  lightswitch compare bdpt.exr path.exr --output difference.png --scale 0.1");
}

/// What CLI11 could not place: an option that is not known, or one word too many.
void refuse_leftovers(const CLI::App& command) {
    const std::vector<std::string> leftovers = command.remaining();
    if (leftovers.empty()) return;
    const auto option = std::find_if(leftovers.begin(), leftovers.end(),
                                     [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    const bool top = command.get_parent() == nullptr;
    const std::string prefix = top ? "" : command.get_name() + ": ";
    const std::string help = fmt::format("; see \"lightswitch {}--help\"", top ? "" : command.get_name() + " ");
    if (option == leftovers.end())
        throw Error(fmt::format("{}there is no use for \"{}\"{}", prefix, leftovers[0], help));
    std::vector<std::string> names;
    for (const CLI::Option* known : command.get_options())
        for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string word = option->substr(0, option->find('='));
    throw Error(fmt::format("{}there is no option \"{}\"{}{}", prefix, word, suggestion(word, views), help));
}

/// What CLI11 found wrong, in a sentence.
std::string explain(const CLI::ParseError& error) {
    const std::string message = error.what();
    const std::string subject = message.substr(0, message.find(':'));
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        return subject + (message.find("At Most") != std::string::npos ? " is given more than once" : " needs a value");
    return message;
}

int run_command(int argc, char** argv) {
    CLI::App app("Renders one scene with different light transport methods, and compares the results.", "lightswitch");
    app.formatter(std::make_shared<Help>());
    app.get_formatter()->column_width(28);
    app.get_formatter()->label("SUBCOMMANDS", "Commands");
    app.set_version_flag("--version", "lightswitch " + version() + ", Embree " + RTC_VERSION_STRING);
    app.footer(
        "Examples:\n"
        "  lightswitch render cornell-box --method path-nee --spp 64 --output box.png --output box.exr\n"
        "  lightswitch compare box.exr reference.exr --output difference.png\n\n"
        "\"lightswitch COMMAND --help\" explains the options of a command.");

    RenderOptions render_options;
    CompareOptions compare_options;
    SceneOptions info_options;
    CLI::App& render_command = *app.add_subcommand("render", "Render a scene to image files");
    CLI::App& compare_command = *app.add_subcommand("compare", "Measure and show how two images differ");
    CLI::App& methods_command = *app.add_subcommand("methods", "List the methods: kind, what each can and cannot do");
    CLI::App& info_command = *app.add_subcommand("info", "Tell what a scene requires");
    add_render(render_command, render_options);
    add_compare(compare_command, compare_options);
    add_scene_options(info_command, info_options);
    for (CLI::App* command : app.get_subcommands({})) command->allow_extras();

    const std::string_view first = argc > 1 ? argv[1] : "";
    const bool is_command = std::find(commands.begin(), commands.end(), first) != commands.end();
    if (first.empty()) throw Error("name a command: " + list(commands) + "; see \"lightswitch --help\"");
    if (!is_command && first[0] != '-')
        throw Error(fmt::format("there is no command \"{}\"{}; known are {}", first, suggestion(first, commands),
                                list(commands)));
    if (!is_command) app.allow_extras();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
        throw Error(explain(error));
    }
    refuse_leftovers(app);
    if (app.get_subcommands().empty())
        throw Error("name a command: " + list(commands) + "; see \"lightswitch --help\"");
    const CLI::App& command = *app.get_subcommands().front();
    refuse_leftovers(command);
    if (&command == &methods_command) return list_methods();
    if (&command == &compare_command) {
        if (compare_options.b.empty()) throw Error("compare: name two images");
        return compare(compare_options);
    }
    const SceneOptions& scene = &command == &info_command ? info_options : render_options.scene;
    if (scene.scene.empty())
        throw Error(fmt::format("{}: name a scene: a file that ends in .xml, or one of {}", command.get_name(),
                                list(stock::names)));
    return &command == &info_command ? info(info_options) : render(render_options);
}

/// Where a standard stream is closed, a file opened later would take its place and receive what is meant for it. Opened
/// the wrong way round instead, so that using it fails.
void occupy_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream)
            _exit(user_error);
}

}  // namespace
}  // namespace lightswitch::program

int main(int argc, char** argv) {
    using namespace lightswitch::program;
    occupy_standard_streams();
    try {
        const int status = run_command(argc, argv);
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
            print_error("standard output could not be written");
            return user_error;
        }
        return status;
    } catch (const std::bad_alloc&) {
        print_error("there is not enough memory; a smaller --size or a smaller scene takes less");
    } catch (const std::exception& error) {
        print_error(error.what());
    }
    return user_error;
}
