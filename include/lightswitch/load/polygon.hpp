#pragma once

// Polygons with any number of corners, cut into triangles.

#include <lightswitch/scene/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <span>

namespace lightswitch::detail {

/// Cuts polygons into triangles that wind as they do. One object serves many polygons and keeps its memory.
class PolygonCutter {
public:
    /// Appends the triangles of a polygon to `mesh`, given at least 3 indices into its positions.
    ///
    /// They are the fan around the first corner where that covers the polygon, as it does when it is convex. Otherwise
    /// ears are clipped off (Meisters, "Polygons have ears", 1975) in the plane of Newell's normal. Corners may repeat,
    /// lie on a line, and touch edges, so a hole may be joined to the outline by an edge used twice.
    ///
    /// Returns false, after appending the fan, when the polygon crosses itself or has no area.
    bool cut(std::span<const std::uint32_t> corners, Mesh& mesh) {
        if (corners.size() == 3 || halves_agree(corners, mesh)) return fan(corners, mesh), true;
        const bool has_area = project(corners, mesh);
        if (has_area && fan_covers()) return fan(corners, mesh), true;
        if (has_area && !crosses_itself() && clip_ears(corners, mesh)) return true;
        return fan(corners, mesh), false;
    }

private:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    static void fan(std::span<const std::uint32_t> corners, Mesh& mesh) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }

    /// Whether the two triangles of a quadrilateral's fan face one way, by more than rounding errors. Spares most
    /// quadrilaterals all that follows.
    static bool halves_agree(std::span<const std::uint32_t> corners, const Mesh& mesh) {
        if (corners.size() != 4) return false;
        const auto arm = [&](std::size_t i) { return mesh.positions[corners[i]] - mesh.positions[corners[0]]; };
        const DVec3 diagonal = arm(2);
        const double size = glm::dot(diagonal, diagonal);
        return glm::dot(glm::cross(arm(1), diagonal), glm::cross(diagonal, arm(3))) > 1e-20 * size * size;
    }

    static double cross(const DVec2& a, const DVec2& b) { return a.x * b.y - a.y * b.x; }

    std::size_t after(std::size_t corner) const { return corner + 1 < points_.size() ? corner + 1 : 0; }

    /// Fills `points_`: the first corner is the origin, the others are at most 2 away from it, and the polygon runs
    /// counter-clockwise. False when there is no area, and so no plane.
    bool project(std::span<const std::uint32_t> corners, const Mesh& mesh) {
        const auto arm = [&](std::size_t i) { return mesh.positions[corners[i]] - mesh.positions[corners[0]]; };
        double extent = 0;
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const DVec3 size = glm::abs(arm(i));
            extent = std::max({extent, size.x, size.y, size.z});
        }
        if (!(extent > 0)) return false;
        DVec3 normal(0);
        for (std::size_t i = 2; i < corners.size(); ++i) normal += glm::cross(arm(i - 1) / extent, arm(i) / extent);
        const double twice_area = glm::length(normal);
        if (!(twice_area > 1e-14)) return false;
        normal /= twice_area;

        // Across the axis that is nearest to the plane: in a plane of the axes no coordinate is rounded.
        const DVec3 size = glm::abs(normal);
        DVec3 axis(0);
        axis[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
        const DVec3 u = glm::normalize(glm::cross(axis, normal)), v = glm::cross(normal, u);
        points_.clear();
        for (std::size_t i = 0; i < corners.size(); ++i)
            points_.emplace_back(glm::dot(arm(i) / extent, u), glm::dot(arm(i) / extent, v));
        twice_area_ = twice_area;
        return true;
    }

    /// Whether the fan's triangles lie side by side: none is turned over, and they go around the first corner at most
    /// once. One turned over by the digits of a file on a line of corners does not count.
    bool fan_covers() const {
        double turned_over = 0, angle = 0;
        DVec2 last(0);
        for (const DVec2& p : points_) {
            if (p == DVec2(0)) continue;  // the first corner again
            const double twice = cross(last, p);
            turned_over -= std::min(twice, 0.0);
            angle += std::abs(std::atan2(twice, glm::dot(last, p)));
            last = p;
        }
        return turned_over <= 1e-7 * twice_area_ && angle < 6.2832;
    }

