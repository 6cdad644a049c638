// Every method at equal time: what is left of its error, and how soon it is as good as the baseline, path-nee.
//
//   methods [--seconds S] [--seeds N] [--size N] [--reference-seconds R] [--cache DIR] [--output DIR] [SCENE...]
//
// --help says what the options mean and how the figures are made.

#include <lightswitch/compare/montage.hpp>
#include <lightswitch/compiled.hpp>
#include <lightswitch/lightswitch.hpp>
#include <lightswitch/sweep/sweep_text.hpp>
#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/mitsuba.hpp>
#endif

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace ls = lightswitch;

constexpr char help[] =
    R"(methods [OPTION VALUE]... [SCENE...]: every method that is not heuristic on every scene at equal time

  --seconds S            for each method on each scene (5)
  --seeds N              independent images of each method (1); errors and means are those of all of them
  --size N               width and height of the images in pixels (128)
  --reference-seconds R  for the reference of each scene (60)
  --cache DIR            keep the references there, and take those of an earlier run; delete them when scenes have
                         changed
  --output DIR           write methods-at-equal-time.png there: the images, one row for each scene
  SCENE                  a stock scene, point-light-box, or a Mitsuba 3 file that ends in .xml;
                         by default cornell-box, cornell-spheres, ajar-door and point-light-box

One thread; seconds are the processor time of the program. The methods of a scene advance in turn, each time until all
have had twice as much (`sweep/sweep.hpp`, as `lightswitch sweep`).

Reference: half of its time goes to bdpt, half to path-nee, each with 8 images of other seeds. The halves are joined
with weights in inverse proportion to their variances over the whole image. Whether they agree is printed: the ratio of
their means, and the largest difference among 4 x 4 tiles, in standard deviations. Up to 3 is chance; above 4 the halves
disagree, or one of them rests on a few rare bright paths.

relMSE:  mean over pixels and channels of (x - r)^2 / (r^2 + 0.01), nothing trimmed, less the part that the reference's
         own noise makes, which the spread of its 16 images tells. Below a tenth of that part only a bound is printed
         (<).
tiles:   the median of the relMSE of 8 x 8 tiles, which single bright pixels do not move.
mean:    of the image, over that of the reference: below 1 where there is light that the method cannot find.
time:    after which the relMSE stays below that of path-nee at the end, as a fraction of path-nee's time; looked at
         each time it has doubled, and interpolated between the logarithms. < if it was below from the first look on,
         - if never.
)";

using Baseline = ls::PathTracerNee;
constexpr std::size_t replicas = 8;

struct Options {
    double seconds = 5, reference_seconds = 60;
    int size = 128, seeds = 1;
    std::string cache, output;
    std::vector<std::string> scenes;
};

// ---- scenes
// ------------------------------------------------------------------------------------------------------------------

/// The Cornell box lit by a point under its lamp.
ls::LibraryDescription describe_point_light_box() {
    ls::LibraryDescription scene = ls::stock::describe_cornell_box();
    scene.name = "point-light-box";
    for (auto& shape : scene.shapes) shape.emission.reset();
    scene.add(ls::PointSource{{0.3, 0.6, 0.4}, ls::Rgb(1.2f, 1.0f, 0.7f)});
    return scene;
}

ls::FullScene build(const std::string& name, int size) {
    std::optional<ls::LibraryDescription> scene = ls::stock::describe(name);
    if (name == "point-light-box") scene = describe_point_light_box();
#if __has_include(<pugixml.hpp>)
    if (name.ends_with(".xml")) {
        scene = ls::load_mitsuba(name);
        scene->name = std::filesystem::path(name).stem().string();
    }
#endif
    if (!scene) throw ls::Error("there is no scene \"" + name + "\"; --help lists what there is");
    scene->film.width = scene->film.height = size;
    return ls::build_scene<ls::AllBsdfs, ls::AllLights>(*scene);
}

// ---- the measurement
// ---------------------------------------------------------------------------------------------------------

/// Eight images of other seeds, those of an earlier run if they are kept: one below the other.
template <class Method>
std::vector<ls::Image> reference_images(const ls::FullScene& scene, const Method& method, const Options& options) {
    char text[64];
    std::snprintf(text, sizeof text, "-%d-%gs.pfm", options.size, options.reference_seconds);
    const auto file = std::filesystem::path(options.cache) / (scene.name() + "-" + std::string(Method::name) + text);
    const int size = options.size, count = static_cast<int>(replicas);
    std::vector<ls::Image> images;
    if (!options.cache.empty() && std::filesystem::exists(file)) {
        const ls::Image sheet = ls::load_image(file);
        if (sheet.width() != size || sheet.height() != count * size)
            throw ls::Error(file.string() + " has another size than the reference: delete it");
        for (int i = 0; i < count; ++i) {
            ls::Image& image = images.emplace_back(size, size);
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) image(x, y) = sheet(x, i * size + y);
        }
        return images;
    }
    if (!options.cache.empty()) ls::check_writable(file);
    std::array<std::uint64_t, replicas> seeds{};
    std::iota(seeds.begin(), seeds.end(), std::uint64_t{1000});
    images = ls::independent_images(ls::contender(scene, method), {.threads = 1}, ls::TimeOf::processor,
                                    options.reference_seconds / (2 * double(replicas)), seeds);
    if (options.cache.empty()) return images;
    ls::Image sheet(size, count * size);
    for (int i = 0; i < count; ++i) ls::paste(sheet, 0, i * size, images[static_cast<std::size_t>(i)]);
    ls::save(file, sheet);
    return images;
}

