#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/reconstruct/mix.hpp>

#include "../support/errors.hpp"
#include "../support/relative.hpp"
#include "noisy_images.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

double relative_rmse(const Image& image, const Image& truth) {
    const DVec3 mean = truth.mean();
    return std::sqrt(mse(image, truth)) / ((mean.x + mean.y + mean.z) / 3);
}

double square_of(double x) { return x * x; }

/// `make(which)` for every cheat, with its name in what doctest prints.
void for_each_cheat(auto&& make) {
    for (const Cheat which : all_cheats) {
        CAPTURE(cheat_names[static_cast<std::size_t>(which)]);
        make(which);
    }
}

}  // namespace

TEST_CASE("mix: whatever the reconstructor does, relMSE is at most 1.2 times that of the samples") {
    const Image truth = true_image(96, 80);
    for (const double noise : {2.0, 0.5, 0.1, 0.02, 0.001})
        for_each_cheat([&](Cheat which) {
            const MixOfNoise made(truth, noise, which, 7);
            const double raw = relmse(made.samples, truth), mixed = relmse(made.mixed.image, truth);
            CAPTURE(noise);
            CHECK(mixed <= 1.2 * raw);
            if (which == Cheat::right) CHECK(mixed <= 0.05 * raw);
            if (which == Cheat::blurs) CHECK(mixed <= 1.1 * std::min(raw, relmse(made.denoised, truth)));
        });
}

TEST_CASE("mix: at 10 % of noise all that cheats is contradicted, and what is right is not") {
    const Image truth = true_image(96, 80);
    for_each_cheat([&](Cheat which) {
        const MixOfNoise made(truth, 0.1, which, 3);
        // An image of one colour has no detail that could be compared.
        const bool cheats =
            which == Cheat::blurs || which == Cheat::clamps || which == Cheat::same_image || which == Cheat::black;
        REQUIRE(made.mixed.contradiction.has_value() == cheats);
        if (!cheats) return;
        CHECK(made.mixed.contradiction->ratio > 40);
        CHECK(made.mixed.contradiction->share > 0.5);
    });
}

TEST_CASE("mix: false alarms") {
    // Of 60 images with noise of 50 %, of which 1 % raise one (as measured): more than 4 have a chance of 3e-4. With
    // rare bright pixels, once in 30 and then 30 times too large, 3 %: more than 8 have 3e-4.
    const Image truth = true_image(96, 80);
    const auto alarms = [&](double tail) {
        int count = 0;
        for (unsigned seed = 0; seed < 60; ++seed)
            count += MixOfNoise(truth, 0.5, Cheat::right, 1000 + seed, tail).mixed.contradiction.has_value();
        MESSAGE(count << " false alarms of 60");
        return count;
    };
    CHECK(alarms(1) <= 4);
    CHECK(alarms(30) <= 8);
}

TEST_CASE("mix: the error of the result is about what it says") {
    const Image truth = true_image(96, 80);
    for (const double noise : {0.3, 0.1, 0.02})
        for (const Cheat which : {Cheat::right, Cheat::blurs, Cheat::clamps, Cheat::same_image}) {
            CAPTURE(noise);
            CAPTURE(cheat_names[static_cast<std::size_t>(which)]);
            const MixOfNoise made(truth, noise, which, 5);
            // Nearly all of the error is that of the lamp's 64 pixels, so that the standard deviation of what is known
            // of its square is sqrt(2 / 64) times that of the samples. Four of them; 24 numbers: false alarms in 1 of
            // 600.
            const double raw = square_of(relative_rmse(made.samples, truth));
            const double off = square_of(made.mixed.relative_error) - square_of(relative_rmse(made.mixed.image, truth));
            CHECK(std::abs(off) < 4 * std::sqrt(2.0 / 64) * raw);
            CHECK(std::abs(square_of(made.mixed.relative_error_of_samples) - raw) < 4 * std::sqrt(2.0 / 64) * raw);
            // The map, place by place.
            double inside = 0;
            for (std::size_t i = 0; i < truth.pixels().size(); ++i) {
                const Rgb difference = made.mixed.image.pixels()[i] - truth.pixels()[i];
                inside += std::sqrt(length_squared(difference) / 3) <= 2 * made.mixed.error.pixels()[i].x;
            }
            CHECK(inside / double(truth.pixels().size()) > 0.9);
        }
}

