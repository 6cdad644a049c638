#pragma once

// Where light comes from, at every place of a scene: learnt from paths, with how far that is to be believed.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/method/direction_tree.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace lightswitch {

/// What a path tells of the light at one of its vertices. Radiance is luminance.
struct GuidingRecord {
    std::uint32_t region = 0;        ///< of the vertex
    bool smooth = false;             ///< whether the path went on, in a direction that has a density
    Vec2 place{0};                   ///< of that direction in the square of a `DirectionTree`
    float incident = 0;              ///< radiance from there times the cosine; less where a light was sampled as well
    float scattered = 0;             ///< what it adds to the radiance of the pixel, over the density
    SolidAnglePdf pdf, bsdf, guide;  ///< of the direction: with which it was chosen, and of the two ways to choose
};

/// What directions are chosen by at a place: a mixture of the BSDF and of what was learnt there.
struct GuidingMixture {
    const DirectionTree* directions = nullptr;  ///< null where nothing was learnt
    float bsdf_share = 1;                       ///< the probability of choosing by the BSDF, above 0

    /// Whether the number `u` chooses the direction by the guide. Otherwise `rest(u)` is uniform in [0, 1).
    bool chooses_guide(float u) const { return !(u < bsdf_share); }
    float rest(float u) const { return bsdf_share < 1 ? std::min(u / bsdf_share, 1 - unit_roundoff) : u; }

    /// A direction chosen by the guide, a unit vector.
    Vec3 sample(const Vec2& u) const { return octahedron::to_direction(directions->sample(u)); }
    /// Its density; 0 where nothing was learnt.
    SolidAnglePdf guide(const Vec3& w) const {
        return directions ? octahedron::to_solid_angle(directions->density(octahedron::to_square(w)), w)
                          : SolidAnglePdf{};
    }
    /// The density of a direction of which the BSDF and the guide have these densities.
    SolidAnglePdf density(SolidAnglePdf bsdf, SolidAnglePdf guide) const {
        return bsdf * bsdf_share + guide * (1 - bsdf_share);
    }
};

/// Regions of space, each with a density over the directions: a binary tree over the cube from -1 to 1 for each of the
/// six ways that a surface can face (Müller, Gross and Novák, "Practical Path Guiding for Efficient Light-Transport
/// Simulation", 2017, section 3.1). Reading is safe from several threads at once; all else is for one.
class GuidingField {
public:
    static constexpr std::size_t max_regions = 4096;

    GuidingField() : nodes_(ways), regions_(ways), lessons_(ways) {
        for (std::uint32_t i = 0; i < ways; ++i) nodes_[i].region = i;
    }

