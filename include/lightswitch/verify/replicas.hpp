#pragma once

// The independent images of one estimator, taken apart by path length and summed up over tiles.

#include <lightswitch/compare/difference.hpp>
#include <lightswitch/compare/tiles.hpp>
#include <lightswitch/verify/estimator.hpp>

#include <chrono>
#include <cstdlib>
#include <optional>

namespace lightswitch::detail {

/// Draws images and keeps their moments. Part 0 is the whole image. Where depth can be limited, part d is the image
/// of the paths of length d, and the last part that of all longer ones: the difference of two renders with the same
/// seed, which for path tracers are the same paths and cancel.
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
    /// Paths that the images are to be without.
    void leave_out(const PathClasses& classes) { left_out_ = classes; }
    const PathClasses& left_out() const { return left_out_; }
    const TileLayout& layout() const { return parts_[0].layout(); }
    std::uint64_t count() const { return parts_[0].count(); }
    bool exact() const { return estimator_.exact; }
    /// Enough to judge by.
    bool usable() const { return count() >= (exact() ? 1u : 3u); }
    double seconds() const { return seconds_; }
    /// Per pixel, in all images.
    std::uint64_t samples_drawn() const { return exact() ? 0 : count() * static_cast<std::uint64_t>(iterations_); }
    std::uint64_t non_finite() const { return non_finite_; }
    /// Samples per pixel of each image.
    int samples() const { return iterations_; }
    /// How many images `draw` makes at a time at most.
    std::uint64_t batch() const {
        constexpr std::uint64_t small = 128 * 128;  // one alone would not occupy all processors
        return !sum_.empty() && sum_.size() <= small ? 8 : 1;
    }
    /// Seconds that an image takes; 0 when that is not known yet.
    double seconds_per_image() const { return seconds_per_image_; }

    /// The variance of the mean of one image, or what would be as uncertain: of images that rest on events that may not
    /// have been met yet.
    double variance_per_image() const {
        const Estimate e = estimates(0, 0)[0][1];
        return double(count()) * std::max(e.variance, 6.25 * e.unseen * e.unseen);
    }

    /// Number of parts, and what they are.
    std::size_t parts() const { return parts_.size(); }
    int length(std::size_t part) const { return static_cast<int>(part); }
    bool and_longer(std::size_t part) const { return lengths_ > 0 && part + 1 == parts_.size(); }

    std::vector<std::array<Estimate, 3>> estimates(std::size_t part, std::size_t level) const {
        auto result = parts_[part].estimates(level);
        const DVec3 event = brightest_event();
        for (std::size_t t = 0; t < result.size(); ++t) {
            const PixelRectangle r = layout().tile(level, t);
            const double samples = double(r.x1 - r.x0) * double(r.y1 - r.y0) * double(count());
            for (std::size_t c = 0; c < 3; ++c) {
                Estimate& e = result[t][c];
                if (exact()) e = Estimate::exact(e.mean);
                else e.unseen = event[int(c)] / samples;
            }
        }
        return result;
    }

    /// The mean of the images, with what they say of scene and camera.
    Image image() const {
        Image result(layout().width(), layout().height());
        result.metadata = metadata_;
        for (std::size_t i = 0; i < sum_.size(); ++i) result.pixels()[i] = Rgb(sum_[i] / double(count()));
        return result;
    }

    /// What a bias is a fraction of: the mean of the whole image per channel, but at least a tenth of the mean of all
    /// channels; 1 for a black image, where the bias is then in units of radiance.
    std::array<double, 3> scale() const {
        DVec3 mean(0);
        for (const DVec3& s : sum_) mean += s / (double(count()) * double(sum_.size()));
        mean = glm::abs(mean);
        const double least = 0.1 * (mean.x + mean.y + mean.z) / 3;
        if (!(least > 0)) return {1, 1, 1};
        return {std::max(mean.x, least), std::max(mean.y, least), std::max(mean.z, least)};
    }

    /// Samples per pixel of the images to come.
    void set_samples(int iterations) { iterations_ = iterations; }
    /// Chooses them so that an image takes about that many seconds, by images that are thrown away; those of one
    /// sample are kept. Where one takes more than `too_long`, path lengths are not told apart.
    void choose_samples(double seconds, double too_long, const std::stop_token& stop) {
        constexpr int most = 1024;
        iterations_ = 1;
        while (iterations_ < most && !stop.stop_requested()) {
            const auto begin = Clock::now();
            std::vector<Image> images = render_all(~std::uint64_t{0} - static_cast<std::uint64_t>(iterations_), stop);
            const double taken = std::chrono::duration<double>(Clock::now() - begin).count();
            if (2 * taken > seconds) {
                if (iterations_ > 1 || stop.stop_requested()) return;
                if (taken > too_long) {
                    lengths_ = 0;
                    parts_.resize(1);
                    images.erase(images.begin(), images.end() - 1);
                }
                add(images);
                seconds_ += taken;
                seconds_per_image_ = taken;
                return;
            }
            iterations_ *= 2;
        }
    }
    /// Forgets all images; the next ones have `factor` times the samples, but at least one.
    void restart(double factor) {
        iterations_ = std::max(1, static_cast<int>(iterations_ * factor));
        seconds_per_image_ *= factor;
        for (TileMoments& part : parts_) part = TileMoments();
        sum_.clear();
        previous_.reset();
        drawn_ = event_at_ = 0;
        seed_ = mix64(seed_);
    }

