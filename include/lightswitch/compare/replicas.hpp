#pragma once

// The independent images of one estimator, taken apart by path length and summed up over tiles.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/estimator.hpp>
#include <lightswitch/compare/tiles.hpp>

#include <chrono>
#include <optional>

namespace lightswitch::detail {

/// Draws images and keeps their moments. Part 0 is the whole image. Where depth can be limited, part d is the image of the paths of
/// length d, and the last part that of all longer ones: the difference of two renders with the same seed, which for path
/// tracers are the same paths and cancel.
class Replicas {
public:
    /// `stream` tells apart the estimators of a run.
    Replicas(Estimator estimator, int lengths, std::uint64_t seed, std::uint64_t stream)
        : estimator_(std::move(estimator)), seed_(mix64(mix64(seed) + stream)) {
        if (estimator_.limits_depth && lengths > 0)
            lengths_ = estimator_.max_depth < 0 ? lengths : std::clamp(estimator_.max_depth - 1, 0, lengths);
        parts_.resize(lengths_ == 0 ? 1 : static_cast<std::size_t>(lengths_) + 2);
    }

    const Estimator& estimator() const { return estimator_; }
    const TileLayout& layout() const { return parts_[0].layout(); }
    std::uint64_t count() const { return parts_[0].count(); }
    bool exact() const { return estimator_.exact; }
    /// Enough to judge by.
    bool usable() const { return count() >= (exact() ? 1u : 3u); }
    double seconds() const { return seconds_; }
    /// Per pixel, in all images.
    std::uint64_t samples_drawn() const { return exact() ? 0 : count() * static_cast<std::uint64_t>(iterations_); }
    std::uint64_t non_finite() const { return non_finite_; }

    /// Number of parts, and what they are.
    std::size_t parts() const { return parts_.size(); }
    int length(std::size_t part) const { return static_cast<int>(part); }
    bool and_longer(std::size_t part) const { return lengths_ > 0 && part + 1 == parts_.size(); }

    std::vector<std::array<Estimate, 3>> estimates(std::size_t part, std::size_t level) const {
        auto result = parts_[part].estimates(level);
        const double event = brightest_event();
        for (std::size_t t = 0; t < result.size(); ++t) {
            const PixelRectangle r = layout().tile(level, t);
            const double samples = double(r.x1 - r.x0) * double(r.y1 - r.y0) * double(count());
            for (Estimate& e : result[t]) {
                if (exact()) e = Estimate::exact(e.mean);
                else e.unseen = event / samples;
            }
        }
        return result;
    }

    /// The mean of the images.
    Image image() const {
        Image result(layout().width(), layout().height());
        for (std::size_t i = 0; i < sum_.size(); ++i) result.pixels()[i] = Rgb(sum_[i] / double(count()));
        return result;
    }

    /// What a bias is a fraction of: the mean of the whole image per channel, but at least a tenth of the mean of all channels.
    std::array<double, 3> scale() const {
        DVec3 mean(0);
        for (const DVec3& s : sum_) mean += s / (double(count()) * double(sum_.size()));
        const double least = std::max(0.1 * (mean.x + mean.y + mean.z) / 3, std::numeric_limits<double>::min());
        return {std::max(mean.x, least), std::max(mean.y, least), std::max(mean.z, least)};
    }

    /// Samples per pixel of the images to come.
    void set_samples(int iterations) { iterations_ = iterations; }
    /// Chooses them so that an image takes about that many seconds, by images that are thrown away.
    void choose_samples(double seconds, const std::stop_token& stop) {
        constexpr int most = 1024;
        iterations_ = 1;
        while (iterations_ < most && !stop.stop_requested()) {
            const auto begin = Clock::now();
            render_all(~drawn_ - static_cast<std::uint64_t>(iterations_), stop);
            const double taken = std::chrono::duration<double>(Clock::now() - begin).count();
            if (2 * taken > seconds) break;
            iterations_ *= 2;
        }
    }
    /// Forgets all images.
    void restart_with_twice_the_samples() {
        iterations_ *= 2;
        for (TileMoments& part : parts_) part = TileMoments();
        sum_.clear();
        previous_.reset();
    }

    /// Adds up to `wanted` images, as many as are worth making at a time; false when the run was stopped meanwhile. Small images are
    /// rendered side by side: one alone would not occupy all processors.
    bool draw(std::uint64_t wanted, const std::stop_token& stop, const Executor auto& executor) {
        const auto begin = Clock::now();
        constexpr std::uint64_t small = 128 * 128;
        const bool side_by_side = !sum_.empty() && sum_.size() <= small;
        std::vector<std::vector<Image>> images(side_by_side ? std::min<std::uint64_t>(wanted, 8) : 1);
        executor.for_each(images.size(), [&](std::size_t i) { images[i] = render_all(drawn_ + i, stop); });
        if (stop.stop_requested()) return false;
        drawn_ += images.size();
        for (const auto& image : images) add(image);
        seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
        return true;
    }

