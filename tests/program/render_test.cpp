// What the program writes when all is well.

#include "../support/relative.hpp"
#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

using namespace lightswitch::test;

namespace {

std::vector<std::string> furnace(std::vector<std::string> more) {
    std::vector<std::string> words{"render", "furnace", "--size", "16x12", "--spp", "4"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The number behind `"key": ` in JSON text; NaN when there is none.
double number(const std::string& json, const std::string& key) {
    const std::string label = "\"" + key + "\": ";
    const std::size_t at = json.find(label);
    return at == std::string::npos ? std::nan("") : std::strtod(json.c_str() + at + label.size(), nullptr);
}

/// A square that `light` shines on, seen from one unit away.
std::string small_scene(const std::string& light, const std::string& sensor_extra = "") {
    return "<scene version=\"3.0.0\">\n"
           "  <integrator type=\"path\"><integer name=\"max_depth\" value=\"3\"/></integrator>\n"
           "  <sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>" +
           sensor_extra +
           "<transform name=\"to_world\"><lookat origin=\"0,0,1\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
           "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"$spp\"/></sampler>"
           "<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"6\"/></film>"
           "</sensor>\n"
           "  <shape type=\"rectangle\"><bsdf type=\"diffuse\"/></shape>\n" +
           light + "</scene>\n";
}

}  // namespace

TEST_CASE("one render goes to several files and formats") {
    const Folder workspace;
    std::vector<std::string> words =
        furnace({"-o", "a.pfm", "--output=b.hdr", "--output", "c.PNG", "--stats", "s.json"});
    std::set<std::string> wanted{"a.pfm", "b.hdr", "c.PNG", "s.json"};
    if (lightswitch::detail::has_exr) {
        words.insert(words.end(), {"-o", "d.exr"});
        wanted.insert("d.exr");
    }
    const Ended ended = run(workspace, words);
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    CHECK(ended.prints("path-nee (unbiased): 4 samples per pixel in "));
    CHECK(ended.prints("; wrote a.pfm, b.hdr, c.PNG"));
    CHECK(workspace.files() == wanted);

    const lightswitch::Image image = lightswitch::load_image(workspace / "a.pfm");
    CHECK(image.width() == 16);
    CHECK(image.height() == 12);
    CHECK(image.mean().x == relative(2, 0.5));  // 1 / (1 - 0.5), but for noise
    CHECK(lightswitch::load_image(workspace / "b.hdr").mean().x == relative(image.mean().x, 0.02));
    CHECK(read_text(workspace / "c.PNG").starts_with("\x89PNG"));
    if (lightswitch::detail::has_exr) {
        const lightswitch::Image exr = lightswitch::load_image(workspace / "d.exr");
        CHECK(exr.pixels() == image.pixels());
        CHECK(exr.metadata.at("method") == "path-nee");
    }
}

TEST_CASE("the image depends on the seed and the sampler, and not on the number of threads") {
    const Folder workspace;
    const auto bytes = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = furnace({"-q", "-o", "x.pfm"});
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = run(workspace, words);
        CHECK(ended.status == 0);
        CHECK(ended.out == "");
        CHECK(ended.err == "");
        return read_text(workspace / "x.pfm");
    };
    const std::string image = bytes({"--threads", "1"});
    CHECK(image.size() > 16 * 12 * 12);
    CHECK(image == bytes({"--threads", "3"}));
    CHECK(image != bytes({"--seed", "1"}));
    CHECK(image != bytes({"--sampler", "independent"}));
    CHECK(image != bytes({"--filter", "gaussian"}));
    CHECK(image != bytes({"--method", "path"}));
}

TEST_CASE("--aov: layers beside the same image") {
    if (!lightswitch::detail::has_exr) return;
    const Folder workspace;
    workspace.write("room.xml", small_scene("<emitter type=\"constant\"/>"));
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"render", "room.xml", "-D", "spp=4", "-o", "x.exr", "-o", "x.pfm"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = run(workspace, words);
        CHECK(ended.status == 0);
        CHECK(ended.err == "");
        return lightswitch::load_image(workspace / "x.exr");
    };
    const lightswitch::Image plain = render({});
    const lightswitch::Image image =
        render({"--aov", "albedo,depth,albedo", "--aov=normal,position", "--threads", "1"});
    CHECK(image.pixels() == plain.pixels());
    CHECK(image.pixels() == lightswitch::load_image(workspace / "x.pfm").pixels());
    CHECK(image.metadata.at("method") == "path-nee");
    CHECK(lightswitch::load_layer(workspace / "x.exr", "albedo")(3, 3) == lightswitch::Rgb(0.5f));
    CHECK(lightswitch::load_layer(workspace / "x.exr", "normal")(3, 3) == lightswitch::Rgb(0, 0, 1));
    const double depth = lightswitch::load_layer(workspace / "x.exr", "depth").mean().x;
    CHECK(depth == relative(1.025, 0.02));  // from 1 in the middle to 1.1 in the corners
    CHECK(lightswitch::load_layer(workspace / "x.exr", "position").mean().z == relative(0, 0).or_absolute(1e-6));
    CHECK_THROWS_AS(lightswitch::load_layer(workspace / "x.exr", "shape"), lightswitch::Error);
    const Ended compared = run(workspace, {"compare", "x.exr", "x.pfm"});
    CHECK(compared.status == 0);
    CHECK(compared.prints("RMSE        0\n"));

