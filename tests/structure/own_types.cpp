// What a user forgets in a method or a surface model of their own, or mistakes for a scene or a method, must be named
// by the compiler. Each CASE is right as it is, and wrong in one thing when MUST_NOT_COMPILE is defined.

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

namespace ls = lightswitch;

#ifdef MUST_NOT_COMPILE
#define UNLESS_FORGOTTEN(...)
#define RIGHT_OR_WRONG(right, wrong) wrong
#else
#define UNLESS_FORGOTTEN(...) __VA_ARGS__
#define RIGHT_OR_WRONG(right, wrong) right
#endif

#if CASE == 1
struct Method {
    static constexpr std::string_view name = "without a kind";
    UNLESS_FORGOTTEN(static constexpr ls::Kind kind = ls::Kind::heuristic;)
    ls::Rgb radiance(const auto&, const ls::Ray&, auto&) const { return ls::Rgb(0); }
};
#elif CASE == 2
struct Method {
    static constexpr std::string_view name = "radiance is no number";
    static constexpr ls::Kind kind = ls::Kind::heuristic;
    RIGHT_OR_WRONG(ls::Rgb, float) radiance(const auto&, const ls::Ray&, auto&) const { return {}; }
};
#elif CASE == 3
struct Method {
    static constexpr std::string_view name = "not const";
    static constexpr ls::Kind kind = ls::Kind::heuristic;
    ls::Rgb radiance(const auto&, const ls::Ray&, auto&) RIGHT_OR_WRONG(const, ) { return ls::Rgb(0); }
};
#elif CASE == 4
struct Method {
    static constexpr std::string_view name = "start without iterate";
    static constexpr ls::Kind kind = ls::Kind::heuristic;
    int start(auto&) const { return 0; }
    UNLESS_FORGOTTEN(void iterate(auto& frame, int&)
                         const { frame.pixels([](const ls::Ray&, auto&) { return ls::Rgb(0); }); })
};
#endif

#if CASE <= 4
ls::Image image(const ls::DiffuseScene& scene) { return ls::render(scene, Method{}); }
#elif CASE <= 6
struct Chalk {
#if CASE == 5
    UNLESS_FORGOTTEN(static constexpr bool specular = false;)
    std::string problem() const { return {}; }
#else
    static constexpr bool specular = false;
    UNLESS_FORGOTTEN(std::string problem() const { return {}; })
#endif
    ls::BsdfValue evaluate(const ls::Vec3&, const ls::Vec3&, ls::Transport) const { return {}; }
    ls::Maybe<ls::BsdfSample> sample(const ls::Vec3&, const ls::Vec3&, ls::Transport) const { return {}; }
};
using ChalkScene = ls::Scene<ls::Bsdfs<Chalk>, ls::AllLights>;
ls::Image image(const ChalkScene& scene) { return ls::render(scene, ls::PathTracer{}); }
#elif CASE <= 11
struct Method {
    static constexpr std::string_view name = "a function that frame.pixels or frame.paths cannot call";
    static constexpr ls::Kind kind = ls::Kind::heuristic;
    int start(auto&) const { return 0; }
    void iterate(auto& frame, int&) const {
        int calls = 0;
#if CASE == 7
        frame.pixels([](RIGHT_OR_WRONG(const, ) ls::Ray&, auto& sampler) { return ls::Rgb(sampler.next_1d()); });
#elif CASE == 8
        frame.pixels([](const ls::Ray&, auto&, const auto&) { return RIGHT_OR_WRONG(ls::Rgb(0), 0.0f); });
#elif CASE == 9
        frame.pixels([calls](const ls::Ray&, auto&)
                         RIGHT_OR_WRONG(, mutable) { return ls::Rgb(float(RIGHT_OR_WRONG(calls, ++calls))); });
#elif CASE == 10
        frame.paths(10, [](std::uint64_t, auto& UNLESS_FORGOTTEN(, auto&)) {});
#else
        frame.paths(10, [calls](std::uint64_t, auto&, auto&)
                            RIGHT_OR_WRONG(, mutable) { RIGHT_OR_WRONG(static_cast<void>(calls), ++calls); });
#endif
        static_cast<void>(calls);
    }
};
ls::Image image(const ls::DiffuseScene& scene) { return ls::render(scene, Method{}); }
#elif CASE == 12
ls::Image image(const ls::DiffuseScene& scene) { return ls::render(RIGHT_OR_WRONG(scene, 42), ls::PathTracer{}); }
#elif CASE == 13
ls::Image image(const ls::AnyScene& any) {
    return std::visit([&](const auto& scene) { return ls::render(RIGHT_OR_WRONG(scene, any), ls::PathTracer{}); }, any);
}
#elif CASE == 14
#include <lightswitch/verify/verify.hpp>
ls::Verdict verdict(const ls::DiffuseScene& scene) {
    return ls::verify(RIGHT_OR_WRONG(scene, 42), ls::PathTracer{}, ls::PathTracer{});
}
#elif CASE == 15
ls::Image image(const ls::DiffuseScene& scene, const std::variant<ls::PathTracer>& any) {
    return std::visit([&](const auto& method) { return ls::render(scene, RIGHT_OR_WRONG(method, any)); }, any);
}
#elif CASE == 16
struct Glow {
    static constexpr bool infinite = false;
    double power() const { return 1; }
    ls::LightSample sample(const ls::SurfacePoint&, const ls::Vec2&) const { return {}; }
    UNLESS_FORGOTTEN(Glow light(const ls::RenderSpace&, double) const { return *this; })
};
void add(ls::LibraryDescription& description) { description.add(Glow{}); }
#elif CASE == 17
#include <lightswitch/method/bdpt.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>
struct Pinhole {
    ls::Ray ray(const ls::Vec2&, const ls::Vec2&) const { return {}; }
    bool has_lens() const { return false; }
    int width() const { return 4; }
    int height() const { return 4; }
};
// A camera of rays alone serves methods that trace from it, and no others.
ls::Image image(const ls::DiffuseScene& scene) {
    return ls::render(scene.with_camera(Pinhole{}), RIGHT_OR_WRONG(ls::PathTracerNee, ls::Bdpt){});
}
#elif CASE == 18
struct Chalk {
    static constexpr bool specular = false;
    UNLESS_FORGOTTEN(std::string problem() const { return {}; })
    ls::BsdfValue evaluate(const ls::Vec3&, const ls::Vec3&, ls::Transport) const { return {}; }
    ls::Maybe<ls::BsdfSample> sample(const ls::Vec3&, const ls::Vec3&, ls::Transport) const { return {}; }
};
std::size_t add(ls::LibraryDescription& description) { return description.add(Chalk{}); }
#else
#error "CASE must be 1 to 18"
#endif
