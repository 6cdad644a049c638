// Renders that are killed, cut, damaged, split and merged.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

#include <chrono>
#include <random>
#include <thread>

#include <sys/mount.h>
#include <sys/stat.h>

using namespace lightswitch::test;

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const Words box{"render", "cornell-box", "--size", "40x30", "--threads", "1"};

/// The file that a render writes to when nothing happens to it.
std::string undisturbed(const Folder& workspace, const Words& words) {
    REQUIRE(run(workspace, words + Words{"-o", "whole.pfm"}).status == 0);
    return read_text(workspace / "whole.pfm");
}

/// Names of the files that are there, without what a kill may have left behind.
bool nothing_left(const Folder& workspace) {
    for (const std::string& name : workspace.files())
        if (name.find(".tmp-") != std::string::npos) return false;
    return true;
}

}  // namespace

TEST_CASE("a render that is killed again and again ends with the image of one that was not") {
    const Folder workspace;
    std::mt19937 random(1);
    for (const auto& [method, samples] :
         {std::pair<std::string, std::string>("path-nee", "160"), {"vcm", "24"}, {"mlt", "24"}}) {
        CAPTURE(method);
        const Words words = box + Words{"--method", method, "--spp", samples};
        const std::string whole = undisturbed(workspace, words);
        const std::string state = method + ".lsw";
        const Words surviving =
            words + Words{"--checkpoint", state, "--every", "0.001", "--write-every", "0.01", "-o", "x.pfm"};
        int kills = 0;
        for (; kills < 25; ++kills) {
            Process process(workspace, surviving);
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 250000));
            if (!process.runs()) {
                process.wait();
                break;
            }
            process.signal(SIGKILL);
            process.wait();
        }
        const Ended last = run(workspace, surviving);
        CHECK(last.status == 0);
        CHECK(last.says("goes on from " + state));
        CHECK(read_text(workspace / "x.pfm") == whole);
        CHECK(nothing_left(workspace));
    }
}

TEST_CASE("the same command again renders nothing more; a larger --spp goes on") {
    const Folder workspace;
    const std::string whole = undisturbed(workspace, box + Words{"--spp", "6"});
    const Words kept{"--checkpoint", "x.lsw", "-o", "x.pfm"};
    CHECK(run(workspace, box + Words{"--spp", "4"} + kept).status == 0);
    const std::string state = read_text(workspace / "x.lsw");
    const Ended again = run(workspace, box + Words{"--spp", "4"} + kept);
    CHECK(again.status == 0);
    CHECK(again.says("goes on from x.lsw: 4 samples per pixel"));
    CHECK(read_text(workspace / "x.lsw") == state);
    CHECK(run(workspace, box + Words{"--spp", "6"} + kept).status == 0);
    CHECK(read_text(workspace / "x.pfm") == whole);
    const Ended fewer = run(workspace, box + Words{"--spp", "5"} + kept);
    CHECK(is_user_error(fewer));
    CHECK(fewer.says("x.lsw: it holds iterations 0 to 5 of seed 0, and asked for are 0 to 4"));
    // Seconds count all parts: there are none left.
    const Ended seconds = run(workspace, box + Words{"--seconds", "1e-6"} + kept);
    CHECK(seconds.status == 0);
    CHECK(seconds.prints("6 samples per pixel in "));
    CHECK(read_text(workspace / "x.pfm") == whole);
    // An error that is reached is not rendered further, and one that is not is.
    const std::string error = undisturbed(workspace, box + Words{"--error", "0.4", "--spp", "200"});
    CHECK(run(workspace, box + Words{"--error", "0.4", "--spp", "200"} + kept).status == 0);
    CHECK(read_text(workspace / "x.pfm") == error);
    CHECK(run(workspace, box + Words{"--error", "0.4", "--spp", "200"} + kept).status == 0);
    CHECK(read_text(workspace / "x.pfm") == error);
}

TEST_CASE("a cancelled render keeps its state, and layers come along in the end") {
    const Folder workspace;
    const Words words = box + Words{"--spp", "20000", "--checkpoint", "x.lsw", "-o", "x.pfm"};
    Process process(workspace, words);
    while (process.runs() && !std::filesystem::exists(workspace / "x.lsw")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        process.signal(SIGINT);
    }
    CHECK(process.wait().status == 130);
    REQUIRE(std::filesystem::exists(workspace / "x.lsw"));
    if (!lightswitch::detail::has_exr) return;
    const Words layers = box + Words{"--spp", "20", "--aov", "albedo,normal,depth"};
    CHECK(run(workspace, layers + Words{"-o", "whole.exr"}).status == 0);
    CHECK(run(workspace, layers + Words{"--spp", "20", "-o", "no.exr"}).status == 2);  // --spp twice
    CHECK(run(workspace, box + Words{"--spp", "7", "--checkpoint", "y.lsw"}).status == 0);
    CHECK(run(workspace, layers + Words{"--checkpoint", "y.lsw", "-o", "y.exr"}).status == 0);
    // All but what tells of time is the same; so is the size.
    CHECK(lightswitch::load_image(workspace / "y.exr").pixels() ==
          lightswitch::load_image(workspace / "whole.exr").pixels());
}

