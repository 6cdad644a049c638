#pragma once

// A comparison as one web page: images to slide and flip between, difference maps, charts and tables.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/core/file.hpp>
#include <lightswitch/report/data.hpp>
#include <lightswitch/report/page.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// An image of the report.
struct ReportImage {
    std::string name;
    Image image;  ///< linear RGB
    /// What is known of it, shown beside the other images' entries of the same name; the metadata of `image` when
    /// empty.
    std::vector<std::pair<std::string, std::string>> facts{};
};

/// Numbers to be shown in false colours over the images. The red channel of `values` counts; a grid that is coarser
/// than the images is stretched over them.
struct ReportMap {
    std::string name;
    Image values;
    bool is_signed = false;  ///< shown from -scale to scale, otherwise from 0
    double scale = 0;  ///< the value at the end of the colour map; 0: the 99th percentile of the magnitudes, rounded up
    std::string legend{};  ///< what the numbers are, with their unit
};

/// An error that falls with time and samples. Points at which a number is not positive and finite are left out of the
/// charts, whose axes are logarithmic.
struct ReportCurve {
    struct Point {
        double seconds = 0, samples = 0, error = 0;
        double low = 0, high = 0;  ///< a band around it; 0: none
    };
    std::string name;
    std::vector<Point> points;
};

/// p-values: uniform in [0,1] when the hypothesis holds. Values outside are not counted.
struct ReportHistogram {
    std::string name;
    std::vector<double> values;
};

