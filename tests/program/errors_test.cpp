// What the program says to bad arguments: one line, status 2, and no file is touched.

#include "program/process.hpp"

using namespace lightswitch::test;

namespace {

struct BadCall {
    std::vector<std::string> arguments;
    std::string message;  // a part of it
};

void check_refused(const Folder& workspace, const std::vector<BadCall>& calls) {
    const auto before = workspace.files();
    for (const BadCall& call : calls) {
        std::string line;
        for (const std::string& word : call.arguments) line += " '" + word + "'";
        CAPTURE(line);
        const Ended ended = run(workspace, call.arguments);
        CAPTURE(ended.status);
        CAPTURE(ended.out);
        CAPTURE(ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(call.message));
        CHECK(workspace.files() == before);
    }
}

/// A render that would work, with more words.
std::vector<std::string> render(std::vector<std::string> more) {
    std::vector<std::string> words{"render", "furnace", "--output", "x.png"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_CASE("a command that is missing, unknown or misspelt") {
    const Folder workspace;
    check_refused(
        workspace,
        {
            {{}, "name a command: render, view, merge, compare, verify, sweep, strategies, replay, methods, info"},
            {{"rendr"},
             "did you mean \"render\"?; known are render, view, merge, compare, verify, sweep, strategies, replay, "
             "methods, info"},
            {{"--bogus"}, "there is no option \"--bogus\""},
            {{"methods", "path"}, "there is no use for \"path\""},
            {{"--", "render"}, "name a command"},
            {{"render", "furnace", "-o", "x.png", "info"}, "there is no use for \"info\""},
            {{"render", "furnace", "--out", "x.png"}, "did you mean \"--output\"?"},
            {{"info"}, "name a scene"},
            {{"info", "furnace", "--spp", "3"}, "there is no option \"--spp\""},
        });
}

TEST_CASE("render: scenes and methods that do not exist") {
    const Folder workspace;
    workspace.write("mesh.txt", "v 0 0 0\n");
    workspace.write("broken.xml", "<scene version=\"3.0.0\">\n  <sensor type=\"fisheye\"/>\n</scene>\n");
    check_refused(
        workspace,
        {
            {{"render"}, "name a scene"},
            {{"render", "cornel-box", "-o", "x.png"}, "did you mean \"cornell-box\"?"},
            {{"render", "missing.xml", "-o", "x.png"}, "missing.xml: no such file"},
            {{"render", "mesh.txt", "-o", "x.png"}, "scene files end in .xml (Mitsuba)"},
            {{"render", "broken.xml", "-o", "x.png"}, "broken.xml:2: "},
            {render({"--method", "pathnee"}), "did you mean \"path-nee\"?; known are silhouette, phong, path"},
            {render({"--method", "radiosity"}), "no method \"radiosity\"; known are silhouette"},
            {render({"--method", "PATH"}), "did you mean \"path\"?"},
            {render({"--method", "Path_Nee"}), "did you mean \"path-nee\"?"},
            {render({"--method", "nee"}), "did you mean \"path-nee\"?"},
            {render({"--method", "photonmapping"}), "did you mean \"photon\"?"},
            {render({"--method", "xyz"}), "no method \"xyz\"; known are silhouette"},
            {render({"--method", ""}), "--method: the name is empty"},
            {{"render", "cornell", "-o", "x.png"}, "did you mean \"cornell-box\"?"},
            {{"verify", "furnace", "-m", "pth"}, "--methods: there is no method \"pth\"; did you mean \"path\"?"},
            {{"verify", "furnace", "-r", "pth"}, "--reference: there is no method \"pth\"; did you mean \"path\"?"},
            {render({"--define", "a=1"}), "stock scenes have no parameters"},
            {render({"--define", "a"}), "not NAME=VALUE"},
        });
}

TEST_CASE("render: outputs that cannot be written") {
    const Folder workspace;
    std::filesystem::create_directory(workspace / "folder.png");
    check_refused(workspace,
                  {
                      {{"render", "furnace"}, "name a file with --output"},
                      {{"render", "furnace", "-o", "folder.png"}, "is a directory"},
                      {{"render", "furnace", "-o", "missing/x.png"}, "the directory 'missing' does not exist"},
                      {{"render", "furnace", "-o", "x.jpg"}, "an image is one of .exr, .hdr, .pfm, .png"},
                      {{"render", "furnace", "-o", "x"}, "has no extension"},
                      {{"render", "furnace", "-o", ""}, "--output: the name is empty"},
                      {{"render", "furnace", "--stats", ""}, "--stats: the name is empty"},
                      {{"verify", "furnace", "--json", ""}, "--json: the name is empty"},
                      {{"verify", "furnace", "--report", ""}, "--report: the name is empty"},
                      {{"verify", "furnace", "--reference", ""}, "--reference: the name is empty"},
                      {{"strategies", "furnace", "--directory", ""}, "--directory: the name is empty"},
                      {{"compare", "a.pfm", "b.pfm", "--report", ""}, "--report: the name is empty"},
                      {{"compare", "a.pfm", "--reference", ""}, "--reference: the name is empty"},
                      {{"compare", "a.pfm", "b.pfm", "-o", "folder.png"}, "--output: folder.png: is a directory"},
                      // Found out before the work, which would take for ever.
                      {render({"--spp", "2147483647", "-o", "missing/x.png"}), "does not exist"},
                      {render({"--stats", "missing/s.json"}), "the directory 'missing' does not exist"},
                      {render({"--stats", "x.png"}), "name the same file"},
                  });
}

TEST_CASE("render: layers that do not exist or have no place") {
    const Folder workspace;
    check_refused(workspace,
                  {
                      {render({"--aov", "colour"}),
                       "--aov: there is no output \"colour\"; known are albedo, normal, depth, position, shape"},
                      {render({"--aov", "albedo,nomal"}), "did you mean \"normal\"?"},
                      {render({"--aov", "albedo,"}), "there is no output \"\""},
                      {render({"--aov", ""}), "there is no output \"\""},
                      {render({"--aov"}), "--aov needs a value"},
                      // Found out before the work, which would take for ever.
                      {render({"--aov", "albedo", "--spp", "2147483647"}), "--aov: only .exr files hold layers"},
                      {{"render", "furnace", "--aov", "depth", "--stats", "-"}, "--aov: only .exr files hold layers"},
                  });
}

TEST_CASE("render: values out of range") {
    const Folder workspace;
    check_refused(workspace, {
                                 {render({"--spp", "0"}), "\"0\" is not a whole number from 1"},
                                 {render({"--spp", "many"}), "\"many\" is not a whole number"},
                                 {render({"--spp", "99999999999"}), "is not a whole number from 1 to 2147483647"},
                                 {render({"--spp"}), "--spp needs a value"},
                                 {render({"--spp", "1", "--spp", "2"}), "--spp is given more than once"},
                                 {render({"--ssp", "1"}), "did you mean \"--spp\"?"},
                                 {render({"--seconds", "-1"}), "not a finite number above 0"},
                                 {render({"--seconds", "nan"}), "not a finite number above 0"},
                                 {render({"--error", "0"}), "not a finite number above 0"},
                                 {render({"--seed", "-1"}), "whole number of at least 0"},
                                 {render({"--threads", "-3"}), "whole number from 0"},
                                 {render({"--threads", "1000000"}), "whole number from 0"},
                                 {render({"--max-depth", "0"}), "1 is emission seen directly"},
                                 {render({"--max-depth", "-2"}), "whole number from -1"},
                                 {render({"--rr-depth", "-1"}), "whole number from 0"},
                                 {render({"--size", "64"}), "is not WIDTHxHEIGHT"},
                                 {render({"--size", "1e9x1e9"}), "is not WIDTHxHEIGHT"},
                                 {render({"--size", "1000000000x1000000000"}), "each side must be between 1 and"},
                                 {render({"--exposure", "inf"}), "not a finite number"},
                                 {render({"--sampler", "halton"}), "known are sobol, independent"},
                                 {render({"--filter", "sinc"}), "known are box, tent, gaussian"},
                                 {render({"stray"}), "there is no use for \"stray\""},
                             });
}

TEST_CASE("numbers at their extremes: every option names itself") {
    const Folder workspace;
    const auto refuse = [&](const std::string& command, std::initializer_list<std::string> options,
                            std::initializer_list<std::string> values) {
        std::vector<BadCall> calls;
        for (const std::string& option : options)
            for (const std::string& value : values) {
                calls.push_back({{command, "furnace", option, value}, option + ": "});
                if (command != "verify") calls.back().arguments.insert(calls.back().arguments.end(), {"-o", "x.png"});
            }
        check_refused(workspace, calls);
    };
    refuse("render", {"--spp", "--seconds", "--error", "--size"}, {"-5", "0", "nan", "inf", "", "x"});
    refuse("render", {"--spp", "--size", "--seed", "--threads", "--max-depth"},
           {"1e300", "99999999999999999999", "1.5"});
    refuse("verify", {"--seconds", "--confidence", "--tolerance", "--lengths"}, {"-5", "nan", "inf", ""});
    refuse("strategies", {"--spp", "--max-depth", "--size"}, {"-5", "0", "nan", ""});
}

TEST_CASE("behind -- stand files, whatever they are called") {
    const Folder workspace;
    workspace.write("-in.xml", "<scene version=\"3.0.0\">\n  <sensor type=\"perspective\"/>\n</scene>\n");
    const Ended info = run(workspace, {"info", "--", "-in.xml"});
    CHECK(info.status == 0);
    CHECK(info.prints("768 x 576 pixels"));
    CHECK(run(workspace, {"render", "--spp", "1", "--size", "4x4", "-q", "-o", "-1.pfm", "--", "-in.xml"}).status == 0);
    CHECK(run(workspace, {"render", "-in.xml", "--"}).says("no option \"-in.xml\""));
    CHECK(run(workspace, {"compare", "-o", "x.pfm", "--", "-1.pfm", "-1.pfm"}).status == 0);
    check_refused(workspace,
                  {
                      {{"render", "--", "-in.xml"}, "name a file with --output"},
                      {{"render", "furnace", "-o", "y.png", "--", "-x"}, "there is no use for"},
                      {{"compare", "--", "-1.pfm", "-1.pfm", "-o", "x.png"}, "./-o: has no extension"},
                      {{"render", "-o", "-1.pfm", "--stats", "-in.xml", "--", "-in.xml"}, "--stats: -in.xml is read"},
                      {{"verify", "--images", "-1.pfm", "x.pfm", "x.pfm", "--", "-out.xml"}, "are the same image"},
                  });
}

TEST_CASE("standard output that cannot be written is an error, and never a file") {
    const Folder workspace;
    const Ended closed =
        Process(workspace, {"render", "furnace", "--spp", "1", "--size", "4x4", "-o", "x.pfm"}, "").wait();
    CHECK(closed.status == 2);
    CHECK(closed.err == "lightswitch: error: standard output could not be written\n");
    CHECK(std::filesystem::file_size(workspace / "x.pfm") < 4 * 4 * 12 + 40);  // nothing but the image
    if (std::filesystem::exists("/dev/full")) {
        const Ended full = Process(workspace, {"methods"}, "/dev/full").wait();
        CHECK(full.status == 2);
        CHECK(full.err == "lightswitch: error: standard output could not be written\n");
    }
}
