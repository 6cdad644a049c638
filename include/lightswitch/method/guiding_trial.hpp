#pragma once

// Whether guiding pays in a scene: pairs of samples of the same pixels with and without it.

#include <lightswitch/core/floating_point.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace lightswitch {

/// Variance times rays of two ways to make samples, from pairs of samples of a pixel made by one of them.
class GuidingTrial {
public:
    /// A pair whose samples differ by `difference`, and took `rays`.
    void add(bool guided, double difference, std::uint64_t rays) {
        Side& side = sides_[guided];
        side.squares += difference * difference;
        side.pairs += 1;
        side.rays += double(rays);
    }
    /// What was added counts half from now on: guides become better.
    void age() {
        for (Side& side : sides_) side = {side.squares / 2, side.pairs / 2, side.rays / 2};
    }

    /// Whether guided samples are worth what they cost, or will be soon; nothing while too little is known. What was
    /// found before is given up only for a clear difference, as all this is noisy.
    std::optional<bool> pays(bool before) const {
        if (sides_[0].pairs < least_pairs || sides_[1].pairs < least_pairs) return {};
        return inefficiency(sides_[0]) > (before ? stay : begin) * inefficiency(sides_[1]);
    }

private:
    static constexpr double least_pairs = 4096;
    /// A guided ray costs half as much again as another, but guides that begin become much better: on a scene where
    /// they divide the variance by ten in the end it is 1.2 to 1.6 at first, and 0.6 to 1.1 where they are no use.
    static constexpr double begin = 1.1, stay = 0.9;

    struct Side {
        double squares = 0, pairs = 0, rays = 0;
    };

    /// Times a constant.
    static double inefficiency(const Side& side) { return (side.squares / side.pairs) * (side.rays / side.pairs); }

    std::array<Side, 2> sides_{};  // without and with
};

}  // namespace lightswitch
