#include <lightswitch/report/report.hpp>

#include <doctest/doctest.h>

#include <chrono>
#include <limits>
#include <random>
#include <string>

using namespace lightswitch;

namespace {

std::size_t count(std::string_view text, std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++found;
    return found;
}

/// What a value is after it has been kept in so many bits.
float kept(float value, detail::KeptBits bits) {
    return std::bit_cast<float>(detail::leading_bits(value, bits) << (32 - static_cast<int>(bits)));
}

Image noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::gamma_distribution<float> radiance(1, 0.5f);
    Image image(width, height);
    for (Rgb& p : image.pixels()) p = Rgb(radiance(random), radiance(random), radiance(random));
    return image;
}

Report two_images() {
    Report report{.title = "Title", .summary = "Verdict"};
    report.images = {{"a", noise(8, 4, 1)}, {"b", noise(8, 4, 2)}};
    return report;
}

}  // namespace

TEST_CASE("report: values keep their leading bits, rounded to the nearest") {
    using detail::KeptBits;
    std::mt19937 random(7);
    std::uniform_int_distribution<std::uint32_t> word;
    for (int i = 0; i < 100000; ++i) {
        const auto value = std::bit_cast<float>(word(random));
        if (!is_finite(value) || std::abs(value) < std::numeric_limits<float>::min() || std::abs(value) > 3e38f)
            continue;
        CHECK(std::abs(kept(value, KeptBits::all_digits) - value) <= std::ldexp(std::abs(value), -16));
        CHECK(std::abs(kept(value, KeptBits::fewer_digits) - value) <= std::ldexp(std::abs(value), -12));
    }
    const float largest = std::numeric_limits<float>::max();
    for (const KeptBits bits : {KeptBits::all_digits, KeptBits::fewer_digits}) {
        for (const float value : {0.0f, 1.0f, -0.5f, 1.5f, 0x1p-126f, 0x1p127f, infinity, -infinity})
            CHECK(kept(value, bits) == value);
        CHECK(is_nan(kept(std::numeric_limits<float>::quiet_NaN(), bits)));
        CHECK(
            is_nan(kept(std::bit_cast<float>(0xff800001u), bits)));  // a NaN that only its last bit tells from infinity
        CHECK(is_finite(kept(largest, bits)));
        CHECK(kept(-largest, bits) < -3.3e38f);
    }
}

TEST_CASE("report: base64, JSON and HTML") {
    CHECK(detail::base64("") == "");
    CHECK(detail::base64("M") == "TQ==");
    CHECK(detail::base64("Ma") == "TWE=");
    CHECK(detail::base64("Man") == "TWFu");
    CHECK(detail::base64("\xff\xfe\xfd\xfc") == "//79/A==");

    CHECK(detail::json_text("a\"b\\c\n</script>&\x7f") == R"("a\"b\\c\u000a\u003c/script\u003e\u0026\u007f")");
    CHECK(detail::json_text("größer ☀ 😀") == "\"größer ☀ 😀\"");
    CHECK(detail::json_number(0.1) == "0.1");
    CHECK(detail::json_number(-1e300) == "-1e+300");
    CHECK(detail::json_number(std::nan("")) == "null");
    CHECK(detail::json_number(std::numeric_limits<double>::infinity()) == "null");

    CHECK(detail::html_text("<a href='x'>&\"\n\x01") == "&lt;a href=&#39;x&#39;&gt;&amp;&quot;\n\xef\xbf\xbd");

    const std::string bad = "\xef\xbf\xbd";
    CHECK(detail::valid_utf8("\xff"
                             "a") == bad + "a");
    CHECK(detail::valid_utf8("\xc3") == bad);                                // cut off
    CHECK(detail::valid_utf8("\xc0\xaf") == bad + bad);                      // overlong
    CHECK(detail::valid_utf8("\xe0\x80\x80") == bad + bad + bad);            // overlong
    CHECK(detail::valid_utf8("\xed\xa0\x80") == bad + bad + bad);            // surrogate
    CHECK(detail::valid_utf8("\xf4\x90\x80\x80") == bad + bad + bad + bad);  // above U+10FFFF
    CHECK(detail::valid_utf8("\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbf") == "\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbf");
}

TEST_CASE("report: no text gets out of its place") {
    const std::string evil = "</script></style></title><b onclick='x'>\"";
    Report report = two_images();
    report.title = report.summary = report.images[0].name = evil;
    report.images[0].facts = {{evil, evil}};
    report.maps = {{evil, Image(2, 2), true, 0, evil}};
    report.curves = {{evil, {{1, 1, 1}}}};
    report.histograms = {{evil, {0.5}}};
    report.tables = {{evil, {evil}, {{evil, "\xff"}}}};
    const std::string html = report_html(report);
    CHECK(html.find(evil) == html.npos);
    CHECK(html.find('\xff') == html.npos);
    // Two images, a map, the JSON and the script; nothing else opens or closes a script.
    CHECK(count(html, "<script") == 5);
    CHECK(count(html, "</script") == 5);
    CHECK(count(html, "<b ") == 0);
    CHECK(count(html, "</title>") == 1);
    CHECK(count(html, "</style>") == 1);
}

