// write_report small|large|single|words FILE: writes a report that browser.py looks at. Its pixel values are exact in
// the report's encoding.

#include <lightswitch/report/report.hpp>

#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <string>

using namespace lightswitch;

namespace {

/// Noise, as far as compression can tell.
Report large_report() {
    Report report{.title = "Large"};
    for (int k = 0; k < 6; ++k) {
        Image image(512, 512);
        for (int y = 0; y < 512; ++y)
            for (int x = 0; x < 512; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto hash = [](int value, std::uint32_t factor) {
                        return static_cast<std::uint32_t>(value) * factor;
                    };
                    const std::uint32_t mixed =
                        (hash(x, 73856093) ^ hash(y, 19349663) ^ hash(3 * k + c, 83492791)) * 2654435761u;
                    image(x, y)[c] =
                        std::ldexp(static_cast<float>((mixed >> 21) + 2048), static_cast<int>(mixed >> 10 & 7) - 12);
                }
        report.images.push_back({"image " + std::to_string(k), image});
    }
    return report;
}

Report small_report() {
    const std::string title = "Title <i>&amp;</i> \"quoted\" ☀";
    Report report{.title = title, .summary = "One </main><script>alert(1)</script>\n\nTwo"};
    const char* names[] = {"reference", "</script><b id=planted>x</b>", "größer \"näher\" & 'mehr' ☀"};
    for (int k = 0; k < 3; ++k) {
        Image image(48, 32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x)
                image(x, y) = Rgb(x + 1, 0, 0) * (static_cast<float>(k + 1) / 256) +
                              Rgb(0, static_cast<float>(y + 1) / 64, static_cast<float>(k + 1) / 8);
        if (k == 1) {
            image(0, 0).y = std::numeric_limits<float>::quiet_NaN();
            image(1, 0).x = std::numeric_limits<float>::infinity();
            image(2, 0) = Rgb(-0.5f, 1e-6f, 1e6f);
        }
        report.images.push_back({names[k], image, {{"samples", std::to_string(16 << k)}, {"<i>", "</script>"}}});
    }
    report.reference = 0;

    Image tiles(6, 4);
    for (std::size_t i = 0; i < tiles.pixels().size(); ++i) tiles.pixels()[i] = Rgb(static_cast<float>(i) / 32);
    report.maps.push_back({"p-values", tiles, false, 1, "p-value of each tile"});

    ReportCurve fast{"fast", {}}, slow{"slow", {{0, 0, 0}, {1, 1, std::nan("")}}};
    for (int i = 0; i < 6; ++i) {
        const double samples = std::exp2(i);
        fast.points.push_back({0.1 * samples, samples, 0.5 / std::sqrt(samples)});
        slow.points.push_back({0.3 * samples, samples, 0.9 / std::cbrt(samples)});
    }
    report.curves = {fast, slow};
    ReportHistogram histogram{"p-values <of> tiles", {std::nan(""), 2}};
    for (int i = 0; i < 400; ++i) histogram.values.push_back((i % 20 + 0.5) / 20);
    for (int i = 0; i < 20; ++i) histogram.values.push_back(0.01);
    report.histograms = {histogram};
    report.tables = {{"Metrics", {"Image", "RMSE"}, {{"<b>a</b>", "0.25"}, {"b"}}}};
    return report;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string size = argc == 3 ? argv[1] : "";
    const std::map<std::string, Report (*)()> reports{
        {"small", small_report},
        {"large", large_report},
        {"single",
         [] {
             return Report{.title = "Single", .images = {{"one pixel", Image(1, 1)}}};
         }},
        {"words",
         [] {
             return Report{.title = "Words", .tables = {{"Table", {}, {{"cell"}}}}};
         }},
    };
    const auto report = reports.find(size);
    if (report == reports.end()) {
        std::cerr << "usage: write_report small|large|single|words FILE\n";
        return 2;
    }
    save_report(argv[2], report->second());
}
