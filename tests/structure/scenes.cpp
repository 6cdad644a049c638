// What the compiler must refuse about scenes: more kinds than a scene type can number, and a session on one that is
// about to go. Each CASE is right unless MUST_NOT_COMPILE is defined.

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/stock.hpp>

namespace ls = lightswitch;

#if CASE <= 2
// One number is left for layers of materials.
#ifdef MUST_NOT_COMPILE
constexpr int kinds = CASE == 1 ? 31 : 32;
#else
constexpr int kinds = CASE == 1 ? 30 : 31;
#endif
#endif

#if CASE == 1
template <int>
struct Chalk : ls::Lambert {};
template <int... Number>
std::size_t size(std::integer_sequence<int, Number...>) {
    return sizeof(ls::Scene<ls::Bsdfs<Chalk<Number>...>, ls::AllLights>);
}
std::size_t all() { return size(std::make_integer_sequence<int, kinds>()); }
#elif CASE == 2
template <int>
struct Lamp : ls::PointLight {};
template <int... Number>
std::size_t size(std::integer_sequence<int, Number...>) {
    return sizeof(ls::Scene<ls::Bsdfs<ls::Lambert>, ls::Lights<Lamp<Number>...> >);
}
std::size_t all() { return size(std::make_integer_sequence<int, kinds>()); }
#elif CASE == 3 || CASE == 4
#if CASE == 3
#define EXECUTOR
#else
#define EXECUTOR , {}, ls::SerialExecutor()
#endif
void render() {
    const ls::DiffuseScene scene = ls::stock::furnace();
#ifdef MUST_NOT_COMPILE
    ls::Session session(ls::stock::furnace(), ls::PathTracer() EXECUTOR);
#else
    ls::Session session(scene, ls::PathTracer() EXECUTOR);
#endif
    session.run({.samples = 1});
}
#else
#error "CASE must be 1 to 4"
#endif
