#pragma once

// The photon map: all items within one fixed radius of a point.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/core/parallel.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightswitch {

/// Finds the items within one fixed radius of a point. An Item is trivially copyable and has a finite `Vec3 position`.
///
/// A uniform grid whose cells are hashed to a table of buckets; items are stored sorted by bucket. Cells are one
/// diameter wide in y and z, so that the box around a query meets at most 2 x 2 rows of cells, and half as wide in x.
/// The cells of a row lie side by side in the table, so that a query reads one contiguous run of items per row; and
/// rows start at multiples of two irrational fractions of the table (those of Roberts' R2 sequence, 2018), so that
/// neighbouring rows never share a bucket and no item is met twice.
///
/// Building takes linear time, and a query expected time proportional to the items near it, unless most items are
/// farther than 2^31 diameters from the origin, where cells end. Distances are computed in float: with a radius below
/// 1e-19 things closer than that may count as coincident, and nothing is found farther away than 1.8e19.
///
/// Memory: at most 8 bytes per item besides the items, and while building once more the size of the items.
template <class Item>
requires std::is_trivially_copyable_v<Item> && std::default_initializable<Item>
class HashGrid {
public:
    /// Replaces the contents by `items`, for queries of `radius` (in the units of the positions).
    ///
    /// `items` is left empty, with memory for as many items: the two exchange their memory, so that who refills the
    /// same vector for every build allocates nothing in the long run. Items whose position is not finite are dropped.
    /// The result is the same to the bit for any executor. Throws `Error` when the radius is negative or not finite,
    /// and for more than 2^31 items; the grid is empty after any exception. Not to be called while another thread uses
    /// the grid.
    void build(std::vector<Item>& items, float radius, const Executor auto& executor) {
        count_ = 0;
        if (!is_finite(radius) || radius < 0) throw Error("the radius of a photon map must be finite and not negative");
        const std::size_t n = items.size();
        if (n > std::size_t{1} << 31) throw Error("a photon map holds at most 2^31 photons: trace fewer per iteration");
        const int bits = layout(n, radius);

        // A stable sort by bucket: first by its leading bits, block by block, which writes to few places at a time,
        // then each of those partitions by itself, in cache.
        const int shift = std::max(bits - partition_bits, 0);
        const std::size_t partitions = (std::size_t{mask_} + 1) >> shift, width = std::size_t{1} << shift;
        const std::size_t block = std::max<std::size_t>(min_block, n / max_blocks + 1);
        const std::size_t blocks = (n + block - 1) / block;
        std::vector<Counts> cursors(blocks);  // what each block has in each partition, then where that goes
        const auto partition_of = [&](const Item& item) {
            return is_finite(item.position) ? std::size_t{bucket(item.position) >> shift} : partitions;
        };
        const auto for_each_in_block = [&](std::size_t k, const auto& fn) {
            for (std::size_t i = k * block; i < std::min(n, (k + 1) * block); ++i) fn(items[i]);
        };
        executor.for_each(blocks, [&](std::size_t k) {
            cursors[k].fill(0);
            for_each_in_block(k, [&](const Item& item) { ++cursors[k][partition_of(item)]; });
        });
        Counts first;  // of each partition; the last one holds what is dropped
        std::uint32_t sum = 0;
        for (std::size_t p = 0; p <= partitions; ++p) {
            first[p] = sum;
            for (Counts& cursor : cursors) sum += std::exchange(cursor[p], sum);
        }
        executor.for_each(blocks, [&](std::size_t k) {
            for_each_in_block(k, [&](const Item& item) { items_[cursors[k][partition_of(item)]++] = item; });
        });
        executor.for_each(partitions, [&](std::size_t p) {
            // While items are placed, the entry after a bucket's own counts up from its begin to its end.
            std::uint32_t* const next = table_.data() + 1;
            std::fill(next + p * width, next + (p + 1) * width, 0u);
            for (std::size_t i = first[p]; i < first[p + 1]; ++i) ++next[bucket(items_[i].position)];
            std::uint32_t begin = first[p];
            for (std::size_t b = p * width; b < (p + 1) * width; ++b) begin += std::exchange(next[b], begin);
            for (std::size_t i = first[p]; i < first[p + 1]; ++i) items[next[bucket(items_[i].position)]++] = items_[i];
        });
        items_.swap(items);
        items.clear();
        count_ = first[partitions];
    }

