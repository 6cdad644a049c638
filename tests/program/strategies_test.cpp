// The sub-command strategies.

#include "../support/relative.hpp"
#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <algorithm>
#include <cmath>

using namespace lightswitch::test;
using lightswitch::Image;
using lightswitch::load_image;

namespace {

using Words = std::vector<std::string>;

constexpr int size = 12, max_depth = 3;

/// A pyramid of three rows: 1, 3 and 4 strategies.
Words pyramid(Words more) {
    Words words{"strategies", "cornell-spheres", "--size", "12x12", "--max-depth", "3", "--spp", "4", "--seed", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The number after `label` in the text; NaN when there is none.
double number_after(const std::string& text, const std::string& label) {
    const std::size_t at = text.find(label);
    return at == std::string::npos ? std::nan("") : std::strtod(text.c_str() + at + label.size(), nullptr);
}

std::string file(int s, int t) { return "s" + std::to_string(s) + "_t" + std::to_string(t) + ".exr"; }

}  // namespace

TEST_CASE("strategies: they add up to the image, and the picture shows each in its place") {
    if (!lightswitch::detail::has_exr) return;
    const Folder workspace;
    const Ended ended = run(workspace, pyramid({"-o", "p.pfm", "--output", "p.png", "--directory", "."}));
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    CHECK(ended.prints("8 strategies, 4 samples per pixel each, in "));
    CHECK(ended.prints("; wrote p.pfm, p.png, 8 images in .\n"));
    CHECK(number_after(ended.out, "the sum of all strategies is the image of bdpt: the largest difference is ") < 1e-4);
    CHECK(workspace.files() == std::set<std::string>{"p.pfm", "p.png", "s0_t2.exr", "s0_t3.exr", "s0_t4.exr",
                                                     "s1_t2.exr", "s1_t3.exr", "s2_t1.exr", "s2_t2.exr", "s3_t1.exr"});

    CHECK(run(workspace, {"render", "cornell-spheres", "-m", "bdpt", "--size", "12x12", "--max-depth", "3", "--spp",
                          "4", "--seed", "2", "-o", "whole.pfm"})
              .status == 0);
    const Image whole = load_image(workspace / "whole.pfm");
    const Image sheet = load_image(workspace / "p.pfm");
    const auto exposure = static_cast<float>(number_after(ended.out, "exposure "));
    constexpr int gap = 8, pitch = size + 11 + gap;  // of tiles; and of rows, with a line of text
    // Below the tiles, and wider than they are, is what they show.
    const int margin = (sheet.width() - gap - 4 * (size + gap)) / 2;
    REQUIRE(margin > 0);
    REQUIRE(sheet.height() == gap + 3 * pitch + 2 * 11);
    int ink = 0;
    for (int y = gap + 3 * pitch; y < sheet.height(); ++y)
        for (int x = 0; x < sheet.width(); ++x) ink += sheet(x, y) != lightswitch::Rgb(1);
    CHECK(ink > 1000);
    Image sum(size, size);
    int white = 0, tiles = 0;
    for (int length = 1; length <= max_depth; ++length) {
        const int in_row = length == 1 ? 1 : length + 1;
        for (int i = 0; i < in_row; ++i, ++tiles) {
            const Image one = load_image(workspace / file(i, length + 1 - i));
            CHECK(one.metadata.at("strategy") ==
                  "s=" + std::to_string(i) + " t=" + std::to_string(length + 1 - i) + ", weighted");
            const int left = margin + (4 - in_row) * (size + gap) / 2 + gap + i * (size + gap),
                      top = gap + (length - 1) * pitch;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    sum(x, y) += one(x, y);
                    const lightswitch::Rgb shown = lightswitch::expose(one(x, y), exposure),
                                           found = sheet(left + x, top + y);
                    for (int c = 0; c < 3; ++c) CHECK(double(found[c]) == relative(double(shown[c]), 0.005));
                    white += std::max({found.x, found.y, found.z}) >= 1 ? 1 : 0;
                }
        }
    }
    CHECK(whole.mean().x > 0.1);
    for (std::size_t i = 0; i < sum.pixels().size(); ++i)
        for (int c = 0; c < 3; ++c) CHECK(double(sum.pixels()[i][c]) == relative(double(whole.pixels()[i][c]), 1e-4));
    CHECK(std::abs(white - tiles * size * size / 100) <= 1);
}

// The seed is fixed. Both sides err by about 3 %.
TEST_CASE("strategies: unweighted, each finds all light of its length by itself") {
    if (!lightswitch::detail::has_exr) return;
    const Folder workspace;
    const Ended ended = run(workspace, {"strategies", "cornell-box", "--size", "16x16", "--max-depth", "2", "--spp",
                                        "256", "--unweighted", "--directory", "."});
    CHECK(ended.status == 0);
    CHECK(ended.prints("unweighted: not to be added up"));
    CHECK(!ended.prints("the sum of all"));
    CHECK(workspace.files() == std::set<std::string>{"s0_t2.exr", "s0_t3.exr", "s1_t2.exr", "s2_t1.exr"});
    const double truth = load_image(workspace / "s1_t2.exr").mean().y;
    CHECK(truth > 0.01);
    for (const char* name : {"s0_t3.exr", "s2_t1.exr"}) {
        CHECK(load_image(workspace / name).mean().y == relative(truth, 0.15));
        CHECK(load_image(workspace / name).metadata.at("strategy").find(", unweighted") != std::string::npos);
    }
}

TEST_CASE("strategies: what it cannot do is an error, and nothing is written") {
    const Folder workspace;
    std::filesystem::create_directory(workspace / "full");
    const std::vector<std::pair<Words, std::string>> calls{
        {{"strategies"}, "strategies: name a scene"},
        {{"strategies", "furnace"}, "nothing would be kept: name a file with --output"},
        {{"strategies", "cornel-box", "-o", "p.png"}, "did you mean \"cornell-box\"?"},
        {pyramid({"-o", "p.jpg"}), "an image is one of"},
        {pyramid({"-o", "missing/p.png"}), "the directory 'missing' does not exist"},
        {pyramid({"-o", "p.png", "--directory", "missing"}), "missing"},
        {{"strategies", "furnace", "-o", "p.png", "--max-depth", "0"}, "\"0\" is not a whole number from 1 to 16"},
        {{"strategies", "furnace", "-o", "p.png", "--max-depth", "17"}, "\"17\" is not a whole number from 1 to 16"},
        {{"strategies", "furnace", "-o", "p.png", "--max-depth", "-1"}, "\"-1\" is not a whole number from 1 to 16"},
        {{"strategies", "furnace", "-o", "p.png", "--spp", "0"}, "--spp: \"0\""},
        {{"strategies", "furnace", "-o", "p.png", "--size", "8000x8000"}, "the picture would be too large"},
        {pyramid({"-o", "p.png", "--method", "path"}), "strategies: there is no option \"--method\""},
        {pyramid({"-o", "p.png", "stray"}), "there is no use for \"stray\""}};
    for (const auto& [arguments, message] : calls) {
        const Ended ended = run(workspace, arguments);
        INFO(message, " : ", ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(message));
        CHECK(workspace.files() == std::set<std::string>{"full"});
    }
}

TEST_CASE("strategies: a signal ends it, and nothing is written") {
    Ended ended;
    for (useconds_t wait = 250'000; wait <= 16'000'000 && ended.status == -1; wait *= 2) {
        const Folder workspace;
        Process process(workspace, {"strategies", "furnace", "--size", "8x8", "--spp", "2147483647", "-o", "p.pfm"});
        usleep(wait);
        process.signal(SIGINT);
        ended = process.wait();
        if (ended.status == -1) continue;
        CHECK(ended.says("cancelled before all strategies were done: nothing is written"));
        CHECK(workspace.files().empty());
    }
    CHECK(ended.status == 130);
}
