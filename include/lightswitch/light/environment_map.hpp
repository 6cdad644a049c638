#pragma once

// Light from infinitely far away that an image tells, in the latitude-longitude format.

#include <lightswitch/core/angle.hpp>
#include <lightswitch/core/error.hpp>
#include <lightswitch/core/grid_distribution.hpp>
#include <lightswitch/light/source.hpp>

#include <memory>
#include <numeric>
#include <optional>
#include <string>

namespace lightswitch {

/// Radiance by direction, and how to choose directions by it. Directions are in the coordinates of the map.
///
/// Mitsuba 3's convention (`envmap`): the top row of texels is the direction +y and the bottom row -y, with equal
/// angles between rows; the middle of the image is +z, its left and right edges are -z, and a quarter of the width from
/// the left is +x. Values hold at the middle of a column and are interpolated bilinearly in the angles, across the
/// seam, too. A map of one row has the same value at all heights; of two rows, the lower fills all of the lower half.
///
/// Directions are chosen by cells, whose corners are four neighbouring texels: a cell by its share of the luminance,
/// and in it evenly over its solid angle, which leaves no density to be infinite at the poles (the common method,
/// pbrt-v3, section 14.2.4, is even in the angles). Immutable: safe to use from several threads. Memory: 16 bytes per
/// texel, 512 MiB for 8192 x 4096.
class EnvironmentMap {
public:
    struct Texel {
        int column, row;
        Rgb value;
    };

    /// The first texel that is negative or not finite, row by row from the top; nothing when there is none.
    static std::optional<Texel> problem(std::span<const Rgb> texels, int width) {
        const auto bad = [](const Rgb& c) { return !(is_finite(c) && min_component(c) >= 0); };
        const auto found = std::find_if(texels.begin(), texels.end(), bad);
        if (found == texels.end()) return std::nullopt;
        const auto index = static_cast<int>(found - texels.begin());
        return Texel{index % width, index / width, *found};
    }

    /// `width` x `height` texels (W/m^2/sr), row by row from the top, left to right. Throws `Error` when their number
    /// is another or above 2^30, when a side is longer than 65536, or when one has a `problem`.
    EnvironmentMap(std::vector<Rgb> texels, int width, int height)
        : texels_(checked(std::move(texels), width, height)),
          width_(width),
          height_(height == 2 ? 3 : height),
          bands_(make_bands(width, std::max(height_ - 1, 1))),
          cells_(static_cast<std::size_t>(width), bands_.size(),
                 [this](std::size_t row, std::span<double> powers) { fill(row, powers); }) {
        mean_luminance_ = std::accumulate(band_powers_.begin(), band_powers_.end(), 0.0) / (4 * pi_d);
        if (!empty()) mix();
    }

    /// True when the map is black.
    bool empty() const { return cells_.empty(); }
    /// Mean over all directions, exact for the interpolated map.
    double mean_luminance() const { return mean_luminance_; }

    /// The largest value of each channel.
    Rgb most() const {
        return std::accumulate(texels_.begin(), texels_.end(), Rgb(0),
                               [](const Rgb& a, const Rgb& b) { return glm::max(a, b); });
    }

    /// What arrives from the direction `wi` (unit).
    Rgb radiance(const Vec3& wi) const {
        const Place at = place(wi);
        const auto right = at.column + 1 == static_cast<std::size_t>(width_) ? 0 : at.column + 1;
        const auto below = std::min(at.row + 1, static_cast<std::size_t>(height_) - 1);
        const auto between = [&](std::size_t row) {
            return (1 - at.across) * texel(at.column, row) + at.across * texel(right, row);
        };
        return (1 - at.down) * between(at.row) + at.down * between(below);
    }

    struct Sample {
        Vec3 wi;  ///< unit
        SolidAnglePdf pdf;
        SolidAnglePdf pdf_by_radiance;  ///< density with which `sample(u)` chooses the direction
    };

    /// A direction chosen by the radiance alone. The map must not be empty.
    Sample sample(const Vec2& u) const {
        const GridDistribution::Cell cell = cells_.sample(u);
        const SolidAnglePdf density = cell_pdf(cell.column, cell.row);
        return {direction(cell), density, density};
    }
    SolidAnglePdf pdf(const Vec3& wi) const {
        const Place at = place(wi);
        return cell_pdf(at.column, at.row);
    }

    /// A direction for a surface with that normal: some by the radiance, and the others by the cosine; evenly over the
    /// sphere where the normal is 0. The map must not be empty.
    Sample sample(const Vec3& normal, const Vec2& u) const {
        const interval::Found choice = interval::find(choices_, u.y);
        if (choice.part == bands_.size()) {
            const Vec2 rest(u.x, choice.place);
            const Vec3 wi = normal == Vec3(0) ? uniform_sphere(rest) : Basis(normal).to_world(cosine_hemisphere(rest));
            const Place at = place(wi);
            return mixed(normal, wi, at.column, at.row);
        }
        const GridDistribution::Cell cell = cells_.sample_in_row(choice, u.x);
        return mixed(normal, direction(cell), cell.column, cell.row);
    }
    SolidAnglePdf pdf(const Vec3& normal, const Vec3& wi) const {
        const Place at = place(wi);
        return mixed(normal, wi, at.column, at.row).pdf;
    }

private:
    static constexpr double pi_d = 3.14159265358979323846;

