#pragma once

// Renders that are denoised: two halves of the samples, with noise of their own, and what a reconstructor makes of
// them.

#include <lightswitch/method/extra_outputs.hpp>
#include <lightswitch/reconstruct/mix.hpp>
#include <lightswitch/reconstruct/oidn.hpp>
#include <lightswitch/reconstruct/regression.hpp>
#include <lightswitch/render/any_session.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// Albedo and normals of a scene, by camera rays as `render_outputs` makes them.
template <class SceneType>
Guides render_guides(const SceneType& scene, int samples = 64, const Settings& settings = {}) {
    std::vector<Layer> layers = render_outputs(scene, {Albedo{}, ShadingNormal{}}, samples, settings);
    if (layers.empty()) return {};  // it was asked for an end
    return {.albedo = std::move(layers[0].image), .normal = std::move(layers[1].image)};
}

/// A render in two halves of different seeds, so that what is made of one knows nothing of the other's noise. Their
/// samples are what `render` makes with `settings.seed`, and with a seed that follows from it. Can be continued, as a
/// `Session`; scene and executor are its own as there.
class HalvedSession {
public:
    template <class SceneType, class M>
    HalvedSession(const SceneType& scene, const M& method, const Settings& settings = {})
        : settings_(settings), executor_(settings.threads), kind_(M::kind) {
        Settings unobserved = settings;
        unobserved.observer = {};
        halves_[0] = detail::AnySession::make(scene, method, unobserved);
        unobserved.seed = second_seed(settings.seed);
        halves_[1] = detail::AnySession::make(scene, method, unobserved);
    }
    /// The scene would be gone before the session is used.
    template <class SceneType, class M>
    HalvedSession(const SceneType&& scene, const M& method, const Settings& settings = {}) = delete;

    /// Makes iterations, of one half and of the other in turn, until the budget is spent or the stop token asks for an
    /// end. Of the budget's error it is the estimated one of what `reconstruct` makes (`Mixed::relative_error`), which
    /// is looked at after 16 samples and each time that there are a quarter more. The observer sees the film of the
    /// first half.
    template <Reconstructor R>
    void run(Budget budget, const R& reconstructor, const Guides& guides, const std::stop_token& pause) {
        using Clock = std::chrono::steady_clock;
        detail::check(budget);
        if (budget.samples == 0 && budget.seconds == 0 && budget.error == 0) budget.samples = 64;
        const auto begin = Clock::now();
        const std::uint64_t already = samples();
        double fraction = 0;
        std::uint64_t next_look = 16;
        const auto wanted = static_cast<std::uint64_t>(budget.samples);
        while (!pause.stop_requested() && !(wanted > 0 && samples() >= wanted) && fraction < 1) {
            detail::AnySession& half = halves_[samples() % 2];
            const std::uint64_t before = half.film().iterations();
            half.run({.samples = static_cast<int>(before) + 1}, pause);
            if (half.film().iterations() == before) break;
            const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
            if (wanted > 0) fraction = std::max(fraction, double(samples() - already) / double(wanted - already));
            if (budget.seconds > 0) fraction = std::max(fraction, seconds / budget.seconds);
            if (budget.error > 0 && samples() >= next_look) {
                next_look = samples() + samples() / 4;
                const double ratio = budget.error / reconstruct(reconstructor, guides).relative_error;
                fraction = std::max(fraction, ratio >= 1 ? 1.0 : ratio * ratio);
            }
            fraction = std::min(fraction, 1.0);
            if (settings_.observer)
                settings_.observer({.iterations = samples(),
                                    .seconds = seconds,
                                    .fraction = fraction,
                                    .seconds_left = detail::seconds_left(seconds, fraction),
                                    .film = halves_[0].film()});
        }
        cancelled_ = pause.stop_requested();
    }
    template <Reconstructor R>
    void run(const Budget& budget, const R& reconstructor, const Guides& guides) {
        run(budget, reconstructor, guides, settings_.stop);
    }

    /// Samples per pixel of both halves together.
    std::uint64_t samples() const { return halves_[0].film().iterations() + halves_[1].film().iterations(); }

    /// The mean of all samples, without any reconstruction.
    Image image() const {
        if (samples() < 2) return halves_[0].image();
        Image result = combined(halves_[0].image(), halves_[1].image(), share(0), share(1));
        result.metadata["samples"] = std::to_string(samples());
        result.metadata["seconds"] = std::to_string(statistics().seconds);
        return result;
    }

