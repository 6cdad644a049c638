// Sweeps of methods whose errors are known. Where they take no time every image is one iteration and the run is the
// same each time; where they do, the number of iterations depends on the machine, and false-alarm rates are stated.

#include "support/errors.hpp"
#include "support/fake_contender.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/method/phong.hpp>
#include <lightswitch/report/sweep_report.hpp>
#include <lightswitch/sweep/sweep_text.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <sstream>

using namespace lightswitch;
using lightswitch::test::contender_of;
using lightswitch::test::Fake;
using lightswitch::test::message_of;

namespace {

constexpr double no_time = 1e-9;  // one iteration

/// relMSE of `iterations` of it against the truth.
double error_of(const Fake& fake, double iterations) {
    const double r = double(fake.level);
    return double(fake.noise) * double(fake.noise) / iterations / (r * r + metric_offset);
}

std::vector<Image> images_of(const Fake& fake, std::uint64_t first, int count) {
    std::vector<std::uint64_t> seeds;
    for (int i = 0; i < count; ++i) seeds.push_back(first + static_cast<std::uint64_t>(i));
    return independent_images(contender_of(fake), {}, TimeOf::wall, no_time, seeds);
}

/// A method's curve without seeds.
SweptMethod curve(std::string name, std::vector<std::pair<double, double>> points) {
    SweptMethod m{.name = std::move(name)};
    for (std::size_t i = 0; i < points.size(); ++i)
        m.curve.push_back({points[i].first, i + 1, {points[i].second * 0.9, points[i].second * 1.1}});
    m.last = m.curve.back();
    return m;
}

}  // namespace

// The errors of 1728 values scatter by 3.4 % for one seed, and by 1.7 % for four: 10 % are six deviations.
TEST_CASE("sweep: errors are those of the methods, whatever the reference's own") {
    const Fake fine{.name = "fine", .noise = 0.2f, .seconds = 1e-3},
        rough{.name = "rough", .noise = 0.6f, .seconds = 1e-3};
    const Sweep result =
        sweep(std::vector{contender_of(fine), contender_of(rough)}, {.seconds = 0.04, .reference_seconds = 0.08});
    REQUIRE(result.methods.size() == 2);
    CHECK(!result.stopped);
    CHECK(result.seeds == 4);
    for (const Fake& fake : {fine, rough}) {
        const SweptMethod& m = *result.find(fake.name);
        REQUIRE(m.curve.size() >= 3);
        for (const SweepPoint& p : m.curve) {
            CAPTURE(p.iterations);
            CHECK(p.errors.size() == 4);
            CHECK(std::abs(p.error() / error_of(fake, double(p.iterations)) - 1) < 0.1);
            CHECK(p.low() <= p.error());
            CHECK(p.high() >= p.error());
            CHECK(p.seconds >= 1e-3 * double(p.iterations));
        }
        CHECK(std::abs(m.variance / m.last.error() - 1) < 0.1);
        CHECK(m.inefficiency == m.variance * m.last.seconds);
        CHECK(m.rays_per_second > 0);
    }
    CHECK(result.frontier().back().best == 0);
    CHECK(result.frontier().back().clear);
}

TEST_CASE("sweep: the reference tells its own error, and the methods see the same") {
    const Fake a{.name = "a", .noise = 0.3f, .side = 64}, b{.name = "b", .noise = 0.5f, .side = 64};
    const Sweep result = sweep(std::vector{contender_of(a), contender_of(b)}, {.seconds = no_time});
    // Eight images of each, weighted by their variances: 0.09 and 0.25.
    const double truth = 1 / (8 / 0.09 + 8 / 0.25) / (1 + metric_offset);
    CHECK(std::abs(result.reference.relmse / truth - 1) < 0.05);
    CHECK(std::abs(relmse(result.reference.image, images_of({.noise = 0, .side = 64}, 1, 2)[0]) / truth - 1) < 0.05);
    CHECK(std::abs(*result.seen_noise / truth - 1) < 0.3);
    CHECK(result.reference.consistent());
    CHECK(std::abs(result.reference.ratio - 1) < 0.01);
}

