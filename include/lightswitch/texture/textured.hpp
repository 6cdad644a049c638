#pragma once

#include <lightswitch/bsdf/material.hpp>
#include <lightswitch/bsdf/parameter.hpp>
#include <lightswitch/texture/texture.hpp>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

namespace lightswitch {

/// A surface model with any of its parameters from textures: a `PlacedMaterial`.
template <Bsdf B>
class Textured {
public:
    static constexpr std::size_t parameters = std::tuple_size_v<std::remove_cvref_t<decltype(parameters_of<B>)>>;

    /// With the parameters of `constants` where no texture is set.
    Textured(const B& constants = {}) : constants_{constants, {}} {}

    /// The model where no parameter has a texture.
    const Mapped<B>* constant() const { return varies_ ? nullptr : &constants_; }

    /// Sets the texture of the parameter of that name. Throws `Error` when the model has no such parameter.
    Textured& set(std::string_view name, Texture texture) {
        bool found = false;
        for_each_parameter<B>([&](std::size_t i, const auto& parameter) {
            if (parameter.name != name || !parameter.varies) return;
            textures_[i] = std::make_shared<const Texture>(std::move(texture));
            varies_ = true;
            found = true;
        });
        if (!found)
            throw Error("the surface model has no parameter \"" + std::string(name) + "\" that a texture could give");
        return *this;
    }

    B at(const Place& place) const {
        return with_textures([&](const Texture& texture) { return texture(place.uv); });
    }

    bool has_dirac_lobe() const { return lightswitch::has_dirac_lobe<B>(constants_); }
    /// Whether light gets through with the greatest values of the textures.
    bool transmits_light() const {
        return lightswitch::transmits_light(with_textures([](const Texture& texture) { return texture.most(); }));
    }

    /// The model's own word on the least and the largest values of the textures.
    std::string problem() const {
        for (const auto& texture : textures_)
            if (texture)
                if (const std::string problem = texture->problem(); !problem.empty()) return problem;
        const std::string problem = with_textures([](const Texture& texture) { return texture.least(); }).problem();
        return problem.empty() ? with_textures([](const Texture& texture) { return texture.most(); }).problem()
                               : problem;
    }

private:
    B with_textures(const auto& value_of) const {
        B result = constants_;
        for_each_parameter<B>([&](std::size_t i, const auto& parameter) {
            if (!textures_[i]) return;
            const Rgb value = value_of(*textures_[i]);
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(result.*parameter.member)>, float>)
                parameter.set(result, parameter.range.within(luminance(value)));
            else parameter.set(result, value);
        });
        return result;
    }

    Mapped<B> constants_;
    bool varies_ = false;
    std::array<std::shared_ptr<const Texture>, parameters> textures_{};  // in the order of `parameters_of<B>`
};

}  // namespace lightswitch
