// What `verify` finds, how soon, and how often it is wrong.
//
//   verify bugs [SECONDS]     every planted bug: seconds until it is found, and whether the path length is right (120 s
//   at most each)
//   verify alarms [RUNS]      right methods against right ones with different seeds: how often they are said to differ
//   verify agree [SECONDS] [SCENE...]   unbiased methods on the stock scenes or on scene files: whether a bias of 2 %
//   is ruled out
//
// Without arguments: bugs, 1000 runs for alarms, agree. Seconds are those of all processors together with whatever else
// they do.

#include "verify/planted/catalogue.hpp"
#include "verify_lamps.hpp"

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/verify/verify.hpp>
#if __has_include(<pugixml.hpp>)
#include <lightswitch/load/mitsuba.hpp>
#endif

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace {

namespace ls = lightswitch;

/// Returns the number of bugs that were missed or found at the wrong path length.
int bugs(double seconds, const std::string& only) {
    std::printf("%-58s %-26s %9s %9s %8s %7s %7s\n", "planted bug", "scene", "found", "seconds", "samples", "length",
                "should");
    int count = 0, found = 0, soon = 0, located = 0, with_length = 0;
    std::vector<ls::test::PlantedBug> all = ls::test::planted_bugs();
    for (auto& bug : ls::test::surface_bugs()) all.push_back(std::move(bug));
    for (const auto& bug : all) {
        if (!only.empty() && bug.name.find(only) == std::string_view::npos) continue;
        const auto [wrong, right] = bug.make();
        const ls::Verdict v = ls::verify(wrong, right, {.seconds = seconds, .tolerance = 0});
        const bool good = v.disagrees() && v.correlated_pixels == bug.correlated;
        ++count;
        found += good;
        soon += good && v.found_after <= 10;
        with_length += bug.first_length > 0;
        located += bug.first_length > 0 && v.first_wrong_length == bug.first_length;
        std::printf("%-58s %-26s %9s %9.2f %8llu %7d %7d%s\n", std::string(bug.name).c_str(),
                    std::string(bug.scene).c_str(), good ? "yes" : "NO", v.found_after,
                    static_cast<unsigned long long>(v.samples), v.first_wrong_length, bug.first_length,
                    v.first_wrong_length == bug.first_length ? "" : "  <- other length");
        std::fflush(stdout);
    }
    std::printf("%d bugs: %d found, %d of them within 10 s; path length right for %d of %d\n\n", count, found, soon,
                located, with_length);
    return count - found + with_length - located;
}

/// Returns the number of false alarms beyond the stated rate.
int alarms(int runs) {
    auto pairs = ls::test::correct_pairs();
    const auto lamps = ls::test::lamp_pairs();
    pairs.insert(pairs.end(), lamps.begin(), lamps.end());
    std::vector<std::pair<ls::Estimator, ls::Estimator>> sides;
    for (const auto& pair : pairs) sides.push_back(pair.make());
    std::vector<int> alarms(pairs.size(), 0), made(pairs.size(), 0), lax_alarms(pairs.size(), 0),
        lax_made(pairs.size(), 0);
    for (int run = 0; run < runs; ++run) {
        const std::size_t i = static_cast<std::size_t>(run) % pairs.size();
        ls::VerifyOptions options{
            .seconds = 0, .tolerance = 0, .seed = 1 + static_cast<std::uint64_t>(run), .images = 54, .samples = 1};
        if (sides[i].first.kind ==
            ls::Kind::consistent) {  // accused only of what stays over many doublings of the samples
            options.images = 16 << 5;
            options.path_lengths = 3;
        }
        const ls::Verdict v = ls::verify(sides[i].first, sides[i].second, options);
        ++made[i];
        alarms[i] += v.disagrees();
        if (v.disagrees())
            std::cout << pairs[i].name << ", " << pairs[i].scene << ", seed " << options.seed << ": " << v
                      << std::flush;
        if (run / static_cast<int>(pairs.size()) % 4 != 0) continue;
        options.confidence = 0.9;  // a rate that so many runs can show
        ++lax_made[i];
        lax_alarms[i] += ls::verify(sides[i].first, sides[i].second, options).disagrees();
    }
    std::printf("%-40s %6s %16s %6s %14s\n", "right against right", "runs", "alarms at 99.9 %", "runs",
                "alarms at 90 %");
    int all = 0, lax = 0, lax_runs = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const std::string name = std::string(pairs[i].name) + ", " + std::string(pairs[i].scene);
        std::printf("%-40.40s %6d %16d %6d %14d\n", name.c_str(), made[i], alarms[i], lax_made[i], lax_alarms[i]);
        all += alarms[i];
        lax += lax_alarms[i];
        lax_runs += lax_made[i];
    }
    std::printf("%-40s %6d %16d %6d %14d   (stated: at most %.1f and %.1f)\n\n", "all", runs, all, lax_runs, lax,
                1e-3 * runs, 0.1 * lax_runs);
    return std::max(0, all - static_cast<int>(1e-3 * runs));
}

