// What surrounds the program: limits of the system, signals, and files that are already there.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <map>

#include <sys/resource.h>
#include <sys/stat.h>

#include <grp.h>

using namespace lightswitch::test;

namespace {

/// A black image in a file that takes hardly any room.
void write_black(const std::filesystem::path& path, int side) {
    const std::string header = "PF\n" + std::to_string(side) + " " + std::to_string(side) + "\n-1.0\n";
    std::ofstream(path, std::ios::binary) << header;
    const std::size_t pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::filesystem::resize_file(path, header.size() + 12 * pixels);
}

constexpr auto scene = R"(<scene version="3.0.0">
  <sensor type="perspective"><transform name="to_world"><lookat origin="0,0,3" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
  <shape type="obj"><string name="filename" value="mesh.obj"/><bsdf type="diffuse"/></shape>
  <emitter type="constant"/>
</scene>
)";

constexpr auto mesh = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

}  // namespace

TEST_CASE("where the system starts no more threads, fewer render, or an error says so") {
    if (geteuid() != 0) {
        MESSAGE("skipped: only root can become a user who has no other processes, whose number can then be limited");
        return;
    }
    constexpr uid_t nobody = 61437;  // some number that no user has
    for (const rlim_t most : {1u, 2u, 3u, 4u, 6u})
        for (const char* threads : {"2", "8"}) {
            const Folder workspace;
            REQUIRE(chmod(workspace.path().c_str(), 0777) == 0);
            Process process(
                workspace,
                {"render", "furnace", "--size", "8x8", "--spp", "2", "--threads", threads, "-q", "-o", "x.pfm"},
                nullptr, [most] {
                    const rlimit limit{most, most};
                    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // or it starts one more process
                    return setgroups(0, nullptr) == 0 && setgid(nobody) == 0 && setuid(nobody) == 0 &&
                           setrlimit(RLIMIT_NPROC, &limit) == 0;
                });
            const Ended ended = process.wait();
            if (ended.status == 127) {
                MESSAGE("skipped: another user may not run the program here");
                return;
            }
            CAPTURE(most);
            CAPTURE(threads);
            CAPTURE(ended.err);
            if (most == 1) {
                CHECK(is_user_error(ended));
                CHECK(ended.says("the system starts no thread for this program: "));
                CHECK(workspace.files().empty());
            } else {
                CHECK(ended.status == 0);
                CHECK(ended.err.empty());
                CHECK(workspace.files() == std::set<std::string>{"x.pfm"});
            }
        }
}

TEST_CASE("a file that may not become so large is an error, and nothing is left of it") {
    const Folder workspace;
    const Ended ended =
        Process(workspace, {"render", "furnace", "--size", "64x64", "--spp", "1", "-o", "x.pfm"}, nullptr, [] {
            const rlimit limit{2048, 2048};
            return setrlimit(RLIMIT_FSIZE, &limit) == 0;
        }).wait();
    CHECK(is_user_error(ended));
    CHECK(ended.says("x.pfm: writing failed, nothing is left behind: "));
    CHECK(workspace.files().empty());
}

