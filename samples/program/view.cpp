#include "program.hpp"

#include "messages.hpp"
#include "method_notes.hpp"

#if LIGHTSWITCH_HAS_WINDOW
#include "load.hpp"
#include "outputs.hpp"
#include "view/interface.hpp"
#include "view/window.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#endif

namespace lightswitch::program {

#if LIGHTSWITCH_HAS_WINDOW

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// How often the window was drawn, and what was rendered meanwhile.
struct Account {
    Clock::time_point begin = Clock::now();
    std::uint64_t frames = 0;
    double drawing = 0;  // seconds

    double seconds() const { return seconds_since(begin); }
};

std::string account_json(const Account& account, const LiveScene& scene) {
    nlohmann::ordered_json json{{"seconds", account.seconds()},
                                {"frames", account.frames},
                                {"frames_per_second", double(account.frames) / account.seconds()},
                                {"drawing_seconds", account.drawing},
                                {"shown", scene.shown_method().name}};
    nlohmann::ordered_json methods = nlohmann::ordered_json::object();
    for (const LiveMethod& method : scene.methods())
        if (const auto& s = method.snapshot; s && s->iterations > 0)
            methods[method.name] = {{"samples_per_pixel", s->iterations},
                                    {"seconds", s->statistics.seconds},
                                    {"rays", s->statistics.counts.rays},
                                    {"estimated_error", s->error},
                                    {"non_finite", s->statistics.counts.non_finite}};
    json["methods"] = methods;
    return json.dump(2) + "\n";
}

}  // namespace

int view(const ViewOptions& options) {
    find_method(options.method, "--method");
    if (!options.against.empty()) find_method(options.against, "--against");
    Outputs outputs;
    outputs.add_text("--stats", options.stats);
    std::optional<LoadedScene> loaded;
    if (!options.scene.scene.empty()) {
        loaded = load_scene(options.scene, options.quiet);
        outputs.refuse_inputs(loaded->summary.files);
    }
    Window window(options.window, "lightswitch");
    Interface interface(window, options);
    if (loaded) interface.set_scene(std::move(*loaded), options);

    Account account;
    int settling = 0;  // frames that are still due: ImGui shows what has happened in several
    while (!interface.wants_to_close()) {
        const auto begin = Clock::now();
        interface.frame();
        const double drawn = seconds_since(begin);
        ++account.frames;
        account.drawing += drawn;
        if (window.wants_to_close()) {
            window.keep_open();
            interface.close();
        }
        // Where the processor draws, it is not to take much from the renderer as long as nobody does anything.
        double pause = interface.moves() || settling > 0 ? 1.0 / 60
                       : interface.is_waited_for()       ? 1.0 / 30
                                                         : std::clamp(25 * drawn, 1.0 / 30, 0.5);
        settling = std::max(settling - 1, 0);
        for (double left = pause - drawn; left > 0; left = pause - seconds_since(begin)) {
            window.wait(left);
            if (window.take_input()) {
                settling = 3;
                pause = 1.0 / 60;
            }
        }
        window.wait(0);
        if (options.seconds > 0 && account.seconds() >= options.seconds) break;
    }
    if (!options.stats.empty() && interface.scene())
        write_text(options.stats, account_json(account, *interface.scene()));
    return success;
}

#else

int view(const ViewOptions&) {
    throw Error(
        "view: this program was built without a window; with GLFW and Dear ImGui (Debian, Ubuntu: libglfw3-dev "
        "libimgui-dev) it is built with one");
}

#endif

}  // namespace lightswitch::program