    /// Adds up to `wanted` images, `batch()` of them at most, side by side; false when the run was stopped meanwhile.
    bool draw(std::uint64_t wanted, const std::stop_token& stop, const Executor auto& executor) {
        const auto begin = Clock::now();
        std::vector<std::vector<Image>> images(std::min(wanted, batch()));
        executor.for_each(images.size(), [&](std::size_t i) { images[i] = render_all(drawn_ + i, stop); });
        if (stop.stop_requested()) return false;
        drawn_ += images.size();
        for (const auto& image : images) add(image);
        const double taken = std::chrono::duration<double>(Clock::now() - begin).count();
        seconds_ += taken;
        seconds_per_image_ = taken / double(images.size());
        return true;
    }

    /// The probability, if pixels erred independently, that they would seem to move together as much as they do.
    ///
    /// The difference of two images has pixels that are positive or negative with equal probability, each by itself.
    /// So for the differences d of a tile (sum d)^2 / sum d^2 - 1 has mean zero, whatever their sizes; it is positive
    /// when neighbours share random numbers. Each pair of images gives one value per tile size; they are judged by
    /// Student's t, on one side.
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
    /// By how much one sample that is brighter than usual may raise a pixel of one image, as far as one can know: by
    /// what was seen anywhere in the images, or by the brightest lamp; where no lamp is known, by four times what was
    /// seen. Lamps in view do not count where paths are taken apart: they are not rare.
    const DVec3& brightest_event() const {
        if (event_at_ == count()) return event_;
        event_at_ = count();
        DVec3 seen(0);
        for (std::size_t i = 0; i < largest_.size(); ++i)
            seen = glm::max(seen, DVec3(largest_[i]) - average_[i] / double(count()));
        const DVec3 lamp = DVec3(estimator_.brightest) / double(iterations_);
        for (int c = 0; c < 3; ++c) event_[c] = lamp[c] > 0 ? std::max(lamp[c], seen[c]) : 4 * seen[c];
        return event_;
    }

    using Clock = std::chrono::steady_clock;

    std::vector<Image> render_all(std::uint64_t index, const std::stop_token& stop) const {
        std::vector<Image> images;
        Estimator::Request request{.seed = mix64(seed_ + index),
                                   .index = index,
                                   .iterations = iterations_,
                                   .left_out = left_out_,
                                   .stop = stop};
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
            largest_.assign(sum_.size(), Rgb(0));
            average_.assign(sum_.size(), DVec3(0));
            for (const char* key : {"scene", "camera", "size"})
                if (const auto found = all.metadata.find(key); found != all.metadata.end()) metadata_.insert(*found);
            for (TileMoments& part : parts_) part = TileMoments(TileLayout(all.width(), all.height()));
        }
        refuse(all);
        if (const auto found = all.metadata.find("non_finite"); found != all.metadata.end())
            non_finite_ += std::strtoull(found->second.c_str(), nullptr, 10);
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            sum_[i] += DVec3(all.pixels()[i]);
            const Rgb indirect = lengths_ > 0 ? all.pixels()[i] - images[0].pixels()[i] : all.pixels()[i];
            largest_[i] = count() == 0 ? indirect : glm::max(largest_[i], indirect);
            average_[i] += DVec3(indirect);
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
            throw Error("the images of " + estimator_.name + " differ in size: " + std::to_string(layout().width()) +
                        " x " + std::to_string(layout().height()) + " and " + std::to_string(image.width()) + " x " +
                        std::to_string(image.height()) + " pixels");
        if (const auto at = image.first_not_finite())
            throw Error("image " + std::to_string(count() + 1) + " of " + estimator_.name +
                        " is not finite in pixel (" + std::to_string(at->first) + ", " + std::to_string(at->second) +
                        "): nothing can be said of it");
    }

    // In green alone: channels err together.
    void correlate(const Image& a, const Image& b) {
        const std::size_t finest = layout().levels() - 1;
        double whole_sum = 0, whole_squares = 0, near = 0, terms = 0;
        for (std::size_t t = 0; t < layout().tiles(finest); ++t) {
            const PixelRectangle r = layout().tile(finest, t);
            double sum = 0, squares = 0;
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    const double d = double(a(x, y).y) - double(b(x, y).y);
                    sum += d;
                    squares += d * d;
                }
            whole_sum += sum;
            whole_squares += squares;
            if (squares > 0) {
                near += sum * sum / squares - 1;
                terms += 1;
            }
        }
        if (terms > 0) near_.add(near / terms);
        if (whole_squares > 0) far_.add(whole_sum * whole_sum / whole_squares - 1);
    }

    Estimator estimator_;
    std::uint64_t seed_;
    int lengths_ = 0, iterations_ = 1;
    std::uint64_t drawn_ = 0, non_finite_ = 0;
    double seconds_ = 0, seconds_per_image_ = 0;
    PathClasses left_out_;
    std::vector<TileMoments> parts_;
    std::vector<DVec3> sum_;
    std::vector<Rgb> largest_;    // of each pixel, without the paths of length 1 where they are known
    std::vector<DVec3> average_;  // sum of the same
    mutable DVec3 event_{0};      // `brightest_event` of so many images
    mutable std::uint64_t event_at_ = 0;
    Image::Metadata metadata_;
    std::optional<Image> previous_;  // waits for the other one of its pair
    Moments near_, far_;             // of the pixels of one small tile, and of the whole image
};

}  // namespace lightswitch::detail
