#pragma once

// Images of one scene against one of them, as a report: metrics, maps and error over time and samples.

#include <lightswitch/compare/flip.hpp>
#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/report/report.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch {

/// An image of a comparison, with what it is called there.
struct ComparedImage {
    std::string name;
    Image image;
    /// How its error fell while it was made, see `render_measured`. Without it, the image is one point of its method's
    /// curve, as far as its metadata tell.
    std::vector<ReportCurve::Point> history{};
};

/// A number of the image's metadata, such as its "samples" per pixel or "seconds"; 0 when it does not say.
inline double metadata_number(const Image& image, std::string_view key) {
    const auto found = image.metadata.find(std::string(key));
    return found == image.metadata.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
}

namespace detail {

inline std::string metadata_text(const Image& image, std::string_view key) {
    const auto found = image.metadata.find(std::string(key));
    return found == image.metadata.end() ? "" : found->second;
}

/// The number with so many significant digits.
inline std::string number_text(double value, int digits = 4) {
    std::array<char, 32> text{};
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr};
}
inline std::string signed_text(double value) { return (std::signbit(value) ? "" : "+") + number_text(value, 3); }
inline std::string percent_text(double value, const Interval& interval) {
    return signed_text(100 * value) + " % (" + signed_text(100 * interval.low) + " to " +
           signed_text(100 * interval.high) + ")";
}

/// The whole image's bias with an interval from the spread of its pixels, as if they erred independently.
inline std::string bias_text(const Image& image, const Image& reference) {
    const DVec3 mean = reference.mean();
    std::string text;
    for (int c = 0; c < 3; ++c) {
        Moments differences;
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            differences.add(double(image.pixels()[i][c]) - double(reference.pixels()[i][c]));
        const Interval interval = welch_interval(Estimate::of(differences), Estimate::exact(0), 0.01);
        text += c > 0 ? ", " : "";
        text += mean[c] > 0
                    ? percent_text(differences.mean() / mean[c], {interval.low / mean[c], interval.high / mean[c]})
                    : signed_text(differences.mean()) + " of black";
    }
    return text;
}

/// Adds the FLIP map of every image but the reference, and the table of metrics.
inline void add_metrics(Report& report, std::span<const ComparedImage> images, std::size_t reference) {
    const Image& truth = images[reference].image;
    ReportTable table{
        .caption = "Metrics against " + images[reference].name +
                   ". The bias is that of the means of red, green and blue, with a 99 % interval that takes pixels "
                   "to err independently.",
        .header = {"image", "MSE", "RMSE", "relMSE", "MAPE", "SMAPE", "HDR-FLIP", "bias"},
        .rows = {}};
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == reference) continue;
        const Image& image = images[i].image;
        double flip = std::numeric_limits<double>::quiet_NaN();
        if (!image.first_not_finite() && !truth.first_not_finite()) {  // FLIP refuses them
            Image map = hdr_flip(image, truth);
            flip = map.mean().x;
            report.maps.push_back({.name = "FLIP of " + images[i].name,
                                   .values = std::move(map),
                                   .scale = 1,
                                   .legend = "HDR-FLIP: 0 looks the same, 1 as different as can be"});
        }
        table.rows.push_back({images[i].name, number_text(mse(image, truth)), number_text(rmse(image, truth)),
                              number_text(relmse(image, truth)), number_text(mape(image, truth)),
                              number_text(smape(image, truth)), number_text(flip), bias_text(image, truth)});
    }
    report.tables.push_back(std::move(table));
}

/// The curves of all images but the reference: histories as they are, and of the others one per method and kind of
/// points, because what joins points says that the same method went from one to the next. Pictures (`Kind::heuristic`)
/// have none.
inline std::vector<ReportCurve> comparison_curves(std::span<const ComparedImage> images, std::size_t reference) {
    std::vector<ReportCurve> curves;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const ComparedImage& one = images[i];
        if (i == reference || metadata_text(one.image, "kind") == name(Kind::heuristic)) continue;
        if (!one.history.empty()) {
            curves.push_back({one.name, one.history});
            continue;
        }
        const double samples = metadata_number(one.image, "samples"), seconds = metadata_number(one.image, "seconds");
        if (!(samples > 0 || seconds > 0)) continue;
        const std::string method = metadata_text(one.image, "method"), points = metadata_text(one.image, "sampling");
        const std::string curve_name = method.empty() ? one.name
                                       : points.empty() || points == name(Sampling())
                                           ? method
                                           : method + ", " + points + " points";
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const auto& c) { return c.name == curve_name; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), {curve_name, {}});
        curve->points.push_back({seconds, samples, std::sqrt(relmse(one.image, images[reference].image))});
    }
    for (ReportCurve& curve : curves)
        std::sort(curve.points.begin(), curve.points.end(),
                  [](const auto& a, const auto& b) { return a.samples < b.samples; });
    return curves;
}

