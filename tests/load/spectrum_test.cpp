#include "load/files.hpp"
#include "support/paths.hpp"
#include "support/relative.hpp"

#include <lightswitch/load/spectrum.hpp>

#include <map>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

const Origin here{"scene.xml", 7, "<spectrum name=\"eta\">"};

Spectrum parse(std::string_view text) { return detail::parse_spectrum(text, here); }

/// What Mitsuba sees in tests/data/spectra/spectra.txt: the use, the spectrum as text, its colour.
struct Expected {
    std::string use, spectrum;
    DVec3 rgb;
};

std::vector<Expected> expected_colors() {
    const std::string bytes = read_file(test::folder() + "/data/spectra/spectra.txt", 1 << 20);
    std::vector<Expected> result;
    for (std::string_view text = bytes; !text.empty();) {
        std::string_view line = detail::next_line(text);
        const auto field = [&] {
            const std::string_view found = line.substr(0, line.find(';'));
            line.remove_prefix(std::min(found.size() + 2, line.size()));
            return std::string(found);
        };
        Expected entry{.use = field(), .spectrum = field(), .rgb = {}};
        for (int c = 0; c < 3; ++c) entry.rgb[c] = detail::parse_number(detail::next_word(line)).value();
        result.push_back(entry);
    }
    return result;
}

}  // namespace

TEST_CASE("spectra have the colours that Mitsuba gives them") {
    const std::map<std::string, SpectrumUse> uses{
        {"reflectance", SpectrumUse::reflectance}, {"index", SpectrumUse::index}, {"emission", SpectrumUse::emission}};
    int compared = 0;
    for (const auto& [use, text, rgb] : expected_colors()) {
        if (use == "blackbody") continue;
        CAPTURE(use);
        CAPTURE(text);
        const Spectrum spectrum =
            text == "lamp.spd" ? load_spectrum(test::folder() + "/data/spectra/lamp.spd") : parse(text);
        const Rgb found = spectrum_to_rgb(spectrum, uses.at(use));
        // Mitsuba's tables are of floats; where a channel is a small difference, that is large beside it.
        const double largest = std::max({std::abs(rgb.x), std::abs(rgb.y), std::abs(rgb.z)});
        for (int c = 0; c < 3; ++c) CHECK(found[c] == relative(rgb[c], 1e-6).or_absolute(2e-7 * largest));
        ++compared;
    }
    CHECK(compared == 51);
}

TEST_CASE("black bodies have the colours of Planck's law") {
    int compared = 0;
    for (const auto& [use, text, rgb] : expected_colors()) {
        if (use != "blackbody") continue;
        CAPTURE(text);
        std::string_view rest = text;
        std::vector<double> numbers = detail::parse_list(rest, here);
        const Rgb found = numbers.size() == 1 ? blackbody_to_rgb(numbers[0])
                                              : blackbody_to_rgb(numbers[0], numbers.at(1), numbers.at(2));
        // The older constants change exponents of up to 50 by 3e-7 of them, Mitsuba computes in floats.
        const double largest = std::max({rgb.x, rgb.y, rgb.z});
        for (int c = 0; c < 3; ++c) CHECK(found[c] == relative(rgb[c], 2e-5).or_absolute(3e-6 * largest));
        ++compared;
    }
    CHECK(compared == 7);

    CHECK(blackbody_to_rgb(1e-3) == Rgb(0));
    CHECK(blackbody_to_rgb(5e-324) == Rgb(0));
    for (const double temperature : {0.0, -1.0, std::nan("")})
        CHECK(contains(message_of([&] { blackbody_to_rgb(temperature, 360, 830, here); }),
                       "scene.xml:7: <spectrum name=\"eta\">: a temperature must be above 0 K"));
    for (const double temperature : {1e300, double(infinity)})
        CHECK(contains(message_of([&] { blackbody_to_rgb(temperature); }), "too large"));
}

