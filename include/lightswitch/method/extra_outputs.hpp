#pragma once

// Extra outputs: what the camera's rays meet rather than how it is lit. Images to guide a denoiser, to composite and to
// look at. Each is a method of its own; `render_outputs` renders several at once, by the camera rays of the image.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/embree/accelerator.hpp>
#include <lightswitch/film/layer.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/render/render.hpp>

#include <chrono>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace lightswitch {

namespace detail {

/// The colour of a surface model: its `albedo()`, or what `phong()` says, or grey.
template <class B>
Rgb albedo_of(const B& bsdf) {
    if constexpr (requires { bsdf.albedo(); }) {
        return bsdf.albedo();
    } else if constexpr (requires { bsdf.phong(); }) {
        const auto terms = bsdf.phong();
        return terms.diffuse + terms.specular;
    } else {
        return Rgb(0.5f);
    }
}

}  // namespace detail

// A sampled output has `of(scene, ray, hit)`, its value for a camera ray and the surface that it has met, if any. What
// belongs to no surface is 0.

/// The colour of the first surface that is neither mirror nor clear glass, 0 to 1: a model's `albedo()`, else the
/// diffuse and specular colours of its `phong()` (of metal, the reflectance at normal incidence), else 0.5.
///
/// A mirror shows the colour of what is seen in it, times its own, and glass that of the stronger of reflection and
/// refraction, so that there is no noise (where a model chooses its lobe by a random number, the one that 1/2 chooses).
/// What is still not found after `max_bounces` of them counts as white, as Open Image Denoise's documentation advises.
/// Emission is added: lamps are white, or, where they are dim, have their own colour.
struct Albedo {
    static constexpr std::string_view name = "albedo", channels = "RGB";
    static constexpr Kind kind = Kind::heuristic;

    int max_bounces = 8;

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const { return of(scene, ray, scene.intersect(ray)); }

    Rgb of(const auto& scene, const Ray&, auto hit) const {
        Rgb sum(0), throughput(1);
        for (int bounce = 0; hit; ++bounce) {
            sum += throughput * scene.emitted(*hit, hit->wo);
            const Maybe<BsdfSample> mirrored = scene.with_bsdf(*hit, [&]<class B>(const B& bsdf) {
                if constexpr (B::specular) {
                    if (bounce < max_bounces)
                        return bsdf.sample(hit->shading_frame().to_local(hit->wo), Vec3(0.5f), Transport::radiance);
                    sum += throughput;
                } else {
                    sum += throughput * glm::clamp(detail::albedo_of(bsdf), 0.0f, 1.0f);
                }
                return Maybe<BsdfSample>();
            });
            if (!mirrored) break;
            throughput *= mirrored->weight * square(mirrored->eta);  // refraction changes no colour
            hit = scene.intersect(hit->spawn(hit->shading_frame().to_world(mirrored->wi)));
        }
        return glm::clamp(sum, 0.0f, 1.0f);
    }
};

/// The shading normal of the first surface, along the scene's axes, -1 to 1: on the side from which the surface is
/// seen, as the geometric normal says. A pixel at an edge has the mean of unit vectors, which is shorter.
struct ShadingNormal {
    static constexpr std::string_view name = "normal", channels = "XYZ";
    static constexpr Kind kind = Kind::heuristic;

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const { return of(scene, ray, scene.intersect(ray)); }

    Rgb of(const auto&, const Ray&, const auto& hit) const {
        if (!hit) return Rgb(0);
        return dot(hit->normal, hit->wo) < 0 ? -hit->shading_normal : hit->shading_normal;
    }
};

/// The distance along the ray from the camera (its lens, or where rays are parallel its plane) to the first surface, in
/// scene units.
struct Depth {
    static constexpr std::string_view name = "depth", channels = "Z";
    static constexpr Kind kind = Kind::heuristic;

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const { return of(scene, ray, scene.intersect(ray)); }

    Rgb of(const auto& scene, const Ray& ray, const auto& hit) const {
        if (!hit) return Rgb(0);
        double distance = double(hit->distance);
        if constexpr (requires { scene.camera().start(ray); }) distance += scene.camera().start(ray);
        return Rgb(static_cast<float>(scene.space().scene_length(distance)));
    }
};

