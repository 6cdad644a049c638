// Reports of comparisons and of verdicts: what their curves join, and what they say of the reference's own noise.

#include "support/errors.hpp"
#include "support/relative.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/report/verdict_report.hpp>
#include <lightswitch/scene/stock.hpp>
#include <lightswitch/verify/verify.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace lightswitch;
using lightswitch::test::message_of;

namespace {

/// An image of 1 with noise of a standard deviation of `noise / sqrt(samples)`, as a file of that method would be.
Image noisy(double noise, int samples, unsigned seed, Image::Metadata metadata = {}) {
    std::mt19937 engine(seed);
    std::normal_distribution<float> error(0, float(noise / std::sqrt(samples)));
    Image image(64, 64);
    for (Rgb& p : image.pixels()) p = Rgb(1) + Rgb(error(engine), error(engine), error(engine));
    image.metadata = std::move(metadata);
    image.metadata["samples"] = std::to_string(samples);
    return image;
}

DiffuseScene small_box() {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 16;
    return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
}

}  // namespace

TEST_CASE("comparison: a curve joins images of one method only") {
    const std::vector<ComparedImage> images{
        {"a64", noisy(1, 64, 1, {{"method", "a"}, {"sampling", "sobol"}, {"seconds", "6.5"}})},
        {"a16", noisy(1, 16, 2, {{"method", "a"}, {"sampling", "sobol"}, {"seconds", "1.5"}})},
        {"b32", noisy(9, 32, 3, {{"method", "b"}, {"seconds", "3"}})},
        {"a32 other points", noisy(1, 32, 4, {{"method", "a"}, {"sampling", "independent"}})},
        {"picture", noisy(9, 4, 5, {{"method", "phong"}, {"kind", "heuristic"}})},
        {"of another renderer", noisy(2, 8, 6)},
        {"truth", noisy(0, 1, 7, {{"method", "a"}})}};
    const Report report = comparison_report(images, 6);
    std::vector<std::string> names;
    for (const ReportCurve& curve : report.curves) names.push_back(curve.name);
    CHECK(names == std::vector<std::string>{"a", "b", "a, independent points", "of another renderer"});
    REQUIRE(report.curves[0].points.size() == 2);
    CHECK(report.curves[0].points[0].samples == 16);
    CHECK(report.curves[0].points[0].seconds == 1.5);
    CHECK(report.curves[0].points[1].samples == 64);
    CHECK(report.curves[0].points[1].seconds == 6.5);
    CHECK(report.curves[0].points[1].error == std::sqrt(relmse(images[0].image, images[6].image)));
    CHECK(report.curves[1].points.size() == 1);
    CHECK(report.images.size() == 7);
    CHECK(report.maps.size() == 6);
    CHECK(report.reference == 6);
    CHECK(!report.reference_noise);  // nothing is known of it
    CHECK(message_of([&] { comparison_report(images, 7); }) == "a comparison needs images, and a reference among them");
}

TEST_CASE("comparison: a rendered image says how long it took") {
    const DiffuseScene scene = small_box();
    Session session(scene, PathTracerNee{});
    session.run({.samples = 2});
    CHECK(metadata_number(session.image(), "seconds") ==
          lightswitch::test::relative(session.statistics().seconds, 1e-3).or_absolute(1e-6));
    CHECK(metadata_number(session.image(), "samples") == 2);
    CHECK(metadata_number(session.image(), "method") == 0);
}

// The noise of 64 x 64 x 3 values is known to 1/sqrt(2 * 12288) = 0.6 %; of the level, a difference of such numbers,
// within 5 %.
TEST_CASE("comparison: the level at which curves end is the noise of the reference") {
    const auto curve_against = [](double method_noise, const Image& reference, double bias = 0) {
        ReportCurve curve{"curve", {}};
        for (int samples = 4; samples <= 1024; samples *= 2) {
            Image image = noisy(method_noise, samples, unsigned(samples));
            for (Rgb& p : image.pixels()) p += Rgb(float(bias));
            curve.points.push_back({1, double(samples), std::sqrt(relmse(image, reference))});
        }
        return curve;
    };
    const Image exact = noisy(0, 1, 1), rough = noisy(1, 256, 99);
    const double noise = std::sqrt(relmse(rough, exact));
    CHECK(noise == lightswitch::test::relative(1.0 / 16, 0.03));

    const auto level = detail::level_of(curve_against(1, rough));
    REQUIRE(level);
    CHECK(*level == lightswitch::test::relative(noise, 0.05));
    CHECK(!detail::level_of(curve_against(1, exact)));
    CHECK(!detail::level_of(curve_against(8, rough)));  // its own noise hides it
    // A biased method ends higher: the lower of the two is nearer to the reference's noise.
    const std::vector<ReportCurve> both{curve_against(1, rough, 0.1), curve_against(1, rough)};
    REQUIRE(detail::level_of(both[0]));
    CHECK(*detail::level_of(both[0]) > 1.5 * noise);
    CHECK(detail::lowest_level(both) == level);
    CHECK(detail::lowest_level(std::vector{both[1], both[0]}) == level);

    // Two points have no level, but show that the other's is not the reference's noise.
    const ReportCurve below{"below", {{1, 1, 2 * noise}, {1, 2, 1.2 * noise}}};
    CHECK(!detail::lowest_level(std::vector{both[0], below}));
    CHECK(!detail::lowest_level({}));
    CHECK(!detail::level_of({"two points", {{1, 1, 1}, {1, 100, 1}}}));
    CHECK(!detail::level_of({"near", {{1, 1, 1}, {1, 2, 1}, {1, 3, 1}}}));
    const double nan = std::nan("");
    CHECK(!detail::level_of({"none", {{1, 1, nan}, {1, 10, 0}, {1, 100, 1}, {1, 0, 1}}}));
}

