// Scenes where one side cannot make what the other does, and where light stands closer than anything that an image
// resolves.

#include "verify/planted/scenes.hpp"

#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/photon_mapping.hpp>
#include <lightswitch/verify/verify.hpp>

#include <doctest/doctest.h>

#include <sstream>

using namespace lightswitch;

namespace {

/// A grey floor under a point lamp off the middle.
LibraryDescription lamp_above_floor(double height) {
    auto scene = test::empty_view<AnyMaterial>("lamp-above-floor", {0, 2, 0.01}, {0, 0, 0}, 45);
    scene.add(test::level({0, 0, 0}, 0.8, 0.8), scene.add(Lambert{Rgb(0.5f)}));
    scene.add(PointSource{{0.013, height, 0.007}, Rgb(1)});
    return scene;
}

/// The same with a ball of glass that throws a caustic.
LibraryDescription caustic() {
    LibraryDescription scene = lamp_above_floor(1);
    scene.add(Sphere{{0, 0.3, 0}, 0.2}, scene.add(Dielectric{}));
    return scene;
}

FullScene build(const LibraryDescription& description) { return build_scene<AllBsdfs, AllLights>(description); }

VerifyOptions limited(int images, std::uint64_t seed = 0) {
    return {.seconds = 0, .tolerance = 0, .path_lengths = 3, .seed = seed, .images = images, .samples = 1};
}

/// Path tracing whose direct light is too strong by a fraction; it does not say what it cannot make unless asked to.
template <bool says>
struct Brighter {
    static constexpr std::string_view name = "brighter";
    static constexpr Kind kind = Kind::unbiased;
    static constexpr PathClasses cannot_make = says ? PathTracerNee::cannot_make : PathClasses{};
    int max_depth = -1;
    float excess = 0;

    Rgb radiance(const auto& scene, const Ray& ray, auto& sampler) const {
        return (1 + excess) * PathTracerNee{.max_depth = max_depth}.radiance(scene, ray, sampler);
    }
};

}  // namespace

// False alarms: 1e-3 for each of the runs as stated.
TEST_CASE("a spot smaller than a pixel, or than the radius of a photon, is no difference") {
    for (const double height : {0.1, 0.01, 1e-4}) {
        const FullScene scene = build(lamp_above_floor(height));
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            CAPTURE(height);
            CAPTURE(seed);
            const Verdict nee = verify(scene, PathTracerNee{}, Bdpt{}, limited(81, seed));
            CHECK_MESSAGE(!nee.disagrees(), nee);
            const Verdict photon = verify(scene, PhotonMapping{}, Bdpt{}, limited(16 << 5, seed));
            CHECK_MESSAGE(!photon.disagrees(), photon);
        }
    }
}

TEST_CASE("the brightest event under a point lamp is right below it, over the probability of choosing it") {
    for (const double height : {1.0, 0.01, 1e-4}) {
        const FullScene scene = build(lamp_above_floor(height));
        const double h = double(scene.length(height)), unit = double(scene.length(1)), intensity = unit * unit;
        const double right = 0.5 / double(pi) * intensity / (h * h);
        CHECK(double(brightest_event(scene).x) > 0.95 * right);
        CHECK(double(brightest_event(scene).x) < 1.01 * right);
    }
    LibraryDescription two = lamp_above_floor(0.1);
    two.add(PointSource{{0.4, 0.1, 0}, Rgb(1)});
    const float one = brightest_event(build(lamp_above_floor(0.1))).x;
    CHECK(brightest_event(build(two)).x > 1.9f * one);
    CHECK(brightest_event(build(two)).x < 2.1f * one);
}

// False alarms: 1e-3 each.
TEST_CASE("a method is compared in what both can make, and the report says what that leaves out") {
    const FullScene scene = build(caustic());
    VerifyOptions options = limited(400);
    options.tolerance = 0.04;
    const Verdict verdict = verify(scene, PathTracerNee{}, Bdpt{}, options);
    CHECK_MESSAGE(verdict.agrees(), verdict);
    CHECK(verdict.left_out == PathClasses{.dirac_caustic = true});
    std::ostringstream text;
    text << verdict;
    CHECK(text.str().find("only one of them makes it: caustics of point and directional lights") != std::string::npos);
    CHECK(verdict.reason.find("Outside the comparison") != std::string::npos);
    // It can be either side that leaves them out.
    const Verdict turned = verify(scene, Bdpt{}, PathTracerNee{}, options);
    CHECK_MESSAGE(turned.agrees(), turned);
    CHECK(turned.left_out == verdict.left_out);
    // What is wrong with the rest is still found.
    const Verdict wrong = verify(scene, Brighter<true>{.excess = 0.03f}, Bdpt{}, limited(400));
    CHECK_MESSAGE(wrong.disagrees(), wrong);
    const Verdict silent = verify(scene, Brighter<false>{}, Bdpt{}, limited(400));
    CHECK_MESSAGE(silent.disagrees(), silent);  // it lacks caustics and does not say so
}

// False alarms: 1e-3 each.
TEST_CASE("the side that makes more is not accused of being brighter") {
    const FullScene scene = build(caustic());
    const Verdict more = verify(scene, PhotonMapping{}, PathTracerNee{}, limited(16 << 4));
    CHECK_MESSAGE(more.answer == Verdict::Answer::undecided, more);
    CHECK(more.reference_lacks == PathClasses{.dirac_caustic = true, .mirrored_dirac_caustic = true});
    CHECK(more.reason.find("path-nee cannot make caustics") != std::string::npos);
    // Of Dirac lights `path` sees nothing at all.
    const Verdict blind = verify(scene, Brighter<true>{}, PathTracer{}, limited(81));
    CHECK_MESSAGE(blind.answer == Verdict::Answer::undecided, blind);
    CHECK(blind.reference_lacks == PathClasses{.dirac_light = true});
    // But never of being darker for no reason, nor for short paths, which both can make.
    const Verdict darker = verify(scene, Brighter<false>{.excess = -0.1f}, PathTracerNee{}, limited(200));
    CHECK_MESSAGE(darker.disagrees(), darker);
    const Verdict direct = verify(scene, Brighter<false>{.excess = 0.1f}, PathTracerNee{}, limited(200));
    CHECK_MESSAGE(direct.disagrees(), direct);
    CHECK(direct.first_wrong_length == 2);
}

TEST_CASE("a depth that is too short for the paths in question makes everything comparable") {
    const FullScene scene = build(caustic());
    CHECK(estimator(scene, PathTracerNee{}).missing ==
          PathClasses{.dirac_caustic = true, .mirrored_dirac_caustic = true});
    CHECK(!estimator(scene, PathTracerNee{.max_depth = 2}).missing.any());
    const FullScene diffuse = build(lamp_above_floor(1));
    CHECK(!estimator(diffuse, PathTracerNee{}).missing.any());
}

TEST_CASE("images are made where the noise is") {
    // The same method on both sides, one with 16 times the samples: its images have a sixteenth of the variance.
    const Estimator plain = test::library_nee(test::small_box());
    Estimator quiet = plain;
    quiet.render = [&plain](const Estimator::Request& request) {
        Estimator::Request more = request;
        more.iterations *= 16;
        return plain.render(more);
    };
    VerifyOptions options = limited(1 << 20);
    options.tolerance = 0.1;
    const Verdict verdict = verify(plain, quiet, options);
    CHECK_MESSAGE(verdict.agrees(), verdict);
    CHECK(verdict.images > 2 * verdict.reference_images);
}
