// Rays per second of path-nee and bdpt over a bare replay of the same rays through Embree: what the library adds to its
// ray tracer.
//
//   ray_rate [SCENE.xml ...]     without arguments: the stock Cornell box
//
// One thread; replay and render alternate; in brackets the middle half of the pairs' ratios.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/load/mitsuba.hpp>

#include <cstdio>
#include <vector>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;

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
    auto light_pdf(const auto& p, const auto& n, const auto& w, const auto& h) const {
        return scene.light_pdf(p, n, w, h);
    }
    auto environment_pdf(const auto& n, const auto& w) const { return scene.environment_pdf(n, w); }
    auto sample_emission(float c, const auto& u, const auto& v) const { return scene.sample_emission(c, u, v); }
    auto emission_pdf(const auto& h, const auto& d) const { return scene.emission_pdf(h, d); }
    auto environment_emission_pdf(const auto& d) const { return scene.environment_emission_pdf(d); }
    float spread(auto l, const auto& p, const auto& w, const auto& q) const { return scene.spread(l, p, w, q); }
    const auto& camera() const { return scene.camera(); }
    const auto& film() const { return scene.film(); }
    const auto& name() const { return scene.name(); }
    const auto& camera_id() const { return scene.camera_id(); }
};

template <class S>
void replay(const S& scene, const std::vector<RecordedRay>& rays, std::uint64_t& hits) {
    const RTCScene handle = scene.accelerator().handle();
    const ls::FlushDenormals flush;
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
}

template <class M, class S>
void measure(const S& scene, int pairs) {
    const M method;
    const Recorder<S> recorder{scene, {}};
    const ls::Settings settings{.threads = 1};
    {
        ls::Session<Recorder<S>, M, ls::SerialExecutor> session(recorder, method, settings, {});
        session.run({.samples = 4});
    }
    std::uint64_t hits = 0;
    const auto result = bench::compare(
        pairs, [&] { replay(scene, recorder.rays, hits); },
        [&] {
            ls::Session<S, M, ls::SerialExecutor> session(scene, method, settings, {});
            session.run({.samples = 4});
        });
    const double samples = 4e-6 * scene.camera().width() * scene.camera().height();
    std::printf("%-16s %-9s %9.2f %9.3f %8.3f  (%.3f to %.3f)%s\n", scene.name().c_str(), M::name.data(),
                double(recorder.rays.size()) * 1e-6 / result.b.median, samples / result.b.median, result.ratio.median,
                result.ratio.low, result.ratio.high, hits ? "" : "  nothing was hit");
}

}  // namespace

int main(int argc, char** argv) try {
    std::printf("%-16s %-9s %9s %9s %8s\n", "scene", "method", "Mrays/s", "Msamp/s", "ratio");
    const auto measure_all = [](const auto& s) {
        measure<ls::PathTracerNee>(s, 15);
        measure<ls::Bdpt>(s, 15);
    };
    if (argc == 1) measure_all(ls::stock::cornell_box());
    for (int i = 1; i < argc; ++i) {
        const ls::AnyScene scene = ls::build_any(ls::load_mitsuba(argv[i]));
        std::visit(measure_all, scene);
    }
} catch (const ls::Error& error) {
    std::fprintf(stderr, "ray_rate: %s\n", error.what());
    return 2;
}