    /// The cells between two rows of texels. Heights are (1 - cos) / 2 of the angle from +y, which is even over the
    /// sphere; in double they keep their digits at both poles.
    struct Band {
        double top, bottom;
        double upper, lower;  ///< solid angle of a cell that the texels of the rows above and below count for
        float density;        ///< one over the solid angle of a cell
    };

    /// A cell, and where in it: in [0, 1], in angles.
    struct Place {
        std::size_t column, row;
        float across, down;
    };

    static std::vector<Rgb> checked(std::vector<Rgb> texels, int width, int height) {
        if (width < 1 || height < 1 || width > 65536 || height > 65536 || std::int64_t{width} * height > 1 << 30 ||
            texels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
            throw Error("an environment map of " + std::to_string(width) + " x " + std::to_string(height) + " with " +
                        std::to_string(texels.size()) + " texels is not possible");
        if (const auto bad = problem(texels, width))
            throw Error("the environment map has the value (" + number_text(double(bad->value.x)) + ", " +
                        number_text(double(bad->value.y)) + ", " + number_text(double(bad->value.z)) + ") in column " +
                        std::to_string(bad->column) + " of row " + std::to_string(bad->row) +
                        "; radiance must be finite and not negative");
        if (height == 2) {
            texels.resize(texels.size() + static_cast<std::size_t>(width));
            std::copy_n(texels.begin() + width, width, texels.begin() + 2 * width);
        }
        return texels;
    }

    static std::vector<Band> make_bands(int width, int count) {
        std::vector<Band> bands;
        const double step = pi_d / count, wedge = 2 * pi_d / width;
        const auto height = [&](int row) { return row == count ? 1 : std::pow(std::sin(row * step / 2), 2); };
        for (int row = 0; row < count; ++row) {
            const double a = row * step, b = a + step, top = height(row), bottom = height(row + 1);
            const double slope = (std::sin(b) - std::sin(a)) / step;
            bands.push_back({.top = top,
                             .bottom = bottom,
                             .upper = wedge * (std::cos(a) - slope),
                             .lower = wedge * (slope - std::cos(b)),
                             .density = static_cast<float>(1 / (wedge * 2 * (bottom - top)))});
        }
        return bands;
    }

    /// The integral of the interpolated luminance over each cell of a row. Positive where any corner is.
    void fill(std::size_t row, std::span<double> powers) {
        const Band& band = bands_[row];
        const std::size_t below = std::min(row + 1, static_cast<std::size_t>(height_) - 1);
        const auto column_power = [&](std::size_t column) {
            return 0.5 * (band.upper * luminance(DVec3(texel(column, row))) +
                          band.lower * luminance(DVec3(texel(column, below))));
        };
        const double first = column_power(0);
        double left = first, sum = 0;
        for (std::size_t column = 0; column < powers.size(); ++column) {
            const double right = column + 1 < powers.size() ? column_power(column + 1) : first;
            powers[column] = left + right;
            sum += powers[column];
            squares_ += powers[column] * powers[column] * double(band.density);
            left = right;
        }
        band_powers_.push_back(sum);
    }

    /// Decides how often directions are chosen by the radiance: the more, the more it varies, but at most 3 times in 4,
    /// because what is bright may be below the horizon. Left over: the cosine, as for a constant environment. Standard
    /// deviation of the irradiance by one sample, relative to it, at 256 x 128 texels, with this choice | with half by
    /// each | by radiance alone: constant map 0 | 0.64 | 1.29; one texel 1e4 brighter, above the horizon 1.46 | 1.80 |
    /// 1.38; one 1e6 brighter, below the horizon 1.7 | 1.0 | 7.9.
    void mix() {
        const double total = 4 * pi_d * mean_luminance_;
        const double variation = 1 - total * total / (4 * pi_d * squares_);
        const double by_radiance = std::clamp(variation, 0.0, 0.75);
        std::vector<double> weights;
        for (const double power : band_powers_) weights.push_back(power / total * by_radiance);
        weights.push_back(1 - by_radiance);
        choices_.resize(weights.size());
        interval::cut(weights, choices_);
    }

    const Rgb& texel(std::size_t column, std::size_t row) const {
        return texels_[row * static_cast<std::size_t>(width_) + column];
    }

    Place place(const Vec3& wi) const {
        const float x = turns(wi.x, -wi.z) * static_cast<float>(width_) - 0.5f, left = std::floor(x);
        const float y = 2 * turns(std::sqrt(square(wi.x) + square(wi.z)), wi.y) * static_cast<float>(height_ - 1);
        const std::size_t row = std::min(static_cast<std::size_t>(y), bands_.size() - 1);
        const int column = static_cast<int>(left);
        return {.column = static_cast<std::size_t>(column < 0 ? column + width_ : column),
                .row = row,
                .across = x - left,
                .down = y - static_cast<float>(row)};
    }

    Vec3 direction(const GridDistribution::Cell& cell) const {
        const Band& band = bands_[cell.row];
        const auto [cos, sin] = cos_sin_turns((double(cell.column) + 0.5 + double(cell.place.x)) / width_);
        const double height = band.top + double(cell.place.y) * (band.bottom - band.top);
        const auto radius = static_cast<float>(2 * std::sqrt(height * (1 - height)));
        return {radius * sin, static_cast<float>(1 - 2 * height), -radius * cos};
    }

    SolidAnglePdf cell_pdf(std::size_t column, std::size_t row) const {
        return {cells_.probability(column, row) * bands_[row].density};
    }

    Sample mixed(const Vec3& normal, const Vec3& wi, std::size_t column, std::size_t row) const {
        if (empty()) return {wi, {}, {}};
        const float by_radiance = interval::probability(choices_, row) * cells_.probability_in_row(column, row);
        const float others = interval::probability(choices_, bands_.size());
        const SolidAnglePdf pdf_of_others =
            normal == Vec3(0) ? uniform_sphere_pdf() : cosine_hemisphere_pdf(dot(normal, wi));
        return {wi, {by_radiance * bands_[row].density + others * pdf_of_others.value}, cell_pdf(column, row)};
    }

    std::vector<Rgb> texels_;
    int width_, height_;
    std::vector<Band> bands_;
    std::vector<double> band_powers_;  // integrals of the luminance
    double squares_ = 0;               // integral of the squared luminance, constant in each cell
    double mean_luminance_ = 0;
    GridDistribution cells_;
    std::vector<std::uint32_t> choices_;  // of the bands, and of the cosine
};

/// An environment map as a light of a scene. Cheap to copy: the map is shared.
struct MappedEnvironment {
    static constexpr bool infinite = true;

