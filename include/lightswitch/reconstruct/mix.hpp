#pragma once

// A denoised image and the samples that it was made of, joined: at every scale and place so much of the samples as
// makes the expected error least.

#include <lightswitch/reconstruct/starlet.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace lightswitch {

/// Two images of the same view with independent noise, what a reconstructor has made of each by itself, and what it has
/// made of both together, weighted by their samples.
struct Halves {
    const Image &a, &b;
    std::uint64_t samples_a = 1, samples_b = 1;
    const Image &denoised_a, &denoised_b, &denoised;
};

/// That denoiser and samples contradict each other: at some scale and place the square of their difference is above
/// `limit` times what noise makes of it, by more than `deviations` standard errors, and by more than (1 % of the
/// radiance)^2. The clearest place.
struct Contradiction {
    static constexpr float limit = 4, deviations = 6;

    double ratio = 0;       ///< of the two squares; above `limit`
    double difference = 0;  ///< root mean square of what noise does not explain, as a fraction of the radiance there
    int x = 0, y = 0;       ///< the place, in pixels
    int size = 1;           ///< of what is wrong there, in pixels: the scale
    double share = 0;       ///< of the image's area where they do, at whatever scale
};

/// What `mix` makes.
struct Mixed {
    Image image;
    Image error;         ///< estimated root mean square error around each pixel, in units of radiance; grey
    Image from_samples;  ///< how much of the detail came from the samples, 0 to 1; grey
    // Estimated root mean square errors as fractions of the image's mean, as `Film::relative_error` has them: of this
    // image and of the two that were joined. Infinite, which is to say unknown, for a black image.
    double relative_error = std::numeric_limits<double>::infinity();
    double relative_error_of_samples = std::numeric_limits<double>::infinity();
    double relative_error_of_denoised = std::numeric_limits<double>::infinity();
    double detail_from_samples = 0;  ///< mean of `from_samples`
    std::optional<Contradiction> contradiction;
};

namespace detail {

/// The mean of the channels' products.
inline Plane<float> product(const Plane<Rgb>& a, const Plane<Rgb>& b) {
    Plane<float> result(a.width, a.height);
    for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] = dot(a.values[i], b.values[i]) / 3;
    return result;
}

/// Smoothed over a neighbourhood of some `step`s, and with less weight over one that is three times as wide.
inline Plane<float> around(Plane<float> near, int step, const Executor auto& executor) {
    constexpr float weight_of_wide = 0.3f;
    Plane<float> between(near.width, near.height);
    for (const int s : {1, 2, 4}) smooth(near, s * step, between, near, executor);
    Plane<float> wide = near;
    for (const int s : {4, 8, 8}) smooth(wide, s * step, between, wide, executor);
    for (std::size_t i = 0; i < near.values.size(); ++i)
        near.values[i] = (near.values[i] + weight_of_wide * wide.values[i]) / (1 + weight_of_wide);
    return near;
}

/// The joining, step by step. Differences are weighed in units of the radiance that each pixel is believed to have, so
/// that dark parts count as much as bright ones.
class Mixing {
public:
    explicit Mixing(const Halves& halves)
        : width_(halves.a.width()),
          height_(halves.a.height()),
          samples_(width_, height_),
          level_(width_, height_),
          residual_(width_, height_),
          noise_(width_, height_),
          noise_of_residual_(width_, height_),
          of_denoised_(width_, height_),
          noise_of_denoised_(width_, height_),
          shares_(width_, height_),
          clearest_(width_, height_) {
        const double total = double(halves.samples_a) + double(halves.samples_b);
        const double share_a = double(halves.samples_a) / total, share_b = double(halves.samples_b) / total;
        // By this factor the difference of two halves has the variance of their mean.
        const double half_difference = std::sqrt(share_a * share_b);
        for (std::size_t i = 0; i < area(); ++i)
            samples_.pixels()[i] = Rgb(share_a * DVec3(halves.a.pixels()[i]) + share_b * DVec3(halves.b.pixels()[i]));
        Plane<float> seen(width_, height_);
        scale_ = unit_scale(samples_);
        for (std::size_t i = 0; i < area(); ++i) {
            const DVec3 a = scale_ * DVec3(halves.a.pixels()[i]), b = scale_ * DVec3(halves.b.pixels()[i]);
            const DVec3 denoised_a = usable(halves.denoised_a.pixels()[i], a);
            const DVec3 denoised_b = usable(halves.denoised_b.pixels()[i], b);
            const DVec3 mean = share_a * a + share_b * b, denoised = usable(halves.denoised.pixels()[i], mean);
            const auto magnitude = [](const DVec3& v) {
                return static_cast<float>((std::abs(v.x) + std::abs(v.y) + std::abs(v.z)) / 3);
            };
            level_.values[i] = magnitude(denoised);
            seen.values[i] = magnitude(mean);
            residual_.values[i] = Rgb(mean - denoised);
            noise_.values[i] = Rgb(half_difference * (a - b));
            noise_of_residual_.values[i] = Rgb(half_difference * ((a - denoised_a) - (b - denoised_b)));
        }
        smooth(seen, 1, SerialExecutor{});
        for (std::size_t i = 0; i < area(); ++i)
            level_.values[i] = std::max({level_.values[i], 0.25f * seen.values[i], dark});
    }

