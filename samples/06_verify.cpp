// Is my method right? Direct light, written by hand, against the path tracer that stops there; once as it should be,
// and once with the cosine forgotten.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/verify/verify.hpp>

#include <iostream>

namespace ls = lightswitch;

template <bool forgets_cosine>
struct DirectLight {
    static constexpr std::string_view name = forgets_cosine ? "direct-light-without-cosine" : "direct-light";
    static constexpr ls::Kind kind = ls::Kind::unbiased;

    ls::Rgb radiance(const auto& scene, const ls::Ray& ray, auto& sampler) const {
        const auto hit = scene.intersect(ray);
        if (!hit) return scene.environment(ray.direction);
        ls::Rgb sum = scene.emitted(*hit, -ray.direction);
        const ls::LightSample light = scene.sample_light(*hit, sampler.next_1d(), sampler.next_2d());
        if (!(light.pdf.value > 0) || scene.occluded(light.visibility)) return sum;
        const ls::Basis basis = hit->shading_frame();
        const ls::Vec3 wo = basis.to_local(-ray.direction), wi = basis.to_local(light.wi);
        const ls::BsdfValue bsdf =
            scene.with_bsdf(*hit, [&](const auto& b) { return b.evaluate(wo, wi, ls::Transport::radiance); });
        const float cosine = forgets_cosine ? 1.0f : std::abs(wi.z);
        return sum + bsdf.value * light.radiance * (cosine / light.pdf.value);
    }
};

int main() try {
    const auto scene = ls::stock::cornell_box();
    const ls::PathTracer truth{.max_depth = 2};
    const ls::Verdict right = ls::verify(scene, DirectLight<false>{}, truth, {.seconds = 20, .tolerance = 0.05});
    const ls::Verdict wrong = ls::verify(scene, DirectLight<true>{}, truth, {.seconds = 20, .tolerance = 0.05});
    std::cout << right << wrong;
    return !right.disagrees() && wrong.disagrees() ? 0 : 1;
} catch (const ls::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
