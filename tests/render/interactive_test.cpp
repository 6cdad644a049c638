#include <lightswitch/compiled.hpp>
#include <lightswitch/render/interactive.hpp>
#include <lightswitch/scene/stock.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

using namespace lightswitch;

namespace {

using Interactive = InteractiveRender<AnyScene>;

LibraryDescription small_box(int size = 32) {
    LibraryDescription description = *stock::describe("cornell-box");
    description.film.width = description.film.height = size;
    return description;
}

bool same(const Image& a, const Image& b) { return a.pixels() == b.pixels(); }

Image rendered(const AnyScene& scene, const AnyMethod& method, int samples) {
    return std::visit([&](const auto& s, const auto& m) { return render(s, m, {.samples = samples}); }, scene, method);
}

/// Waits until the method has made so many iterations.
void wait_for(const Interactive& live, std::size_t method, std::uint64_t iterations) {
    for (int i = 0; i < 60000; ++i) {
        if (const auto snapshot = live.snapshot(method); snapshot && snapshot->iterations >= iterations) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL("no picture within a minute");
}

}  // namespace

TEST_CASE("Every method's image is what render makes, however often methods were switched in between") {
    const LibraryDescription description = small_box();
    const AnyScene scene = build_any(description);
    Interactive live(scene, description.camera);
    std::vector<AnyMethod> methods;
    for_each_method([&](const auto& m) { methods.push_back(m); });
    for (const AnyMethod& method : methods) live.add(method);
    live.limit(9);
    // Switching faster than iterations end, so that many are broken off.
    for (int round = 0; round < 300; ++round) {
        live.show(static_cast<std::size_t>(round) % methods.size());
        std::this_thread::sleep_for(std::chrono::microseconds(300 + 67 * (round % 23)));
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
        live.show(i);
        live.wait();
        const auto snapshot = live.snapshot(i);
        REQUIRE(snapshot);
        CAPTURE(method_name(methods[i]));
        CHECK(snapshot->failure.empty());
        CHECK(snapshot->iterations == 9);
        CHECK(same(snapshot->image, rendered(scene, methods[i], 9)));
        CHECK(snapshot->variance.pixels().size() == snapshot->image.pixels().size());
        CHECK(snapshot->statistics.iterations == 9);
        CHECK(snapshot->image.metadata.at("method") == method_name(methods[i]));
    }
}

TEST_CASE("Methods that are shown together take turns, and one that is not shown rests") {
    const LibraryDescription description = small_box();
    Interactive live(build_any(description), description.camera);
    const std::size_t a = live.add(PathTracer{}), b = live.add(PathTracerNee{}), c = live.add(Bdpt{});
    live.show({a, b});
    wait_for(live, a, 3);
    wait_for(live, b, 3);
    CHECK(!live.snapshot(c));
    live.show(b);
    wait_for(live, b, 10);
    const auto rested = live.snapshot(a)->iterations;
    wait_for(live, b, 30);
    CHECK(live.snapshot(a)->iterations <= rested + 1);
}

TEST_CASE("A move of the camera begins anew, first with coarse pictures") {
    const LibraryDescription description = small_box(512);
    const AnyScene scene = build_any(description);
    std::atomic<int> updates = 0;
    Interactive live(scene, description.camera, {}, [&] { ++updates; });
    const std::size_t method = live.add(Bdpt{});
    live.limit(1);
    live.show(method);
    live.wait();
    CHECK(updates >= 2);
    CHECK(same(live.snapshot(method)->image, rendered(scene, Bdpt{}, 1)));

    CameraDescription moved = description.camera;
    moved.to_world[3].x += 0.1 * description.camera.focus_distance;
    live.limit(0);
    live.move(moved, description.film);
    std::shared_ptr<const Snapshot> first;
    do {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        first = live.snapshot(method);
    } while (first->view == 0);
    CHECK(first->view == 1);
    CHECK(first->iterations == 0);
    CHECK(first->image.width() < 512);
    CHECK(first->variance.empty());

    live.limit(1);
    live.wait();
    const AnyScene other =
        std::visit([&](const auto& s) -> AnyScene { return s.with_camera(moved, description.film); }, scene);
    CHECK(same(live.snapshot(method)->image, rendered(other, Bdpt{}, 1)));
    CHECK(!same(live.snapshot(method)->image, rendered(scene, Bdpt{}, 1)));
    CHECK(std::visit([](const auto& s) { return s.camera_id(); }, *live.scene()) ==
          std::visit([](const auto& s) { return s.camera_id(); }, other));
}

TEST_CASE("After a move nothing of an earlier view is left, but of what is shown until there is something newer") {
    const LibraryDescription description = small_box();
    Interactive live(build_any(description), description.camera);
    const std::size_t shown = live.add(PathTracerNee{}), other = live.add(Silhouette{});
    live.limit(2);
    for (const std::size_t method : {other, shown}) {
        live.show(method);
        live.wait();
    }
    REQUIRE(live.snapshot(other));
    CameraDescription moved = description.camera;
    moved.fov += 5;
    live.move(moved, description.film);
    CHECK(!live.snapshot(other));
    REQUIRE(live.snapshot(shown));
    live.show(std::vector<std::size_t>{});
    const auto left = live.snapshot(shown);
    CHECK((!left || left->view == 1));
    live.show({shown, other});
    live.wait();
    for (const std::size_t method : {other, shown}) CHECK(live.snapshot(method)->view == 1);
}

TEST_CASE("Many moves in a row end at the last one") {
    const LibraryDescription description = small_box(128);
    Interactive live(build_any(description), description.camera);
    for_each_method([&](const auto& m) { live.add(m); });
    live.limit(2);
    CameraDescription camera = description.camera;
    for (int i = 0; i < 200; ++i) {
        camera.fov = 30 + 0.1 * i;
        live.show(static_cast<std::size_t>(i % 9));
        live.move(camera, description.film);
        std::this_thread::sleep_for(std::chrono::microseconds(50 * (i % 40)));
    }
    live.wait();
    const auto snapshot = live.snapshot(199 % 9);
    CHECK(snapshot->view == 200);
    const AnyScene seen = std::visit([&](const auto& s) -> AnyScene { return s.with_camera(camera, description.film); },
                                     build_any(description));
    CHECK(same(snapshot->image, rendered(seen, Silhouette{}, 2)) == (199 % 9 == 0));
    CHECK(snapshot->image.metadata.at("camera") == std::visit([](const auto& s) { return s.camera_id(); }, seen));
}

TEST_CASE("A camera that is impossible is an error, and changes nothing") {
    const LibraryDescription description = small_box();
    Interactive live(build_any(description), description.camera);
    const std::size_t method = live.add(PathTracerNee{});
    live.limit(1);
    live.show(method);
    CameraDescription impossible = description.camera;
    impossible.fov = 200;
    CHECK_THROWS_AS(live.move(impossible, description.film), Error);
    live.wait();
    CHECK(live.snapshot(method)->view == 0);
    CHECK(live.snapshot(method)->iterations == 1);
}

namespace {

struct Fails {
    static constexpr std::string_view name = "fails";
    static constexpr Kind kind = Kind::heuristic;
    Rgb radiance(const auto&, const Ray&, auto&) const { throw Error("this method cannot"); }
};

}  // namespace

TEST_CASE("What a method throws is told, and the others go on") {
    const LibraryDescription description = small_box();
    const auto scene = build_as<DiffuseScene>(description);
    InteractiveRender live(scene, description.camera);
    const std::size_t fails = live.add(Fails{}), works = live.add(PathTracerNee{});
    live.limit(2);
    live.show({fails, works});
    live.wait();
    CHECK(live.snapshot(fails)->failure == "this method cannot");
    CHECK(live.snapshot(works)->iterations == 2);
}

TEST_CASE("It ends at once while an image is being made") {
    const LibraryDescription description = small_box(2048);
    const auto begin = std::chrono::steady_clock::now();
    {
        Interactive live(build_any(description), description.camera);
        live.show(live.add(Vcm{}));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    // An iteration of that size takes far longer than the ten seconds that are a bound for a slow machine.
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));
}