TEST_CASE("report: a page of its own") {
    Report report = two_images();
    report.tables = {{"Metrics", {"Image", "RMSE", "Note"}, {{"a", "0.25 %", "x"}, {"b"}}}};
    const std::string html = report_html(report);
    CHECK(html.starts_with("<!DOCTYPE html>\n"));
    CHECK(html.ends_with("</html>\n"));
    CHECK(count(html, "default-src 'none'") == 1);
    CHECK(count(html, "<p>Verdict</p>") == 1);
    CHECK(count(html, "<td") == 6);  // short rows are filled up
    CHECK(count(html, "<td class=\"number\">0.25 %</td>") == 1);
    CHECK(count(html, "http") == 2);  // the attribute http-equiv and the name space of SVG
    CHECK(count(html, "http://www.w3.org/2000/svg") == 1);

    const std::string words = report_html({.title = "Only words", .tables = {{"T", {}, {{"cell"}}}}});
    CHECK(count(words, "id=\"viewer\"") == 0);
    CHECK(count(words, "view.zoom") == 0);
    CHECK(count(words, "<td>cell</td>") == 1);
    CHECK(count(words, "<thead>") == 0);
}

TEST_CASE("report: p-values are counted in 20 bins, what is none is not") {
    const double nan = std::nan("");
    const std::string json = detail::report_histogram({"h", {0, 0.049, 0.05, 0.5, 1, nan, -0.01, 1.01}});
    CHECK(json == "{\"name\":\"h\",\"total\":8,\"bins\":[2,1,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1]}");
}

TEST_CASE("report: size and time of six images of noise") {
    Report report{.title = "Noise"};
    for (unsigned i = 0; i < 6; ++i) report.images.push_back({"noise", noise(512, 512, i)});
    const auto start = std::chrono::steady_clock::now();
    const std::string html = report_html(report);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    MESSAGE(html.size() << " bytes in " << seconds.count() << " s");
    CHECK(html.size() < 14'000'000);

    report.images.resize(2);
    CHECK(count(report_html(report), "\"bits\":24") == 1);
    for (ReportImage& image : report.images) image.image = Image(512, 512);
    CHECK(report_html(report).size() < 150'000);  // nothing to tell
}

TEST_CASE("report: refuses what it cannot show, and leaves no file") {
    Report report = two_images();
    report.images.push_back({"c", Image(8, 5)});
    CHECK_THROWS_WITH_AS(report_html(report), "images of different size cannot be compared: 8 x 4 and 8 x 5 pixels",
                         Error);
    report = two_images();
    report.images[0].image.metadata["scene"] = "x";
    report.images[1].image.metadata["scene"] = "y";
    CHECK_THROWS_AS(report_html(report), Error);
    report = {.title = "Empty", .images = {{"a", Image()}}};
    CHECK_THROWS_AS(report_html(report), Error);
    report = two_images();
    report.reference = 2;
    CHECK_THROWS_WITH_AS(report_html(report), "the report's reference is image 2 of 2, counted from 0", Error);
    report = two_images();
    report.maps = {{"m", Image()}};
    CHECK_THROWS_WITH_AS(report_html(report), "the report's map 'm' has no pixels", Error);
    report.maps = {{"m", Image(1, 1), false, std::nan("")}};
    CHECK_THROWS_AS(report_html(report), Error);
    report.maps[0].scale = -1;
    CHECK_THROWS_AS(report_html(report), Error);
    report.images.clear();
    report.maps[0].scale = 1;
    CHECK_THROWS_AS(report_html(report), Error);
    report = {.title = "Too large", .images = std::vector<ReportImage>(2, {"a", Image(4096, 4096)})};
    CHECK_THROWS_AS(report_html(report), Error);
    CHECK_THROWS_AS(save_report("no such directory/report.html", two_images()), Error);
}

TEST_CASE("report: values that are not numbers do not break the data") {
    Report report = two_images();
    for (Rgb& p : report.images[0].image.pixels())
        p = Rgb(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.0f);
    report.curves = {{"c", {{std::nan(""), 1, 1}, {1, std::numeric_limits<double>::infinity(), 0}}}};
    const std::string html = report_html(report);
    CHECK(count(html, "[[null,1,1],[1,null,0]]") == 1);
}