TEST_CASE("sweep: the interval of the bias holds what it says") {
    int missed = 0, found = 0;
    for (std::uint64_t run = 0; run < 200; ++run) {
        const Fake right{.name = "right", .noise = 0.3f, .side = 8};
        const Fake wrong{.name = "wrong", .noise = 0.3f, .level = 1.1f, .side = 8};
        const Sweep result = sweep(std::vector{contender_of(right), contender_of(wrong)},
                                   join(images_of(right, 1000 * run + 100, 4), images_of(right, 1000 * run + 200, 4)),
                                   {.seconds = no_time, .seeds = 8, .seed = 1000 * run});
        const Interval of_right = *result.methods[0].bias_interval, of_wrong = *result.methods[1].bias_interval;
        missed += of_right.low > 0 || of_right.high < 0;
        found += of_wrong.low > 0 && of_wrong.low < 0.1 && of_wrong.high > 0.1;
    }
    CHECK(missed >= 1);  // of 200 times 1 %
    CHECK(missed <= 8);
    CHECK(found >= 190);
}

TEST_CASE("sweep: a method that finds light rarely makes no reference, however even its images are") {
    const Fake rare{.name = "rare", .noise = 0, .rarity = 1e6f}, noisy{.name = "noisy", .noise = 0.5f};
    const Fake noisier{.name = "noisier", .noise = 1};
    const Sweep result =
        sweep(std::vector{contender_of(rare), contender_of(noisy), contender_of(noisier)}, {.seconds = no_time});
    CHECK(result.reference.first != "rare");
    CHECK(result.reference.second != "rare");
    CHECK(std::abs(result.find("rare")->last.error() - 1 / 1.01) < 0.3);
}

TEST_CASE("sweep: of two pilots the better one has less variance times seconds") {
    const auto pilot = [](const Fake& fake, double seconds) {
        detail::Pilot result{.contender = 0, .images = {}, .seconds = seconds};
        for (const Image& image : images_of(fake, 1 + static_cast<std::uint64_t>(100 * fake.noise), 2))
            result.images.add(image);
        return result;
    };
    const Fake fine{.noise = 0.1f}, rough{.noise = 0.2f}, black{.noise = 0, .level = 0};
    using Order = std::vector<std::size_t>;
    CHECK(detail::by_inefficiency(std::vector{pilot(rough, 1), pilot(fine, 3), pilot(black, 1)}) == Order{1, 0, 2});
    CHECK(detail::by_inefficiency(std::vector{pilot(black, 1), pilot(rough, 1), pilot(fine, 5)}) == Order{1, 2, 0});
}

TEST_CASE("sweep: what makes a reference is unbiased, and misses as little as possible") {
    const PathClasses caustics{.dirac_caustic = true};
    const Fake blurred{.name = "blurred", .noise = 0.1f, .kind = Kind::consistent};
    const Fake blind{.name = "blind", .noise = 0.1f, .missing = caustics}, seeing{.name = "seeing", .noise = 1};
    const Sweep result =
        sweep(std::vector{contender_of(blurred), contender_of(blind), contender_of(seeing)}, {.seconds = no_time});
    CHECK(result.reference.first == "seeing");
    CHECK(result.reference.second == "seeing");
    CHECK(!result.reference.missing.any());
    const Sweep without = sweep(std::vector{contender_of(blurred), contender_of(blind)}, {.seconds = no_time});
    CHECK(without.reference.missing == caustics);
    CHECK(message_of([&] {
              sweep(std::vector{contender_of(blurred)}, {.seconds = no_time});
          }).find("no method is unbiased") != std::string::npos);
}

