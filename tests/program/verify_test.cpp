// The sub-command verify.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <nlohmann/json.hpp>

#include <random>

using namespace lightswitch::test;

namespace {

/// Independent images of noise around `level`: NAME-1.pfm, NAME-2.pfm, ...
void write_noise(const Folder& workspace, const std::string& name, int count, float level, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> uniform(0.5f, 1.5f);
    for (int n = 1; n <= count; ++n) {
        lightswitch::Image image(24, 16);
        for (auto& p : image.pixels()) p = lightswitch::Rgb(level * uniform(engine));
        lightswitch::save(workspace / (name + "-" + std::to_string(n) + ".pfm"), image);
    }
}

}  // namespace

// False alarm: 1e-3.
TEST_CASE("verify: methods on a scene") {
    const Folder workspace;
    const Ended ended = run(workspace, {"verify", "furnace", "--methods", "path-nee", "--size", "16x16", "--seconds",
                                        "20", "--tolerance", "0.02", "--json", "v.json", "--report", "v.html"});
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    CHECK(ended.prints("path-nee against path: agrees. A bias of more than"));
    CHECK(ended.prints("  length 1: no difference found"));
    CHECK(ended.prints("  length 6 and longer: no difference found"));
    const auto json = nlohmann::json::parse(read_text(workspace / "v.json"));
    REQUIRE(json["verdicts"].size() == 1);
    const auto& verdict = json["verdicts"][0];
    CHECK(verdict["verdict"] == "agrees");
    CHECK(verdict["method"] == "path-nee");
    CHECK(verdict["reference"] == "path");
    CHECK(verdict["first_wrong_length"].is_null());
    CHECK(verdict["parts"].size() == 7);
    CHECK(verdict["parts"][0]["bias_interval"][0][0] < 0.02);
    CHECK(read_text(workspace / "v.html").find("path-nee") != std::string::npos);
    CHECK(workspace.files() == std::set<std::string>{"v.html", "v.json"});
}

TEST_CASE("verify: by default all methods that can have the reference's image") {
    const Folder workspace;
    const auto verified = [&](const char* scene) {
        const Ended ended = run(workspace, {"verify", scene, "--size", "4x4", "--seconds", "0.01", "--lengths", "0",
                                            "--bootstrap", "1000", "--json", "-"});
        CHECK(ended.err.find("warning") == std::string::npos);
        std::set<std::string> names;
        const auto json = nlohmann::json::parse(ended.out);
        for (const auto& verdict : json["verdicts"]) names.insert(verdict["method"].get<std::string>());
        return names;
    };
    CHECK(verified("cornell-box") ==
          std::set<std::string>{"path", "light", "bdpt", "photon", "vcm", "mlt", "path-guided"});
    CHECK(verified("cornell-spheres") == std::set<std::string>{"path", "bdpt", "photon", "vcm", "mlt", "path-guided"});
}

TEST_CASE("verify: the reference makes what the methods make, or leaves out what they cannot") {
    const Folder workspace;
    workspace.write("caustic.xml", R"(<scene version="3.0.0"><sensor type="perspective">
        <transform name="to_world"><lookat origin="0,2,0.01" target="0,0,0" up="0,0,1"/></transform></sensor>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/></transform></shape>
        <shape type="sphere"><point name="center" value="0,0.4,0"/><float name="radius" value="0.2"/>
            <bsdf type="dielectric"/></shape>
        <emitter type="point"><point name="position" value="0,1,0"/></emitter></scene>)");
    const auto compared = [&](const std::string& scene, std::vector<std::string> more) {
        more.insert(more.begin(), {"verify", scene, "--size", "4x4", "--seconds", "0.01", "--json", "-"});
        const auto json = nlohmann::json::parse(run(workspace, more).out);
        std::set<std::string> lines;
        for (const auto& v : json["verdicts"]) {
            std::string line = v["method"].get<std::string>() + ", " + v["reference"].get<std::string>();
            if (!v["left_out"].is_null()) line += ", without " + v["left_out"].get<std::string>();
            if (!v["reference_lacks"].is_null()) line += ", which lacks " + v["reference_lacks"].get<std::string>();
            lines.insert(line);
        }
        return lines;
    };
    using Lines = std::set<std::string>;
    const std::string caustics = "caustics of point and directional lights";
    CHECK(compared("caustic.xml", {"--bootstrap", "1000"}) ==
          Lines{"path-nee, bdpt, without " + caustics, "path-guided, bdpt, without " + caustics,
                "light, bdpt, without what is seen in mirrors or through glass", "mlt, bdpt",
                "photon, bdpt, which lacks " + caustics + ", seen in mirrors or through glass",
                "vcm, bdpt, which lacks " + caustics + ", seen in mirrors or through glass"});
    CHECK(compared("caustic.xml", {"--methods", "vcm", "--reference", "path-nee"}) ==
          Lines{"vcm, path-nee, which lacks " + caustics});
    CHECK(compared("cornell-spheres", {"--methods", "light"}) ==
          Lines{"light, bdpt, without what is seen in mirrors or through glass"});
    CHECK(compared("cornell-box", {"--methods", "vcm"}) == Lines{"vcm, path-nee"});
    CHECK(compared("cornell-box", {"--methods", "path-nee"}) == Lines{"path-nee, path"});
}

