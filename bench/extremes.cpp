// Numbers at the extremes: scenes whose images have a known mean, each varied as far as it goes, by every method.
//
//   extremes [--seconds S] [--markdown] [ROW...]
//
// --help says what the table means.

#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/compiled.hpp>
#include <lightswitch/render/any_session.hpp>

#include "extremes_surfaces.hpp"
#include "paired.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace {

using namespace extremes;

constexpr char help[] =
    R"(extremes [--seconds S] [--markdown] [ROW...]: images at the extremes, by every method that is not heuristic

  --seconds S   of one thread, for each method in each row (0.5)
  --markdown    as a table of docs/numerics.md
  ROW           only rows whose description holds that text

A figure is the mean of the image over what it must be, known in closed form, by numerical integration, or (rooms) from
the same scene at its usual size. In brackets: the standard error in units of the last digit, from images of other
seeds.

FAILS    more than five standard errors, plus the relative rounding that the row allows, away from what it must be: by
         chance once in a million figures. Also more than 5 % away when the errors seem small, which a method that
         misses some light underestimates.
starves  the method finds the light of this row too rarely to be judged, which is as it should be: not measured.
noisy    it should find it, but its standard error is above 3 %.
refused  the scene has an error that says what is wrong with it, as it should.

Methods that are only consistent (photon, vcm) may be off by 2 % more, as their first images are blurred.
Exit status 1 when anything fails.
)";

struct Options {
    double seconds = 0.5;
    bool markdown = false;
    std::vector<std::string> rows;
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--help") {
            std::fputs(help, stdout);
            std::exit(0);
        }
        if (word == "--markdown") {
            options.markdown = true;
        } else if (word == "--seconds" && i + 1 < argc) {
            options.seconds = std::atof(argv[++i]);
        } else if (word.starts_with("-")) {
            throw ls::Error("there is no option " + word + "; see --help");
        } else {
            options.rows.push_back(word);
        }
    }
    if (!(options.seconds > 0)) throw ls::Error("--seconds must be above 0");
    return options;
}

/// Mean and standard error of the mean of images.
struct Measured {
    double mean = 0, error = 0;
    std::uint64_t non_finite = 0;
};

template <class SceneType, class M>
Measured measure(const SceneType& scene, const M& method, double seconds) {
    constexpr int least = 16;
    double sum = 0, squares = 0, spent = 0;
    std::uint64_t count = 0, non_finite = 0;
    const auto image = [&](int samples) {
        return bench::seconds_of([&] {
            ls::Session<SceneType, M> session(scene, method, {.seed = 1 + count++, .threads = 1});
            session.run({.samples = samples});
            const DVec3 mean = session.film().image().mean();
            const double value = (mean.x + mean.y + mean.z) / 3;
            sum += value;
            squares += value * value;
            non_finite += session.statistics().counts.non_finite;
        });
    };
    // Images of several samples, so that their means are nearly normal and a method's preparations are few.
    const double first = image(1);
    const int samples = std::clamp(int(seconds / (2 * least) / std::max(first, 1e-6)), 1, 256);
    sum = squares = 0;
    count = 0;
    while (count < least || spent < seconds) spent += image(samples);
    const double n = double(count), mean = sum / n;
    return {mean, std::sqrt(std::max(squares - sum * mean, 0.0) / (n * (n - 1))), non_finite};
}

/// Such as 1.0003(4).
std::string with_error(double value, double error) {
    const int digits = error > 0 ? std::clamp(int(std::ceil(-std::log10(error))), 0, 6) : 6;
    char text[64];
    std::snprintf(text, sizeof text, "%.*f(%.0f)", digits, value, error * std::pow(10, digits));
    return text;
}

struct Cell {
    std::string text;
    bool fails = false;
};

