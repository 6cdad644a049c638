#include "load.hpp"

#include "messages.hpp"
#include "scene_files.hpp"
#include "text.hpp"
#include "warnings.hpp"

#include <lightswitch/compiled.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/scene/stock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace lightswitch::program {
namespace {

/// One line for a problem and what was done about it.
std::string line(const Problem& problem) { return fmt::format("{}; {}", problem.text, problem.instead); }

LibraryDescription load_file(const SceneOptions& options, Notices& notices, Problems& problems) {
    try {
        return load_mitsuba(options.scene,
                            MitsubaOptions{.defines = options.defines,
                                           .strictness = options.lenient ? Strictness::lenient : Strictness::strict,
                                           .search_paths = options.search_paths,
                                           .sensor = options.sensor,
                                           .notices = &notices,
                                           .problems = &problems});
    } catch (const UnsupportedScene& error) {
        const std::size_t count = error.problems().size();
        throw Error(fmt::format(
            "{} ({}: \"lightswitch info\" lists {}, --lenient goes on with stand-ins)", error.what(),
            count == 1 ? "the only thing that is not supported" : fmt::format("{} things are not supported", count),
            count == 1 ? "it" : "them"));
    }
}

LibraryDescription describe(const SceneOptions& options, Notices& notices, Problems& problems) {
    const std::string& scene = options.scene;
    if (is_mitsuba_file(scene)) return load_file(options, notices, problems);
    if (is_scene_file(scene)) {
        if (!options.defines.empty()) throw Error("--define: only Mitsuba scenes have parameters");
        if (!options.search_paths.empty())
            throw Error("--path: only the files that Mitsuba scenes name are looked for in other folders");
        if (!options.sensor.empty()) throw Error("--sensor: only Mitsuba scenes have cameras to choose from");
        return load_other_file(scene, notices);
    }
    const auto stock = stock::describe(scene);
    if (!stock) {
        std::error_code ignored;
        if (std::filesystem::exists(scene, ignored))
            throw Error(fmt::format("{}: is not a scene: scene files end in {}", scene, scene_endings()));
        throw Error(fmt::format("there is no scene \"{}\"{}; a scene is a file that ends in {}, or one of {}", scene,
                                suggestion(scene, stock::names), scene_endings(), list(stock::names)));
    }
    if (!options.defines.empty()) throw Error("--define: the stock scenes have no parameters");
    if (!options.search_paths.empty()) throw Error("--path: the stock scenes have no files");
    if (!options.sensor.empty()) throw Error("--sensor: the stock scenes have one camera each");
    return *stock;
}

std::string material_name(const LibraryDescription::NamedMaterial& material) {
    const std::string sides = material.two_sided ? "two-sided " : "";
    if (material.layer) return sides + std::string(layer_name(*material.layer));
    return sides + (material.bsdf.placed() ? "textured " : "") + std::string(material.bsdf.model_name());
}

SceneSummary summarize(const LibraryDescription& scene) {
    SceneSummary summary{.camera = scene.camera,
                         .size = {scene.film.width, scene.film.height},
                         .max_depth = scene.max_depth,
                         .rr_depth = scene.rr_depth,
                         .samples = scene.samples,
                         .materials = {},
                         .files = {scene.files.begin(), scene.files.end()},
                         .exposure = scene.exposure,
                         .stand_ins = {}};
    const auto count = [&](const auto& shape) {
        const bool mesh = std::holds_alternative<Mesh>(shape.geometry);
        summary.meshes += mesh ? 1 : 0;
        if (shape.emission) ++(mesh ? summary.luminous_meshes : summary.luminous_spheres);
    };
    for (const auto& shape : scene.shapes) count(shape);
    for (const auto& group : scene.groups)
        for (const auto& shape : group.shapes) count(shape);
    for (const auto& placed : scene.sources) {
        if (placed.source.is_environment()) ++summary.environments;
        if (placed.source.get<PointSource>()) ++summary.point_lights;
        if (placed.source.get<SpotSource>()) ++summary.spot_lights;
        if (placed.source.get<DirectionalSource>()) ++summary.directional_lights;
    }
    for (const auto& material : scene.materials) ++summary.materials[material_name(material)];
    return summary;
}

}  // namespace

LoadedScene load_scene(const SceneOptions& options, bool quiet, StandIns tell_stand_ins) {
    Notices notices;
    Problems problems;
    LibraryDescription description = describe(options, notices, problems);
    if (!quiet)
        for (const std::string& notice : notices) print_warning(notice);
    std::vector<std::string> stand_ins;
    for (const Problem& problem : problems) stand_ins.push_back(line(problem));
    if (tell_stand_ins == StandIns::warn)
        for (const std::string& text : stand_ins) print_warning(text);
    if (options.size) description.film.resize(options.size->width, options.size->height);
    else if (options.shrink_to > 0) description.film.shrink(options.shrink_to);
    if (options.filter) description.film.filter = *options.filter;
    SceneSummary summary = summarize(description);
    summary.stand_ins = std::move(stand_ins);
    const DivertedOutput embree_may_talk;
    AnyScene scene = build_any(description, options.build);
    if (!quiet) warn_about_coincident_lights(scene, description);
    return {std::move(summary), std::move(scene)};
}

PathLength path_length(const SceneSummary& summary, const std::optional<int>& max_depth,
                       const std::optional<int>& rr_depth) {
    const PathLength usual;
    return {.max_depth = max_depth.value_or(summary.max_depth.value_or(usual.max_depth)),
            .rr_depth = rr_depth.value_or(summary.rr_depth.value_or(usual.rr_depth))};
}

void keep_stand_ins(Image& image, const SceneSummary& summary) {
    constexpr std::size_t most = 50;  // a header should not outgrow its image
    const std::vector<std::string>& stand_ins = summary.stand_ins;
    if (stand_ins.empty()) return;
    const auto end = stand_ins.begin() + static_cast<std::ptrdiff_t>(std::min(most, stand_ins.size()));
    std::string text = fmt::format("{}", fmt::join(stand_ins.begin(), end, " | "));
    if (stand_ins.size() > most) text += fmt::format(" | and {} more", stand_ins.size() - most);
    image.metadata["stand_ins"] = text;
}

std::optional<Box> bounds(const AnyScene& any_scene) {
    return std::visit(
        [](const auto& scene) -> std::optional<Box> {
            if (scene.statistics().triangles + scene.statistics().spheres == 0) return {};
            RTCBounds box;
            rtcGetSceneBounds(scene.accelerator().handle(), &box);
            const RenderSpace& space = scene.space();
            const auto corner = [&](float x, float y, float z) { return space.scene_point(DVec3(x, y, z)); };
            return Box{corner(box.lower_x, box.lower_y, box.lower_z), corner(box.upper_x, box.upper_y, box.upper_z)};
        },
        any_scene);
}

}  // namespace lightswitch::program