/// Text in rows and columns. Columns in which every cell reads as a number are aligned to the right.
struct ReportTable {
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/// What a report shows. All texts are plain text in UTF-8.
struct Report {
    std::string title;
    std::string summary{};  ///< the verdict; an empty line begins a new paragraph
    std::vector<ReportImage> images{};
    std::optional<std::size_t> reference{};  ///< index of the image that the others are compared with at first
    std::vector<ReportMap> maps{};
    std::vector<ReportCurve> curves{};
    std::string error_name = "Error";  ///< what the curves show
    bool squared_errors = false;       ///< so that with independent samples they fall as 1 / N, and else as 1 / sqrt(N)
    std::optional<double> reference_noise{};  ///< the part of the errors that is its own, drawn as a level
    std::vector<ReportHistogram> histograms{};
    std::vector<ReportTable> tables{};
};

namespace detail {

/// More pixel values make files that browsers do not open: 2^26 take 170 MB.
inline constexpr std::size_t max_report_values = std::size_t{1} << 26;
/// Up to so many values a report keeps all digits and stays below 12 MB even for noise.
inline constexpr std::size_t max_exact_report_values = std::size_t{7} << 19;

/// Throws `Error` for what cannot be shown; returns the number of pixel values.
inline std::size_t check_report(const Report& report) {
    std::size_t values = 0;
    for (const ReportImage& image : report.images) {
        refuse_unless_comparable(report.images.front().image, image.image);
        values += 3 * image.image.pixels().size();
    }
    for (const ReportMap& map : report.maps) {
        if (report.images.empty()) throw Error("the report's map '" + map.name + "' has no image to lie over");
        if (map.values.empty()) throw Error("the report's map '" + map.name + "' has no pixels");
        if (!std::isfinite(map.scale) || map.scale < 0)
            throw Error("the scale of the report's map '" + map.name + "' must be positive, or 0 to choose it");
        values += map.values.pixels().size();
    }
    if (report.reference && *report.reference >= report.images.size())
        throw Error("the report's reference is image " + std::to_string(*report.reference) + " of " +
                    std::to_string(report.images.size()) + ", counted from 0");
    if (values > max_report_values)
        throw Error("the report's images and maps have " + std::to_string(values) + " values; at most " +
                    std::to_string(max_report_values) + " are possible: give fewer or smaller images");
    return values;
}

inline std::string report_histogram(const ReportHistogram& histogram) {
    std::array<std::size_t, 20> bins{};
    for (const double p : histogram.values)
        if (p >= 0 && p <= 1) ++bins[std::min<std::size_t>(19, static_cast<std::size_t>(p * 20))];
    return "{\"name\":" + json_text(histogram.name) + ",\"total\":" + std::to_string(histogram.values.size()) +
           ",\"bins\":" + json_array(bins, [](std::size_t n) { return std::to_string(n); }) + "}";
}

/// Everything that the page's script reads, but the pixels.
inline std::string report_json(const Report& report, KeptBits kept) {
    const auto facts = [](const ReportImage& image) {
        const auto pair = [](const auto& fact) {
            return "[" + json_text(fact.first) + "," + json_text(fact.second) + "]";
        };
        return image.facts.empty() ? json_array(image.image.metadata, pair) : json_array(image.facts, pair);
    };
    const auto size = [](const Image& image) {
        return ",\"width\":" + std::to_string(image.width()) + ",\"height\":" + std::to_string(image.height());
    };
    const auto point = [](const ReportCurve::Point& p) {
        const std::string band = p.low > 0 ? "," + json_number(p.low) + "," + json_number(p.high) : "";
        return "[" + json_number(p.seconds) + "," + json_number(p.samples) + "," + json_number(p.error) + band + "]";
    };
    return "{\"bits\":" + std::to_string(static_cast<int>(kept)) +
           ",\"reference\":" + (report.reference ? std::to_string(*report.reference) : "null") + ",\"images\":" +
           json_array(report.images,
                      [&](const ReportImage& image) {
                          return "{\"name\":" + json_text(image.name) + size(image.image) +
                                 ",\"facts\":" + facts(image) + "}";
                      }) +
           ",\"maps\":" +
           json_array(report.maps,
                      [&](const ReportMap& map) {
                          return "{\"name\":" + json_text(map.name) + size(map.values) +
                                 ",\"signed\":" + (map.is_signed ? "true" : "false") +
                                 ",\"scale\":" + json_number(map.scale) + ",\"legend\":" + json_text(map.legend) + "}";
                      }) +
           ",\"curves\":" +
           json_array(report.curves,
                      [&](const ReportCurve& curve) {
                          return "{\"name\":" + json_text(curve.name) +
                                 ",\"points\":" + json_array(curve.points, point) + "}";
                      }) +
           ",\"errorName\":" + json_text(report.error_name) + ",\"power\":" + (report.squared_errors ? "1" : "0.5") +
           ",\"noise\":" + (report.reference_noise ? json_number(*report.reference_noise) : "null") +
           ",\"histograms\":" + json_array(report.histograms, report_histogram) + "}";
}

/// True for what a table aligns to the right: a number, perhaps with a sign, a percent sign or a unit of time.
inline bool looks_numeric(std::string_view cell) {
    if (cell.empty() || cell == "-" || cell == "nan" || cell == "-nan" || cell == "inf" || cell == "-inf") return true;
    const std::size_t first = cell.find_first_not_of("+-~<>= ");
    return first != std::string_view::npos && (cell[first] == '.' || (cell[first] >= '0' && cell[first] <= '9')) &&
           cell.find_first_not_of("0123456789.,+-eE%xs ", first) == std::string_view::npos;
}

inline std::string report_table(const ReportTable& table) {
    std::size_t columns = table.header.size();
    for (const auto& row : table.rows) columns = std::max(columns, row.size());
    std::vector<bool> numeric(columns, true);
    for (const auto& row : table.rows)
        for (std::size_t c = 0; c < row.size(); ++c) numeric[c] = numeric[c] && looks_numeric(row[c]);
    const auto cells = [&](const std::vector<std::string>& row, const std::string& tag) {
        std::string result = "<tr>";
        for (std::size_t c = 0; c < columns; ++c)
            result += "<" + tag + (numeric[c] ? " class=\"number\">" : ">") +
                      (c < row.size() ? html_text(row[c]) : "") + "</" + tag.substr(0, 2) + ">";
        return result + "</tr>\n";
    };
    std::string html = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + html_text(table.caption) +
                       "\">\n<table>\n<caption>" + html_text(table.caption) + "</caption>\n";
    if (!table.header.empty()) html += "<thead>" + cells(table.header, "th scope=\"col\"") + "</thead>\n";
    html += "<tbody>\n";
    for (const auto& row : table.rows) html += cells(row, "td");
    return html + "</tbody>\n</table>\n</div>\n";
}

inline std::string report_summary(std::string_view text) {
    std::string html;
    while (!text.empty()) {
        const std::size_t end = text.find("\n\n");
        if (end != 0) html += "<p>" + html_text(text.substr(0, end)) + "</p>\n";
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    }
    return html.empty() ? "" : "<div class=\"summary\">\n" + html + "</div>\n";
}

}  // namespace detail

/// The report as one HTML page that needs no other file and no network. Pixel values are kept to 2^-16 of their size,
/// or to 2^-12 when there are more than 3.6 million of them; the page says which.
///
/// Throws `Error` unless the images are comparable (`refuse_unless_comparable`), for maps without pixels or images, for
/// a reference that is none of the images, and when there are more than 2^26 pixel values.
inline std::string report_html(const Report& report) {
    const std::size_t values = detail::check_report(report);
    const auto kept =
        values > detail::max_exact_report_values ? detail::KeptBits::fewer_digits : detail::KeptBits::all_digits;
    const auto title = "<title>" + detail::html_text(report.title) + "</title>\n";
    std::string html =
        detail::page_head_html + title + "<style>" + detail::page_style_css + "</style>\n</head>\n<body>\n";
    html += "<header>\n<h1>" + detail::html_text(report.title) + "</h1>\n" + detail::report_summary(report.summary) +
            "</header>\n<main>\n";
    if (!report.images.empty()) html += detail::page_viewer_html;
    if (!report.tables.empty()) {
        html += "<section id=\"tables\" aria-label=\"Tables\">\n";
        for (const ReportTable& table : report.tables) html += detail::report_table(table);
        html += "</section>\n";
    }
    html += "<section id=\"charts\" aria-label=\"Charts\"></section>\n";
    if (!report.images.empty()) html += detail::page_facts_html;
    html += "</main>\n";
    std::size_t stream = 0;
    const auto add_pixels = [&](const Image& image, bool one_channel) {
        html += "<script type=\"text/plain\" id=\"pixels-" + std::to_string(stream++) + "\">\n" +
                detail::encode_pixels(image, one_channel, kept) + "</script>\n";
    };
    for (const ReportImage& image : report.images) add_pixels(image.image, false);
    for (const ReportMap& map : report.maps) add_pixels(map.values, true);
    html += "<script type=\"application/json\" id=\"report\">" + detail::report_json(report, kept) + "</script>\n";
    html += std::string("<script>\n'use strict';\n") + detail::page_pixels_js + detail::page_charts_js;
    if (!report.images.empty()) html += detail::page_viewer_js;
    return html + "</script>\n</body>\n</html>\n";
}

/// Writes `report_html(report)` to `path`, all of it or nothing. Throws `Error` as that does, and when it cannot be
/// written.
inline void save_report(const std::filesystem::path& path, const Report& report) {
    check_file_writable(path);
    write_file_atomically(path, report_html(report));
}

}  // namespace lightswitch
