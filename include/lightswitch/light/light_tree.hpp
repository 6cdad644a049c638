#pragma once

// Choosing one of many lights by what it may bring to a point.

#include <lightswitch/core/math.hpp>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace lightswitch {

/// A choice among many lights by their importance at a point: a tree over their bounds, walked from the root by the
/// share of each child (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting",
/// 2018, without the splitting; four children to a node).
///
/// Probabilities are whole numbers of `steps`, and exact: the numbers [0, steps) are handed down the tree, and a
/// light's probability is how many of them get to it. Some are reserved for each light, whatever its importance, so
/// that none that can contribute is left out and a wrong bound costs a bounded amount of noise; at every node the
/// others are divided among the children by importance. Made by `LightTreeBuilder`. Immutable: safe to use from
/// several threads.
class LightTree {
public:
    struct Choice {
        std::uint32_t light;  ///< its number
        std::uint32_t steps;  ///< how many of the numbers choose it
    };

    bool empty() const { return nodes_.empty(); }
    /// How many numbers there are to choose by.
    std::uint32_t steps() const { return steps_; }
    std::size_t bytes() const { return nodes_.size() * sizeof(Node) + keys_.size() * sizeof(std::uint32_t); }

    /// The light that `step`, below `steps()`, chooses at `position`, where light matters that comes from the side of
    /// `normal` (unit, or 0 for all sides). Must not be empty.
    Choice choose(const Vec3& position, const Vec3& normal, std::uint32_t step) const {
        return walk(position, normal, step, false);
    }

    /// Whether the tree chooses the light of that number at all.
    bool holds(std::size_t light) const { return keys_[light] != none; }

    /// How many steps choose that light, which the tree must hold, at such a point.
    std::uint32_t steps_of(std::size_t light, const Vec3& position, const Vec3& normal) const {
        return walk(position, normal, keys_[light], true).steps;
    }

private:
    friend class LightTreeBuilder;

    using Four [[gnu::vector_size(16)]] = float;
    using FourBits [[gnu::vector_size(16)]] = std::int32_t;

    static constexpr std::uint32_t none = 0xffffffffu;
    static constexpr std::uint32_t leaf = 0x80000000u;  ///< flag of a child that is a light

    /// Four subtrees, fewer where there are not as many lights: the ones without reserved steps are not there.
    struct alignas(64) Node {
        Four x{}, y{}, z{}, radius{};       ///< a sphere around the lights
        Four axis_x{}, axis_y{}, axis_z{};  ///< times the cosine of that angle; 0 beyond a right angle
        Four spread{};        ///< of normals around the axis: the sine of their greatest angle; 1 beyond a right angle
        Four cos_emission{};  ///< as in `LightBounds`, at least 0
        Four intensity{};     ///< sum, in units of the greatest of one light
        FourBits reserved{};  ///< steps, each with those of the children before it
        std::array<std::uint32_t, 4> child{};  ///< number of a node, or of a light with the flag `leaf`
    };

    static Four sqrt(const Four& v) {
#if defined(__SSE2__)
        return _mm_sqrt_ps(v);
#else
        return Four{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
    }
    static Four to_float(const FourBits& v) { return __builtin_convertvector(v, Four); }
    static FourBits to_integer(const Four& v) { return __builtin_convertvector(v, FourBits); }
    static Four greatest(const Four& a, const Four& b) { return a > b ? a : b; }
    static Four least(const Four& a, const Four& b) { return a < b ? a : b; }

    /// A cosine that may be greater by `blur`: itself where it is large, and above 0 wherever it can be.
    static Four blurred(const Four& cosine, const Four& blur) { return greatest(cosine, (cosine + blur) * 0.5f); }

    /// What each child may bring to the point: intensity over the squared distance, times the cosines that are possible
    /// at either end.
    static Four importance(const Node& node, const Vec3& position, const Vec3& normal) {
        const Four zero{}, one = zero + 1.0f;
        const Four x = node.x - position.x, y = node.y - position.y, z = node.z - position.z;
        const Four distance2 = x * x + y * y + z * z + 1e-30f, radius2 = node.radius * node.radius;
        // Cosines at the centre, and how much more they may be elsewhere in the sphere.
        const Four near = one / sqrt(distance2 + radius2), blur = node.radius * near;
        const Four cos_axis = (node.axis_x * x + node.axis_y * y + node.axis_z * z) * -near;
        const Four off_axis = cos_axis + node.spread, cos_there = least(blurred(off_axis, blur), one);
        const FourBits shines = off_axis + 2.5f * blur > node.cos_emission;
        // For the mean of 1 / distance^2 over a ball of that radius, with more for a ball that the point is in or near:
        // there the nearest lights count most.
        const Four mean2 = greatest(distance2 - radius2 * (1.0f / 3), distance2 * 0.3f + radius2 * 0.2f);
        Four result = node.intensity * (shines ? greatest(cos_there, zero) : zero) / mean2;
        if (normal != Vec3(0)) {
            const Four cos_here = (normal.x * x + normal.y * y + normal.z * z) * near;
            result *= greatest(blurred(cos_here, blur), zero);
        }
        return result;
    }

    /// One function for choosing and for asking, so that both compute the very same: `target` is a number to choose by,
    /// or the key of a light: the sum of what is reserved for the lights before it.
    [[gnu::noinline]] Choice walk(const Vec3& position, const Vec3& normal, std::uint32_t target, bool by_key) const {
        auto rest = static_cast<std::int32_t>(target);
        auto free = static_cast<std::int32_t>(steps_ - reserved_);
        for (const Node* node = nodes_.data();;) {
            // Where the numbers of each child end: of those that are free, and of all that count here.
            std::array<std::int32_t, 5> given{}, end{};
            const FourBits until = free > 0 ? divide(*node, position, normal, free) : FourBits{};
            const FourBits ends = by_key ? node->reserved : node->reserved + until;
            std::memcpy(&given[1], &until, sizeof until);
            std::memcpy(&end[1], &ends, sizeof ends);
            std::size_t i = 0;
            while (i < 3 && rest >= end[i + 1]) ++i;
            rest -= end[i];
            free = given[i + 1] - given[i];
            const std::uint32_t child = node->child[i];
            if (child & leaf) {
                const std::int32_t reserved = node->reserved[i] - (i > 0 ? node->reserved[i - 1] : 0);
                return {child & ~leaf, static_cast<std::uint32_t>(reserved + free)};
            }
            node = &nodes_[child];
        }
    }

    /// Divides the free numbers among the children by importance: where those of each end.
    static FourBits divide(const Node& node, const Vec3& position, const Vec3& normal, std::int32_t free) {
        const Four share = importance(node, position, normal);
        // One after the other: so what brings nothing, or is not there, adds nothing to the last bit.
        const float two = share[0] + share[1], three = two + share[2], four = three + share[3];
        Four sums{share[0], two, three, four};
        if (!(four > 0 && four <= std::numeric_limits<float>::max())) sums = to_float(node.reserved);
        const Four parts = sums / sums[3] * static_cast<float>(free) + 0.5f;
        const FourBits until = to_integer(parts);
        return until < free ? until : FourBits{} + free;
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> keys_;  // by light number; `none` of lights that the tree does not hold
    std::uint32_t steps_ = 0, reserved_ = 0;
};

}  // namespace lightswitch
