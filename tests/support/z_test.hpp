#pragma once

// Do two noisy estimates have the same expected value? Welch's test, for whole images and for their tiles.

#include "support/chi_square.hpp"

#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/film/image.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace lightswitch::test {

/// Estimates of the tiles of an image (row by row from the top, three channels each) and of the whole.
struct TileEstimates {
    int columns = 0, rows = 0, side = 0;
    std::vector<Estimate> tiles;
    Estimate whole[3];

    /// No tile's variance below that of `other` times `factor`. Where light is found rarely, a few replicas often all
    /// miss it, and then seem more certain than they are; a longer render of the same kind knows better. With the ratio
    /// of the numbers of samples as `factor`, this only removes such false alarms.
    TileEstimates& at_least(const TileEstimates& other, double factor) {
        for (std::size_t i = 0; i < tiles.size(); ++i)
            if (tiles[i].variance < factor * other.tiles[i].variance) {
                tiles[i].variance = factor * other.tiles[i].variance;
                tiles[i].freedom = other.tiles[i].freedom;
            }
        return *this;
    }

    /// With `n` x `n` tiles joined into one. For tiles that err independently, as those of `load_tiles`.
    TileEstimates joined(int n) const {
        TileEstimates result{.columns = columns / n, .rows = rows / n, .side = side * n, .tiles = {}, .whole = {}};
        std::copy(whole, whole + 3, result.whole);
        result.tiles.resize(3 * static_cast<std::size_t>(result.columns * result.rows),
                            Estimate{.freedom = tiles[0].freedom});
        for (int y = 0; y < result.rows * n; ++y)
            for (int x = 0; x < result.columns * n; ++x)
                for (int c = 0; c < 3; ++c) {
                    const Estimate& from = tiles[static_cast<std::size_t>(3 * (y * columns + x) + c)];
                    Estimate& to = result.tiles[static_cast<std::size_t>(3 * (y / n * result.columns + x / n) + c)];
                    to.mean += from.mean / (n * n);
                    to.variance += from.variance / (double(n) * n * n * n);
                }
        return result;
    }
};

/// Collects independent images of one scene. Tiles average over many pixels and samples, so that their values are close
/// to normal.
class Replicas {
public:
    explicit Replicas(int side) : side_(side) {}

    void add(const Image& image) {
        columns_ = image.width() / side_;
        rows_ = image.height() / side_;
        values_.resize(3 * static_cast<std::size_t>(columns_ * rows_ + 1));
        std::vector<double> sums(values_.size());
        for (int y = 0; y < rows_ * side_; ++y)
            for (int x = 0; x < columns_ * side_; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double value = image(x, y)[c] / double(side_ * side_);
                    sums[index(y / side_ * columns_ + x / side_, c)] += value;
                    sums[index(columns_ * rows_, c)] += value / (columns_ * rows_);
                }
        for (std::size_t i = 0; i < sums.size(); ++i) values_[i].push_back(sums[i]);
    }

    TileEstimates estimates() const {
        TileEstimates result{.columns = columns_, .rows = rows_, .side = side_, .tiles = {}, .whole = {}};
        for (const auto& values : values_) result.tiles.push_back(Estimate::of(values));
        std::copy(result.tiles.end() - 3, result.tiles.end(), result.whole);
        result.tiles.resize(result.tiles.size() - 3);
        return result;
    }

private:
    static std::size_t index(int tile, int channel) { return static_cast<std::size_t>(3 * tile + channel); }

    int side_, columns_ = 0, rows_ = 0;
    std::vector<std::vector<double>> values_;
};

