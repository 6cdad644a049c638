#include <lightswitch/bsdf/coat.hpp>
#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/bsdf/dielectric.hpp>
#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/bsdf/mapped.hpp>
#include <lightswitch/bsdf/plastic.hpp>
#include <lightswitch/bsdf/rough_conductor.hpp>
#include <lightswitch/bsdf/rough_dielectric.hpp>

#include "../support/relative.hpp"
#include "bsdf_checks.hpp"

#include <tuple>

using namespace lightswitch;
using test::direction;
using test::relative;

namespace {

/// A model under a coat, as scenes have it where no map turns the normal. `optics` must outlive it.
template <Bsdf B>
Mapped<B> under(const detail::CoatOptics& optics, const B& base) {
    return {base, {.active = true}, &optics};
}

const Coat tinted{
    .eta = 1.7f, .specular_reflectance = {0.9f, 0.7f, 0.5f}, .thickness = 2, .sigma_a = {0.1f, 0.2f, 0.6f}};
const Coat smooth[] = {
    {}, tinted, {.eta = 1 / 1.3f}, {.eta = 3, .sigma_a = Rgb(0.1f)}, {.specular_reflectance = Rgb(0)}};
const Coat rough[] = {
    {.alpha = 0.2f},
    {.eta = 1.7f, .thickness = 0.5f, .sigma_a = {0.1f, 0.2f, 0.6f}, .alpha = 0.4f, .distribution = Facets::ggx},
    {.eta = 1 / 1.3f, .alpha = 0.4f}};
const RoughConductor metal{
    .distribution = Facets::ggx, .alpha_u = 0.3f, .alpha_v = 0.5f, .eta = Rgb(0.2f), .k = Rgb(3)};
const RoughDielectric glass{.alpha_u = 0.4f, .alpha_v = 0.4f};
const auto bases =
    std::tuple{Lambert{{0.9f, 0.8f, 1}}, metal, Plastic{.diffuse_reflectance = {0.9f, 0.6f, 0.3f}}, glass};
constexpr double cosines[] = {1, 0.8, 0.3, 0.05};
const double level = test::sidak(1e-6, 8 * 4 * 4 * 2);

/// Calls `f(model)` for every base under each of the coats.
void for_each_model(const auto& coats, const auto& f) {
    for (const Coat& coat : coats) {
        const detail::CoatOptics optics(coat);
        CAPTURE(coat.eta);
        CAPTURE(coat.alpha);
        std::apply([&](const auto&... base) { (f(coat, under(optics, base)), ...); }, bases);
    }
}
void for_each_model(const auto& f) {
    for_each_model(smooth, f);
    for_each_model(rough, f);
}

/// Transmittance of a smooth boundary for the cosine `c` outside, and the cosine inside, in the words of textbooks.
struct Boundary {
    double transmittance, inside;
    Boundary(double c, double eta) {
        const double a = std::acos(c), b = std::asin(std::sin(a) / eta);
        const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
        inside = std::cos(b);
        transmittance = 1 - 0.5 * (s * s + p * p);
    }
};

}  // namespace

TEST_CASE("coat: what is below is seen through two boundaries, by Snell's law, and through what absorbs") {
    const detail::CoatOptics optics(tinted);
    const Lambert grey{Rgb(0.5f)};
    const auto model = under(optics, grey);
    for (const double a : {0.95, 0.6, 0.2})
        for (const double b : {0.9, 0.5, 0.1}) {
            const Boundary in(a, double(tinted.eta)), out(b, double(tinted.eta));
            const BsdfValue value = model.evaluate(direction(a), direction(b, 2), Transport::radiance);
            for (int c = 0; c < 3; ++c) {
                const double way = 2 * double(tinted.sigma_a[c]) * (1 / in.inside + 1 / out.inside);
                const double expected = in.transmittance * out.transmittance * std::exp(-way) * 0.5 / double(pi) /
                                        (double(tinted.eta) * double(tinted.eta));
                CHECK(value.value[c] == relative(expected, 2e-6));
            }
        }
}

TEST_CASE("coat: directions are refracted, so that a lobe below is where Snell's law has it") {
    const Coat coat{.eta = 1.5f};
    const detail::CoatOptics optics(coat);
    const auto model = under(optics, metal);
    for (const double a : {0.95, 0.6, 0.2})
        for (const double b : {0.9, 0.5, 0.1}) {
            const auto inside = [](double cosine, double phi) { return direction(Boundary(cosine, 1.5).inside, phi); };
            const Rgb base = metal.evaluate(inside(a, 0.3), inside(b, 1), Transport::radiance).value;
            const Rgb value = model.evaluate(direction(a, 0.3), direction(b, 1), Transport::radiance).value;
            const double factor = Boundary(a, 1.5).transmittance * Boundary(b, 1.5).transmittance / (1.5 * 1.5);
            CHECK(value.y == relative(double(base.y) * factor, 1e-5));
        }
}

