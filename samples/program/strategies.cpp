#include "cancellation.hpp"
#include "load.hpp"
#include "messages.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "run.hpp"
#include "text.hpp"
#include "warnings.hpp"

#include <lightswitch/compare/montage.hpp>
#include <lightswitch/film/image_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace lightswitch::program {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int gap = 8;  // pixels between tiles

/// Of the texts, for tiles of that width.
int letter_size(int width) { return std::max(1, width / 64); }
int line_height(int width) { return (glyph_height + 4) * letter_size(width); }

struct StrategyImage {
    Strategy strategy;
    Image image;

    int length() const { return strategy.light_vertices + strategy.camera_vertices - 1; }
};

/// All strategies with paths of at most `max_depth` segments, by path length and then by s. A light alone that meets
/// the lens alone (s = 1, t = 1) would see the light itself, which is left to s = 0.
std::vector<StrategyImage> all_strategies(int max_depth, bool weighted) {
    std::vector<StrategyImage> all;
    for (int length = 1; length <= max_depth; ++length)
        for (int s = 0; s <= length; ++s)
            if (const int t = length + 1 - s; s != 1 || t != 1) all.push_back({{s, t, weighted}, {}});
    return all;
}

std::filesystem::path file_of(const StrategyImage& one, const std::string& directory) {
    return std::filesystem::path(directory) /
           fmt::format("s{}_t{}.exr", one.strategy.light_vertices, one.strategy.camera_vertices);
}

/// Everything that can be known to be impossible before the work begins.
void check_outputs(const StrategiesCommand& command, const std::vector<StrategyImage>& all,
                   const SceneSummary& summary) {
    if (command.outputs.empty() && command.directory.empty())
        throw Error("nothing would be kept: name a file with --output (.png, .exr, .hdr or .pfm) or a --directory");
    Outputs outputs;
    for (const auto& output : command.outputs) outputs.add_image("--output", output);
    if (!command.directory.empty())
        for (const StrategyImage& one : all) outputs.add_image("--directory", file_of(one, command.directory));
    outputs.refuse_inputs(summary.files);
    if (command.outputs.empty()) return;
    const Size& size = summary.size;
    const long long columns = command.max_depth + 1, rows = command.max_depth, line = line_height(size.width);
    try {
        Image::check_size(columns * (size.width + gap) + gap, rows * (size.height + line + gap) + gap + 2 * line);
    } catch (const Error& error) {
        throw Error(fmt::format("the picture would be too large ({}); a smaller --size or --max-depth makes it smaller",
                                error.what()));
    }
}

/// The exposure at which one percent of the values, the largest channel of each pixel of each image, is white. 0 stops
/// where there is nothing to see.
float common_exposure(const std::vector<StrategyImage>& all) {
    std::vector<float> values;
    for (const StrategyImage& one : all)
        for (const Rgb& pixel : one.image.pixels())
            if (const float value = max_component(pixel); value > 0) values.push_back(value);
    if (values.empty()) return 0;
    const std::size_t total = all.size() * all[0].image.pixels().size();
    const std::size_t white = std::min(total / 100, values.size() - 1);
    const auto at = values.end() - 1 - static_cast<std::ptrdiff_t>(white);
    std::nth_element(values.begin(), at, values.end());
    return -std::log2(*at);
}

/// A row for every path length, each centred, and below them what they are.
Image pyramid(const std::vector<StrategyImage>& all, float exposure, int samples) {
    std::vector<Image> rows;
    for (std::size_t begin = 0; begin < all.size();) {
        std::vector<Tile> tiles;
        const int length = all[begin].length();
        for (; begin < all.size() && all[begin].length() == length; ++begin) {
            const Strategy& strategy = all[begin].strategy;
            tiles.push_back({fmt::format("s={} t={}", strategy.light_vertices, strategy.camera_vertices),
                             all[begin].image, exposure});
        }
        rows.push_back(montage(tiles, {.columns = static_cast<int>(tiles.size()),
                                       .gap = gap,
                                       .letter_size = letter_size(tiles[0].image.width())}));
    }
    const int pitch = rows[0].height() - gap;  // neighbours share the gap between them
    const std::string texts[] = {"s vertices from a light, t from the camera; a row per path length",
                                 fmt::format("{}, exposure {:+.2f} stops, {} samples per pixel",
                                             all[0].strategy.weighted ? "weighted" : "unweighted", exposure, samples)};
    const int dot = letter_size(all[0].image.width()), line = line_height(all[0].image.width());
    int width = rows.back().width(), top = pitch * static_cast<int>(rows.size()) + gap;
    for (const std::string& text : texts) width = std::max(width, text_width(text, dot) + 2 * gap);
    Image sheet(width, top + 2 * line);
    fill_rectangle(sheet, 0, 0, sheet.width(), sheet.height(), Rgb(1));
    for (std::size_t i = 0; i < rows.size(); ++i)
        paste(sheet, (width - rows[i].width()) / 2, pitch * static_cast<int>(i), rows[i]);
    for (const std::string& text : texts) {
        draw_text(sheet, (width - text_width(text, dot)) / 2, top, text, srgb(20, 20, 20), dot);
        top += line;
    }
    return sheet;
}

