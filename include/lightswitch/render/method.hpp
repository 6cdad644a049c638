#pragma once

// What a rendering method is.

#include <lightswitch/camera/camera.hpp>
#include <lightswitch/core/math.hpp>
#include <lightswitch/core/sampler.hpp>
#include <lightswitch/film/filter.hpp>
#include <lightswitch/geometry/ray.hpp>
#include <lightswitch/render/path_classes.hpp>

#include <concepts>
#include <string_view>

namespace lightswitch {

/// What a method promises.
enum class Kind {
    heuristic,   ///< a picture of the scene, not of its light transport: never compared with the others
    consistent,  ///< the error vanishes as the work grows, but the expected value is off for any finite amount
    unbiased,    ///< the expected value of every iteration is the exact image
};

constexpr std::string_view name(Kind kind) {
    switch (kind) {
        case Kind::heuristic: return "heuristic";
        case Kind::consistent: return "consistent";
        default: return "unbiased";
    }
}

/// What the sample of a pixel in an iteration depends on: what has to be made again to have it again (`replay`). An
/// image method says so with `static constexpr Dependence dependence`; of pixel methods it is known.
enum class Dependence {
    pixel,      ///< on what `frame.pixels` gives for that pixel, and nothing else; splats are looked for in others
    iteration,  ///< on the light paths of the iteration (`frame.paths`), too; other pixels add nothing to it
    history,    ///< on anything before, in other pixels and iterations: what is assumed of a method that does not say
};

/// What rendering asks of a scene, and every method may: the camera and film by which it is seen, and what rays meet.
/// `Scene` is one; so is anything that stands before one, such as a scene that counts its rays. What else a method asks
/// for (surfaces, lights) is between it and the scene: see the members of `Scene`.
template <class S>
concept SceneView = requires(const S scene, const Ray ray) {
    requires Camera<std::remove_cvref_t<decltype(scene.camera())>>;
    { scene.film().filter } -> std::convertible_to<Filter>;
    { static_cast<bool>(scene.intersect(ray)) } -> std::same_as<bool>;
    { scene.occluded(ray) } -> std::convertible_to<bool>;
    { scene.name() } -> std::convertible_to<std::string_view>;
    { scene.camera_id() } -> std::convertible_to<std::string_view>;
};

namespace detail {

/// Named for every type that is to be rendered, so that the compiler says which one is no scene.
template <class S>
struct RequireScene {
    static_assert(
        SceneView<S>,
        "what is rendered must be a scene, such as `stock::cornell_box()` or what `build_scene` returns (std::visit "
        "gives the one in an `AnyScene`), and comes before the method");
    static constexpr bool value = true;
};

}  // namespace detail

/// A type that says what it is: `static constexpr std::string_view name` and `static constexpr Kind kind`.
template <class M>
concept NamedMethod = requires {
    { M::name } -> std::convertible_to<std::string_view>;
    { M::kind } -> std::convertible_to<Kind>;
};

/// A method that estimates one camera ray at a time: `Rgb radiance(scene, ray, sampler) const`, the radiance that
/// arrives at the ray's origin. Called from many threads at once on the same object.
template <class M, class SceneType>
concept PixelMethod = NamedMethod<M> && detail::RequireScene<SceneType>::value &&
    requires(const M method, const SceneType& scene, const Ray& ray, Sampler& sampler) {
    { method.radiance(scene, ray, sampler) } -> std::same_as<Rgb>;
};

/// A method that estimates the whole image at once: `start(frame)` gives the state that it keeps between iterations
/// (what it adds to the film is forgotten), and `iterate(frame, state)` makes one estimate through `frame.pixels` and
/// `frame.paths`. Both are called on one thread. An iteration that is broken off, by an exception or because
/// `frame.stopped()`, must leave the state such that it can be made again. A state may have `statistics()`, which gives
/// pairs of a name (in lower case, with underscores) and a number for `RenderStatistics::of_method`.
template <class M, class FrameType>
concept ImageMethod = NamedMethod<M> && requires(const M method, FrameType& frame) {
    {method.start(frame)};
    method.iterate(frame, *static_cast<decltype(method.start(frame))*>(nullptr));
};

}  // namespace lightswitch