TEST_CASE("coat: a smooth one reflects Fresnel's part, and a mirror below the rest, twice dimmed") {
    const detail::CoatOptics optics(tinted);
    const Conductor copper{.eta = {0.2f, 0.9f, 1.2f}, .k = {3.9f, 2.5f, 2.2f}};
    const auto model = under(optics, copper);
    for (const double cosine : {0.99, 0.7, 0.2}) {
        const Vec3 wo = direction(cosine);
        const Boundary in(cosine, double(tinted.eta));
        DVec3 sum(0);
        constexpr int count = 1 << 16;
        for (int i = 0; i < count; ++i) {
            const auto sample = model.sample(wo, Vec3(0.3f, 0.6f, (float(i) + 0.5f) / count), Transport::radiance);
            REQUIRE(sample);
            CHECK(sample->specular);
            CHECK(sample->reversal == relative(1, 1e-5));
            CHECK(std::sqrt(length_squared(sample->wi - test::mirrored(wo))) < 1e-6f);
            sum += DVec3(sample->weight);
        }
        for (int c = 0; c < 3; ++c) {
            const double metal_part = double(fresnel_conductor(float(in.inside), copper.eta, copper.k)[c]);
            const double absorbed = std::exp(-4 * double(tinted.sigma_a[c]) / in.inside);
            const double expected = (1 - in.transmittance) * double(tinted.specular_reflectance[c]) +
                                    in.transmittance * in.transmittance * metal_part * absorbed;
            CHECK(sum[c] / count == relative(expected, 1e-4));
        }
    }
}

TEST_CASE("coat: sampling follows the density, and the rest is the coat's or kept inside") {
    std::uint32_t seed = 1;
    for_each_model([&]<class M>(const Coat& coat, const M& model) {
        for (const double cosine : cosines) {
            if (coat.eta < 1 && cosine < 0.75) continue;                                   // total reflection
            if (transmits<M> && (coat.eta < 1 || cosine > 0.9 || cosine < 0.1)) continue;  // into few cells
            const double alpha = coat.smooth() || transmits<M> ? 1 : double(coat.alpha);
            test::check_density(model, direction(cosine), alpha, level, seed++);
            if (transmits<M>) test::check_density(model, -direction(cosine), alpha, level, seed++);
        }
    });
}

TEST_CASE("coat: weights and densities of samples are those of evaluation") {
    for_each_model([&]<class M>(const Coat& coat, const M& model) {
        // Near total reflection the cosine inside does not follow from the digits of the one outside.
        if (coat.eta < 1 && !std::is_base_of_v<Lambert, M>) return;
        for (const double cosine : cosines)
            test::check_sample_agrees_with_evaluate(model, direction(cosine), 2e-3, 2e-3);
    });
}

TEST_CASE("coat: energy") {
    std::uint32_t seed = 101;
    for_each_model([&](const Coat& coat, const auto& model) {
        for (const double cosine : cosines) {
            if (transmits<std::remove_cvref_t<decltype(model)>>) continue;  // below, as importance
            test::check_albedo(model, direction(cosine), coat.smooth() ? 1 : double(coat.alpha), seed++);
        }
    });
    for_each_model([&](const Coat& coat, const auto& model) {
        if (transmits<std::remove_cvref_t<decltype(model)>> && coat.eta > 1)
            test::check_albedo(model, direction(0.6), 1, seed++, Transport::importance);
    });
}

TEST_CASE("coat: reciprocity; what radiance sees one way, importance sees the other way") {
    for_each_model([&](const Coat&, const auto& model) {
        if (!transmits<std::remove_cvref_t<decltype(model)>>) test::check_reciprocity(model);
        test::check_adjoint(model);
    });
}

TEST_CASE("coat: of a specular path the probability the other way round is known") {
    const detail::CoatOptics optics(tinted);
    const auto model = under(optics, Dielectric{.eta = 1.4f});
    // How probable it is that light from there gets through, good to 1 %.
    const auto probability = [&](const Vec3& from) {
        constexpr int side = 200;
        int through = 0;
        for (int i = 0; i < side * side; ++i) {
            const Vec3 u((float(i % side) + 0.5f) / side, 0.5f, (float(i / side) + 0.5f) / side);
            const auto sample = model.sample(from, u, Transport::radiance);
            through += sample && sample->wi.z * from.z < 0;
        }
        return double(through) / (side * side);
    };
    test::Random random(11);
    int refracted = 0, uneven = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 wo = uniform_sphere(random.next_2d());
        const auto there = model.sample(wo, random.next_3d(), Transport::radiance);
        if (!there || there->wi.z * wo.z > 0) continue;
        ++refracted;
        uneven += std::abs(there->reversal - 1) > 0.1f;
        const double expected = probability(there->wi) / probability(wo);
        CHECK(there->reversal == relative(expected, 0.05));
    }
    CHECK(refracted > 60);
    CHECK(uneven > 5);
}

