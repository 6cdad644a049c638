#include "support/relative.hpp"

#include <lightswitch/bsdf/conductor.hpp>
#include <lightswitch/load/metals.hpp>

#include <doctest/doctest.h>

#include <set>

using namespace lightswitch;
using namespace lightswitch::test;

TEST_CASE("metals have the numbers that Mitsuba shades them with") {
    // Gold as printed by Mitsuba 3.9.1: traverse(load_dict({"type": "conductor", "material": ...})).
    const auto gold = metal_by_name("Au");
    REQUIRE(gold);
    CHECK(gold->eta == Rgb(0.14303598f, 0.37530708f, 1.4420453f));
    CHECK(gold->k == Rgb(3.982997f, 2.3855565f, 1.6033592f));
    const auto mirror = metal_by_name("none");
    REQUIRE(mirror);
    CHECK(mirror->eta == Rgb(0));
    CHECK(mirror->k == Rgb(1));
}

TEST_CASE("the table of metals is sorted, and a name is a name with its capitals") {
    std::set<std::string_view> names;
    for (const auto& metal : detail::metal_table) {
        CHECK_MESSAGE((names.empty() || *names.rbegin() < metal.name), metal.name);
        names.insert(metal.name);
        CHECK_MESSAGE(metal_by_name(metal.name), metal.name);
    }
    CHECK(names.size() == 71);
    for (const auto* name :
         {"a-C", "Ag", "Al", "Cu", "Cu_palik", "d-C_palik", "Na_palik", "Se-e", "TiO2-e_palik", "VN", "W"})
        CHECK_MESSAGE(names.contains(name), name);
    for (const auto* name : {"", "au", "AU", "Au ", "Na", "None", "none ", "../ior/Au", "Au.eta.spd"})
        CHECK_MESSAGE(!metal_by_name(name), name);
}

TEST_CASE("the numbers of metals are those that the script wrote") {
    double sum = 0, weight = 0;
    for (const auto& metal : detail::metal_table) {
        for (std::size_t c = 0; c < 3; ++c) sum += ++weight * metal.eta[c];
        for (std::size_t c = 0; c < 3; ++c) sum += ++weight * metal.k[c];
    }
    CHECK(sum == relative(204318.571003, 1e-12));
}

TEST_CASE("every metal is one that a scene accepts, and reflects between nothing and everything") {
    for (const auto& metal : detail::metal_table) {
        const auto index = metal_by_name(metal.name);
        REQUIRE(index);
        const Conductor conductor{.eta = index->eta, .k = index->k};
        CHECK_MESSAGE(conductor.problem() == "", metal.name);
        for (float cosine : {0.0f, 1e-6f, 0.1f, 0.5f, 0.9f, 1.0f}) {
            const Rgb reflectance = fresnel_conductor(cosine, index->eta, index->k);
            CHECK_MESSAGE((min_component(reflectance) >= 0 && max_component(reflectance) <= 1), metal.name);
        }
    }
    // Mitsuba 3.9.1: conductor's weight at a cosine of 0.5, to its digits.
    const auto alsb = metal_by_name("AlSb"), gold = metal_by_name("Au");
    const auto near = [](const Rgb& a, const Rgb& b) { return max_component(glm::abs(a - b)) < 1e-6f; };
    CHECK(near(fresnel_conductor(0.5f, alsb->eta, alsb->k), Rgb(1, 0.36864400f, 0.43141556f)));
    CHECK(near(fresnel_conductor(0.5f, gold->eta, gold->k), Rgb(0.96221042f, 0.80437082f, 0.37117517f)));
}

TEST_CASE("the names are listed for messages") {
    const std::string names = metal_names();
    CHECK(names.starts_with("Ag, Al, AlAs, "));
    CHECK(names.ends_with(", W, a-C, d-C, d-C_palik and none"));
}
