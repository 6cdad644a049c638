#pragma once

// Renders that survive: a session is written to a file, and another one goes on from there.

#include <lightswitch/embree/api.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/render/render_state.hpp>
#include <lightswitch/version.hpp>

#include <algorithm>
#include <concepts>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightswitch {

namespace detail {

template <class T>
std::string setting_text(const T& value) {
    if constexpr (std::same_as<T, bool>) return value ? "on" : "off";
    else if constexpr (std::integral<T>) return std::to_string(value);
    else {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", double(value));
        return text;
    }
}

/// The settings of a method that are known by name; those of one's own methods by `settings()`, which gives pairs of a
/// name and a value as text.
template <class M>
void add_settings(std::vector<RenderFact>& facts, const M& m) {
    const auto add = [&](const char* name, const auto& value) { facts.emplace_back(name, setting_text(value)); };
    if constexpr (requires { m.max_depth; }) add("max depth", m.max_depth);
    if constexpr (requires { m.rr_depth; }) add("rr depth", m.rr_depth);
    if constexpr (requires { m.radius.pixels; }) add("radius", m.radius.pixels);
    if constexpr (requires { m.radius.alpha; }) add("alpha", m.radius.alpha);
    if constexpr (requires { m.paths_per_pixel; }) add("photon paths", m.paths_per_pixel);
    if constexpr (requires { m.final_gather; }) add("final gather", m.final_gather);
    if constexpr (requires { m.bootstrap; }) add("bootstrap", m.bootstrap);
    if constexpr (requires { m.mutations; }) add("mutations", m.mutations);
    if constexpr (requires { m.refine; }) add("refine", m.refine);
    if constexpr (requires { m.first_training; }) add("first training", m.first_training);
    if constexpr (requires { m.training; }) add("training", m.training);
    if constexpr (requires { m.always_guide; }) add("always guide", m.always_guide);
    if constexpr (requires { m.settings(); })
        for (const auto& [name, value] : m.settings()) facts.emplace_back(name, value);
}

template <class SceneType, class M, Executor E>
std::vector<RenderFact> facts_of(const Session<SceneType, M, E>& session, std::string_view content) {
    const auto& scene = session.scene();
    const Filter filter = scene.film().filter;
    std::vector<RenderFact> facts{
        {"version", version()},
        {"Embree", RTC_VERSION_STRING},
        {"scene", std::string(scene.name())},
        {"size", std::to_string(session.film().width()) + "x" + std::to_string(session.film().height())},
        {"camera", std::string(scene.camera_id())},
        {"filter", std::string(filter.name()) + " " + setting_text(filter.radius())},
        {"method", std::string(M::name)}};
    add_settings(facts, session.method());
    facts.emplace_back("sampling", std::string(name(session.settings().sampling)));
    if (!content.empty()) facts.emplace_back("content", std::string(content));
    return facts;
}

}  // namespace detail

/// By which the session's iterations are known again. Where more than one have been made, the first of its seed is made
/// once more.
template <class SceneType, class M, Executor E>
RenderState::Trace trace_of(Session<SceneType, M, E>& session) {
    const std::uint64_t seed = session.settings().seed;
    const auto& ranges = session.made().ranges();
    const auto of_seed =
        std::find_if(ranges.begin(), ranges.end(), [&](const IterationRange& range) { return range.seed == seed; });
    if (of_seed == ranges.end()) throw Error("there is nothing to keep before the first iteration");
    const bool alone = session.film().iterations() == 1;
    return {seed, of_seed->begin, detail::checksum_of(alone ? session.film() : session.film_of(of_seed->begin))};
}

/// The state of a session, between two iterations (or in its observer). `content` is a text of what the scene holds,
/// such as a hash, by which another scene of the same name is told apart. `traces` are those that are known already.
/// Throws `Error` when nothing has been rendered, or the method keeps what cannot be written.
template <class SceneType, class M, Executor E>
RenderState state_of(Session<SceneType, M, E>& session, std::string_view content = "",
                     std::vector<RenderState::Trace> traces = {}) {
    if (std::none_of(traces.begin(), traces.end(),
                     [&](const RenderState::Trace& trace) { return trace.seed == session.settings().seed; }))
        traces.push_back(trace_of(session));
    return {.facts = detail::facts_of(session, content),
            .kind = std::string(name(M::kind)),
            .iterations = session.made(),
            .statistics = session.statistics(),
            .traces = std::move(traces),
            .method_state = session.method_state(),
            .has_history = session.has_history(),
            .film = session.film()};
}

/// Lets a session, which has rendered nothing yet, go on from a state: from then on it is what the one was that wrote
/// it, to the last bit. Throws `Error`, which names the difference, when that was of another scene, camera, size,
/// method, setting, seed, sampling or version; or when an iteration that is made again is not the same, as where the
/// scene's content differs, or Embree uses other instructions here than there.
template <class SceneType, class M, Executor E>
void resume(Session<SceneType, M, E>& session, RenderState state, std::string_view content = "") {
    if (session.film().iterations() > 0) throw Error("a session that has rendered cannot take another's place");
    const std::string difference = detail::first_difference(state.facts, detail::facts_of(session, content));
    if (!difference.empty()) throw Error("is of another render: it has " + difference);
    const std::uint64_t seed = session.settings().seed;
    const auto of_seed = std::find_if(state.traces.begin(), state.traces.end(),
                                      [&](const RenderState::Trace& trace) { return trace.seed == seed; });
    if (of_seed == state.traces.end())
        throw Error("is of another render: it has seed " + state.iterations.seeds() + ", here " + std::to_string(seed));
    if (state.has_history && state.method_state.empty())
        throw Error("is merged of several renders by " + std::string(M::name) +
                    ", whose iterations depend on those before: no render can go on from there");
    if (detail::checksum_of(session.film_of(of_seed->iteration)) != of_seed->checksum)
        throw Error("is of another render: iteration " + std::to_string(of_seed->iteration) +
                    ", made again, is not the same. The scene's content is another, or the program was built another "
                    "way, or Embree uses other instructions here than there");
    session.restore(std::move(state.film), std::move(state.iterations), std::move(state.statistics),
                    detail::ByteReader(state.method_state, "the state of " + std::string(M::name)));
}

/// Writes the state of a session to a file: see `state_of` and `save_state`.
template <class SceneType, class M, Executor E>
void save_checkpoint(Session<SceneType, M, E>& session, const std::filesystem::path& file,
                     std::string_view content = "") {
    save_state(state_of(session, content), file);
}

/// Lets a session go on from a file: see `load_state` and `resume`.
template <class SceneType, class M, Executor E>
void load_checkpoint(Session<SceneType, M, E>& session, const std::filesystem::path& file,
                     std::string_view content = "") {
    RenderState state = load_state(file);
    at_place(detail::file_origin(file), [&] { resume(session, std::move(state), content); });
}

}  // namespace lightswitch
