// Renders that are written, read, gone on with and merged: always the bits of one that nothing has happened to.

#include "support/errors.hpp"
#include "support/folder.hpp"
#include "support/random_scenes.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/checkpoint.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

const DiffuseScene& box() {
    static const DiffuseScene scene = [] {
        LibraryDescription description = stock::describe_cornell_box();
        description.film.width = 20;
        description.film.height = 13;
        description.film.filter = Filter::gaussian(0.7f);  // wider than a pixel
        return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    }();
    return scene;
}

/// With settings that leave the tests short.
template <class M>
M quick() {
    M method;
    if constexpr (std::same_as<M, Mlt>) method.bootstrap = 500;
    if constexpr (std::same_as<M, PathGuided>) {
        method.first_training = 8;
        method.always_guide = true;
    }
    return method;
}

bool identical_films(const Film& a, const Film& b) {
    return a.iterations() == b.iterations() && a.sums() == b.sums() && a.windows() == b.windows() &&
           identical(a.image(), b.image()) && identical(a.variance(), b.variance()) &&
           a.relative_error() == b.relative_error();
}

void check_same(const RenderState& a, const RenderState& b) {
    CHECK(identical_films(a.film, b.film));
    CHECK(a.iterations == b.iterations);
    const RenderCounts &x = a.statistics.counts, &y = b.statistics.counts;
    CHECK(x.rays == y.rays);
    CHECK(x.shadow_rays == y.shadow_rays);
    CHECK(x.paths == y.paths);
    CHECK(x.splats == y.splats);
    CHECK(x.non_finite == y.non_finite);
    CHECK(x.first_non_finite == y.first_non_finite);
    CHECK(a.method_state == b.method_state);
    // How much memory vectors that have grown hold depends on when they were made.
    const auto all_but_bytes = [](auto numbers) {
        std::erase_if(numbers, [](const auto& number) { return number.first == "photon_map_bytes"; });
        return numbers;
    };
    CHECK(all_but_bytes(a.statistics.of_method) == all_but_bytes(b.statistics.of_method));
}

constexpr int samples = 9;

template <class M, class S>
RenderState whole(const S& scene, const M& method, const Settings& settings) {
    Session<S, M> session(scene, method, settings);
    session.run({.samples = samples});
    return state_of(session);
}

/// Killed after every few iterations, and gone on with by others with other threads.
template <class M, class S>
void check_resume(const S& scene, const M& method) {
    CAPTURE(M::name);
    const Folder folder;
    const auto file = folder / "x.lsw";
    const RenderState undisturbed = whole(scene, method, {.seed = 3, .threads = 1});
    for (int made = 0, threads = 1; made < samples; made += 2, threads = 3 - threads) {
        Session<S, M> session(scene, method, {.seed = 3, .threads = threads});
        if (made > 0) load_checkpoint(session, file);
        CHECK(session.film().iterations() == std::uint64_t(made));
        session.run({.samples = std::min(made + 2, samples)});
        save_checkpoint(session, file);
    }
    check_same(load_state(file), undisturbed);
    CHECK(folder.files() == std::set<std::string>{"x.lsw"});
    // One that has nothing left to do.
    Session<S, M> done(scene, method, {.seed = 3});
    load_checkpoint(done, file);
    done.run({.samples = samples});
    check_same(state_of(done), undisturbed);
    CHECK(identical(done.image(), undisturbed.image()));
}

template <class M, class S>
void check_merge(const S& scene, const M& method) {
    CAPTURE(M::name);
    const RenderState undisturbed = whole(scene, method, {.seed = 3, .threads = 1});
    const auto part = [&](std::uint64_t begin, int count) {
        Session<S, M> session(scene, method, {.seed = 3, .threads = 2, .first_iteration = begin});
        session.run({.samples = count});
        return state_of(session);
    };
    const auto check = [&](RenderState merged) {
        CHECK(identical_films(merged.film, undisturbed.film));
        CHECK(merged.iterations == undisturbed.iterations);
        CHECK(merged.statistics.counts.rays == undisturbed.statistics.counts.rays);
        CHECK(merged.statistics.counts.non_finite == undisturbed.statistics.counts.non_finite);
        CHECK(merged.statistics.counts.first_non_finite == undisturbed.statistics.counts.first_non_finite);
        CHECK(identical(merged.image(), undisturbed.image()));
    };
    for (const auto& [first, second] : {std::pair(1, 2), {4, 1}, {3, 3}}) {
        RenderState c = part(0, first), b = part(std::uint64_t(first), second),
                    a = part(std::uint64_t(first + second), samples - first - second);
        merge(a, std::move(b));
        merge(a, std::move(c));
        check(std::move(a));
    }
    // With a gap, which a render that goes on fills.
    RenderState a = part(0, 2), b = part(6, 3);
    merge(b, std::move(a));
    CHECK(b.iterations.text() == "0 to 1, 6 to 8 of seed 3");
    Session<S, M> session(scene, method, {.seed = 3});
    resume(session, std::move(b));
    session.run({.samples = samples});
    CHECK(session.made() == undisturbed.iterations);
    CHECK(identical_films(session.film(), undisturbed.film));
    CHECK(session.image().metadata.at("samples") == "9");
    // What is there twice.
    RenderState again = part(0, 3), over = part(2, 2);
    const Film before = again.film;
    CHECK(message_of([&] { merge(again, std::move(over)); }) == "iterations 2 to 2 of seed 3 are there twice");
    CHECK(identical_films(again.film, before));
}

}  // namespace

