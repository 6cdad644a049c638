#pragma once

// Renders as files: what has been made so far, from which they go on or which is merged with what others have made.

#include <lightswitch/core/file.hpp>
#include <lightswitch/render/archive.hpp>
#include <lightswitch/render/iterations.hpp>
#include <lightswitch/render/packing.hpp>
#include <lightswitch/render/settings.hpp>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightswitch {

/// The name of something that a render is made of, and its value as text.
using RenderFact = std::pair<std::string, std::string>;

/// A render between two iterations.
struct RenderState {
    /// Of what the image is a function besides the iterations. Renders that go on from one another, or merge, agree.
    std::vector<RenderFact> facts;
    std::string kind;
    IterationSet iterations;
    RenderStatistics statistics;
    /// Of one iteration of each seed, by which it is known again: seed, iteration and the sums of its film.
    struct Trace {
        std::uint64_t seed = 0, iteration = 0, checksum = 0;
        void keep(auto& archive) { archive(seed, iteration, checksum); }
    };
    std::vector<Trace> traces;
    /// What the method keeps, and whether that is needed to go on.
    std::string method_state;
    bool has_history = false;
    Film film;

    std::string fact(std::string_view name) const {
        for (const RenderFact& fact : facts)
            if (fact.first == name) return fact.second;
        return {};
    }

    /// As of `Session::image()`.
    Image image() const {
        Image result = film.image();
        result.metadata = {{"method", fact("method")},
                           {"kind", kind},
                           {"scene", fact("scene")},
                           {"camera", fact("camera")},
                           {"samples", std::to_string(film.iterations())},
                           {"seconds", std::to_string(statistics.seconds)},
                           {"seed", iterations.seeds()},
                           {"sampling", fact("sampling")}};
        if (statistics.counts.non_finite > 0)
            result.metadata["non_finite"] = std::to_string(statistics.counts.non_finite);
        return result;
    }
};

namespace detail {

/// In words, how one render differs from another; empty when it does not.
inline std::string first_difference(const std::vector<RenderFact>& theirs, const std::vector<RenderFact>& ours) {
    for (const RenderFact& fact : ours) {
        const auto found =
            std::find_if(theirs.begin(), theirs.end(), [&](const RenderFact& f) { return f.first == fact.first; });
        const std::string value = found == theirs.end() ? "nothing" : found->second;
        if (value != fact.second) return fact.first + " " + value + ", here " + fact.second;
    }
    for (const RenderFact& fact : theirs)
        if (std::none_of(ours.begin(), ours.end(), [&](const RenderFact& f) { return f.first == fact.first; }))
            return fact.first + " " + fact.second + ", here nothing";
    return {};
}

inline std::uint64_t checksum_of(const Film& film) {
    Checksum sum;
    for (const PixelSums& pixel : film.sums())
        for (std::size_t i = 0; i < PixelSums::bins; ++i) sum.mix(static_cast<std::uint64_t>(pixel.bin(i)));
    for (const PixelSums::Windows& windows : film.windows())
        sum.mix(static_cast<std::uint64_t>(windows.of[0] * 256 + windows.of[1]));
    return sum.value();
}

/// Lists of pairs or triples, as so many lists.
template <class T, class... Member>
void keep_columns(auto& archive, std::vector<T>& rows, Member T::*... members) {
    const auto keep_one = [&]<class Value>(Value T::*member) {
        std::vector<Value> column;
        for (T& row : rows) column.push_back(std::move(row.*member));
        archive(column);
        rows.resize(column.size());
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*member = std::move(column[i]);
    };
    (keep_one(members), ...);
}

/// Whether they are written or read: all but the sums of the film.
inline void keep_all_but_film(auto& archive, RenderState& state, std::uint32_t& width, std::uint32_t& height) {
    using Value = std::pair<std::string, double>;
    RenderCounts& counts = state.statistics.counts;
    std::vector<IterationRange> ranges = state.iterations.ranges();
    keep_columns(archive, state.facts, &RenderFact::first, &RenderFact::second);
    keep_columns(archive, ranges, &IterationRange::seed, &IterationRange::begin, &IterationRange::end);
    keep_columns(archive, state.statistics.of_method, &Value::first, &Value::second);
    keep_columns(archive, counts.first_non_finite, &NonFinite::iteration, &NonFinite::seed, &NonFinite::pixel);
    archive(counts.rays, counts.shadow_rays, counts.paths, counts.splats, counts.non_finite, state.statistics.seconds,
            state.kind, state.traces, state.method_state, state.has_history, width, height);
    state.iterations = IterationSet(std::move(ranges));
    state.statistics.iterations = state.iterations.count();
}

inline constexpr std::string_view state_magic = "lightswitch state\n";
inline constexpr std::uint32_t state_format = 2;
inline constexpr std::uintmax_t most_state_bytes = std::uintmax_t(1) << 36;

/// What remains of the bytes of a whole file between the header and the checksum. Throws `Error` for a file of another
/// kind, of another version of the format, or that is damaged.
inline std::string_view checked_body(std::string_view bytes, const Origin& where) {
    constexpr std::size_t head = state_magic.size() + 12, tail = 8;
    if (!bytes.starts_with(state_magic.substr(0, std::min(bytes.size(), state_magic.size()))) || bytes.empty())
        fail(where, "is not the state of a render");
    if (bytes.size() >= head) {
        const auto format = get_little_endian<std::uint32_t>(bytes.data() + state_magic.size());
        if (format != state_format)
            fail(where, "is the state of a render in format " + std::to_string(format) + ", and this version reads " +
                            std::to_string(state_format));
    }
    if (bytes.size() < head + tail ||
        get_little_endian<std::uint64_t>(bytes.data() + state_magic.size() + 4) != bytes.size())
        fail(where, "is cut off or damaged: nothing can be taken from it");
    const std::string_view summed = bytes.substr(0, bytes.size() - tail);
    if (Checksum::of(summed) != get_little_endian<std::uint64_t>(bytes.data() + summed.size()))
        fail(where, "is damaged (its checksum is wrong): nothing can be taken from it");
    return summed.substr(head);
}

/// A state as the bytes of a file.
inline std::string bytes_of(const RenderState& state) {
    RenderState kept{.facts = state.facts,
                     .kind = state.kind,
                     .iterations = state.iterations,
                     .statistics = state.statistics,
                     .traces = state.traces,
                     .method_state = state.method_state,
                     .has_history = state.has_history,
                     .film = Film(1, 1)};
    std::string bytes(state_magic);
    put_little_endian(bytes, state_format);
    const std::size_t size_at = bytes.size();
    put_little_endian(bytes, std::uint64_t{0});
    ArchiveWriter writer(bytes);
    auto width = static_cast<std::uint32_t>(state.film.width()),
         height = static_cast<std::uint32_t>(state.film.height());
    keep_all_but_film(writer, kept, width, height);
    pack_film(bytes, state.film);
    std::string size;
    put_little_endian(size, static_cast<std::uint64_t>(bytes.size() + 8));
    bytes.replace(size_at, size.size(), size);
    put_little_endian(bytes, Checksum::of(bytes));
    return bytes;
}

/// The state that those bytes are, which come from `where`. Throws `Error` when they are no state, or are damaged in
/// any way.
inline RenderState state_from(std::string_view bytes, const Origin& where) {
    ByteReader in(checked_body(bytes, where), where.file);
    ArchiveReader reader(in);
    RenderState state{.facts = {},
                      .kind = {},
                      .iterations = {},
                      .statistics = {},
                      .traces = {},
                      .method_state = {},
                      .film = Film(1, 1)};
    std::uint32_t width = 0, height = 0;
    return at_place(where, [&] {
        keep_all_but_film(reader, state, width, height);
        Image::check_size(width, height);
        state.film = Film(static_cast<int>(width), static_cast<int>(height));
        unpack_film(in, state.film, state.iterations.count());
        return std::move(state);
    });
}

}  // namespace detail