    std::filesystem::rename(workspace / "x.exr", workspace / "one.exr");
    render({"--aov", "position,depth,normal,albedo", "--threads", "3"});
    for (const char* name : {"albedo", "depth", "normal", "position"})
        CHECK(lightswitch::load_layer(workspace / "x.exr", name).pixels() ==
              lightswitch::load_layer(workspace / "one.exr", name).pixels());
}

TEST_CASE("the depth of paths is that of the command line") {
    // In the furnace every surface emits 1 and reflects half: depth d shows the first d terms of 1 + 1/2 + 1/4 + ...
    const Folder workspace;
    for (const auto& [depth, value] : {std::pair{"1", 1.0}, {"2", 1.5}, {"3", 1.75}}) {
        const Ended ended = run(workspace, furnace({"-m", "path", "--max-depth", depth, "-o", "x.pfm"}));
        CHECK(ended.status == 0);
        CHECK(lightswitch::load_image(workspace / "x.pfm").mean().x == relative(value, 1e-5));
    }
}

TEST_CASE("--stats: every key, and alone on standard output") {
    const Folder workspace;
    const Ended ended = run(workspace, furnace({"--stats", "-", "--max-depth", "7", "--seed", "5", "--threads", "2"}));
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("{\n"));
    CHECK(ended.out.ends_with("}\n"));
    CHECK(ended.says("path-nee (unbiased): 4 samples per pixel"));  // the summary gives way
    for (const char* key : {"method",
                            "kind",
                            "scene",
                            "scene_type",
                            "width",
                            "height",
                            "samples_per_pixel",
                            "seconds",
                            "rays",
                            "shadow_rays",
                            "rays_per_second",
                            "samples_per_second",
                            "threads",
                            "seed",
                            "sampler",
                            "max_depth",
                            "rr_depth",
                            "stand_ins",
                            "mean",
                            "estimated_error",
                            "non_finite",
                            "first_non_finite",
                            "splats",
                            "paths",
                            "triangles",
                            "spheres",
                            "lights",
                            "build_seconds",
                            "embree_bytes",
                            "scene_bytes",
                            "camera",
                            "embree_version",
                            "lightswitch_version",
                            "cancelled"}) {
        CAPTURE(key);
        CHECK(ended.prints("\n  \"" + std::string(key) + "\": "));
    }
    CHECK(ended.prints("\"method\": \"path-nee\""));
    CHECK(ended.prints("\"cancelled\": false"));
    for (const auto& [key, value] : {std::pair{"width", 16},
                                     {"height", 12},
                                     {"samples_per_pixel", 4},
                                     {"threads", 2},
                                     {"seed", 5},
                                     {"max_depth", 7},
                                     {"rr_depth", 5},
                                     {"triangles", 12},
                                     {"lights", 12}}) {
        CAPTURE(key);
        CHECK(number(ended.out, key) == value);
    }
    CHECK(number(ended.out, "rays") >= 16 * 12 * 4);
    CHECK(number(ended.out, "rays") > number(ended.out, "shadow_rays"));
    CHECK(number(ended.out, "samples_per_second") == relative(16 * 12 * 4 / number(ended.out, "seconds"), 1e-6));
    CHECK(run(workspace, furnace({"-m", "phong", "--stats", "-"})).prints("\"max_depth\": null"));
}