TEST_CASE("every method goes on from a file to the bits of a render that was not disturbed") {
    for_each_method([](const auto& m) { check_resume(box(), quick<std::remove_cvref_t<decltype(m)>>()); });
}

TEST_CASE("parts of every method whose iterations stand alone merge to the bits of one render") {
    for_each_method([]<class M>(const M&) {
        if constexpr (!std::same_as<M, Mlt>) check_merge(box(), quick<M>());
    });
}

TEST_CASE("mlt of several seeds merges to the mean, and is not gone on with") {
    const Mlt method = quick<Mlt>();
    RenderState a = whole(box(), method, {.seed = 3}), b = whole(box(), method, {.seed = 4});
    Film both = a.film;
    both.merge(b.film);
    merge(a, std::move(b));
    CHECK(identical_films(a.film, both));
    CHECK(a.image().metadata.at("seed") == "3, 4");
    Session<DiffuseScene, Mlt> session(box(), method, {.seed = 3});
    CHECK(
        message_of([&] { resume(session, std::move(a)); }) ==
        "is merged of several renders by mlt, whose iterations depend on those before: no render can go on from there");
}

namespace {

/// Not a number for every seventh sample or so, and an image method, too.
struct Broken {
    static constexpr std::string_view name = "broken";
    static constexpr Kind kind = Kind::heuristic;
    Rgb radiance(const auto&, const Ray&, auto& sampler) const {
        return sampler.next_1d() < 0.01f ? Rgb(std::numeric_limits<float>::quiet_NaN()) : Rgb(sampler.next_1d());
    }
};

/// Keeps a number and does not say so.
struct Secret {
    static constexpr std::string_view name = "secret";
    static constexpr Kind kind = Kind::heuristic;
    int start(auto&) const { return 0; }
    void iterate(auto& frame, int& count) const {
        ++count;
        frame.pixels([&](const Ray&, auto&) { return Rgb(static_cast<float>(count)); });
    }
};

}  // namespace

TEST_CASE("values that are not finite are counted as if nothing had happened") {
    check_resume(box(), Broken{});
    check_merge(box(), Broken{});
}

TEST_CASE("a method that does not say what it keeps is not written") {
    Session<DiffuseScene, Secret> session(box(), Secret{});
    session.run({.samples = 2});
    CHECK(message_of([&] { state_of(session); }).starts_with("the method secret keeps something"));
}

TEST_CASE("what an iteration counts is forgotten when it is broken off") {
    std::stop_source stop;
    std::uint64_t rays = 0;
    Session<DiffuseScene, Vcm> session(box(), Vcm{},
                                       {.stop = stop.get_token(), .observer = [&](const Progress& progress) {
                                            if (progress.iterations == 2) stop.request_stop();
                                        }});
    session.run({.samples = 5});
    rays = session.statistics().counts.rays;
    session.run({.samples = 5}, {});
    Session<DiffuseScene, Vcm> other(box(), Vcm{});
    other.run({.samples = 2});
    CHECK(rays == other.statistics().counts.rays);
    other.run({.samples = 5});
    CHECK(session.statistics().counts.rays == other.statistics().counts.rays);
}

