#include "report.hpp"

#include <lightswitch/compare/flip.hpp>
#include <lightswitch/compare/metrics.hpp>

#include <fmt/format.h>

namespace lightswitch::program {
namespace {

std::string number(double value) { return fmt::format("{:.4g}", value); }
std::string percent(double value) { return fmt::format("{:+.3g} %", 100 * value); }
std::string percent_interval(double value, const Interval& interval) {
    return fmt::format("{} ({:+.3g} to {:+.3g})", percent(value), 100 * interval.low, 100 * interval.high);
}

/// The whole image's bias with an interval from the spread of its pixels, as if they erred independently.
std::string bias_with_interval(const Image& image, const Image& reference) {
    const DVec3 mean = reference.mean();
    std::string text;
    for (int c = 0; c < 3; ++c) {
        Moments differences;
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            differences.add(double(image.pixels()[i][c]) - double(reference.pixels()[i][c]));
        const Interval interval = welch_interval(Estimate::of(differences), Estimate::exact(0), 0.01);
        text += c > 0 ? ", " : "";
        text += mean[c] > 0
                    ? percent_interval(differences.mean() / mean[c], {interval.low / mean[c], interval.high / mean[c]})
                    : fmt::format("{:+.3g} of black", differences.mean());
    }
    return text;
}

ReportTable metrics_table(const std::vector<NamedImage>& images, std::size_t reference,
                          const std::vector<double>& flips) {
    ReportTable table{
        .caption = "Metrics against " + images[reference].name +
                   ". The bias is that of the means of red, green and blue, with a 99 % interval that takes pixels "
                   "to err independently.",
        .header = {"image", "MSE", "RMSE", "relMSE", "MAPE", "SMAPE", "HDR-FLIP", "bias"},
        .rows = {}};
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == reference) continue;
        const Image &x = images[i].image, &r = images[reference].image;
        table.rows.push_back({images[i].name, number(mse(x, r)), number(rmse(x, r)), number(relmse(x, r)),
                              number(mape(x, r)), number(smape(x, r)), number(flips[i]), bias_with_interval(x, r)});
    }
    return table;
}

/// Adds the FLIP maps; returns their means, 0 for the reference.
std::vector<double> add_flip(Report& report, const std::vector<NamedImage>& images, std::size_t reference) {
    std::vector<double> means(images.size(), 0.0);
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == reference) continue;
        means[i] = std::numeric_limits<double>::quiet_NaN();
        if (images[i].image.first_not_finite() || images[reference].image.first_not_finite()) continue;  // FLIP refuses
        Image map = hdr_flip(images[i].image, images[reference].image);
        means[i] = map.mean().x;
        report.maps.push_back({.name = "FLIP of " + images[i].name,
                               .values = std::move(map),
                               .scale = 1,
                               .legend = "HDR-FLIP: 0 looks the same, 1 as different as can be"});
    }
    return means;
}

std::string length_text(const Verdict& v) {
    return v.first_wrong_length > 0 ? std::to_string(v.first_wrong_length) : v.disagrees() ? "not known" : "";
}

ReportTable verdict_table(const std::vector<Verdict>& verdicts) {
    ReportTable table{
        .caption = fmt::format("Verdicts, against {}", verdicts[0].reference),
        .header = {"method", "verdict", "why", "first wrong path length", "images", "samples per pixel", "seconds"},
        .rows = {}};
    for (const Verdict& v : verdicts)
        table.rows.push_back({v.method, std::string(name(v.answer)), v.reason, length_text(v), std::to_string(v.images),
                              std::to_string(v.samples), number(v.seconds)});
    return table;
}

ReportTable parts_table(const Verdict& v) {
    ReportTable table{
        .caption = fmt::format(
            "{} against {} by path length. Bias: of the mean, as a part of the reference's whole image, "
            "with an interval of confidence {:.6g} %. p: of the most improbable tile, times the number of tests",
            v.method, v.reference, 100 * v.confidence),
        .header = {"paths", "verdict", "red", "green", "blue", "p", "where"},
        .rows = {}};
    for (const Verdict::Part& part : v.parts)
        table.rows.push_back({name(part), part.disagrees ? "disagrees" : "no difference found",
                              percent_interval(part.bias[0], part.interval[0]),
                              percent_interval(part.bias[1], part.interval[1]),
                              percent_interval(part.bias[2], part.interval[2]), number(part.p),
                              part.p > 0.05 ? std::string()
                                            : fmt::format("columns {} to {}, rows {} to {}", part.worst.x0,
                                                          part.worst.x1 - 1, part.worst.y0, part.worst.y1 - 1)});
    return table;
}

}  // namespace

double samples_of(const Image& image) {
    const auto found = image.metadata.find("samples");
    return found == image.metadata.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
}

Report comparison_report(const std::vector<NamedImage>& images, std::size_t reference) {
    Report report{.title = "Comparison with " + images[reference].name};
    ReportCurve curve{.name = "images, root of relMSE", .points = {}};
    for (std::size_t i = 0; i < images.size(); ++i) {
        report.images.push_back({.name = images[i].name, .image = images[i].image});
        if (i != reference && samples_of(images[i].image) > 0)
            curve.points.push_back({.samples = samples_of(images[i].image),
                                    .error = std::sqrt(relmse(images[i].image, images[reference].image))});
    }
    report.reference = reference;
    if (curve.points.size() > 1) {
        std::sort(curve.points.begin(), curve.points.end(),
                  [](const auto& a, const auto& b) { return a.samples < b.samples; });
        report.curves.push_back(std::move(curve));
    }
    const std::vector<double> flips = add_flip(report, images, reference);
    report.tables.push_back(metrics_table(images, reference, flips));
    return report;
}

Report verdict_report(const std::string& scene, const std::vector<Verdict>& verdicts) {
    std::vector<NamedImage> images{{verdicts[0].reference, verdicts[0].reference_image}};
    for (const Verdict& v : verdicts) images.push_back({v.method, v.image});
    Report report = comparison_report(images, 0);
    report.title = scene;
    report.curves.clear();
    report.tables.insert(report.tables.begin(), verdict_table(verdicts));
    for (const Verdict& v : verdicts) {
        report.summary += fmt::format(
            "{}{} {} {}. {}", report.summary.empty() ? "" : "\n\n", v.method, name(v.answer),
            v.answer == Verdict::Answer::undecided ? "against " + v.reference : "with " + v.reference, v.reason);
        report.tables.push_back(parts_table(v));
        if (!v.p_values.empty()) {
            Image surprise = v.p_values;
            ReportHistogram histogram{.name = "p-values of the smallest tiles, " + v.method, .values = {}};
            for (Rgb& p : surprise.pixels()) {
                for (int c = 0; c < 3; ++c) histogram.values.push_back(static_cast<double>(p[c]));
                p = Rgb(-std::log10(std::max(min_component(p), 1e-30f)));
            }
            report.histograms.push_back(std::move(histogram));
            report.maps.push_back({.name = "surprise, " + v.method,
                                   .values = std::move(surprise),
                                   .scale = 10,
                                   .legend = "-log10 of the smallest p-value of the tile's channels"});
        }
        ReportCurve curve{.name = v.method + ", root of relMSE", .points = {}};
        for (const Verdict::Moment& m : v.curve) curve.points.push_back({m.seconds, double(m.samples), m.error});
        report.curves.push_back(std::move(curve));
    }
    return report;
}

}  // namespace lightswitch::program