    Mixed mix(const Executor auto& executor) {
        int levels = 0;
        while ((4 << levels) < std::max(width_, height_) && levels < 6) ++levels;
        double of_samples = 0, of_denoised = 0;
        for (std::size_t i = 0; i < area(); ++i) {
            of_samples += double(length_squared(noise_.values[i]));
            of_denoised += double(length_squared(noise_.values[i] - noise_of_residual_.values[i]) +
                                  length_squared(residual_.values[i]) - length_squared(noise_of_residual_.values[i]));
        }
        // What comes of it takes the denoised image's place, as a better guess of the pixels' radiance: where that was
        // far off, errors were weighed wrongly.
        constexpr int passes = 4;
        Plane<Rgb> noise = noise_;  // which `join` takes apart
        for (int pass = 0; pass < passes; ++pass) {
            if (pass > 0) begin_anew(noise);
            for (int l = 0; l <= levels; ++l) join(l, levels, pass, executor);
        }

        Mixed result{.image = Image(width_, height_),
                     .error = Image(width_, height_),
                     .from_samples = Image(width_, height_),
                     .contradiction = {}};
        Plane<float> variance(width_, height_), bias(width_, height_);
        double mean = 0, of_mix = 0, share = 0;
        std::size_t clearest = 0, contradicted = 0;
        for (std::size_t i = 0; i < area(); ++i) {
            const DVec3 corrected = DVec3(samples_.pixels()[i]) - DVec3(of_denoised_.values[i]) / scale_;
            result.image.pixels()[i] = Rgb(corrected);
            result.from_samples.pixels()[i] = Rgb(shares_.values[i]);
            // What is left is noise as the half differences have it, and what the correction has beyond its own noise.
            variance.values[i] = length_squared(noise.values[i] - noise_of_denoised_.values[i]) / 3;
            bias.values[i] =
                (length_squared(of_denoised_.values[i]) - length_squared(noise_of_denoised_.values[i])) / 3;
            mean += (corrected.x + corrected.y + corrected.z) * scale_ / 3;
            of_mix += double(variance.values[i] + bias.values[i]);
            share += double(shares_.values[i]);
            if (clearest_.values[i].ratio > clearest_.values[clearest].ratio) clearest = i;
            contradicted += clearest_.values[i].ratio > Contradiction::limit;
        }
        // The map is smoothed in units of the radiance, lest a lamp's error spread to what is around it.
        for (Plane<float>* plane : {&variance, &bias})
            for (std::size_t i = 0; i < area(); ++i) plane->values[i] /= level_.values[i] * level_.values[i];
        for (const int s : {1, 2, 4}) smooth(variance, s, executor);
        for (const int s : {1, 2, 4, 8}) smooth(bias, s, executor);
        for (std::size_t i = 0; i < area(); ++i) {
            const double error = std::sqrt(double(variance.values[i]) + std::max(double(bias.values[i]), 0.0));
            result.error.pixels()[i] = Rgb(static_cast<float>(error * double(level_.values[i]) / scale_));
        }
        const double pixels = double(area());
        if (mean > 0) {
            const auto relative = [&](double sum) { return std::sqrt(std::max(sum, 0.0) / pixels) / (mean / pixels); };
            result.relative_error = relative(of_mix);
            result.relative_error_of_samples = relative(of_samples / 3);
            result.relative_error_of_denoised = relative(of_denoised / 3);
        }
        result.detail_from_samples = share / pixels;
        if (contradicted > 0) {
            const Clear& c = clearest_.values[clearest];
            result.contradiction = {.ratio = double(c.ratio),
                                    .difference = double(c.difference),
                                    .x = static_cast<int>(clearest % std::size_t(width_)),
                                    .y = static_cast<int>(clearest / std::size_t(width_)),
                                    .size = 1 << c.level,
                                    .share = double(contradicted) / pixels};
        }
        return result;
    }

private:
    /// Radiance, as a fraction of the image's mean, below which errors are not weighed by it any more.
    static constexpr float dark = 0.3f;
    /// How many coefficients of a neighbourhood are as good as independent: its weights' effective area is 264 of them
    /// (4 pi times the variance of the near one, 21), and each is correlated with about five.
    static constexpr float independent = 264.0f / 5;