TEST_CASE("a state of another render is refused, and the difference named") {
    const PathTracerNee method;
    const Folder folder;
    const auto file = folder / "x.lsw";
    {
        Session<DiffuseScene, PathTracerNee> session(box(), method, {.seed = 3});
        CHECK(message_of([&] { save_checkpoint(session, file); }) ==
              "there is nothing to keep before the first iteration");
        session.run({.samples = 2});
        save_checkpoint(session, file, "abc");
    }
    const auto refusal = [&](const auto& scene, const auto& other, const Settings& settings,
                             std::string_view content = "abc") {
        Session<DiffuseScene, std::remove_cvref_t<decltype(other)>> session(scene, other, settings);
        const std::string message = message_of([&] { load_checkpoint(session, file, content); });
        CHECK(session.film().iterations() == 0);
        const std::string begin = file.string() + ": is of another render: ";
        REQUIRE(message.starts_with(begin));
        return message.substr(begin.size());
    };
    const auto changed = [](const auto& change) {
        LibraryDescription description = stock::describe_cornell_box();
        description.film.width = 20;
        description.film.height = 13;
        description.film.filter = Filter::gaussian(0.7f);
        change(description);
        return build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    };
    const Settings same{.seed = 3};
    CHECK(refusal(box(), method, {.seed = 4}) == "it has seed 3, here 4");
    CHECK(refusal(box(), method, {.seed = 3, .sampling = Sampling::independent}) ==
          "it has sampling sobol, here independent");
    CHECK(refusal(box(), PathTracer{}, same) == "it has method path-nee, here path");
    CHECK(refusal(box(), PathTracerNee{.max_depth = 3}, same) == "it has max depth -1, here 3");
    CHECK(refusal(box(), PathTracerNee{.rr_depth = 7}, same) == "it has rr depth 5, here 7");
    CHECK(refusal(box(), method, same, "abd") == "it has content abc, here abd");
    CHECK(refusal(box(), method, same, "") == "it has content abc, here nothing");
    CHECK(refusal(changed([](auto& d) { d.film.width = 21; }), method, same) == "it has size 20x13, here 21x13");
    CHECK(refusal(changed([](auto& d) { d.name = "other"; }), method, same) == "it has scene cornell-box, here other");
    CHECK(refusal(changed([](auto& d) { d.film.filter = Filter::box(); }), method, same)
              .starts_with("it has filter gaussian"));
    CHECK(refusal(changed([](auto& d) { d.camera.fov += 1; }), method, same).starts_with("it has camera "));
    // What no name tells is found by making an iteration again.
    CHECK(refusal(changed([](auto& d) { d.materials[0].bsdf = Lambert{Rgb(0.123f)}; }), method, same)
              .starts_with("iteration 0, made again, is not the same."));
    Session<DiffuseScene, PathTracerNee> right(box(), method, same);
    load_checkpoint(right, file, "abc");
    CHECK(right.film().iterations() == 2);
    CHECK(message_of([&] {
              load_checkpoint(right, file, "abc");
          }).ends_with("a session that has rendered cannot take another's place"));
}

TEST_CASE("damaged files are refused, whatever the damage, and so are others") {
    const Folder folder;
    Session<DiffuseScene, Mlt> session(box(), quick<Mlt>(), {.seed = 3});
    session.run({.samples = 2});
    const auto file = folder / "x.lsw";
    save_checkpoint(session, file);
    const std::string good = read_file(file, 1 << 30);
    const auto refusal = [&](std::string_view bytes) {
        return message_of([&] { load_state(folder.write("y.lsw", bytes)); });
    };
    REQUIRE(refusal(good) == "(no error)");
    for (std::size_t length = 0; length < good.size(); length += 1 + length / 40)
        CHECK(refusal(good.substr(0, length)) != "(no error)");
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = good;
        const std::size_t at = random() % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (i % 8)));
        CHECK(refusal(bytes) != "(no error)");
    }
    CHECK(refusal(good + "x").ends_with("is cut off or damaged: nothing can be taken from it"));
    CHECK(refusal("").ends_with("is not the state of a render"));
    CHECK(refusal("PF\n1 1\n").ends_with("is not the state of a render"));
    std::string later = good;
    later[detail::state_magic.size()] = 9;
    CHECK(refusal(later).ends_with("is the state of a render in format 9, and this version reads 2"));
    CHECK(message_of([&] { load_state(folder / "none.lsw"); }).ends_with("no such file"));
    MESSAGE("bytes a pixel of the file: " << double(good.size()) / (20 * 13));
}

TEST_CASE("an error that has been reached is not rendered further") {
    const PathTracerNee method;
    Session<DiffuseScene, PathTracerNee> session(box(), method);
    session.run({.error = 0.2});
    const std::uint64_t made = session.film().iterations();
    session.run({.error = 0.2});
    CHECK(session.film().iterations() == made);
}
