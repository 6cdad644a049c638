// furnace: what white surfaces do to the light of a white sky: the fraction that comes back or gets through, by model,
// roughness and angle. Models of single scattering lose what facets would reflect twice; none may gain, but for two
// that do so where they come from.
//
// Printed as the table of docs/conventions.md. Exit status 1 when a value of any other model is above 1 by more than
// its standard error allows.

#include <lightswitch/scene/library.hpp>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

namespace ls = lightswitch;

namespace {

bool may_gain = false, gains = false;

/// Mean and standard error of the weights of samples: light that arrives along `cosine`, followed as importance, which
/// no change of index scales.
void print_albedo(const auto& model, float cosine) {
    constexpr int side = 64, count = side * side * side;
    const ls::Vec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        // The centres of a grid over all choices, turned a little from slice to slice.
        const int x = i % side, y = i / side % side, z = i / (side * side);
        const auto in = [](double v) { return float(v - std::floor(v)); };
        const ls::Vec3 u(in((x + 0.5 + 0.61803 * z) / side), in((y + 0.5 + 0.41421 * z) / side),
                         (float(z) + 0.5f) / side);
        const auto sample = model.sample(wo, u, ls::Transport::importance);
        const double weight = sample ? double(sample->weight.x) : 0;
        sum += weight;
        squares += weight * weight;
    }
    const double mean = sum / count, error = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
    gains = gains || (!may_gain && mean > 1 + 4 * error + 1e-4);
    std::printf(" %.3f |", mean);
}

/// A row: `make(alpha)` for three roughnesses, at three angles each.
void print_row(const char* name, const auto& make) {
    std::printf("| %s |", name);
    for (const float alpha : {0.1f, 0.3f, 1.0f})
        for (const float cosine : {0.95f, 0.5f, 0.1f}) print_albedo(make(alpha), cosine);
    std::printf("\n");
}

void print_smooth(const char* name, const auto& model) {
    std::printf("| %s |", name);
    for (const float cosine : {0.95f, 0.5f, 0.1f}) print_albedo(model, cosine);
    std::printf(" | | | | | |\n");
}

}  // namespace

int main() {
    using ls::Facets, ls::Rgb;
    std::printf("| model, white | 0.1: 0.95 | 0.5 | 0.1 | 0.3: 0.95 | 0.5 | 0.1 | 1: 0.95 | 0.5 | 0.1 |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
    print_smooth("`diffuse`", ls::Lambert{Rgb(1)});
    print_smooth("`conductor`", ls::Conductor{});
    print_smooth("`dielectric`", ls::Dielectric{});
    print_smooth("`thindielectric`", ls::ThinDielectric{});
    print_smooth("`plastic`", ls::Plastic{.diffuse_reflectance = Rgb(1)});
    print_row("`roughconductor`, GGX",
              [](float a) { return ls::RoughConductor{.distribution = Facets::ggx, .alpha_u = a, .alpha_v = a}; });
    print_row("`roughconductor`, Beckmann",
              [](float a) { return ls::RoughConductor{.distribution = Facets::beckmann, .alpha_u = a, .alpha_v = a}; });
    print_row("`roughdielectric`, GGX",
              [](float a) { return ls::RoughDielectric{.distribution = Facets::ggx, .alpha_u = a, .alpha_v = a}; });
    print_row("`roughdielectric`, Beckmann", [](float a) {
        return ls::RoughDielectric{.distribution = Facets::beckmann, .alpha_u = a, .alpha_v = a};
    });
    print_row("`roughplastic`, GGX", [](float a) {
        return ls::RoughPlastic{.distribution = Facets::ggx, .alpha = a, .diffuse_reflectance = Rgb(1)};
    });
    const auto coated = [](const auto& base, float alpha) {
        static std::vector<std::unique_ptr<const ls::detail::CoatOptics>> coats;
        coats.push_back(std::make_unique<const ls::detail::CoatOptics>(ls::Coat{.alpha = alpha}));
        return ls::Mapped<std::remove_cvref_t<decltype(base)>>{base, {.active = true}, coats.back().get()};
    };
    print_smooth("`coating` of `diffuse`", coated(ls::Lambert{Rgb(1)}, 0));
    print_smooth("`coating` of `conductor`", coated(ls::Conductor{}, 0));
    print_smooth("`coating` of `dielectric`", coated(ls::Dielectric{}, 0));
    print_row("`roughcoating`, Beckmann, of `diffuse`", [&](float a) { return coated(ls::Lambert{Rgb(1)}, a); });
    may_gain = true;
    print_row("`roughdiffuse`", [](float a) { return ls::RoughDiffuse{.alpha = a, .reflectance = Rgb(1)}; });
    // Roughness is the square root of alpha here.
    print_row("`principled`, no metal",
              [](float a) { return ls::Principled{.base_color = Rgb(1), .roughness = std::sqrt(a)}; });
    may_gain = false;
    print_row("`principled`, metal",
              [](float a) { return ls::Principled{.base_color = Rgb(1), .roughness = std::sqrt(a), .metallic = 1}; });
    print_row("`principled`, glass",
              [](float a) { return ls::Principled{.base_color = Rgb(1), .roughness = std::sqrt(a), .spec_trans = 1}; });
    print_row("`principledthin`, glass", [](float a) {
        return ls::PrincipledThin{.base_color = Rgb(1), .roughness = std::sqrt(a), .spec_trans = 1};
    });
    print_row("`ward`, lobe alone", [](float a) {
        return ls::Ward{.alpha_u = a, .alpha_v = a, .diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(1)};
    });
    print_smooth("`phong`, lobe alone, exponent 30",
                 ls::ModifiedPhong{.diffuse_reflectance = Rgb(0), .specular_reflectance = Rgb(1)});
    return gains ? 1 : 0;
}