    /// Above 0 when `c` is to the left of the line from `a` to `b`; 0 when it is on it, but for rounding errors.
    double side(std::size_t a, std::size_t b, std::size_t c) const {
        const DVec2 u = points_[b] - points_[a], v = points_[c] - points_[a];
        const double twice = cross(u, v);
        const double error = 1e-14 * (std::abs(u.x) + std::abs(u.y) + std::abs(v.x) + std::abs(v.y));
        return std::abs(twice) <= error ? 0 : twice;
    }

    /// Whether two edges cross in a point inside both.
    bool cross_inside(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
        const auto apart = [](double s, double t) { return (s < 0 && t > 0) || (s > 0 && t < 0); };
        return apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b));
    }

    /// Sweeps along x, then y, and compares each edge with those next to it above and below, when it comes and when
    /// what was between them goes (Shamos and Hoey, "Geometric intersection problems", 1976).
    bool crosses_itself() const {
        const auto precedes = [&](std::size_t a, std::size_t b) {
            const DVec2 &p = points_[a], &q = points_[b];
            return p.x != q.x ? p.x < q.x : p.y < q.y;
        };
        const auto start = [&](std::size_t edge) { return precedes(after(edge), edge) ? after(edge) : edge; };
        const auto end = [&](std::size_t edge) { return precedes(after(edge), edge) ? edge : after(edge); };
        const auto height = [&](std::size_t edge, std::size_t over) {
            const double at_start = side(start(over), end(over), start(edge));
            return at_start != 0 ? at_start : side(start(over), end(over), end(edge));
        };
        const auto is_below = [&](std::size_t e, std::size_t f) {
            const double gap = precedes(start(f), start(e)) ? -height(e, f) : height(f, e);
            return gap != 0 ? gap > 0 : e < f;
        };
        const auto cross_each_other = [&](std::size_t e, std::size_t f) {
            return cross_inside(start(e), end(e), start(f), end(f));
        };

        struct Event {
            std::size_t corner, edge;
            bool starts;
        };
        std::vector<Event> events;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (points_[i] == points_[after(i)]) continue;
            events.push_back({start(i), i, true});
            events.push_back({end(i), i, false});
        }
        std::sort(events.begin(), events.end(), [&](const Event& a, const Event& b) {
            if (precedes(a.corner, b.corner) || precedes(b.corner, a.corner)) return precedes(a.corner, b.corner);
            return a.starts < b.starts;
        });
        std::set<std::size_t, decltype(is_below)> met(is_below);
        std::vector<decltype(met.begin())> places(points_.size());
        for (const Event& event : events) {
            auto& place = places[event.edge];
            if (event.starts) place = met.insert(event.edge).first;
            const auto next = std::next(place);
            if (place != met.begin()) {
                const std::size_t previous = *std::prev(place);
                if (event.starts ? cross_each_other(previous, event.edge)
                                 : next != met.end() && cross_each_other(previous, *next))
                    return true;
            }
            if (event.starts && next != met.end() && cross_each_other(event.edge, *next)) return true;
            if (!event.starts) met.erase(place);
        }
        return false;
    }

    /// Appends one triangle per ear. Appends nothing and returns false when there is no ear left too early, which
    /// happens only where the polygon goes around something twice or backwards.
    ///
    /// A corner is looked at once, and again whenever a neighbour is clipped: nothing else can make an ear of it.
    bool clip_ears(std::span<const std::uint32_t> corners, Mesh& mesh) {
        const std::size_t count = corners.size(), first_triangle = mesh.triangles.size();
        links_.resize(count);
        queue_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            links_[i] = {i == 0 ? count - 1 : i - 1, after(i), i};
            queue_[i] = i;
        }
        tree_ = queue_;
        left_.resize(count);
        plant(0, count, 0);
        const auto look_later = [&](std::size_t corner) {
            links_[corner].place = queue_.size();
            queue_.push_back(corner);
        };
        double rest = twice_area_;
        for (std::size_t place = 0; place < queue_.size(); ++place) {
            const std::size_t b = queue_[place], a = links_[b].before, c = links_[b].after;
            if (links_[b].place != place || a == c) continue;
            const double twice = side(a, b, c);
            // A repeated corner, or a way there and back: nothing to cover.
            const bool spike = twice == 0 && glm::dot(points_[b] - points_[a], points_[c] - points_[b]) <= 0;
            if (!spike && !(twice > 0 && is_free({a, b, c}, 0, count, 0, {}))) continue;
            if (!spike) {
                mesh.triangles.push_back({corners[a], corners[b], corners[c]});
                rest -= twice;
            }
            links_[a].after = c;
            links_[c].before = a;
            remove(b);
            // Both wait for the next round, or the ears would all share a corner and be long and thin.
            look_later(a);
            look_later(c);
        }
        // What remains may be corners on a line.
        if (std::abs(rest) <= 1e-9 * twice_area_) return true;
        mesh.triangles.resize(first_triangle);
        return false;
    }

    /// Orders the corners from `begin` to `end` as a kd-tree: the corner in the middle parts those before it from those
    /// after it, along x and y in turn.
    void plant(std::size_t begin, std::size_t end, int axis) {
        if (begin == end) return;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return tree_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](std::size_t a, std::size_t b) { return points_[a][axis] < points_[b][axis]; });
        links_[tree_[middle]].leaf = middle;
        left_[middle] = end - begin;
        plant(begin, middle, 1 - axis);
        plant(middle + 1, end, 1 - axis);
    }

    void remove(std::size_t corner) {
        links_[corner].place = none;
        const std::size_t leaf = links_[corner].leaf;
        for (std::size_t begin = 0, end = tree_.size(); begin < end;) {
            const std::size_t middle = begin + (end - begin) / 2;
            --left_[middle];
            if (leaf == middle) return;
            (leaf < middle ? end : begin) = leaf < middle ? middle : middle + 1;
        }
    }

    struct Ear {
        std::size_t a, b, c;
    };
    struct Box {
        DVec2 lower{-2}, upper{2};
    };

    /// Whether no corner of a part of the tree, all of which lies in `box`, is in the way of clipping the ear.
    bool is_free(const Ear& ear, std::size_t begin, std::size_t end, int axis, const Box& box) const {
        if (begin == end) return true;
        const std::size_t middle = begin + (end - begin) / 2, corner = tree_[middle];
        if (left_[middle] == 0 || misses(ear, box)) return true;
        if (links_[corner].place != none && is_in_the_way(corner, ear)) return false;
        Box before = box, after = box;
        before.upper[axis] = after.lower[axis] = points_[corner][axis];
        return is_free(ear, begin, middle, 1 - axis, before) && is_free(ear, middle + 1, end, 1 - axis, after);
    }

    /// Whether an axis or an edge of the ear separates it from the box.
    bool misses(const Ear& ear, const Box& box) const {
        // Both margins are above the error that `side` allows for.
        const DVec2 &a = points_[ear.a], &b = points_[ear.b], &c = points_[ear.c];
        const DVec2 lower = glm::min(a, glm::min(b, c)) - 1e-12, upper = glm::max(a, glm::max(b, c)) + 1e-12;
        if (box.upper.x < lower.x || box.upper.y < lower.y || box.lower.x > upper.x || box.lower.y > upper.y)
            return true;
        const DVec2 center = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
        const auto is_outside = [&](const DVec2& p, const DVec2& q) {
            const DVec2 edge = q - p;
            return cross(edge, center - p) + std::abs(edge.x) * half.y + std::abs(edge.y) * half.x < -1e-12;
        };
        return is_outside(a, b) || is_outside(b, c) || is_outside(c, a);
    }

    /// Whether corner `p` keeps the polygon from being cut from `c` to `a`.
    bool is_in_the_way(std::size_t p, const Ear& ear) const {
        const auto left_of = [&](std::size_t q) {
            return std::array{side(ear.a, ear.b, q), side(ear.b, ear.c, q), side(ear.c, ear.a, q)};
        };
        const auto [ab, bc, ca] = left_of(p);
        if (ab < 0 || bc < 0 || ca < 0) return false;
        if (ab > 0 && bc > 0) return true;
        // It touches the outline: from the outside, unless one of its edges goes into the ear.
        const std::array<bool, 3> inside{ab > 0, bc > 0, ca > 0};
        const auto goes_in = [&](std::size_t q) {
            const auto sides = left_of(q);
            return (inside[0] || sides[0] > 0) && (inside[1] || sides[1] > 0) && (inside[2] || sides[2] > 0);
        };
        return goes_in(links_[p].before) || goes_in(links_[p].after);
    }

    /// Neighbours in what is left of the polygon, where the corner stands in the queue (`none` once it is clipped), and
    /// where in the tree.
    struct Links {
        std::size_t before, after, place, leaf = 0;
    };

    std::vector<DVec2> points_;
    double twice_area_ = 0;
    std::vector<Links> links_;
    std::vector<std::size_t> queue_, tree_;
    std::vector<std::size_t> left_;  ///< by the place in the tree: corners not clipped, of the part that it divides
};

}  // namespace lightswitch::detail
