#include "cancellation.hpp"
#include "messages.hpp"
#include "outputs.hpp"
#include "program.hpp"

#include <lightswitch/film/tonemap.hpp>
#include <lightswitch/render/render_state.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lightswitch::program {

int merge(const MergeOptions& options) {
    if (options.states.empty()) throw Error("merge: name the states of renders (--checkpoint) that are to be merged");
    if (options.outputs.empty() && options.checkpoint.empty())
        throw Error("nothing would be kept: name a file with --output (.png, .exr, .hdr or .pfm) or --checkpoint");
    Outputs outputs;
    for (const auto& output : options.outputs) outputs.add_image("--output", output);
    outputs.add_file("--checkpoint", options.checkpoint);
    outputs.refuse_inputs(options.states);

    RenderState all = load_state(options.states.front());
    for (std::size_t i = 1; i < options.states.size(); ++i) {
        const auto& file = options.states[i];
        RenderState more = load_state(file);
        at_place(detail::file_origin(file), [&] { lightswitch::merge(all, std::move(more)); });
    }
    const Image image = all.image();
    std::optional<float> exposure;
    if (std::any_of(options.outputs.begin(), options.outputs.end(), is_picture))
        exposure = options.exposure ? *options.exposure : auto_exposure(image);
    if (!options.checkpoint.empty()) {
        const Uninterrupted writing;
        save_state(all, options.checkpoint);
    }
    for (const auto& output : options.outputs) write_image(output, image, {.exposure = exposure.value_or(0)});
    if (options.quiet) return success;
    std::string text = fmt::format("{} ({}): {} samples per pixel of {} states (iterations {}) in {:.3f} s",
                                   all.fact("method"), all.kind, all.film.iterations(), options.states.size(),
                                   all.iterations.text(), all.statistics.seconds);
    if (const double error = all.film.relative_error(); std::isfinite(error))
        text += fmt::format(", estimated error {:.2g} %", 100 * error);
    if (exposure) text += fmt::format(", exposure {:.4g} stops", *exposure);
    std::vector<std::string> written;
    for (const auto& output : options.outputs) written.push_back(output.string());
    if (!options.checkpoint.empty()) written.push_back(options.checkpoint.string());
    fmt::print("{}; wrote {}\n", text, fmt::join(written, ", "));
    return success;
}

}  // namespace lightswitch::program
