#include "method_options.hpp"

#include "options.hpp"
#include "values.hpp"

#include <concepts>

namespace lightswitch::program {
namespace {

/// Calls `f` for every setting: option, key of --stats, where `MethodOptions` keeps it, and what leads from a method
/// that has it to the member.
void for_each_setting(auto&& f) {
    f(
        "--radius", "initial_radius_pixels", &MethodOptions::radius,
        [](auto& m) -> auto& requires requires { m.radius.pixels; } { return m.radius.pixels; });
    f(
        "--alpha", "alpha", &MethodOptions::alpha,
        [](auto& m) -> auto& requires requires { m.radius.alpha; } { return m.radius.alpha; });
    f(
        "--photon-paths", "paths_per_pixel", &MethodOptions::photon_paths,
        [](auto& m) -> auto& requires requires { m.paths_per_pixel; } { return m.paths_per_pixel; });
    f(
        "--final-gather", "final_gather", &MethodOptions::final_gather,
        [](auto& m) -> auto& requires requires { m.final_gather; } { return m.final_gather; });
    f(
        "--bootstrap", "bootstrap", &MethodOptions::bootstrap,
        [](auto& m) -> auto& requires requires { m.bootstrap; } { return m.bootstrap; });
    f(
        "--mutations", "mutations_per_pixel", &MethodOptions::mutations,
        [](auto& m) -> auto& requires requires { m.mutations; } { return m.mutations; });
    f(
        "--no-refine", "refine", &MethodOptions::refine,
        [](auto& m) -> auto& requires requires { m.refine; } { return m.refine; });
}

/// The names of the methods that have the member, such as "photon, vcm".
std::string owners(const auto& member) {
    std::vector<std::string_view> names;
    for_each_method([&](const auto& m) {
        if constexpr (std::invocable<decltype(member), decltype(m)>) names.push_back(m.name);
    });
    return list(names);
}

[[noreturn]] void refuse_setting(std::string_view option, std::span<const AnyMethod> methods,
                                 const std::string& having) {
    std::vector<std::string_view> names;
    for (const AnyMethod& method : methods) names.push_back(method_name(method));
    throw Error(methods.empty()
                    ? fmt::format("{}: files have no settings; leave it out", option)
                    : fmt::format("{}: there is no such setting in {}; it belongs to {}", option, list(names), having));
}

/// The shortest decimal number that is the same in single precision: 0.3 instead of 0.30000001192092896.
double decimal(float value) { return std::strtod(fmt::format("{}", value).c_str(), nullptr); }

}  // namespace

void add_method_options(CLI::App& app, MethodOptions& options) {
    const auto add = [&](const std::string& name, const std::string& type, auto set, const std::string& help) {
        add_value(app, name, type, set, help)->group("Options of single methods");
    };
    add(
        "--radius", "PIXELS",
        [&](const std::string& text) {
            options.radius = parse_float("--radius", text, 0, false);
            if (*options.radius > 1000) throw Error("--radius: it must be at most 1000 pixels");
        },
        "photon, vcm: radius in pixels within which light is gathered in\nthe first iteration "
        "(default: photon 4, vcm 1); 0: vcm merges\nnothing");
    add(
        "--alpha", "A",
        [&](const std::string& text) {
            options.alpha = parse_float("--alpha", text, 0, true);
            if (*options.alpha >= 1) throw Error("--alpha: it must be below 1, such as 0.667");
        },
        "photon, vcm: the area shrinks as iterations^(A - 1), with A above\n0 and below 1 (default: 0.667)");
    add(
        "--photon-paths", "N",
        [&](const std::string& text) { options.photon_paths = parse_number_option("--photon-paths", text, 0, true); },
        "photon: light paths per pixel and iteration (default: 0.5)");
    app.add_flag_callback(
           "--final-gather", [&] { options.final_gather = true; },
           "photon: one more bounce before light is gathered (default: not)")
        ->group("Options of single methods");
    add(
        "--bootstrap", "N",
        [&](const std::string& text) { options.bootstrap = parse_int("--bootstrap", text, 1, 1 << 24); },
        "mlt: number of paths that tell beforehand how bright the image is\n(default: 32768)");
    add(
        "--mutations", "N",
        [&](const std::string& text) {
            options.mutations = parse_float("--mutations", text, 0, true);
            if (*options.mutations > 1000) throw Error("--mutations: it must be at most 1000");
        },
        "mlt: mutations per pixel and iteration where much is left to\nchains; fewer elsewhere (default: 0.5)");
    app.add_flag_callback(
           "--no-refine", [&] { options.refine = false; },
           "mlt: plan chains by the first paths alone (default: by all\niterations before)")
        ->group("Options of single methods");
}

void set_options(std::span<AnyMethod> methods, const MethodOptions& options, std::size_t pixels) {
    for_each_setting([&](std::string_view option, std::string_view, auto kept, const auto& member) {
        const auto& value = options.*kept;
        if (!value) return;
        bool used = false;
        const auto set = [&](auto& m) {
            if constexpr (std::invocable<decltype(member), decltype(m)>) {
                member(m) = *value;
                used = true;
            }
        };
        for (AnyMethod& method : methods) std::visit(set, method);
        if (!used) refuse_setting(option, methods, owners(member));
    });
    for (const AnyMethod& method : methods)
        if (const auto* photon = std::get_if<PhotonMapping>(&method)) {
            if (!(photon->radius.pixels > 0)) throw Error("--radius: photon would gather nothing; it must be above 0");
            if (photon->paths_per_pixel * double(pixels) > double(Image::max_area))
                throw Error(
                    fmt::format("--photon-paths: {:.6g} for each of {} pixels are more light paths than an "
                                "iteration may have, {}; more iterations (--spp) do the same",
                                photon->paths_per_pixel, pixels, Image::max_area));
        }
}

std::vector<std::pair<std::string_view, std::variant<bool, int, double>>> settings_of(const AnyMethod& method) {
    std::vector<std::pair<std::string_view, std::variant<bool, int, double>>> settings;
    for_each_setting([&](std::string_view, std::string_view key, auto, const auto& member) {
        std::visit(
            [&](const auto& m) {
                if constexpr (std::invocable<decltype(member), decltype(m)>) {
                    const auto value = member(m);
                    if constexpr (std::same_as<decltype(value), const float>)
                        settings.emplace_back(key, decimal(value));
                    else settings.emplace_back(key, value);
                }
            },
            method);
    });
    return settings;
}

}  // namespace lightswitch::program
