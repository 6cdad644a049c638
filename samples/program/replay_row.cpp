#include "replay_row.hpp"

#include <fmt/format.h>

namespace lightswitch::program {

std::string text_of(const DVec3& v) {
    const DVec3 w = v + 0.0;  // no -0
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", w.x, w.y, w.z);
}

namespace {

using Kind = PathEvent::Kind;

std::string text_of(const DVec2& v) { return fmt::format("({:.6g}, {:.6g})", v.x, v.y); }

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

}  // namespace

ReplayRow replay_row(const PathEvent& event, const Rgb& sum) {
    const std::string vertex = fmt::format("{}{}", event.of_light ? 'y' : 'z', event.vertex);
    const std::string kind(name(event.kind));
    switch (event.kind) {
        case Kind::camera:
            return {vertex, kind, "at " + text_of(event.from), "towards " + text_of(event.direction),
                    "through " + text_of(event.film) + " of the film"};
        case Kind::light:
            return {vertex, kind, "at " + text_of(event.from), "towards " + text_of(event.direction),
                    fmt::format("{}, carrying {}", event.light, text_of(event.throughput))};
        case Kind::surface:
            return {vertex, kind, "at " + text_of(event.position), "normal " + text_of(event.normal), place(event)};
        case Kind::escape: return {"", kind, "", "towards " + text_of(event.direction), "nothing is there"};
        case Kind::scatter:
            return {vertex, kind, "towards " + text_of(event.direction), "carrying " + text_of(event.throughput),
                    (event.specular ? "Dirac lobe" : fmt::format("density {:.6g}", event.pdf)) +
                        (event.survival == 1 ? ""
                                             : fmt::format(", roulette {:.6g}: {}", event.survival,
                                                           event.survived ? "goes on" : "ends"))};
        case Kind::shadow:
            return {vertex, "shadow ray", (event.blocked ? "blocked at " : "to ") + text_of(event.position), "",
                    event.blocked ? place(event) : "free"};
        case Kind::contribution:
            return {vertex, "+", "value " + text_of(event.value), "sum " + text_of(sum), strategy(event)};
        case Kind::splat:
            return {vertex, event.here ? "+ splat" : "splat", "value " + text_of(event.value),
                    event.how == Finding::other ? "" : "at " + text_of(event.film) + (event.here ? "" : ": elsewhere"),
                    fmt::format("{}; of path {}", strategy(event), event.path)};
        default: return {"", "= sample", "value " + text_of(event.value), "", event.here ? "" : "not finite: black"};
    }
}

}  // namespace lightswitch::program
