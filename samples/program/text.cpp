#include "text.hpp"

#include <lightswitch/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace lightswitch::program {
namespace {

/// Letters to insert, delete, replace or swap with their neighbour to make `b` of `a`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                cost[i][j] = i + j;
                continue;
            }
            cost[i][j] = std::min(
                {cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    return cost[a.size()][b.size()];
}

}  // namespace

std::string suggestion(std::string_view given, std::span<const std::string_view> known) {
    if (given.size() > 64) return {};
    std::string word(given);
    for (char& c : word) c = c == '_' || c == ' ' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    std::string_view nearest;
    std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string_view candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance >= least || distance >= candidate.size()) continue;
        least = distance;
        nearest = candidate;
    }
    if (nearest.empty() && word.size() > word.find_first_not_of('-') + 2) {  // a part of a name, or a name and more
        least = std::string::npos;
        for (const std::string_view candidate : known) {
            const bool part = candidate.find(word) != std::string_view::npos;
            if (!part && word.find(candidate) == std::string::npos) continue;
            const std::size_t distance = part ? candidate.size() - word.size() : word.size() - candidate.size();
            if (distance >= least) continue;
            least = distance;
            nearest = candidate;
        }
    }
    return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

std::string list(std::span<const std::string_view> names) { return fmt::format("{}", fmt::join(names, ", ")); }

long long parse_integer_option(std::string_view option, std::string_view text, long long least, long long most) {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size() && value >= least && value <= most) return value;
    throw Error(fmt::format("{}: \"{}\" is not a whole number {}", option, text,
                            most == std::numeric_limits<long long>::max() ? fmt::format("of at least {}", least)
                                                                          : fmt::format("from {} to {}", least, most)));
}

double parse_number_option(std::string_view option, std::string_view text, double least, bool above) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value) &&
        (above ? value > least : value >= least))
        return value;
    const bool any = least == std::numeric_limits<double>::lowest();
    throw Error(fmt::format("{}: \"{}\" is not a finite number{}", option, text,
                            any ? "" : fmt::format("{} {}", above ? " above" : " of at least", least)));
}

}  // namespace lightswitch::program
