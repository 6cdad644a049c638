// A surface model of a user that is wrong for some numbers must show in the counts, whatever path it is met on.

#include "support/renders.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// Lambert with something else than a number in one component of a weight.
struct Broken {
    static constexpr bool specular = false;
    int channel = 0;
    float value = 0;

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport t) const { return Lambert{}.evaluate(wo, wi, t); }
    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport t) const {
        auto result = Lambert{}.sample(wo, u, t);
        if (result) result->weight[channel] = value;
        return result;
    }
    std::string problem() const { return {}; }
};

}  // namespace

TEST_CASE("a surface model that gives NaN or infinity is counted at every pixel, and paths end") {
    using BrokenScene = Scene<Bsdfs<Broken>, Lights<TriangleLight>>;
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinity})
        for (int channel = 0; channel < 3; ++channel) {
            // A room whose every wall shines, so that each path meets light after the first bounce.
            SceneDescription<Broken> description;
            description.add(cube().flipped(), description.add(Broken{channel, value}), Rgb(1));
            description.film.width = description.film.height = 8;
            const auto scene = build_scene<Bsdfs<Broken>, Lights<TriangleLight>>(description);
            const auto check = [&](const auto& method, std::uint64_t at_least) {
                Session<BrokenScene, std::remove_cvref_t<decltype(method)>> session(scene, method);
                session.run({.samples = 4});
                CHECK(session.statistics().counts.non_finite >= at_least);
                for (const Rgb& p : session.film().image().pixels()) CHECK(is_finite(p));
            };
            CAPTURE(channel);
            CAPTURE(value);
            check(PathTracer{}, 4 * 64);
            check(PathTracerNee{}, 4 * 64);
            // Roulette by a channel that is not broken ends half of the paths before they meet light; fewer than 90 of
            // 256 are left with probability 1e-6.
            check(PathTracer{.rr_depth = 0}, 90);
            check(PathTracerNee{.rr_depth = 0}, 90);
        }
}