    /// The clearest contradiction at a place.
    struct Clear {
        float ratio = 0, difference = 0;
        int level = 0;
        Clear(int = 0) {}
    };

    static double square_of(double x) { return x * x; }
    std::size_t area() const { return samples_.pixels().size(); }

    /// Of a reconstructor's pixel; what it should have been made of, where it is not finite.
    DVec3 usable(const Rgb& denoised, const DVec3& samples) const {
        return is_finite(denoised) ? glm::clamp(scale_ * DVec3(denoised), DVec3(-1e9), DVec3(1e9)) : samples;
    }

    /// Before another pass over the samples' noise and what the last has chosen.
    void begin_anew(Plane<Rgb>& noise) {
        for (std::size_t i = 0; i < area(); ++i) {
            const Rgb mixed = Rgb(scale_ * DVec3(samples_.pixels()[i])) - of_denoised_.values[i];
            level_.values[i] = std::max((std::abs(mixed.x) + std::abs(mixed.y) + std::abs(mixed.z)) / 3, dark);
            noise_.values[i] = noise.values[i];
            residual_.values[i] = of_denoised_.values[i];
            noise_of_residual_.values[i] = noise_of_denoised_.values[i];
            of_denoised_.values[i] = noise_of_denoised_.values[i] = Rgb(0);
        }
    }

    /// Chooses at one scale. With x the samples, d the denoised image and T the truth, x - s (x - d) has the least
    /// expected error for s = E[(x - T)(x - d)] / E[(x - d)^2]. Half differences have the noise of x and of d and
    /// nothing else, so the product of those of x and of x - d has the expectation of the numerator. A standard error
    /// of it is added: in doubt for the denoised image, which alone can say anything where samples are few.
    void join(int l, int levels, int pass, const Executor auto& executor) {
        const int step = 1 << l;
        const auto split = [&](Plane<Rgb>& plane) {
            if (l == levels) return plane;
            Plane<Rgb> between(width_, height_), coarse(width_, height_);
            smooth(plane, step, between, coarse, executor);
            for (std::size_t i = 0; i < area(); ++i) plane.values[i] -= coarse.values[i];
            std::swap(plane, coarse);
            return coarse;
        };
        const Plane<Rgb> residual = split(residual_), noise = split(noise_);
        const Plane<Rgb> noise_of_residual = split(noise_of_residual_);
        const auto relative = [&](Plane<Rgb> plane) {
            for (std::size_t i = 0; i < area(); ++i) plane.values[i] /= level_.values[i];
            return plane;
        };
        const Plane<Rgb> r = relative(residual), n = relative(noise), nr = relative(noise_of_residual);
        const Plane<float> all = around(product(r, r), step, executor);
        const Plane<float> shared = around(product(n, nr), step, executor);
        const Plane<float> doubts = standard_errors(r, n, step, executor);
        for (std::size_t i = 0; i < area(); ++i) {
            const float square = all.values[i];
            const float share = square > 0 ? std::clamp((shared.values[i] + doubts.values[i]) / square, 0.0f, 1.0f) : 0;
            of_denoised_.values[i] += share * residual.values[i];
            noise_of_denoised_.values[i] += share * noise_of_residual.values[i];
            if (pass == 0) shares_.values[i] += (1 - share) / static_cast<float>(levels + 1);
        }
        // Contradictions are those of the denoised image, and of scales at which the image has enough places.
        if (pass > 0 || 16 * step > std::min(width_, height_)) return;
        contradict(nr, all, doubts, step, l, executor);
    }