TEST_CASE("shares of a render merge to its image, and the result can be gone on with") {
    const Folder workspace;
    for (const std::string method : {"path-nee", "bdpt", "photon"}) {
        const Words words = box + Words{"--method", method, "--filter", "gaussian", "--sampler", "independent"};
        const std::string whole = undisturbed(workspace, words + Words{"--spp", "11"});
        const std::string more = undisturbed(workspace, words + Words{"--spp", "14"});
        for (const std::string k : {"1", "2", "3"})
            CHECK(run(workspace, words + Words{"--spp", "11", "--part", k + "/3", "--checkpoint", k + method}).status ==
                  0);
        const std::string a = "1" + method, b = "2" + method, c = "3" + method;
        const Ended merged = run(workspace, {"merge", c, a, b, "-o", "x.pfm", "--checkpoint", "all" + method});
        CHECK(merged.status == 0);
        CHECK(merged.prints("11 samples per pixel of 3 states (iterations 0 to 10 of seed 0)"));
        CHECK(read_text(workspace / "x.pfm") == whole);
        CHECK(run(workspace, words + Words{"--spp", "14", "--checkpoint", "all" + method, "-o", "x.pfm"}).status == 0);
        CHECK(read_text(workspace / "x.pfm") == more);
        const Ended twice = run(workspace, {"merge", a, b, a, "-o", "y.pfm"});
        CHECK(is_user_error(twice));
        CHECK(twice.says(a + ": iterations 0 to 2 of seed 0 are there twice"));
        CHECK_FALSE(std::filesystem::exists(workspace / "y.pfm"));
    }
    const Ended other = run(workspace, {"merge", "1bdpt", "2photon", "-o", "y.pfm"});
    CHECK(is_user_error(other));
    CHECK(other.says("2photon: is of another render: it has method photon, here bdpt"));
    const Ended part = run(workspace, box + Words{"--spp", "11", "--part", "2/3", "--method", "bdpt", "--filter",
                                                  "gaussian", "--sampler", "independent", "--checkpoint", "1bdpt"});
    CHECK(is_user_error(part));
    CHECK(part.says("1bdpt: it holds iterations 0 to 2 of seed 0, and --part 2/3 is 3 to 6"));
}

TEST_CASE("mlt has no shares, but seeds") {
    const Folder workspace;
    const Words mlt = box + Words{"--method", "mlt", "--bootstrap", "500", "--spp", "4"};
    const Ended part = run(workspace, mlt + Words{"--part", "1/2", "--checkpoint", "a"});
    CHECK(is_user_error(part));
    CHECK(part.says("--part: each iteration of mlt goes on from the one before; give every machine its own --seed"));
    CHECK(run(workspace, mlt + Words{"--seed", "1", "--checkpoint", "a"}).status == 0);
    CHECK(run(workspace, mlt + Words{"--seed", "2", "--checkpoint", "b"}).status == 0);
    CHECK(run(workspace, {"merge", "a", "b", "--checkpoint", "c"}).status == 0);
    const Ended on = run(workspace, mlt + Words{"--spp=9", "--seed", "2", "--checkpoint", "c"});
    CHECK(on.status == 2);
}

