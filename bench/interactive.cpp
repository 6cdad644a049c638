// What rendering for eyes costs: by method on the Cornell box with spheres of 512 x 512 pixels,
//   - milliseconds from a move of the camera to the first coarse picture, and to the image itself;
//   - the rate of iterations with snapshots that are looked at 30 times a second, over that of a session alone.
// Medians; in brackets the middle half. `interactive [METHOD ...]`

#include <lightswitch/compiled.hpp>
#include <lightswitch/render/interactive.hpp>
#include <lightswitch/scene/stock.hpp>

#include "paired.hpp"

#include <chrono>
#include <thread>

namespace {

namespace ls = lightswitch;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Iterations per second, by the clock, of one second each.
double alone(const auto& scene, const auto& method) {
    ls::Session session(scene, method);
    const auto begin = Clock::now();
    session.run({.seconds = 1});
    return double(session.film().iterations()) / seconds_since(begin);
}
double looked_at(const auto& scene, const ls::CameraDescription& camera, const auto& method) {
    ls::InteractiveRender live(scene, camera);
    live.add(method);
    live.show(0);
    while (!live.snapshot(0) || live.snapshot(0)->iterations == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const auto before = live.snapshot(0)->iterations;
    const auto begin = Clock::now();
    while (seconds_since(begin) < 1) std::this_thread::sleep_for(std::chrono::milliseconds(33));
    // Up to the last that was seen.
    const auto last = live.snapshot(0);
    while (live.snapshot(0) == last) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return double(live.snapshot(0)->iterations - before) / seconds_since(begin);
}

void report(const ls::LibraryDescription& description, const auto& scene, const auto& method) {
    std::vector<double> first, whole, ratio;
    {
        ls::InteractiveRender live(scene, description.camera);
        live.add(method);
        live.show(0);
        ls::CameraDescription camera = description.camera;
        for (int i = 0; i < 21; ++i) {
            camera.fov += 0.1;
            const auto begin = Clock::now();
            live.move(camera, description.film);
            const auto wait = [&](auto condition) {
                for (;; std::this_thread::sleep_for(std::chrono::microseconds(200)))
                    if (const auto snapshot = live.snapshot(0);
                        snapshot && snapshot->view == std::uint64_t(i) + 1 && condition(*snapshot))
                        return 1000 * seconds_since(begin);
            };
            first.push_back(wait([](const ls::Snapshot&) { return true; }));
            whole.push_back(wait([](const ls::Snapshot& s) { return s.iterations > 0; }));
        }
    }
    for (int i = 0; i < 9; ++i) {
        const double rate = alone(scene, method);
        ratio.push_back(looked_at(scene, description.camera, method) / rate);
    }
    const bench::Spread f(first), w(whole), r(ratio);
    std::printf("%-10s  first picture %5.0f ms (%.0f to %.0f)  image %6.0f ms  rate %.3f (%.3f to %.3f)\n",
                std::string(method.name).c_str(), f.median, f.low, f.high, w.median, r.median, r.low, r.high);
}

}  // namespace

int main(int argc, char** argv) {
    ls::LibraryDescription description = *ls::stock::describe("cornell-spheres");
    description.film.width = description.film.height = 512;
    const auto scene = ls::build_as<ls::FullScene>(description);
    ls::for_each_method([&](const auto& method) {
        bool wanted = argc == 1;
        for (int i = 1; i < argc; ++i) wanted = wanted || method.name == argv[i];
        if (wanted) report(description, scene, method);
    });
}
