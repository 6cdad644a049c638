#pragma once

// One look at two sets of images: every part, every tile size, every tile, every channel.

#include <lightswitch/verify/bias_history.hpp>
#include <lightswitch/verify/replicas.hpp>
#include <lightswitch/verify/verdict.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace lightswitch::detail {

/// Paths that only one side makes. Where they may be, the side without them may well be the darker one.
struct OneSided {
    PathClasses ours_lack, theirs_lack;

    bool any() const { return ours_lack.any() || theirs_lack.any(); }
};

/// The comparison of two sets of images at one look.
///
/// `level` is the probability of a false alarm that the look may use up. Half goes to the whole image, half to its
/// parts by length, in equal shares; each part shares in equal shares among the tile sizes, and there among tiles and
/// channels. The sum of the probabilities of events bounds the probability of any, whatever depends on what
/// (Bonferroni).
///
/// A consistent method (one with a `history`) is asked whether its bias shrinks. Where light or edges are finer than
/// its radius it does not for a long time, so single tiles are no evidence: more than half of the tiles that are not
/// black, and nine at least, must be off to the same side by more than they may. Were it fewer, then the rest, summed
/// up, would not be; and those tiles that are off least sum up to no more than the rest.
class TestOfParts {
public:
    TestOfParts(const Replicas& ours, const Replicas& theirs, double level, const OneSided& one_sided,
                const BiasHistory* history)
        : ours_(ours),
          theirs_(theirs),
          scale_(theirs.scale()),
          level_(level),
          one_sided_(one_sided),
          history_(history) {
        const std::size_t count = ours.parts() == theirs.parts() ? ours.parts() : 1;
        for (std::size_t i = 0; i < count; ++i) {
            const double share = count == 1 ? 1 : i == 0 ? 0.5 : 0.5 / double(count - 1);
            test(i, level * share);
        }
    }

    std::vector<Verdict::Part> parts;
    Image p_values;
    double events = std::numeric_limits<double>::infinity();
    /// The smallest `VerifyOptions::tolerance` that all intervals of the first three tile sizes keep within; and what
    /// it would be if nothing rare could be missing.
    double needed_tolerance = 0, plain_tolerance = 0;
    double observed_bias = 0;  ///< what it would have to be for what is seen, if there were no noise
    /// Of a consistent method: whether the bias of some tile of the whole image (`Verdict::Part::worst`) exceeds what
    /// it may be.
    bool stuck_somewhere = false;

    /// For `BiasHistory`.
    std::vector<BiasHistory::OfLevels> differences() const {
        const TileLayout& layout = ours_.layout();
        std::vector<BiasHistory::OfLevels> result(parts.size(), BiasHistory::OfLevels(layout.levels()));
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (std::size_t l = 0; l < layout.levels(); ++l) {
                const auto a = ours_.estimates(i, l), b = theirs_.estimates(i, l);
                result[i][l].resize(a.size());
                for (std::size_t t = 0; t < a.size(); ++t)
                    for (std::size_t c = 0; c < 3; ++c) {
                        const Estimate difference = a[t][c] - b[t][c];
                        result[i][l][t][c] = {std::abs(difference.mean), difference.variance};
                    }
            }
        return result;
    }

private:
    using OfTiles = std::vector<std::array<Estimate, 3>>;
    struct Sides {
        OfTiles ours, theirs;
    };

    /// Whether a difference in that direction says anything about the part.
    bool is_evidence(const Verdict::Part& part, bool ours_is_less) const {
        const PathClasses& lacking = ours_is_less ? one_sided_.ours_lack : one_sided_.theirs_lack;
        const bool open_ended = part.length == 0 || part.and_longer;
        return !lacking.any() || (!open_ended && part.length < lacking.shortest());
    }

