// Every method at equal time: what is left of its error, and how soon it is as good as the baseline, path-nee.
//
//   methods [--seconds S] [--size N] [--reference-seconds R] [--cache DIR] [--output DIR] [SCENE...]
//
// --help says what the options mean and how the figures are made.

#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/montage.hpp>
#include <lightswitch/lightswitch.hpp>
#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/mitsuba.hpp>
#endif

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;

constexpr char help[] =
    R"(methods [OPTION VALUE]... [SCENE...]: every method that is not heuristic on every scene at equal time

  --seconds S            for each method on each scene (5)
  --size N               width and height of the images in pixels (128)
  --reference-seconds R  for the reference of each scene (60)
  --cache DIR            keep the references there, and take those of an earlier run; delete them when scenes have
                         changed
  --output DIR           write methods-at-equal-time.png there: the images, one row for each scene
  SCENE                  a stock scene, point-light-box, or a Mitsuba 3 file that ends in .xml;
                         by default cornell-box, cornell-spheres, ajar-door and point-light-box

One thread; seconds are its processor time. The methods of a scene advance in turn, each time until all have had twice
as much.

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
constexpr int replicas = 8, doublings = 10;

struct Options {
    double seconds = 5, reference_seconds = 60;
    int size = 128;
    std::string cache, output;
    std::vector<std::string> scenes;
};

/// Iterations until this thread has spent `seconds` in all on it, whatever `spent` before.
void advance(auto& session, double& spent, double seconds) {
    while (spent < seconds)
        spent +=
            bench::seconds_of([&] { session.run({.samples = static_cast<int>(session.film().iterations()) + 1}); });
}

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

// ---- the reference
// -----------------------------------------------------------------------------------------------------------

/// Independent images of one method, one below the other.
template <class Method>
ls::Image render_replicas(const ls::FullScene& scene, const Method& method, const Options& options) {
    const int size = options.size;
    ls::Image sheet(size, replicas * size);
    for (int i = 0; i < replicas; ++i) {
        ls::Session<ls::FullScene, Method, ls::SerialExecutor> session(
            scene, method, {.seed = 1000 + static_cast<std::uint64_t>(i)}, {});
        double spent = 0;
        advance(session, spent, options.reference_seconds / (2 * replicas));
        ls::paste(sheet, 0, i * size, session.image());
    }
    return sheet;
}

template <class Method>
ls::Image cached_replicas(const ls::FullScene& scene, const Method& method, const Options& options) {
    if (options.cache.empty()) return render_replicas(scene, method, options);
    char text[64];
    std::snprintf(text, sizeof text, "-%d-%gs.pfm", options.size, options.reference_seconds);
    const auto file = std::filesystem::path(options.cache) / (scene.name() + "-" + std::string(Method::name) + text);
    if (std::filesystem::exists(file)) return ls::load_image(file);
    ls::check_writable(file);
    ls::Image sheet = render_replicas(scene, method, options);
    ls::save(file, sheet);
    return sheet;
}

/// The mean of some images, and the variance of that mean in every pixel and channel.
struct Half {
    ls::Image mean, variance;

    Half(const ls::Image& sheet, int size) : mean(size, size), variance(size, size) {
        if (sheet.width() != size || sheet.height() != replicas * size)
            throw ls::Error("a reference in the cache has another size: delete it");
        for (std::size_t i = 0; i < mean.pixels().size(); ++i) {
            ls::DVec3 sum(0), squares(0);
            for (std::size_t k = 0; k < replicas; ++k) {
                const ls::DVec3 x(sheet.pixels()[k * mean.pixels().size() + i]);
                sum += x;
                squares += x * x;
            }
            mean.pixels()[i] = ls::Rgb(sum / double(replicas));
            variance.pixels()[i] = ls::Rgb(glm::max(squares - sum * sum / double(replicas), ls::DVec3(0)) /
                                           double(replicas * (replicas - 1)));
        }
    }
};

double sum_of(const ls::Rgb& x) { return double(x.x) + double(x.y) + double(x.z); }

struct Reference {
    ls::Image image, noise;  // the noise is the part of relMSE that the reference's own variance is expected to make
    double relmse = 0;       // the mean of `noise`