/// The time after which the error stays at or below that of the baseline at the end, as text: a fraction of its time.
std::string time_as_fraction(const ls::SweptMethod& method, const ls::SweptMethod& baseline) {
    const auto time = method.seconds_to(baseline.last.error());
    if (!time) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%s%.3f", time->at_most ? "<" : "", time->seconds / baseline.last.seconds);
    return text;
}

/// Prints the table of one scene; returns its row of the montage.
std::vector<ls::Tile> compare_methods(const ls::FullScene& scene, const Options& options) {
    std::printf("\n%s\n", scene.name().c_str());
    ls::Reference reference =
        ls::join(reference_images(scene, ls::Bdpt{}, options), reference_images(scene, Baseline{}, options));
    reference.first = ls::Bdpt::name;
    reference.second = Baseline::name;
    std::printf(
        "reference: relMSE of its own %.2e; its halves: ratio of means %.4f (%.1f deviations), worst tile %.1f%s\n",
        reference.relmse, reference.ratio, reference.deviations, reference.worst_tile,
        reference.consistent() ? "" : "  <- above 4: ask `lightswitch verify`");

    const std::vector<ls::Contender> contenders = ls::all_contenders(scene);
    const ls::Sweep sweep =
        ls::sweep(contenders, std::move(reference),
                  {.seconds = options.seconds, .seeds = options.seeds, .clock = ls::TimeOf::processor, .threads = 1});
    const ls::SweptMethod& baseline = *sweep.find(Baseline::name);
    const double brightness = ls::detail::sum_of(sweep.reference.image.mean()) / 3;
    const float exposure =
        brightness > 0 ? std::clamp(static_cast<float>(std::log2(0.3 / brightness)), -20.0f, 20.0f) : 0;
    std::vector<ls::Tile> row{{scene.name(), sweep.reference.image, exposure}};
    std::printf("%-12s %10s %9s %10s %10s %8s %8s\n", "method", "iterations", "Mrays/s", "relMSE", "tiles", "mean",
                "time");
    for (const ls::SweptMethod& m : sweep.methods) {
        const std::string error = ls::detail::error_text(m.last.error(), sweep.least_error());
        std::printf("%-12s %10llu %9.2f %10s %10.3g %8.4f %8s\n", m.name.c_str(),
                    static_cast<unsigned long long>(m.last.iterations), 1e-6 * m.rays_per_second, error.c_str(),
                    m.typical, 1 + m.bias, time_as_fraction(m, baseline).c_str());
        row.push_back({m.name + " " + error, m.image, exposure});
    }
    std::fflush(stdout);
    return row;
}

// ---- the command line
// --------------------------------------------------------------------------------------------------------

double number(const std::string& option, const std::string& text, double low, double high) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != 0 || !(value >= low && value <= high)) {
        char range[64];
        std::snprintf(range, sizeof range, " needs a number from %g to %g", low, high);
        throw ls::Error(option + range + ", not \"" + text + "\"");
    }
    return value;
}

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& option = arguments[i];
        if (!option.starts_with("--")) {
            options.scenes.push_back(option);
            continue;
        }
        const std::string value = i + 1 < arguments.size() ? arguments[i + 1] : "";
        if (option == "--seconds") options.seconds = number(option, value, 1e-3, 1e6);
        else if (option == "--reference-seconds") options.reference_seconds = number(option, value, 1e-3, 1e6);
        else if (option == "--seeds") options.seeds = static_cast<int>(number(option, value, 1, 1000));
        else if (option == "--size") options.size = static_cast<int>(number(option, value, 8, 2048));
        else if (option == "--cache") options.cache = value;
        else if (option == "--output") options.output = value;
        else throw ls::Error("there is no option " + option + "; --help lists what there is");
        if (value.empty()) throw ls::Error(option + " needs a value");
        ++i;
    }
    if (options.scenes.empty()) options.scenes = {"cornell-box", "cornell-spheres", "ajar-door", "point-light-box"};
    return options;
}

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (std::find(arguments.begin(), arguments.end(), "--help") != arguments.end()) {
        std::fputs(help, stdout);
        return 0;
    }
    const Options options = parse(arguments);
    if (!options.cache.empty()) std::filesystem::create_directories(options.cache);
    const auto file = std::filesystem::path(options.output) / "methods-at-equal-time.png";
    if (!options.output.empty()) {
        std::filesystem::create_directories(options.output);
        ls::check_writable(file);
    }

    std::printf("%g s for each method, %d x %d pixels, references of %g s\n", options.seconds, options.size,
                options.size, options.reference_seconds);
    std::fflush(stdout);
    std::vector<ls::Tile> tiles;
    int columns = 0;
    for (const std::string& name : options.scenes) {
        const std::vector<ls::Tile> row = compare_methods(build(name, options.size), options);
        columns = static_cast<int>(row.size());
        tiles.insert(tiles.end(), row.begin(), row.end());
    }
    if (!options.output.empty()) {
        ls::save(file, ls::montage(tiles, {.columns = columns}));
        std::printf("\nwrote %s: the references at the left, then the methods with their relMSE\n",
                    file.string().c_str());
    }
} catch (const ls::Error& error) {
    std::fprintf(stderr, "methods: %s\n", error.what());
    return 2;
} catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "methods: %s\n", error.what());
    return 2;
}