// As above: the noise within 3 %.
TEST_CASE("comparison: an image by the reference's method with another seed tells the reference's noise") {
    const auto metadata = [](const char* seed) {
        return Image::Metadata{{"method", "a"}, {"kind", "unbiased"}, {"sampling", "sobol"}, {"seed", seed}};
    };
    const auto noise_of = [](std::vector<ComparedImage> images) {
        return comparison_report(images, 0).reference_noise;
    };
    const ComparedImage truth{"truth", noisy(1, 256, 1, metadata("1"))}, other{"other", noisy(1, 64, 2, metadata("2"))};
    ComparedImage few{"few", noisy(1, 4, 3, metadata("3"))};
    for (const auto& images :
         {std::vector{truth, other}, std::vector{truth, few, other}, std::vector{truth, other, few}}) {
        const auto noise = noise_of(images);
        REQUIRE(noise);
        CHECK(*noise == lightswitch::test::relative(1.0 / 16, 0.03));
    }
    for (const char* key : {"seed", "method", "sampling"}) {
        ComparedImage changed = other;
        changed.image.metadata[key] = key == std::string("seed") ? "1" : "x";
        CHECK(!noise_of({truth, changed}));
    }
}

TEST_CASE("comparison: a render is measured on its way") {
    const DiffuseScene scene = small_box();
    const Image reference = render(scene, PathTracerNee{}, {.samples = 64}, {.seed = 1});
    int observed = 0;
    Settings settings{.seed = 5};
    settings.observer = [&](const Progress&) { ++observed; };
    const ComparedImage one = render_measured(scene, PathTracerNee{}, reference, {.samples = 11}, settings);
    CHECK(observed == 11);
    CHECK(one.name == "path-nee");
    const Image same = render(scene, PathTracerNee{}, {.samples = 11}, {.seed = 5});
    CHECK(one.image.pixels() == same.pixels());
    std::vector<double> samples;
    for (const auto& p : one.history) samples.push_back(p.samples);
    CHECK(samples == std::vector<double>{1, 2, 4, 8, 11});
    CHECK(one.history.back().error == std::sqrt(relmse(one.image, reference)));
    for (std::size_t i = 1; i < one.history.size(); ++i) CHECK(one.history[i].seconds > one.history[i - 1].seconds);

    const Report report = comparison_report(std::vector<ComparedImage>{{"reference", reference}, one}, 0);
    REQUIRE(report.curves.size() == 1);
    CHECK(report.curves[0].points.size() == 5);
    CHECK(report_html(report).find("path-nee") != std::string::npos);
}

TEST_CASE("verdicts: one page for all of a run, each thing explained once") {
    const DiffuseScene scene = small_box();
    const VerifyOptions options{.seconds = 0, .tolerance = 0, .path_lengths = 2, .images = 24, .samples = 1};
    const std::vector<Verdict> verdicts =
        Verification(estimator(scene, PathTracer{}),
                     {estimator(scene, PathTracerNee{}), estimator(scene, PathTracer{})}, options)
            .run();
    REQUIRE(verdicts.size() == 2);
    const Report report = verdict_report("box", verdicts);
    CHECK(report.title == "box");
    CHECK(report.images.size() == 3);
    CHECK(report.reference == 0);
    CHECK(report.curves.size() == 2);
    CHECK(report.reference_noise == detail::lowest_level(report.curves));
    CHECK(report.histograms.size() == 2);
    REQUIRE(report.tables.size() == 3);
    CHECK(report.tables[0].rows.size() == 2);
    CHECK(report.tables[2].rows.size() == verdicts[0].parts.size() + verdicts[1].parts.size());
    CHECK(report.tables[2].rows.front().front() == "path-nee");
    CHECK(report.tables[2].rows.back().front() == "path");
    CHECK(report.summary.find("\n\npath ") != std::string::npos);
    CHECK(report_html(report).find("By path length") != std::string::npos);
    CHECK(verdict_report("one", verdicts[0]).images.size() == 2);
    CHECK(message_of([] { verdict_report("none", std::vector<Verdict>{}); }) ==
          "a report of verdicts needs one at least");
}