TEST_CASE("the table of the standard observer and of daylight is the CIE's") {
    const auto at = [](double w) { return detail::cie_at(w); };
    // Some rows, and sums over all, of CIE 018:2019.
    CHECK(at(360) == std::array{0.0001299, 0.000003917, 0.0006061, 46.6383});
    CHECK(at(555)[1] == 1);
    CHECK(at(560) == std::array{0.5945, 0.995, 0.0039, 100.0});
    CHECK(at(830)[0] == 0.000001251141);
    CHECK(at(562.5)[3] == relative((100 + 98.1671) / 2, 1e-15));
    DVec3 sum(0);
    for (const auto& row : detail::cie_table) sum += DVec3(row[0], row[1], row[2]);
    CHECK(5 * sum.x == relative(106.8656999431, 1e-12));
    CHECK(5 * sum.y == relative(106.8570392524, 1e-12));
    CHECK(5 * sum.z == relative(106.8933215449, 1e-12));
}

TEST_CASE("one is white, and the sum is near the integral") {
    const Spectrum one = parse("100:1, 1000:1");
    CHECK(luminance(DVec3(spectrum_to_rgb(one, SpectrumUse::emission))) == relative(1, 5e-5));
    for (int c = 0; c < 3; ++c) CHECK(spectrum_to_rgb(one, SpectrumUse::reflectance)[c] == relative(0.99889, 2e-4));
    // Colours add up, and what is twice as strong has twice the colour.
    const Rgb half = spectrum_to_rgb(parse("100:0.5, 1000:0.5"), SpectrumUse::emission);
    for (int c = 0; c < 3; ++c) CHECK(2 * half[c] == relative(spectrum_to_rgb(one, SpectrumUse::emission)[c], 1e-6));
}

TEST_CASE("the text of a spectrum is one number or pairs") {
    CHECK(parse(" 0.5 ").values == std::vector{0.5});
    CHECK(parse("0.5,").wavelengths.empty());
    const Spectrum pairs = parse("400:0.1,  500:2e-1\t600.5:+3\n700:-4,");
    CHECK(pairs.wavelengths == std::vector{400.0, 500.0, 600.5, 700.0});
    CHECK(pairs.values == std::vector{0.1, 0.2, 3.0, -4.0});

    const auto regular = detail::parse_regular_spectrum(400, 700, "1, 2 3,4", here);
    CHECK(regular.wavelengths == std::vector{400.0, 500.0, 600.0, 700.0});
    CHECK(regular.values == std::vector{1.0, 2.0, 3.0, 4.0});
    const auto irregular = detail::parse_irregular_spectrum("400, 700", "0.1 0.2", here);
    CHECK(irregular.wavelengths == std::vector{400.0, 700.0});
    CHECK(irregular.values == std::vector{0.1, 0.2});

    for (const auto& [text, what] : std::map<std::string, std::string>{
             {"", "needs one number"},
             {" , ", "needs one number"},
             {"0.5 0.6", "needs one number"},
             {"abc", "\"abc\" is not a finite number"},
             {"nan", "\"nan\" is not a finite number"},
             {"400:0.1", "at least two wavelengths, not 1"},
             {"400:0.1, 500", "\"500\" is not a wavelength and a value"},
             {"400:0.1, :0.5", "\":0.5\" is not a wavelength and a value"},
             {"400:0.1, 500:", "\"500:\" is not a wavelength and a value"},
             {"400:0.1, 500:1:2", "\"500:1:2\" is not a wavelength and a value"},
             {"400 : 0.1, 500:1", "\"400\" is not a wavelength and a value"},
             {"400:inf, 500:1", "\"400:inf\" is not a wavelength and a value"},
             {"500:1, 400:1", "wavelengths must increase, but 400 comes after 500"},
             {"400:1, 400:1", "wavelengths must increase, but 400 comes after 400"},
             {"0:1, 400:1", "a wavelength must be above 0, not 0"},
             {":", "\":\" is not a wavelength and a value"},
         }) {
        const std::string message = message_of([&] { parse(text); });
        CHECK_MESSAGE(message.starts_with("scene.xml:7: <spectrum name=\"eta\">: "), text << " -> " << message);
        CHECK_MESSAGE(contains(message, what), text << " -> " << message);
    }
    CHECK(contains(message_of([] { detail::parse_irregular_spectrum("1 2 3", "1 2", here); }),
                   "has 3 wavelengths, but 2 values"));
    CHECK(contains(message_of([] { detail::parse_irregular_spectrum("", "", here); }),
                   "at least two wavelengths, not 0"));
    CHECK(contains(message_of([] { detail::parse_regular_spectrum(400, 700, "1", here); }),
                   "at least two wavelengths, not 1"));
    CHECK(contains(message_of([] { detail::parse_regular_spectrum(700, 400, "1 2", here); }),
                   "wavelengths must increase"));
}

