#pragma once

// What a sweep finds out: the errors of methods over time, and what follows from them.

#include <lightswitch/sweep/reference.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch {

/// Images of several seeds after the same number of iterations.
struct SweepPoint {
    double seconds = 0;  ///< of each, on average
    std::uint64_t iterations = 0;
    std::vector<double> errors{};  ///< of each: relMSE, less the part that the reference's own noise makes

    double error() const {
        double sum = 0;
        for (const double e : errors) sum += e;
        return errors.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / double(errors.size());
    }
    /// The band: the smallest and the largest. Of n seeds one more is outside with probability 2 / (n + 1).
    double low() const { return *std::min_element(errors.begin(), errors.end()); }
    double high() const { return *std::max_element(errors.begin(), errors.end()); }
    /// Standard error of the logarithm of `error`; infinite for one seed.
    double uncertainty() const {
        if (errors.size() < 2) return std::numeric_limits<double>::infinity();
        Moments m;
        for (const double e : errors) m.add(e);
        return std::sqrt(m.variance() / double(errors.size())) / m.mean();
    }
};

/// One method of a sweep.
struct SweptMethod {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    std::string name;
    Kind kind = Kind::unbiased;
    PathClasses missing = {};         ///< paths that the scene may hold and the method does not make
    std::vector<SweepPoint> curve{};  ///< at times that double; only errors that can be told from the reference's own
    SweepPoint last{};                ///< the end of the curve, even if its error cannot
    Image image{};                    ///< of the first seed, at the end
    double rays_per_second = 0;
    double typical =
        unknown;  ///< median of the relMSE of 8 x 8 tiles of `image`: what single bright pixels do not move
    double variance =
        unknown;  ///< of the last images, relative as relMSE: their error without bias; of two seeds or more
    double inefficiency = unknown;            ///< variance times seconds
    double bias = unknown;                    ///< of the mean over the image, as a fraction of the reference's
    std::optional<Interval> bias_interval{};  ///< where that is with a probability of 99 %; of two seeds or more

    /// The error after so many seconds: between two points of the curve, by a power of time. Nothing before the first
    /// and, but for the fraction of an iteration, behind the last.
    std::optional<double> error_at(double seconds) const {
        if (curve.empty() || seconds < curve.front().seconds * 0.999) return {};
        const auto after =
            std::find_if(curve.begin(), curve.end(), [&](const auto& p) { return p.seconds >= seconds; });
        if (after == curve.begin()) return curve.front().error();
        if (after == curve.end())
            return seconds < 1.25 * curve.back().seconds ? std::optional(curve.back().error()) : std::nullopt;
        const SweepPoint &a = *(after - 1), &b = *after;
        const double part = std::log(seconds / a.seconds) / std::log(b.seconds / a.seconds);
        return a.error() * std::pow(b.error() / a.error(), part);
    }

    /// A time that may be known as a bound only.
    struct Time {
        double seconds = 0;
        bool at_most = false;  ///< already the first point was below
    };
    /// After how long the error stays at or below `target`, between two points by a power of time; nothing when it does
    /// not. An error that is lost in the reference's noise counts as a tenth of the target.
    std::optional<Time> seconds_to(double target) const {
        if (last.errors.empty() || !(target > 0)) return {};
        std::vector<SweepPoint> points = curve;
        if (points.empty() || points.back().iterations != last.iterations) points.push_back(last);
        std::size_t first = points.size();
        while (first > 0 && points[first - 1].error() <= target) --first;
        if (first == points.size()) return {};
        if (first == 0) return Time{points[0].seconds, true};
        const SweepPoint &above = points[first - 1], &below = points[first];
        const double bottom = std::log(std::max(below.error(), 0.1 * target)), top = std::log(above.error());
        const double part = top > bottom ? (top - std::log(target)) / (top - bottom) : 1;
        return Time{above.seconds * std::pow(below.seconds / above.seconds, part)};
    }
};

/// The best method after some time.
struct FrontierPoint {
    double seconds = 0;
    std::size_t best = 0;  ///< its place among the methods
    double error = 0;
    std::optional<std::size_t> second{};  ///< the next best, if any has an error yet
    double ratio = 1;                     ///< its error over that of the best
    bool clear = false;                   ///< beyond two standard errors, as far as the seeds tell
};

/// Every method under equal time.
struct Sweep {
    Reference reference{};
    std::vector<SweptMethod> methods{};
    double seconds = 0;    ///< that each method had for each seed
    int seeds = 0;         ///< independent images of each method
    bool stopped = false;  ///< before all was done

    /// The reference's own error as the unbiased methods see it: what is left of the best one's relMSE when its own
    /// variance is taken away. Nothing with fewer than two seeds.
    std::optional<double> seen_noise{};

    /// Errors below this are lost in the reference's own.
    double least_error() const { return 0.1 * reference.relmse; }

    const SweptMethod* find(std::string_view name) const {
        const auto found = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
        return found == methods.end() ? nullptr : &*found;
    }

    /// The best method at times that double up to the last.
    std::vector<FrontierPoint> frontier() const {
        std::vector<FrontierPoint> result;
        for (int left = 30; left >= 0; --left) {
            FrontierPoint point{.seconds = std::ldexp(seconds, -left)};
            const SweptMethod *best = nullptr, *second = nullptr;
            for (const SweptMethod& m : methods) {
                const auto error = m.error_at(point.seconds);
                if (!error) continue;
                if (!best || *error < point.error) {
                    second = best;
                    best = &m;
                    point.ratio = point.error > 0 ? point.error / *error : 1;
                    point.error = *error;
                } else if (!second || *error < point.ratio * point.error) {
                    second = &m;
                    point.ratio = *error / point.error;
                }
            }
            if (!best) continue;
            point.best = static_cast<std::size_t>(best - methods.data());
            if (second) {
                point.second = static_cast<std::size_t>(second - methods.data());
                const double noise =
                    std::hypot(uncertainty_at(*best, point.seconds), uncertainty_at(*second, point.seconds));
                point.clear = std::log(point.ratio) > 2 * noise;
            }
            result.push_back(point);
        }
        return result;
    }

private:
    static double uncertainty_at(const SweptMethod& m, double seconds) {
        const auto after =
            std::find_if(m.curve.begin(), m.curve.end(), [&](const auto& p) { return p.seconds >= seconds; });
        return (after == m.curve.end() ? m.curve.back() : *after).uncertainty();
    }
};

}  // namespace lightswitch
