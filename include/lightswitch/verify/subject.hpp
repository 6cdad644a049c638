#pragma once

// One method of a verification, and what is known of it so far.

#include <lightswitch/verify/test_of_parts.hpp>
#include <lightswitch/verify/verify_options.hpp>

#include <limits>
#include <optional>
#include <vector>

namespace lightswitch::detail {

inline constexpr std::uint64_t first_look = 16;  ///< images

/// A method, its images and its verdict.
struct Subject {
    Subject(const Estimator& method, const VerifyOptions& options, std::uint64_t stream)
        : replicas(method, options.path_lengths, options.seed, stream) {
        if (method.kind == Kind::consistent) history.emplace();
    }

    Replicas replicas;
    const Replicas* reference = nullptr;
    std::optional<BiasHistory> history;  // of a consistent method
    double begun_with = 1,
           images = first_look;  // of a consistent method: samples of its first look; images of this one
    Verdict verdict;
    bool decided = false;
    std::uint64_t alarm_at = 0;  // number of images when a difference was first found
    std::vector<bool> alarms;    // by part
    std::vector<Image> snapshots;
    bool where_is_known = false;  // the lengths before the first wrong one are known to be right
    double needed_tolerance = std::numeric_limits<double>::infinity();
    bool rare = false;  // what may be missing counts for more than the noise
    bool stuck = false;
};

/// Files: as many as they are.
inline bool is_fixed(const Replicas& r) { return r.estimator().available > 0 && !r.exact(); }

}  // namespace lightswitch::detail