TEST_CASE("sweep: halves of a reference that differ are told") {
    const Fake one{.name = "one", .noise = 0.1f}, other{.name = "other", .noise = 0.2f, .level = 0.95f};
    const Reference wrong = join(images_of(one, 1, 8), images_of(other, 100, 8));
    CHECK(!wrong.consistent());
    CHECK(std::abs(wrong.ratio - 1 / 0.95) < 0.01);
    CHECK(wrong.deviations > 4);
    // 200 right pairs: a tile in 16 beyond 4 deviations of few images is rare, but not never.
    int alarms = 0;
    for (unsigned run = 0; run < 200; ++run)
        alarms += !join(images_of(one, 1000 + 20 * run, 8), images_of(one, 1010 + 20 * run, 8)).consistent();
    CHECK(alarms <= 2);
}

TEST_CASE("sweep: curves stop where the reference's own error begins") {
    const Fake rough{.name = "rough", .noise = 1, .side = 64}, fine{.name = "fine", .noise = 0.01f, .side = 64};
    const Sweep result = sweep(std::vector{contender_of(fine), contender_of(rough)},
                               join(images_of(rough, 100, 8), images_of(rough, 200, 8)), {.seconds = no_time});
    CHECK(result.find("fine")->curve.empty());
    CHECK(result.find("fine")->last.errors.size() == 4);
    CHECK(result.find("rough")->curve.size() == 1);
    CHECK(detail::error_text(result.find("fine")->last.error(), result.least_error()) ==
          "<" + detail::digits(result.least_error()));
}

TEST_CASE("sweep: the error of an image that is given is found by the methods") {
    const Fake fake{.noise = 0.02f, .side = 64}, rough{.name = "rough", .noise = 1, .side = 64};
    const Fake noise{.noise = 0.05f, .side = 64};
    const Sweep result =
        sweep(std::vector{contender_of(rough), contender_of(fake)}, images_of(noise, 77, 1)[0], {.seconds = no_time});
    CHECK(std::abs(result.reference.relmse / error_of(noise, 1) - 1) < 0.1);
    CHECK(result.reference.relmse == *result.seen_noise);
    CHECK(!result.reference.first.size());
    const Sweep exact =
        sweep(std::vector{contender_of(fake)}, images_of({.noise = 0, .side = 64}, 1, 1)[0], {.seconds = no_time});
    CHECK(exact.reference.relmse < 0.1 * error_of(fake, 1));
    CHECK(std::abs(exact.methods[0].last.error() / error_of(fake, 1) - 1) < 0.05);
}

TEST_CASE("sweep: preparation counts, and methods have equal time") {
    const Fake quick{.name = "quick", .noise = 0.5f, .seconds = 1e-3};
    const Fake prepared{.name = "prepared", .noise = 0.01f, .seconds = 1e-3, .preparation = 0.03};
    const Sweep result = sweep(std::vector{contender_of(quick), contender_of(prepared)},
                               images_of({.noise = 0}, 1, 1)[0], {.seconds = 0.08, .seeds = 2});
    const SweptMethod &first = result.methods[0], &second = result.methods[1];
    CHECK(first.curve.front().seconds < 0.01);
    CHECK(second.last.seconds >= 0.07);
    CHECK(first.last.seconds >= 0.07);
    CHECK(second.last.iterations < first.last.iterations);
    const auto frontier = result.frontier();
    CHECK(frontier.front().best == 0);
    CHECK(frontier.back().best == 1);
}

TEST_CASE("sweep: progress does not fall, and a stop keeps what there is") {
    const Fake a{.name = "a", .seconds = 1e-3}, b{.name = "b", .seconds = 1e-3};
    std::vector<double> fractions;
    SweepOptions options{.seconds = 0.02, .seeds = 3};
    options.observer = [&](const SweepProgress& p) {
        CHECK(p.seconds_left >= 0);
        fractions.push_back(p.fraction);
    };
    sweep(std::vector{contender_of(a), contender_of(b)}, options);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
    CHECK(fractions.front() < 0.1);
    CHECK(fractions.back() > 0.85);
    CHECK(fractions.back() <= 1);

    for (const double when : {0.01, 0.7}) {
        CAPTURE(when);
        std::stop_source source;
        options.stop = source.get_token();
        options.observer = [&](const SweepProgress& p) {
            if (p.fraction > when) source.request_stop();
        };
        const Sweep stopped = sweep(std::vector{contender_of(a), contender_of(b)}, options);
        CHECK(stopped.stopped);
        CHECK(stopped.seeds <= 3);
        CHECK(stopped.methods.empty() == (when < 0.1));
        std::ostringstream text;
        text << stopped;
        CHECK(text.str().size() > 10);
    }
}