/// The root of the relMSE that is left on a curve when its samples are without number: of e^2 = a / samples + b, fitted
/// to the curve's errors by least squares of their ratios, the root of b. That is the reference's own noise, and the
/// method's bias if it has one. Only for independent samples, as others gain more than that. Nothing when three points
/// over a factor of four do not show it, as a tenth of the smallest e^2 at least.
inline std::optional<double> level_of(const ReportCurve& curve) {
    double uu = 0, uv = 0, vv = 0, u_sum = 0, v_sum = 0, count = 0;
    double fewest = std::numeric_limits<double>::infinity(), most = 0, least = fewest;
    for (const ReportCurve::Point& p : curve.points) {
        const double v = 1 / (p.error * p.error), u = v / p.samples;
        if (!(p.samples > 0 && std::isfinite(u) && u > 0)) continue;
        uu += u * u, uv += u * v, vv += v * v, u_sum += u, v_sum += v, count += 1;
        fewest = std::min(fewest, p.samples), most = std::max(most, p.samples), least = std::min(least, 1 / v);
    }
    if (count < 3 || most < 4 * fewest) return {};
    const double b = (uu * v_sum - uv * u_sum) / (uu * vv - uv * uv);
    if (!(b >= 0.1 * least)) return {};
    return std::sqrt(std::min(b, least));
}

/// The lowest level of all curves: the others are raised by bias. So is that one if a point of any curve is below it,
/// and then nothing is known.
inline std::optional<double> lowest_level(std::span<const ReportCurve> curves) {
    std::optional<double> lowest;
    for (const ReportCurve& curve : curves)
        if (const auto level = level_of(curve); level && (!lowest || *level < *lowest)) lowest = level;
    for (const ReportCurve& curve : curves)
        for (const ReportCurve::Point& p : curve.points)
            if (lowest && p.error < *lowest) lowest.reset();
    return lowest;
}

/// The root of the relMSE of the reference itself, as far as the images tell. One that differs from it in nothing but
/// the seed and the number of samples, n instead of N, has N / n times its variance: of the relMSE between the two,
/// n / (n + N) is the reference's. Else, for independent samples, what is left on the curves.
inline std::optional<double> reference_noise(std::span<const ComparedImage> images, std::size_t reference,
                                             std::span<const ReportCurve> curves) {
    const Image& truth = images[reference].image;
    const double total = metadata_number(truth, "samples");
    double most = 0;
    std::optional<double> noise;
    bool independent = true;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == reference) continue;
        const Image& image = images[i].image;
        independent = independent && metadata_text(image, "sampling") == name(Sampling::independent);
        const auto same = [&](const char* key) { return metadata_text(image, key) == metadata_text(truth, key); };
        const double samples = metadata_number(image, "samples");
        if (!same("method") || !same("sampling") || same("seed") ||
            metadata_text(truth, "kind") != name(Kind::unbiased) || !(total > 0 && samples > most))
            continue;
        most = samples;
        noise = std::sqrt(relmse(image, truth) * samples / (samples + total));
    }
    return noise || !independent ? noise : lowest_level(curves);
}

inline constexpr const char* error_of_curves = "Error: root of relMSE";

}  // namespace detail

/// Renders `scene` with `method`, and measures the error (root of relMSE) to `reference` after 1, 2, 4, ... iterations
/// and at the end. The time that measuring takes counts for the budget but not on the curve. Throws `Error` as
/// `refuse_unless_comparable`, and what rendering throws.
template <class SceneType, class M>
ComparedImage render_measured(const SceneType& scene, const M& method, const Image& reference,
                              const Budget& budget = {}, Settings settings = {}) {
    using Clock = std::chrono::steady_clock;
    ComparedImage result{.name = std::string(M::name), .image = {}};
    double measuring = 0;
    std::uint64_t next = 1;
    settings.observer = [&, given = settings.observer](const Progress& progress) {
        if (progress.iterations >= next || progress.fraction >= 1) {
            const auto begin = Clock::now();
            const double error = std::sqrt(relmse(progress.film.image(), reference));
            result.history.push_back({progress.seconds - measuring, double(progress.iterations), error});
            while (next <= progress.iterations) next *= 2;
            measuring += std::chrono::duration<double>(Clock::now() - begin).count();
        }
        if (given) given(progress);
    };
    Session<SceneType, M> session(scene, method, settings);
    session.run(budget);
    result.image = session.image();
    return result;
}

/// Images against the one with the index `reference`: metrics, FLIP maps, and error over time and samples, where files
/// say how many they hold ("samples", "seconds" and "method" of their metadata). Throws `Error` unless they are
/// comparable.
inline Report comparison_report(std::span<const ComparedImage> images, std::size_t reference) {
    if (reference >= images.size()) throw Error("a comparison needs images, and a reference among them");
    Report report{.title = "Comparison with " + images[reference].name, .reference = reference};
    for (const ComparedImage& one : images) report.images.push_back({.name = one.name, .image = one.image});
    report.curves = detail::comparison_curves(images, reference);
    report.error_name = detail::error_of_curves;
    report.reference_noise = detail::reference_noise(images, reference, report.curves);
    detail::add_metrics(report, images, reference);
    return report;
}

}  // namespace lightswitch
