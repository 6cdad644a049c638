#pragma once

// What a rough clear coat lets through: a table that surface models share.

#include <lightswitch/bsdf/fresnel.hpp>
#include <lightswitch/bsdf/microfacets.hpp>
#include <lightswitch/bsdf/parameter.hpp>

#include <array>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

namespace lightswitch {

/// How much light gets through a rough boundary with isotropic facets, by single scattering with Smith's masking.
///
/// The numbers are Mitsuba 3's (`roughplastic`), so that images agree: transmittance at 64 equidistant cosines,
/// straight between them, and the reflectance from inside as the plain mean over these cosines. Both are less than the
/// integrals (a smooth coat of index 1.49 is said to reflect 0.581 of the light inside, and not 0.590), and what is
/// lost is absorbed.
class RoughCoat {
public:
    static constexpr int cosines = 64;

    /// Absorbs everything.
    RoughCoat() = default;

    /// Takes 3 to 50 ms, and eight times that for `eta` below 1. At `eta` 1 there is no boundary.
    RoughCoat(Facets distribution, float alpha, float eta) {
        if (eta == 1) {
            transmittances_.fill(1);
            return;
        }
        const Microfacets facets(distribution, alpha, alpha);
        // Total reflection, which has an edge, needs more.
        const std::vector<Node> nodes = gauss_legendre(eta > 1 ? 32 : 128);
        double inside = 0;
        // Facets are drawn symmetrically in the second of two numbers: half of the square does.
        for (int i = 0; i < cosines; ++i) {
            const float z = std::max(static_cast<float>(i) / (cosines - 1), 1e-6f);
            const Vec3 wo{std::sqrt((1 - z) * (1 + z)), 0, z};
            double sum = 0;
            for (const Node& x : nodes)
                for (std::size_t j = 0; 2 * j < nodes.size(); ++j)
                    sum += 2 * x.weight * nodes[j].weight *
                           double(transmitted(facets, wo, {x.position, nodes[j].position}, eta));
            transmittances_[static_cast<std::size_t>(i)] = static_cast<float>(sum);

            // Only the sum over all cosines counts: Fibonacci's lattice, shifted from one to the next.
            constexpr unsigned points = 2584, step = 1597;
            double reflectance = 0;
            for (unsigned j = 0; j < points; ++j) {
                const double x = (j + modulo_1(0.754877666246693 * i)) / points;
                const double y = modulo_1(static_cast<double>(j * step) / points + 0.569840290998053 * i);
                reflectance += double(reflected(facets, wo, Vec2(x, 0.5 * y), 1 / eta));
            }
            inside += double(z) * reflectance / points;
        }
        inside_reflectance_ = static_cast<float>(2 * inside / cosines);
    }

    /// What of the light from the direction with that cosine gets in; or of diffuse light from inside gets out there,
    /// times eta^2.
    float transmittance(float cosine) const {
        const float x = cosine * (cosines - 1);
        const int i = std::clamp(static_cast<int>(x), 0, cosines - 2);
        const float left = transmittances_[static_cast<std::size_t>(i)];
        return left + (x - static_cast<float>(i)) * (transmittances_[static_cast<std::size_t>(i) + 1] - left);
    }

    /// What of diffuse light from inside is reflected.
    float inside_reflectance() const { return inside_reflectance_; }

private:
    struct Node {
        float position;
        double weight;
    };

    /// Gauss's points in (0, 1), from the largest, by Newton's method on Legendre's polynomial (Numerical Recipes,
    /// section 4.6).
    static std::vector<Node> gauss_legendre(int n) {
        std::vector<Node> nodes;
        for (int i = 0; i < n; ++i) {
            double x = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1;
            for (int step = 0; step < 8; ++step) {
                double p = 1, before = 0;
                for (int k = 1; k <= n; ++k) before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
                slope = n * (before - x * p) / ((1 - x) * (1 + x));
                x -= p / slope;
            }
            nodes.push_back({static_cast<float>(0.5 + 0.5 * x), 1 / ((1 - x) * (1 + x) * slope * slope)});
        }
        return nodes;
    }

    static double modulo_1(double x) { return x - std::floor(x); }

    /// Of the light from `wo`, what a facet that is drawn with `u` refracts to the other side, past all other facets.
    static float transmitted(const Microfacets& facets, const Vec3& wo, const Vec2& u, float eta) {
        const Vec3 m = normalize(facets.sample_visible_normal(wo, u));
        const float cosine = dot(wo, m);
        if (!(cosine > 0)) return 0;
        const FresnelDielectric fresnel = fresnel_dielectric(cosine, eta);
        const Vec3 inwards = wo / fresnel.eta - (cosine / fresnel.eta + fresnel.cos_t) * m;
        return fresnel.cos_t != 0 && inwards.z > 0 ? (1 - fresnel.reflectance) * facets.masking(inwards) : 0;
    }

    /// The same for reflection.
    static float reflected(const Microfacets& facets, const Vec3& wo, const Vec2& u, float eta) {
        const Vec3 m = normalize(facets.sample_visible_normal(wo, u));
        const float cosine = dot(wo, m);
        const Vec3 wi = 2 * cosine * m - wo;
        if (!(cosine > 0 && wi.z > 0)) return 0;
        return fresnel_dielectric(cosine, eta).reflectance * facets.masking(wi);
    }

    std::array<float, cosines> transmittances_{};
    float inside_reflectance_ = 0;
};

/// The coat of that kind, made when it is first asked for and kept until the program ends (some 300 bytes). May be
/// asked for by several threads at once. Where the parameters are impossible it absorbs everything.
inline const RoughCoat& rough_coat(Facets distribution, float alpha, float eta) {
    using Key = std::tuple<Facets, float, float>;
    static const RoughCoat black;
    if (!as_roughness.contains(alpha) || !as_relative_index.contains(eta)) return black;
    const Key key{distribution, alpha, eta};
    thread_local std::pair<Key, const RoughCoat*> latest{};  // models are made one like the other
    if (latest.second && latest.first == key) return *latest.second;
    static std::mutex mutex;
    static std::map<Key, RoughCoat> coats;
    const std::lock_guard lock(mutex);
    auto found = coats.find(key);
    if (found == coats.end()) found = coats.emplace(key, RoughCoat(distribution, alpha, eta)).first;
    latest = {key, &found->second};
    return found->second;
}

}  // namespace lightswitch
