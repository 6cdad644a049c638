// Rays per second of path-nee over a bare replay of the same rays through Embree: what the library adds to its ray tracer.
//
//   ray_rate [SCENE.xml ...]     without arguments: the stock Cornell box
//
// One thread; render and replay alternate, and the ratio is taken pair by pair.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/load/mitsuba.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace {

namespace ls = lightswitch;

/// Processor time of this thread: other work on the machine does not count.
double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct RecordedRay {
    ls::Ray ray;
    bool shadow;
};

/// The scene with an ear: notes every ray that a method traces.
template <class S>
struct Recorder {
    const S& scene;
    mutable std::vector<RecordedRay> rays;

    auto intersect(const ls::Ray& ray) const {
        rays.push_back({ray, false});
        return scene.intersect(ray);
    }
    bool occluded(const ls::Ray& ray) const {
        rays.push_back({ray, true});
        return scene.occluded(ray);
    }
    decltype(auto) with_bsdf(const auto& point, auto&& f) const { return scene.with_bsdf(point, f); }
    ls::Rgb emitted(const auto& p, const auto& d) const { return scene.emitted(p, d); }
    ls::Rgb environment(const auto& d) const { return scene.environment(d); }
    auto sample_light(const auto& p, float c, const auto& u) const { return scene.sample_light(p, c, u); }
    auto light_pdf(const auto& p, const auto& w, const auto& h) const { return scene.light_pdf(p, w, h); }
    auto environment_pdf(const auto& n, const auto& w) const { return scene.environment_pdf(n, w); }
    const auto& camera() const { return scene.camera(); }
    const auto& film() const { return scene.film(); }
};

template <class S>
double replay(const S& scene, const std::vector<RecordedRay>& rays, std::uint64_t& hits) {
    const RTCScene handle = scene.accelerator().handle();
    const ls::FlushDenormals flush;
    const double begin = now();
    for (const RecordedRay& r : rays) {
        RTCRayHit query;
        query.ray.org_x = r.ray.origin.x, query.ray.org_y = r.ray.origin.y, query.ray.org_z = r.ray.origin.z;
        query.ray.dir_x = r.ray.direction.x, query.ray.dir_y = r.ray.direction.y, query.ray.dir_z = r.ray.direction.z;
        query.ray.tnear = r.ray.near, query.ray.tfar = r.ray.far;
        query.ray.time = 0, query.ray.mask = 0xffffffffu, query.ray.id = 0, query.ray.flags = 0;
        if (r.shadow) {
            ls::embree::occluded(handle, query.ray);
            hits += query.ray.tfar < 0;
        } else {
            query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            ls::embree::intersect(handle, query);
            hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return now() - begin;
}

template <class S>
void measure(const S& scene, int pairs) {
    const ls::PathTracerNee method;
    const Recorder<S> recorder{scene, {}};
    const ls::Settings settings{.threads = 1};
    {
        ls::Session<Recorder<S>, ls::PathTracerNee, ls::SerialExecutor> session(recorder, method, settings, {});
        session.run({.samples = 4});
    }
    std::vector<double> ratios, render_rate, sample_rate;
    std::uint64_t hits = 0;
    const double rays = double(recorder.rays.size());
    for (int i = 0; i <= pairs; ++i) {
        ls::Session<S, ls::PathTracerNee, ls::SerialExecutor> session(scene, method, settings, {});
        const double begin = now();
        session.run({.samples = 4});
        const double seconds = now() - begin;
        const double bare = replay(scene, recorder.rays, hits);
        if (i == 0) continue;  // warm-up
        ratios.push_back(bare / seconds);
        render_rate.push_back(rays / seconds * 1e-6);
        sample_rate.push_back(4e-6 * double(session.film().area()) / seconds);
    }
    const auto median = [](std::vector<double>& v) {
        std::sort(v.begin(), v.end());
        return v[v.size() / 2];
    };
    const double rate = median(render_rate), ratio = median(ratios);
    std::printf("%-16s %9.2f %9.3f %8.3f  (%.3f to %.3f)  %s\n", scene.name().c_str(), rate,
                median(sample_rate), ratio, ratios.front(), ratios.back(), hits ? "" : "no hits?");
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%-16s %9s %9s %8s\n", "scene", "Mrays/s", "Msamp/s", "ratio");
    if (argc == 1) measure(ls::stock::cornell_box(), 15);
    for (int i = 1; i < argc; ++i) {
        const ls::AnyScene scene = ls::build_any(ls::load_mitsuba(argv[i]));
        std::visit([](const auto& s) { measure(s, 15); }, scene);
    }
}
