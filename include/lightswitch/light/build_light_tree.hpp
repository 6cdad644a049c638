#pragma once

// From the bounds of lights to a tree.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/light/light.hpp>
#include <lightswitch/light/light_tree.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace lightswitch {

/// A light that a `LightTree` is to choose.
struct LightToChoose {
    LightBounds bounds;
    std::uint32_t number;  ///< below 2^31
    std::uint32_t steps;   ///< how many numbers would choose it without the tree, at least 1
};

/// Builds a `LightTree`: splits the lights in two, from the top, where the sum over both halves of intensity, extent
/// and spread of directions is least among 16 bins along each axis (the surface area orientation heuristic of Conty
/// Estevez and Kulla 2018, with a simpler measure of directions), and takes two levels of that as one. Subtrees are
/// built by several threads; the result is the same for any number of them.
class LightTreeBuilder {
public:
    /// The numbers of `lights` are all below `count`; together their steps are at most 2^24.
    static LightTree build(std::vector<LightToChoose> lights, std::size_t count) {
        LightTree tree;
        tree.keys_.assign(count, LightTree::none);
        if (lights.empty()) return tree;
        LightTreeBuilder builder;
        double most = 0;
        for (const auto& light : lights) most = std::max(most, light.bounds.intensity);
        for (const auto& light : lights) {
            tree.steps_ += light.steps;
            Item item{light.bounds, light.number, std::max(light.steps / reserve, 1u), 0};
            item.intensity = most > 0 ? static_cast<float>(light.bounds.intensity / most) : 0;
            builder.items_.push_back(item);
        }
        builder.build_all(tree.nodes_);
        std::uint32_t& sum = tree.reserved_;
        for (const Item& item : builder.items_) {
            tree.keys_[item.number] = sum;
            sum += item.reserved;
        }
        return tree;
    }

private:
    using Node = LightTree::Node;

    /// One in so many steps of each light are reserved for it.
    static constexpr std::uint32_t reserve = 8;

    struct Item {
        LightBounds bounds;
        std::uint32_t number, reserved;
        float intensity;
    };
    using Items = std::span<Item>;

    struct Box {
        Vec3 lower{infinity}, upper{-infinity};
        void include(const Vec3& center, float radius) {
            lower = glm::min(lower, center - radius);
            upper = glm::max(upper, center + radius);
        }
        void include(const Box& other) {
            lower = glm::min(lower, other.lower);
            upper = glm::max(upper, other.upper);
        }
        float diagonal2() const { return length_squared(upper - lower); }
    };

    /// What the measure of a half is made of.
    struct Bin {
        Box box;
        float intensity = 0;
        Vec3 directions{0};  // sum of axes, by intensity and how narrow the light's own cone is
        std::size_t count = 0;

        void include(const Item& item) {
            box.include(item.bounds.center, item.bounds.radius);
            intensity += item.intensity;
            directions += item.intensity * (0.5f + 0.5f * item.bounds.cos_normals) * item.bounds.axis;
            ++count;
        }
        void include(const Bin& other) {
            box.include(other.box);
            intensity += other.intensity;
            directions += other.directions;
            count += other.count;
        }
        /// Directions count between 1, all the same, and 4, all there are.
        float cost(float least_extent2) const {
            const float together =
                intensity > 0 ? std::min(std::sqrt(length_squared(directions)) / intensity, 1.0f) : 0;
            return intensity * (box.diagonal2() + least_extent2) * (4 - 3 * together);
        }
    };

    void build_all(std::vector<Node>& nodes) {
        // The upper part is built here, and what is left of it by several threads, each part into its own list.
        constexpr std::size_t small = 4096;
        std::vector<Part> parts;
        top(items_, nodes, small, parts);
        const auto build_part = [&](std::size_t i) { subtree(parts[i].items, parts[i].nodes); };
        if (parts.size() > 1) TbbExecutor().for_each(parts.size(), build_part);
        else SerialExecutor().for_each(parts.size(), build_part);
        for (Part& part : parts) {
            const auto first = static_cast<std::uint32_t>(nodes.size());
            for (Node& node : part.nodes) {
                for (std::uint32_t& child : node.child)
                    if (!(child & LightTree::leaf)) child += first;
                nodes.push_back(node);
            }
            if (part.parent != none) nodes[part.parent].child[part.slot] = first;
        }
    }

    static constexpr std::uint32_t none = LightTree::none;

    struct Part {
        Items items;
        std::uint32_t parent;
        std::size_t slot;
        std::vector<Node> nodes;
    };

    void top(Items items, std::vector<Node>& nodes, std::size_t small, std::vector<Part>& parts,
             std::uint32_t parent = none, std::size_t slot = 0) {
        if (items.size() <= small) {
            parts.push_back({items, parent, slot, {}});
            return;
        }
        const auto number = add_node(nodes);
        if (parent != none) nodes[parent].child[slot] = number;
        std::size_t i = 0;
        for (const Items& part : quarters(items)) {
            if (!part.empty()) {
                set(nodes[number], i, part);
                if (part.size() > 1) top(part, nodes, small, parts, number, i);
                ++i;
            }
        }
    }

    static std::uint32_t add_node(std::vector<Node>& nodes) {
        nodes.emplace_back();
        nodes.back().child.fill(LightTree::leaf);
        return static_cast<std::uint32_t>(nodes.size() - 1);
    }