/// Where the first surface lies, in the scene's coordinates and units.
struct Position {
    static constexpr std::string_view name = "position", channels = "XYZ";
    static constexpr Kind kind = Kind::heuristic;

    Rgb radiance(const auto& scene, const Ray& ray, auto&) const { return of(scene, ray, scene.intersect(ray)); }

    Rgb of(const auto& scene, const Ray&, const auto& hit) const {
        return hit ? Rgb(scene.space().scene_point(DVec3(hit->position))) : Rgb(0);
    }
};

namespace detail {

/// A number of what the centre of each pixel sees (through the centre of the lens), the same in every iteration:
/// numbers have no mean. A float holds those up to 2^24.
template <class Numbers>
struct AtPixelCentres {
    struct Nothing {};
    Nothing start(auto&) const { return {}; }

    void iterate(auto& frame, Nothing&) const {
        const auto& scene = frame.scene();
        const auto width = static_cast<std::size_t>(frame.width());
        frame.pixels([&](const Ray&, auto&, const PixelContext& pixel) {
            const Vec2 centre(static_cast<float>(pixel.index % width) + 0.5f,
                              static_cast<float>(pixel.index / width) + 0.5f);
            const auto hit = scene.identify(scene.camera().ray(centre, Vec2(0.5f)));
            return hit ? Rgb(static_cast<float>(Numbers::number(*hit))) : Rgb(0);
        });
    }
};

}  // namespace detail

/// Which shape the centre of the pixel sees: meshes count from 1 in the order of the description (those without a
/// triangle that has an area are left out), then those of groups, the same in every instance, and all spheres share the
/// number after them. 0 is nothing.
struct ShapeNumber : detail::AtPixelCentres<ShapeNumber> {
    static constexpr std::string_view name = "shape", channels = "I";
    static constexpr Kind kind = Kind::heuristic;

    static double number(const embree::Hit& hit) { return double(hit.geometry) + 1; }
};

/// Which primitive of that shape: its triangles (those that have an area), or the scene's spheres, count from 1. 0 is
/// nothing.
struct PrimitiveNumber : detail::AtPixelCentres<PrimitiveNumber> {
    static constexpr std::string_view name = "primitive", channels = "I";
    static constexpr Kind kind = Kind::heuristic;

    static double number(const embree::Hit& hit) { return double(hit.primitive) + 1; }
};

/// Any of the outputs.
using ExtraOutput = std::variant<Albedo, ShadingNormal, Depth, Position, ShapeNumber, PrimitiveNumber>;

inline std::string_view output_name(const ExtraOutput& output) {
    return std::visit([](const auto& o) -> std::string_view { return o.name; }, output);
}

/// All of them, with their defaults.
inline const std::vector<ExtraOutput>& extra_outputs() {
    static const std::vector<ExtraOutput> all = []<std::size_t... I>(std::index_sequence<I...>) {
        return std::vector<ExtraOutput>{std::variant_alternative_t<I, ExtraOutput>{}...};
    }
    (std::make_index_sequence<std::variant_size_v<ExtraOutput>>{});
    return all;
}

/// The names of all outputs, separated by commas.
inline std::string output_names() {
    std::string names;
    for (const ExtraOutput& output : extra_outputs())
        names += (names.empty() ? "" : ", ") + std::string(output_name(output));
    return names;
}

/// The output of that name, with its defaults. Throws `Error` that lists the names when there is none.
inline ExtraOutput output_by_name(std::string_view wanted) {
    for (const ExtraOutput& output : extra_outputs())
        if (output_name(output) == wanted) return output;
    throw Error("there is no output \"" + std::string(wanted) + "\"; known are " + output_names());
}

namespace detail {

template <class Output>
inline constexpr bool is_number = std::is_base_of_v<AtPixelCentres<Output>, Output>;

/// The sum of one output's samples. Nothing but the channels that it has: there may be many outputs.
class OutputSums {
public:
    OutputSums(const ExtraOutput& output, std::size_t area)
        : output_(output),
          channels_(std::visit([](const auto& o) { return o.channels.size(); }, output)),
          sums_(area * channels_) {}