ls::LibraryDescription describe(const std::string& scene) {
#if __has_include(<pugixml.hpp>)
    if (scene.ends_with(".xml")) return ls::load_mitsuba(scene);
#endif
    if (const auto stock = ls::stock::describe(scene)) return *stock;
    throw ls::Error("there is no scene \"" + scene + "\"");
}

/// Returns the number of disagreements.
int agree(double seconds, const std::vector<std::string>& scenes) {
    std::printf("%-28s %-12s %-12s %9s %12s %8s %8s %9s\n", "scene", "method", "reference", "seconds", "verdict",
                "bias %", "within", "rare");
    int wrong = 0;
    for (const std::string& name : scenes) {
        auto description = describe(name);
        description.film.width = description.film.height = 64;
        const ls::AnyScene scene = ls::build_any(description);
        const auto verdicts = std::visit(
            [&](const auto& s) {
                std::vector<ls::Estimator> methods;
                ls::for_each_method([&](const auto& m) {
                    if (m.kind != ls::Kind::heuristic && m.name != ls::PathTracer::name)
                        methods.push_back(ls::estimator(s, m));
                });
                return ls::Verification(ls::estimator(s, ls::PathTracer{}), methods,
                                        {.seconds = seconds, .tolerance = 0.02})
                    .run();
            },
            scene);
        for (const ls::Verdict& v : verdicts) {
            double bias = 0;
            for (const double b : v.parts.front().bias)
                if (std::abs(b) > std::abs(bias)) bias = b;
            double within = 0;
            for (const auto& interval : v.parts.front().interval)
                within = std::max({within, interval.high, -interval.low});
            std::printf("%-28s %-12s %-12s %9.1f %12s %8.3f %8.3f %9.0f\n", name.substr(name.rfind('/') + 1).c_str(),
                        v.method.c_str(), v.reference.c_str(), v.seconds + v.reference_seconds,
                        std::string(ls::name(v.answer)).c_str(), 100 * bias, 100 * within, v.events);
            std::fflush(stdout);
            wrong += v.disagrees();
            if (v.disagrees()) std::cout << v;
        }
    }
    std::printf("\n");
    return wrong;
}

}  // namespace

int main(int argc, char** argv) try {
    const std::string what = argc > 1 ? argv[1] : "";
    const double number = argc > 2 ? std::atof(argv[2]) : 0;
    std::vector<std::string> scenes(ls::stock::names.begin(), ls::stock::names.end());
    if (what == "agree" && argc > 3) scenes.assign(argv + 3, argv + argc);
    int failures = 0;
    if (what.empty() || what == "bugs")
        failures += bugs(number > 0 ? number : 120, what == "bugs" && argc > 3 ? argv[3] : "");
    if (what.empty() || what == "alarms") failures += alarms(number > 0 ? static_cast<int>(number) : 1000);
    if (what.empty() || what == "agree") failures += agree(number > 0 ? number : 120, scenes);
    return failures == 0 ? 0 : 1;
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
