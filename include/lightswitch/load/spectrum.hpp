#pragma once

// Spectra, and the colours that they have for Mitsuba's RGB variants.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/file.hpp>
#include <lightswitch/load/cie.hpp>
#include <lightswitch/load/text.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightswitch {

/// A quantity by wavelength: linear between the samples and 0 outside of them, or the same everywhere.
struct Spectrum {
    std::vector<double> wavelengths{};  ///< nanometres, increasing; empty when there is one value for all
    std::vector<double> values{};       ///< as many, or one
};

/// What a spectrum describes, which decides what its colour is.
enum class SpectrumUse {
    reflectance,  ///< as daylight (D65) shows it, clamped to [0, 1]
    index,        ///< as daylight shows it, not negative: `eta` and `k` of a metal, absorption
    emission,     ///< as it shines, not negative
};

/// The colour that Mitsuba 3.9.1 gives a spectrum when its variant is an RGB one. Like there it is a sum over 1000
/// wavelengths from 360 to 830 nm, not an integral: what lies between two of them, 0.47 nm apart, may be missed.
/// Colours outside of BT.709's triangle are clamped channel by channel. A spectrum of one value is grey and not
/// clamped, but as an emission it has the white of equal energy, which is not that of sRGB.
///
/// Throws `Error`, of that place, when the numbers of wavelengths and values do not fit, or the colour is too large for
/// floats.
Rgb spectrum_to_rgb(const Spectrum& spectrum, SpectrumUse use, const Origin& where = {});

/// The colour, as an emission, of a black body of `temperature` kelvin, in W/(m^2 sr nm) and between two wavelengths in
/// nanometres (Planck's law; the constants are those of the SI of 2019). Mitsuba's RGB variants refuse this type; its
/// spectral ones see 0.1 percent more, for the sum above is that much below the integral, and keep negative channels.
///
/// Throws `Error`, of that place, unless the temperature is positive, or when the colour is too large for floats.
Rgb blackbody_to_rgb(double temperature, double lowest = detail::cie_first, double highest = detail::cie_last,
                     const Origin& where = {});

/// Reads a text file of at most 1 MiB: a wavelength in nanometres and a value on each line, `#` begins a comment.
///
/// Throws `Error` with the line for anything else in it, for a wavelength that is not above the one before, and unless
/// there are two.
Spectrum load_spectrum(const std::filesystem::path& path);

namespace detail {

inline constexpr std::uintmax_t max_spectrum_bytes = std::uintmax_t(1) << 20;

/// Mitsuba's sum, and the numbers by which it is divided: with these a spectrum of 1 has luminance 1 as an emission (to
/// 6e-7), but 0.9989 as a reflectance.
inline constexpr int spectrum_steps = 1000;
inline constexpr double cie_y_sum = 106.7502593994140625, cie_d65_mean = 98.99741751876255;

/// The colour, not clamped, of the emission that is `value(wavelength)` at a wavelength in nanometres; in daylight, of
/// that reflectance.
template <class F>
DVec3 sum_spectrum(F&& value, bool in_daylight) {
    DVec3 xyz(0);
    for (int i = 0; i < spectrum_steps; ++i) {
        const double wavelength = cie_first + i / (spectrum_steps - 1.0) * (cie_last - cie_first);
        const auto [x, y, z, d65] = cie_at(wavelength);
        xyz += value(wavelength) * (in_daylight ? d65 / cie_d65_mean : 1) * DVec3(x, y, z);
    }
    return xyz_to_rgb(xyz * ((cie_last - cie_first) / spectrum_steps / cie_y_sum));
}

/// `rgb` in floats, which must be finite.
inline Rgb finite_rgb(const DVec3& rgb, const Origin& where) {
    const Rgb result(rgb);
    if (!lightswitch::is_finite(result)) fail(where, "the colour of the spectrum is too large");
    return result;
}

/// Appends a sample.
inline void add_sample(Spectrum& spectrum, double wavelength, double value, const Origin& where) {
    if (!(wavelength > 0)) fail(where, "a wavelength must be above 0, not " + shown(wavelength));
    if (!spectrum.wavelengths.empty() && !(wavelength > spectrum.wavelengths.back()))
        fail(where, "wavelengths must increase, but " + shown(wavelength) + " comes after " +
                        shown(spectrum.wavelengths.back()));
    spectrum.wavelengths.push_back(wavelength);
    spectrum.values.push_back(value);
}

inline void check_samples(const Spectrum& spectrum, const Origin& where) {
    if (spectrum.wavelengths.size() < 2)
        fail(where, "a spectrum needs at least two wavelengths, not " + std::to_string(spectrum.wavelengths.size()));
}

/// The finite numbers in a list that commas or spaces separate.
inline std::vector<double> parse_list(std::string_view text, const Origin& where) {
    std::vector<double> numbers;
    for (auto word = next_word(text, ", \t\r\n"); !word.empty(); word = next_word(text, ", \t\r\n"))
        numbers.push_back(finite_number(word, where));
    return numbers;
}

/// The spectrum of `<spectrum value="...">`: one number, or pairs such as "400:0.1, 700:0.5".
inline Spectrum parse_spectrum(std::string_view text, const Origin& where) {
    if (text.find(':') == std::string_view::npos) {
        Spectrum uniform{.values = parse_list(text, where)};
        if (uniform.values.size() != 1)
            fail(where, "needs one number, or wavelengths and values such as \"400:0.1, 700:0.5\"");
        return uniform;
    }
    Spectrum result;
    for (auto word = next_word(text, ", \t\r\n"); !word.empty(); word = next_word(text, ", \t\r\n")) {
        const std::size_t colon = std::min(word.find(':'), word.size());
        const auto wavelength = parse_number(word.substr(0, colon));
        const auto value = parse_number(word.substr(std::min(colon + 1, word.size())));
        if (!wavelength || !value)
            fail(where, quote(word) + " is not a wavelength and a value, with a colon and no space between them");
        add_sample(result, *wavelength, *value, where);
    }
    check_samples(result, where);
    return result;
}

/// The spectrum of type `irregular`: lists of the same length.
inline Spectrum parse_irregular_spectrum(std::string_view wavelengths, std::string_view values, const Origin& where) {
    const auto at = parse_list(wavelengths, where), numbers = parse_list(values, where);
    if (at.size() != numbers.size())
        fail(where,
             "has " + std::to_string(at.size()) + " wavelengths, but " + std::to_string(numbers.size()) + " values");
    Spectrum result;
    for (std::size_t i = 0; i < at.size(); ++i) add_sample(result, at[i], numbers[i], where);
    check_samples(result, where);
    return result;
}

/// The spectrum of type `regular`: values at equal distances from the lowest wavelength to the highest.
inline Spectrum parse_regular_spectrum(double lowest, double highest, std::string_view values, const Origin& where) {
    const auto numbers = parse_list(values, where);
    Spectrum result;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double t = numbers.size() > 1 ? static_cast<double>(i) / static_cast<double>(numbers.size() - 1) : 0;
        add_sample(result, (1 - t) * lowest + t * highest, numbers[i], where);
    }
    check_samples(result, where);
    return result;
}

