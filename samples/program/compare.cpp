#include "program.hpp"

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/film/image_io.hpp>

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

}  // namespace

int compare(const CompareOptions& options) {
    for (const auto& output : options.outputs) {
        check_writable(output);
        if (has_extension(output, ".hdr") && !options.absolute)
            throw Error(output.string() + ": .hdr holds no negative values; use .exr or .pfm, or --absolute");
    }
    const Image a = load_image(options.a), b = load_image(options.b);
    const Image signed_difference = difference(a, b);

    const DVec3 mean_a = a.mean(), mean_b = b.mean();
    const Extremes extremes = find_extremes(signed_difference);
    line("A", fmt::format("{}, {} x {} pixels", options.a.string(), a.width(), a.height()));
    line("B", fmt::format("{}, the reference", options.b.string()));
    line("mean A", fmt::format("{:.6g} {:.6g} {:.6g}", mean_a.x, mean_a.y, mean_a.z));
    line("mean B", fmt::format("{:.6g} {:.6g} {:.6g}", mean_b.x, mean_b.y, mean_b.z));
    line("mean ratio", fmt::format("{:.6f}", mean_ratio(a, b)));
    line("MSE", fmt::format("{:.6g}", mse(a, b)));
    line("RMSE", fmt::format("{:.6g}", rmse(a, b)));
    line("relMSE", fmt::format("{:.6g}", relmse(a, b)));
    line("max |A - B|", extremes.largest > 0
                            ? fmt::format("{:.6g} at pixel ({}, {})", extremes.largest, extremes.x, extremes.y)
                            : "0");
    if (extremes.not_finite > 0) line("not finite", fmt::format("{} pixels of A - B", extremes.not_finite));

    const Image shown = options.absolute ? absolute_difference(a, b) : signed_difference;
    for (const auto& output : options.outputs) {
        if (!has_extension(output, ".png")) {
            save(output, shown);
            continue;
        }
        using Map = FalseColorOptions::Map;
        save(output, false_color(shown, {.map = options.absolute ? Map::sequential : Map::diverging,
                                         .scale = options.scale,
                                         .caption = options.absolute ? "|A - B|" : "A - B"}));
    }
    return success;
}

}  // namespace lightswitch::program
