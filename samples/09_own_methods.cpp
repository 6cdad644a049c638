// Methods of one's own beside the library's, chosen by name, and a page that compares them:
// 09_own_methods [SECONDS [METHOD...]] writes own-methods.html.
//
// Both show light that is seen directly or after one reflection, as the library's methods do up to path length 2.

#include <lightswitch/lightswitch.hpp>
#include <lightswitch/report/comparison_report.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace ls = lightswitch;

/// Resampled importance sampling (Talbot, Cline and Egbert 2005): of several places on the lights one is chosen in
/// proportion to the light that would arrive from it if nothing were in between; a single shadow ray shows whether
/// something is.
struct Resampled {
    static constexpr std::string_view name = "resampled";
    static constexpr ls::Kind kind = ls::Kind::unbiased;
    int candidates = 8;

    ls::Rgb radiance(const auto& scene, const ls::Ray& ray, auto& sampler) const {
        const auto hit = scene.intersect(ray);
        if (!hit) return scene.environment(ray.direction);
        const ls::Basis basis = hit->shading_frame();
        const ls::Vec3 wo = basis.to_local(-ray.direction);
        ls::Rgb chosen(0);  // the reflected light of the candidate that is kept, divided by its brightness
        ls::Ray visibility;
        float sum = 0;
        for (int i = 0; i < candidates; ++i) {
            const float choice = sampler.next_1d();
            const ls::LightSample light = scene.sample_light(*hit, choice, sampler.next_2d());
            const float keep = sampler.next_1d();
            if (!(light.pdf.value > 0)) continue;
            const ls::Vec3 wi = basis.to_local(light.wi);
            const ls::Rgb reflected = light.radiance * std::abs(wi.z) * scene.with_bsdf(*hit, [&](const auto& bsdf) {
                return bsdf.evaluate(wo, wi, ls::Transport::radiance).value;
            });
            const float brightness = ls::luminance(reflected), weight = brightness / light.pdf.value;
            sum += weight;
            if (!(keep * sum < weight)) continue;
            chosen = reflected / brightness;
            visibility = light.visibility;
        }
        const ls::Rgb seen = scene.emitted(*hit, -ray.direction);
        if (!(sum > 0) || scene.occluded(visibility)) return seen;
        return seen + chosen * (sum / static_cast<float>(candidates));
    }
};

/// Directions by the surface alone, `rays` of them: light where they happen to meet any. An image method, for the
/// example's sake.
struct ByChance {
    static constexpr std::string_view name = "by-chance";
    static constexpr ls::Kind kind = ls::Kind::unbiased;
    int rays = 8;

    struct Nothing {};
    Nothing start(auto&) const { return {}; }
    void iterate(auto& frame, Nothing&) const {
        frame.pixels([&](const ls::Ray& ray, auto& sampler) { return one_pixel(frame.scene(), ray, sampler); });
    }

private:
    ls::Rgb one_pixel(const auto& scene, const ls::Ray& ray, auto& sampler) const {
        const auto hit = scene.intersect(ray);
        if (!hit) return scene.environment(ray.direction);
        const ls::Basis basis = hit->shading_frame();
        ls::Rgb sum(0);
        for (int i = 0; i < rays; ++i) {
            const ls::Vec2 u = sampler.next_2d();
            const float lobe = sampler.next_1d();
            const auto next = scene.with_bsdf(*hit, [&](const auto& bsdf) {
                return bsdf.sample(basis.to_local(-ray.direction), ls::Vec3(u, lobe), ls::Transport::radiance);
            });
            if (!next) continue;
            const ls::Ray second = hit->spawn(basis.to_world(next->wi));
            const auto lamp = scene.intersect(second);
            sum +=
                next->weight * (lamp ? scene.emitted(*lamp, -second.direction) : scene.environment(second.direction));
        }
        return scene.emitted(*hit, -ray.direction) + sum / static_cast<float>(rays);
    }
};

using Any = ls::append_t<ls::AnyMethod, Resampled, ByChance>;

int main(int argc, char** argv) try {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 1;
    std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
    if (names.empty()) names = {"path-nee", "resampled", "by-chance"};

    const auto scene = ls::stock::cornell_box();
    const ls::PathLength length{.max_depth = 2};
    const ls::Image reference = ls::render(scene, ls::PathTracerNee{.max_depth = 2}, {.samples = 256}, {.seed = 1});
    std::vector<ls::ComparedImage> images{{"reference", reference}};
    for (const std::string& name : names) {
        Any method = ls::method_by_name<Any>(name);
        ls::set_path_length(method, length);
        const auto render = [&](const auto& m) {
            return ls::render_measured(scene, m, reference, {.seconds = seconds});
        };
        images.push_back(std::visit(render, method));
    }
    ls::save_report("own-methods.html", ls::comparison_report(images, 0));
    std::printf("wrote own-methods.html\n");
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