    /// The probability, if pixels erred independently, that they would seem to move together as much as they do.
    ///
    /// The difference of two images has pixels that are positive or negative with equal probability, each by itself. So for the
    /// differences d of a tile (sum d)^2 / sum d^2 - 1 has mean zero, whatever their sizes; it is positive when neighbours share
    /// random numbers. Each pair of images gives one value per tile size; they are judged by Student's t, on one side.
    double pixel_correlation_p() const {
        double smallest = 1;
        for (const Moments& m : {near_, far_}) {
            if (m.count() < 8) continue;
            const Estimate e = Estimate::of(m);
            if (!(e.mean > 0) || !(e.variance > 0)) continue;
            smallest = std::min(smallest, 0.5 * student_p(e.mean / std::sqrt(e.variance), e.freedom));
        }
        return std::min(1.0, 2 * smallest);
    }
    /// How much a small tile's variance exceeds that of independent pixels, as a fraction.
    double pixel_correlation() const { return std::max(near_.mean(), far_.mean()); }

private:
    /// By how much one sample that is brighter than usual may raise a pixel of one image, as far as one can know: by what was seen anywhere
    /// in the images, or by the brightest lamp, but at most by four times what was seen. Lamps in view do not count where
    /// paths are taken apart: they are not rare.
    double brightest_event() const {
        double seen = 0;
        for (std::size_t i = 0; i < largest_.size(); ++i)
            seen = std::max(seen, double(largest_[i]) - average_[i] / double(count()));
        const double lamp = estimator_.brightest / double(iterations_);
        if (seen == 0) return lamp;
        return lamp > 0 ? std::clamp(lamp, seen, 4 * seen) : 4 * seen;
    }

    using Clock = std::chrono::steady_clock;

    std::vector<Image> render_all(std::uint64_t index, const std::stop_token& stop) const {
        std::vector<Image> images;
        Estimator::Request request{.seed = mix64(seed_ + index), .index = index, .iterations = iterations_, .stop = stop};
        for (int d = 1; d <= lengths_; ++d) {
            request.max_depth = d;
            images.push_back(estimator_.render(request));
        }
        request.max_depth = Estimator::Request::unlimited;
        images.push_back(estimator_.render(request));
        return images;
    }

    void add(const std::vector<Image>& images) {
        const Image& all = images.back();
        if (sum_.empty()) {
            sum_.resize(all.pixels().size(), DVec3(0));
            largest_.assign(sum_.size(), 0.0f);
            average_.assign(sum_.size(), 0.0);
            for (TileMoments& part : parts_) part = TileMoments(TileLayout(all.width(), all.height()));
        }
        refuse(all);
        for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += DVec3(all.pixels()[i]);
        if (const auto found = all.metadata.find("non_finite"); found != all.metadata.end())
            non_finite_ += std::stoull(found->second);
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            const Rgb indirect = lengths_ > 0 ? all.pixels()[i] - images[0].pixels()[i] : all.pixels()[i];
            const float value = max_component(indirect);
            largest_[i] = count() == 0 ? value : std::max(largest_[i], value);
            average_[i] += double(value);
        }
        parts_[0].add(all);
        for (std::size_t d = 0; d < images.size() && images.size() > 1; ++d)
            parts_[d + 1].add(images[d], d == 0 ? nullptr : &images[d - 1]);
        if (!estimator_.independent_pixels) return;
        if (previous_) {
            correlate(*previous_, all);
            previous_.reset();
        } else {
            previous_ = all;
        }
    }

    void refuse(const Image& image) const {
        if (image.width() != layout().width() || image.height() != layout().height())
            fail("the images of " + estimator_.name + " differ in size: " + std::to_string(layout().width()) + " x " +
                 std::to_string(layout().height()) + " and " + std::to_string(image.width()) + " x " +
                 std::to_string(image.height()) + " pixels");
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                if (!is_finite(image(x, y)))
                    fail("image " + std::to_string(count() + 1) + " of " + estimator_.name + " is not finite in pixel (" +
                         std::to_string(x) + ", " + std::to_string(y) + "): nothing can be said of it");
    }
    [[noreturn]] static void fail(const std::string& what) { throw Error(what); }

    void correlate(const Image& a, const Image& b) {
        const std::size_t finest = layout().levels() - 1;
        DVec3 whole_sum(0), whole_squares(0), near(0);
        double terms = 0;
        for (std::size_t t = 0; t < layout().tiles(finest); ++t) {
            const PixelRectangle r = layout().tile(finest, t);
            DVec3 sum(0), squares(0);
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    const DVec3 d = DVec3(a(x, y)) - DVec3(b(x, y));
                    sum += d;
                    squares += d * d;
                }
            whole_sum += sum;
            whole_squares += squares;
            if (squares.y > 0) {
                near += sum * sum / squares - 1.0;  // only green is used: channels err together
                terms += 1;
            }
        }
        if (terms > 0) near_.add(near.y / terms);
        if (whole_squares.y > 0) far_.add(whole_sum.y * whole_sum.y / whole_squares.y - 1.0);
    }

    Estimator estimator_;
    std::uint64_t seed_;
    int lengths_ = 0, iterations_ = 1;
    std::uint64_t drawn_ = 0, non_finite_ = 0;
    double seconds_ = 0;
    std::vector<TileMoments> parts_;
    std::vector<DVec3> sum_;
    std::vector<float> largest_;    // of each pixel's brightest channel, without the paths of length 1 where they are known
    std::vector<double> average_;   // sum of the same
    std::optional<Image> previous_;  // waits for the other one of its pair
    Moments near_, far_;             // of the pixels of one small tile, and of the whole image
};

}  // namespace lightswitch::detail