    /// Of both halves.
    RenderStatistics statistics() const {
        RenderStatistics sum = halves_[0].statistics();
        const RenderStatistics& other = halves_[1].statistics();
        sum.iterations = samples();
        sum.seconds += other.seconds;
        sum.cancelled = cancelled_;
        sum.counts.rays += other.counts.rays;
        sum.counts.shadow_rays += other.counts.shadow_rays;
        sum.counts.paths += other.counts.paths;
        sum.counts.splats += other.counts.splats;
        sum.counts.non_finite += other.counts.non_finite;
        auto& places = sum.counts.first_non_finite;
        places.insert(places.end(), other.counts.first_non_finite.begin(), other.counts.first_non_finite.end());
        return sum;
    }

    /// What `reconstructor` makes of the samples, mixed with them (`mix`). Of a single sample there are no halves: then
    /// it is what the reconstructor makes of it, with an error that is not known.
    template <Reconstructor R>
    Mixed reconstruct(const R& reconstructor, const Guides& guides) const {
        const Image raw = image(), none;
        const Image a = halves_[0].film().image(), b = halves_[1].film().image();
        const auto variance = [&](std::size_t half) {
            constexpr std::uint64_t fewest = 4;  // fewer samples say too little of their spread
            return halves_[1].film().iterations() < fewest ? Image() : halves_[half].film().variance();
        };
        const auto make = [&](const Image& image, const Image& of_it) {
            return reconstructor.reconstruct({image, of_it, guides}, executor_);
        };
        Mixed result;
        if (samples() < 2) {
            result.image = make(raw, none);
            result.from_samples = result.error = Image(raw.width(), raw.height());
            for (Rgb& pixel : result.error.pixels()) pixel = Rgb(infinity);
        } else {
            const Image variance_a = variance(0), variance_b = variance(1);
            const Image both = variance_a.empty()
                                   ? Image()
                                   : combined(variance_a, variance_b, share(0) * share(0), share(1) * share(1));
            const Image of_a = make(a, variance_a), of_b = make(b, variance_b), of_both = make(raw, both);
            result = mix({.a = a,
                          .b = b,
                          .samples_a = halves_[0].film().iterations(),
                          .samples_b = halves_[1].film().iterations(),
                          .denoised_a = of_a,
                          .denoised_b = of_b,
                          .denoised = of_both},
                         executor_);
        }
        result.image.metadata = raw.metadata;
        result.image.metadata["denoised"] = R::name;
        if (kind_ == Kind::unbiased) result.image.metadata["kind"] = name(Kind::consistent);
        return result;
    }

    /// The seed of the second half.
    static std::uint64_t second_seed(std::uint64_t seed) { return seed ^ 0x9e3779b97f4a7c15u; }

private:
    double share(std::size_t half) const { return double(halves_[half].film().iterations()) / double(samples()); }

    static Image combined(Image a, const Image& b, double weight_a, double weight_b) {
        for (std::size_t i = 0; i < a.pixels().size(); ++i)
            a.pixels()[i] = Rgb(weight_a * DVec3(a.pixels()[i]) + weight_b * DVec3(b.pixels()[i]));
        return a;
    }

    Settings settings_;
    TbbExecutor executor_;
    Kind kind_;
    std::array<detail::AnySession, 2> halves_;
    bool cancelled_ = false;
};

/// Renders and denoises: `render_denoised(scene, PathTracerNee{}, Regression{}, {.samples = 64}).image`. The error that
/// the budget may name is that of the denoised image. Guides are rendered first, which no budget counts. Deterministic
/// as `render`, if the reconstructor is.
template <class SceneType, class M, Reconstructor R>
Mixed render_denoised(const SceneType& scene, const M& method, const R& reconstructor, const Budget& budget = {},
                      const Settings& settings = {}) {
    Settings of_guides = settings;
    of_guides.observer = {};
    Guides guides = render_guides(scene, 64, of_guides);
    if constexpr (requires { reconstructor.prepare(guides); }) guides = reconstructor.prepare(guides);
    HalvedSession session(scene, method, settings);
    session.run(budget, reconstructor, guides);
    return session.reconstruct(reconstructor, guides);
}

}  // namespace lightswitch
