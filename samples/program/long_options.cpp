#include "options.hpp"
#include "values.hpp"

namespace lightswitch::program {
namespace {

Share parse_share(std::string_view text) {
    const std::size_t slash = text.find('/');
    try {
        if (slash == std::string_view::npos) throw Error("");
        const int of = parse_int("", text.substr(slash + 1), 1, 1 << 24);
        return {parse_int("", text.substr(0, slash), 1, of), of};
    } catch (const Error&) {
        throw Error(fmt::format("--part: \"{}\" is not K/N with K from 1 to N, such as 3/8", text));
    }
}

}  // namespace

void add_long_options(CLI::App& app, RenderOptions& options) {
    const auto seconds = [&](const std::string& name, double& target, const std::string& help) {
        add_value(
            app, name, "S",
            [&target, name](const std::string& text) { target = parse_number_option(name, text, 0, true); }, help)
            ->group("Long renders");
    };
    add_value(
        app, "--checkpoint", "FILE.lsw",
        [&](const std::string& text) {
            if (text.empty()) throw Error("--checkpoint: the name is empty");
            options.checkpoint = text;
        },
        "the render's state: written while it goes on and at its end. Where\nthere is one, the render goes on from it: "
        "the same command after\na kill, or with a larger --spp")
        ->group("Long renders");
    seconds("--every", options.every, "seconds between two writings of the checkpoint (default: 60)");
    seconds("--write-every", options.write_every, "write the images every so many seconds, too (default: at the end)");
    add_value(
        app, "--part", "K/N", [&](const std::string& text) { options.share = parse_share(text); },
        "only the K-th of N shares of the samples, to --checkpoint;\n\"lightswitch merge\" joins them. Started by "
        "mpirun, the processes\n"
        "share one render without it")
        ->group("Long renders");
}

void add_merge(CLI::App& app, MergeOptions& options) {
    app.add_option("STATES", options.states,
                   "states of renders of one image (render --checkpoint), which share\nno iteration of a seed")
        ->type_name("");
    add_outputs(app, options.outputs, "image to write: .exr, .pfm, .hdr or .png; may be repeated");
    add_value(
        app, "--checkpoint", "FILE.lsw",
        [&](const std::string& text) {
            if (text.empty()) throw Error("--checkpoint: the name is empty");
            options.checkpoint = text;
        },
        "write the merged state, from which \"render --checkpoint\" can go on");
    add_value(
        app, "--exposure", "STOPS",
        [&](const std::string& text) {
            options.exposure = parse_float("--exposure", text, std::numeric_limits<double>::lowest(), false);
        },
        "brightness of .png: radiance times 2^STOPS (default: what the image\nshows on average is a middle grey)");
    app.add_flag("-q,--quiet", options.quiet, "no summary");
    app.footer(
        "The merged image is, to the last bit, that of one render of all the iterations. States of another scene,\n"
        "camera, size, method, setting, sampler or version are refused, and so are those that share an iteration.\n"
        "Different seeds may be merged; of mlt, whose iterations go on from one another, that is the way, and the\n"
        "result cannot be continued. Layers (--aov) are not in states: a render that goes on from the merged one\n"
        "writes them.\n\n"
        "Examples:\n"
        "  lightswitch render room.xml --spp 1000 --part 1/2 --checkpoint a.lsw     (on one machine)\n"
        "  lightswitch render room.xml --spp 1000 --part 2/2 --checkpoint b.lsw     (on another)\n"
        "  lightswitch merge a.lsw b.lsw --output room.exr --checkpoint room.lsw");
}

}  // namespace lightswitch::program