    /// Calls `fn(item)` once for every item at a distance of at most the radius from `at` (none if `at` is not
    /// finite), in an order that depends on the build and on `at` alone. Safe to use from several threads.
    void for_each_near(const Vec3& at, auto&& fn) const {
        if (count_ == 0 || !is_finite(at)) return;
        const std::uint32_t x = cell_x(at.x - reach_), more = cell_x(at.x + reach_) - x;
        const std::uint32_t y = cell(at.y - reach_), y_end = cell(at.y + reach_) + 1;
        const std::uint32_t z = cell(at.z - reach_), z_end = cell(at.z + reach_) + 1;
        // All rows are looked up before any is read: the processor then waits for memory once and not four times.
        std::array<Run, 5> runs;  // at most one row goes past the end of the table and on from its begin
        std::size_t n = 0;
        for (std::uint32_t row_z = z; row_z != z_end; ++row_z) {
            for (std::uint32_t row_y = y; row_y != y_end; ++row_y) {
                const std::uint32_t begin = (x + stride_y_ * row_y + stride_z_ * row_z) & mask_, last = begin + more;
                runs[n] = {table_[begin], table_[std::min(last, mask_) + 1]};
                __builtin_prefetch(items_.data() + runs[n++].begin);
                if (last > mask_) [[unlikely]]
                    runs[n++] = {0, table_[last - mask_]};
            }
        }
        for (std::size_t k = 0; k < n; ++k) scan(runs[k], at, fn);
    }

    /// Number of items held: those of the last build whose position was finite.
    std::size_t size() const { return count_; }
    /// Memory held, including what is kept for later builds.
    std::size_t bytes() const { return items_.capacity() * sizeof(Item) + table_.capacity() * sizeof(std::uint32_t); }
    /// As given to `build`.
    float radius() const { return radius_; }

private:
    static constexpr int partition_bits = 8;
    static constexpr std::size_t min_block = 1 << 14, max_blocks = 64;
    using Counts = std::array<std::uint32_t, (std::size_t{1} << partition_bits) + 1>;
    struct Run {
        std::uint32_t begin, end;
    };

    /// Sets the cells and the size of the tables, and returns the binary logarithm of the number of buckets.
    int layout(std::size_t n, float radius) {
        radius_ = radius;
        radius_squared_ = square(std::min(radius, 0x1.fffffep+63f));
        // Slightly too large: whatever passes the test of distances in spite of rounding is in the cells that are
        // visited, and these are no more than 2 x 2 rows of 3 although the numbers of the cells are rounded, too.
        reach_ = std::max(double{radius}, 0x1p-60) * (1 + 0x1p-20);
        cells_per_unit_ = 1 / (2 * reach_ * (1 + 0x1p-16));
        // From 32 buckets on, the begins of rows that differ by at most 1 in y and z are at least 3 buckets apart.
        const int bits = static_cast<int>(std::bit_width(std::max<std::size_t>(n, 32) - 1));
        mask_ = (std::uint32_t{1} << bits) - 1;
        // The strides are 1/g and 1/g^2 of the table, where g^3 = g + 1.
        stride_y_ = static_cast<std::uint32_t>(0xc13fa9a902a6328fu >> (64 - bits)) | 1u;
        stride_z_ = static_cast<std::uint32_t>(0x91e10da5c79e7b1du >> (64 - bits)) | 1u;
        table_.resize(std::size_t{mask_} + 2);
        table_[0] = 0;
        if (items_.capacity() < n) items_ = {};  // or resize() would copy them, and reserve more than it is asked for
        items_.resize(n);
        return bits;
    }

    /// Cells are numbered in double, modulo 2^32, and positions farther out than 2^32 cells are in the last cell:
    /// monotone, and defined for all numbers but NaN.
    static std::uint32_t number_of(double cells) {
        constexpr double limit = 0x1p32 - 5;  // odd: the last cells do not share their bucket with those around 0
        // Positive, so that cutting off the fraction rounds down.
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(cells, -limit, limit) + limit));
    }
    std::uint32_t cell(double v) const { return number_of(v * cells_per_unit_); }
    std::uint32_t cell_x(double v) const { return number_of(v * (2 * cells_per_unit_)); }
    std::uint32_t bucket(const Vec3& p) const {
        return (cell_x(p.x) + stride_y_ * cell(p.y) + stride_z_ * cell(p.z)) & mask_;
    }

    /// Few of the items pass and no branch predictor can tell which: they are noted without a branch, and then visited.
    [[gnu::always_inline]] void scan(const Run& run, const Vec3& at, auto&& fn) const {
        std::array<std::uint32_t, 32> found;
        for (std::uint32_t i = run.begin; i < run.end;) {
            const std::uint32_t end = i + std::min<std::uint32_t>(run.end - i, 32);
            std::size_t n = 0;
            for (; i < end; ++i) {
                found[n] = i;
                n += length_squared(items_[i].position - at) <= radius_squared_;
            }
            for (std::size_t k = 0; k < n; ++k) fn(items_[found[k]]);
        }
    }

    std::vector<Item> items_;           // by bucket
    std::vector<std::uint32_t> table_;  // bucket b holds items_[table_[b]] up to items_[table_[b + 1]]
    std::size_t count_ = 0;
    float radius_ = 0, radius_squared_ = 0;
    double reach_ = 0, cells_per_unit_ = 0;
    std::uint32_t mask_ = 0, stride_y_ = 0, stride_z_ = 0;
};

}  // namespace lightswitch