    void test(std::size_t i, double level) {
        Verdict::Part part;
        part.length = ours_.length(i);
        part.and_longer = ours_.and_longer(i);
        const TileLayout& layout = ours_.layout();
        double least_of_tiles = std::numeric_limits<double>::infinity(), least_of_votes = least_of_tiles;
        bool found = false;
        Sides whole;
        for (std::size_t l = 0; l < layout.levels(); ++l) {
            const auto a = ours_.estimates(i, l), b = theirs_.estimates(i, l);
            const auto p = p_of_tiles(part, i, l, a, b);
            if (l == 0) whole = {a, b};
            if (i == 0 && l + 1 == layout.levels()) draw_p_values(layout, l, p);
            const double tests = 3 * double(layout.tiles(l)) * double(layout.levels());
            double largest = 0;  // of the significant differences on this level
            for (std::size_t t = 0; t < a.size(); ++t)
                for (std::size_t c = 0; c < 3; ++c) {
                    // The place is the largest difference on the finest level that shows one; or else the most
                    // improbable.
                    const double off = std::abs(a[t][c].mean - b[t][c].mean);
                    const bool significant = p[t][c] * tests < level;
                    if (significant ? off > largest : !found && p[t][c] * tests < least_of_tiles) {
                        part.worst = layout.tile(l, t);
                        part.worst_channel = static_cast<int>(c);
                        part.ours = a[t][c].mean;
                        part.theirs = b[t][c].mean;
                    }
                    if (significant) largest = std::max(largest, off);
                    found = found || significant;
                    least_of_tiles = std::min(least_of_tiles, p[t][c] * tests);
                }
            if (history_)
                least_of_votes =
                    std::min(least_of_votes, vote(part, i, l, {a, b}, whole) * 6 * double(layout.levels()));
            if (l == 0) measure_bias(part, a[0], b[0]);
            if (i == 0 && l < 3) measure_need(l, a, b);
        }
        part.p = std::min(1.0, history_ ? least_of_votes : least_of_tiles);
        part.disagrees = part.p < level;
        if (i == 0) stuck_somewhere = history_ && found;
        parts.push_back(part);
    }

    std::vector<std::array<double, 3>> p_of_tiles(const Verdict::Part& part, std::size_t i, std::size_t l,
                                                  const OfTiles& a, const OfTiles& b) const {
        std::vector<std::array<double, 3>> p(a.size());
        for (std::size_t t = 0; t < a.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c) {
                const double slack = rounding * (std::abs(a[t][c].mean) + std::abs(b[t][c].mean));
                double allowed = 0;
                if (history_) {
                    const auto bound = history_->allowed(double(ours_.samples()), i, l, t, c);
                    allowed =
                        bound ? bound->size + 4 * std::sqrt(bound->variance) : std::numeric_limits<double>::infinity();
                }
                p[t][c] =
                    is_evidence(part, a[t][c].mean < b[t][c].mean) ? welch_p(a[t][c], b[t][c], slack + allowed) : 1;
            }
        return p;
    }

    void draw_p_values(const TileLayout& layout, std::size_t l, const std::vector<std::array<double, 3>>& p) {
        p_values = Image(layout.columns(l), layout.rows(l));
        for (std::size_t t = 0; t < p.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c) p_values.pixels()[t][static_cast<int>(c)] = static_cast<float>(p[t][c]);
    }

