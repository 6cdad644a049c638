// Renders with every method on every scene type; its machine code is what hot_path.sh looks at. With PLANT_VIRTUAL the
// methods are called through a virtual function, which the check must find.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/render/interactive.hpp>

#include <memory>

namespace ls = lightswitch;

#ifdef PLANT_VIRTUAL
struct Abstract {
    virtual ~Abstract() = default;
    virtual ls::Rgb radiance(const ls::FullScene& scene, const ls::Ray& ray, ls::Sampler& sampler) const = 0;
};
template <class M>
struct Concrete : Abstract {
    M method;
    ls::Rgb radiance(const ls::FullScene& scene, const ls::Ray& ray, ls::Sampler& sampler) const override {
        return method.radiance(scene, ray, sampler);
    }
};
struct Virtual {
    static constexpr std::string_view name = "virtual";
    static constexpr ls::Kind kind = ls::Kind::unbiased;
    std::shared_ptr<Abstract> method;
    ls::Rgb radiance(const ls::FullScene& scene, const ls::Ray& ray, ls::Sampler& sampler) const {
        return method->radiance(scene, ray, sampler);
    }
};
#endif

int main(int argc, char** argv) {
    const std::string_view name = argc > 1 ? argv[1] : "furnace";
    double sum = 0;
#ifdef PLANT_VIRTUAL
    const ls::FullScene scene = ls::build_scene<ls::AllBsdfs, ls::AllLights>(*ls::stock::describe(name));
    Virtual method;
    if (argc > 2) method.method = std::make_shared<Concrete<ls::PathTracer>>();
    else method.method = std::make_shared<Concrete<ls::PathTracerNee>>();
    sum = ls::render(scene, method, {.samples = 1}).mean().x;
#else
    const ls::AnyScene scene = ls::build_any(*ls::stock::describe(name));
    ls::for_each_method([&](const auto& m) {
        const ls::AnyMethod method = m;
        std::visit([&](const auto& s, const auto& chosen) { sum += ls::render(s, chosen, {.samples = 1}).mean().x; },
                   scene, method);
    });
    // What a window does.
    ls::InteractiveRender live(scene, ls::stock::describe(name)->camera);
    ls::for_each_method([&](const auto& m) { live.add(ls::AnyMethod(m)); });
    live.limit(1);
    live.show(3);
    live.wait();
    sum += live.snapshot(3)->image.mean().x;
#endif
    return sum > 0 ? 0 : 1;
}