    std::shared_ptr<const EnvironmentMap> map;
    Mat3 to_world;       ///< from directions of the map to those of the scene: a rotation, possibly mirrored
    float scale;         ///< of the map's values; must not take one beyond the range of a float
    float scene_radius;  ///< of the sphere that the light must fill

    /// As that of a constant environment of the map's mean.
    double power() const {
        return double(scale) * map->mean_luminance() * double(pi * pi) * double(square(scene_radius));
    }

    Rgb radiance(const Vec3& wi) const { return scale * map->radiance(to_map(wi)); }
    /// The largest radiance from anywhere.
    Rgb brightest() const { return scale * map->most(); }

    LightSample sample(const SurfacePoint& from, const Vec2& u) const {
        if (map->empty()) return {};
        const EnvironmentMap::Sample chosen = map->sample(to_map(from.lit_normal()), u);
        const Vec3 wi = to_world * chosen.wi;
        return {.wi = wi,
                .radiance = scale * map->radiance(chosen.wi),
                .pdf = chosen.pdf,
                .dirac = false,
                .visibility = from.spawn(wi),
                .spread = chosen.pdf.value / emission_pdf(chosen.pdf_by_radiance).value};
    }

    SolidAnglePdf pdf(const Vec3& normal, const Vec3& wi) const { return map->pdf(to_map(normal), to_map(wi)); }

    LightEmission emit(const Vec2& place, const Vec2& direction) const {
        if (map->empty()) return {};
        const EnvironmentMap::Sample chosen = map->sample(direction);
        const EmissionPdf density = emission_pdf(chosen.pdf);
        return {.ray = ray_into_scene(to_world * chosen.wi, place, scene_radius),
                .weight = scale * map->radiance(chosen.wi) / density.value,
                .pdf = density};
    }
    EmissionPdf emission_pdf(const Vec3& wi) const { return emission_pdf(map->pdf(to_map(wi))); }
    float spread(const SurfacePoint& at, const Vec3& wi, const Vec3&) const {
        const float emission = emission_pdf(wi).value;
        return emission > 0 ? pdf(at.lit_normal(), wi).value / emission : 0;
    }

private:
    Vec3 to_map(const Vec3& v) const { return v * to_world; }
    EmissionPdf emission_pdf(SolidAnglePdf direction) const { return uniform_disk_pdf(scene_radius) * direction; }
};

/// What a description says of it: `scale` times the radiance of the map, whose directions become those of the scene by
/// `to_world`, a rotation that may be mirrored.
struct EnvironmentMapSource {
    std::shared_ptr<const EnvironmentMap> map;
    DMat3 to_world{1};
    double scale = 1;

    std::string problem() const {
        if (!map) return "the environment has no map";
        if (!(scale >= 0) || !std::isfinite(scale)) return "the environment's scale is not a number of at least 0";
        if (!is_orthonormal(to_world, 1e-3)) return "the environment's transform must be a rotation";
        return detail::radiance_problem(Rgb(DVec3(map->most()) * scale), "the environment's radiance");
    }
    MappedEnvironment light(const RenderSpace&, double radius) const {
        return {map, Mat3(to_world), float(scale), float(radius)};
    }
    Emitter emitter(const MappedEnvironment&) const {
        return {.kind = Emitter::Kind::environment, .strength = Rgb(float(scale * map->mean_luminance()))};
    }
};

}  // namespace lightswitch
