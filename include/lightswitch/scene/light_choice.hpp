#pragma once

// Which light of a scene is chosen, and how often.

#include <lightswitch/core/table.hpp>
#include <lightswitch/geometry/surface_point.hpp>
#include <lightswitch/light/light_tree.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lightswitch::detail {

/// The choice of a light by its number. Paths that start at a light choose it from a table. So do surface points where
/// there are few lights; of many, those with bounds are chosen by a tree, which gets as much of the probability as they
/// have in the table, and the others as by the table.
class LightChoice {
public:
    struct Chosen {
        std::size_t number;
        float probability;
    };

    LightChoice() = default;
    explicit LightChoice(DiscreteDistribution table) : table_(std::move(table)) {}
    LightChoice(DiscreteDistribution table, LightTree tree) : LightChoice(std::move(table)) {
        tree_ = std::move(tree);
        std::uint32_t steps = 0;
        for (std::uint32_t number = 0; number < table_.size(); ++number) {
            if (tree_.holds(number) || table_.probability(number) == 0) continue;
            steps += static_cast<std::uint32_t>(table_.probability(number) * all_steps);
            rest_.push_back({steps, number});
        }
    }

    /// Whether there is no light that could be chosen.
    bool empty() const { return table_.empty(); }

    /// Where a path is to start: the light for `u` in [0, 1), and the probability with which a light is chosen so.
    std::size_t start(float u) const { return table_.sample(u); }
    float start_probability(std::size_t number) const { return table_.probability(number); }

    /// At a surface point.
    [[gnu::always_inline]] Chosen at(const SurfacePoint& from, float u) const {
        if (!tree_.empty()) [[unlikely]]
            return at_by_tree(from.position, from.lit_normal(), u);
        const std::size_t number = table_.sample(u);
        return {number, table_.probability(number)};
    }
    /// The probability of a light at a point of that position and `lit_normal()`.
    [[gnu::always_inline]] float probability_at(const Vec3& position, const Vec3& normal, std::size_t number) const {
        if (!tree_.empty()) [[unlikely]]
            return by_tree(position, normal, number);
        return table_.probability(number);
    }
    /// What has been chosen at a point has so many times the probability of starting a path at that light.
    [[gnu::always_inline]] float over_start(const Chosen& chosen) const {
        return tree_.empty() ? 1 : chosen.probability / table_.probability(chosen.number);
    }
    /// The same for any light and a point that sees it.
    [[gnu::always_inline]] float over_start(const SurfacePoint& at, std::size_t number) const {
        if (!tree_.empty()) [[unlikely]]
            return by_tree(at.position, at.lit_normal(), number) / table_.probability(number);
        return 1;
    }

private:
    static constexpr float step = 0x1p-24f, all_steps = 0x1p24f;  // as in DiscreteDistribution

    struct Rest {
        std::uint32_t until;  // its numbers and those before end there
        std::uint32_t number;
    };

    [[gnu::noinline]] Chosen at_by_tree(const Vec3& position, const Vec3& normal, float u) const {
        const auto choice = static_cast<std::uint32_t>(u * all_steps);
        const std::uint32_t of_rest = rest_.empty() ? 0 : rest_.back().until;
        if (choice < of_rest) {
            const auto found = std::upper_bound(rest_.begin(), rest_.end(), choice,
                                                [](std::uint32_t c, const Rest& rest) { return c < rest.until; });
            return {found->number, table_.probability(found->number)};
        }
        const LightTree::Choice chosen = tree_.choose(position, normal, choice - of_rest);
        return {chosen.light, static_cast<float>(chosen.steps) * step};
    }
    [[gnu::noinline]] float by_tree(const Vec3& position, const Vec3& normal, std::size_t number) const {
        if (!tree_.holds(number)) return table_.probability(number);
        return static_cast<float>(tree_.steps_of(number, position, normal)) * step;
    }

    DiscreteDistribution table_;
    LightTree tree_;
    std::vector<Rest> rest_;  // lights that the tree does not hold, where there is one
};

}  // namespace lightswitch::detail
