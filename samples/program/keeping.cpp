#include "keeping.hpp"

#include "cancellation.hpp"
#include "messages.hpp"

#include <lightswitch/render/packing.hpp>

#include <fmt/format.h>

namespace lightswitch::program {

std::string content_of(const SceneOptions& options, const SceneSummary& summary) {
    constexpr std::uintmax_t any_size = ~std::uintmax_t{0};
    detail::Checksum sum;
    const auto mix = [&](std::string_view text) { sum.mix(detail::Checksum::of(text)); };
    for (const auto& file : summary.files) mix(FileBytes(file, any_size).view());
    if (summary.files.empty()) mix(options.scene);
    for (const auto& [name, value] : options.defines) mix(name), mix(value);
    mix(options.sensor);
    mix(options.build.robust ? "robust" : "");
    mix(options.lenient ? "lenient" : "");
    return fmt::format("{:016x}", sum.value());
}

Span span_of(const RenderOptions& options, const Budget& budget, const AnyMethod& method) {
    if (!options.share) return {0, budget.samples};
    const Share share = *options.share;
    if (options.checkpoint.empty())
        throw Error(
            "--part: name the file that is to hold the share with --checkpoint; \"lightswitch merge\" joins them");
    if (budget.samples == 0 || budget.error > 0)
        throw Error("--part: shares are of a number of samples: give --spp, the same for all, and no --error");
    if (has_history(method))
        throw Error(
            fmt::format("--part: each iteration of {} goes on from the one before; give every machine its own "
                        "--seed and all of the samples instead, and merge these",
                        method_name(method)));
    const auto bound = [&](int n) {
        return static_cast<std::uint64_t>(budget.samples) * static_cast<std::uint64_t>(n) /
               static_cast<std::uint64_t>(share.of);
    };
    const std::uint64_t begin = bound(share.number - 1), end = bound(share.number);
    if (begin == end)
        throw Error(fmt::format("--part: {} samples in {} shares leave none for number {}", budget.samples, share.of,
                                share.number));
    return {begin, static_cast<int>(end - begin)};
}

Checkpoint::Checkpoint(const RenderOptions& options, const Span& span)
    : file_(options.checkpoint), now_(options.checkpoint.empty() ? 0 : options.every) {
    if (file_.empty()) return;
    remove_leftovers(file_);
    for (const auto& output : options.outputs) remove_leftovers(output);
    if (!std::filesystem::exists(file_)) return;
    from_ = load_state(file_);
    const auto refuse = [&](const std::string& why) {
        throw Error(fmt::format("--checkpoint: {}: {}; name another file, or remove this one", file_.string(), why));
    };
    const std::uint64_t end =
        span.samples > 0 ? span.begin + static_cast<std::uint64_t>(span.samples) : ~std::uint64_t{0};
    for (const IterationRange& range : from_->iterations.ranges())
        if (range.begin < span.begin || range.end > end)
            refuse(fmt::format("it holds iterations {}, and {} {} to {}", from_->iterations.text(),
                               options.share ? fmt::format("--part {}/{} is", options.share->number, options.share->of)
                                             : "asked for are",
                               span.begin, end - 1));
    written_ = from_->film.iterations();
    rays_before_ = from_->statistics.counts.rays;
    if (span.samples > 0 && written_ > static_cast<std::uint64_t>(span.samples))
        refuse(
            fmt::format("it holds {} samples per pixel, more than the {} that are asked for", written_, span.samples));
    if (!options.quiet)
        print_note(fmt::format("goes on from {}: {} samples per pixel, {:.1f} s", file_.string(), written_,
                               from_->statistics.seconds));
}

bool Checkpoint::write(const Halt& halt) {
    try {
        const Uninterrupted writing;
        save_state(halt.state(), file_);
        written_ = halt.statistics.iterations;
        failure_.clear();
    } catch (const Error& error) {
        failure_ = fmt::format("--checkpoint: {}", error.what());
    }
    now_.done();
    return failure_.empty();
}

void Checkpoint::observe(const Halt& halt) {
    if (!now_.due()) return;
    const bool failed_before = !failure_.empty();
    if (!write(halt) && !failed_before)
        print_warning(fmt::format("{}; the render goes on, and so does the trying", failure_));
}

void Checkpoint::end(const Halt& halt) {
    if (!file_.empty() && halt.statistics.iterations > written_) write(halt);
}

void Checkpoint::complain() const {
    if (!failure_.empty()) throw Error(failure_);
}

}  // namespace lightswitch::program
