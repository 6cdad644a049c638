#pragma once

// A method on a scene, without its types, as one of several that are measured against each other.

#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/any_session.hpp>
#include <lightswitch/sweep/sweep_options.hpp>

#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lightswitch {

/// A method on a scene. What it refers to must outlive it.
struct Contender {
    std::string name;
    Kind kind = Kind::unbiased;
    PathClasses missing = {};  ///< paths that the scene may hold and the method does not make
    std::function<detail::AnySession(const Settings&)> start;
};

/// The method on the scene. Refers to `scene` and copies `method`.
template <class SceneType, class M>
requires NamedMethod<M> Contender contender(const SceneType& scene, const M& method) {
    static_assert(detail::RequireScene<SceneType>::value);
    PathClasses missing = cannot_make<M>();
    if constexpr (requires { method.left_out; }) missing = missing | method.left_out;
    return {std::string(M::name), M::kind, possible_paths(scene) & missing,
            [&scene, method](const Settings& settings) { return detail::AnySession::make(scene, method, settings); }};
}

/// The scene would be gone before the contender is used.
template <class SceneType, class M>
requires requires { typename SceneType::Data; }
Contender contender(const SceneType&& scene, const M& method) = delete;

/// The same for what variants hold.
template <class... S, class... M>
Contender contender(const std::variant<S...>& scene, const std::variant<M...>& method) {
    return std::visit([](const auto& s, const auto& m) { return contender(s, m); }, scene, method);
}

/// Every method of the variant that is not heuristic, with its defaults.
template <class Variant = AnyMethod, class SceneType>
std::vector<Contender> all_contenders(const SceneType& scene) {
    std::vector<Contender> contenders;
    for_each_method<Variant>([&](const auto& method) {
        if (method.kind == Kind::heuristic) return;
        detail::visit_any([&](const auto& s) { contenders.push_back(contender(s, method)); }, scene);
    });
    return contenders;
}

namespace detail {

inline double now(TimeOf clock) {
    if (clock == TimeOf::processor) return double(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A session and the seconds that were spent on it, the preparation among them.
class TimedSession {
public:
    TimedSession(const Contender& contender, const Settings& settings, TimeOf clock)
        : stop_(settings.stop), clock_(clock) {
        spend([&] { session_ = std::make_unique<AnySession>(contender.start(settings)); });
    }

    double seconds() const { return seconds_; }
    std::uint64_t iterations() const { return session_->film().iterations(); }
    const AnySession& session() const { return *session_; }

    /// Iterations until `seconds` are spent in all, one at least; false when the run was stopped before.
    bool advance_to(double seconds) {
        do
            if (!advance_to_iteration(iterations() + 1)) return false;
        while (seconds_ < seconds);
        return true;
    }
    /// Iterations until there are so many.
    bool advance_to_iteration(std::uint64_t wanted) {
        if (iterations() < wanted) spend([&] { session_->run({.samples = static_cast<int>(wanted)}, stop_); });
        return iterations() >= wanted;
    }

private:
    void spend(auto&& work) {
        const double begin = now(clock_);
        work();
        seconds_ += now(clock_) - begin;
    }

    std::stop_token stop_;
    TimeOf clock_;
    double seconds_ = 0;
    std::unique_ptr<AnySession> session_;
};

}  // namespace detail

}  // namespace lightswitch
