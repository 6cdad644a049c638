// The sub-command compare.

#include "program/process.hpp"

#include <lightswitch/film/image_io.hpp>

using namespace lightswitch::test;

namespace {

lightswitch::Image image(int width, int height, float value) {
    lightswitch::Image result(width, height);
    for (auto& pixel : result.pixels()) pixel = lightswitch::Rgb(value, 2 * value, 4 * value);
    return result;
}

}  // namespace

TEST_CASE("compare prints the metrics and writes the difference") {
    const Folder workspace;
    lightswitch::Image a = image(20, 10, 1);
    a(7, 3).y += 0.5f;
    lightswitch::save(workspace / "a.pfm", a);
    lightswitch::save(workspace / "b.pfm", image(20, 10, 1));
    const Ended ended = run(workspace, {"compare", "a.pfm", "b.pfm", "-o", "d.png", "-o", "d.pfm"});
    CHECK(ended.status == 0);
    CHECK(ended.err == "");
    CHECK(ended.prints("mean A      1 2.0025 4\n"));
    CHECK(ended.prints("mean B      1 2 4\n"));
    CHECK(ended.prints("mean ratio  1.000357\n"));     // 7.0025 / 7
    CHECK(ended.prints("MSE         0.000416667\n"));  // 0.25 / 600
    CHECK(ended.prints("RMSE        0.0204124\n"));
    CHECK(ended.prints("relMSE      0.000103907\n"));  // 0.25 / 4.01 / 600
    CHECK(ended.prints("max |A - B| 0.5 at pixel (7, 3)\n"));
    CHECK(workspace.files() == std::set<std::string>{"a.pfm", "b.pfm", "d.pfm", "d.png"});
    const lightswitch::Image difference = lightswitch::load_image(workspace / "d.pfm");
    CHECK(difference(7, 3) == lightswitch::Rgb(0, 0.5f, 0));
    CHECK(difference(8, 3) == lightswitch::Rgb(0));

    CHECK(run(workspace, {"compare", "b.pfm", "a.pfm", "-o", "d.pfm"}).status == 0);
    CHECK(lightswitch::load_image(workspace / "d.pfm")(7, 3).y == -0.5f);
    CHECK(run(workspace, {"compare", "b.pfm", "a.pfm", "-o", "d.pfm", "-o", "d.hdr", "--absolute"}).status == 0);
    CHECK(lightswitch::load_image(workspace / "d.pfm")(7, 3).y == 0.5f);
    CHECK(lightswitch::load_image(workspace / "d.hdr")(7, 3).y == 0.5f);
}

TEST_CASE("compare counts values that are not finite") {
    const Folder workspace;
    lightswitch::Image a = image(4, 4, 1);
    a(1, 1).x = std::nanf("");
    lightswitch::save(workspace / "a.pfm", a);
    lightswitch::save(workspace / "b.pfm", image(4, 4, 1));
    const Ended ended = run(workspace, {"compare", "a.pfm", "b.pfm"});
    CHECK(ended.status == 0);
    CHECK(ended.prints("not finite  1 pixel"));
    CHECK(ended.prints("MSE         nan\n"));
}

TEST_CASE("compare refuses what cannot be compared, and writes nothing") {
    const Folder workspace;
    lightswitch::save(workspace / "a.pfm", image(4, 4, 1));
    lightswitch::save(workspace / "b.pfm", image(4, 5, 1));
    lightswitch::save(workspace / "c.png", image(4, 4, 1));
    workspace.write("d.pfm", "PF\n4 4\n-1\nshort");
    std::vector<std::pair<std::vector<std::string>, std::string>> calls{
        {{"compare"}, "name two images"},
        {{"compare", "a.pfm"}, "name two images"},
        {{"compare", "a.pfm", "b.pfm", "-o", "x.png"}, "images of different size cannot be compared: 4 x 4 and 4 x 5"},
        {{"compare", "a.pfm", "none.pfm"}, "none.pfm: no such file"},
        {{"compare", "a.pfm", "c.png"}, "PNG is not read"},
        {{"compare", "a.pfm", "d.pfm"}, "d.pfm: "},
        {{"compare", "a.pfm", "a.pfm", "-o", "x.hdr"}, "no negative values"},
        {{"compare", "a.pfm", "a.pfm", "-o", "x.gif"}, "an image is one of"},
        {{"compare", "a.pfm", "a.pfm", "--scale", "0"}, "not a finite number above 0"},
        {{"compare", "--reference", "a.pfm"}, "compare: name an image"},
        {{"compare", "a.pfm", "a.pfm", "b.pfm"}, "different size"},
        {{"compare", "a.pfm", "--reference", "b.pfm"}, "different size"},
        {{"compare", "a.pfm", "a.pfm", "--report", "nowhere/x.html"}, "nowhere"}};
    if (lightswitch::detail::has_exr) {
        for (const char* scene : {"furnace", "cornell-box"})
            CHECK(run(workspace, {"render", scene, "--size", "4x4", "--spp", "1", "-o", scene + std::string(".exr")})
                      .status == 0);
        calls.push_back({{"compare", "furnace.exr", "cornell-box.exr", "-o", "x.png"}, "different scene"});
    }
    const auto before = workspace.files();
    for (const auto& [arguments, message] : calls) {
        const Ended ended = run(workspace, arguments);
        CAPTURE(message);
        CAPTURE(ended.out);
        CAPTURE(ended.err);
        CHECK(is_user_error(ended));
        CHECK(ended.says(message));
        CHECK(workspace.files() == before);
    }
}