/// The largest difference between the sum of the images and `whole`, over the mean of `whole`.
double largest_difference(const std::vector<StrategyImage>& all, const Image& whole) {
    double largest = 0;
    for (std::size_t i = 0; i < whole.pixels().size(); ++i) {
        DVec3 difference = -DVec3(whole.pixels()[i]);
        for (const StrategyImage& one : all) difference += DVec3(one.image.pixels()[i]);
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(difference[c]));
    }
    const DVec3 mean = whole.mean();
    return largest > 0 ? largest * 3 / (mean.x + mean.y + mean.z) : 0;
}

}  // namespace

int strategies(const StrategiesCommand& command) {
    std::vector<StrategyImage> all = all_strategies(command.max_depth, !command.unweighted);
    SceneOptions scene_options = command.scene;
    if (!scene_options.size) scene_options.shrink_to = 128;
    const LoadedScene loaded = load_scene(scene_options, command.quiet);
    check_outputs(command, all, loaded.summary);
    warn_about_scene(loaded, Bdpt::name);

    const Cancellation cancellation;
    ProgressLine line(!command.quiet);
    const PathLength length = path_length(loaded.summary, command.max_depth, {});
    const Bdpt method{.max_depth = length.max_depth, .rr_depth = length.rr_depth};
    const auto begin = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    RenderCounts counts;
    const auto render_one = [&](const Bdpt& bdpt, const std::string& what) {
        Job job;
        job.budget.samples = command.samples;
        job.settings.seed = command.seed;
        job.settings.threads = command.threads;
        job.settings.stop = cancellation.token();
        job.progress = [&](const Progress& progress, std::uint64_t) {
            line.update(seconds(), fmt::format("{}: {:.0f} %", what, 100 * progress.fraction));
        };
        Rendered rendered = run(loaded.scene, bdpt, job);
        counts = rendered.statistics.counts;
        return std::move(rendered.image);
    };
    // Every strategy is a render with the same random numbers, so that their sum is the image but for rounding.
    for (std::size_t i = 0; i < all.size() && !cancellation.token().stop_requested(); ++i) {
        Bdpt one = method;
        one.only = all[i].strategy;
        all[i].image = render_one(one, fmt::format("strategy {} of {}, s={} t={}", i + 1, all.size(),
                                                   one.only->light_vertices, one.only->camera_vertices));
        all[i].image.metadata["strategy"] =
            fmt::format("s={} t={}, {}", one.only->light_vertices, one.only->camera_vertices,
                        command.unweighted ? "unweighted" : "weighted");
    }
    Image whole;
    if (!cancellation.token().stop_requested()) whole = render_one(method, "all strategies together");
    line.clear();
    if (cancellation.token().stop_requested()) {
        print_note("cancelled before all strategies were done: nothing is written");
        return Status::cancelled;
    }
    warn_about_values(counts, whole);

    const float exposure = common_exposure(all);
    std::string written;
    const auto keep = [&](const std::filesystem::path& file, const Image& image) {
        write_image(file, image);
        written += (written.empty() ? "; wrote " : ", ") + file.string();
    };
    if (!command.outputs.empty()) {
        const Image sheet = pyramid(all, exposure, command.samples);
        for (const auto& output : command.outputs) keep(output, sheet);
    }
    if (!command.directory.empty()) {
        for (const StrategyImage& one : all) write_image(file_of(one, command.directory), one.image);
        written += fmt::format("{}{} images in {}", written.empty() ? "; wrote " : ", ", all.size(), command.directory);
    }
    if (command.quiet) return success;
    fmt::print("{} strategies, {} samples per pixel each, in {:.3g} s; exposure {:+.2f} stops{}\n", all.size(),
               command.samples, seconds(), exposure, written);
    if (command.unweighted)
        fmt::print("unweighted: not to be added up, as each may hold all light of its path length\n");
    else
        fmt::print("the sum of all strategies is the image of bdpt: the largest difference is {:.2g} of the mean\n",
                   largest_difference(all, whole));
    return success;
}

}  // namespace lightswitch::program