/// Writes a state so that the file is either as it was or complete, also after a power failure. Throws `Error` as
/// `write_file_atomically` does.
inline void save_state(const RenderState& state, const std::filesystem::path& file) {
    write_file_durably(file, detail::bytes_of(state));
}

/// Reads a state. Throws `Error` when there is no such file, it is no state, or it is damaged in any way.
inline RenderState load_state(const std::filesystem::path& file) {
    const FileBytes bytes(file, detail::most_state_bytes);
    return detail::state_from(bytes.view(), detail::file_origin(file));
}

/// Adds the iterations of another render of the same image: the result is, to the last bit, that of a render of all of
/// them. Of methods whose iterations depend on those before it cannot go on. Throws `Error` when the two differ in
/// anything but seed and iterations, or share an iteration.
inline void merge(RenderState& state, RenderState&& other) {
    const std::string difference = detail::first_difference(other.facts, state.facts);
    if (!difference.empty()) throw Error("is of another render: it has " + difference);
    IterationSet iterations = state.iterations;
    iterations.merge(other.iterations);
    state.film.merge(other.film);
    state.iterations = std::move(iterations);
    for (const RenderState::Trace& trace : other.traces)
        if (std::none_of(state.traces.begin(), state.traces.end(),
                         [&](const RenderState::Trace& t) { return t.seed == trace.seed; }))
            state.traces.push_back(trace);
    state.method_state.clear();
    state.statistics.iterations = state.iterations.count();
    state.statistics.seconds += other.statistics.seconds;
    state.statistics.of_method.clear();
    RenderCounts& counts = state.statistics.counts;
    const RenderCounts& more = other.statistics.counts;
    counts.rays += more.rays;
    counts.shadow_rays += more.shadow_rays;
    counts.paths += more.paths;
    counts.splats += more.splats;
    counts.non_finite += more.non_finite;
    auto& first = counts.first_non_finite;
    for (const NonFinite& found : more.first_non_finite) {
        const auto before = [](const NonFinite& a, const NonFinite& b) {
            return std::pair(a.seed, a.iteration) < std::pair(b.seed, b.iteration);
        };
        first.insert(std::upper_bound(first.begin(), first.end(), found, before), found);
    }
    first.resize(std::min(first.size(), detail::max_noted));
}

}  // namespace lightswitch
