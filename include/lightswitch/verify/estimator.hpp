#pragma once

// A source of independent images with one expected value: a method on a scene, files of another renderer, or the
// exact image.

#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/scene.hpp>
#include <lightswitch/verify/brightest.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// What `verify` compares: something that gives independent, noisy images with one expected value, as many as one
/// asks for. `render` may be called from several threads at once; what it refers to must outlive it.
struct Estimator {
    /// What one image is to be made of.
    struct Request {
        std::uint64_t seed = 0;  ///< different seeds give independent images
        std::uint64_t index =
            0;               ///< how many images were asked for before, for sources that have a fixed number of them
        int iterations = 1;  ///< samples per pixel
        int max_depth = unlimited;  ///< longest path, or what the method itself says
        PathClasses left_out = {};  ///< paths that are not to be made, of those in `Estimator::can_leave_out`
        std::stop_token stop = {};  ///< ends the render early; the image is then thrown away

        static constexpr int unlimited = -1;
    };

    std::string name;
    Kind kind = Kind::unbiased;
    bool limits_depth = false;           ///< honours `Request::max_depth`
    int max_depth = Request::unlimited;  ///< longest path of the whole image
    PathClasses missing = {};            ///< paths that the scene may hold and the method does not make
    PathClasses can_leave_out = {};      ///< honours `Request::left_out`
    bool independent_pixels = false;     ///< pixels share no random numbers: true of pixel methods
    bool exact = false;                  ///< has no noise: one image is all there is to know
    std::uint64_t available = 0;         ///< number of images that there are; 0: as many as one asks for
    /// The largest radiance that a path can find by chance, per channel and for one sample per pixel
    /// (`brightest_event`); 0 when it is not known. What was not seen yet may be as bright.
    Rgb brightest{0};
    std::function<Image(const Request&)> render;
};

/// The method on the scene. Refers to `scene` and copies `method`. A member `max_depth` of the method is taken to be
/// the longest path as in `PathLength`: 1 is emission seen directly, 2 adds direct light, -1 is unlimited.
template <class SceneType, class M>
Estimator estimator(const SceneType& scene, const M& method, const Settings& settings = {}) {
    static_assert(detail::RequireScene<SceneType>::value);
    constexpr bool limits_depth = requires(M m) { m.max_depth = 1; };
    Estimator result;
    result.name = std::string(M::name);
    result.kind = M::kind;
    result.limits_depth = limits_depth;
    result.independent_pixels = PixelMethod<M, SceneType>;
    if constexpr (limits_depth) result.max_depth = method.max_depth;
    constexpr bool leaves_out = requires(M m) { m.left_out = M::can_leave_out; };
    PathClasses missing = cannot_make<M>();
    if constexpr (leaves_out) missing = missing | method.left_out;
    result.missing = possible_paths(scene) & missing;
    if (result.max_depth >= 0 && result.max_depth < result.missing.shortest()) result.missing = {};
    if constexpr (leaves_out) result.can_leave_out = M::can_leave_out;
    result.brightest = brightest_event(scene);
    result.render = [&scene, method, settings](const Estimator::Request& request) {
        M limited = method;
        if constexpr (limits_depth)
            if (request.max_depth >= 0 && (method.max_depth < 0 || request.max_depth < method.max_depth))
                limited.max_depth = request.max_depth;
        if constexpr (leaves_out) limited.left_out = method.left_out | request.left_out;
        Settings own = settings;
        own.seed = request.seed;
        own.stop = request.stop;
        return lightswitch::render(scene, limited, {.samples = request.iterations}, own);
    };
    return result;
}

/// The scene would be gone before the estimator is used.
template <class SceneType, class M>
requires requires { typename SceneType::Data; }
Estimator estimator(const SceneType&& scene, const M& method, const Settings& settings = {}) = delete;

/// The same for a scene that nobody else keeps.
template <class SceneType, class M>
Estimator estimator(std::shared_ptr<const SceneType> scene, const M& method, const Settings& settings = {}) {
    Estimator result = estimator(*scene, method, settings);
    result.render = [scene, inner = std::move(result.render)](const Estimator::Request& request) {
        return inner(request);
    };
    return result;
}

/// Images that are there already: independent renders of one scene by another renderer, say. Throws `Error` without
/// any.
inline Estimator given(std::vector<Image> images, std::string name) {
    if (images.empty()) throw Error(name + ": there are no images");
    Estimator result;
    result.name = std::move(name);
    result.available = images.size();
    result.render = [all = std::make_shared<const std::vector<Image>>(std::move(images))](
                        const Estimator::Request& request) { return all->at(request.index); };
    return result;
}

/// An image without noise: what theory says.
inline Estimator exactly(Image image, std::string name = "exact") {
    Estimator result;
    result.name = std::move(name);
    result.exact = true;
    result.available = 1;
    result.render = [one = std::make_shared<const Image>(std::move(image))](const Estimator::Request&) { return *one; };
    return result;
}

}  // namespace lightswitch
