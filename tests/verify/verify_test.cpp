// The test of methods: what it finds, what it does not, and when it says that it cannot tell.

#include "support/errors.hpp"
#include "verify/planted/catalogue.hpp"

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/verify/verify.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace lightswitch;
using lightswitch::test::message_of;

namespace {

DiffuseScene small_furnace() {
    LibraryDescription description = stock::describe_furnace();
    description.film.width = description.film.height = 16;
    return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
}

/// A limit that does not depend on the machine.
VerifyOptions limited(int images, int samples) {
    return {.seconds = 0, .tolerance = 0, .images = images, .samples = samples};
}

/// Path tracing, too bright by a fraction that may fall as iterations go on.
template <Kind claimed, bool shrinks>
struct TooBright {
    static constexpr std::string_view name = "too-bright";
    static constexpr Kind kind = claimed;
    double excess = 0.1;

    struct Nothing {};
    Nothing start(auto&) const { return {}; }
    void iterate(auto& frame, Nothing&) const {
        const double falls = shrinks ? std::pow(double(frame.iteration()) + 1, -1.0 / 3) : 1;
        const auto factor = static_cast<float>(1 + excess * falls);
        frame.pixels([&](const Ray& ray, auto& sampler) {
            return factor * PathTracerNee{}.radiance(frame.scene(), ray, sampler);
        });
    }
};

struct NotFinite {
    static constexpr std::string_view name = "not-finite";
    static constexpr Kind kind = Kind::unbiased;
    Rgb radiance(const auto& scene, const Ray& ray, auto& sampler) const {
        const Rgb value = PathTracerNee{}.radiance(scene, ray, sampler);
        return sampler.next_1d() < 1e-3f ? Rgb(std::nanf("")) : value;
    }
};

/// Right, but its depth counts bounces.
struct CountsBounces {
    static constexpr std::string_view name = "counts-bounces";
    static constexpr Kind kind = Kind::unbiased;
    int max_depth = -1;
    Rgb radiance(const auto& scene, const Ray& ray, auto& sampler) const {
        return PathTracer{.max_depth = max_depth < 0 ? -1 : max_depth + 1}.radiance(scene, ray, sampler);
    }
};

std::vector<Image> noise(int count, int width, int height, float level, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> uniform(0.5f, 1.5f);
    std::vector<Image> images;
    for (int n = 0; n < count; ++n) {
        Image image(width, height);
        for (Rgb& p : image.pixels()) p = Rgb(level * uniform(engine));
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace

TEST_CASE("a method of one's own is tested in three lines") {
    const auto scene = stock::furnace();
    const Verdict verdict = verify(scene, PathTracerNee{}, PathTracer{}, {.seconds = 10});
    CHECK_MESSAGE(verdict.agrees(), verdict);
}

TEST_CASE("a wrong one is found out, with its size, its place and its path length") {
    const auto scene = small_furnace();
    Image two(16, 16);
    for (Rgb& p : two.pixels()) p = Rgb(2);
    const Verdict right = verify(scene, PathTracerNee{}, two, limited(64, 4));
    CHECK_MESSAGE(right.agrees(), right);
    const Verdict verdict = verify(scene, TooBright<Kind::unbiased, false>{.excess = 0.02}, two, limited(64, 4));
    CHECK(verdict.disagrees());
    CHECK(verdict.parts.front().interval[0].low > 0.005);
    CHECK(verdict.parts.front().interval[0].low < 0.02);
    CHECK(verdict.parts.front().interval[0].high > 0.02);
}

// False alarms: 1e-3 each by the statement of `verify`, so one in all of them with probability 0.05; the seeds are
// fixed. This is the other direction: every bug must be found, with few samples.
TEST_CASE("planted bugs are found, at the right path length") {
    for (const auto& bug : test::planted_bugs()) {
        const auto [wrong, right] = bug.make();
        const Verdict verdict = verify(wrong, right, limited(1500, 8));
        INFO(bug.name, " in ", bug.scene, ": ", verdict);
        CHECK(verdict.disagrees());
        CHECK(verdict.correlated_pixels == bug.correlated);
        CHECK(verdict.first_wrong_length == bug.first_length);
    }
}

// Each pair disagrees with a probability of at most 1e-3: three of 100 with 1.5e-4. (1000 runs: bench/verify.)
TEST_CASE("right methods are not accused") {
    std::vector<std::pair<Estimator, Estimator>> pairs;
    for (const auto& pair : test::correct_pairs()) pairs.push_back(pair.make());
    int alarms = 0;
    for (std::size_t run = 0; run < 100; ++run) {
        VerifyOptions options = limited(36, 1);
        options.seed = 1000 + run;
        const auto& [a, b] = pairs[run % pairs.size()];
        const Verdict verdict = verify(a, b, options);
        if (verdict.disagrees()) MESSAGE(verdict);
        alarms += verdict.disagrees();
    }
    CHECK(alarms < 3);
}

TEST_CASE("few rare bright paths leave it undecided, and it says why") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 16;
    // A lamp a hundredth as large, and as much brighter.
    auto& lamp = std::get<Mesh>(description.shapes[5].geometry);
    for (DVec3& p : lamp.positions) p = {0.1 * p.x, p.y, 0.1 * p.z};
    description.shapes[5].emission = Rgb(1800, 1400, 700);
    const auto scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    VerifyOptions options = limited(40, 4);
    options.tolerance = 0.01;
    const Verdict verdict = verify(scene, PathTracer{}, PathTracerNee{}, options);
    INFO(verdict);
    CHECK(verdict.answer == Verdict::Answer::undecided);
    CHECK(verdict.reason.find("rare bright paths") != std::string::npos);
    CHECK(verdict.events < 1000);
}

TEST_CASE("the verdict is a function of scene, methods, options and seed") {
    const auto scene = small_furnace();
    const auto run = [&](int threads, std::uint64_t seed) {
        VerifyOptions options = limited(24, 2);
        options.threads = threads;
        options.seed = seed;
        return verify(scene, PathTracerNee{}, PathTracer{}, options);
    };
    const Verdict a = run(1, 0), b = run(3, 0), c = run(1, 1);
    REQUIRE(a.parts.size() == 7);
    for (std::size_t i = 0; i < a.parts.size(); ++i) {
        CHECK(a.parts[i].p == b.parts[i].p);
        CHECK(a.parts[i].bias == b.parts[i].bias);
        CHECK(a.parts[i].interval[0].low == b.parts[i].interval[0].low);
    }
    CHECK(a.image.pixels() == b.image.pixels());
    CHECK(a.parts[0].bias != c.parts[0].bias);
}

// 16 images per look and tile; false alarms as stated, 1e-3.
TEST_CASE("a consistent method's bias must shrink") {
    const auto scene = small_furnace();
    VerifyOptions options = limited(16 << 8, 1);  // 256 times the samples of the first look
    options.path_lengths = 0;
    const Verdict shrinking = verify(scene, TooBright<Kind::consistent, true>{}, PathTracerNee{}, options);
    CHECK_MESSAGE(!shrinking.disagrees(), shrinking);
    const Verdict constant = verify(scene, TooBright<Kind::consistent, false>{}, PathTracerNee{}, options);
    CHECK_MESSAGE(constant.disagrees(), constant);
    CHECK(constant.reason.find("does not shrink") != std::string::npos);
    // The same that claims to be unbiased is found out at once.
    CHECK(verify(scene, TooBright<Kind::unbiased, true>{}, PathTracerNee{}, options).disagrees());
}

TEST_CASE("contributions that are not finite are no agreement") {
    const auto scene = small_furnace();
    const Verdict verdict = verify(scene, NotFinite{}, PathTracerNee{}, limited(16, 1));
    CHECK(verdict.disagrees());
    CHECK(verdict.non_finite > 0);
    // The reference's are not the method's fault, and nothing can be said.
    const Verdict other =
        verify(scene, PathTracerNee{}, NotFinite{}, {.seconds = 0, .tolerance = 0.5, .images = 16, .samples = 1});
    CHECK(!other.agrees());
    CHECK(other.reference_non_finite > 0);
    if (!other.disagrees()) CHECK(other.reason.find("of the reference") != std::string::npos);
}

// A path tracer that has not met the bulb yet must not be thought to be without it. False alarm: 1e-3 per seed.
TEST_CASE("a small bulb beside a large lamp is no difference") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 16;
    auto bulb = description.shapes[5];
    for (DVec3& p : std::get<Mesh>(bulb.geometry).positions) p = {0.01 * p.x + 0.5, p.y - 0.3, 0.01 * p.z};
    bulb.emission = Rgb(5e4f);
    description.shapes.push_back(bulb);
    const auto scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        VerifyOptions options = limited(36, 1);
        options.seed = seed;
        const Verdict verdict = verify(scene, PathTracerNee{}, PathTracer{}, options);
        CHECK_MESSAGE(verdict.answer == Verdict::Answer::undecided, verdict);
    }
}

