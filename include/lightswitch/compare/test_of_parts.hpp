#pragma once

// One look at two sets of images: every part, every tile size, every tile, every channel.

#include <lightswitch/compare/replicas.hpp>
#include <lightswitch/compare/verdict.hpp>

namespace lightswitch::detail {

class TestOfParts;

/// What the bias of a consistent method may be at this look: what it may have been at the first one, times a power of
/// the ratio of samples. Progressive photon mapping's bias falls with the squared radius, on average over n
/// iterations as n^(-1/3) (Knaus and Zwicker 2011, with alpha = 2/3); here a power of -1/4 is asked for.
class ShrinkingBound {
public:
    double allowed(std::size_t part, std::size_t level, std::size_t tile, std::size_t channel) const {
        if (looks_ == 0) return std::numeric_limits<double>::infinity();
        return first_[part][level][tile][channel] * std::pow(2.0, -0.25 * looks_);
    }
    /// After each look; the samples are doubled from one to the next.
    inline void learn(const TestOfParts& test);

private:
    friend class TestOfParts;
    int looks_ = 0;
    std::vector<std::vector<std::vector<std::array<double, 3>>>> first_;  // by part, level, tile, channel
};

/// The comparison of two sets of images at one look.
///
/// `level` is the probability of a false alarm that the look may use up. Half goes to the whole image, half to its
/// parts by length, in equal shares; each part shares in equal shares among the tile sizes, and there among tiles and
/// channels. The sum of the probabilities of events bounds the probability of any, whatever depends on what
/// (Bonferroni).
class TestOfParts {
public:
    TestOfParts(const Replicas& ours, const Replicas& theirs, double level, const ShrinkingBound* bound)
        : ours_(ours), theirs_(theirs), scale_(theirs.scale()), level_(level), bound_(bound) {
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

private:
    friend class ShrinkingBound;

    void test(std::size_t i, double level) {
        Verdict::Part part;
        part.length = ours_.length(i);
        part.and_longer = ours_.and_longer(i);
        const TileLayout& layout = ours_.layout();
        double worst = std::numeric_limits<double>::infinity();
        for (std::size_t l = 0; l < layout.levels(); ++l) {
            const auto a = ours_.estimates(i, l), b = theirs_.estimates(i, l);
            const double tests = 3 * double(layout.tiles(l)) * double(layout.levels());
            const bool finest = i == 0 && l + 1 == layout.levels();
            if (finest) p_values = Image(layout.columns(l), layout.rows(l));
            double largest = 0;  // of the significant differences on this level
            for (std::size_t t = 0; t < a.size(); ++t)
                for (std::size_t c = 0; c < 3; ++c) {
                    const double slack = rounding * (std::abs(a[t][c].mean) + std::abs(b[t][c].mean));
                    const double p = welch_p(a[t][c], b[t][c], slack + (bound_ ? bound_->allowed(i, l, t, c) : 0));
                    if (finest) p_values.pixels()[t][static_cast<int>(c)] = static_cast<float>(p);
                    // The place is the largest difference on the finest level that shows one; or else the most
                    // improbable.
                    const double off = std::abs(a[t][c].mean - b[t][c].mean);
                    const bool significant = p * tests < level;
                    if (significant ? off > largest : !part.disagrees && p * tests < worst) {
                        part.worst = layout.tile(l, t);
                        part.worst_channel = static_cast<int>(c);
                        part.ours = a[t][c].mean;
                        part.theirs = b[t][c].mean;
                    }
                    if (significant) largest = std::max(largest, off);
                    part.disagrees = part.disagrees || significant;
                    worst = std::min(worst, p * tests);
                }
            if (l == 0) measure_bias(part, a[0], b[0]);
            if (i == 0 && l < 3) measure_need(l, a, b);
        }
        part.p = std::min(1.0, worst);
        parts.push_back(part);
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

    void measure_need(std::size_t l, const auto& a, const auto& b) {
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
            }
    }

    /// Images hold floats: relative differences as small as this are no evidence.
    static constexpr double rounding = 5e-6;

    const Replicas &ours_, &theirs_;
    std::array<double, 3> scale_;  // what a bias is a fraction of
    double level_;
    const ShrinkingBound* bound_;
};

inline void ShrinkingBound::learn(const TestOfParts& test) {
    if (looks_++ > 0) return;
    const TileLayout& layout = test.ours_.layout();
    first_.resize(test.parts.size());
    for (std::size_t i = 0; i < first_.size(); ++i)
        for (std::size_t l = 0; l < layout.levels(); ++l) {
            const auto a = test.ours_.estimates(i, l), b = test.theirs_.estimates(i, l);
            auto& tiles = first_[i].emplace_back(a.size());
            // Far beyond the noise of the tile, so that missing the truth here costs nothing of the stated rate that
            // counts.
            const double p = test.level_ / (3 * double(layout.tiles(l)) * double(layout.levels()));
            for (std::size_t t = 0; t < a.size(); ++t)
                for (std::size_t c = 0; c < 3; ++c) {
                    const Interval interval = welch_interval(a[t][c], b[t][c], p);
                    tiles[t][c] = std::max(interval.high, -interval.low);
                }
        }
}

}  // namespace lightswitch::detail