TEST_CASE("the budget: seconds and error end a render, whichever comes first") {
    const Folder workspace;
    const Ended by_error =
        run(workspace, {"render", "furnace", "--size", "8x8", "--error", "0.9", "--seconds", "60", "--stats", "-"});
    CHECK(by_error.status == 0);
    CHECK(number(by_error.out, "samples_per_pixel") == 16);  // judged from there on
    const Ended by_time =
        run(workspace, {"render", "furnace", "--size", "8x8", "--error", "1e-9", "--seconds", "0.2", "--stats", "-"});
    CHECK(by_time.status == 0);
    CHECK(number(by_time.out, "seconds") >= 0.2);
    CHECK(number(by_time.out, "seconds") < 20);
    const Ended by_samples =
        run(workspace, {"render", "furnace", "--size", "8x8", "--spp", "3", "--seconds", "60", "--stats", "-"});
    CHECK(number(by_samples.out, "samples_per_pixel") == 3);
}

TEST_CASE("--error on an image that stays black: nothing is claimed, and it ends and says why") {
    const Folder workspace;
    workspace.write("dark.xml", small_scene(""));
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"render", "dark.xml", "-D", "spp=4", "--error", "0.1", "--stats", "-"};
        words.insert(words.end(), more.begin(), more.end());
        return run(workspace, words);
    };
    const Ended alone = render({});
    CHECK(alone.status == 0);
    CHECK(number(alone.out, "samples_per_pixel") == 256);
    CHECK(alone.prints("\"estimated_error\": null"));
    CHECK(alone.prints("\"cancelled\": false"));
    CHECK(alone.says("warning: the image is black after 256 samples per pixel, so its error is not known"));
    CHECK_FALSE(alone.says("estimated error"));
    const Ended limited = render({"--spp", "300"});
    CHECK(number(limited.out, "samples_per_pixel") == 300);
    CHECK_FALSE(limited.says("its error is not known"));
}

TEST_CASE("a scene file: its requests hold unless the command line says otherwise") {
    const Folder workspace;
    workspace.write("room.xml", small_scene("<emitter type=\"constant\"/>"));
    const Ended plain = run(workspace, {"render", "room.xml", "--define", "spp=9", "--stats", "-"});
    CHECK(plain.status == 0);
    CHECK(number(plain.out, "samples_per_pixel") == 9);
    CHECK(number(plain.out, "max_depth") == 3);
    CHECK(number(plain.out, "width") == 8);
    CHECK(plain.prints("\"scene\": \"room.xml\""));
    CHECK(plain.prints("\"scene_type\": \"full\""));
    const Ended other = run(workspace, {"render", "room.xml", "-D", "spp=9", "--spp", "2", "--max-depth", "-1",
                                        "--size", "5x4", "--stats", "-"});
    CHECK(number(other.out, "samples_per_pixel") == 2);
    CHECK(number(other.out, "max_depth") == -1);
    CHECK(number(other.out, "width") == 5);
    CHECK(is_user_error(run(workspace, {"render", "room.xml", "--stats", "-"})));  // $spp has no value
}