template <class M>
Cell judge(const Row& row, const ls::AnyScene& scene, const M& method, const std::optional<Measured>& base,
           double seconds) {
    // A space before and after, so that "path" is not found in "path-nee".
    if ((" " + row.starved + " ").find(" " + std::string(M::name) + " ") != std::string::npos) return {"starves"};
    const Measured found = std::visit([&](const auto& s) { return measure(s, method, seconds); }, scene);
    if (found.non_finite > 0) return {std::to_string(found.non_finite) + " not finite: FAILS", true};
    const double factor = base ? base->mean : 1, low = row.low * factor, high = row.high * factor;
    const double error = std::hypot(found.error, base ? base->error * row.high : 0.0);
    const double beyond = std::max({low - found.mean, found.mean - high, 0.0});
    const double scale = high > 0 ? high : 1;
    const double blur = M::kind == ls::Kind::consistent ? 0.02 : 0;
    Cell cell{high > 0 ? with_error(found.mean / (low == high ? scale : 1), error / (low == high ? scale : 1))
                       : short_text(found.mean)};
    const bool noisy = error > 0.03 * scale;
    cell.fails = beyond > 5 * error + (row.rounding + blur) * scale || (!noisy && beyond > 0.05 * scale);
    cell.text += cell.fails ? ": FAILS" : noisy ? ": noisy" : "";
    return cell;
}

Cell judge_refusal(const Row& row) {
    try {
        ls::build_any(row.scene(), {.embree_config = "threads=1"});
    } catch (const ls::Error& error) {
        const std::string message = error.what();
        return {"refused: " + message, message.find(row.refused) == std::string::npos};
    }
    return {"not refused: FAILS", true};
}

/// What can be judged: methods that obey the rendering equation.
void for_each_judged(auto&& f) {
    ls::for_each_method([&]<class M>(const M& m) {
        if constexpr (M::kind != ls::Kind::heuristic) f(m);
    });
}

int run(const Options& options) {
    Rows rows;
    add_sizes(rows);
    add_details(rows);
    add_lights(rows);
    add_surfaces(rows);
    add_skies(rows);
    add_cameras(rows);
    std::string heading = "| what | at | must be |", line = "|---|---|---|";
    for_each_judged([&](const auto& m) {
        heading += " " + std::string(m.name) + " |";
        line += "---|";
    });
    std::printf("%s\n", heading.c_str());
    if (options.markdown) std::printf("%s\n", line.c_str());
    int cells = 0, failed = 0;
    for (const Row& row : rows.all()) {
        const std::string name = row.what + " " + row.at;
        const auto wanted = [&](const std::string& text) { return name.find(text) != std::string::npos; };
        if (!options.rows.empty() && std::none_of(options.rows.begin(), options.rows.end(), wanted)) continue;
        std::printf("| %s | %s |", row.what.c_str(), row.at.c_str());
        std::fflush(stdout);
        const auto print = [&](const Cell& cell) {
            ++cells;
            failed += cell.fails;
            std::printf(" %s |", cell.text.c_str());
            std::fflush(stdout);
        };
        if (!row.refused.empty()) {
            std::printf(" |");
            print(judge_refusal(row));
            std::printf("\n");
            continue;
        }
        const ls::AnyScene scene = ls::build_any(row.scene(), {.embree_config = "threads=1"});
        std::optional<Measured> base;
        if (row.same_as) {
            const ls::AnyScene other = ls::build_any(row.same_as(), {.embree_config = "threads=1"});
            base = std::visit([&](const auto& s) { return measure(s, ls::Bdpt{}, 4 * options.seconds); }, other);
        }
        const double factor = base ? base->mean : 1;
        if (row.low == row.high) std::printf(" %.5g |", row.low * factor);
        else
            std::printf(" %.3g to %.3g%s |", row.low * factor, row.high * factor,
                        row.known_bound.empty() ? "" : (" (known: " + row.known_bound + ")").c_str());
        for_each_judged([&](const auto& m) { print(judge(row, scene, m, base, options.seconds)); });
        std::printf("\n");
    }
    std::printf("\n%d figures, %d fail\n", cells, failed);
    return cells > 0 && failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(parse(argc, argv));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "extremes: %s\n", error.what());
        return 2;
    }
}
