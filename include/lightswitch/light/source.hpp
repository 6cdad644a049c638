#pragma once

// What a description says of a light that is no surface, whatever its type.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/problem.hpp>
#include <lightswitch/geometry/render_space.hpp>
#include <lightswitch/light/light.hpp>

#include <functional>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>

namespace lightswitch {

/// Something that becomes a light of a built scene: `light(space, radius)` gives that light, which meets `Light`, in
/// render space, where a sphere of that `radius` around the origin holds the scene. It may throw `Error`.
///
/// Optionally `problem()` says in words why the parameters are impossible (an empty text if they are not), and
/// `emitter(light)` how methods that treat it as one light see it (`Emitter`).
template <class S>
concept LightSource = std::copy_constructible<S> && requires(const S source, const RenderSpace& space, double radius) {
    requires Light<std::remove_cvref_t<decltype(source.light(space, radius))>>;
};

/// One luminous shape or source, summed up for methods that treat it as one light.
struct Emitter {
    enum class Kind { environment, directional, point, surface, other };

    Kind kind = Kind::surface;
    Rgb strength{0};      ///< radiance; of a point its intensity (render space), of a directional source its irradiance
    Vec3 position{0};     ///< point, or centroid of a surface (render space)
    Vec3 direction{0};    ///< unit, towards a directional source
    Vec3 vector_area{0};  ///< of a surface: sum of normal * area (render space)
    float area = 0;       ///< of a surface
    std::size_t first_light = 0, light_count = 0;  ///< numbers of the lights that belong to it

    /// Whether no ray can meet it by chance.
    bool dirac() const { return kind != Kind::surface && kind != Kind::environment; }
};

/// Any `LightSource`; a value.
class Source {
public:
    template <class S>
    requires(!std::same_as<S, Source> && LightSource<S>) Source(S source)
        : model_(std::make_unique<Model<S>>(std::move(source))) {}
    Source(const Source& other) : model_(other.model_->copy()) {}
    Source(Source&&) noexcept = default;
    Source& operator=(Source other) noexcept {
        model_ = std::move(other.model_);
        return *this;
    }

    /// The source, if it is of that type; or else a null pointer.
    template <class S>
    const S* get() const {
        const auto* model = dynamic_cast<const Model<S>*>(model_.get());
        return model ? &model->source : nullptr;
    }
    template <class S>
    S* get() {
        return const_cast<S*>(std::as_const(*this).get<S>());
    }

    std::string problem() const { return model_->problem(); }
    const std::type_info& light_type() const { return model_->light_type(); }
    /// Whether its light surrounds the scene and is met by the rays that leave it.
    bool is_environment() const { return model_->is_environment(); }

    using Take = std::function<void(const void* light, const Emitter& emitter)>;
    /// Calls `take` with a pointer to the light, of the type `light_type()`. Errors of the source are said to be of
    /// `origin`.
    void make(const RenderSpace& space, double radius, const Origin& origin, const Take& take) const {
        model_->make(space, radius, origin, take);
    }

private:
    struct Base {
        virtual ~Base() = default;
        virtual std::unique_ptr<Base> copy() const = 0;
        virtual std::string problem() const = 0;
        virtual const std::type_info& light_type() const = 0;
        virtual bool is_environment() const = 0;
        virtual void make(const RenderSpace&, double, const Origin&, const Take&) const = 0;
    };
    template <class S>
    struct Model final : Base {
        using Made =
            std::remove_cvref_t<decltype(std::declval<const S&>().light(std::declval<const RenderSpace&>(), 1.0))>;

        explicit Model(S s) : source(std::move(s)) {}
        std::unique_ptr<Base> copy() const override { return std::make_unique<Model>(source); }
        std::string problem() const override {
            if constexpr (requires { source.problem(); }) return source.problem();
            else return {};
        }
        const std::type_info& light_type() const override { return typeid(Made); }
        bool is_environment() const override { return EnvironmentLight<Made>; }
        void make(const RenderSpace& space, double radius, const Origin& origin, const Take& take) const override {
            const Made light = at_place(origin, [&] { return source.light(space, radius); });
            Emitter emitter{.kind = EnvironmentLight<Made> ? Emitter::Kind::environment : Emitter::Kind::other};
            if constexpr (requires { source.emitter(light); }) emitter = source.emitter(light);
            take(&light, emitter);
        }

        S source;
    };

    std::unique_ptr<Base> model_;
};

namespace detail {

/// A position of a light in render space, or an intensity there. Throws `Error` for what single precision cannot hold.
inline Vec3 light_position(const DVec3& position, const RenderSpace& space) {
    const DVec3 result = space.point(position);
    if (!(glm::length(result) < 1e18)) throw Error("the light is too far away beside the size of the scene");
    return Vec3(result);
}
inline Rgb light_intensity(const Rgb& intensity, const RenderSpace& space) {
    // Irradiance is intensity over distance squared, and distances are multiplied by the scale.
    const DVec3 result = DVec3(intensity) * (space.scale() * space.scale());
    if (!(glm::length(result) < 1e30)) throw Error("the light's intensity is too high beside the size of the scene");
    return Rgb(result);
}

}  // namespace detail

}  // namespace lightswitch
