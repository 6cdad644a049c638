#pragma once

#include "support/paths.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/path_tracer.hpp>
#include <lightswitch/method/path_tracer_nee.hpp>

#include <doctest/doctest.h>

namespace lightswitch::test {

/// A scene, and what another renderer made of it; see tests/data/reference.
template <class SceneType>
struct Reference {
    SceneType scene;
    TileEstimates tiles;
    int samples;  ///< per pixel, of the reference
};

template <class SceneType>
Reference<SceneType> reference(SceneType scene, int samples, const std::string& folder = "reference") {
    TileEstimates tiles = load_tiles(test::folder() + "/data/" + folder + "/" + scene.name() + ".txt");
    return {std::move(scene), std::move(tiles), samples};
}
inline auto cornell_box() { return reference(stock::cornell_box(), 3072); }
inline auto cornell_spheres() { return reference(stock::cornell_spheres(), 3584); }
inline auto veach_mis() { return reference(build_scene<AllBsdfs, AllLights>(describe_veach_mis()), 7680); }

/// How a comparison is made. `false_alarm` holds for all tiles and channels together.
struct Effort {
    int replicas = 16, samples = 8;  ///< samples of each replica
    Sampling sampling = Sampling::sobol;
    double bias = 0.002;  ///< the 99 % interval of the relative bias of each channel must lie within this
    double false_alarm = 1e-3;
    int join = 1;  ///< tiles that are joined to one, in each direction
};

/// Replicas against the reference: Welch's test for each tile, and the bias of the whole image. The seeds are fixed:
/// the bias test was seen to pass, and would for other seeds in more than nine of ten cases.
template <class SceneType, class M>
void check_reference(const Reference<SceneType>& reference, const M& method, const Effort& effort) {
    const TileEstimates truth = reference.tiles.joined(effort.join);
    TileEstimates ours =
        replicate(reference.scene, method, truth.side, effort.replicas, effort.samples, effort.sampling);
    // The reference comes from path tracing with next event estimation too, whose pixels are heavy-tailed in two of the
    // scenes.
    ours.at_least(truth, double(reference.samples) / (effort.replicas * effort.samples));
    const Comparison comparison = compare(ours, truth, effort.false_alarm);
    INFO(reference.scene.name(), " ", M::name, " ", name(effort.sampling));
    CHECK_MESSAGE(comparison.agree(), comparison);
    for (int c = 0; c < 3; ++c) {
        const BiasInterval bias(ours.whole[c], truth.whole[c]);
        MESSAGE(M::name, " on ", reference.scene.name(), ", ", name(effort.sampling), ": ", bias);
        CHECK_MESSAGE(bias.within(effort.bias), bias);
    }
}

}  // namespace lightswitch::test