TEST_CASE("no output replaces an input or another output, whatever the two are called") {
    const Folder workspace;
    workspace.write("scene.xml", scene);
    workspace.write("mesh.obj", mesh);
    for (int i = 1; i <= 3; ++i) {
        lightswitch::Image image(4, 4);
        image(0, 0) = lightswitch::Rgb(static_cast<float>(i));
        lightswitch::save(workspace / ("in" + std::to_string(i) + ".pfm"), image);
    }
    std::filesystem::create_directory(workspace / "folder");
    std::filesystem::create_symlink("in1.pfm", workspace / "link.pfm");
    std::filesystem::create_hard_link(workspace / "in1.pfm", workspace / "hard.pfm");
    std::filesystem::create_symlink("new.pfm", workspace / "to-new.pfm");
    std::map<std::string, std::string> before;
    for (const std::string& name : workspace.files())
        if (name != "to-new.pfm" && name != "folder") before[name] = read_text(workspace / name);

    struct Call {
        std::vector<std::string> words;
        std::string message;
    };
    const auto render = [](std::vector<std::string> more) {
        std::vector<std::string> words{"render", "scene.xml", "--spp", "1", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const auto compare = [](std::vector<std::string> more) {
        std::vector<std::string> words{"compare", "in1.pfm", "in2.pfm"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const auto verify = [](std::vector<std::string> more) {
        std::vector<std::string> words{"verify", "scene.xml", "-m", "path-nee", "--seconds", "0.01", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const std::vector<std::string> files{"verify",  "scene.xml", "--images", "in1.pfm",
                                         "in2.pfm", "in3.pfm",   "--size",   "4x4"};

    const auto with = [](std::vector<std::string> words, std::initializer_list<std::string> more) {
        words.insert(words.end(), more);
        return words;
    };
    const std::string absolute = (workspace / "in1.pfm").string();
    const Call calls[] = {
        {compare({"-o", "in1.pfm"}), "--output: in1.pfm is read by this command and is not overwritten"},
        {compare({"-o", "./folder/../in2.pfm"}), "--output: ./folder/../in2.pfm is read by this command (as in2.pfm)"},
        {compare({"-o", "link.pfm"}), "(as in1.pfm)"},
        {compare({"-o", "hard.pfm"}), "(as in1.pfm)"},
        {compare({"-o", absolute}), "(as in1.pfm)"},
        {compare({"--report", "in2.pfm"}), "--report: in2.pfm is read"},
        {{"compare", "in1.pfm", "-r", "in2.pfm", "-o", "in2.pfm"}, "--output: in2.pfm is read"},
        {compare({"-o", "x.png", "--report", "./x.png"}), "--output and --report name the same file, ./x.png"},
        {render({"-o", "x.png", "-o", "./x.png"}), "--output names the same file twice, ./x.png"},
        {render({"-o", "new.pfm", "-o", "to-new.pfm"}), "--output names the same file twice, to-new.pfm"},
        {render({"-o", "x.png", "--stats", "folder/../x.png"}), "--output and --stats name the same file"},
        {render({"--stats", "scene.xml"}), "--stats: scene.xml is read"},
        {render({"--stats", "mesh.obj"}), "--stats: mesh.obj is read"},
        {verify({"--json", "scene.xml"}), "--json: scene.xml is read"},
        {verify({"--report", "mesh.obj"}), "--report: mesh.obj is read"},
        {verify({"--report", "x", "--json", "./x"}), "--report and --json name the same file"},
        {with(files, {"--json", "in3.pfm"}), "--json: in3.pfm is read"},
        {with(files, {"--json", "mesh.obj"}), "--json: mesh.obj is read"},
        {{"strategies", "scene.xml", "-o", "folder/s0_t2.exr", "--directory", "folder"},
         "--output and --directory name"},
        {{"strategies", "scene.xml", "-o", "a.png", "-o", "./a.png"}, "--output names the same file twice"},
    };
    for (const Call& call : calls) {
        std::string line;
        for (const std::string& word : call.words) line += " " + word;
        CAPTURE(line);
        const Ended ended = run(workspace, call.words);
        CAPTURE(ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(call.message));
        for (const auto& [name, text] : before) CHECK(read_text(workspace / name) == text);
        CHECK(workspace.files().size() == before.size() + 2);
    }
    CHECK(run(workspace, render({"-o", "to-new.pfm"})).status == 0);  // an output of its own
    CHECK(std::filesystem::is_symlink(workspace / "to-new.pfm"));
    CHECK(std::filesystem::exists(workspace / "new.pfm"));
}

TEST_CASE("a directory that may not be written") {
    if (geteuid() == 0) {
        MESSAGE("skipped: root may write everywhere");
        return;
    }
    const Folder workspace;
    REQUIRE(chmod(workspace.path().c_str(), 0500) == 0);
    const Ended ended = run(workspace, {"render", "furnace", "-o", "x.pfm"});
    CHECK(is_user_error(ended));
    CHECK(ended.says("--output: x.pfm: cannot create a file in this directory"));
    REQUIRE(chmod(workspace.path().c_str(), 0700) == 0);
}

TEST_CASE("what Embree tells of itself never stands on standard output") {
    const Folder workspace;
    const Ended rendered =
        run(workspace, {"render", "furnace", "--size", "4x4", "--spp", "1", "--embree", "verbose=2", "--stats", "-"});
    CHECK(rendered.status == 0);
    CHECK(rendered.out.starts_with("{\n"));
    CHECK(rendered.out.ends_with("\n}\n"));
    CHECK(rendered.out.find("Embree Ray Tracing") == std::string::npos);
    CHECK(rendered.says("Embree Ray Tracing"));
    const Ended info = run(workspace, {"info", "furnace", "--embree", "verbose=1"});
    CHECK(info.out.starts_with("scene "));
    CHECK(info.says("Embree Ray Tracing"));
}

TEST_CASE("a hang-up ends a render as other signals do, more than one of them too, but not under nohup") {
    for (const bool ignored : {false, true}) {
        CAPTURE(ignored);
        Ended ended;
        for (useconds_t wait = 125'000; wait <= 16'000'000 && ended.status == -1; wait *= 2) {
            const Folder workspace;
            Process process(workspace,
                            {"render", "furnace", "--size", "8x8", "--spp", "2147483647", "-q", "-o", "x.pfm"}, nullptr,
                            [ignored] { return std::signal(SIGHUP, ignored ? SIG_IGN : SIG_DFL) != SIG_ERR; });
            usleep(wait);
            for (int i = 0; i < 3; ++i) process.signal(SIGHUP);
            if (ignored) {
                usleep(50'000);
                CHECK(process.runs());
                process.signal(SIGKILL);
                process.wait();
                break;
            }
            ended = process.wait();
            if (ended.status == -1) continue;
            CHECK(ended.says("lightswitch: cancelled: the image holds "));
            CHECK(workspace.files() == std::set<std::string>{"x.pfm"});
        }
        if (!ignored) CHECK(ended.status == 130);
    }
}

TEST_CASE("a signal while a file is written leaves it whole, and no other") {
    const Folder workspace;
    write_black(workspace / "a.pfm", 2000);
    const std::string target = "difference.pfm";
    bool caught = false;
    for (int attempt = 0; attempt < 3 && !caught; ++attempt) {
        std::filesystem::remove(workspace / target);
        Process process(workspace, {"compare", "a.pfm", "a.pfm", "-o", target});
        while (!caught && process.runs()) {
            for (const std::string& name : workspace.files()) {
                std::error_code gone;
                const auto size = std::filesystem::file_size(workspace / name, gone);
                caught |= name[0] == '.' && !gone && size > 0;
            }
            if (!caught) usleep(200);
        }
        if (!caught) continue;
        process.signal(SIGTERM);
        process.wait();
        REQUIRE(workspace.files() == std::set<std::string>{"a.pfm", target});
        CHECK(std::filesystem::file_size(workspace / target) > 12u * 2000 * 2000);
    }
    if (!caught) MESSAGE("the program always wrote the file before it was seen: nothing is tested");
}