    static std::uint32_t subtree(Items items, std::vector<Node>& nodes) {
        const auto number = add_node(nodes);
        std::size_t i = 0;
        for (const Items& part : quarters(items)) {
            if (part.empty()) continue;
            set(nodes[number], i, part);
            if (part.size() > 1) {
                const std::uint32_t child = subtree(part, nodes);
                nodes[number].child[i] = child;
            }
            ++i;
        }
        return number;
    }

    /// Bounds of a child.
    static void set(Node& node, std::size_t i, Items items) {
        Vec3 center(0), directions(0);
        float intensity = 0;
        std::uint32_t reserved = 0;
        for (const Item& item : items) {
            intensity += item.intensity;
            center += item.intensity * item.bounds.center;
            directions += item.intensity * item.bounds.axis;
            reserved += item.reserved;
        }
        if (items.size() == 1) {
            center = items[0].bounds.center;
            directions = items[0].bounds.axis;
            node.child[i] = items[0].number | LightTree::leaf;
        } else if (intensity > 0) {
            center /= intensity;
        }
        const float length2 = length_squared(directions);
        const bool directed = length2 > 1e-12f * square(intensity);
        const Vec3 axis = directed ? directions * (1 / std::sqrt(length2)) : Vec3(0, 0, 1);
        float radius = 0, cos_normals = directed ? 1.0f : -1.0f, cos_emission = 1;
        for (const Item& item : items) {
            const LightBounds& b = item.bounds;
            radius = std::max(radius, std::sqrt(length_squared(b.center - center)) + b.radius);
            const float cosine = std::clamp(dot(b.axis, axis), -1.0f, 1.0f);
            const float own = std::clamp(b.cos_normals, -1.0f, 1.0f);
            // The cosine of the sum of both angles, unless that is more than pi.
            const float sum = cosine > -own ? cosine * own - safe_sqrt((1 - cosine * cosine) * (1 - own * own)) : -1;
            cos_normals = std::min(cos_normals, sum);
            cos_emission = std::min(cos_emission, b.cos_emission);
        }
        constexpr float rounding = 1e-6f;
        node.x[i] = center.x, node.y[i] = center.y, node.z[i] = center.z;
        node.radius[i] = radius * (1 + rounding);
        const float cosine = std::max(cos_normals - rounding, 0.0f);
        node.axis_x[i] = cosine * axis.x, node.axis_y[i] = cosine * axis.y, node.axis_z[i] = cosine * axis.z;
        node.spread[i] = safe_sqrt(1 - square(cosine));
        node.cos_emission[i] = std::max(cos_emission - rounding, 0.0f);
        node.intensity[i] = intensity;
        for (std::size_t j = i; j < 4; ++j) node.reserved[j] += static_cast<std::int32_t>(reserved);
    }

    static std::array<Items, 4> quarters(Items items) {
        const auto [a, b] = halves(items);
        const auto [a0, a1] = halves(a);
        const auto [b0, b1] = halves(b);
        return {a0, a1, b0, b1};
    }

    static std::pair<Items, Items> halves(Items items) {
        const std::size_t middle = split(items);
        return {items.first(middle), items.subspan(middle)};
    }

    /// Sorts the lights by the half that they belong to; returns where the second begins.
    static std::size_t split(Items items) {
        if (items.size() < 3) return (items.size() + 1) / 2;
        Box centers;
        for (const Item& item : items) centers.include(item.bounds.center, 0);
        const Vec3 extent = centers.upper - centers.lower;
        const float longest = max_component(extent);
        if (!(longest > 0)) return items.size() / 2;
        constexpr std::size_t bins = 16;
        float best = infinity;
        int best_axis = -1;
        std::size_t best_bin = 0;
        const auto bin_of = [&](const Item& item, int axis) {
            const float place = (item.bounds.center[axis] - centers.lower[axis]) / extent[axis];
            return std::min(static_cast<std::size_t>(place * float(bins)), bins - 1);
        };
        for (int axis = 0; axis < 3; ++axis) {
            if (!(extent[axis] > 1e-3f * longest)) continue;
            std::array<Bin, bins> bin{};
            for (const Item& item : items) bin[bin_of(item, axis)].include(item);
            std::array<Bin, bins> above{};
            above[bins - 1] = bin[bins - 1];
            for (std::size_t i = bins - 1; i-- > 0;) above[i] = bin[i], above[i].include(above[i + 1]);
            Bin below;
            const float thin = longest / extent[axis], least = square(1e-3f * longest);
            for (std::size_t i = 0; i + 1 < bins; ++i) {
                below.include(bin[i]);
                if (below.count == 0 || above[i + 1].count == 0) continue;
                const float cost = thin * (below.cost(least) + above[i + 1].cost(least));
                if (best_axis < 0 || cost < best) best = cost, best_axis = axis, best_bin = i;
            }
        }
        if (best_axis < 0) return items.size() / 2;
        const auto middle = std::partition(items.begin(), items.end(),
                                           [&](const Item& item) { return bin_of(item, best_axis) <= best_bin; });
        return static_cast<std::size_t>(middle - items.begin());
    }

    std::vector<Item> items_;
};

}  // namespace lightswitch
