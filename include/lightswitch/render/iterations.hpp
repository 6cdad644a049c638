#pragma once

// Which iterations of a render have been made.

#include <lightswitch/core/error.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace lightswitch {

/// Iterations from `begin` to before `end`, of one seed.
struct IterationRange {
    std::uint64_t seed = 0, begin = 0, end = 0;

    friend auto operator<=>(const IterationRange&, const IterationRange&) = default;
};

/// A set of iterations of one or several seeds.
class IterationSet {
public:
    IterationSet() = default;
    /// Throws `Error` when a range is empty, or two overlap.
    explicit IterationSet(std::vector<IterationRange> ranges) : ranges_(std::move(ranges)) { tidy(); }

    /// By seed and begin; no two of a seed touch.
    const std::vector<IterationRange>& ranges() const { return ranges_; }
    std::uint64_t count() const {
        std::uint64_t sum = 0;
        for (const IterationRange& range : ranges_) sum += range.end - range.begin;
        return sum;
    }

    /// The first iteration of that seed, from `from` on, that is not in the set.
    std::uint64_t next(std::uint64_t seed, std::uint64_t from) const {
        for (const IterationRange& range : ranges_)
            if (range.seed == seed && range.begin <= from && from < range.end) from = range.end;
        return from;
    }
    /// Adds an iteration that is not in the set.
    void add(std::uint64_t seed, std::uint64_t iteration) {
        for (IterationRange& range : ranges_)
            if (range.seed == seed && range.end == iteration) {
                ++range.end;
                if (ranges_.size() > 1) tidy();
                return;
            }
        ranges_.push_back({seed, iteration, iteration + 1});
        tidy();
    }
    /// Adds another set. Throws `Error` when an iteration is in both.
    void merge(const IterationSet& other) {
        std::vector<IterationRange> all = ranges_;
        all.insert(all.end(), other.ranges_.begin(), other.ranges_.end());
        ranges_ = IterationSet(std::move(all)).ranges_;
    }

    /// The seeds, such as "0" or "3, 7".
    std::string seeds() const {
        std::string text;
        for (std::size_t i = 0; i < ranges_.size(); ++i)
            if (i == 0 || ranges_[i].seed != ranges_[i - 1].seed)
                text += (i == 0 ? "" : ", ") + std::to_string(ranges_[i].seed);
        return text;
    }
    /// Such as "0 to 99, 200 to 299 of seed 0".
    std::string text() const {
        std::string text;
        for (std::size_t i = 0; i < ranges_.size(); ++i) {
            text += (i == 0 ? "" : ", ") + text_of(ranges_[i]);
            if (i + 1 == ranges_.size() || ranges_[i + 1].seed != ranges_[i].seed)
                text += " of seed " + std::to_string(ranges_[i].seed);
        }
        return text;
    }

    friend bool operator==(const IterationSet&, const IterationSet&) = default;

private:
    static std::string text_of(const IterationRange& range) {
        return std::to_string(range.begin) + " to " + std::to_string(range.end - 1);
    }

    void tidy() {
        std::sort(ranges_.begin(), ranges_.end());
        std::vector<IterationRange> tidied;
        for (const IterationRange& range : ranges_) {
            if (range.begin >= range.end) throw Error("a range of iterations is empty");
            if (tidied.empty() || tidied.back().seed != range.seed || tidied.back().end < range.begin) {
                tidied.push_back(range);
                continue;
            }
            if (range.begin < tidied.back().end)
                throw Error("iterations " + text_of({range.seed, range.begin, std::min(range.end, tidied.back().end)}) +
                            " of seed " + std::to_string(range.seed) + " are there twice");
            tidied.back().end = range.end;
        }
        ranges_ = std::move(tidied);
    }

    std::vector<IterationRange> ranges_;
};

}  // namespace lightswitch
