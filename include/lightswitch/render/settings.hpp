#pragma once

// What a render is told, and what it tells.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/sampler.hpp>
#include <lightswitch/film/film.hpp>
#include <lightswitch/render/splatter.hpp>

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// When to stop: at whichever limit is met first. A limit of 0 is no limit; without any, 64 samples. Limits are numbers
/// and not negative.
struct Budget {
    int samples = 0;     ///< iterations, which for most methods are samples per pixel
    double seconds = 0;  ///< of rendering; at least one iteration is made
    /// Estimated error of the image, see `Film::relative_error`; judged from 16 iterations on. That of a black image is
    /// unknown: where there may be no light at all, set another limit, too.
    double error = 0;
};

/// What an observer is told after every iteration.
struct Progress {
    std::uint64_t iterations = 0;
    double seconds = 0;       ///< spent rendering
    double fraction = 0;      ///< of the budget that is spent, 0 to 1; never falls
    double seconds_left = 0;  ///< estimated
    const Film& film;
};

/// How to render; the defaults are right for most uses.
struct Settings {
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: as many as the machine has
    Sampling sampling = Sampling::sobol;
    std::stop_token stop = {};                           ///< ends the render early; whole iterations are kept
    std::function<void(const Progress&)> observer = {};  ///< called on the rendering thread after every iteration
    std::uint64_t first_iteration = 0;  ///< those before are left to others, whose films merge with this one
};

/// What a render did.
struct RenderStatistics {
    std::uint64_t iterations = 0;
    double seconds = 0;  ///< rendering only, steady clock
    int threads = 0;
    bool cancelled = false;
    RenderCounts counts;
    std::vector<std::pair<std::string, double>> of_method;  ///< what the method's state says, by name
};

namespace detail {

/// Estimated, when so many seconds have spent that fraction of a budget; 0 where nothing can be told.
inline double seconds_left(double seconds, double fraction) { return fraction > 0 ? seconds * (1 / fraction - 1) : 0; }

/// Throws `Error` when a limit is not one.
inline void check(const Budget& budget) {
    const auto check_limit = [](double limit, const char* what) {
        if (!(limit >= 0))
            throw Error(std::string("the budget of ") + what + " is " + number_text(limit) + ": give 0 for no limit");
    };
    check_limit(budget.samples, "samples");
    check_limit(budget.seconds, "seconds");
    check_limit(budget.error, "error");
}

}  // namespace detail

}  // namespace lightswitch