// False alarm: 1e-3.
TEST_CASE("verify: the options of single methods hold for those that have them") {
    const Folder workspace;
    // Light is spread over the whole box, so the picture has no shadows.
    const Ended blurred =
        run(workspace, {"verify", "cornell-box", "--methods", "photon", "--reference", "path-nee", "--radius", "1000",
                        "--size", "16x16", "--seconds", "5", "--lengths", "0", "--json", "-"});
    CHECK(blurred.status != 0);
    CHECK(nlohmann::json::parse(blurred.out)["verdicts"][0]["parts"][0]["bias_interval"][0][1] < -0.2);
    const Ended sharp = run(workspace, {"verify", "furnace", "--methods", "vcm,path-nee", "--radius", "0", "--size",
                                        "8x8", "--seconds", "20", "--lengths", "0", "--tolerance", "0.1"});
    CHECK(sharp.status == 0);
}

TEST_CASE("verify: too little time is no agreement") {
    const Folder workspace;
    const Ended ended = run(
        workspace, {"verify", "cornell-box", "--size", "16x16", "--seconds", "0.2", "--tolerance", "1e-4", "--quiet"});
    CHECK(ended.status == 3);
    CHECK(ended.out == "");
    CHECK(ended.err == "");
}

// False alarms: 1e-3 each.
TEST_CASE("verify: files against files, and against a method") {
    const Folder workspace;
    write_noise(workspace, "a", 12, 1, 1);
    write_noise(workspace, "b", 9, 1, 2);
    write_noise(workspace, "c", 12, 1.06f, 3);
    write_noise(workspace, "two", 8, 2, 4);
    const Ended same = run(workspace, {"verify", "--images", "a-*.pfm", "--against", "b-*.pfm", "--tolerance", "0.1"});
    CHECK(same.status == 0);
    CHECK(same.prints("a-*.pfm against b-*.pfm: agrees."));
    const Ended other = run(workspace, {"verify", "--images", "c-*.pfm", "--against", "b-*.pfm", "--json", "-"});
    CHECK(other.status == 1);
    const auto json = nlohmann::json::parse(other.out);
    CHECK(json["verdicts"][0]["verdict"] == "disagrees");

    CHECK(json["verdicts"][0]["parts"][0]["bias_interval"][1][0] > 0);
    // The furnace is 2 everywhere; the reference is rendered at the images' size. A list of files is as good as a
    // pattern.
    CHECK(run(workspace, {"verify", "furnace", "--images", "two-1.pfm", "two-2.pfm", "two-3.pfm", "two-4.pfm",
                          "two-5.pfm", "two-6.pfm", "two-7.pfm", "--reference", "path-nee", "--tolerance", "0.5"})
              .status == 0);
    CHECK(run(workspace, {"verify", "furnace", "--images", "c-*.pfm", "--reference", "path-nee"}).status == 1);
}

