#include <lightswitch/bsdf/fresnel.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::relative;

// Reference values: Mitsuba 3, `mi.fresnel` and `mi.fresnel_conductor` (scalar_rgb).

TEST_CASE("fresnel: dielectric values agree with Mitsuba's") {
    const struct {
        float eta, cos_i, reflectance, cos_t;
    } table[] = {
        {1.5f, 1, 0.0400000f, -1},
        {1.5f, 0.6f, 0.0645250f, -0.8459052f},
        {1.5f, 0.1f, 0.5715926f, -0.7483314f},
        {1.5f, -1, 0.0400000f, 1},
        {1.5f, -0.9f, 0.0463326f, 0.7566373f},
        {1.5f, -0.6f, 1, 0},
        {1.33f, 0.6f, 0.0386962f, -0.7988700f},
        {1.33f, -0.9f, 0.0223328f, 0.8148060f},
        {2.4f, 1, 0.1695502f, -1},
        {2.4f, 0.1f, 0.5859887f, -0.9100137f},
        {2.4f, -0.9f, 1, 0},
        {0.3f, 1, 0.2899409f, -1},
        {0.3f, 0.6f, 1, 0},
        {0.3f, -0.9f, 0.2901585f, 0.9914131f},
        {0.3f, -0.6f, 0.2961132f, 0.9707729f},
    };
    for (const auto& row : table) {
        CAPTURE(row.eta);
        CAPTURE(row.cos_i);
        const auto f = fresnel_dielectric(row.cos_i, row.eta);
        CHECK(std::abs(f.reflectance - row.reflectance) < 1e-6f);
        CHECK(std::abs(f.cos_t - row.cos_t) < 1e-6f);
        CHECK(f.eta == relative(row.cos_i > 0 ? row.eta : 1 / row.eta, 1e-5));
    }
}

TEST_CASE("fresnel: dielectric limits") {
    for (const float eta : {1.0001f, 1.33f, 1.5f, 2.4f, 0.4f, 0.99f}) {
        CAPTURE(eta);
        CHECK(fresnel_dielectric(1, eta).reflectance == relative(square((eta - 1) / (eta + 1)), 1e-4));
        CHECK(fresnel_dielectric(1e-7f, eta).reflectance == relative(1, 1e-4));
        // Brewster's angle, tan = eta: only the perpendicular part is reflected.
        const float brewster = 1 / std::sqrt(1 + eta * eta);
        CHECK(fresnel_dielectric(brewster, eta).reflectance ==
              relative(0.5f * square((1 - eta * eta) / (1 + eta * eta)), 1e-3));
        // What enters along one side leaves along the other with the same transmittance.
        const auto in = fresnel_dielectric(0.95f, eta);
        if (in.cos_t != 0) {
            const auto out = fresnel_dielectric(in.cos_t, eta);
            // The cosine that is handed over is rounded, which counts the more the less the two media differ: the
            // reflectance is about the square of that difference.
            CHECK(out.reflectance == relative(in.reflectance, 1e-4 + 4 * double(unit_roundoff / std::abs(eta - 1))));
            CHECK(out.cos_t == relative(0.95f, 1e-5));
        }
    }
    // The critical angle: sin = 1 / eta from inside.
    const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));
    CHECK(fresnel_dielectric(static_cast<float>(-critical * 0.9999), 1.5f).reflectance == 1);
    CHECK(fresnel_dielectric(static_cast<float>(-critical * 1.0001), 1.5f).reflectance < 0.95f);
    // Equal media: nothing happens.
    for (const float c : {1.0f, 0.3f, 1e-7f, -1e-3f}) {
        CHECK(fresnel_dielectric(c, 1).reflectance == 0);
        CHECK(fresnel_dielectric(c, 1).cos_t == -c);
    }
}

TEST_CASE("fresnel: what a dielectric transmits, with all digits at grazing angles") {
    for (const float eta : {1.0f, 1 + 0x1p-23f, 1.01f, 1.5f, 10.0f, 1000.0f, 0.99f, 0.6f})
        for (const float c : {1.0f, 0.9f, 0.5f, 0.1f, 1e-3f}) {
            CAPTURE(eta);
            CAPTURE(c);
            const double reflectance = double(fresnel_dielectric(c, eta).reflectance);
            CHECK(fresnel_dielectric_transmittance(c, eta) == relative(1 - reflectance, 1e-6).or_absolute(2e-7));
        }
    // In the limit, 2 c (n^2 + 1) / sqrt(n^2 - 1).
    for (const float c : {1e-5f, 1e-10f, 1e-30f})
        CHECK(fresnel_dielectric_transmittance(c, 1.5f) == relative(2 * double(c) * 3.25 / std::sqrt(1.25), 1e-4));
}