TEST_CASE("compare takes any number of images, and makes a page of them") {
    const Folder workspace;
    lightswitch::save(workspace / "a.pfm", image(20, 10, 1));
    lightswitch::save(workspace / "b.pfm", image(20, 10, 1.5f));
    lightswitch::save(workspace / "c.pfm", image(20, 10, 2));
    const Ended ended = run(workspace, {"compare", "a.pfm", "b.pfm", "--reference", "c.pfm", "--report", "r.html"});
    CHECK(ended.err == "");
    REQUIRE(ended.status == 0);
    CHECK(ended.prints("A           a.pfm, 20 x 10 pixels\nB           c.pfm, the reference\n"));
    CHECK(ended.prints("mean ratio  0.500000\n"));
    CHECK(ended.prints("MAPE        0.49"));
    CHECK(ended.prints("SMAPE       0.66"));
    CHECK(ended.prints("A           b.pfm, 20 x 10 pixels\nB           c.pfm, the reference\n"));
    CHECK(ended.prints("mean ratio  0.750000\n"));
    const std::string page = read_text(workspace / "r.html");
    CHECK(page.starts_with("<!DOCTYPE html>"));
    for (const char* name : {"a.pfm", "b.pfm", "c.pfm", "relMSE", "HDR-FLIP"})
        CHECK(page.find(name) != std::string::npos);
    // Without --reference the last one is it.
    CHECK(run(workspace, {"compare", "a.pfm", "b.pfm", "c.pfm"}).out == ended.out);
}

TEST_CASE("compare: the page's curves belong to one method each, and know the seconds") {
    if (!lightswitch::detail::has_exr) return;
    const Folder workspace;
    const auto render = [&](const char* method, const char* spp, const char* file) {
        CHECK(run(workspace, {"render", "furnace", "--size", "8x8", "-m", method, "--spp", spp, "-o", file}).status ==
              0);
    };
    render("path", "1", "a1.exr");
    render("path-nee", "4", "b4.exr");
    render("path", "16", "a16.exr");
    render("path-nee", "64", "truth.exr");
    REQUIRE(run(workspace, {"compare", "a1.exr", "b4.exr", "a16.exr", "truth.exr", "--report", "r.html"}).status == 0);
    const std::string page = read_text(workspace / "r.html");
    const std::size_t begin = page.find("\"curves\":["), end = page.find("],\"errorName\"");
    REQUIRE(begin < end);
    const std::string curves = page.substr(begin, end - begin);
    CHECK(curves.find("{\"name\":\"path\",\"points\":[[") != std::string::npos);
    CHECK(curves.find("{\"name\":\"path-nee\",\"points\":[[") != std::string::npos);
    CHECK(curves.find(",1,") < curves.find(",16,"));
    CHECK(curves.find("[0,") == std::string::npos);  // seconds are known
}

TEST_CASE("compare: the picture of a difference names the files") {
    const Folder workspace;
    lightswitch::save(workspace / "a.pfm", image(20, 10, 1));
    lightswitch::save(workspace / "a-name-that-is-longer.pfm", image(20, 10, 1));
    lightswitch::save(workspace / "b.pfm", image(20, 10, 1.5f));
    const auto width = [&](const char* first) {
        CHECK(run(workspace, {"compare", first, "b.pfm", "-o", "d.png"}).status == 0);
        const std::string png = read_text(workspace / "d.png");
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(png.at(at)); };
        return byte(18) << 8 | byte(19);  // of the header
    };
    CHECK(width("a-name-that-is-longer.pfm") - width("a.pfm") == 20 * 6);  // letters of 6 dots
}
