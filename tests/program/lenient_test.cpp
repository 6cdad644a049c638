// Scene files that ask for what is not supported, and the options that say how a scene is read and shown.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <algorithm>

using namespace lightswitch::test;

namespace {

/// A scene with two things that are not supported, in lines 3 and 4.
const std::string scene =
    "<scene version=\"3.0.0\">\n<sensor type=\"perspective\" id=\"wide\"><film type=\"hdrfilm\"><integer "
    "name=\"width\" "
    "value=\"8\"/><integer name=\"height\" value=\"6\"/></film></sensor>\n"
    "<shape type=\"sphere\"><bsdf type=\"hair\"/></shape>\n"
    "<emitter type=\"sun\"/>\n<emitter type=\"constant\"/></scene>";

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t result = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++result;
    return result;
}

}  // namespace

TEST_CASE("a strict render refuses what is not supported, and says how to go on") {
    const Folder workspace;
    workspace.write("room.xml", scene);
    for (const char* command : {"render", "verify", "strategies"}) {
        std::vector<std::string> words{command, "room.xml"};
        if (command != std::string("verify")) words.insert(words.end(), {"-o", "x.png"});
        const Ended ended = run(workspace, words);
        CHECK(is_user_error(ended));
        CHECK(ended.says("room.xml:3: <bsdf type=\"hair\">: unknown type \"hair\""));
        CHECK(ended.says("(2 things are not supported: \"lightswitch info\" lists them, --lenient goes on with "));
    }
    CHECK(workspace.files() == std::set<std::string>{"room.xml"});
}

TEST_CASE("--lenient renders with stand-ins, warns of each once, and keeps them beside the image") {
    const Folder workspace;
    workspace.write("room.xml", scene);
    const Ended ended =
        run(workspace, {"render", "room.xml", "--lenient", "--quiet", "--spp", "1", "-o", "x.hdr", "--stats", "-"});
    CHECK(ended.status == 0);
    CHECK(count(ended.err, "lightswitch: warning: room.xml:") == 2);
    CHECK(ended.says("room.xml:3: <bsdf type=\"hair\">: "));
    CHECK(ended.says("; it is diffuse\n"));
    CHECK(ended.says("room.xml:4: <emitter type=\"sun\">: "));
    CHECK(ended.says("; it is left out\n"));
    CHECK(count(ended.out, "\"room.xml:") == 2);
    const std::string kept = lightswitch::load_image(workspace / "x.hdr").metadata.at("stand_ins");
    CHECK(kept.starts_with("room.xml:3: <bsdf type=\"hair\">: "));
    CHECK(kept.find("; it is diffuse | room.xml:4: <emitter type=\"sun\">: ") != std::string::npos);
}

TEST_CASE("info lists every problem and what --lenient does about it") {
    const Folder workspace;
    workspace.write("room.xml", scene);
    const Ended strict = run(workspace, {"info", "room.xml"});
    CHECK(strict.status == 0);
    CHECK(strict.err.empty());
    CHECK(strict.prints("8 x 6 pixels"));
    CHECK(strict.prints("problems    2 things are not supported; with --lenient a render goes on like this:\n"));
    CHECK(count(strict.out, "            room.xml:") == 2);
    CHECK(strict.prints("room.xml:4: <emitter type=\"sun\">: "));
    const auto before_build = [](const std::string& text) { return text.substr(0, text.find("memory ")); };
    CHECK(before_build(run(workspace, {"info", "room.xml", "--lenient"}).out) == before_build(strict.out));
    CHECK_FALSE(run(workspace, {"info", "furnace"}).prints("problems"));
}

TEST_CASE("--sensor and --path") {
    const Folder workspace;
    std::filesystem::create_directory(workspace / "meshes");
    workspace.write("meshes/t.obj", "v 0 0 3\nv 1 0 3\nv 0 1 3\nf 1 2 3\n");
    workspace.write(
        "room.xml",
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><sensor type=\"orthographic\" id=\"plan\"/><shape "
        "type=\"obj\"><string name=\"filename\" value=\"t.obj\"/></shape></scene>");
    CHECK(run(workspace, {"info", "room.xml"}).prints("t.obj: no such file; it is left out"));
    const Ended found = run(workspace, {"info", "room.xml", "--path", "meshes", "--sensor", "plan"});
    CHECK(found.err.empty());
    CHECK(found.prints("1 mesh of 1 triangle"));
    CHECK(found.prints("orthographic"));
    CHECK(run(workspace, {"info", "room.xml", "--path", "meshes", "--sensor", "1"}).prints("orthographic"));
    CHECK(run(workspace, {"info", "room.xml", "--path", "meshes"}).says("is one of 2 sensors: the first is used"));
    for (const auto& [words, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"info", "room.xml", "--sensor", "2"}, "there is no sensor \"2\"; known are 0 to 1, \"plan\""},
             {{"info", "room.xml", "--sensor", ""}, "--sensor: the name is empty"},
             {{"info", "room.xml", "--path", ""}, "--path: the name is empty"},
             {{"info", "meshes/t.obj", "--path", "meshes"}, "--path: only the files that Mitsuba scenes name"},
             {{"info", "furnace", "--path", "meshes"}, "--path: the stock scenes have no files"},
             {{"info", "furnace", "--sensor", "1"}, "--sensor: the stock scenes have one camera each"}}) {
        const Ended ended = run(workspace, words);
        CHECK(is_user_error(ended));
        CHECK(ended.says(message));
    }
}

TEST_CASE("--exposure: given, the scene's, or by the image") {
    const Folder workspace;
    const auto scene_with = [](const std::string& film) {
        return "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"ldrfilm\"><integer name=\"width\" "
               "value=\"4\"/><integer name=\"height\" value=\"4\"/>" +
               film +
               "</film></sensor><emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.72\"/></emitter></scene>";
    };
    workspace.write("plain.xml", scene_with(""));
    workspace.write("asks.xml", scene_with("<float name=\"exposure\" value=\"-1.5\"/>"));
    const auto render = [&](const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> words{"render", name, "--spp", "1", "-o", "x.png"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = run(workspace, words);
        CHECK(ended.status == 0);
        return ended.out;
    };
    const auto has = [](const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(render("plain.xml", {}), ", exposure -2 stops; wrote x.png"));
    const std::string automatic = read_text(workspace / "x.png");
    CHECK(has(render("plain.xml", {"--exposure", "-2"}), ", exposure -2 stops"));
    CHECK(read_text(workspace / "x.png") == automatic);
    CHECK(has(render("plain.xml", {"--exposure", "0"}), ", exposure 0 stops"));
    CHECK(read_text(workspace / "x.png") != automatic);
    CHECK(has(render("asks.xml", {}), ", exposure -1.5 stops"));
    CHECK(has(render("asks.xml", {"--exposure", "auto"}), ", exposure -2 stops"));
    CHECK(has(render("asks.xml", {"--exposure", "1"}), ", exposure 1 stops"));
    CHECK_FALSE(has(run(workspace, {"render", "plain.xml", "--spp", "1", "-o", "x.pfm"}).out, "exposure"));
}