TEST_CASE("fresnel: what a dielectric transmits of diffuse light is the integral over all cosines") {
    for (const float eta :
         {1.0f, 1 + 0x1p-23f, 1.0001f, 1.01f, 1.33f, 1.5f, 2.5f, 10.0f, 1000.0f, 0.999f, 0.7f, 0.1f}) {
        CAPTURE(eta);
        // Midpoints of t, cos = c + (1 - c) t^2: the integrand has the root of a sine at the critical cosine c.
        const double critical = std::sqrt(std::max(0.0, 1 - double(eta) * double(eta)));
        double sum = 0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double t = (i + 0.5) / steps, c = critical + (1 - critical) * t * t;
            sum += 2 * c * double(fresnel_dielectric_transmittance(float(c), eta)) * 2 * t * (1 - critical) / steps;
        }
        CHECK(diffuse_transmittance(eta) == relative(sum, 1e-5));
        CHECK(diffuse_transmittance(eta) == relative(double(eta) * eta * diffuse_transmittance(1 / eta), 1e-6));
        CHECK(diffuse_transmittance(eta) <= 1);
    }
    CHECK(diffuse_transmittance(1.5f) == relative(0.90822204, 1e-6));  // by Gauss's quadrature in double precision
    CHECK(diffuse_transmittance(0.001f) == relative(5.28006061e-9, 1e-6));
}

TEST_CASE("fresnel: conductor values agree with Mitsuba's") {
    const struct {
        float eta, k, cos_i, reflectance;
    } table[] = {
        {0.2f, 3.9f, 1, 0.9519520f},    {0.2f, 3.9f, 0.5f, 0.9458821f},    {0.2f, 3.9f, 0.1f, 0.9628965f},
        {3.1f, 3.3f, 1, 0.5523466f},    {3.1f, 3.3f, 0.5f, 0.5318714f},    {3.1f, 3.3f, 0.1f, 0.6264175f},
        {1.5f, 0, 1, 0.0400000f},       {1.5f, 0, 0.5f, 0.0891867f},       {1.5f, 0, 0.1f, 0.5715925f},
        {0.143f, 3.98f, 1, 0.9666409f}, {0.143f, 3.98f, 0.5f, 0.9621721f}, {0.143f, 3.98f, 0.1f, 0.9734334f},
        {0.05f, 4.3f, 1, 0.9897929f},   {0.05f, 4.3f, 0.5f, 0.9882227f},   {0.05f, 4.3f, 0.1f, 0.9908670f},
    };
    for (const auto& row : table) {
        CAPTURE(row.eta);
        CAPTURE(row.cos_i);
        CHECK(std::abs(fresnel_conductor(row.cos_i, row.eta, row.k) - row.reflectance) < 1e-6f);
    }
}

TEST_CASE("fresnel: conductor limits") {
    for (const float c : {1.0f, 0.7f, 0.01f, 1e-7f, 0.0f}) {
        CAPTURE(c);
        CHECK(fresnel_conductor(c, 0, 1) == 1);  // the ideal mirror, exactly
        CHECK(fresnel_conductor(c, 1.5f, 0) == relative(fresnel_dielectric(c, 1.5f).reflectance, 1e-5));
    }
    CHECK(fresnel_conductor(0.5f, 1, 0) == 0);  // no boundary at all
    int bad = 0;
    for (const float eta : {0.0f, 1e-4f, 0.1f, 0.9f, 1.0f, 3.0f, 1e3f, 1e8f})
        for (const float k : {0.0f, 1e-4f, 0.1f, 1.0f, 5.0f, 1e3f, 1e8f})
            for (int i = 0; i <= 100; ++i) {
                const float f = fresnel_conductor(0.01f * static_cast<float>(i), eta, k);
                if ((eta != 0 || k != 0) && !(f >= 0 && f <= 1)) ++bad;
            }
    CHECK(bad == 0);
}

TEST_CASE("fresnel: impossible indices are explained") {
    CHECK(conductor_problem(Rgb(0), Rgb(1)) == "");
    CHECK(conductor_problem(Rgb(1.5f), Rgb(0)) == "");
    CHECK(conductor_problem(Rgb(1, 0, 1), Rgb(1, 0, 1)).find("both 0") != std::string::npos);
}
