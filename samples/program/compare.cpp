#include "outputs.hpp"
#include "program.hpp"

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/film/image_io.hpp>
#include <lightswitch/report/comparison_report.hpp>

#include <fmt/format.h>

namespace lightswitch::program {
namespace {

bool has_extension(const std::filesystem::path& path, std::string_view wanted) {
    const std::string extension = path.extension().string();
    return std::equal(extension.begin(), extension.end(), wanted.begin(), wanted.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

struct Extremes {
    double largest = 0;          // of |a - b|, over finite channels
    int x = 0, y = 0;            // where
    std::size_t not_finite = 0;  // pixels
};

Extremes find_extremes(const Image& difference) {
    Extremes result;
    for (int y = 0; y < difference.height(); ++y)
        for (int x = 0; x < difference.width(); ++x) {
            const Rgb& d = difference(x, y);
            if (!is_finite(d)) {
                ++result.not_finite;
                continue;
            }
            const double magnitude = static_cast<double>(max_component(glm::abs(d)));
            if (magnitude > result.largest) result = {magnitude, x, y, result.not_finite};
        }
    return result;
}

void line(std::string_view label, const std::string& text) { fmt::print("{:<12}{}\n", label, text); }

void print_comparison(const ComparedImage& image, const ComparedImage& reference, const Image& difference) {
    const Image &a = image.image, &b = reference.image;
    const DVec3 mean_a = a.mean(), mean_b = b.mean();
    const Extremes extremes = find_extremes(difference);
    line("A", fmt::format("{}, {} x {} pixels", image.name, a.width(), a.height()));
    line("B", fmt::format("{}, the reference", reference.name));
    line("mean A", fmt::format("{:.6g} {:.6g} {:.6g}", mean_a.x, mean_a.y, mean_a.z));
    line("mean B", fmt::format("{:.6g} {:.6g} {:.6g}", mean_b.x, mean_b.y, mean_b.z));
    line("mean ratio", fmt::format("{:.6f}", mean_ratio(a, b)));
    line("MSE", fmt::format("{:.6g}", mse(a, b)));
    line("RMSE", fmt::format("{:.6g}", rmse(a, b)));
    line("relMSE", fmt::format("{:.6g}", relmse(a, b)));
    line("MAPE", fmt::format("{:.6g}", mape(a, b)));
    line("SMAPE", fmt::format("{:.6g}", smape(a, b)));
    line("max |A - B|", extremes.largest > 0
                            ? fmt::format("{:.6g} at pixel ({}, {})", extremes.largest, extremes.x, extremes.y)
                            : "0");
    if (extremes.not_finite > 0) line("not finite", fmt::format("{} pixels of A - B", extremes.not_finite));
}

/// What the first difference is, for the picture of it.
std::string caption(const ComparedImage& image, const ComparedImage& reference, bool absolute) {
    const std::string difference = fmt::format("{} - {}", std::filesystem::path(image.name).filename().string(),
                                               std::filesystem::path(reference.name).filename().string());
    return fmt::format("{}, W/(m^2 sr)", absolute ? "|" + difference + "|" : difference);
}

void write_difference(const CompareOptions& options, const Image& signed_difference, const std::string& caption) {
    Image shown = signed_difference;
    if (options.absolute)
        for (Rgb& p : shown.pixels()) p = glm::abs(p);
    for (const auto& output : options.outputs) {
        if (!has_extension(output, ".png")) {
            write_image(output, shown);
            continue;
        }
        using Map = FalseColorOptions::Map;
        write_image(output, false_color(shown, {.map = options.absolute ? Map::sequential : Map::diverging,
                                                .scale = options.scale,
                                                .caption = caption}));
    }
}

void check_outputs(const CompareOptions& options) {
    Outputs outputs;
    for (const auto& output : options.outputs) {
        outputs.add_image("--output", output);
        if (has_extension(output, ".hdr") && !options.absolute)
            throw Error("--output: " + output.string() +
                        ": .hdr holds no negative values; use .exr or .pfm, or --absolute");
    }
    outputs.add_file("--report", options.report);
    outputs.refuse_inputs(options.images);
    outputs.refuse_inputs({options.reference});
}

}  // namespace

int compare(const CompareOptions& options) {
    if (options.images.size() < (options.reference.empty() ? 2u : 1u))
        throw Error(options.reference.empty() ? "compare: name two images" : "compare: name an image");
    check_outputs(options);
    std::vector<ComparedImage> images;
    for (const auto& path : options.images) images.push_back({path.string(), load_image(path)});
    if (!options.reference.empty()) images.push_back({options.reference.string(), load_image(options.reference)});
    const ComparedImage& reference = images.back();

    std::vector<Image> differences;  // all of them before anything is printed: one may be refused
    for (std::size_t i = 0; i + 1 < images.size(); ++i)
        differences.push_back(difference(images[i].image, reference.image));
    for (std::size_t i = 0; i < differences.size(); ++i) {
        if (i > 0) fmt::print("\n");
        print_comparison(images[i], reference, differences[i]);
    }
    write_difference(options, differences.front(), caption(images.front(), reference, options.absolute));
    if (!options.report.empty()) write_report(options.report, comparison_report(images, images.size() - 1));
    return success;
}

}  // namespace lightswitch::program