TEST_CASE("sweep: errors between the points, times to an error, and the best of several") {
    const SweptMethod m = curve("m", {{1, 1}, {2, 0.25}, {4, 0.0625}});
    CHECK(!m.error_at(0.5));
    CHECK(std::abs(*m.error_at(std::sqrt(2.0)) - 0.5) < 1e-12);
    CHECK(*m.error_at(4.5) == 0.0625);
    CHECK(!m.error_at(6));
    CHECK(std::abs(m.seconds_to(0.5)->seconds - std::sqrt(2.0)) < 1e-12);
    CHECK(m.seconds_to(2)->at_most);
    CHECK(!m.seconds_to(0.01));
    CHECK(!curve("rising", {{1, 0.1}, {2, 1}}).seconds_to(0.5));

    Sweep sweep{.methods = {m, curve("steady", {{1, 0.5}, {2, 0.4}, {4, 0.3}})}, .seconds = 4, .seeds = 2};
    const auto frontier = sweep.frontier();
    REQUIRE(frontier.size() == 3);
    CHECK(frontier[0].best == 1);
    CHECK(frontier[1].best == 0);
    CHECK(frontier[2].best == 0);
    CHECK(std::abs(frontier[2].ratio - 4.8) < 1e-12);
    CHECK(frontier[2].clear);
    CHECK(detail::frontier_text(sweep) ==
          "Best: steady from 1 s; m from 2 s. At 4 s steady is next with 4.8 times the error.");
    CHECK(sweep_csv(sweep).find("m,unbiased,2,2,0.25,0.225,0.275,2,1\n") != std::string::npos);
}

TEST_CASE("sweep: methods of one's own on a scene, in three lines, and what they make") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = description.film.height = 12;
    const auto scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    const std::vector methods{contender(scene, PathTracerNee{}), contender(scene, PathTracer{})};
    const Sweep result = sweep(methods, {.seconds = 0.02, .seeds = 2, .seed = 5});
    const Report report = sweep_report("mine", result);
    const SweptMethod& nee = *result.find("path-nee");
    CHECK(test::identical(
        nee.image, render(scene, PathTracerNee{}, {.samples = static_cast<int>(nee.last.iterations)}, {.seed = 5})));
    CHECK(report.images.size() == 3);
    CHECK(report.curves[0].points[0].low > 0);
    const std::string html = report_html(report);
    for (const char* text : {"path-nee", "relMSE; bands", "The best method at each time"})
        CHECK(html.find(text) != std::string::npos);
    CHECK(all_contenders(scene).size() == 8);
}

TEST_CASE("sweep: what it cannot do is an error that says why") {
    const std::vector fakes{contender_of({})};
    const auto scene = stock::cornell_box();
    const auto says = [&](auto&& f, const char* text) {
        CHECK_MESSAGE(message_of(f).find(text) != std::string::npos, text);
    };
    says([&] { sweep(std::vector<Contender>{}); }, "needs a method");
    says([&] { sweep(fakes, {.seconds = 0}); }, "must be positive");
    says([&] { sweep(fakes, {.seeds = 0}); }, "needs a seed");
    says([&] { sweep(std::vector{contender(scene, Phong{})}); }, "phong is heuristic");
    says([&] { sweep(fakes, Image(3, 3), {.seconds = no_time}); }, "different size");
    Image broken(24, 24);
    broken(7, 3).y = std::nanf("");
    says([&] { sweep(fakes, broken, {.seconds = no_time}); }, "not finite in pixel (7, 3)");
    says([&] { join(images_of({}, 1, 1), images_of({}, 2, 2)); }, "two images by each");
    says([&] { sweep_report("nothing", Sweep{}); }, "before there was anything");
}
