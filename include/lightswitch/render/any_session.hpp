#pragma once

// Sessions without their types, for who keeps several of them.

#include <lightswitch/render/render.hpp>

#include <functional>
#include <memory>
#include <variant>

namespace lightswitch::detail {

/// A session whatever its types.
struct AnySession {
    std::function<void(const Budget&, const std::stop_token&)> run;
    std::function<const Film&()> film;
    std::function<const RenderStatistics&()> statistics;
    std::function<Image()> image;

    template <class SceneType, class M>
    static AnySession make(const SceneType& scene, const M& method, const Settings& settings) {
        const auto session = std::make_shared<Session<SceneType, M>>(scene, method, settings);
        return {[session](const Budget& budget, const std::stop_token& pause) { session->run(budget, pause); },
                [session]() -> const Film& { return session->film(); },
                [session]() -> const RenderStatistics& { return session->statistics(); },
                [session] { return session->image(); }};
    }
};

template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

/// `f` of the object, or of what a variant holds.
template <class T>
decltype(auto) visit_any(auto&& f, const T& object) {
    if constexpr (is_variant<T>) return std::visit(f, object);
    else return f(object);
}

}  // namespace lightswitch::detail
