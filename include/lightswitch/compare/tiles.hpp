#pragma once

// Independent images, summed up over tiles of every size from a few pixels to the whole.

#include <lightswitch/compare/statistics.hpp>
#include <lightswitch/film/image.hpp>

#include <array>
#include <vector>

namespace lightswitch {

/// A rectangle of pixels: columns [x0, x1), rows [y0, y1).
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// How an image is cut into tiles: level 0 is the whole, level k has up to 2^k x 2^k tiles, the finest at most 16 x
/// 16 of at least 4 x 4 pixels.
class TileLayout {
public:
    TileLayout() = default;
    TileLayout(int width, int height) : width_(width), height_(height) {
        for (int level = 0; level <= 4; ++level) {
            const int columns = parts(width, level), rows = parts(height, level);
            if (level > 0 && columns == columns_.back() && rows == rows_.back()) break;
            columns_.push_back(columns);
            rows_.push_back(rows);
        }
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t levels() const { return columns_.size(); }
    int columns(std::size_t level) const { return columns_[level]; }
    int rows(std::size_t level) const { return rows_[level]; }
    std::size_t tiles(std::size_t level) const {
        return static_cast<std::size_t>(columns_[level]) * static_cast<std::size_t>(rows_[level]);
    }
    PixelRectangle tile(std::size_t level, std::size_t index) const {
        const int columns = columns_[level], rows = rows_[level];
        const int i = static_cast<int>(index) % columns, j = static_cast<int>(index) / columns;
        return {edge(i, columns, width_), edge(j, rows, height_), edge(i + 1, columns, width_),
                edge(j + 1, rows, height_)};
    }
    /// The tile of `level` that holds the finest tile `index`.
    std::size_t ancestor(std::size_t level, std::size_t index) const {
        const int columns = columns_.back(), rows = rows_.back();
        const int i = static_cast<int>(index) % columns * columns_[level] / columns;
        const int j = static_cast<int>(index) / columns * rows_[level] / rows;
        return static_cast<std::size_t>(j * columns_[level] + i);
    }

private:
    // Powers of two, so that coarse tiles are made of whole fine ones.
    static int parts(int pixels, int level) {
        int count = 1;
        for (int k = 0; k < level && 2 * count * 4 <= pixels; ++k) count *= 2;
        return count;
    }
    static int edge(int i, int parts, int pixels) {
        return static_cast<int>(static_cast<long long>(pixels) * i / parts);
    }

    int width_ = 0, height_ = 0;
    std::vector<int> columns_, rows_;
};

/// Mean radiance of every tile on every level, in three channels, over independent images.
class TileMoments {
public:
    TileMoments() = default;
    explicit TileMoments(const TileLayout& layout) : layout_(layout), levels_(layout.levels()) {
        for (std::size_t level = 0; level < levels_.size(); ++level) levels_[level].resize(layout.tiles(level));
    }

    const TileLayout& layout() const { return layout_; }
    std::uint64_t count() const { return levels_.empty() ? 0 : levels_[0][0][0].count(); }

    /// Adds an image, less another one where that is given. Both must have the layout's size.
    void add(const Image& image, const Image* less = nullptr) {
        const std::size_t finest = layout_.levels() - 1;
        std::vector<std::vector<DVec3>> sums(layout_.levels());
        for (std::size_t level = 0; level <= finest; ++level) sums[level].resize(layout_.tiles(level), DVec3(0));
        for (std::size_t t = 0; t < layout_.tiles(finest); ++t) {
            const PixelRectangle r = layout_.tile(finest, t);
            DVec3 sum(0);
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    sum += DVec3(image(x, y));
                    if (less) sum -= DVec3((*less)(x, y));
                }
            for (std::size_t level = 0; level <= finest; ++level) sums[level][layout_.ancestor(level, t)] += sum;
        }
        for (std::size_t level = 0; level <= finest; ++level)
            for (std::size_t t = 0; t < sums[level].size(); ++t) {
                const PixelRectangle r = layout_.tile(level, t);
                const double area = double(r.x1 - r.x0) * double(r.y1 - r.y0);
                for (int c = 0; c < 3; ++c)
                    levels_[level][t][static_cast<std::size_t>(c)].add(sums[level][t][c] / area);
            }
    }

    /// Per tile and channel of a level.
    std::vector<std::array<Estimate, 3>> estimates(std::size_t level) const {
        const auto& tiles = levels_[level];
        std::vector<std::array<Estimate, 3>> result(tiles.size());
        const double n = static_cast<double>(count());
        for (std::size_t c = 0; c < 3; ++c) {
            double pooled_variance = 0, pooled_third = 0, thirds = 0, cubes = 0;
            for (const auto& tile : tiles) {
                pooled_variance += tile[c].variance() / double(tiles.size());
                pooled_third += std::max(0.0, Estimate::of(tile[c]).third) * n * n / double(tiles.size());
                thirds += tile[c].third();
                cubes += std::pow(tile[c].variance(), 1.5);
            }
            // Of few tiles it would be noise.
            const double usual_skewness = tiles.size() >= 16 && cubes > 0 ? thirds / cubes : 0;
            const std::vector<double> from_finest = third_from_finest(level, c);
            for (std::size_t t = 0; t < tiles.size(); ++t) {
                Estimate& e = result[t][c] = Estimate::of(tiles[t][c]);
                e.third = std::max(
                    {e.third, from_finest[t], usual_skewness * std::pow(tiles[t][c].variance(), 1.5) / (n * n)});
                // What is rare may have happened in other tiles only. A share of the average tile's moments makes
                // room for it.
                const double share = std::max(0.05, 4 / n);
                e.variance += share * pooled_variance / n;
                e.third += share * pooled_third / (n * n);
            }
        }
        return result;
    }

private:
    /// The third moment of the mean by the tiles' own: better known than from the images' means where tiles are
    /// independent.
    std::vector<double> third_from_finest(std::size_t level, std::size_t channel) const {
        const std::size_t finest = layout_.levels() - 1;
        std::vector<double> sums(layout_.tiles(level), 0.0);
        if (level == finest) return sums;
        const double share = double(layout_.tiles(level)) / double(layout_.tiles(finest)),
                     n = static_cast<double>(count());
        for (std::size_t t = 0; t < layout_.tiles(finest); ++t)
            sums[layout_.ancestor(level, t)] += levels_[finest][t][channel].third() * share * share * share / (n * n);
        return sums;
    }

    TileLayout layout_;
    std::vector<std::vector<std::array<Moments, 3>>> levels_;
};

}  // namespace lightswitch