    /// Of the mean of `residual`'s squares around each place, by the noise of what is squared.
    Plane<float> standard_errors(const Plane<Rgb>& residual, const Plane<Rgb>& noise, int step,
                                 const Executor auto& executor) const {
        Plane<float> errors(width_, height_);
        for (std::size_t i = 0; i < area(); ++i)
            errors.values[i] = length_squared(residual.values[i]) / 3 * (length_squared(noise.values[i]) / 3);
        errors = around(std::move(errors), step, executor);
        for (float& error : errors.values) error = std::sqrt(4 / independent * error);
        return errors;
    }

    /// Notes where `all`, the mean squares of what differs at a scale, is more than noise makes of it.
    void contradict(const Plane<Rgb>& noise_of_residual, const Plane<float>& all, const Plane<float>& doubts, int step,
                    int l, const Executor auto& executor) {
        const Plane<float> chance = around(product(noise_of_residual, noise_of_residual), step, executor);
        for (std::size_t i = 0; i < area(); ++i) {
            const float square = all.values[i], unexplained = square - chance.values[i];
            if (!(unexplained > std::max(1e-4f, Contradiction::deviations * doubts.values[i]))) continue;
            const float ratio = square / std::max(chance.values[i], 1e-6f * square);  // finite where there is no noise
            Clear& clearest = clearest_.values[i];
            if (ratio <= std::max(Contradiction::limit, clearest.ratio)) continue;
            clearest.ratio = ratio;
            clearest.difference = std::sqrt(unexplained);
            clearest.level = l;
        }
    }

    int width_, height_;
    double scale_ = 1;
    Image samples_;
    Plane<float> level_;
    Plane<Rgb> residual_, noise_, noise_of_residual_;  // x - d, and half differences of x and of x - d
    Plane<Rgb> of_denoised_, noise_of_denoised_;       // what the denoiser takes away from x, and its noise
    Plane<float> shares_;
    Plane<Clear> clearest_;
};

}  // namespace detail

/// Joins samples and denoised image such that
///
/// * the error is about that of the better of the two, at every scale and place, and often less;
/// * it vanishes as the samples grow, whatever the reconstructor does: their weight goes to 1 where they differ from
///   the denoised image by more than noise;
/// * nothing need be known of the reconstructor or of the method, whose noise may be different and correlated among
///   pixels: the halves tell.
///
/// Weights are chosen in the starlet transform of the difference, after SURE-based combinations of rendered images
/// (Zheng et al. 2021, "Ensemble Denoising for Monte Carlo Renderings"; Firmino et al. 2022, "Progressive Denoising of
/// Monte Carlo Rendered Images"; Gu et al. 2022, "Neural James-Stein Combiner for Unbiased and Biased Renderings"), by
/// two halves instead of derivatives of the reconstructor or training. Pixels of a denoised image that are not finite
/// count as their samples. Throws `Error` when sizes differ, a half has no samples, or is not finite.
Mixed mix(const Halves& halves, const Executor auto& executor) {
    const Guides none;
    detail::check(NoisyImage{halves.a, halves.b, none});
    for (const Image* denoised : {&halves.denoised_a, &halves.denoised_b, &halves.denoised})
        detail::check_same_size(*denoised, halves.a, "denoised image");
    if (halves.samples_a == 0 || halves.samples_b == 0 || halves.b.empty())
        throw Error("a mixture needs two halves that have samples");
    return detail::Mixing(halves).mix(executor);
}

}  // namespace lightswitch