TEST_CASE("coat: with index 1 there is none, and what it absorbs is all that it does") {
    const detail::CoatOptics nothing(Coat{.eta = 1}), filter(Coat{.eta = 1, .sigma_a = {0.1f, 0.2f, 0.3f}}),
        rough_nothing(Coat{.eta = 1, .alpha = 0.3f});
    test::Random random(12);
    const auto check = [&](const auto& base) {
        for (int i = 0; i < 1000; ++i) {
            const Vec3 wo = uniform_sphere(random.next_2d()), wi = uniform_sphere(random.next_2d());
            const Vec3 u = random.next_3d();
            const BsdfValue bare = base.evaluate(wo, wi, Transport::radiance);
            for (const auto* coat : {&nothing, &rough_nothing}) {
                const BsdfValue value = under(*coat, base).evaluate(wo, wi, Transport::radiance);
                CHECK(value.value == bare.value);
                CHECK(value.pdf.value == bare.pdf.value);
            }
            const auto a = base.sample(wo, u, Transport::radiance),
                       b = under(nothing, base).sample(wo, u, Transport::radiance);
            REQUIRE(bool(a) == bool(b));
            if (a) {
                CHECK(a->wi == b->wi);
                CHECK(a->weight == b->weight);
                CHECK(a->pdf.value == b->pdf.value);
            }
            const Rgb dimmed = under(filter, base).evaluate(wo, wi, Transport::radiance).value;
            if (dimmed.z > 1e-30f)
                CHECK(dimmed.z == relative(double(bare.value.z) *
                                               std::exp(-0.3 / std::abs(double(wo.z)) - 0.3 / std::abs(double(wi.z))),
                                           2e-5));
        }
    };
    std::apply([&](const auto&... base) { (check(base), ...); }, bases);
}

TEST_CASE("coat: extreme directions and parameters") {
    for_each_model([&](const Coat& coat, const auto& model) {
        // A facet that reflects all is drawn as often as the mean of facets reflects, which in thinner media may be 2
        // %.
        test::check_extremes(model, coat.eta < 1 && !coat.smooth() ? 50 : 4, 60000);
    });
    constexpr int least = 3000;  // samples: the coat may keep much inside
    for (const Coat& coat :
         {Coat{.eta = 1}, Coat{.eta = 1 + 0x1p-23f}, Coat{.eta = 1 - 0x1p-24f}, Coat{.eta = 1e-3f}, Coat{.eta = 1e3f},
          Coat{.thickness = 1e18f, .sigma_a = {0, 1e18f, 1}}, Coat{.eta = 1, .sigma_a = {0, 1e18f, 1}}}) {
        const detail::CoatOptics optics(coat);
        CAPTURE(coat.eta);
        test::check_extremes(under(optics, Lambert{}), 4, least);
        test::check_extremes(under(optics, Conductor{}), 4, least);
        test::check_extremes(under(optics, Dielectric{}), 8, least);
    }
    for (const Coat& coat : {Coat{.alpha = 1e-4f}, Coat{.alpha = 1}, Coat{.eta = 1 + 0x1p-23f, .alpha = 0.3f}}) {
        const detail::CoatOptics optics(coat);
        CAPTURE(coat.alpha);
        test::check_extremes(under(optics, Lambert{}), 4, least);
    }
}

TEST_CASE("coat: it says whether something is a mirror") {
    const detail::CoatOptics clear(Coat{}), frosted(Coat{.alpha = 0.3f});
    CHECK_FALSE(has_dirac_lobe(Mapped<Lambert>{}));
    CHECK(has_dirac_lobe(under(clear, Lambert{})));
    CHECK_FALSE(has_dirac_lobe(under(frosted, Lambert{})));
    CHECK(has_dirac_lobe(under(frosted, Plastic{})));
}

TEST_CASE("coat: impossible parameters are refused by name") {
    CHECK(Coat{}.problem().empty());
    CHECK(tinted.problem().empty());
    CHECK(Coat{.eta = 0}.problem().find("eta is 0") == 0);
    CHECK(Coat{.specular_reflectance = {1, 1.5f, 1}}.problem().find("specular_reflectance") == 0);
    CHECK(Coat{.thickness = -1}.problem().find("thickness") == 0);
    CHECK(Coat{.sigma_a = {0, -1, 0}}.problem().find("sigma_a") == 0);
    CHECK(Coat{.sigma_a = Rgb(infinity)}.problem().find("sigma_a") == 0);
    CHECK(Coat{.alpha = 1.1f}.problem().find("alpha") == 0);
    CHECK(Coat{.alpha = std::numeric_limits<float>::quiet_NaN()}.problem().find("alpha") == 0);
}
