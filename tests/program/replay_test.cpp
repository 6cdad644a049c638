// The sub-command replay.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <algorithm>

using namespace lightswitch::test;

namespace {

using Words = std::vector<std::string>;

Words replay(Words more) {
    Words words{"replay", "cornell-box", "--size", "16x12", "--seed", "3"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The three numbers behind `"key": [` in JSON text.
lightswitch::Rgb color(const std::string& json, const std::string& key) {
    const std::string label = "\"" + key + "\": [";
    const std::size_t at = json.find(label);
    lightswitch::Rgb result(-1);
    if (at == std::string::npos) return result;
    const char* text = json.c_str() + at + label.size();
    for (int c = 0; c < 3; ++c) {
        char* end = nullptr;
        result[c] = static_cast<float>(std::strtod(text, &end));
        text = end + (*end == ',' ? 1 : 0);
    }
    return result;
}

}  // namespace

TEST_CASE("replay: the value is that of a render of one sample") {
    const Folder workspace;
    for (const std::string method : {"path-nee", "bdpt", "photon"}) {
        CAPTURE(method);
        REQUIRE(run(workspace, {"render", "cornell-box", "-m", method, "--size", "16x12", "--seed", "3", "--spp", "1",
                                "-q", "-o", "one.pfm"})
                    .status == 0);
        const lightswitch::Image image = lightswitch::load_image(workspace / "one.pfm");
        for (const auto& [x, y] : {std::pair(8, 2), {3, 9}, {15, 11}}) {
            const std::string pixel = std::to_string(x) + "," + std::to_string(y);
            const Ended ended = run(workspace, replay({"-m", method, "--pixel", pixel, "--json", "-"}));
            CHECK(ended.status == 0);
            CHECK(ended.err == "");
            CHECK(color(ended.out, "value") == image.pixels()[static_cast<std::size_t>(y * 16 + x)]);
            CHECK(ended.prints("\"explained\": true"));
        }
    }
}

TEST_CASE("replay: the listing tells of vertices, contributions and their sum") {
    const Folder workspace;
    const Ended ended = run(workspace, replay({"--pixel", "8,2", "--brightest", "50", "--json", "s.json"}));
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    for (const char* text : {"brightest of 50 samples: iteration ", " times their mean\n",
                             "path-nee on cornell-box, 16 x 12 pixels: pixel (8, 2), iteration ", ", seed 3\n",
                             "\nz0  camera       at (0, ", "\nz1  surface      at (", "diffuse, shape ",
                             "\n    = sample     value (", "film (", "the contributions add up to it, bit for bit\n"})
        CHECK_MESSAGE(ended.prints(text), text);
    CHECK(workspace.files() == std::set<std::string>{"s.json"});
    // The same by its number.
    const std::string json = read_text(workspace / "s.json");
    const std::size_t at = json.find("\"iteration\": ");
    REQUIRE(at != std::string::npos);
    const std::string number = std::to_string(std::strtol(json.c_str() + at + 13, nullptr, 10));
    const Ended again = run(workspace, replay({"--pixel", "8,2", "--iteration", number}));
    CHECK(ended.out.ends_with(again.out));
    CHECK(run(workspace, replay({"--pixel", "8,2", "-q"})).out == "");
    CHECK(run(workspace, replay({"-m", "mlt", "--bootstrap", "500", "--pixel", "8,2"}))
              .prints("the method does not tell of all contributions: only what came of them is exact\n"));
}

TEST_CASE("replay: what is wrong is said") {
    const Folder workspace;
    const auto refused = [&](const Words& words, const std::string& text) {
        const Ended ended = run(workspace, words);
        CHECK(ended.status == 2);
        CHECK(ended.out == "");
        CHECK_MESSAGE(ended.says(text), ended.err);
        CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    };
    refused(replay({}), "name a pixel: --pixel X,Y, counted from 0 at the top left");
    refused(replay({"--pixel", "3"}), "--pixel: \"3\" is not X,Y, counted from 0 at the top left, such as 120,34");
    refused(replay({"--pixel", "3,-1"}), "--pixel: \"3,-1\" is not X,Y");
    refused(replay({"--pixel", "16,2"}), "pixel (16, 2) is outside of the image of 16 x 12 pixels");
    refused(replay({"--pixel", "1,2", "--iteration", "x"}), "--iteration: \"x\" is not a whole number of at least 0");
    refused(replay({"--pixel", "1,2", "--brightest", "0"}), "--brightest: \"0\" is not a whole number of at least 1");
    refused(replay({"--pixel", "1,2", "--brightest", "9", "--iteration", "1"}), "excludes");
    refused(replay({"--pixel", "1,2", "-m", "pth"}), "--method: there is no method \"pth\"; did you mean \"path\"?");
    refused({"replay", "--pixel", "1,2"}, "replay: name a scene");
}