    /// The region of a position in render space, on a surface that faces along `normal`.
    [[gnu::always_inline]] std::uint32_t find(const Vec3& position, const Vec3& normal) const {
        std::array<std::uint32_t, 3> at;
        for (int axis = 0; axis < 3; ++axis) {
            const float along = std::clamp(position[axis] * 0.5f + 0.5f, 0.0f, 1 - unit_roundoff);
            at[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(along * 0x1p24f) << 8;
        }
        std::uint32_t n = way_of(normal);
        for (std::size_t axis = 0; nodes_[n].child != 0; axis = axis == 2 ? 0 : axis + 1) {
            n = nodes_[n].child + (at[axis] >> 31);
            at[axis] <<= 1;
        }
        return nodes_[n].region;
    }

    /// How directions are chosen in a region.
    GuidingMixture mixture(std::uint32_t region) const {
        const Region& r = regions_[region];
        return {r.learnt ? &r.directions : nullptr, r.bsdf_share};
    }

    /// Whether anything was learnt.
    bool learnt() const { return learnt_; }

    /// Takes in records, those of a region in their order whatever the threads.
    void add(std::span<const GuidingRecord> records, const Executor auto& executor) {
        std::vector<std::uint32_t> begin(regions_.size() + 1), order(records.size());
        for (const GuidingRecord& record : records) ++begin[record.region + 1];
        for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
        std::vector<std::uint32_t> next = begin;
        for (std::uint32_t i = 0; i < records.size(); ++i) order[next[records[i].region]++] = i;
        for_each_region(executor, [&](std::size_t r) {
            for (std::uint32_t i = begin[r]; i < begin[r + 1]; ++i) add(regions_[r], lessons_[r], records[order[i]]);
        });
    }

    /// Learns from what was added, of which that since the last time counts most, and divides regions where that was
    /// much.
    void learn(const Executor auto& executor) {
        for_each_region(executor, [&](std::size_t r) { learn(regions_[r], lessons_[r]); });
        const std::size_t before = nodes_.size();
        for (std::size_t n = 0; n < before; ++n)
            if (nodes_[n].child == 0) divide(static_cast<std::uint32_t>(n), 3);
        learnt_ = std::any_of(regions_.begin(), regions_.end(), [](const Region& r) { return r.learnt; });
        for (Lessons& lessons : lessons_) {
            lessons.visits = 0;
            lessons.squares = {};
        }
    }

    std::size_t size() const { return regions_.size(); }
    std::size_t nodes() const {
        std::size_t sum = 0;
        for (const Region& r : regions_) sum += r.directions.nodes();
        return sum;
    }
    std::size_t bytes() const {
        std::size_t sum =
            nodes_.size() * sizeof(Node) + regions_.size() * sizeof(Region) + lessons_.size() * sizeof(Lessons);
        for (const Region& r : regions_) sum += r.directions.bytes();
        for (const Lessons& l : lessons_) sum += l.sums.bytes();
        return sum;
    }
    /// The mean over the regions of the guide's share.
    double guided_share() const {
        double sum = 0;
        for (const Region& r : regions_) sum += 1 - double(r.bsdf_share);
        return sum / double(regions_.size());
    }

private:
    static constexpr std::uint32_t ways = 6;
    static constexpr double visits_per_region = 4000;  // more divide it
    static constexpr double least_visits = 256;        // fewer teach nothing
    static constexpr double ageing = 0.5;
    static constexpr int max_depth = 45;
    /// Of the BSDF: those that are tried. The last is the floor, the third what a region begins with.
    static constexpr std::array<float, 4> shares{1, 0.75f, 0.5f, 0.25f};

    struct Node {
        std::uint32_t child = 0;  // the first of two
        std::uint32_t region = 0;
    };
    struct Region {
        DirectionTree directions;
        float bsdf_share = 1;
        bool learnt = false;
    };
    struct Lessons {
        DirectionSums sums;
        double visits = 0;
        std::array<double, shares.size()> squares{};  // second moments of what is scattered, with each of the shares
        int depth = 0;
    };

    static std::uint32_t way_of(const Vec3& normal) {
        const float x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
        const int axis = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        return static_cast<std::uint32_t>(2 * axis + (normal[axis] < 0));
    }

    void for_each_region(const Executor auto& executor, const auto& work) {
        constexpr std::size_t per_unit = 16;
        executor.for_each((regions_.size() + per_unit - 1) / per_unit, [&](std::size_t unit) {
            const std::size_t end = std::min((unit + 1) * per_unit, regions_.size());
            for (std::size_t r = unit * per_unit; r < end; ++r) work(r);
        });
    }

    static void add(const Region& region, Lessons& lessons, const GuidingRecord& record) {
        ++lessons.visits;
        if (!record.smooth || !is_positive(record.pdf)) return;
        lessons.sums.add(record.place, double(record.incident) / record.pdf, record.bsdf / record.pdf);
        if (!region.learnt || !(record.scattered > 0)) return;
        // What the variance would be had the direction been chosen by another mixture.
        const double square = double(record.scattered) * double(record.scattered);
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const GuidingMixture other{&region.directions, shares[i]};
            lessons.squares[i] += square * (record.pdf / other.density(record.bsdf, record.guide));
        }
    }

    static void learn(Region& region, Lessons& lessons) {
        if (lessons.visits < least_visits) return;
        const auto best = std::min_element(lessons.squares.begin(), lessons.squares.end()) - lessons.squares.begin();
        region.bsdf_share = region.learnt ? shares[static_cast<std::size_t>(best)] : shares[2];
        region.directions = lessons.sums.tree();
        region.learnt = true;
        lessons.sums.refit(region.directions, ageing);
    }

    /// Cuts a leaf in the middle while there were more visits than a region should have, `levels` times at most: its
    /// parts begin with what the whole has learnt.
    void divide(std::uint32_t n, int levels) {
        const std::uint32_t r = nodes_[n].region;
        Lessons& lessons = lessons_[r];
        if (levels == 0 || !(lessons.visits > visits_per_region) || regions_.size() >= max_regions ||
            lessons.depth >= max_depth)
            return;
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        const auto other = static_cast<std::uint32_t>(regions_.size());
        nodes_[n].child = child;
        lessons.visits /= 2;
        lessons.sums.refit(regions_[r].directions, 0.5);
        ++lessons.depth;
        regions_.push_back(Region(regions_[r]));
        lessons_.push_back(Lessons(lessons_[r]));
        nodes_.push_back({.region = r});
        nodes_.push_back({.region = other});
        divide(child, levels - 1);
        divide(child + 1, levels - 1);
    }

    std::vector<Node> nodes_;  // the first six are the roots
    std::vector<Region> regions_;
    std::vector<Lessons> lessons_;  // of each region
    bool learnt_ = false;
};

}  // namespace lightswitch
