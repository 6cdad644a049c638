#include "process.hpp"

#include <lightswitch/film/image_io.hpp>

using namespace lightswitch;
using namespace lightswitch::test;

TEST_CASE("--denoise: image, layers, statistics, and what the image says of itself") {
    const Folder workspace;
    const Ended ended = run(workspace, {"render", "cornell-box", "--size", "24x20", "--spp", "9", "--denoise", "own",
                                        "--aov", "depth", "-o", "x.exr", "-o", "x.png", "--stats", "-"});
    REQUIRE(ended.status == 0);
    for (const char* key : {"\"denoiser\": \"own\"", "\"denoise_seconds\"", "\"estimated_error_of_samples\"",
                            "\"estimated_error_of_denoised\"", "\"detail_from_samples\"", "\"samples_per_pixel\": 9"})
        CHECK(ended.prints(key));
    CHECK(ended.says("denoised by own"));
    const Image image = load_image(workspace / "x.exr");
    CHECK(image.metadata.at("denoised") == "own");
    CHECK(image.metadata.at("kind") == "consistent");
    CHECK(image.metadata.at("samples") == "9");
    for (const char* layer : {"error", "from_samples", "samples", "depth"})
        CHECK(!load_layer(workspace / "x.exr", layer).first_not_finite());
    CHECK(load_layer(workspace / "x.exr", "samples").pixels() != image.pixels());
    CHECK_THROWS_AS(load_layer(workspace / "x.exr", "albedo"), Error);  // a guide that nobody asked for
    CHECK(std::filesystem::exists(workspace / "x.png"));
}

TEST_CASE("--denoise: the same for any number of threads; ends at an error") {
    const Folder workspace;
    for (const char* threads : {"1", "2"})
        REQUIRE(run(workspace, {"render", "cornell-box", "--size", "24x20", "--spp", "6", "--denoise", "own",
                                "--threads", threads, "-q", "-o", std::string(threads) + ".pfm"})
                    .status == 0);
    CHECK(read_text(workspace / "1.pfm") == read_text(workspace / "2.pfm"));
    const Ended ended =
        run(workspace, {"render", "furnace", "--size", "16x12", "--error", "0.05", "--denoise", "own", "--stats", "-"});
    CHECK(ended.status == 0);
    CHECK(ended.prints("\"denoiser\": \"own\""));
}

TEST_CASE("--denoise: one sample has no error that is known; wrong names, and no library where one is asked for") {
    const Folder workspace;
    const Ended single =
        run(workspace, {"render", "furnace", "--size", "8x8", "--spp", "1", "--denoise", "own", "-o", "x.pfm"});
    CHECK(single.status == 0);
    CHECK(single.says("a single sample per pixel"));
    const Ended wrong = run(workspace, {"render", "furnace", "--denoise", "magic", "-o", "y.pfm"});
    CHECK(is_user_error(wrong));
    CHECK(wrong.says("auto, oidn, own"));
    const auto without_library = [] { return setenv("LIGHTSWITCH_OIDN", "/no/such/library", 1) == 0; };
    const auto with = [&](const char* name) {
        return Process(workspace,
                       {"render", "furnace", "--size", "8x8", "--spp", "4", "--denoise", name, "-o", "y.pfm"}, nullptr,
                       without_library)
            .wait();
    };
    const Ended missing = with("oidn");
    CHECK(is_user_error(missing));
    CHECK(missing.says("LIGHTSWITCH_OIDN"));
    CHECK(!std::filesystem::exists(workspace / "y.pfm"));
    const Ended other = with("auto");
    CHECK(other.status == 0);
    CHECK(other.prints("denoised by own"));
}
