#pragma once

// Verdicts as a report: the images and their differences, where they differ, and error over time.

#include <lightswitch/report/comparison_report.hpp>
#include <lightswitch/verify/verdict.hpp>

namespace lightswitch {

namespace detail {

inline ReportTable verdict_table(std::span<const Verdict> verdicts) {
    ReportTable table{
        .caption = "Verdicts, against " + verdicts[0].reference,
        .header = {"method", "verdict", "why", "first wrong path length", "images", "samples per pixel", "seconds"},
        .rows = {}};
    for (const Verdict& v : verdicts) {
        const std::string length = v.first_wrong_length > 0 ? std::to_string(v.first_wrong_length)
                                   : v.disagrees()          ? "not known"
                                                            : "";
        table.rows.push_back({v.method, std::string(name(v.answer)), v.reason, length, std::to_string(v.images),
                              std::to_string(v.samples), number_text(v.seconds)});
    }
    return table;
}

/// One table for all methods, so that it is explained once.
inline ReportTable parts_table(std::span<const Verdict> verdicts) {
    ReportTable table{
        .caption = "By path length. Bias of red, green and blue: of the mean, as a part of the whole image of " +
                   verdicts[0].reference + ", with an interval of confidence " +
                   number_text(100 * verdicts[0].confidence, 6) +
                   " %. p: of the most improbable tile, times the number of tests",
        .header = {"method", "paths", "verdict", "red", "green", "blue", "p", "where"},
        .rows = {}};
    for (const Verdict& v : verdicts)
        for (const Verdict::Part& part : v.parts) {
            std::vector<std::string> row{v.method, name(part), part.disagrees ? "disagrees" : "no difference found"};
            for (std::size_t c = 0; c < 3; ++c) row.push_back(percent_text(part.bias[c], part.interval[c]));
            row.push_back(number_text(part.p));
            row.push_back(part.p > 0.05
                              ? ""
                              : "columns " + std::to_string(part.worst.x0) + " to " +
                                    std::to_string(part.worst.x1 - 1) + ", rows " + std::to_string(part.worst.y0) +
                                    " to " + std::to_string(part.worst.y1 - 1));
            table.rows.push_back(std::move(row));
        }
    return table;
}

/// The p-values of a verdict's smallest tiles, as a histogram and as a map.
inline void add_p_values(Report& report, const Verdict& v) {
    if (v.p_values.empty()) return;
    Image surprise = v.p_values;
    ReportHistogram histogram{.name = v.method + ": p-values of the smallest tiles", .values = {}};
    for (Rgb& p : surprise.pixels()) {
        for (int c = 0; c < 3; ++c) histogram.values.push_back(double(p[c]));
        p = Rgb(-std::log10(std::max(min_component(p), 1e-30f)));
    }
    report.histograms.push_back(std::move(histogram));
    report.maps.push_back({.name = "surprise, " + v.method,
                           .values = std::move(surprise),
                           .scale = 10,
                           .legend = "-log10 of the smallest p-value of the tile's channels"});
}

}  // namespace detail

/// The verdicts of one run, which share their reference, as a report. Throws `Error` when there are none, or no images.
inline Report verdict_report(std::string title, std::span<const Verdict> verdicts) {
    if (verdicts.empty()) throw Error("a report of verdicts needs one at least");
    std::vector<ComparedImage> images{{verdicts[0].reference, verdicts[0].reference_image}};
    for (const Verdict& v : verdicts) {
        ComparedImage one{v.method, v.image};
        for (const Verdict::Moment& m : v.curve) one.history.push_back({m.seconds, double(m.samples), m.error});
        images.push_back(std::move(one));
    }
    Report report = comparison_report(images, 0);
    report.title = std::move(title);
    report.reference_noise = detail::lowest_level(report.curves);  // verify adds up independent images
    report.tables.insert(report.tables.begin(), detail::verdict_table(verdicts));
    report.tables.push_back(detail::parts_table(verdicts));  // the longest
    for (const Verdict& v : verdicts) {
        const char* with = v.answer == Verdict::Answer::undecided ? " against " : " with ";
        report.summary += (report.summary.empty() ? "" : "\n\n") + v.method + " " + std::string(name(v.answer)) + with +
                          v.reference + ". " + v.reason;
        detail::add_p_values(report, v);
    }
    return report;
}
/// The same of one.
inline Report verdict_report(std::string title, const Verdict& verdict) {
    return verdict_report(std::move(title), std::span(&verdict, 1));
}

}  // namespace lightswitch