/// The spectrum in the text of a file.
inline Spectrum parse_spectrum_file(std::string_view text, const std::string& file) {
    Origin where{file, 0, {}};
    Spectrum result;
    for (text = without_byte_order_mark(text); !text.empty();) {
        ++where.line;
        std::string_view line = next_line(text);
        line = line.substr(0, line.find('#'));
        const std::string_view first = next_word(line), second = next_word(line);
        if (first.empty()) continue;
        const auto wavelength = parse_number(first), value = parse_number(second);
        if (!wavelength || !value || !next_word(line).empty())
            fail(where, "expected a wavelength and a value, two finite numbers with space between them");
        add_sample(result, *wavelength, *value, where);
    }
    check_samples(result, {file, 0, {}});
    return result;
}

}  // namespace detail

inline Rgb spectrum_to_rgb(const Spectrum& spectrum, SpectrumUse use, const Origin& where) {
    const auto& [wavelengths, values] = spectrum;
    if (values.size() != std::max<std::size_t>(wavelengths.size(), 1) || wavelengths.size() == 1)
        fail(where, "a spectrum needs one value alone, or a value for each of two or more wavelengths");
    if (wavelengths.empty()) {
        const bool shines = use == SpectrumUse::emission;
        return detail::finite_rgb(values[0] * (shines ? detail::xyz_to_rgb(DVec3(1)) : DVec3(1)), where);
    }
    std::size_t i = 0;
    const auto value = [&](double wavelength) {
        if (wavelength < wavelengths.front() || wavelength > wavelengths.back()) return 0.0;
        while (i + 2 < wavelengths.size() && wavelengths[i + 1] <= wavelength) ++i;
        const double t = (wavelength - wavelengths[i]) / (wavelengths[i + 1] - wavelengths[i]);
        return (1 - t) * values[i] + t * values[i + 1];
    };
    const Rgb rgb = detail::finite_rgb(detail::sum_spectrum(value, use != SpectrumUse::emission), where);
    return glm::clamp(rgb, 0.0f, use == SpectrumUse::reflectance ? 1.0f : std::numeric_limits<float>::max());
}

inline Rgb blackbody_to_rgb(double temperature, double lowest, double highest, const Origin& where) {
    constexpr double planck = 6.62607015e-34, speed_of_light = 299792458, boltzmann = 1.380649e-23;  // SI
    if (!(temperature > 0)) fail(where, "a temperature must be above 0 K, not " + detail::shown(temperature));
    const auto radiance = [&](double wavelength) {
        if (wavelength < lowest || wavelength > highest) return 0.0;
        const double metres = wavelength * 1e-9;
        const double per_metre = 2 * planck * speed_of_light * speed_of_light / std::pow(metres, 5) /
                                 std::expm1(planck * speed_of_light / (metres * boltzmann * temperature));
        return 1e-9 * per_metre;
    };
    return glm::max(detail::finite_rgb(detail::sum_spectrum(radiance, false), where), 0.0f);
}

inline Spectrum load_spectrum(const std::filesystem::path& path) {
    return detail::parse_spectrum_file(read_file(path, detail::max_spectrum_bytes), path.string());
}

}  // namespace lightswitch