TEST_CASE("without a tolerance, too little is known to agree") {
    const auto scene = stock::cornell_box();
    const Verdict verdict =
        verify(scene, PathTracerNee{}, PathTracer{}, {.seconds = 0, .tolerance = 0, .images = 4, .samples = 1});
    CHECK(verdict.answer == Verdict::Answer::undecided);
}

TEST_CASE("depths that are counted otherwise are named as a possible cause") {
    const Verdict verdict = verify(small_furnace(), CountsBounces{}, PathTracer{}, limited(24, 1));
    CHECK(verdict.disagrees());
    CHECK(verdict.first_wrong_length == 1);
    CHECK_MESSAGE(verdict.reason.find("PathLength") != std::string::npos, verdict);
}

// False alarm of the first: 1e-3.
TEST_CASE("images that are given: the same test") {
    const Estimator a = given(noise(24, 40, 30, 1, 1), "a"), b = given(noise(20, 40, 30, 1, 2), "b");
    const Verdict same = verify(a, b, {.seconds = 10, .tolerance = 0.02});
    CHECK_MESSAGE(same.agrees(), same);
    CHECK(same.images == 24);
    CHECK(same.reference_images == 20);
    const Verdict other = verify(given(noise(24, 40, 30, 1.02f, 3), "brighter"), b, {.seconds = 10});
    CHECK_MESSAGE(other.disagrees(), other);
    CHECK(other.first_wrong_length == 0);  // files do not tell lengths apart
    const Verdict few = verify(given(noise(2, 40, 30, 1, 3), "few"), b, {.seconds = 10});
    CHECK(few.answer == Verdict::Answer::undecided);
    CHECK(few.reason.find("too few images") != std::string::npos);
}

