#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "method_options.hpp"
#include "outputs.hpp"
#include "replay_row.hpp"
#include "run.hpp"
#include "text.hpp"
#include "warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lightswitch::program {
namespace {

using Json = nlohmann::ordered_json;
using Kind = PathEvent::Kind;

void print(const ReplayRow& row) {
    std::string line =
        fmt::format("{:<3} {:<12} {:<45} {:<45} {}", row.vertex, row.what, row.first, row.second, row.rest);
    line.resize(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
}

void print_listing(const PathReplay& replayed) {
    Rgb sum(0);
    for (const PathEvent& event : replayed.events) {
        if (event.kind == Kind::contribution) sum += event.value;
        if ((event.kind == Kind::camera || event.kind == Kind::light) && &event != &replayed.events.front())
            fmt::print("\n");
        print(replay_row(event, sum));
        if (event.kind == Kind::sample) sum = Rgb(0);
    }
    fmt::print("\nfilm {}: sample {} and splats {}\n", text_of(replayed.value()), text_of(replayed.sample),
               text_of(replayed.splatted));
    if (replayed.dropped > 0) fmt::print("{} values or rays were not finite; they count as black\n", replayed.dropped);
    fmt::print("{}\n", replayed.explained
                           ? "the contributions add up to it, bit for bit"
                           : "the method does not tell of all contributions: only what came of them is exact");
}

template <class T>
Json json(const glm::vec<3, T>& v) {
    return {v.x, v.y, v.z};
}

Json json(const PathEvent& event) {
    Json result{{"event", name(event.kind)}};
    const auto path = [&] {
        result["path"] = event.of_light ? "light" : "camera";
        result["vertex"] = event.vertex;
    };
    const auto strategy = [&] {
        result["how"] = name(event.how);
        result["s"] = event.light_vertices;
        result["t"] = event.camera_vertices;
        result["weight"] = event.weight;
        result["value"] = json(event.value);
    };
    const auto surface = [&] {
        result["position"] = json(event.position);
        result["surface"] = event.surface;
        result["shape"] = event.shape;
        result["primitive"] = event.primitive;
        result["light"] = event.light;
    };
    if (event.kind != Kind::splat && event.kind != Kind::sample) path();
    switch (event.kind) {
        case Kind::camera: result["film"] = {event.film.x, event.film.y}; [[fallthrough]];
        case Kind::light:
            result["position"] = json(event.from);
            result["direction"] = json(event.direction);
            if (event.kind == Kind::light) {
                result["light"] = event.light;
                result["throughput"] = json(event.throughput);
            }
            break;
        case Kind::surface:
            surface();
            result["normal"] = json(event.normal);
            break;
        case Kind::escape: result["direction"] = json(event.direction); break;
        case Kind::scatter:
            result["direction"] = json(event.direction);
            result["pdf"] = event.pdf;
            result["dirac"] = event.specular;
            result["throughput"] = json(event.throughput);
            result["survival"] = event.survival;
            result["survived"] = event.survived;
            break;
        case Kind::shadow:
            result["from"] = json(event.from);
            result["blocked"] = event.blocked;
            if (event.blocked) surface();
            else result["position"] = json(event.position);
            break;
        case Kind::contribution: strategy(); break;
        case Kind::splat:
            strategy();
            result["number"] = event.path;
            result["film"] = {event.film.x, event.film.y};
            result["here"] = event.here;
            break;
        case Kind::sample:
            result["value"] = json(event.value);
            result["finite"] = event.here;
            break;
    }
    return result;
}

std::string listing_json(const ReplayCommand& command, const ReplayedPixel& at,
                         const std::optional<BrightestSample>& brightest, const PathReplay& replayed) {
    Json result{{"method", command.method},
                {"scene", command.scene.scene},
                {"pixel", {at.x, at.y}},
                {"iteration", at.iteration},
                {"seed", command.seed},
                {"sampler", name(command.sampling)},
                {"value", json(replayed.value())},
                {"sample", json(replayed.sample)},
                {"splatted", json(replayed.splatted)},
                {"not_finite", replayed.dropped},
                {"explained", replayed.explained},
                {"events", Json::array()}};
    for (const PathEvent& event : replayed.events) result["events"].push_back(json(event));
    if (brightest)
        result["brightest"] = {{"iterations", brightest->tried},
                               {"value", json(brightest->value)},
                               {"mean", json(brightest->mean)},
                               {"not_finite", brightest->non_finite}};
    return result.dump(2) + "\n";
}

void print_brightest(const BrightestSample& brightest) {
    const double mean = luminance(brightest.mean), value = luminance(brightest.value);
    fmt::print("brightest of {} samples: iteration {}, value {}{}\n", brightest.tried, brightest.iteration,
               text_of(brightest.value), mean > 0 ? fmt::format(", {:.3g} times their mean", value / mean) : "");
    if (brightest.first_non_finite)
        fmt::print("{} of them had values that were not finite: the first is --iteration {}\n", brightest.non_finite,
                   *brightest.first_non_finite);
}

}  // namespace

int replay(const ReplayCommand& command) {
    AnyMethod method = find_method(command.method, "--method");
    if (!command.pixel) throw Error("name a pixel: --pixel X,Y, counted from 0 at the top left");
    Outputs outputs;
    outputs.add_text("--json", command.json);
    const LoadedScene loaded = load_scene(command.scene, command.quiet);
    outputs.refuse_inputs(loaded.summary.files);
    const Size size = loaded.summary.size;
    set_options({&method, 1}, command.of_method, std::size_t(size.width) * std::size_t(size.height));
    warn_about_depths(method, command.max_depth, command.rr_depth);
    set_path_length(method, path_length(loaded.summary, command.max_depth, command.rr_depth));

    const Cancellation cancellation;
    const Settings settings{
        .seed = command.seed, .threads = command.threads, .sampling = command.sampling, .stop = cancellation.token()};
    const ReplayOptions options{.others = !command.own};
    ReplayedPixel at{command.pixel->x, command.pixel->y, command.iteration};
    std::optional<BrightestSample> brightest;
    if (command.brightest > 0) {
        brightest = run_brightest(loaded.scene, method, settings, at, command.brightest, options);
        at.iteration = brightest->iteration;
    }
    PathReplay replayed;
    if (!cancellation.token().stop_requested()) replayed = run_replay(loaded.scene, method, settings, at, options);
    if (cancellation.token().stop_requested()) {
        print_note("cancelled before the sample was made");
        return Status::cancelled;
    }
    if (!command.json.empty()) write_text(command.json, listing_json(command, at, brightest, replayed));
    if (command.json == "-" || command.quiet) return success;
    if (brightest) print_brightest(*brightest);
    fmt::print("{} on {}, {} x {} pixels: pixel ({}, {}), iteration {}, seed {}\n\n", command.method,
               command.scene.scene, size.width, size.height, at.x, at.y, at.iteration, command.seed);
    print_listing(replayed);
    return success;
}

}  // namespace lightswitch::program
