#pragma once

// Do methods have the same expected image? A statistical test with a stated rate of false alarms.

#include <lightswitch/verify/verification.hpp>

namespace lightswitch {

/// Compares two estimators, see `Verification`.
inline Verdict verify(const Estimator& method, const Estimator& reference, const VerifyOptions& options = {}) {
    return std::move(Verification(reference, {method}, options).run().front());
}

/// Whether `method` has the same expected image of `scene` as `reference`: the test of a method of one's own, in one
/// line. Throws `Error` for heuristic methods.
template <class SceneType, class M, class R>
requires NamedMethod<M> && NamedMethod<R> &&(!std::same_as<M, Estimator>)Verdict
    verify(const SceneType& scene, const M& method, const R& reference, const VerifyOptions& options = {}) {
    const Settings settings{.threads = options.threads};
    return verify(estimator(scene, method, settings), estimator(scene, reference, settings), options);
}

/// The same against an image that is known without noise, such as what theory says of a furnace.
template <class SceneType, class M>
requires NamedMethod<M> Verdict verify(const SceneType& scene, const M& method, const Image& exact,
                                       const VerifyOptions& options = {}) {
    return verify(estimator(scene, method, {.threads = options.threads}), exactly(exact), options);
}

}  // namespace lightswitch
