#include "denoising.hpp"

#include "messages.hpp"

#include <lightswitch/reconstruct/denoise.hpp>

#include <fmt/format.h>

#include <chrono>

namespace lightswitch::program {
namespace {

template <Reconstructor R>
Rendered run_with(const R& reconstructor, HalvedSession& session, const Job& job, Guides guides, Denoising& denoising) {
    using Clock = std::chrono::steady_clock;
    if constexpr (requires { reconstructor.prepare(guides); }) guides = reconstructor.prepare(guides);
    session.run(job.budget, reconstructor, guides);
    if (session.samples() == 0) return {session.image(), session.statistics(), 0};
    const auto begin = Clock::now();
    denoising.samples = session.image();
    denoising.mixed = session.reconstruct(reconstructor, guides);
    denoising.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return {denoising.mixed.image, session.statistics(), denoising.mixed.relative_error};
}

Image guide(const std::vector<Layer>& layers, std::string_view name) {
    for (const Layer& layer : layers)
        if (layer.name == name) return layer.image;
    return {};
}

}  // namespace

std::string choose_denoiser(std::string_view wanted) {
    if (wanted == "auto") return std::string(Oidn::why_not() ? Regression::name : Oidn::name);
    if (wanted == Oidn::name) {
        try {
            const Oidn probe(1);
        } catch (const Error& error) {
            throw Error(fmt::format("--denoise oidn: {}; --denoise own needs nothing", error.what()));
        }
    }
    return std::string(wanted);
}

Rendered run_denoised(const AnyScene& any_scene, const AnyMethod& any_method, const Job& job,
                      const std::vector<Layer>& layers, Denoising& denoising) {
    return std::visit(
        [&](const auto& scene, const auto& method) -> Rendered {
            const HalvedSession* running = nullptr;
            Settings settings = job.settings;
            settings.observer = [&](const Progress& progress) {
                job.progress(progress, running->statistics().counts.rays);
                job.observer(progress, {.statistics = running->statistics(), .state = {}, .image = {}});
            };
            HalvedSession session(scene, method, settings);
            running = &session;
            Guides guides{.albedo = guide(layers, "albedo"), .normal = guide(layers, "normal")};
            if (denoising.denoiser == Oidn::name)
                return run_with(Oidn(settings.threads), session, job, std::move(guides), denoising);
            return run_with(Regression{}, session, job, std::move(guides), denoising);
        },
        any_scene, any_method);
}

void warn_about_denoising(const Denoising& denoising, std::uint64_t samples) {
    if (samples < 2)
        print_warning("a single sample per pixel says nothing of the denoiser's error: it is not known; give --spp 2");
    const std::optional<Contradiction>& contradiction = denoising.mixed.contradiction;
    if (!contradiction) return;
    print_warning(fmt::format(
        "denoiser and samples contradict each other in {:.2g} % of the image, most clearly around pixel ({}, {}), in "
        "detail of about {} pixels: by {:.2g} % of the radiance, {:.3g} times what noise would do; the samples are "
        "believed there",
        100 * contradiction->share, contradiction->x, contradiction->y, contradiction->size,
        100 * contradiction->difference, std::sqrt(contradiction->ratio)));
}

void add_denoising_layers(std::vector<Layer>& layers, const Denoising& denoising) {
    layers.push_back({"error", "Y", denoising.mixed.error});
    layers.push_back({"from_samples", "Y", denoising.mixed.from_samples});
    layers.push_back({"samples", "RGB", denoising.samples});
}

}  // namespace lightswitch::program