TEST_CASE("verify: what it cannot do is an error that says what to do, and nothing is written") {
    const Folder workspace;
    write_noise(workspace, "a", 4, 1, 1);
    write_noise(workspace, "few", 2, 1, 1);
    for (int n = 1; n <= 3; ++n)
        lightswitch::save(workspace / ("same-" + std::to_string(n) + ".pfm"), lightswitch::Image(24, 16));
    lightswitch::Image broken(24, 16);
    broken(7, 3).y = std::nanf("");
    lightswitch::save(workspace / "nan-1.pfm", broken);
    broken(7, 3).y = 1;
    lightswitch::save(workspace / "nan-2.pfm", broken);
    lightswitch::save(workspace / "nan-3.pfm", lightswitch::Image(24, 16));
    lightswitch::save(workspace / "size-1.pfm", lightswitch::Image(24, 16));
    lightswitch::save(workspace / "size-2.pfm", lightswitch::Image(24, 17));
    lightswitch::save(workspace / "size-3.pfm", broken);
    for (int n = 1; n <= 3; ++n) workspace.write("bad-" + std::to_string(n) + ".pfm", "PF\n4 4\n-1\nshort");
    const std::set<std::string> before = workspace.files();
    const std::vector<std::pair<std::vector<std::string>, std::string>> calls{
        {{"verify"}, "verify: name a scene"},
        {{"verify", "furnace", "--methods", "phong"}, "phong is heuristic"},
        {{"verify", "furnace", "--methods", "pth"}, "--methods: there is no method \"pth\"; did you mean \"path\"?"},
        {{"verify", "furnace", "--reference", "silhouette"}, "the reference must be unbiased"},
        {{"verify", "furnace", "--reference", "bdp"}, "--reference: there is no method"},
        {{"verify", "furnace", "--methods", "bdpt,path-nee", "--radius", "1"},
         "--radius: there is no such setting in path, bdpt, path-nee; it belongs to photon, vcm"},
        {{"verify", "furnace", "--methods", "vcm,photon", "--radius", "0"}, "photon would gather nothing"},
        {{"verify", "furnace", "--bootstrap", "0"}, "--bootstrap: \"0\""},
        {{"verify", "--images", "a-*.pfm", "--against", "a-*.pfm", "--radius", "1"}, "files have no settings"},
        {{"verify", "furnace", "--confidence", "1"}, "--confidence: it must be below 1"},
        {{"verify", "furnace", "--seconds", "0"}, "--seconds"},
        {{"verify", "furnace", "--images", "none-*.pfm"}, "--images: no file matches \"none-*.pfm\""},
        {{"verify", "furnace", "--images", "few-*.pfm"}, "2 files are given; at least 3 independent renders"},
        {{"verify", "furnace", "--images", "same-*.pfm"}, "same-1.pfm and same-2.pfm are the same image"},
        {{"verify", "furnace", "--images", "nan-*.pfm"}, "nan-1.pfm: pixel (7, 3) is not finite"},
        {{"verify", "furnace", "--images", "bad-*.pfm"}, "bad-1.pfm: "},
        {{"verify", "furnace", "--images", "size-*.pfm"}, "size-1.pfm and size-2.pfm: images of different size"},
        {{"verify", "furnace", "--images", "a-*.pfm", "--methods", "path"}, "leave out --methods"},
        {{"verify", "furnace", "--images", "a-*.pfm", "--size", "8x8"}, "--size 8x8: the images have 24x16 pixels"},
        {{"verify", "furnace", "--against", "a-*.pfm"}, "name the others with --images"},
        {{"verify", "furnace", "--images", "a-*.pfm", "--against", "a-*.pfm"}, "leave out the scene"},
        {{"verify", "--images", "a-*.pfm", "furnace"}, "name the scene before the files"},
        {{"verify", "--images", "a-*.pfm", "--against", "a-*.pfm"}, "share an image"},
        {{"verify", "--images", "a-*.pfm", "--against", "a-*.pfm", "--methods", "path"}, "leave out --methods"},
        {{"verify", "furnace", "--reference", "a-1.pfm"}, "files are named with --images and --against"},
        {{"verify", "furnace", "--report", "x", "--json", "x"}, "name the same file"},
        {{"verify", "furnace", "--report", "nowhere/x.html"}, "nowhere"},
        {{"verify", "none.xml"}, "none.xml"}};
    for (const auto& [arguments, message] : calls) {
        const Ended ended = run(workspace, arguments);
        INFO(message, " : ", ended.err);
        CHECK(ended.status == 2);
        CHECK(ended.out == "");
        CHECK(ended.err.find(message) != std::string::npos);
        CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    }
    CHECK(workspace.files() == before);
}
