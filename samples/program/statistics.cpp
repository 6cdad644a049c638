#include "statistics.hpp"

#include "method_options.hpp"

#include <lightswitch/version.hpp>

#include <nlohmann/json.hpp>

namespace lightswitch::program {
namespace {

using Json = nlohmann::ordered_json;

/// Where a value was not finite, and how to meet it again.
Json non_finite(const RenderCounts& counts, int width) {
    Json places = Json::array();
    for (const NonFinite& place : counts.first_non_finite) {
        const auto columns = static_cast<std::uint32_t>(width);
        places.push_back({{"x", place.pixel % columns},
                          {"y", place.pixel / columns},
                          {"iteration", place.iteration},
                          {"seed", place.seed}});
    }
    return places;
}

}  // namespace

std::string statistics_json(const LoadedScene& loaded, const AnyMethod& method, const RenderOptions& options,
                            const Rendered& rendered, const Denoising& denoising) {
    const RenderStatistics& statistics = rendered.statistics;
    const RenderCounts& counts = statistics.counts;
    const DVec3 mean = rendered.image.mean();
    const double width = rendered.image.width(), height = rendered.image.height();
    const auto per_second = [&](double amount) { return statistics.seconds > 0 ? amount / statistics.seconds : 0; };
    const std::string_view scene_type = scene_type_name(loaded.scene);

    Json json{{"method", method_name(method)},
              {"kind", name(method_kind(method))},
              {"scene", options.scene.scene},
              {"scene_type", scene_type.substr(0, scene_type.find(':'))},
              {"width", rendered.image.width()},
              {"height", rendered.image.height()},
              {"samples_per_pixel", statistics.iterations},
              {"seconds", statistics.seconds},
              {"rays", counts.rays},
              {"shadow_rays", counts.shadow_rays},
              {"rays_per_second", per_second(double(counts.rays))},
              {"samples_per_second", per_second(double(statistics.iterations) * width * height)},
              {"threads", statistics.threads},
              {"processes", rendered.sharing.ranks},
              {"seed", options.seed},
              {"sampler", name(options.sampling)},
              {"max_depth", nullptr},
              {"rr_depth", nullptr}};
    std::visit(
        [&](const auto& m) {
            if constexpr (requires { m.max_depth; }) json["max_depth"] = m.max_depth;
            if constexpr (requires { m.rr_depth; }) json["rr_depth"] = m.rr_depth;
        },
        method);
    for (const auto& setting : settings_of(method))
        std::visit([&](auto value) { json[std::string(setting.first)] = value; }, setting.second);
    json["stand_ins"] = loaded.summary.stand_ins;
    json["mean"] = {mean.x, mean.y, mean.z};
    json["estimated_error"] = rendered.estimated_error;
    json["non_finite"] = counts.non_finite;
    json["first_non_finite"] = non_finite(counts, rendered.image.width());
    json["splats"] = counts.splats;
    json["paths"] = counts.paths;
    std::visit(
        [&](const auto& built) {
            const SceneStatistics& of_scene = built.statistics();
            json["triangles"] = of_scene.triangles;
            json["spheres"] = of_scene.spheres;
            json["lights"] = of_scene.lights;
            json["build_seconds"] = of_scene.build_seconds;
            json["embree_bytes"] = of_scene.embree_bytes;
            json["scene_bytes"] = of_scene.scene_bytes;
            json["camera"] = built.camera_id();
        },
        loaded.scene);
    if (!denoising.denoiser.empty()) {
        json["denoiser"] = denoising.denoiser;
        json["denoise_seconds"] = denoising.seconds;
        json["estimated_error_of_samples"] = denoising.mixed.relative_error_of_samples;
        json["estimated_error_of_denoised"] = denoising.mixed.relative_error_of_denoised;
        json["detail_from_samples"] = denoising.mixed.detail_from_samples;
    }
    if (const Sharing& sharing = rendered.sharing; sharing.ranks > 1) {
        json["gatherings"] = sharing.gatherings;
        json["most_bytes_sent"] = sharing.most_bytes_sent;
        json["most_seconds_waited"] = sharing.most_seconds_waited;
    }
    for (const auto& [key, value] : statistics.of_method) json[key] = value;
    json["embree_version"] = RTC_VERSION_STRING;
    json["lightswitch_version"] = version();
    json["cancelled"] = statistics.cancelled;
    // JSON has no infinity: null stands for it. Names need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lightswitch::program
