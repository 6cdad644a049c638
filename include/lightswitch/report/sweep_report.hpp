#pragma once

// A sweep as a report: error over time with bands, the best method at each time, and images at equal time.

#include <lightswitch/report/report.hpp>
#include <lightswitch/sweep/sweep_text.hpp>

#include <string>
#include <utility>

namespace lightswitch {

namespace detail {

inline ReportTable report_table_of(std::string caption, TextTable table) {
    ReportTable result{.caption = std::move(caption), .header = std::move(table.front()), .rows = {}};
    result.rows.assign(std::make_move_iterator(table.begin() + 1), std::make_move_iterator(table.end()));
    return result;
}

}  // namespace detail

/// The sweep as a report, with the reference as its first image. Throws `Error` when there is nothing to show.
inline Report sweep_report(std::string title, const Sweep& sweep) {
    if (sweep.methods.empty()) throw Error("the sweep was stopped before there was anything to show");
    const std::string seeds = std::to_string(sweep.seeds);
    Report report{.title = std::move(title), .reference = 0, .squared_errors = true};
    report.summary = detail::frontier_text(sweep) + "\n\n" + detail::reference_text(sweep.reference, sweep.seen_noise);
    if (sweep.stopped) report.summary += "\n\nStopped before all was done.";
    report.error_name = "relMSE" + (sweep.seeds > 1 ? "; bands: smallest and largest of " + seeds + " seeds" : "");
    if (sweep.reference.relmse > 0) report.reference_noise = sweep.reference.relmse;
    report.images.push_back({.name = "reference", .image = sweep.reference.image});
    for (const SweptMethod& m : sweep.methods) {
        report.images.push_back({.name = m.name, .image = m.image});
        ReportCurve curve{m.name, {}};
        for (const SweepPoint& p : m.curve) {
            const bool band = p.errors.size() > 1;
            curve.points.push_back(
                {p.seconds, double(p.iterations), p.error(), band ? p.low() : 0, band ? p.high() : 0});
        }
        report.curves.push_back(std::move(curve));
    }
    report.tables.push_back(detail::report_table_of(
        "Every method after about " + detail::digits(sweep.seconds) +
            " s. relMSE: mean over seeds, less the reference's own part, and the smallest and largest. typical: median "
            "of 8 x 8 tiles of the image below. var x s: relative variance times seconds. bias: of the mean over the "
            "image, with a 99 % interval",
        detail::method_table(sweep)));
    report.tables.push_back(detail::report_table_of(
        "The best method at each time. clear: by more than two standard errors", detail::frontier_table(sweep)));
    return report;
}

}  // namespace lightswitch
