// Metropolis light transport sees the image of path tracing, from the first iteration on, and says what its chains did.
// More scenes and path lengths, with more samples, are in mlt_long_test.cpp.

#include "mlt.hpp"

#include "support/relative.hpp"
#include "support/statistics.hpp"

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// What the state says, by name.
double of_method(const RenderStatistics& statistics, std::string_view name) {
    for (const auto& [key, value] : statistics.of_method)
        if (key == name) return value;
    FAIL("no statistic of the name ", name);
    return 0;
}

double square_of(double x) { return x * x; }

}  // namespace

// False alarm: 1e-3 in each test case that compares means.

TEST_CASE("mlt: agrees with path tracing") {
    const auto cases = mlt_cases();
    for (const TransportCase& c : cases) check_mlt_against_path_nee(c, {-1}, 8, 1e-3, static_cast<int>(cases.size()));
}

TEST_CASE("mlt: each limit of the path length") {
    const TransportCase box{"cornell-box", scenes::on_small_film(stock::describe_cornell_box())};
    check_mlt_against_path_nee(box, {1, 2, 3, 4}, 8, 1e-3, 2);
    const TransportCase all{"stage under all", scenes::stage_under_all()};
    check_mlt_against_path_nee(all, {1, 2, 3, 4}, 8, 1e-3, 2);
}

TEST_CASE("mlt: furnaces are geometric series") {
    for (const float albedo : {0.5f, 0.8f})
        for (const int depth : {2, 3, -1}) {
            const double a = double(albedo), expected = depth < 0 ? 1 / (1 - a) : (1 - std::pow(a, depth)) / (1 - a);
            const TileEstimates truth = known_tiles(2, 2, 8, expected);
            TransportCase box{"furnace " + std::to_string(albedo),
                              scenes::on_small_film(stock::describe_furnace(albedo))};
            check_mlt(box, build_scene<DiffuseBsdfs, Lights<TriangleLight>>(box.description), truth, depth, 8, 1e-3, 6);
        }
}

TEST_CASE("mlt: nothing at depth 0, emission alone at depth 1, black without light") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    CHECK(render(scene, Mlt{.max_depth = 0}, {.samples = 1}).mean() == DVec3(0));
    CHECK(identical(render(scene, Mlt{.max_depth = 1}, {.samples = 2}),
                    render(scene, PathTracerNee{.max_depth = 1}, {.samples = 2})));
    const FullScene dark = build_scene<AllBsdfs, AllLights>(scenes::hollow_sphere());
    CHECK(render(dark, Mlt{.bootstrap = 64}, {.samples = 2}).mean() == DVec3(0));
}

// A film of several tiles of the guide, some of them not full: the guide must cancel. Chains do not divide the pixels.
TEST_CASE("mlt: agrees with path tracing where the guide is uneven") {
    LibraryDescription description = stock::describe_cornell_box();
    description.film.width = 41;
    description.film.height = 25;
    const TransportCase c{"41 x 25", description, true, 12};
    check_mlt_against_path_nee(c, {-1}, 8, 1e-3, 1);
}

// A filter that takes in a good part of what lies beyond the film.
TEST_CASE("mlt: agrees with path tracing at the border of a film with a wide filter") {
    check_mlt_against_path_nee({"wide gaussian", scenes::filtered(Filter::gaussian(1.5f))}, {-1}, 8, 1e-3, 1);
}

// Sixteen seeds: their mean is that of path tracing (t test, 1e-3 in each scene), and none is further from it than what
// the seeds themselves spread: beyond 5 of their deviations is one value in 2e6, for three channels of 16 seeds 2e-5.
TEST_CASE("mlt: every seed gives the same image") {
    const auto check = [](const LibraryDescription& description, int samples, double spread) {
        const FullScene scene = build_scene<AllBsdfs, AllLights>(description);
        const TileEstimates truth = replicate_finite(scene, PathTracerNee{}, 8, 16, 8 * samples, 1001);
        Mean seeds[3];
        std::vector<DVec3> means;
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            means.push_back(render(scene, mlt_for_tests(-1, samples), {.samples = 4 * samples}, {.seed = seed}).mean());
            for (int c = 0; c < 3; ++c) seeds[c].add(means.back()[c]);
        }
        for (int c = 0; c < 3; ++c) {
            const Estimate ours{seeds[c].value(), square_of(seeds[c].error()), 15};
            CHECK_MESSAGE(welch_p(ours, truth.whole[c]) > sidak(1e-3, 3), description.name, ", channel ", c, ": ",
                          BiasInterval(ours, truth.whole[c]));
            // Else the bound on single seeds would say nothing.
            CHECK(std::sqrt(seeds[c].variance()) < spread * seeds[c].value());
            for (const DVec3& mean : means)
                CHECK(std::abs(mean[c] - truth.whole[c].mean) < 5 * std::sqrt(seeds[c].variance()));
        }
    };
    check(scenes::on_small_film(stock::describe_cornell_box()), 16, 0.05);
    check(scenes::on_small_film(stock::describe_cornell_spheres()), 32, 0.15);
}

