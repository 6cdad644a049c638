#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "method_notes.hpp"
#include "method_options.hpp"
#include "outputs.hpp"
#include "run.hpp"
#include "text.hpp"
#include "warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lightswitch::program {
namespace {

using Json = nlohmann::ordered_json;
using Kind = PathEvent::Kind;

template <class T>
std::string text(const glm::vec<3, T>& v) {
    const auto w = v + T(0);  // no -0
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", w.x, w.y, w.z);
}
std::string text(const DVec2& v) { return fmt::format("({:.6g}, {:.6g})", v.x, v.y); }

/// What is there: "diffuse, shape 3, primitive 1; TriangleLight".
std::string place(const PathEvent& event) {
    std::string result(event.surface);
    if (event.shape > 0)
        result += fmt::format("{}shape {}, primitive {}", result.empty() ? "" : ", ", event.shape, event.primitive);
    if (!event.light.empty()) result += fmt::format("{}{}", result.empty() ? "" : "; ", event.light);
    return result;
}

std::string strategy(const PathEvent& event) {
    if (event.light_vertices + event.camera_vertices == 0) return std::string(name(event.how));
    return fmt::format("{}, s={} t={}, weight {:.6g}", name(event.how), event.light_vertices, event.camera_vertices,
                       event.weight);
}

/// The columns of the listing.
struct Row {
    std::string vertex, what, first, second, rest;
};

void print(const Row& row) {
    std::string line =
        fmt::format("{:<3} {:<12} {:<45} {:<45} {}", row.vertex, row.what, row.first, row.second, row.rest);
    line.resize(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
}

Row row(const PathEvent& event, const Rgb& sum) {
    const std::string vertex = fmt::format("{}{}", event.of_light ? 'y' : 'z', event.vertex);
    const std::string kind(name(event.kind));
    switch (event.kind) {
        case Kind::camera:
            return {vertex, kind, "at " + text(event.from), "towards " + text(event.direction),
                    "through " + text(event.film) + " of the film"};
        case Kind::light:
            return {vertex, kind, "at " + text(event.from), "towards " + text(event.direction),
                    fmt::format("{}, carrying {}", event.light, text(event.throughput))};
        case Kind::surface:
            return {vertex, kind, "at " + text(event.position), "normal " + text(event.normal), place(event)};
        case Kind::escape: return {"", kind, "", "towards " + text(event.direction), "nothing is there"};
        case Kind::scatter:
            return {vertex, kind, "towards " + text(event.direction), "carrying " + text(event.throughput),
                    (event.specular ? "Dirac lobe" : fmt::format("density {:.6g}", event.pdf)) +
                        (event.survival == 1 ? ""
                                             : fmt::format(", roulette {:.6g}: {}", event.survival,
                                                           event.survived ? "goes on" : "ends"))};
        case Kind::shadow:
            return {vertex, "shadow ray", (event.blocked ? "blocked at " : "to ") + text(event.position), "",
                    event.blocked ? place(event) : "free"};
        case Kind::contribution:
            return {vertex, "+", "value " + text(event.value), "sum " + text(sum), strategy(event)};
        case Kind::splat:
            return {vertex, event.here ? "+ splat" : "splat", "value " + text(event.value),
                    event.how == Finding::other ? "" : "at " + text(event.film) + (event.here ? "" : ": elsewhere"),
                    fmt::format("{}; of path {}", strategy(event), event.path)};
        default: return {"", "= sample", "value " + text(event.value), "", event.here ? "" : "not finite: black"};
    }
}

void print_listing(const PathReplay& replayed) {
    Rgb sum(0);
    for (const PathEvent& event : replayed.events) {
        if (event.kind == Kind::contribution) sum += event.value;
        if ((event.kind == Kind::camera || event.kind == Kind::light) && &event != &replayed.events.front())
            fmt::print("\n");
        print(row(event, sum));
        if (event.kind == Kind::sample) sum = Rgb(0);
    }
    fmt::print("\nfilm {}: sample {} and splats {}\n", text(replayed.value()), text(replayed.sample),
               text(replayed.splatted));
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
               text(brightest.value), mean > 0 ? fmt::format(", {:.3g} times their mean", value / mean) : "");
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
