#include <lightswitch/compare/metrics.hpp>
#include <lightswitch/compiled.hpp>
#include <lightswitch/reconstruct/denoise.hpp>
#include <lightswitch/scene/stock.hpp>

#include "../support/errors.hpp"
#include "../support/relative.hpp"
#include "noisy_images.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

DiffuseScene small_cornell_box() {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.resize(64, 64);
    return build_as<DiffuseScene>(description);
}

/// Calls `test` with every reconstructor that is there.
void for_each_reconstructor(auto&& test) {
    test(Regression{});
    if (const auto reason = Oidn::why_not()) MESSAGE("skipped: oidn, as " << *reason);
    else test(Oidn(1));
}

}  // namespace

TEST_CASE("reconstructors: less noise, the same for any number of threads, black stays black") {
    const Image truth = true_image(64, 50), noisy = with_noise(truth, 0.3, 4);
    Guides guides{.albedo = truth, .normal = {}};  // which has the texture, but not the lamp's brightness
    for (Rgb& pixel : guides.albedo.pixels()) pixel = min(pixel, Rgb(1));
    const Guides no_guides;
    const Image none;
    for_each_reconstructor([&](const auto& reconstructor) {
        const auto make = [&](const Image& image, int threads) {
            return reconstructor.reconstruct({image, none, image.width() == truth.width() ? guides : no_guides},
                                             TbbExecutor(threads));
        };
        const Image once = make(noisy, 1);
        CHECK(relmse(once, truth) < relmse(noisy, truth) / 2);
        CHECK(make(noisy, 2).pixels() == once.pixels());
        CHECK(make(noisy, 7).pixels() == once.pixels());
        for (const auto& size : {std::pair(1, 1), std::pair(2, 1), std::pair(1, 37), std::pair(17, 3)}) {
            const Image black(size.first, size.second);
            const Image made = make(black, 1);
            for (const Rgb& pixel : made.pixels()) CHECK(length_squared(pixel) < 1e-6f);
            Image grey = black;
            for (const float value : {1e-30f, 1.0f, 1e30f}) {
                for (Rgb& pixel : grey.pixels()) pixel = Rgb(value);
                for (const Rgb& pixel : make(grey, 1).pixels()) {
                    CHECK(is_finite(pixel));
                    // A network is not exact, least of all on so few pixels.
                    if (reconstructor.name == Regression::name) CHECK(pixel.y / value == relative(1, 1e-3));
                }
            }
        }
        Image broken = noisy;
        broken(3, 2).z = infinity;
        CHECK(message_of([&] { make(broken, 1); }).find("not finite in pixel (3, 2)") != std::string::npos);
    });
}

TEST_CASE("render_denoised: nearer to the truth than the samples, by a few lines") {
    const DiffuseScene scene = small_cornell_box();
    const Image truth = render(scene, PathTracerNee{}, {.samples = 1024}, {.seed = 9});
    for_each_reconstructor([&](const auto& reconstructor) {
        const Mixed mixed = render_denoised(scene, PathTracerNee{}, reconstructor, {.samples = 17});
        const Image samples = render(scene, PathTracerNee{}, {.samples = 17});
        MESSAGE(reconstructor.name << ": " << relmse(mixed.image, truth) / relmse(samples, truth)
                                   << " of relMSE is left");
        // 0.71 and 0.26 when this was written; 17 samples of a box whose lamp's edges have nearly all of the error.
        CHECK(relmse(mixed.image, truth) < (reconstructor.name == Oidn::name ? 0.5 : 0.85) * relmse(samples, truth));
        CHECK(mixed.image.metadata.at("denoised") == reconstructor.name);
        CHECK(mixed.image.metadata.at("kind") == "consistent");
        CHECK(mixed.image.metadata.at("samples") == "17");
        CHECK(mixed.relative_error > 0);
        CHECK(mixed.relative_error < 1);
    });
}

TEST_CASE("HalvedSession: continued or not, on any number of threads, the same image") {
    const DiffuseScene scene = small_cornell_box();
    const Guides guides = render_guides(scene, 4);
    const Regression own;
    HalvedSession once(scene, PathTracerNee{}, {.seed = 5, .threads = 1});
    once.run({.samples = 7}, own, guides);
    HalvedSession often(scene, PathTracerNee{}, {.seed = 5, .threads = 2});
    for (const int samples : {1, 4, 7}) often.run({.samples = samples}, own, guides);
    CHECK(once.image().pixels() == often.image().pixels());
    CHECK(once.reconstruct(own, guides).image.pixels() == often.reconstruct(own, guides).image.pixels());
    CHECK(once.statistics().iterations == 7);

    // Its samples are those of two renders.
    const Image a = render(scene, PathTracerNee{}, {.samples = 4}, {.seed = 5});
    const Image b = render(scene, PathTracerNee{}, {.samples = 3}, {.seed = HalvedSession::second_seed(5)});
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        CHECK(once.image().pixels()[i].x ==
              relative((4 * double(a.pixels()[i].x) + 3 * double(b.pixels()[i].x)) / 7, 1e-5));
}

TEST_CASE("HalvedSession: one sample has no halves; an error ends it; a stop keeps what is done") {
    const DiffuseScene scene = small_cornell_box();
    const Guides guides = render_guides(scene, 4);
    const Regression own;
    HalvedSession session(scene, PathTracerNee{});
    session.run({.samples = 1}, own, guides);
    const Mixed single = session.reconstruct(own, guides);
    CHECK(!single.image.first_not_finite());
    CHECK(std::isinf(single.relative_error));

    session.run({.samples = 4096, .error = 0.2}, own, guides);
    CHECK(session.samples() < 1000);
    CHECK(session.reconstruct(own, guides).relative_error < 0.2);

    std::stop_source stop;
    stop.request_stop();
    HalvedSession stopped(scene, PathTracerNee{}, {.stop = stop.get_token()});
    stopped.run({.samples = 8}, own, guides);
    CHECK(stopped.samples() == 0);
    CHECK(stopped.statistics().cancelled);
}

TEST_CASE("Oidn: what is missing is told") {
    if (!Oidn::why_not()) return;
    CHECK(message_of([] { Oidn oidn; }).find("LIGHTSWITCH_OIDN") != std::string::npos);
}
