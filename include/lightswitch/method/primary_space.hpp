#pragma once

// Points of the space of random numbers, and how a Markov chain walks through it.

#include <lightswitch/core/math.hpp>
#include <lightswitch/core/sampler.hpp>

#include <array>
#include <vector>

namespace lightswitch {

/// A point of the unit cube of as many dimensions as a path asks for (Kelemen et al., "A Simple and Robust Mutation
/// Strategy for the Metropolis Light Transport Algorithm", 2002). Dimensions are in streams, so that one part of a path
/// can grow without shifting the numbers of another. A number is brought up to date when it is asked for: those that
/// are not used cost nothing.
///
/// `propose` begins a step; `reject` takes it back.
class PrimarySample {
public:
    static constexpr std::size_t streams = 2;

    /// A uniform point, made of `seed` alone, but for what `begin_at` says.
    explicit PrimarySample(std::uint64_t seed = 0) : random_(seed) {}

    RandomSequence& random() { return random_; }

    /// Before the first step: the next pair of numbers of a stream.
    void begin_at(std::size_t stream, const Vec2& pair) {
        for (const float value : {pair.x, pair.y}) coordinates_[stream].push_back({value, now_, 0, 0});
    }

    /// A step moves every coordinate a little, and around the end of [0, 1).
    void propose() { ++now_; }
    void reject() {
        for (auto& stream : coordinates_)
            for (Coordinate& c : stream)
                if (c.modified == now_) c = {c.old_value, c.old_modified, c.old_value, c.old_modified};
        --now_;
    }

    /// Reads one stream from its begin on; serves as the sampler of a path, which takes numbers in pairs.
    class Reader {
    public:
        Reader(PrimarySample& sample, std::size_t stream) : sample_(sample), stream_(stream) {}
        float next_1d() { return sample_.value(stream_, 2 * pair_++); }
        Vec2 next_2d() {
            const std::size_t at = 2 * pair_++;
            const float x = sample_.value(stream_, at);
            return {x, sample_.value(stream_, at + 1)};
        }

        /// Past a pair that is of no use here.
        void skip() { ++pair_; }

    private:
        PrimarySample& sample_;
        std::size_t stream_, pair_ = 0;
    };

private:
    struct Coordinate {
        float value = 0;
        std::uint32_t modified = 0;  // the step that changed it last; 0: never used
        float old_value = 0;
        std::uint32_t old_modified = 0;
    };

    float value(std::size_t stream, std::size_t position) {
        auto& coordinates = coordinates_[stream];
        if (position >= coordinates.size()) coordinates.resize(position + 1);
        Coordinate& c = coordinates[position];
        if (c.modified == now_) return c.value;
        c.old_value = c.value;
        c.old_modified = c.modified;
        // Many steps in a row are one whose size grows as their square root.
        c.value =
            c.modified == 0 ? random_.next_float() : moved(c.value, std::sqrt(static_cast<float>(now_ - c.modified)));
        c.modified = now_;
        return c.value;
    }

    /// By a distance whose logarithm is uniform (Kelemen et al., section 3.2).
    float moved(float x, float scale) {
        constexpr float longest = 1.0f / 64, log_ratio = 2.7725887f;  // the shortest is a sixteenth of it
        const float along = 2 * random_.next_float() - 1;
        const float distance = std::min(scale * longest * std::exp(-log_ratio * std::abs(along)), 0.5f);
        const float to = x + std::copysign(distance, along);
        const float wrapped = to - std::floor(to);
        return wrapped < 1 ? wrapped : 0.0f;
    }

    RandomSequence random_;
    std::array<std::vector<Coordinate>, streams> coordinates_;
    std::uint32_t now_ = 1;
};

}  // namespace lightswitch
