// What a user forgets in a method or a surface model of their own must be named by the compiler. Each CASE is complete
// as it is, and lacks one thing when MUST_NOT_COMPILE is defined.

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
// What the documentation tells users to write, because GCC says only that Bsdfs<Chalk> is wrong, but not why.
static_assert(ls::Bsdf<Chalk>);
using ChalkScene = ls::Scene<ls::Bsdfs<Chalk>, ls::AllLights>;
ls::Image image(const ChalkScene& scene) { return ls::render(scene, ls::PathTracer{}); }
#else
#error "CASE must be 1 to 6"
#endif
