#pragma once

// How the options of all sub-commands read their values. A value that is wrong throws `Error`, which names the option.

#include "text.hpp"

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::program {

inline constexpr long long unlimited = std::numeric_limits<long long>::max();

/// A value that is given at most once and that `set(text)` checks and stores.
template <class Set>
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type, Set set,
                       const std::string& help) {
    return app.add_option_function<std::string>(name, std::function<void(const std::string&)>(set), help)
        ->type_name(type);
}

/// A value that may be given several times, one at a time.
template <class Set>
void add_values(CLI::App& app, const std::string& name, const std::string& type, Set set, const std::string& help) {
    app.add_option_function<std::vector<std::string>>(
           name,
           [set](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) set(text);
           },
           help)
        ->type_name(type)
        ->allow_extra_args(false);
}

/// A name, of a file or of anything else, that is not empty. `target` is a string or a path.
inline void add_name(CLI::App& app, const std::string& name, const std::string& type, auto& target,
                     const std::string& help) {
    const std::string option = name.substr(name.find("--"));
    add_value(
        app, name, type,
        [option, &target](const std::string& text) {
            if (text.empty()) throw Error(option + ": the name is empty");
            target = text;
        },
        help);
}

/// A finite number of single precision, of at least `least`, or above it when `above` is set.
inline float parse_float(std::string_view option, std::string_view text, double least, bool above) {
    const auto value = static_cast<float>(parse_number_option(option, text, least, above));
    if (!is_finite(value) || (above && !(static_cast<double>(value) > least)))
        throw Error(fmt::format("{}: \"{}\" is beyond the range of single precision", option, text));
    return value;
}

/// A whole number that fits an `int`.
inline int parse_int(std::string_view option, std::string_view text, int least,
                     int most = std::numeric_limits<int>::max()) {
    return static_cast<int>(parse_integer_option(option, text, least, most));
}

inline void add_seed(CLI::App& app, std::uint64_t& seed, const std::string& help) {
    add_value(
        app, "--seed", "K",
        [&](const std::string& text) {
            seed = static_cast<std::uint64_t>(parse_integer_option("--seed", text, 0, unlimited));
        },
        help);
}

inline void add_threads(CLI::App& app, int& threads, const std::string& more = "") {
    constexpr int most = 1024;
    add_value(
        app, "--threads", "T", [&](const std::string& text) { threads = parse_int("--threads", text, 0, most); },
        "rendering threads; 0, the default, is one per processor" + more);
}

}  // namespace lightswitch::program