TEST_CASE("mix: scale, threads and size of halves") {
    const Image truth = true_image(50, 37);
    const Image a = with_noise(truth, 0.5, 1), b = with_noise(truth, 0.5, 2), joint = mean_of(a, b);
    const auto denoise = [&](const Image& image) { return cheat(Cheat::blurs, image, truth); };
    const auto made = [&](float scale, const auto& executor) {
        const auto scaled = [&](Image image) {
            for (Rgb& pixel : image.pixels()) pixel *= scale;
            return image;
        };
        const Image sa = scaled(a), sb = scaled(b), da = scaled(denoise(a)), db = scaled(denoise(b));
        const Image d = scaled(denoise(joint));
        Mixed mixed = mix({.a = sa, .b = sb, .denoised_a = da, .denoised_b = db, .denoised = d}, executor);
        mixed.image = scaled(mixed.image);
        for (Rgb& pixel : mixed.image.pixels()) pixel /= scale * scale;
        return mixed;
    };
    const Mixed one = made(1, SerialExecutor{});
    for (const int threads : {1, 2, 7}) {
        const Mixed other = made(1, TbbExecutor(threads));
        CHECK(other.image.pixels() == one.image.pixels());
        CHECK(other.error.pixels() == one.error.pixels());
    }
    for (const int exponent : {-50, 30}) {
        const Mixed other = made(std::ldexp(1.0f, exponent), SerialExecutor{});
        CHECK(other.image.pixels() == one.image.pixels());
        CHECK(other.relative_error == one.relative_error);
    }
    // Radiance of 1e-30 and 1e30.
    for (const float scale : {1e-30f, 1e30f}) {
        Image dim = a;
        for (Rgb& pixel : dim.pixels()) pixel *= scale;
        const Mixed mixed =
            mix({.a = dim, .b = dim, .denoised_a = dim, .denoised_b = dim, .denoised = dim}, SerialExecutor{});
        for (std::size_t i = 0; i < dim.pixels().size(); ++i)
            CHECK(mixed.image.pixels()[i].y == relative(dim.pixels()[i].y, 1e-6));
    }
}

TEST_CASE("mix: small, black and broken images") {
    for (const auto& size : {std::pair(1, 1), std::pair(1, 5), std::pair(3, 2), std::pair(33, 1)}) {
        const Image black(size.first, size.second);
        Image grey = black;
        for (Rgb& pixel : grey.pixels()) pixel = Rgb(2);
        for (const Image* image : {&std::as_const(black), &std::as_const(grey)}) {
            const Mixed mixed =
                mix({.a = *image, .b = *image, .denoised_a = black, .denoised_b = grey, .denoised = grey},
                    SerialExecutor{});
            CHECK(!mixed.image.first_not_finite());
            CHECK(!mixed.error.first_not_finite());
            CHECK(!mixed.from_samples.first_not_finite());
        }
    }
    const Image black(4, 4), other(4, 5);
    Image broken = black;
    broken(1, 2).x = infinity;
    const auto attempt = [&](const Image& a, const Image& b, const Image& denoised, std::uint64_t samples_b = 1) {
        return message_of([&] {
            mix({.a = a,
                 .b = b,
                 .samples_b = samples_b,
                 .denoised_a = denoised,
                 .denoised_b = denoised,
                 .denoised = denoised},
                SerialExecutor{});
        });
    };
    CHECK(attempt(black, black, black) == "(no error)");
    CHECK(attempt(black, other, black).find("4 x 5 pixels") != std::string::npos);
    CHECK(attempt(black, black, other).find("denoised image has 4 x 5") != std::string::npos);
    CHECK(attempt(black, broken, black).find("not finite in pixel (1, 2)") != std::string::npos);
    CHECK(attempt(black, black, black, 0).find("two halves") != std::string::npos);
    CHECK(attempt(black, Image(), black).find("two halves") != std::string::npos);
    CHECK(std::isinf(
        mix({.a = black, .b = black, .denoised_a = black, .denoised_b = black, .denoised = black}, SerialExecutor{})
            .relative_error));
}
