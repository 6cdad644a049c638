#pragma once

// A material whatever its type: what descriptions hold.

#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/material.hpp>

#include <concepts>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>
#include <utility>

namespace lightswitch {

namespace detail {

/// What the surface model of a material is called in scene files; empty if it says nothing of that.
template <Material M>
constexpr std::string_view model_name() {
    if constexpr (requires { model_of<M>::name; }) return model_of<M>::name;
    else return {};
}

}  // namespace detail

/// Any surface model, or what gives one at every place; a value, of which copies are cheap. Grey if nothing else.
class AnyMaterial {
public:
    AnyMaterial() : AnyMaterial(Lambert{}) {}
    template <class M>
    requires(!std::same_as<M, AnyMaterial> && Material<M>) AnyMaterial(M material)
        : model_(std::make_shared<const Model<M>>(std::move(material))) {}

    /// The material, if it is of that type; or else a null pointer.
    template <class M>
    const M* get() const {
        return model_->type() == typeid(M) ? &static_cast<const Model<M>&>(*model_).material : nullptr;
    }
    /// The material, which is of that type; throws `std::bad_cast` if not.
    template <class M>
    const M& as() const {
        if (const M* material = get<M>()) return *material;
        throw std::bad_cast();
    }

    /// Why its parameters are impossible, in words; an empty text if they are not.
    std::string problem() const { return model_->problem(); }
    bool transmits_light() const { return model_->transmits_light(); }
    /// Of a surface model whether it looks the same however it is turned; true of what differs from place to place.
    bool isotropic() const { return model_->isotropic(); }
    /// Whether all lobes of its surface model are Dirac distributions.
    bool specular() const { return model_->specular(); }
    /// What the surface model is called in scene files; empty if it says nothing of that.
    std::string_view model_name() const { return model_->model_name(); }
    /// Whether it may differ from place to place.
    bool placed() const { return model_->placed(); }

private:
    struct Base {
        virtual ~Base() = default;
        virtual const std::type_info& type() const = 0;
        virtual std::string problem() const = 0;
        virtual bool transmits_light() const = 0;
        virtual bool isotropic() const = 0;
        virtual bool specular() const = 0;
        virtual std::string_view model_name() const = 0;
        virtual bool placed() const = 0;
    };
    template <class M>
    struct Model final : Base {
        explicit Model(M m) : material(std::move(m)) {}
        const std::type_info& type() const override { return typeid(M); }
        std::string problem() const override { return material.problem(); }
        bool transmits_light() const override { return lightswitch::transmits_light(material); }
        bool isotropic() const override {
            if constexpr (Bsdf<M>) return is_isotropic(material);
            else return true;
        }
        bool specular() const override { return model_of<M>::specular; }
        std::string_view model_name() const override { return detail::model_name<M>(); }
        bool placed() const override { return PlacedMaterial<M>; }

        M material;
    };

    std::shared_ptr<const Base> model_;
};

}  // namespace lightswitch
