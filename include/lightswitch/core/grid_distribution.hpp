#pragma once

// A probability distribution over the cells of a grid.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>

#include <span>
#include <vector>

namespace lightswitch {

/// The interval [0, 1) cut into parts, each of a whole number of steps of 2^-24: the distance of the sampler's numbers.
/// It is kept as the ends of the parts, in steps, in memory of the caller.
namespace interval {

inline constexpr std::uint32_t steps = 1u << 24;

/// A part, and how far along it a number is: in [0, 1).
struct Found {
    std::size_t part = 0;
    float place = 0;
};

/// Makes parts with lengths proportional to the weights, rounded to whole steps but to no less than one for a positive
/// weight. If no weight is positive, all parts are empty. At most 2^24 weights, finite and not negative, with a finite
/// sum; throws `Error` otherwise. `ends` must be as long as `weights`.
inline void cut(std::span<const double> weights, std::span<std::uint32_t> ends) {
    if (weights.size() > steps) throw Error("more than 2^24 weights: too many for one number to choose from");
    double total = 0;
    std::uint32_t positive_left = 0;
    for (const double w : weights) {
        if (!(w >= 0 && is_finite(w))) throw Error("a weight is negative or not finite");
        total += w;
        positive_left += w > 0;
    }
    if (!is_finite(total)) throw Error("the sum of the weights is not finite");
    double sum = 0;
    std::uint32_t end = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] > 0) {
            --positive_left;
            sum += weights[i];
            const auto rounded = static_cast<std::uint32_t>(std::round(sum / total * steps));
            end = std::clamp(rounded, end + 1, steps - positive_left);
        }
        ends[i] = end;
    }
}

/// The part that holds `u` in [0, 1), which must be one of an interval that is not empty. All numbers within a step
/// count as its middle, so that places average to the middle of the part even where it is only a few steps long.
inline Found find(std::span<const std::uint32_t> ends, float u) {
    const auto step = static_cast<std::uint32_t>(std::clamp(u * 0x1p24f, 0.0f, 0x1p24f - 1));
    const auto end = std::upper_bound(ends.begin(), ends.end(), step);
    const std::uint32_t begin = end == ends.begin() ? 0 : end[-1];
    const float place = static_cast<float>((step - begin + 0.5) / (*end - begin));
    return {static_cast<std::size_t>(end - ends.begin()), std::min(place, 1 - unit_roundoff)};
}

/// The probability of a part.
inline float probability(std::span<const std::uint32_t> ends, std::size_t part) {
    return static_cast<float>(ends[part] - (part > 0 ? ends[part - 1] : 0)) * 0x1p-24f;
}

}  // namespace interval

/// Chooses a cell of a grid, with a probability proportional to its weight, and a place in the cell.
///
/// One number chooses the row and another the column in it; what is left of each is the place. Both maps are monotone,
/// which keeps the stratification of the sample points. Probabilities are rounded to whole multiples of 2^-24, once for
/// the row and once for the column in the row, and what `probability` says is exactly what happens. A cell of weight 0
/// is never chosen, any other can be. Takes 4 bytes per cell and per row (128 MiB for 8192 x 4096), and time that grows
/// with the logarithms of the sides. Immutable: safe to use from several threads.
class GridDistribution {
public:
    struct Cell {
        std::size_t column = 0, row = 0;
        Vec2 place{0};  ///< in [0, 1)^2, from the cell's first corner to the last
    };

    /// `fill(row, weights)` is called once for each row, in order, to set its `columns` weights. At least one row and
    /// column. Throws `Error` when there are more than 2^24 rows or columns, or when a weight is negative or it or the
    /// sum is not finite.
    template <class Fill>
    GridDistribution(std::size_t columns, std::size_t rows, const Fill& fill)
        : columns_(columns), ends_(columns * rows), row_ends_(rows) {
        std::vector<double> weights(columns), sums(rows);
        for (std::size_t row = 0; row < rows; ++row) {
            fill(row, std::span(weights));
            interval::cut(weights, std::span(ends_).subspan(row * columns, columns));
            for (const double w : weights) sums[row] += w;
        }
        interval::cut(sums, row_ends_);
    }

    /// True when no weight is positive: then nothing can be chosen.
    bool empty() const { return row_ends_.back() == 0; }

    /// The cell for `u` in [0, 1)^2. Must not be empty.
    Cell sample(const Vec2& u) const { return sample_in_row(interval::find(row_ends_, u.y), u.x); }
    /// The same after the row, of positive weight, has been chosen.
    Cell sample_in_row(const interval::Found& row, float u) const {
        const interval::Found column = interval::find(row_of(row.part), u);
        return {.column = column.part, .row = row.part, .place = {column.place, row.place}};
    }

    /// With which `sample` chooses the cell. Times the number of cells it is a density over the unit square.
    float probability(std::size_t column, std::size_t row) const {
        return interval::probability(row_ends_, row) * probability_in_row(column, row);
    }
    float probability_in_row(std::size_t column, std::size_t row) const {
        return interval::probability(row_of(row), column);
    }

private:
    std::span<const std::uint32_t> row_of(std::size_t row) const {
        return std::span(ends_).subspan(row * columns_, columns_);
    }

    std::size_t columns_;
    std::vector<std::uint32_t> ends_, row_ends_;
};

}  // namespace lightswitch