TEST_CASE("a spectrum that is too large or incomplete is an error, not a wrong colour") {
    for (const auto use : {SpectrumUse::reflectance, SpectrumUse::index, SpectrumUse::emission}) {
        const auto message = [&](const Spectrum& s) { return message_of([&] { spectrum_to_rgb(s, use, here); }); };
        CHECK(contains(message(parse("400:1e308, 700:1e308")),
                       "scene.xml:7: <spectrum name=\"eta\">: the colour of the"));
        CHECK(contains(message(parse("400:-1e308, 500:1e308, 700:-1e308")), "too large"));
        CHECK(contains(message(parse("1e39")), "too large"));
        CHECK(contains(message({}), "one value alone"));
        CHECK(contains(message({{500}, {1}}), "one value alone"));
        CHECK(contains(message({{500, 600}, {1}}), "one value alone"));
        CHECK(contains(message({{}, {1, 2}}), "one value alone"));
        CHECK(spectrum_to_rgb(parse("5e-324:1, 1e308:1"), use).x > 0.9f);
    }
}

TEST_CASE("files of spectra are pairs of numbers by lines") {
    const Folder folder;
    const auto read = [&](std::string_view text) { return load_spectrum(folder.write("a.spd", text)); };
    const Spectrum read_pairs = read("\xef\xbb\xbf# comment\n\n400 0.1 # here, too\r\n  500\t2e-1\r\r600 +3");
    CHECK(read_pairs.wavelengths == std::vector{400.0, 500.0, 600.0});
    CHECK(read_pairs.values == std::vector{0.1, 0.2, 3.0});

    for (const auto& [text, what] : std::map<std::string, std::string>{
             {"", "a.spd: a spectrum needs at least two wavelengths, not 0"},
             {"400 1", "a.spd: a spectrum needs at least two wavelengths, not 1"},
             {"# 1 2\n400 1\n500", "a.spd:3: expected a wavelength and a value"},
             {"400 1\n500 1 2", "a.spd:2: expected a wavelength and a value"},
             {"400,1\n500,2", "a.spd:1: expected a wavelength and a value"},
             {"400 1\n500 0x2", "a.spd:2: expected a wavelength and a value"},
             {"400 1\n\n300 1", "a.spd:3: wavelengths must increase, but 300 comes after 400"},
             {std::string("400 1\0 2", 8), "a.spd:1: expected a wavelength and a value"},
         })
        CHECK_MESSAGE(contains(message_of([&] { read(text); }), what), text);
    CHECK(contains(message_of([&] { load_spectrum(folder.path() / "none.spd"); }), "none.spd: no such file"));
    CHECK(contains(message_of([&] { read(std::string((1 << 20) + 1, '\n')); }), "at most 1048576 are read"));
}

TEST_CASE("damaged spectra give an error or a colour") {
    const std::string text = "# lamp\n380 0.02\n420 0.11\n430.5\t0.35\r\n436 2.5\n441.5 0.35\n780 5e-2\n",
                      pairs = "400:0.1, 500:0.2 600:1e3, 700:-4";
    int errors = 0;
    for (std::uint32_t seed = 0; seed < 4000; ++seed) {
        try {
            const bool file = seed % 2 == 0;
            const Spectrum spectrum =
                file ? detail::parse_spectrum_file(mutated(text, seed), "a.spd") : parse(mutated(pairs, seed));
            for (const auto use : {SpectrumUse::reflectance, SpectrumUse::emission})
                CHECK(is_finite(spectrum_to_rgb(spectrum, use)));
        } catch (const Error&) {
            ++errors;
        }
    }
    CHECK(errors > 400);
    CHECK(errors < 3600);
}
