// Every method on one scene, and what sets each apart from the path tracer: 05_comparison [DIRECTORY]
//
// Writes to DIRECTORY (by default the current one), for each scene, SCENE-METHOD.png and .exr, a picture of each
// difference, and SCENE-comparison.png: the methods side by side, the differences beneath. All methods get the same
// number of samples per pixel.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/montage.hpp>
#include <lightswitch/lightswitch.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace ls = lightswitch;

namespace {

constexpr int image_size = 144, samples = 64, reference_samples = 1024;
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

ls::Image difference_picture(const Entry& entry, const ls::Image& reference, bool legend) {
    return ls::false_color(ls::difference(entry.image, reference),
                           {.scale = largest_difference, .legend = legend, .caption = entry.name + " - reference"});
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
    std::vector<ls::Tile> pictures, differences;
    for (const Entry& entry : entries) {
        ls::save(file(entry.name + ".png"), entry.image);
        ls::save(file(entry.name + ".exr"), entry.image);
        ls::save(file(entry.name + "-difference.png"), difference_picture(entry, reference.image, true));
        pictures.push_back({entry.name + " (" + std::string(ls::name(entry.kind)) + ")", entry.image});
        differences.push_back({entry.name + " - reference", difference_picture(entry, reference.image, false)});
    }
    pictures.insert(pictures.end(), differences.begin(), differences.end());
    ls::save(file("comparison.png"), ls::montage(pictures, {.columns = static_cast<int>(entries.size())}));

    std::printf("%s, against %d samples per pixel of path:\n", scene.name().c_str(), reference_samples);
    print_table(entries, reference.image);
    std::printf("wrote %s\n\n", file("comparison.png").string().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path directory = argc > 1 ? argv[1] : ".";
    compare_methods(
        ls::build_scene<ls::DiffuseBsdfs, ls::Lights<ls::TriangleLight>>(with_size(ls::stock::describe_cornell_box())),
        directory);
    compare_methods(ls::build_scene<ls::AllBsdfs, ls::AllLights>(with_size(ls::stock::describe_cornell_sculpture())),
                    directory);
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