TEST_CASE("what is wrong with a checkpoint is said, and nothing is overwritten") {
    const Folder workspace;
    const Words kept = box + Words{"--spp", "4", "--checkpoint", "x.lsw", "-o", "x.pfm", "-q"};
    REQUIRE(run(workspace, kept).status == 0);
    const std::string good = read_text(workspace / "x.lsw"), image = read_text(workspace / "x.pfm");
    const auto refused = [&](const Words& words, const std::string& why) {
        CAPTURE(why);
        const std::string before = read_text(workspace / "x.lsw");
        const Ended ended = run(workspace, words);
        CAPTURE(ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(why));
        CHECK(read_text(workspace / "x.lsw") == before);
        CHECK(read_text(workspace / "x.pfm") == image);
    };
    const Words other{"render", "cornell-spheres", "--size", "40x30", "--spp", "4", "--checkpoint", "x.lsw", "-q"};
    refused(other, "x.lsw: is of another render: it has scene cornell-box, here cornell-spheres");
    refused(kept + Words{"--seed", "1"}, "it has seed 0, here 1");
    refused(kept + Words{"--method", "path"}, "it has method path-nee, here path");
    refused(kept + Words{"--max-depth", "3"}, "it has max depth -1, here 3");
    refused(kept + Words{"--robust"}, "it has content ");
    refused(kept + Words{"--part", "1/9"}, "--part: 4 samples in 9 shares leave none for number 1");
    refused(kept + Words{"--part", "9/8"}, "--part: \"9/8\" is not K/N");
    refused({"render", "cornell-box", "--part", "1/2", "-o", "y.pfm"}, "--part: name the file");
    refused(kept + Words{"--part", "1/2", "--error", "0.1"}, "--part: shares are of a number of samples");
    refused(kept + Words{"--every", "0"}, "--every: \"0\" is not a finite number above 0");
    refused({"render", "cornell-box", "--checkpoint", "y.lsw", "--write-every", "1"},
            "--write-every: there is no image");
    refused({"merge"}, "merge: name the states");
    refused({"merge", "x.lsw"}, "nothing would be kept");
    refused({"merge", "x.lsw", "--checkpoint", "x.lsw"}, "is read by this command");
    refused({"merge", "x.pfm", "-o", "y.pfm"}, "x.pfm: is not the state of a render");
    std::mt19937 random(2);
    for (int i = 0; i < 8; ++i) {
        std::string bytes = good;
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << i);
        workspace.write("x.lsw", bytes);
        refused(kept, "x.lsw: is ");
        workspace.write("x.lsw", good.substr(0, random() % good.size()));
        refused(kept, "x.lsw: is ");
    }
    workspace.write("x.lsw", good);
    CHECK(run(workspace, kept).status == 0);
    CHECK(read_text(workspace / "x.lsw") == good);
}

TEST_CASE("a file of the scene that has changed is another scene") {
    const Folder workspace;
    const auto scene = [](const char* radiance) {
        return "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "
               "value=\"8\"/><integer name=\"height\" value=\"8\"/></film></sensor><emitter type=\"constant\"><rgb "
               "name=\"radiance\" value=\"" +
               std::string(radiance) + "\"/></emitter></scene>";
    };
    workspace.write("a.xml", scene("1"));
    const Words words{"render", "a.xml", "--spp", "2", "--checkpoint", "x.lsw"};
    CHECK(run(workspace, words).status == 0);
    CHECK(run(workspace, words).status == 0);
    workspace.write("a.xml", scene("2"));
    const Ended ended = run(workspace, words);
    CHECK(is_user_error(Ended{ended.status, ended.out, ended.err.substr(ended.err.find('\n') + 1)}));
    CHECK(ended.says("x.lsw: is of another render: it has content "));
}

TEST_CASE("a directory that may not be written is found out before the work, a full disk is survived") {
    const Folder workspace;
    CHECK(is_user_error(run(workspace, box + Words{"--spp", "1", "--checkpoint", "none/x.lsw"})));
    if (geteuid() != 0) {
        MESSAGE("skipped: only root can make a small disk");
        return;
    }
    const auto disk = workspace / "disk";
    std::filesystem::create_directory(disk);
    if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
        MESSAGE("skipped: no file system can be mounted here");
        return;
    }
    const Words words = box + Words{"--spp", "40", "--checkpoint", "disk/x.lsw", "--every", "0.001", "-o", "x.pfm"};
    CHECK(run(workspace, box + Words{"--spp", "10", "--checkpoint", "disk/x.lsw"}).status == 0);
    std::ofstream(disk / "filler") << std::string(1 << 20, 'x');
    const std::string before = read_text(disk / "x.lsw");
    const Ended full = run(workspace, words);
    CHECK(full.status == 2);
    CHECK(full.says("warning: --checkpoint: disk/x.lsw: writing failed, nothing is left behind: No space left"));
    CHECK(full.says("error: --checkpoint: disk/x.lsw: writing failed"));
    CHECK(read_text(disk / "x.lsw") == before);
    CHECK(read_text(workspace / "x.pfm") == undisturbed(workspace, box + Words{"--spp", "40"}));
    std::filesystem::remove(disk / "filler");
    CHECK(run(workspace, words).status == 0);
    CHECK(read_text(workspace / "x.pfm") == read_text(workspace / "whole.pfm"));
    REQUIRE(mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "") == 0);
    const Ended read_only = run(workspace, box + Words{"--spp", "50", "--checkpoint", "disk/x.lsw"});
    CHECK(is_user_error(read_only));
    CHECK(read_only.says("--checkpoint: disk/x.lsw: "));
    CHECK(umount(disk.c_str()) == 0);
}
