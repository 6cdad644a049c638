// The sub-command sweep.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <chrono>
#include <thread>

using namespace lightswitch::test;

TEST_CASE("sweep: a table, the curves, and a page") {
    const Folder workspace;
    const Ended ended = run(workspace, {"sweep", "cornell-box", "--size", "16x12", "--seconds", "0.02", "--seeds", "2",
                                        "--csv", "curves.csv", "--report", "sweep.html"});
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    for (const char* text : {"Reference: ", "\nmethod ", "\npath-nee ", "\nmlt ", "\nBest: "})
        CHECK(ended.prints(text));
    CHECK(!ended.prints("phong"));
    const std::string csv = read_text(workspace / "curves.csv");
    CHECK(csv.starts_with("method,kind,iterations,seconds,relmse,low,high,seeds,resolved\npath,unbiased,"));
    CHECK(csv.find("\nphoton,consistent,") != std::string::npos);
    CHECK(csv.find(",2,1\n") != std::string::npos);
    const std::string page = read_text(workspace / "sweep.html");
    CHECK(page.find("cornell-box: error over time") != std::string::npos);
    CHECK(page.find("src=\"http") == std::string::npos);
    CHECK(workspace.files() == std::set<std::string>{"curves.csv", "sweep.html"});
}

TEST_CASE("sweep: some methods against an image, and the table alone on standard output") {
    const Folder workspace;
    CHECK(run(workspace, {"render", "cornell-box", "--size", "16x16", "--spp", "64", "--output", "truth.pfm"}).status ==
          0);
    const Ended ended = run(workspace, {"sweep", "cornell-box", "--methods", "bdpt,path-nee,bdpt", "--reference",
                                        "truth.pfm", "--seconds", "0.01", "--csv", "-"});
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("method,kind,"));
    CHECK(ended.prints("\nbdpt,"));
    CHECK(ended.prints("\npath-nee,"));
    CHECK(!ended.prints("\nvcm,"));
    CHECK(ended.says("Reference: an image that was given. Its own relMSE is about"));
    const Ended quiet = run(workspace, {"sweep", "cornell-spheres", "--methods", "all", "--radius", "2", "--size",
                                        "8x8", "--seconds", "0.005", "--seeds", "1", "--quiet"});
    CHECK(quiet.status == 0);
    CHECK(quiet.out + quiet.err == "");
    CHECK(run(workspace, {"sweep", "cornell-spheres", "--size", "8x8", "--seconds", "0.005", "--seeds", "1"})
              .says("light cannot show what is seen in mirrors or through glass: that is part of its error"));
}

TEST_CASE("sweep: Ctrl-C keeps what was measured, or writes nothing") {
    const Folder workspace;
    const auto after = [&](double seconds, std::vector<std::string> more) {
        more.insert(more.begin(), {"sweep", "cornell-box", "--size", "16x16", "--csv", "curves.csv"});
        Process process(workspace, more);
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        process.signal(SIGINT);
        return process.wait();
    };
    const Ended early = after(0.5, {"--reference-seconds", "1000"});
    CHECK(early.status == 130);
    CHECK(early.says("cancelled before anything was measured: nothing is written"));
    CHECK(workspace.files().empty());
    const Ended late = after(2, {"--reference-seconds", "0.1", "--seconds", "20"});
    CHECK(late.status == 130);
    CHECK(late.says("cancelled: 0 of 4 seeds are whole"));
    CHECK(late.prints("\npath-nee "));
    CHECK(read_text(workspace / "curves.csv").find("\npath-nee,") != std::string::npos);
}

TEST_CASE("sweep: what it cannot do is an error that says what to do, and nothing is written") {
    const Folder workspace;
    lightswitch::save(workspace / "small.pfm", lightswitch::Image(4, 4));
    const std::set<std::string> before = workspace.files();
    const std::vector<std::pair<std::vector<std::string>, std::string>> calls{
        {{}, "sweep: name a scene"},
        {{"cornell-box", "--methods", "phong"}, "--methods: phong is heuristic"},
        {{"cornell-box", "--methods", "pth"}, "did you mean \"path\"?"},
        {{"cornell-box", "--methods", "photon,vcm"}, "no method is unbiased"},
        {{"cornell-box", "--methods", "path", "--radius", "1"}, "--radius: there is no such setting in path"},
        {{"cornell-box", "--seconds", "0"}, "--seconds"},
        {{"cornell-box", "--seeds", "0"}, "--seeds: \"0\""},
        {{"cornell-box", "--max-depth", "0"}, "--max-depth: 0 would show nothing"},
        {{"cornell-box", "--reference", "none.pfm"}, "none.pfm"},
        {{"cornell-box", "--reference", "small.pfm", "--size", "8x8"}, "--size 8x8: the reference has 4x4 pixels"},
        {{"cornell-box", "--reference", "small.pfm", "--csv", "small.pfm"}, "is read by this command"},
        {{"cornell-box", "--csv", "a", "--report", "a"}, "name the same file"},
        {{"cornell-box", "--report", "none/page.html"}, "--report: "},
    };
    for (const auto& [arguments, message] : calls) {
        std::vector<std::string> words{"sweep"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        const Ended ended = run(workspace, words);
        CHECK_MESSAGE(is_user_error(ended), message);
        CHECK_MESSAGE(ended.says(message), ended.err);
    }
    CHECK(workspace.files() == before);
}
