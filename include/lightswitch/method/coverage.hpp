#pragma once

#include <lightswitch/core/math.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightswitch {

/// What independent paths found, and how much of it rests on a few bright ones: by parts of the image and path lengths,
/// since what is rare in one place does not show in the whole.
struct Coverage {
    static constexpr int side = 4, lengths = 4;  ///< lengths 2, 3, 4, and all longer ones
    static constexpr double enough = 16;         ///< paths by which a part is known to a quarter

    double light = 0;  ///< of all contributions
    double left = 0;   ///< of it, what was too bright for the path that found it
    struct Part {
        double left = 0, squares = 0;

        void keep(auto& archive) { archive(left, squares); }
    };
    std::array<Part, std::size_t(side* side* lengths)> parts{};

    /// A contribution `brightness` of a path of `length` segments at `place` in [0, 1)^2 of the film (others count to
    /// its border), of which `too_much` was left.
    void add(const Vec2& place, int length, double brightness, double too_much) {
        light += brightness;
        if (!(too_much > 0)) return;
        left += too_much;
        const auto along = [](float x) { return std::clamp(static_cast<int>(x * float(side)), 0, side - 1); };
        const int cell = (along(place.y) * side + along(place.x)) * lengths + std::clamp(length - 2, 0, lengths - 1);
        Part& part = parts[static_cast<std::size_t>(cell)];
        part.left += too_much;
        part.squares += too_much * too_much;
    }

    void operator+=(const Coverage& other) {
        light += other.light;
        left += other.left;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].left += other.parts[i].left;
            parts[i].squares += other.parts[i].squares;
        }
    }

    /// How many equally bright paths would tell as much of what was left, in (sum)^2 / (sum of squares); 0 for none.
    double paths_left() const {
        double squares = 0;
        for (const Part& part : parts) squares += part.squares;
        return squares > 0 ? left * left / squares : 0;
    }

    /// The share of all light that does not rest on fewer than `enough` such paths in its part; 1 before any is found.
    /// What no path has found yet is not in it.
    double covered() const {
        double few = 0;
        for (const Part& part : parts)
            if (part.left * part.left < enough * part.squares) few += part.left;
        return light > 0 ? 1 - few / light : 1;
    }

    void keep(auto& archive) {
        archive(light, left);
        for (Part& part : parts) archive(part);
    }
};

}  // namespace lightswitch