    Reference(const Half& a, const Half& b) : image(a.mean), noise(a.mean) {
        const double error_a = relative_variance(a), error_b = relative_variance(b);
        const double share = error_a + error_b > 0 ? error_b / (error_a + error_b) : 0.5;
        for (std::size_t i = 0; i < image.pixels().size(); ++i) {
            const ls::DVec3 r = share * ls::DVec3(a.mean.pixels()[i]) + (1 - share) * ls::DVec3(b.mean.pixels()[i]);
            const ls::DVec3 variance = share * share * ls::DVec3(a.variance.pixels()[i]) +
                                       (1 - share) * (1 - share) * ls::DVec3(b.variance.pixels()[i]);
            image.pixels()[i] = ls::Rgb(r);
            noise.pixels()[i] = ls::Rgb(variance / (r * r + ls::metric_offset));
            relmse += sum_of(noise.pixels()[i]) / (3 * double(image.pixels().size()));
        }
    }

private:
    static double relative_variance(const Half& half) {
        double sum = 0;
        for (std::size_t i = 0; i < half.mean.pixels().size(); ++i) {
            const ls::DVec3 r(half.mean.pixels()[i]);
            const ls::DVec3 term = ls::DVec3(half.variance.pixels()[i]) / (r * r + ls::metric_offset);
            sum += term.x + term.y + term.z;
        }
        return sum;
    }
};

/// Sum over a tile (column `tx`, row `ty` of `n` by `n`) of what `term` says of each pixel.
double over_tile(const ls::Image& image, int n, int tx, int ty, const auto& term) {
    double sum = 0;
    for (int y = ty * image.height() / n; y < (ty + 1) * image.height() / n; ++y)
        for (int x = tx * image.width() / n; x < (tx + 1) * image.width() / n; ++x) sum += term(x, y);
    return sum;
}

void print_agreement(const Half& a, const Half& b, const Reference& reference) {
    const auto deviations = [&](int n, int tx, int ty) {
        const double difference =
            over_tile(a.mean, n, tx, ty, [&](int x, int y) { return sum_of(a.mean(x, y)) - sum_of(b.mean(x, y)); });
        // The channels of a pixel err together: their deviations add up.
        const double variance = over_tile(a.mean, n, tx, ty, [&](int x, int y) {
            const auto square_of_sum = [&](const Half& half) {
                const ls::Rgb v = half.variance(x, y);
                const double s = std::sqrt(double(v.x)) + std::sqrt(double(v.y)) + std::sqrt(double(v.z));
                return s * s;
            };
            return square_of_sum(a) + square_of_sum(b);
        });
        return variance > 0 ? difference / std::sqrt(variance) : 0;
    };
    double worst = 0;
    for (int i = 0; i < 16; ++i) worst = std::max(worst, std::abs(deviations(4, i % 4, i / 4)));
    std::printf(
        "reference: relMSE of its own %.2e; its halves: ratio of means %.4f (%.1f deviations), worst tile %.1f%s\n",
        reference.relmse, ls::mean_ratio(a.mean, b.mean), deviations(1, 0, 0), worst,
        worst > 4 ? "  <- above 4: ask `lightswitch verify`" : "");
}

// ---- the methods
// -------------------------------------------------------------------------------------------------------------

double error_of(const ls::Image& image, const Reference& reference) {
    return ls::relmse(image, reference.image) - reference.relmse;
}

double median_of_tiles(const ls::Image& image, const Reference& reference) {
    constexpr int n = 8;
    std::vector<double> tiles;
    for (int i = 0; i < n * n; ++i) {
        double pixels = 0;
        const double sum = over_tile(image, n, i % n, i / n, [&](int x, int y) {
            ++pixels;
            const ls::Rgb r = reference.image(x, y), d = image(x, y) - r;
            return sum_of(d * d / (r * r + static_cast<float>(ls::metric_offset))) - sum_of(reference.noise(x, y));
        });
        if (pixels > 0) tiles.push_back(sum / (3 * pixels));
    }
    std::sort(tiles.begin(), tiles.end());
    return tiles[tiles.size() / 2];
}

struct Look {
    double seconds, error;
};

/// One method on one scene. The type of its method ends here.
struct Cell {
    std::string name;
    std::function<void(double seconds)> advance_to;  // until so many seconds in all
    std::function<ls::Image()> image;
    std::function<ls::RenderStatistics()> statistics;
    double seconds = 0;
    std::vector<Look> looks;
};