TEST_CASE("warnings about what will not be seen") {
    const Folder workspace;
    const std::string point = "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"2\"/></emitter>";
    workspace.write("point.xml", small_scene(point));
    workspace.write("clipped.xml", small_scene(point,
                                               "<float name=\"near_clip\" value=\"5\"/>"
                                               "<float name=\"far_clip\" value=\"9\"/>"));
    workspace.write("dark.xml", small_scene(""));
    const auto warnings = [&](const std::string& scene, const std::string& method) {
        const Ended ended = run(workspace, {"render", scene, "-D", "spp=1", "-m", method, "-o", "x.pfm"});
        CHECK(ended.status == 0);
        return ended.err;
    };
    CHECK(warnings("point.xml", "path").find("warning: the method path cannot see the scene's 1 point") !=
          std::string::npos);
    CHECK(warnings("point.xml", "path-nee") == "");
    CHECK(warnings("clipped.xml", "path-nee").find("warning: the camera's near_clip 5 and far_clip 9") !=
          std::string::npos);
    CHECK(warnings("dark.xml", "path-nee").find("warning: the scene has no light") != std::string::npos);
    CHECK(warnings("dark.xml", "silhouette") == "");
    // A lamp in a wall, and one before it.
    const auto lamp = [](const char* z) {
        return small_scene(
            std::string("<shape type=\"rectangle\"/>\n<shape type=\"rectangle\"><transform name=\"to_world\">") +
            "<scale value=\"0.3\"/><rotate z=\"1\" angle=\"20\"/><translate z=\"" + z +
            "\"/></transform><emitter type=\"area\"/></shape>");
    };
    workspace.write("in.xml", lamp("0"));
    workspace.write("before.xml", lamp("0.001"));
    const std::string in_wall = warnings("in.xml", "path-nee");
    CHECK(in_wall.find(" % of this light lies in another surface") != std::string::npos);
    CHECK(in_wall.find("<shape type=\"rectangle\">: about") != std::string::npos);
    CHECK(run(workspace, {"info", "in.xml", "-D", "spp=1"}).says(" % of this light lies in another surface"));
    CHECK(warnings("before.xml", "path-nee") == "");
    CHECK(run(workspace, furnace({"-m", "phong", "--max-depth", "3", "-o", "x.pfm"}))
              .says("warning: the method phong has no"));
}

TEST_CASE("methods, info, version and help print") {
    const Folder workspace;
    const Ended methods = run(workspace, {"methods"});
    CHECK(methods.status == 0);
    for (const char* text :
         {"silhouette  heuristic", "phong       heuristic", "path        unbiased", "path-nee    unbiased"})
        CHECK(methods.prints(text));
    const Ended info = run(workspace, {"info", "cornell-spheres"});
    CHECK(info.status == 0);
    for (const char* text :
         {"full: Scene<", "256 x 256 pixels", "2 spheres", "1 conductor", "1 dielectric", "1 luminous mesh", "Embree"})
        CHECK(info.prints(text));
    CHECK(run(workspace, {"--version"}).out.starts_with("lightswitch "));
    for (const char* command : {"render", "compare", "verify", "strategies", "methods", "info"}) {
        const Ended help = run(workspace, {command, "--help"});
        CHECK(help.status == 0);
        CHECK(help.prints("Usage: lightswitch " + std::string(command)));
        const std::size_t examples = help.out.find("\nExamples:\n");
        REQUIRE(examples != std::string::npos);  // of its own
        CHECK(help.out.find("\n  lightswitch " + std::string(command), examples) != std::string::npos);
    }
    CHECK(workspace.files().empty());
}

TEST_CASE("a signal ends a render, and what is done is kept") {
    // A signal that comes before the render has begun ends the program as usual; then a later one is tried.
    for (const int signal : {SIGINT, SIGTERM}) {
        Ended ended;
        for (useconds_t wait = 250'000; wait <= 16'000'000 && ended.status == -1; wait *= 2) {
            const Folder workspace;
            Process process(workspace, {"render", "furnace", "--size", "8x8", "--spp", "2147483647", "-o", "x.pfm",
                                        "--stats", "s.json"});
            usleep(wait);
            process.signal(signal);
            ended = process.wait();
            if (ended.status == -1) continue;
            CHECK(ended.says("lightswitch: cancelled: the image holds "));
            CHECK(workspace.files() == std::set<std::string>{"s.json", "x.pfm"});
            CHECK(lightswitch::load_image(workspace / "x.pfm").mean().x == relative(2, 0.5));
            const std::string json = read_text(workspace / "s.json");
            CHECK(json.find("\"cancelled\": true") != std::string::npos);
            CHECK(number(json, "samples_per_pixel") >= 1);
        }
        CHECK(ended.status == 130);
    }
}

TEST_CASE("a signal before the first sample leaves nothing") {
    Ended ended;
    for (useconds_t wait = 250'000; wait <= 16'000'000 && ended.status == -1; wait *= 2) {
        const Folder workspace;  // one iteration takes several seconds
        Process process(workspace,
                        {"render", "furnace", "--size", "3000x3000", "--threads", "1", "-m", "path", "-o", "x.pfm"});
        usleep(wait);
        process.signal(SIGINT);
        ended = process.wait();
        if (ended.status == -1) continue;
        CHECK(ended.says("cancelled before the first sample was complete: nothing is written"));
        CHECK(workspace.files().empty());
    }
    CHECK(ended.status == 130);
}
