// Guided path tracing with a mistake in its densities.

#include "verify/planted/catalogue.hpp"
#include "verify/planted/scenes.hpp"

#include <lightswitch/method/path_guided.hpp>

namespace lightswitch::test {

namespace {

/// The guide's density counts whole in the mixture, not with its share.
struct ShareForgotten : GuidingMixture {
    SolidAnglePdf density(SolidAnglePdf bsdf, SolidAnglePdf guide) const { return bsdf * bsdf_share + guide; }
};

/// The guide's density is one over the square, not over the sphere.
struct JacobianForgotten : GuidingMixture {
    SolidAnglePdf guide(const Vec3& w) const {
        return directions ? SolidAnglePdf{directions->density(octahedron::to_square(w))} : SolidAnglePdf{};
    }
};

template <class Mixture>
Estimator planted(const LibraryDescription& description) {
    return estimator(
        std::make_shared<const DiffuseScene>(build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description)),
        BasicPathGuided<Mixture>{.first_training = 8, .training = 0, .always_guide = true});
}

template <class Mixture>
std::pair<Estimator, Estimator> beside_nee() {
    const LibraryDescription description = indirect_ceiling();
    return {planted<Mixture>(description), library_nee(description)};
}

}  // namespace

std::vector<PlantedBug> guided_bugs() {
    return {{"share of the guide forgotten in the mixture", "indirect-ceiling", 3, beside_nee<ShareForgotten>},
            {"solid angle forgotten in the guide's density", "indirect-ceiling", 3, beside_nee<JacobianForgotten>}};
}

std::vector<CorrectPair> guided_copies() {
    return {{"path-guided, path-nee", "indirect-ceiling", beside_nee<GuidingMixture>}};
}

}  // namespace lightswitch::test
