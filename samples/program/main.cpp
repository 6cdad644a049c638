// The program `lightswitch`: renders scenes with any of the library's methods, and compares the images.

#include "messages.hpp"
#include "options.hpp"
#include "ranks.hpp"
#include "scene_files.hpp"
#include "text.hpp"

#include <lightswitch/embree/api.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/version.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <thread>

namespace lightswitch::program {
namespace {

constexpr std::array<std::string_view, 10> commands{"render", "view",       "merge",  "compare", "verify",
                                                    "sweep",  "strategies", "replay", "methods", "info"};
/// CLI11's help, with a usage line that shows what must be given.
class Help : public CLI::Formatter {
public:
    std::string make_usage(const CLI::App* app, std::string) const override {
        const std::string command = app->get_name();
        if (command == "render") return usage("render SCENE --output FILE [OPTIONS]");
        if (command == "view") return usage("view [SCENE] [OPTIONS]");
        if (command == "merge") return usage("merge STATE ... [--output FILE] [--checkpoint FILE.lsw]");
        if (command == "compare") return usage("compare A B ... [OPTIONS]");
        if (command == "verify")
            return usage(
                "verify SCENE [OPTIONS]\n"
                "       lightswitch verify SCENE --images FILES [OPTIONS]\n"
                "       lightswitch verify --images FILES --against FILES [OPTIONS]");
        if (command == "sweep") return usage("sweep SCENE [OPTIONS]");
        if (command == "strategies") return usage("strategies SCENE --output FILE [OPTIONS]");
        if (command == "replay") return usage("replay SCENE --pixel X,Y [OPTIONS]");
        if (command == "info") return usage("info SCENE [OPTIONS]");
        if (command == "methods") return usage("methods");
        return usage("COMMAND [OPTIONS]");
    }

private:
    static std::string usage(const char* arguments) { return fmt::format("Usage: lightswitch {}\n", arguments); }
};

/// The command line, last word first as CLI11 wants it. It looks for options even behind a "--" in places, so words
/// there that begin with "-" are written as the file names that they are.
std::vector<std::string> reversed_words(int argc, char** argv) {
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const auto end = std::find(words.begin(), words.end(), "--");
    for (auto word = end; word != words.end(); ++word)
        if (word != end && word->starts_with('-')) word->insert(0, "./");
    std::reverse(words.begin(), words.end());
    return words;
}

/// What CLI11 could not place: an option that is not known, or one word too many.
void refuse_leftovers(const CLI::App& command) {
    std::vector<std::string> leftovers = command.remaining();
    // The first "--" ends the options, and is not there for itself.
    const auto end = std::find(leftovers.begin(), leftovers.end(), "--");
    const auto option =
        std::find_if(leftovers.begin(), end, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    const std::string unknown = option == end ? std::string() : *option;
    if (end != leftovers.end()) leftovers.erase(end);
    if (leftovers.empty()) return;
    const bool top = command.get_parent() == nullptr;
    const std::string prefix = top ? "" : command.get_name() + ": ";
    const std::string help = fmt::format("; see \"lightswitch {}--help\"", top ? "" : command.get_name() + " ");
    if (unknown.empty()) throw Error(fmt::format("{}there is no use for \"{}\"{}", prefix, leftovers[0], help));
    std::vector<std::string> names;
    for (const CLI::Option* known : command.get_options())
        for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string word = unknown.substr(0, unknown.find('='));
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
        "  lightswitch compare box.exr reference.exr --output difference.png\n"
        "  lightswitch verify cornell-box --methods path-nee --reference path\n"
        "  lightswitch sweep cornell-box --report sweep.html\n\n"
        "\"lightswitch COMMAND --help\" explains the options of a command. Behind \"--\" stand only files, also those\n"
        "whose names begin with \"-\".");

    RenderOptions render_options;
    ViewOptions view_options;
    MergeOptions merge_options;
    CompareOptions compare_options;
    VerifyCommand verify_options;
    SweepCommand sweep_options;
    StrategiesCommand strategies_options;
    ReplayCommand replay_options;
    SceneOptions info_options;
    CLI::App& render_command = *app.add_subcommand("render", "Render a scene to image files");
    CLI::App& view_command = *app.add_subcommand("view", "Open a window in which methods are switched live");
    CLI::App& merge_command = *app.add_subcommand("merge", "Join what several renders have made of one image");
    CLI::App& compare_command = *app.add_subcommand("compare", "Measure and show how images differ");
    CLI::App& verify_command = *app.add_subcommand("verify", "Tell whether methods have the same expected image");
    CLI::App& sweep_command = *app.add_subcommand("sweep", "Measure every method's error over time");
    CLI::App& strategies_command =
        *app.add_subcommand("strategies", "Show what each strategy of bidirectional path tracing finds");
    CLI::App& replay_command = *app.add_subcommand("replay", "Tell how one sample of a pixel came about");
    CLI::App& methods_command = *app.add_subcommand("methods", "List the methods: kind, what each can and cannot do");
    CLI::App& info_command = *app.add_subcommand("info", "Tell what a scene requires");
    add_render(render_command, render_options);
    add_view(view_command, view_options);
    add_merge(merge_command, merge_options);
    add_compare(compare_command, compare_options);
    add_verify(verify_command, verify_options);
    add_sweep(sweep_command, sweep_options);
    add_strategies(strategies_command, strategies_options);
    add_replay(replay_command, replay_options);
    add_scene_options(info_command, info_options);
    methods_command.footer(
        "Examples:\n"
        "  lightswitch methods\n"
        "  lightswitch render cornell-box --method bdpt --output box.png");
    info_command.footer(
        "Examples:\n"
        "  lightswitch info cornell-box\n"
        "  lightswitch info room.xml --define lamp=12 --size 640x360");
    for (CLI::App* command : app.get_subcommands({})) command->allow_extras();

    const std::string_view first = argc > 1 ? argv[1] : "";
    const bool is_command = std::find(commands.begin(), commands.end(), first) != commands.end();
    if (first.empty()) throw Error("name a command: " + list(commands) + "; see \"lightswitch --help\"");
    if (!is_command && first[0] != '-')
        throw Error(fmt::format("there is no command \"{}\"{}; known are {}", first, suggestion(first, commands),
                                list(commands)));
    app.allow_extras();
    app.require_subcommand(0, 1);  // a second name of a command is a word like others
    try {
        app.parse(reversed_words(argc, argv));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
        throw Error(explain(error));
    }
    refuse_leftovers(app);
    if (app.get_subcommands().empty())
        throw Error("name a command: " + list(commands) + "; see \"lightswitch --help\"");
    const CLI::App& command = *app.get_subcommands().front();
    refuse_leftovers(command);
    if (rank_count() > 1 && &command != &render_command)
        throw Error(fmt::format("{}: processes of an MPI job share only \"render\": start it without them",
                                command.get_name()));
    if (&command == &methods_command) return list_methods();
    if (&command == &view_command) return view(view_options);
    if (&command == &merge_command) return merge(merge_options);
    if (&command == &compare_command) return compare(compare_options);
    if (&command == &verify_command) return verify(verify_options);
    const SceneOptions& scene = &command == &info_command         ? info_options
                                : &command == &strategies_command ? strategies_options.scene
                                : &command == &sweep_command      ? sweep_options.scene
                                : &command == &replay_command     ? replay_options.scene
                                                                  : render_options.scene;
    if (scene.scene.empty())
        throw Error(fmt::format("{}: name a scene: a file that ends in {}, or one of {}", command.get_name(),
                                scene_endings(), list(stock::names)));
    if (&command == &info_command) return info(info_options);
    if (&command == &replay_command) return replay(replay_options);
    if (&command == &sweep_command) return sweep(sweep_options);
    return &command == &strategies_command ? strategies(strategies_options) : render(render_options);
}

/// Where a standard stream is closed, a file opened later would take its place and receive what is meant for it. Opened
/// the wrong way round instead, so that using it fails.
void occupy_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream)
            _exit(user_error);
}

/// What no thread has caught: oneTBB throws so out of its own threads when it cannot start one more. An error like
/// others.
[[noreturn]] void end_by_uncaught() {
    static std::atomic_flag told;
    if (told.test_and_set()) std::this_thread::sleep_for(std::chrono::seconds(1));  // another thread ends the program
    try {
        if (const auto exception = std::current_exception()) std::rethrow_exception(exception);
    } catch (const std::exception& error) {
        print_error(error.what());
        std::_Exit(user_error);
    } catch (...) {
    }
    std::abort();
}

}  // namespace
}  // namespace lightswitch::program

int main(int argc, char** argv) {
    using namespace lightswitch::program;
    occupy_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that becomes too large is then a failed write, and an error
    std::set_terminate(end_by_uncaught);
    const MpiJob job(argc, argv);
    try {
        const int status = run_command(argc, argv);
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
            print_error("standard output could not be written");
            return user_error;
        }
        return status;
    } catch (const std::bad_alloc&) {
        print_error(last_words("there is not enough memory; a smaller --size or a smaller scene takes less"));
    } catch (const std::exception& error) {
        print_error(last_words(error.what()));
    }
    return user_error;
}
