// Every method through the program: its image, its numbers, and the options that only some methods have.
// All seeds are fixed, so nothing here fails by chance.

#include "program/process.hpp"
#include "support/relative.hpp"

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/method/any_method.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace lightswitch::test;

namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr int pixels = 16 * 16, samples = 4;

struct Result {
    Json stats;
    std::string image;  // the file, bit by bit
    double mean = 0;
};

Words words(std::string_view method, const Words& more, int spp = samples, const std::string& scene = "cornell-box") {
    Words all{"render",   scene,   "--size",  "16x16", "--method", std::string(method), "--spp", std::to_string(spp),
              "--output", "x.pfm", "--stats", "-",     "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

Result render(std::string_view method, const Words& more = {}, int spp = samples,
              const std::string& scene = "cornell-box") {
    const Folder workspace;
    const Ended ended = run(workspace, words(method, more, spp, scene));
    INFO(method, ": ", ended.err);
    REQUIRE(ended.status == 0);
    // Few samples of a scene with rare light are warned of.
    CHECK((ended.err.empty() || (scene != "cornell-box" && ended.says("rests on few rare paths"))));
    const lightswitch::DVec3 mean = lightswitch::load_image(workspace / "x.pfm").mean();
    return {Json::parse(ended.out), read_text(workspace / "x.pfm"), (mean.x + mean.y + mean.z) / 3};
}

double radius_after(double pixels_at_first, double alpha) {
    return pixels_at_first * std::pow(double(samples), (alpha - 1) / 2);
}

}  // namespace

TEST_CASE("every method renders, and its numbers are sound") {
    const double truth = render("path", {}, 256).mean;
    lightswitch::for_each_method([&](const auto& method) {
        const Result result = render(method.name, {"--threads", "2"});
        const Json& stats = result.stats;
        CAPTURE(method.name);
        CHECK(stats["method"] == method.name);
        CHECK(stats["kind"] == lightswitch::name(method.kind));
        CHECK(stats["samples_per_pixel"] == samples);
        CHECK(stats["rays"] >= pixels * samples);
        CHECK(stats["rays"] >= stats["shadow_rays"]);
        CHECK(stats["non_finite"] == 0);
        CHECK(stats["first_non_finite"].empty());
        CHECK(stats["max_depth"] == (method.kind == lightswitch::Kind::heuristic ? Json() : Json(-1)));
        CHECK(result.image == render(method.name, {"--threads", "1"}).image);
        if (method.kind == lightswitch::Kind::heuristic) CHECK(stats["splats"] == 0);
        else CHECK(result.mean == relative(truth, 0.25));
    });
}

TEST_CASE("methods tell in --stats what they have done") {
    const Json light = render("light").stats, bdpt = render("bdpt").stats, photon = render("photon").stats,
               vcm = render("vcm").stats, mlt = render("mlt").stats;
    for (const Json& stats : {light, bdpt, vcm, mlt}) {
        CAPTURE(stats["method"]);
        CHECK(stats["splats"] > pixels);
        CHECK(stats["shadow_rays"] > pixels);
    }
    CHECK(photon["splats"] == 0);
    for (const Json& stats : {light, vcm}) {
        CAPTURE(stats["method"]);
        CHECK(stats["paths"] == pixels * samples);
    }
    CHECK(photon["paths"] == pixels * samples / 2);
    CHECK(photon["shadow_rays"] > pixels);
    CHECK(photon["photons"] > pixels);
    CHECK(photon["photon_map_bytes"] > photon["photons"]);
    CHECK(photon["radius_pixels"] == relative(radius_after(4, 2 / 3.0), 1e-5));
    CHECK(photon["initial_radius_pixels"] == 4);
    CHECK(vcm["light_vertices"] > pixels);
    CHECK(vcm["radius_pixels"] == relative(radius_after(1, 2 / 3.0), 1e-5));
    CHECK(mlt["paths"] >= pixels * samples);
    CHECK(mlt["mutations"] >= mlt["chains"]);
    CHECK(mlt["mutations_per_pixel"] == 0.5);
    CHECK(mlt["chain_length"] >= 8);
    CHECK(mlt["chain_energy"] > 0);
    CHECK(mlt["chain_share"] >= 0);
    CHECK(mlt["coverage"] > 0.5);
    CHECK(mlt["coverage"] <= 1);
    CHECK(mlt["rr_depth"].is_null());
    CHECK(!bdpt.contains("alpha"));
}

TEST_CASE("options of single methods: each arrives, and changes the image") {
    struct Case {
        std::string_view method;
        Words option;
        std::string key;  // of --stats
        Json value;
    };
    const std::vector<Case> cases{{"photon", {"--radius", "3.5"}, "initial_radius_pixels", 3.5},
                                  {"vcm", {"--radius", "0"}, "initial_radius_pixels", 0},
                                  {"photon", {"--alpha", "0.4"}, "alpha", 0.4},
                                  {"vcm", {"--alpha", "0.9"}, "alpha", 0.9},
                                  {"photon", {"--photon-paths", "2.5"}, "paths_per_pixel", 2.5},
                                  {"photon", {"--final-gather"}, "final_gather", true},
                                  {"mlt", {"--bootstrap", "1000"}, "bootstrap", 1000},
                                  {"mlt", {"--mutations", "3"}, "mutations_per_pixel", 3},
                                  {"mlt", {"--no-refine"}, "refine", false}};
    std::map<std::string_view, Result> plain;
    // Nothing is left to the chains of mlt in the box.
    const auto scene_for = [](std::string_view method) { return method == "mlt" ? "ajar-door" : "cornell-box"; };
    for (const std::string_view method : {"photon", "vcm", "mlt"})
        plain[method] = render(method, {}, samples, scene_for(method));
    for (const Case& c : cases) {
        CAPTURE(c.method);
        CAPTURE(c.option[0]);
        const Result result = render(c.method, c.option, samples, scene_for(c.method));
        CHECK(result.stats[c.key] == c.value);
        CHECK(plain[c.method].stats[c.key] != c.value);
        CHECK(result.image != plain[c.method].image);
    }
}

TEST_CASE("options of single methods do what they say") {
    CHECK(render("photon", {"--radius", "3", "--alpha", "0.5"}).stats["radius_pixels"] ==
          relative(radius_after(3, 0.5), 1e-5));
    CHECK(render("vcm", {"--radius", "0"}).stats["radius_pixels"] == 0);
    CHECK(render("photon", {"--photon-paths", "2.5"}).stats["paths"] == pixels * samples * 5 / 2);
    CHECK(render("photon", {"--final-gather"}).stats["shadow_rays"] > render("photon").stats["shadow_rays"]);
    // Unrefined, the plan is that of the beginning, however long the render.
    const auto energy = [](const Words& option, int spp) {
        return render("mlt", option, spp, "ajar-door").stats["chain_energy"];
    };
    CHECK(energy({"--no-refine"}, samples) == energy({"--no-refine"}, 1));
    CHECK(energy({}, samples) != energy({}, 1));
}

TEST_CASE("the depth of paths is that of the command line, for every method that has one") {
    // In the furnace every surface emits 1 and reflects half: depth d shows the first d terms of 1 + 1/2 + 1/4 + ...
    const Folder workspace;
    for (const char* method : {"path", "path-nee", "light", "bdpt", "photon", "vcm", "mlt", "path-guided"})
        for (const auto& [depth, value] : {std::pair{"1", 1.0}, {"2", 1.5}}) {
            const Ended ended = run(workspace, {"render", "furnace", "--size", "16x16", "--spp", "64", "-m", method,
                                                "--max-depth", depth, "-q", "-o", "x.pfm"});
            CAPTURE(method);
            CHECK(ended.status == 0);
            CHECK(lightswitch::load_image(workspace / "x.pfm").mean().x == relative(value, 0.05));
        }
}

TEST_CASE("options of single methods: wrong values, and methods that do not have them") {
    const Folder workspace;
    const std::vector<std::tuple<std::string_view, Words, std::string>> calls{
        {"path-nee", {"--radius", "1"}, "--radius: there is no such setting in path-nee; it belongs to photon, vcm"},
        {"bdpt", {"--alpha", "0.5"}, "--alpha: there is no such setting in bdpt; it belongs to photon, vcm"},
        {"vcm", {"--photon-paths", "2"}, "--photon-paths: there is no such setting in vcm; it belongs to photon"},
        {"vcm", {"--final-gather"}, "--final-gather: there is no such setting in vcm; it belongs to photon"},
        {"photon", {"--mutations", "8"}, "--mutations: there is no such setting in photon; it belongs to mlt"},
        {"path", {"--bootstrap", "8"}, "it belongs to mlt"},
        {"phong", {"--no-refine"}, "--no-refine: there is no such setting in phong; it belongs to mlt"},
        {"photon", {"--radius", "0"}, "--radius: photon would gather nothing; it must be above 0"},
        {"vcm", {"--radius", "-1"}, "--radius: \"-1\" is not a finite number of at least 0"},
        {"vcm", {"--radius", "inf"}, "--radius: \"inf\" is not a finite number"},
        {"vcm", {"--radius", "1e6"}, "--radius: it must be at most 1000 pixels"},
        {"vcm", {"--radius"}, "--radius needs a value"},
        {"vcm", {"--radius", "1", "--radius", "2"}, "--radius is given more than once"},
        {"photon", {"--alpha", "0"}, "--alpha: \"0\" is not a finite number above 0"},
        {"photon", {"--alpha", "1"}, "--alpha: it must be below 1"},
        {"photon", {"--alpha", "0.9999999999"}, "--alpha: it must be below 1"},
        {"photon", {"--alpha", "1e-60"}, "--alpha: \"1e-60\" is beyond the range"},
        {"photon", {"--photon-paths", "0"}, "--photon-paths: \"0\" is not a finite number above 0"},
        {"photon", {"--photon-paths", "1e9"}, "--photon-paths: 1e+09 for each of 256 pixels are more light paths"},
        {"mlt", {"--bootstrap", "2.5"}, "--bootstrap: \"2.5\" is not a whole number"},
        {"mlt", {"--bootstrap", "0"}, "--bootstrap: \"0\" is not a whole number from 1"},
        {"mlt",
         {"--bootstrap", "99999999999"},
         "--bootstrap: \"99999999999\" is not a whole number from 1 to 16777216"},
        {"mlt", {"--mutations", "0"}, "--mutations: \"0\" is not a finite number above 0"},
        {"mlt", {"--mutations", "1001"}, "--mutations: it must be at most 1000"}};
    for (const auto& [method, option, message] : calls) {
        const Ended ended = run(workspace, words(method, option));
        INFO(message, " : ", ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(message));
        CHECK(workspace.files().empty());
    }
    CHECK(run(workspace,
              {"render", "furnace", "-m", "mlt", "--rr-depth", "3", "--size", "4x4", "--spp", "1", "-o", "x.pfm"})
              .says("warning: the method mlt has no Russian roulette: --rr-depth changes nothing"));
}

TEST_CASE("methods: a line for what each can and one for what it cannot, none too long for a terminal") {
    const Folder workspace;
    const Ended ended = run(workspace, {"methods"});
    CHECK(ended.status == 0);
    lightswitch::for_each_method([&](const auto& method) {
        std::string line(method.name);
        line.resize(12, ' ');
        line += lightswitch::name(method.kind);
        line.resize(24, ' ');
        CHECK(("\n" + ended.out).find("\n" + line + "can:    ") != std::string::npos);
    });
    std::istringstream lines(ended.out);
    for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(line.size() <= 120, line);
}

TEST_CASE("help: the options of single methods are a group of their own") {
    const Folder workspace;
    for (const char* command : {"render", "verify"}) {
        const std::string help = run(workspace, {command, "--help"}).out;
        const std::size_t group = help.find("\nOptions of single methods:\n");
        REQUIRE(group != std::string::npos);
        for (const char* option : {"--radius PIXELS", "--alpha A", "--photon-paths N", "--final-gather",
                                   "--bootstrap N", "--mutations N", "--no-refine"})
            CHECK(help.find(option, group) != std::string::npos);
        std::istringstream lines(help);
        for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(line.size() <= 120, line);
    }
}
