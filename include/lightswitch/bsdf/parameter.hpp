#pragma once

// What the parameters of a surface model are, said once: for scene files, textures, checks and documents.

#include <lightswitch/core/math.hpp>

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace lightswitch {

/// The values that a parameter can have: from `least` to `most`, without `least` itself where it is open.
struct ParameterRange {
    float least = 0, most = 1;
    bool open = false;

    /// The value itself, but for the end that is left out: then one just above it, which is the least roughness that
    /// facets have. A file that says 0 means a surface that is next to smooth.
    float within(float value) const { return open && value == least ? least + 1e-4f : value; }

    bool contains(float value) const { return (open ? value > least : value >= least) && value <= most; }
};

/// A fraction of light, and most other things.
inline constexpr ParameterRange as_fraction{};
/// The roughness of microfacets: with none a surface is another model.
inline constexpr ParameterRange as_roughness{.least = 0, .most = 1, .open = true};
/// A part of a complex index of refraction; fourth powers must stay finite.
inline constexpr ParameterRange as_metal_index{.least = 0, .most = 1e8f};
/// The index of refraction behind a surface over that in front of it.
inline constexpr ParameterRange as_relative_index{.least = 1e-3f, .most = 1e3f};

/// A parameter of a surface model: its name in scene files, where it is kept, which values it can have, and whether it
/// may differ from place to place. A name that stands for two others is kept in two places. `T` is `float` or `Rgb`.
template <class B, class T>
struct Parameter {
    std::string_view name;
    T B::*member;
    ParameterRange range = as_fraction;
    bool varies = true;
    T B::*also = nullptr;

    void set(B& model, const T& value) const {
        model.*member = value;
        if (also) model.*also = value;
    }
};

/// The roughness of facets that are stretched along x and y: "alpha_u", "alpha_v", and "alpha" for both.
template <class B>
inline constexpr auto stretched_roughness =
    std::tuple{Parameter{"alpha_u", &B::alpha_u, as_roughness}, Parameter{"alpha_v", &B::alpha_v, as_roughness},
               Parameter{"alpha", &B::alpha_u, as_roughness, true, &B::alpha_v}};

/// The parameters of a surface model, as a `std::tuple` of `Parameter`s; each model names its own beside itself.
template <class B>
inline constexpr auto parameters_of = std::tuple{};

/// Calls `f(index, parameter)` for every `Parameter` of the model `B`.
template <class B>
void for_each_parameter(const auto& f) {
    constexpr std::size_t count = std::tuple_size_v<std::remove_cvref_t<decltype(parameters_of<B>)>>;
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f(I, std::get<I>(parameters_of<B>)), ...); }
    (std::make_index_sequence<count>());
}

namespace detail {

inline std::string outside(const ParameterRange& range) {
    const auto number = [](float value) {
        std::string text = std::to_string(value);
        if (value >= 1e6f) return std::string("1e") + std::to_string(std::lround(std::log10(value)));
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
        return text;
    };
    return range.open ? ", which is not above " + number(range.least) + " and at most " + number(range.most)
                      : ", which is outside " + number(range.least) + " to " + number(range.most);
}

}  // namespace detail

/// Explains the first parameter whose value is out of its range, or returns an empty string.
template <class B>
std::string parameter_problem(const B& model) {
    std::string problem;
    for_each_parameter<B>([&](std::size_t, const auto& parameter) {
        const auto& value = model.*parameter.member;
        if (!problem.empty()) return;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) {
            if (!parameter.range.contains(value))
                problem =
                    std::string(parameter.name) + " is " + std::to_string(value) + detail::outside(parameter.range);
        } else {
            for (int c = 0; c < 3 && problem.empty(); ++c)
                if (!parameter.range.contains(value[c]))
                    problem = std::string(parameter.name) + " has a component of " + std::to_string(value[c]) +
                              detail::outside(parameter.range);
        }
    });
    return problem;
}

}  // namespace lightswitch