std::vector<std::unique_ptr<Cell>> cells_of(const ls::FullScene& scene) {
    std::vector<std::unique_ptr<Cell>> cells;
    ls::for_each_method([&]<class Method>(const Method& method) {
        if constexpr (Method::kind != ls::Kind::heuristic) {
            using Session = ls::Session<ls::FullScene, Method, ls::SerialExecutor>;
            auto cell = std::make_unique<Cell>();
            cell->name = Method::name;
            // Preparation is part of the time.
            std::shared_ptr<Session> session;
            cell->seconds = bench::seconds_of(
                [&] { session = std::make_shared<Session>(scene, method, ls::Settings{}, ls::SerialExecutor{}); });
            cell->advance_to = [session, &spent = cell->seconds](double seconds) { advance(*session, spent, seconds); };
            cell->image = [session] { return session->image(); };
            cell->statistics = [session] { return session->statistics(); };
            cells.push_back(std::move(cell));
        }
    });
    return cells;
}

/// The time after which the error stays at or below `target`, as text: a fraction of `whole`.
std::string time_until(const std::vector<Look>& looks, double target, double whole) {
    std::size_t first = looks.size();
    while (first > 0 && looks[first - 1].error <= target) --first;
    if (first == looks.size() || !(target > 0)) return "-";
    char text[32];
    if (first == 0) {
        std::snprintf(text, sizeof text, "<%.3f", looks[0].seconds / whole);
        return text;
    }
    const Look &above = looks[first - 1], &below = looks[first];
    // An error that is lost in the reference's noise has no logarithm; a tenth of the target does for it.
    const double bottom = std::log(std::max(below.error, 0.1 * target)), top = std::log(above.error);
    const double part = top > bottom ? (top - std::log(target)) / (top - bottom) : 1;
    const double time = above.seconds * std::pow(below.seconds / above.seconds, part);
    std::snprintf(text, sizeof text, "%.3f", time / whole);
    return text;
}

/// An error as text; that which cannot be told from the reference's noise as a bound.
std::string error_text(double error, double noise) {
    char text[32];
    if (error < 0.1 * noise) std::snprintf(text, sizeof text, "<%.3g", 0.1 * noise);
    else std::snprintf(text, sizeof text, "%.3g", error);
    return text;
}

/// Prints the table of one scene; returns its row of the montage.
std::vector<ls::Tile> compare_methods(const ls::FullScene& scene, const Options& options) {
    std::printf("\n%s\n", scene.name().c_str());
    const Half a(cached_replicas(scene, ls::Bdpt{}, options), options.size);
    const Half b(cached_replicas(scene, Baseline{}, options), options.size);
    const Reference reference(a, b);
    print_agreement(a, b, reference);

    const auto cells = cells_of(scene);
    for (int left = doublings; left >= 0; --left)
        for (const auto& cell : cells) {
            const double before = cell->seconds;
            cell->advance_to(std::ldexp(options.seconds, -left));
            if (cell->seconds > before) cell->looks.push_back({cell->seconds, error_of(cell->image(), reference)});
        }

    const auto baseline =
        std::find_if(cells.begin(), cells.end(), [](const auto& cell) { return cell->name == Baseline::name; });
    const Look goal = (*baseline)->looks.back();
    const double brightness = sum_of(ls::Rgb(reference.image.mean())) / 3;
    const float exposure =
        brightness > 0 ? std::clamp(static_cast<float>(std::log2(0.3 / brightness)), -20.0f, 20.0f) : 0;
    std::vector<ls::Tile> row{{scene.name(), reference.image, exposure}};
    std::printf("%-12s %10s %9s %10s %10s %8s %8s\n", "method", "iterations", "Mrays/s", "relMSE", "tiles", "mean",
                "time");
    for (const auto& cell : cells) {
        const ls::Image image = cell->image();
        const ls::RenderStatistics s = cell->statistics();
        const std::string error = error_text(cell->looks.back().error, reference.relmse);
        std::printf("%-12s %10llu %9.2f %10s %10.3g %8.4f %8s\n", cell->name.c_str(),
                    static_cast<unsigned long long>(s.iterations), 1e-6 * double(s.counts.rays) / cell->seconds,
                    error.c_str(), median_of_tiles(image, reference), ls::mean_ratio(image, reference.image),
                    time_until(cell->looks, goal.error, goal.seconds).c_str());
        row.push_back({cell->name + " " + error, image, exposure});
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