/// Reads tile data; see tests/data/reference.
inline TileEstimates load_tiles(const std::string& path) {
    TileEstimates result;
    std::ifstream file(path);
    file >> result.columns >> result.rows >> result.side;
    const int count = result.columns * result.rows;
    for (int tile = 0; tile < count; ++tile) {
        Estimate e[3];
        for (Estimate& channel : e) file >> channel.mean;
        for (Estimate& channel : e) {
            file >> channel.variance;
            channel.freedom = result.side * result.side;
        }
        for (int c = 0; c < 3; ++c) {
            result.tiles.push_back(e[c]);
            result.whole[c].mean += e[c].mean / count;
            result.whole[c].variance += e[c].variance / (double(count) * count);
        }
    }
    if (!file || count < 1) throw Error(path + ": no tile data");
    return result;
}

/// The outcome of a comparison of images: agreement unless something was less probable than `level`.
struct Comparison {
    double level = 0;     ///< of each single test
    double smallest = 1;  ///< p-value
    int tests = 0, worst_tile = -1, worst_channel = 0;
    double ours = 0, theirs = 0;  ///< where it is worst
    /// Of all tiles together: sees small differences that are everywhere, where `smallest` sees large ones at one
    /// place.
    ChiSquare together;

    bool agree() const { return smallest > level && together.p_value > level; }

    friend std::ostream& operator<<(std::ostream& out, const Comparison& c) {
        return out << "smallest p " << c.smallest << " of " << c.tests << " (level " << c.level << ") at tile "
                   << c.worst_tile << " channel " << c.worst_channel << ": " << c.ours << " against " << c.theirs
                   << "; together " << c.together;
    }
};

/// Compares all tiles and the whole, in all channels. When the expectations are equal, it disagrees with a probability
/// of at most `false_alarm`, if that is shared with `others` - 1 comparisons of the same size (Sidak; channels and the
/// whole depend on the tiles, which only makes it rarer).
inline Comparison compare(const TileEstimates& a, const TileEstimates& b, double false_alarm, int others = 1) {
    Comparison result;
    if (a.columns != b.columns || a.rows != b.rows) throw std::logic_error("tiles of different images");
    result.tests = static_cast<int>(a.tiles.size()) + 4;
    result.level = sidak(false_alarm, result.tests * others);
    const auto test = [&](const Estimate& ours, const Estimate& theirs, int tile, int channel) {
        // Differences within the rounding of float images do not count.
        const double p = welch_p(ours, theirs, 1e-6 * (std::abs(ours.mean) + std::abs(theirs.mean)));
        if (p < result.smallest) {
            result.smallest = p;
            result.worst_tile = tile;
            result.worst_channel = channel;
            result.ours = ours.mean;
            result.theirs = theirs.mean;
        }
        return p;
    };
    for (std::size_t i = 0; i < a.tiles.size(); ++i) {
        const double p = test(a.tiles[i], b.tiles[i], static_cast<int>(i) / 3, static_cast<int>(i) % 3);
        if (i % 3 != 1) continue;  // green stands for all: channels err together
        // The normal number that is as improbable as this t: squares of those add up to chi-square.
        const double z = student_quantile(std::max(p, 1e-300), infinity);
        result.together.statistic += z * z;
        ++result.together.degrees_of_freedom;
    }
    for (int c = 0; c < 3; ++c) test(a.whole[c], b.whole[c], -1, c);
    result.together.p_value = gamma_q(0.5 * result.together.degrees_of_freedom, 0.5 * result.together.statistic);
    return result;
}

/// The interval, of that confidence, of the relative bias of `ours`: its lower and upper end.
struct BiasInterval {
    double low = 0, high = 0;

    BiasInterval(const Estimate& ours, const Estimate& truth, double confidence = 0.99) {
        const Estimate difference = ours - truth;
        const double half = student_quantile(1 - confidence, difference.freedom) * std::sqrt(difference.variance);
        low = (difference.mean - half) / truth.mean;
        high = (difference.mean + half) / truth.mean;
    }

    bool within(double bound) const { return low > -bound && high < bound; }

    friend std::ostream& operator<<(std::ostream& out, const BiasInterval& b) {
        return out << "bias between " << 100 * b.low << " % and " << 100 * b.high << " %";
    }
};

}  // namespace lightswitch::test
