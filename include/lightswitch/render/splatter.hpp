#pragma once

// What work units collect: contributions to other pixels, and counts.

#include <lightswitch/core/parallel.hpp>
#include <lightswitch/core/ray_count.hpp>
#include <lightswitch/film/film.hpp>
#include <lightswitch/film/filter.hpp>

#include <algorithm>
#include <vector>

namespace lightswitch {

/// A value or a ray that was not finite, and how to meet it again: render that one pixel with that seed and iteration.
struct NonFinite {
    std::uint64_t iteration = 0;
    std::uint64_t seed = 0;
    std::uint32_t pixel = 0;  ///< row * width + column; 0 also for what belongs to none, like a ray of a light path

    friend auto operator<=>(const NonFinite&, const NonFinite&) = default;
};

/// Counts over all iterations.
struct RenderCounts {
    std::uint64_t rays = 0;         ///< closest-hit and visibility rays
    std::uint64_t shadow_rays = 0;  ///< visibility rays among them
    std::uint64_t paths = 0;        ///< light paths started by `Frame::paths`
    std::uint64_t splats = 0;
    /// Contributions that were not finite, replaced by black, and rays that Embree must not see
    /// (`embree::Accelerator`), which meet nothing.
    std::uint64_t non_finite = 0;
    std::vector<NonFinite> first_non_finite;  ///< the first 16 of them, in the order of iteration and pixel
};

namespace detail {

inline constexpr std::size_t max_noted = 16;

/// What one work unit found out; units share nothing while they run.
struct UnitReport {
    std::uint64_t rays = 0, shadow_rays = 0, non_finite = 0;
    std::vector<NonFinite> where;  // the first of them

    void note(const NonFinite& found, std::uint64_t times = 1) {
        non_finite += times;
        for (; times > 0 && where.size() < max_noted; --times) [[unlikely]] where.push_back(found);
    }
};

/// Counts the rays of a unit by the thread's counters before and after.
class UnitScope {
public:
    explicit UnitScope(UnitReport& report) : report_(report), before_(ray_count) {}
    ~UnitScope() {
        const auto& now = ray_count;
        report_.shadow_rays += now.occluded - before_.occluded;
        report_.rays += now.occluded - before_.occluded + now.intersect - before_.intersect;
    }
    UnitScope(const UnitScope&) = delete;
    UnitScope& operator=(const UnitScope&) = delete;

private:
    UnitReport& report_;
    RayCount before_;
    FlushDenormals flush_;
};

}  // namespace detail

/// Collects the splats of one work unit.
class Splatter {
public:
    /// On a film of that size.
    Splatter(std::vector<Splat>& splats, detail::UnitReport& report, int width, int height, const Filter& filter,
             std::uint64_t iteration, std::uint64_t seed)
        : splats_(&splats),
          report_(&report),
          width_(width),
          height_(height),
          filter_(filter),
          iteration_(iteration),
          seed_(seed) {}

    /// Adds `value` at the point `at` (columns and rows from the top left corner of the film) to the pixels around it,
    /// by the weights of the film's filter: with the box, to the pixel that holds the point. `value` is the integrand
    /// over the area of the film (in pixels) divided by the density of `at`. What is off the film is ignored; what is
    /// not finite is counted and dropped.
    void splat(const Vec2& at, const Rgb& value) {
        const bool finite = is_finite(value);
        if (filter_.kind() == Filter::Kind::box) {
            if (at.x >= 0 && at.y >= 0 && at.x < static_cast<float>(width_) && at.y < static_cast<float>(height_))
                [[likely]]
                add(static_cast<int>(at.x), static_cast<int>(at.y), value, finite);
            else if (!(is_finite(at.x) && is_finite(at.y))) add(0, 0, value, false);
            return;
        }
        if (!(is_finite(at.x) && is_finite(at.y))) return add(0, 0, value, false);
        // Pixels whose centres are within the radius.
        const float r = filter_.radius();
        const auto first = [&](float x) { return static_cast<int>(std::ceil(std::max(x - r - 0.5f, 0.0f))); };
        const auto last = [&](float x, int size) {
            return static_cast<int>(std::floor(std::clamp(x + r - 0.5f, -1.0f, static_cast<float>(size - 1))));
        };
        const int x1 = last(at.x, width_), y1 = last(at.y, height_);
        if (!(at.x - r < static_cast<float>(width_) && at.y - r < static_cast<float>(height_))) return;
        for (int y = first(at.y); y <= y1; ++y)
            for (int x = first(at.x); x <= x1; ++x) {
                const float weight = filter_.pdf(at - Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
                if (weight > 0) add(x, y, weight * value, finite);
                if (!finite) return;
            }
    }

private:
    void add(int x, int y, const Rgb& value, bool finite) {
        const auto pixel =
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width_) + static_cast<std::uint32_t>(x);
        if (finite) [[likely]]
            splats_->push_back({pixel, value});
        else report_->note({iteration_, seed_, pixel});
    }

    std::vector<Splat>* splats_;
    detail::UnitReport* report_;
    int width_, height_;
    Filter filter_;
    std::uint64_t iteration_, seed_;
};

}  // namespace lightswitch
