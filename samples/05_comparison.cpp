// Every method on one scene, and what sets each apart from the path tracer: 05_comparison [DIRECTORY]
//
// Writes to DIRECTORY (by default the current one), for each scene, SCENE-METHOD.png and .exr, a picture of each
// difference, and SCENE-comparison.png: the methods side by side, and beneath each its difference, which heuristic
// methods do not have. All methods get the same number of samples per pixel.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/montage.hpp>
#include <lightswitch/lightswitch.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ls = lightswitch;

namespace {

constexpr int columns = 5, image_size = 174;  // a sheet of about 900 pixels, the width of a page
constexpr int samples = 64, reference_samples = 1024;
constexpr float largest_difference = 0.5f;  // at the ends of the colour maps, the same for all

struct Entry {
    std::string name;
    ls::Kind kind;
    ls::Image image;
    ls::RenderStatistics statistics;
};

ls::LibraryDescription with_size(ls::LibraryDescription scene) {
    scene.film.width = scene.film.height = image_size;
    return scene;
}

template <class Scene, class Method>
Entry render(const Scene& scene, const Method& method, int spp, std::uint64_t seed) {
    ls::Session session(scene, method, {.seed = seed});
    session.run({.samples = spp});
    return {std::string(Method::name), Method::kind, session.image(), session.statistics()};
}

ls::Image blank() {
    ls::Image white(1, 1);
    white(0, 0) = ls::Rgb(1);
    return white;
}

ls::FalseColorOptions colors(std::string caption) {
    return {.scale = largest_difference, .caption = std::move(caption)};
}

/// The methods and the reference, `columns` in a row, and the differences below; where there is none stands, once, the
/// colour bar.
ls::Image sheet(const std::vector<Entry>& entries, const Entry& reference) {
    constexpr int letter_size = 2;
    std::vector<ls::Tile> tiles;
    bool has_bar = false;
    for (std::size_t begin = 0; begin <= entries.size(); begin += columns) {
        const std::size_t end = std::min(begin + columns, entries.size());
        std::vector<ls::Tile> differences;
        for (std::size_t i = begin; i < end; ++i) {
            const Entry& entry = entries[i];
            tiles.push_back({entry.name, entry.image});
            if (entry.kind != ls::Kind::heuristic) {
                ls::FalseColorOptions options = colors("");
                options.legend = false;
                differences.push_back(
                    {"less reference", ls::false_color(ls::difference(entry.image, reference.image), options)});
            } else if (!has_bar) {
                ls::FalseColorOptions options = colors("");
                options.letter_size = letter_size;
                differences.push_back({"W/(m^2 sr)", ls::color_bar(image_size, options)});
                has_bar = true;
            } else {
                differences.push_back({"", blank()});
            }
        }
        if (end - begin < columns) tiles.push_back({"reference", reference.image});
        while (tiles.size() % columns != 0) tiles.push_back({"", blank()});
        tiles.insert(tiles.end(), differences.begin(), differences.end());
        while (tiles.size() % columns != 0) tiles.push_back({"", blank()});
    }
    return ls::montage(tiles, {.columns = columns, .letter_size = letter_size});
}

void print_table(const std::vector<Entry>& entries, const ls::Image& reference) {
    std::printf("%-12s %-12s %6s %8s %9s %9s %11s\n", "method", "kind", "spp", "seconds", "Mrays/s", "relMSE",
                "mean ratio");
    for (const Entry& entry : entries) {
        const ls::RenderStatistics& s = entry.statistics;
        std::printf("%-12s %-12s %6d %8.2f %9.2f ", entry.name.c_str(), std::string(ls::name(entry.kind)).c_str(),
                    static_cast<int>(s.iterations), s.seconds, 1e-6 * double(s.counts.rays) / s.seconds);
        if (entry.kind == ls::Kind::heuristic)
            std::printf("%9s %11s\n", "-", "-");  // its image is no estimate of the reference
        else std::printf("%9.4f %11.4f\n", ls::relmse(entry.image, reference), ls::mean_ratio(entry.image, reference));
    }
}

template <class Scene>
void compare_methods(const Scene& scene, const std::filesystem::path& directory) {
    // Other random numbers than the methods use, or the path tracer would be compared with a part of itself.
    const Entry reference = render(scene, ls::PathTracer{}, reference_samples, 1);
    std::vector<Entry> entries;
    ls::for_each_method([&](const auto& method) { entries.push_back(render(scene, method, samples, 0)); });

    const auto file = [&](const std::string& rest) { return directory / (scene.name() + "-" + rest); };
    for (const Entry& entry : entries) {
        ls::save(file(entry.name + ".png"), entry.image);
        ls::save(file(entry.name + ".exr"), entry.image);
        if (entry.kind == ls::Kind::heuristic) continue;
        ls::save(file(entry.name + "-difference.png"), ls::false_color(ls::difference(entry.image, reference.image),
                                                                       colors(entry.name + " - path, W/(m^2 sr)")));
    }
    ls::save(file("comparison.png"), sheet(entries, reference));

    std::printf("%s, against %d samples per pixel of path:\n", scene.name().c_str(), reference_samples);
    print_table(entries, reference.image);
    std::printf("wrote %s\n\n", file("comparison.png").string().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path directory = argc > 1 ? argv[1] : ".";
    compare_methods(ls::build_scene<ls::AllBsdfs, ls::AllLights>(with_size(ls::stock::describe_still_life())),
                    directory);
    compare_methods(
        ls::build_scene<ls::DiffuseBsdfs, ls::Lights<ls::TriangleLight>>(with_size(ls::stock::describe_cornell_box())),
        directory);
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