// The mean of many first iterations. False alarm: 1e-3 for the comparison, which sees a bias of the whole beyond 1.5 %,
// and for each of the bounds on the bias.
TEST_CASE("mlt: no bias from where chains start") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::start_up());
    const TileEstimates truth = replicate_finite(scene, PathTracerNee{}, 2, 16, 1024, 1001);
    const auto check = [&](bool refine, int samples, int seeds) {
        const TileEstimates ours = replicate_finite(scene, start_up_mlt(refine), 2, seeds, samples, 1);
        const BiasInterval whole(ours.whole[1], truth.whole[1], 0.999);
        CHECK_MESSAGE(whole.within(0.03), whole);
        CHECK(whole.high - whole.low < 0.03);
        const Comparison comparison = compare(ours, truth, 1e-3);
        CHECK_MESSAGE(comparison.agree(), comparison);
    };
    check(false, 1, 1024);
    check(true, 4, 384);
}

namespace {

/// A box with a small lamp, seen through a narrow lens: the caustic of a glass ball, in a mirror ball. A few paths in a
/// million find it.
LibraryDescription caustic_in_mirror() {
    LibraryDescription scene = stock::describe_cornell_spheres();
    for (auto& shape : scene.shapes) shape.emission.reset();
    scene.add(quad({-0.03, 0.98, -0.03}, {0.03, 0.98, -0.03}, {0.03, 0.98, 0.03}, {-0.03, 0.98, 0.03}), 0, Rgb(400));
    scenes::look(scene, {0, 0, 3.9}, {-0.35, -0.65, 0.05}, 20);
    return scenes::on_small_film(scene);
}

}  // namespace

// Chains that go on from one iteration to the next, with large steps to find new light, missed a quarter of it in most
// seeds and showed four times as much in others. F test of the squared distances of eight seeds from the truth, over
// the variance of the seeds of bidirectional path tracing: false alarm 1e-3.
TEST_CASE("mlt: every seed has the light that few paths find") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(caustic_in_mirror());
    Mean truth, distances;
    for (std::uint64_t seed = 101; seed <= 116; ++seed)
        truth.add(render(scene, Bdpt{}, {.samples = 512}, {.seed = seed}).mean().y);
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
        distances.add(
            square_of(render(scene, mlt_for_tests(-1), {.samples = 512}, {.seed = seed}).mean().y - truth.value()));
    constexpr double f_8_15 = 6.47;  // exceeded with probability 1e-3
    CHECK_MESSAGE(distances.value() < f_8_15 * truth.variance() * (1 + 1.0 / 16), std::sqrt(distances.value()),
                  " from ", truth.value(), ", which spreads by ", std::sqrt(truth.variance()));
    // Else the bound would say nothing.
    CHECK(std::sqrt(truth.variance()) < 0.12 * truth.value());
}

TEST_CASE("mlt: statistics of usual chains") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(stock::describe_cornell_spheres()));
    const auto run = [&](const Mlt& method) {
        Session<FullScene, Mlt> session(scene, method);
        session.run({.samples = 32});
        return session.statistics();
    };
    const RenderStatistics usual = run(mlt_for_tests(-1));
    CHECK(usual.counts.non_finite == 0);
    CHECK(of_method(usual, "chains") > 0);
    CHECK(of_method(usual, "mutations") >= 8 * of_method(usual, "chains"));
    // What was planned, as far as a few bright paths let plans come true.
    CHECK(of_method(usual, "mutations") > 0.1 * 32 * 256 * 0.5);
    CHECK(of_method(usual, "mutations") < 5 * 32 * 256 * 0.5);
    CHECK(of_method(usual, "acceptance_rate") > 0.1);
    CHECK(of_method(usual, "acceptance_rate") < 1);
    CHECK(of_method(usual, "chain_length") >= 8);
    CHECK(of_method(usual, "chain_length") <= 4096);
    CHECK(of_method(usual, "chain_share") > 0.005);
    CHECK(of_method(usual, "chain_share") < 0.3);
    CHECK(of_method(usual, "coverage") > 0.5);
    CHECK(of_method(usual, "coverage") <= 1);
    CHECK(of_method(run({.bootstrap = 4096, .mutations = 4}), "mutations") > 3 * of_method(usual, "mutations"));
    CHECK(of_method(run({.bootstrap = 0}), "mutations") > 0);
    // Where nothing is rare, nothing is left to chains.
    const FullScene furnace = build_scene<AllBsdfs, AllLights>(scenes::on_small_film(stock::describe_furnace(0.5f)));
    Session<FullScene, Mlt> box(furnace, mlt_for_tests(-1));
    box.run({.samples = 8});
    CHECK(of_method(box.statistics(), "chain_share") < 0.02);
    CHECK(of_method(box.statistics(), "coverage") > 0.98);
}