TEST_CASE("what cannot be compared is refused, in words") {
    const auto scene = small_furnace();
    CHECK(message_of([&] { verify(scene, Phong{}, PathTracer{}); }).find("phong is heuristic") == 0);
    CHECK(message_of([&] {
              verify(scene, PathTracer{}, Silhouette{});
          }).find("the reference must be unbiased: silhouette") == 0);
    CHECK(message_of([&] { verify(scene, PathTracer{}, Image(8, 8), limited(3, 1)); }) ==
          "images of different size cannot be compared: 16 x 16 and 8 x 8 pixels");
    auto broken = noise(4, 8, 8, 1, 1);
    broken[2](3, 5).y = std::nanf("");
    CHECK(message_of([&] { verify(given(broken, "x"), given(noise(4, 8, 8, 1, 2), "y")); }) ==
          "image 3 of x is not finite in pixel (3, 5): nothing can be said of it");
    auto unequal = noise(4, 8, 8, 1, 1);
    unequal[1] = Image(8, 9);
    CHECK(message_of([&] {
              verify(given(unequal, "x"), given(noise(4, 8, 8, 1, 2), "y"));
          }).find("the images of x differ in size") == 0);
    Estimator files = given(noise(4, 8, 8, 1, 1), "files");
    files.kind = Kind::consistent;
    CHECK(message_of([&] { verify(files, given(noise(4, 8, 8, 1, 2), "y")); }).find("files is consistent") == 0);
    auto other = noise(4, 8, 8, 1, 1);
    other[0].metadata["scene"] = "one";
    auto others = noise(4, 8, 8, 1, 2);
    others[0].metadata["scene"] = "two";
    CHECK(message_of([&] { verify(given(other, "x"), given(others, "y")); }).find("images with a different scene") ==
          0);
    CHECK(message_of([] { given({}, "none"); }) == "none: there are no images");
    CHECK(message_of([&] { verify(scene, PathTracer{}, PathTracer{}, {.confidence = 1}); }).find("the confidence") ==
          0);
    CHECK(message_of([&] { verify(scene, PathTracer{}, PathTracer{}, {.tolerance = -1}); }).find("the tolerance") == 0);
    CHECK(message_of([&] { verify(scene, PathTracer{}, PathTracer{}, {.seconds = 0}); }).find("verify needs a limit") ==
          0);
}

TEST_CASE("it can be stopped, and says what it knows") {
    const auto scene = small_furnace();
    std::stop_source stop;
    VerifyOptions options{.seconds = 60, .tolerance = 0, .stop = stop.get_token()};
    std::uint64_t seen = 0;
    options.observer = [&](const VerifyProgress& progress) {
        seen = std::max(seen, progress.images);
        if (progress.images >= 16 && progress.method == "path-nee") stop.request_stop();
    };
    const Verdict verdict = verify(scene, PathTracerNee{}, PathTracer{}, options);
    CHECK(seen >= 16);
    CHECK(verdict.seconds + verdict.reference_seconds < 30);
    CHECK(verdict.images >= 16);
    CHECK(!verdict.parts.empty());
    stop.request_stop();
    CHECK(verify(scene, PathTracerNee{}, PathTracer{}, options).answer == Verdict::Answer::undecided);
}

TEST_CASE("after every look it tells what the verdict would be, which leaves the last one as it is") {
    const auto scene = small_furnace();
    VerifyOptions options = limited(200, 2);
    const Verdict alone = verify(scene, PathTracerNee{}, PathTracer{}, options);
    std::vector<Verdict> looks;
    options.looked = [&](const Verdict& verdict) { looks.push_back(verdict); };
    const Verdict verdict = verify(scene, PathTracerNee{}, PathTracer{}, options);
    REQUIRE(looks.size() >= 2);
    for (std::size_t i = 1; i < looks.size(); ++i) {
        CHECK(looks[i].images > looks[i - 1].images);
        CHECK(looks[i].method == "path-nee");
        CHECK(!looks[i].reason.empty());
    }
    CHECK(looks.back().answer == verdict.answer);
    CHECK(looks.back().reason == verdict.reason);
    CHECK(looks.back().images == verdict.images);
    CHECK(verdict.answer == alone.answer);
    CHECK(verdict.images == alone.images);
    CHECK(verdict.parts.front().bias == alone.parts.front().bias);
    CHECK(verdict.curve.size() == alone.curve.size());
}
