#pragma once

// A sweep in words: tables for terminals and pages, and as comma-separated values.

#include <lightswitch/sweep/sweep.hpp>

#include <array>
#include <charconv>
#include <ostream>
#include <string>
#include <vector>

namespace lightswitch {

namespace detail {

inline std::string digits(double value, int count = 3) {
    if (std::isnan(value)) return "-";
    std::array<char, 32> text{};
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, count).ptr};
}

inline std::string sweep_percent(double value) {
    const std::string text = digits(100 * value, std::abs(value) < 0.1 ? 2 : 3);
    return (value < 0 ? "" : "+") + text + " %";
}

/// An error; one that is lost in the reference's own as a bound.
inline std::string error_text(double error, double least) {
    return error > 0 && error >= least ? digits(error) : "<" + digits(least);
}

inline std::string time_text(const std::optional<SweptMethod::Time>& time) {
    return !time ? "-" : (time->at_most ? "<" : "") + digits(time->seconds);
}

/// Rows of text, the first of which is the header.
using TextTable = std::vector<std::vector<std::string>>;

inline TextTable method_table(const Sweep& sweep) {
    TextTable table{{"method", "kind", "samples", "Mrays/s", "relMSE", "from", "to", "typical", "s to 1e-2",
                     "s to 1e-3", "var x s", "bias", "99 % from", "to"}};
    const double least = sweep.least_error();
    for (const SweptMethod& m : sweep.methods) {
        const bool band = m.last.errors.size() > 1;
        table.push_back({m.name, std::string(name(m.kind)), std::to_string(m.last.iterations),
                         digits(1e-6 * m.rays_per_second), error_text(m.last.error(), least),
                         band ? error_text(m.last.low(), least) : "-", band ? error_text(m.last.high(), least) : "-",
                         error_text(m.typical, least), time_text(m.seconds_to(1e-2)), time_text(m.seconds_to(1e-3)),
                         digits(m.inefficiency), std::isnan(m.bias) ? "-" : sweep_percent(m.bias),
                         m.bias_interval ? sweep_percent(m.bias_interval->low) : "-",
                         m.bias_interval ? sweep_percent(m.bias_interval->high) : "-"});
    }
    return table;
}

inline TextTable frontier_table(const Sweep& sweep) {
    TextTable table{{"seconds", "best", "relMSE", "next", "its relMSE", "clear"}};
    for (const FrontierPoint& p : sweep.frontier())
        table.push_back({digits(p.seconds), sweep.methods[p.best].name, digits(p.error),
                         p.second ? sweep.methods[*p.second].name : "-", p.second ? "x " + digits(p.ratio) : "-",
                         p.second ? p.clear ? "yes" : "no" : "-"});
    return table;
}

/// What the errors are measured against.
inline std::string reference_text(const Reference& r, const std::optional<double>& seen) {
    if (r.first.empty()) {
        std::string text = "Reference: an image that was given.";
        if (seen) text += " Its own relMSE is about " + digits(r.relmse, 2) + ", as the best method's images tell.";
        else text += " Its own error is not known: that takes two seeds or more.";
        return text;
    }
    std::string text = "Reference: " + r.first;
    text += r.second == r.first ? ", checked by other seeds of the same" : ", checked by " + r.second;
    text += "; its own relMSE is " + digits(r.relmse, 2) + " by the spread of its images";
    if (seen) text += ", and " + digits(*seen, 2) + " by what the best method's images tell";
    if (seen && *seen > 2 * r.relmse) text += " (rare bright paths: it is worse than it knows)";
    text += ". The two parts differ by " + sweep_percent(r.ratio - 1) + " in the mean (" + digits(r.deviations, 2) +
            " deviations), and by " + digits(r.worst_tile, 2) + " deviations in the worst of 16 tiles";
    text += r.consistent() ? "."
                           : ": they disagree, or one of them rests on a few rare bright paths. Do not trust the "
                             "errors; give it more time.";
    if (r.missing.any()) text += " It lacks " + describe(r.missing) + ": methods that show them seem wrong.";
    return text;
}

/// Which method is the best when, in a sentence.
inline std::string frontier_text(const Sweep& sweep) {
    std::string text;
    std::size_t last = sweep.methods.size();
    const std::vector<FrontierPoint> frontier = sweep.frontier();
    for (const FrontierPoint& p : frontier) {
        if (p.best == last) continue;
        text += (text.empty() ? "Best: " : "; ") + sweep.methods[p.best].name + " from " + digits(p.seconds, 2) + " s";
        last = p.best;
    }
    if (text.empty()) return "No error could be told from that of the reference.";
    const FrontierPoint& end = frontier.back();
    text += ". At " + digits(end.seconds) + " s";
    if (end.second)
        text += " " + sweep.methods[*end.second].name + " is next with " + digits(end.ratio, 2) + " times the error" +
                (end.clear ? "" : ", which the seeds do not tell apart for sure");
    else text += " no other has an error yet";
    return text + ".";
}

}  // namespace detail

/// The curves as comma-separated values, a row for each point; `resolved` is 0 where the error is lost in that of the
/// reference.
inline std::string sweep_csv(const Sweep& sweep) {
    using detail::digits;
    std::string text = "method,kind,iterations,seconds,relmse,low,high,seeds,resolved\n";
    for (const SweptMethod& m : sweep.methods) {
        const auto add = [&](const SweepPoint& p, bool resolved) {
            text += m.name + "," + std::string(name(m.kind)) + "," + std::to_string(p.iterations) + "," +
                    digits(p.seconds, 6) + "," + digits(p.error(), 6) + "," + digits(p.low(), 6) + "," +
                    digits(p.high(), 6) + "," + std::to_string(p.errors.size()) + (resolved ? ",1\n" : ",0\n");
        };
        for (const SweepPoint& p : m.curve) add(p, true);
        if (m.curve.empty() || m.curve.back().iterations != m.last.iterations) add(m.last, false);
    }
    return text;
}

inline std::ostream& operator<<(std::ostream& out, const Sweep& sweep) {
    if (sweep.methods.empty()) return out << "Stopped before there was anything to compare.\n";
    const auto print = [&](const detail::TextTable& table) {
        for (const auto& row : table) {
            for (std::size_t c = 0; c < row.size(); ++c) {
                std::size_t width = 0;
                for (const auto& other : table) width = std::max(width, other[c].size());
                const std::string gap(width - row[c].size(), ' ');
                out << (c > 0 ? "  " : "") << (c < 2 ? row[c] + gap : gap + row[c]);
            }
            out << '\n';
        }
    };
    out << detail::reference_text(sweep.reference, sweep.seen_noise) << "\n\n";
    print(detail::method_table(sweep));
    return out << '\n' << detail::frontier_text(sweep) << '\n';
}

}  // namespace lightswitch