namespace {

LibraryDescription odd_film() {
    LibraryDescription scene = random_scene(2);
    scene.film.width = 53;
    scene.film.height = 37;
    return scene;
}

const Mlt small_mlt{.bootstrap = 3000, .mutations = 2};

/// Breaks off the work of one call of `for_each`, in the middle, once.
struct Interrupted {
    int* calls_left;
    std::stop_source* stop = nullptr;  ///< asked to end; without it, an exception

    void for_each(std::size_t n, const auto& unit) const {
        const bool now = (*calls_left)-- == 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (now && i == n / 2) {
                if (!stop) throw Error("broken off");
                stop->request_stop();
            }
            unit(i);
        }
    }
    int threads() const { return 1; }
};

}  // namespace

TEST_CASE("mlt: the same for any threads, and when continued") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(odd_film());
    for (const bool refine : {false, true})
        for (const Sampling sampling : {Sampling::sobol, Sampling::independent}) {
            Mlt method = small_mlt;
            method.refine = refine;
            Session<FullScene, Mlt, SerialExecutor> serial(scene, method, {.seed = 5, .sampling = sampling}, {});
            serial.run({.samples = 8});
            const Image expected = serial.film().image();
            for (const int threads : {1, 2, 8}) {
                Session<FullScene, Mlt> parallel(scene, method, {.seed = 5, .threads = threads, .sampling = sampling});
                for (const int samples : {3, 8}) parallel.run({.samples = samples});
                CHECK(identical(parallel.film().image(), expected));
                CHECK(identical(parallel.film().variance(), serial.film().variance()));
                CHECK(parallel.statistics().of_method == serial.statistics().of_method);
                CHECK(parallel.statistics().counts.rays == serial.statistics().counts.rays);
            }
            CHECK_FALSE(identical(expected, render(scene, method, {.samples = 8}, {.seed = 6, .sampling = sampling})));
        }
}

TEST_CASE("mlt: goes on after an exception as if nothing had happened") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(odd_film());
    const Image expected = render(scene, small_mlt, {.samples = 6});
    // From an observer, between iterations.
    bool thrown = false;
    Session<FullScene, Mlt> observed(scene, small_mlt, {.observer = [&](const Progress& progress) {
                                         if (progress.iterations == 3 && !std::exchange(thrown, true))
                                             throw Error("seen enough");
                                     }});
    CHECK_THROWS_AS(observed.run({.samples = 6}), Error);
    CHECK(observed.film().iterations() == 3);
    observed.run({.samples = 6});
    CHECK(identical(observed.film().image(), expected));

    // Within the passes of an iteration over pixels and over chains.
    for (const int calls : {0, 1}) {
        int calls_left = -1;
        Session<FullScene, Mlt, Interrupted> session(scene, small_mlt, {}, Interrupted{&calls_left});
        session.run({.samples = 2});
        calls_left = calls;
        CHECK_THROWS_AS(session.run({.samples = 6}), Error);
        CHECK(session.film().iterations() == 2);
        session.run({.samples = 6});
        CHECK(identical(session.film().image(), expected));
    }
}

TEST_CASE("mlt: an iteration that is stopped can be made again") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(odd_film());
    const Image expected = render(scene, small_mlt, {.samples = 3});
    Film film(53, 37);
    int calls_left = -1;
    RenderCounts counts;
    const auto with_frame = [&](std::uint64_t iteration, std::stop_source* stop, const auto& f) {
        const Interrupted executor{&calls_left, stop};
        Frame<FullScene, Interrupted> frame({.scene = scene,
                                             .film = film,
                                             .executor = executor,
                                             .sampling = Sampling::sobol,
                                             .seed = 0,
                                             .iteration = iteration,
                                             .stop = stop ? stop->get_token() : std::stop_token(),
                                             .counts = counts});
        return f(frame);
    };
    auto state = with_frame(Frame<FullScene, Interrupted>::before_the_first, nullptr,
                            [](auto& frame) { return small_mlt.start(frame); });
    film.discard(SerialExecutor{});
    for (std::uint64_t iteration = 0; iteration < 3; ++iteration) {
        const auto iterate = [&](auto& frame) { small_mlt.iterate(frame, state); };
        for (int calls = 0; calls < 2; ++calls) {
            std::stop_source stop;
            calls_left = calls;
            with_frame(iteration, &stop, iterate);
            CHECK(stop.stop_requested());
            film.discard(SerialExecutor{});
        }
        with_frame(iteration, nullptr, iterate);
        film.commit(SerialExecutor{});
    }
    CHECK(identical(film.image(), expected));
}

TEST_CASE("mlt: every scale by a power of two gives the same bits") {
    LibraryDescription scene = odd_film();
    scene.camera.near_clip = 0.01;
    const auto at_scale = [&](int k) {
        return render(build_scene<AllBsdfs, AllLights>(scaled(scene, k)), small_mlt, {.samples = 3});
    };
    const Image image = at_scale(0);
    CHECK(image.mean().y > 0);
    for (const int k : {-40, 40}) CHECK(identical(image, at_scale(k)));
}