    /// From several threads, for different pixels.
    void add(std::size_t pixel, const auto& scene, const Ray& ray, const auto& hit) {
        std::visit(
            [&](const auto& output) {
                if constexpr (!is_number<std::remove_cvref_t<decltype(output)>>) {
                    const Rgb value = output.of(scene, ray, hit);
                    for (std::size_t c = 0; c < channels_ && is_finite(value); ++c)
                        sums_[pixel * channels_ + c] += double(value[static_cast<int>(c)]);
                }
            },
            output_);
    }

    /// As the output's own method has it: grey where there is one channel.
    Image mean(int width, int height, double samples) const {
        Image image(width, height);
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                image.pixels()[i][static_cast<int>(c)] =
                    static_cast<float>(sums_[i * channels_ + std::min(c, channels_ - 1)] / samples);
        return image;
    }

private:
    ExtraOutput output_;
    std::size_t channels_;
    std::vector<double> sums_;
};

/// Adds the samples of all outputs; false when `settings.stop` has asked for an end before the last.
template <class SceneType>
bool add_samples(const SceneType& scene, std::vector<OutputSums>& sums, int samples, const Settings& settings) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const TbbExecutor executor(settings.threads);
    Film film(scene.camera().width(), scene.camera().height());  // for the frame's sake
    RenderCounts counts;
    for (int i = 0; i < samples; ++i) {
        Frame<SceneType, TbbExecutor> frame({.scene = scene,
                                             .film = film,
                                             .executor = executor,
                                             .sampling = settings.sampling,
                                             .seed = settings.seed,
                                             .iteration = static_cast<std::uint64_t>(i),
                                             .stop = settings.stop,
                                             .counts = counts});
        frame.pixels([&](const Ray& ray, auto&, const PixelContext& pixel) {
            const auto hit = scene.intersect(ray);
            for (OutputSums& sum : sums) sum.add(pixel.index, scene, ray, hit);
            return Rgb(0);
        });
        if (settings.stop.stop_requested()) return false;
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        const double fraction = (i + 1.0) / samples;
        if (settings.observer)
            settings.observer({.iterations = static_cast<std::uint64_t>(i) + 1,
                               .seconds = seconds,
                               .fraction = fraction,
                               .seconds_left = detail::seconds_left(seconds, fraction),
                               .film = film});
    }
    return true;
}

}  // namespace detail

/// Renders outputs of a scene, of the size of its image: layers for `save_layers`, in the order given, each as
/// `render(scene, output, {.samples = samples}, settings)` would make it, to the bit (but the film rounds a channel to
/// 2^-64 of the largest in its pixel, and values that are not finite in single precision are not counted). A camera ray
/// and the surface that it meets are found once for all of them. With the seed and sampling of an image, the rays are
/// those of its first `samples` iterations: edges are filtered alike, as denoisers need it.
///
/// 64 samples leave little noise: outputs have none but at edges and out of focus. The observer is called after each
/// with an empty film. When `settings.stop` asks for an end there are no layers. Throws `Error` unless `samples` is at
/// least 1.
template <class SceneType>
std::vector<Layer> render_outputs(const SceneType& scene, const std::vector<ExtraOutput>& outputs, int samples = 64,
                                  const Settings& settings = {}) {
    static_assert(detail::RequireScene<SceneType>::value);
    if (samples < 1) throw Error("extra outputs of " + std::to_string(samples) + " samples: give at least 1");
    std::vector<Layer> layers;
    std::vector<detail::OutputSums> sums;
    std::vector<std::size_t> layer_of_sum;
    for (const ExtraOutput& output : outputs)
        std::visit(
            [&]<class Output>(const Output& o) {
                Image image;
                if constexpr (detail::is_number<Output>) {
                    Settings unobserved = settings;
                    unobserved.observer = {};
                    image = render(scene, o, {.samples = 1}, unobserved);
                } else {
                    layer_of_sum.push_back(layers.size());
                    sums.emplace_back(output,
                                      std::size_t(scene.camera().width()) * std::size_t(scene.camera().height()));
                }
                layers.push_back({std::string(o.name), std::string(o.channels), std::move(image)});
            },
            output);
    if (!sums.empty() && !detail::add_samples(scene, sums, samples, settings)) return {};
    for (std::size_t i = 0; i < sums.size(); ++i)
        layers[layer_of_sum[i]].image = sums[i].mean(scene.camera().width(), scene.camera().height(), samples);
    if (settings.stop.stop_requested()) return {};
    return layers;
}

}  // namespace lightswitch
