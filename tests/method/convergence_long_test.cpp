// Consistent methods: how fast the mean over the iterations comes close to the exact image.

#include "nearly.hpp"

#include <array>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

constexpr std::array<int, 4> decades{1, 10, 100, 1000};

/// Bounds of an exponent.
struct Band {
    double steepest = 0, flattest = 0;
};

/// The relative mean square error, a mean over replicas, falls by a power of the number of iterations within the
/// `band`, and in every decade; in the end the whole image is off by less than `bound`, as a fraction.
template <class SceneType, class M>
void check_convergence(const std::string& what, const SceneType& scene, const M& method, const Image& truth, Band band,
                       double bound) {
    constexpr int replicas = 8;
    std::array<double, decades.size()> error{};
    double bias = 0;
    const double level = truth.mean().y;
    for (int i = 0; i < replicas; ++i) {
        Session<SceneType, M> session(scene, method, {.seed = 1 + static_cast<std::uint64_t>(i)});
        for (std::size_t d = 0; d < decades.size(); ++d) {
            session.run({.samples = decades[d]});
            const Image image = session.image();
            double sum = 0;
            for (std::size_t p = 0; p < image.pixels().size(); ++p)
                for (int c = 0; c < 3; ++c) {
                    const double exact = double(truth.pixels()[p][c]), off = double(image.pixels()[p][c]) - exact;
                    sum += off * off / (exact * exact + 1e-4 * level * level);
                }
            error[d] += sum / (3 * double(image.pixels().size()) * replicas);
        }
        CHECK(session.statistics().counts.non_finite == 0);
        bias += (session.image().mean().y / level - 1) / replicas;
    }
    const double exponent = std::log(error.back() / error.front()) / std::log(double(decades.back()));
    MESSAGE(what, ": ", error[0], " ", error[1], " ", error[2], " ", error[3], ", exponent ", exponent, ", bias ",
            100 * bias, " %");
    CAPTURE(what);
    CHECK(exponent > band.steepest);
    CHECK(exponent < band.flattest);
    for (std::size_t d = 1; d < decades.size(); ++d) CHECK(error[d] < error[d - 1]);
    CHECK(std::abs(bias) < bound);
}

}  // namespace

// With alpha = 2/3 variance falls as n^(-2/3), and bias as the area of the radius, n^(-1/3): squared, n^(-2/3) too.
// Where walls meet, photons are missing within the radius, and bias falls as the radius only: squared, n^(-1/3). Light
// that needs no photons, such as direct light, has errors that fall as 1/n or faster. So the exponent lies between -1/3
// and about -1: near -2/3 as long as the photons' noise decides, nearer to -1/3 where the radius is large, and near -1
// where most of the light is direct, as in the sphere. VCM errs as a connection does where that is the
// better of the two, and so falls as 1/n. The errors are means over 8 renders of 768 values; they err by less than 10
// %, an exponent by less than 0.02.
TEST_CASE("convergence: on the Cornell box, with its edges") {
    const LibraryDescription description = scenes::on_small_film(stock::describe_cornell_box());
    const DiffuseScene scene = build_scene<DiffuseBsdfs, Lights<TriangleLight>>(description);
    const Image truth = render(scene, PathTracerNee{}, {.samples = 32768}, {.seed = 77});
    check_convergence("photon", scene, PhotonMapping{}, truth, {-0.7, -0.5}, 0.005);
    check_convergence("photon, narrow", scene, PhotonMapping{.radius = {.pixels = 0.5f}}, truth, {-0.8, -0.6}, 0.005);
    check_convergence("photon, final gathering", scene, PhotonMapping{.final_gather = true}, truth, {-1.1, -0.7}, 0.01);
    check_convergence("vcm", scene, Vcm{}, truth, {-1.2, -0.9}, 0.002);
}

TEST_CASE("convergence: in a sphere, where only the lamp has edges") {
    const FullScene scene = build_scene<AllBsdfs, AllLights>(scenes::lamp_in_sphere());
    const Image truth = render(scene, PathTracerNee{}, {.samples = 32768}, {.seed = 77});
    check_convergence("photon", scene, PhotonMapping{}, truth, {-1.15, -0.8}, 0.01);
    check_convergence("vcm", scene, Vcm{}, truth, {-1.3, -0.9}, 0.001);
}

// False alarm: 1e-3. Left out are cases that merging is too noisy for, and coarse facets, on which photons of one facet
// count at the next by the cosine to another normal: the bias of half a pixel is more than 5 % there.
TEST_CASE("convergence: close to bidirectional path tracing in scenes of all kinds") {
    const auto cases = transport_cases();
    for (const TransportCase& c : cases)
        if (c.name != "veach-mis" && c.name != "many lights" && !c.name.starts_with("smooth normals"))
            check_nearly_bdpt(c, -1, 16, 256, 1e-3, static_cast<int>(cases.size()));
}