    /// The probability that the bias of a majority of tiles seems not to shrink though it does: for the channel and the
    /// sign where that is least.
    double vote(const Verdict::Part& part, std::size_t i, std::size_t l, const Sides& tiles, const Sides& whole) const {
        double least = 1;
        for (std::size_t c = 0; c < 3; ++c)
            for (const double sign : {-1.0, 1.0})
                if (is_evidence(part, sign < 0)) least = std::min(least, vote(i, l, c, sign, tiles, whole));
        return least;
    }
    double vote(std::size_t i, std::size_t l, std::size_t c, double sign, const Sides& tiles,
                const Sides& whole) const {
        // In proportion to the tiles' brightness.
        std::vector<double> excess;
        std::array<std::vector<double>, 2> variances, thirds;  // of both sides
        Estimate ours, theirs;
        for (std::size_t t = 0; t < tiles.ours.size(); ++t) {
            const Estimate &x = tiles.ours[t][c], &y = tiles.theirs[t][c];
            const double brightness = std::max(std::abs(x.mean), std::abs(y.mean));
            if (!(brightness > 1e-3 * scale_[c])) continue;
            const auto allowed = history_->allowed(double(ours_.samples()), i, l, t, c);
            if (!allowed) return 1;
            const double weight = 1 / (brightness + 0.1 * scale_[c]), square = weight * weight;
            excess.push_back(weight * (sign * (x.mean - y.mean) - allowed->size - rounding * brightness));
            variances[0].push_back(square * (x.variance + allowed->variance));
            variances[1].push_back(square * y.variance);
            thirds[0].push_back(square * weight * x.third);
            thirds[1].push_back(square * weight * y.third);
            ours.unseen = std::max(ours.unseen, weight * x.unseen);
            theirs.unseen = std::max(theirs.unseen, weight * y.unseen);
            ours.freedom = std::min(ours.freedom, x.freedom);
            theirs.freedom = std::min(theirs.freedom, y.freedom);
        }
        const std::size_t majority = std::max<std::size_t>(9, excess.size() / 2 + 1);
        if (excess.size() < majority) return 1;
        // Of any tiles, as many as are not in the majority.
        const std::size_t rest = excess.size() - majority + 1;
        const auto sum_of_first = [&](std::vector<double>& values, auto order) {
            std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rest) - 1, values.end(), order);
            return std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(rest), 0.0);
        };
        const double sum = sum_of_first(excess, std::less<>());
        if (!(sum > 0)) return 1;
        ours.variance = sum_of_first(variances[0], std::greater<>()) * dependence(tiles.ours, whole.ours, c);
        theirs.variance = sum_of_first(variances[1], std::greater<>()) * dependence(tiles.theirs, whole.theirs, c);
        ours.third = sum_of_first(thirds[0], std::greater<>());
        theirs.third = sum_of_first(thirds[1], std::greater<>());
        ours.mean = sign * sum;
        return welch_p(ours, theirs);
    }

    /// By how much the variance of a sum of tiles exceeds that of independent ones.
    static double dependence(const OfTiles& tiles, const OfTiles& whole, std::size_t c) {
        double sum = 0;
        for (const auto& tile : tiles) sum += tile[c].variance;
        const double count = double(tiles.size());
        return sum > 0 ? std::max(1.0, count * count * whole[0][c].variance / sum) : 1;
    }

    void measure_bias(Verdict::Part& part, const std::array<Estimate, 3>& a, const std::array<Estimate, 3>& b) {
        for (std::size_t c = 0; c < 3; ++c) {
            const Interval interval = welch_interval(a[c], b[c], level_ / 3);
            part.bias[c] = (a[c].mean - b[c].mean) / scale_[c];
            part.interval[c] = {interval.low / scale_[c], interval.high / scale_[c]};
            part.share[c] = b[c].mean / scale_[c];
            if (part.length > 0) continue;
            for (const Estimate* e : {&a[c], &b[c]})
                if (e->third > 0)
                    events = std::min(events, e->variance * e->variance * e->variance / (e->third * e->third));
        }
    }

    void measure_need(std::size_t l, const OfTiles& a, const OfTiles& b) {
        const double tiles = double(a.size());
        for (std::size_t t = 0; t < a.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c) {
                Estimate ours = a[t][c], theirs = b[t][c];
                if (l > 0) ours.unseen = theirs.unseen = 0;  // what may be missing of the whole bounds it for the tiles
                const auto need = [&] {
                    const Interval interval = welch_interval(ours, theirs, level_ / (3 * 3 * tiles));
                    return std::max(interval.high, -interval.low) / (scale_[c] * tiles);
                };
                needed_tolerance = std::max(needed_tolerance, need());
                ours.third = theirs.third = ours.unseen = theirs.unseen = 0;
                plain_tolerance = std::max(plain_tolerance, need());
                observed_bias = std::max(observed_bias, std::abs(ours.mean - theirs.mean) / (scale_[c] * tiles));
            }
    }

    /// Images hold floats: relative differences as small as this are no evidence.
    static constexpr double rounding = 5e-6;

    const Replicas &ours_, &theirs_;
    std::array<double, 3> scale_;  // what a bias is a fraction of
    double level_;
    OneSided one_sided_;
    const BiasHistory* history_;
};

}  // namespace lightswitch::detail
