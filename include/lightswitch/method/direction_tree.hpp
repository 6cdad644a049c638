#pragma once

// A density over the sphere of directions that is learnt from samples: a quadtree over a square that is folded around
// an octahedron.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/pdf.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace lightswitch {

/// The unit square folded around an octahedron whose faces are projected to the unit sphere: both ways take no function
/// but a square root, and the Jacobian is a power of the sum of the direction's coordinates.
namespace octahedron {

namespace detail {

/// What lies beyond the diagonals belongs to the lower half, and the other way round.
[[gnu::always_inline]] inline Vec2 turned_over(float x, float y) {
    return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y)};
}

}  // namespace detail

/// The place in [0, 1)^2 of a unit vector.
[[gnu::always_inline]] inline Vec2 to_square(const Vec3& w) {
    const float inverse = 1 / (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    Vec2 p(w.x * inverse, w.y * inverse);
    if (w.z < 0) p = detail::turned_over(p.x, p.y);
    constexpr float most = 1 - unit_roundoff;
    return {std::clamp(0.5f * p.x + 0.5f, 0.0f, most), std::clamp(0.5f * p.y + 0.5f, 0.0f, most)};
}

/// The unit vector of a place.
[[gnu::always_inline]] inline Vec3 to_direction(const Vec2& place) {
    Vec2 p(2 * place.x - 1, 2 * place.y - 1);
    const float z = 1 - std::abs(p.x) - std::abs(p.y);
    if (z < 0) p = detail::turned_over(p.x, p.y);
    return normalize(Vec3(p.x, p.y, z));
}

/// What a density over the square is over the sphere, at the unit vector `w`: a point of the octahedron at the distance
/// 1 / s from the middle, s the sum of the sizes of `w`'s coordinates, covers s^3 times the solid angle of its area in
/// the square from -1 to 1.
[[gnu::always_inline]] inline SolidAnglePdf to_solid_angle(float density, const Vec3& w) {
    const float s = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    return {density / (4 * s * s * s)};
}

}  // namespace octahedron

/// A density over the unit square, constant in the cells of a quadtree (Müller, Gross and Novák, "Practical Path
/// Guiding for Efficient Light-Transport Simulation", 2017, section 3.2). Reading is safe from several threads at once.
class DirectionTree {
public:
    static constexpr int max_depth = 9;
    static constexpr std::size_t max_nodes = 256;

    /// Even, in 256 cells.
    DirectionTree() { divide_evenly(4); }

    float density(Vec2 place) const {
        float density = 1;
        for (std::size_t n = 0;;) {
            const Node& node = nodes_[n];
            const std::size_t quarter = descend(place);
            density *= 4 * node.share[quarter];
            n = node.child[quarter];
            if (n == 0) return density;
        }
    }

    /// A place in the square of that density, for `u` uniform in [0, 1)^2.
    Vec2 sample(Vec2 u) const {
        Vec2 corner(0);
        float size = 1;
        for (std::size_t n = 0;;) {
            const Node& node = nodes_[n];
            const auto& share = node.share;
            const std::size_t x = choose(u.x, share[0] + share[2], share[1] + share[3]);
            const std::size_t y = choose(u.y, share[x], share[x + 2]);
            size *= 0.5f;
            corner += size * Vec2(x, y);
            n = node.child[x + 2 * y];
            if (n == 0) break;
        }
        constexpr float most = 1 - unit_roundoff;
        return {std::min(corner.x + size * u.x, most), std::min(corner.y + size * u.y, most)};
    }

    std::size_t nodes() const { return nodes_.size(); }
    std::size_t bytes() const { return nodes_.size() * sizeof(Node); }

private:
    friend class DirectionSums;

    /// Of the four quarters, by x and then y: the shares of the node's probability, and where they are divided further.
    /// The root is nobody's child, so 0 means nowhere.
    struct Node {
        std::array<float, 4> share{0.25f, 0.25f, 0.25f, 0.25f};
        std::array<std::uint16_t, 4> child{};
    };

    std::size_t divide_evenly(int levels) {
        const std::size_t n = nodes_.size();
        nodes_.emplace_back();
        for (std::size_t q = 0; q < 4 && levels > 1; ++q) {
            const std::size_t child = divide_evenly(levels - 1);
            nodes_[n].child[q] = static_cast<std::uint16_t>(child);
        }
        return n;
    }

    /// The quarter that holds a place, which becomes its place there.
    [[gnu::always_inline]] static std::size_t descend(Vec2& place) {
        place *= 2;
        const bool x = place.x >= 1, y = place.y >= 1;
        place -= Vec2(x, y);
        return std::size_t{x} + 2 * std::size_t{y};
    }
    /// The first or second of two parts by their weights; `u` becomes what is left of it.
    [[gnu::always_inline]] static std::size_t choose(float& u, float first, float second) {
        const float at = u * (first + second);
        const bool later = !(at < first);
        u = std::clamp(later ? (at - first) / second : at / first, 0.0f, 1 - unit_roundoff);
        return later;
    }

