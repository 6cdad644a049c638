#include <lightswitch/core/math.hpp>
#include <lightswitch/core/warp.hpp>

#include "../support/chi_square.hpp"
#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::relative;

namespace {

/// The largest violation of an orthonormal, right-handed basis around `n`.
double basis_error(const Vec3& n) {
    const Basis basis(n);
    const DVec3 t(basis.tangent), b(basis.bitangent), z(basis.normal);
    double error = glm::length(glm::cross(t, b) - z);
    error = std::max(error, std::abs(glm::length(t) - 1));
    error = std::max(error, std::abs(glm::length(b) - 1));
    error = std::max({error, std::abs(glm::dot(t, b)), std::abs(glm::dot(t, z)), std::abs(glm::dot(b, z))});
    return basis.normal == n ? error : 1;
}

}  // namespace

TEST_CASE("basis: orthonormal and right-handed around any unit vector") {
    test::Random random(1);
    double worst = 0;
    for (int i = 0; i < 1000000; ++i) worst = std::max(worst, basis_error(uniform_sphere(random.next_2d())));
    CHECK(worst < 6e-7);

    // The poles, where other constructions divide by nothing, and their surroundings.
    worst = 0;
    for (const float z : {1.0f, -1.0f, 0.0f, -0.0f})
        for (const float x : {0.0f, -0.0f, 1.0f, -1.0f})
            if (std::abs(x) + std::abs(z) == 1) {
                worst = std::max(worst, basis_error({x, 0, z}));
                worst = std::max(worst, basis_error({0, x, z}));
                worst = std::max(worst, basis_error({0.0f * x, -0.0f, z == 0 ? 1.0f : z}));
            }
    for (int i = 0; i < 200000; ++i) {
        const double angle = 6.28318530717958647692 * double(random.next()),
                     tilt = std::pow(10, -8 * double(random.next()));
        for (const double sign : {-1.0, 1.0}) {
            const DVec3 n(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle), sign * std::cos(tilt));
            worst = std::max(worst, basis_error(Vec3(n)));
        }
    }
    CHECK(worst < 6e-7);
}

TEST_CASE("basis: local and world are inverse to each other") {
    test::Random random(2);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        const Basis basis(uniform_sphere(random.next_2d()));
        const Vec3 v = uniform_sphere(random.next_2d());
        worst = std::max(worst, double(glm::length(basis.to_world(basis.to_local(v)) - v)));
        worst = std::max(worst, double(std::abs(basis.to_local(v).z - dot(v, basis.normal))));
    }
    CHECK(worst < 1e-6);
    CHECK(Basis({0, 0, -1}).to_local({0, 0, -1}) == Vec3(0, 0, 1));
}

TEST_CASE("math: finite numbers, bounds and colours") {
    CHECK(lightswitch::is_finite(0.0f));
    CHECK(lightswitch::is_finite(-std::numeric_limits<float>::max()));
    CHECK(lightswitch::is_finite(std::numeric_limits<float>::denorm_min()));
    CHECK_FALSE(lightswitch::is_finite(infinity));
    CHECK_FALSE(lightswitch::is_finite(-infinity));
    CHECK_FALSE(lightswitch::is_finite(std::numeric_limits<float>::quiet_NaN()));
    CHECK_FALSE(lightswitch::is_finite(Vec3(0, std::numeric_limits<float>::quiet_NaN(), 1)));
    CHECK_FALSE(lightswitch::is_finite(Vec3(0, 0, infinity)));

    // (1 + u)^n - 1 is below the bound.
    for (const int n : {1, 3, 8, 100}) {
        CHECK(double(gamma_bound(n)) >= std::pow(1 + 0x1p-24, n) - 1);
        CHECK(double(gamma_bound(n)) < 1.001 * n * 0x1p-24);
    }

    CHECK(luminance(Rgb(1)) == relative(1, 1e-5));
    CHECK(luminance(DVec3(0, 1, 0)) == 0.7152);
    CHECK(max_component({1, 3, 2}) == 3);
    CHECK(safe_sqrt(-1e-9f) == 0);
    CHECK(is_black(Rgb(-0.0f)));
    CHECK_FALSE(is_black(Rgb(0, 1e-45f, 0)));
    CHECK(glm::length(lightswitch::normalize(Vec3(1e-10f, -2e-10f, 3e-10f))) == relative(1, 1e-5));
}