    std::vector<Node> nodes_;
};

/// Of what the next `DirectionTree` is made: sums over samples in the cells of the present one.
class DirectionSums {
public:
    DirectionSums() : DirectionSums(DirectionTree()) {}

    /// A sample at `place`: what it found over its density, and the density of the BSDF over its density.
    void add(Vec2 place, double found, double base) {
        for (std::size_t n = 0;;) {
            Cell& cell = cells_[n];
            const std::size_t quarter = DirectionTree::descend(place);
            n = cell.child[quarter];
            if (n != 0) continue;
            cell.sum[quarter] += {found, found * found, base};
            return;
        }
    }

    /// The density that the samples tell of. A few samples, or some that outshine the others, tell little: shares are
    /// drawn towards those of the BSDF, the more the fewer samples of equal weight would tell as much. Cells that hold
    /// more than `largest_cell` of the whole are divided, and those that hold less are not.
    DirectionTree tree() {
        const Sum whole = gather(0);
        DirectionTree result;
        if (!(whole.base > 0)) return result;
        result.nodes_.clear();
        divide(result, 0, whole, 1, 1);
        return result;
    }

    /// Takes over the cells of `tree`, and what was added before counts `factor` of it.
    void refit(const DirectionTree& tree, double factor) {
        DirectionSums next(tree);
        hand_over(next, 0, 0, {}, factor);
        *this = std::move(next);
    }

    std::size_t bytes() const { return cells_.size() * sizeof(Cell); }

private:
    static constexpr double largest_cell = 0.02, trust = 10;
    static constexpr std::ptrdiff_t nowhere = -1;

    struct Sum {
        double found = 0, squares = 0, base = 0;

        Sum& operator+=(const Sum& other) {
            found += other.found;
            squares += other.squares;
            base += other.base;
            return *this;
        }
        Sum operator*(double factor) const { return {found * factor, squares * factor, base * factor}; }
    };
    struct Cell {
        std::array<Sum, 4> sum{};
        std::array<std::uint16_t, 4> child{};
    };

    explicit DirectionSums(const DirectionTree& tree) : cells_(tree.nodes_.size()) {
        for (std::size_t i = 0; i < cells_.size(); ++i) cells_[i].child = tree.nodes_[i].child;
    }

    /// The sum over a cell, which those above it keep as well.
    Sum gather(std::size_t n) {
        Sum whole;
        for (std::size_t q = 0; q < 4; ++q) {
            const std::size_t child = cells_[n].child[q];
            if (child != 0) cells_[n].sum[q] = gather(child);
            whole += cells_[n].sum[q];
        }
        return whole;
    }

    /// A quarter of the cell `from`, where there is one, and its own cell; quarters of what is not divided are alike.
    std::pair<Sum, std::ptrdiff_t> quarter(std::ptrdiff_t from, const Sum& whole, std::size_t q) const {
        if (from == nowhere) return {whole * 0.25, nowhere};
        const Cell& cell = cells_[static_cast<std::size_t>(from)];
        return {cell.sum[q], cell.child[q] == 0 ? nowhere : cell.child[q]};
    }

    void hand_over(DirectionSums& next, std::size_t to, std::ptrdiff_t from, const Sum& whole, double factor) const {
        for (std::size_t q = 0; q < 4; ++q) {
            const auto [sum, below] = quarter(from, whole, q);
            const std::size_t child = next.cells_[to].child[q];
            if (child != 0) hand_over(next, child, below, sum, factor);
            else next.cells_[to].sum[q] = sum * factor;
        }
    }

    /// Appends a node of `probability`, and all below it, for what the cell `from` holds.
    std::size_t divide(DirectionTree& result, std::ptrdiff_t from, const Sum& whole, double probability,
                       int depth) const {
        const std::size_t n = result.nodes_.size();
        result.nodes_.emplace_back();
        const double alike = whole.squares > 0 ? whole.found * whole.found / whole.squares : 0;
        const double belief = !(whole.found > 0) ? 0 : whole.base > 0 ? alike / (alike + trust) : 1;
        for (std::size_t q = 0; q < 4; ++q) {
            const auto [sum, below] = quarter(from, whole, q);
            double share = belief > 0 ? belief * (sum.found / whole.found) : 0;
            if (belief < 1) share += (1 - belief) * (whole.base > 0 ? sum.base / whole.base : 0.25);
            result.nodes_[n].share[q] = static_cast<float>(share);
            if (!(share * probability > largest_cell) || depth == DirectionTree::max_depth ||
                result.nodes_.size() >= DirectionTree::max_nodes)
                continue;
            const std::size_t child = divide(result, below, sum, share * probability, depth + 1);
            result.nodes_[n].child[q] = static_cast<std::uint16_t>(child);
        }
        return n;
    }

    std::vector<Cell> cells_;
};

}  // namespace lightswitch
