#pragma once

// Colours in scene files, in all the ways that Mitsuba's versions have for them.

#include <lightswitch/film/tonemap.hpp>
#include <lightswitch/load/xml_element.hpp>

namespace lightswitch::detail {

/// The three channels of "#rrggbb", from 0 to 1; nothing when it is none.
inline std::optional<DVec3> parse_hexadecimal(std::string_view text) {
    const std::string_view word = next_word(text);
    std::uint32_t value = 0;
    if (word.size() != 7 || word[0] != '#' || !next_word(text).empty()) return {};
    const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), value, 16);
    if (error != std::errc() || end != word.data() + word.size()) return {};
    return DVec3(value >> 16, (value >> 8) & 0xff, value & 0xff) / 255.0;
}

/// `<rgb>`, whose numbers are linear also where they are hexadecimal, as in Mitsuba 0.6 and 2; or `<srgb>`.
inline Rgb read_rgb(const XmlFile& file, pugi::xml_node node) {
    const auto hexadecimal = parse_hexadecimal(node.attribute("value").value());
    const auto numbers = hexadecimal ? std::vector<double>{hexadecimal->x, hexadecimal->y, hexadecimal->z}
                                     : read_numbers(file, node, "value", {1, 3});
    Rgb result(numbers.size() == 1 ? DVec3(numbers[0]) : DVec3(numbers[0], numbers[1], numbers[2]));
    if (std::string_view(node.name()) == "srgb")
        result = {srgb_decode(result.x), srgb_decode(result.y), srgb_decode(result.z)};
    if (!lightswitch::is_finite(result)) fail(file.origin(node), "the colour is too large");
    return result;
}

/// A `<blackbody>` of Mitsuba 0.6, whose temperature may end in K.
inline Rgb read_blackbody(const XmlFile& file, pugi::xml_node node) {
    std::string_view text = node.attribute("temperature").value();
    std::string_view word = next_word(text);
    if (word.ends_with('K') || word.ends_with('k')) word.remove_suffix(1);
    const auto temperature = parse_number(word);
    if (!temperature) fail(file.origin(node), quote(word) + " is not a temperature");
    const double scale = node.attribute("scale") ? read_numbers(file, node, "scale", {1})[0] : 1;
    return blackbody_to_rgb(*temperature, cie_first, cie_last, file.origin(node)) * static_cast<float>(scale);
}

/// A `<spectrum>` of some type, which is an object.
inline Rgb read_spectrum_of_type(XmlElement element, SpectrumUse use) {
    const std::string kind = element.type();
    const Origin where = element.origin();
    const auto list = [&](const char* name) { return element.text(name).value_or(""); };
    Rgb result;
    if (kind == "uniform") {
        result = Rgb(static_cast<float>(element.number("value", 1)));
    } else if (kind == "d65") {
        result = element.color("color", 1) * static_cast<float>(element.number("scale", 1));
    } else if (kind == "srgb") {
        result = element.color("color", 1);
    } else if (kind == "regular") {
        const double lowest = element.number("wavelength_min", cie_first),
                     highest = element.number("wavelength_max", cie_last);
        result = spectrum_to_rgb(parse_regular_spectrum(lowest, highest, list("values"), where), use, where);
    } else if (kind == "irregular") {
        const std::string wavelengths = list("wavelengths");
        result = spectrum_to_rgb(parse_irregular_spectrum(wavelengths, list("values"), where), use, where);
    } else if (kind == "blackbody") {
        const auto temperature = element.number("temperature");
        if (!temperature) element.error("the parameter \"temperature\" is missing");
        const double lowest = element.number("wavelength_min", cie_first);
        result = blackbody_to_rgb(*temperature, lowest, element.number("wavelength_max", cie_last), where);
    } else {
        element.unknown_type("uniform, d65, srgb, regular, irregular and blackbody");
    }
    element.finish();
    return result;
}

/// The colour of a `<spectrum>` by value, from a file, or of a type.
inline Rgb read_spectrum(const XmlFile& file, pugi::xml_node node, SpectrumUse use) {
    const Origin where = file.origin(node);
    if ((node.attribute("value") ? 1 : 0) + (node.attribute("filename") ? 1 : 0) + (node.attribute("type") ? 1 : 0) !=
        1)
        fail(where, "needs one of the attributes \"value\", \"filename\" and \"type\"");
    if (node.attribute("type")) return read_spectrum_of_type(XmlElement(file, node), use);
    if (node.attribute("filename"))
        return at_place(where, [&] {
            return spectrum_to_rgb(load_spectrum(file.locate(node, node.attribute("filename").value())), use);
        });
    const std::string_view value = node.attribute("value").value();
    // What Mitsuba 0.6 calls a spectrum of three samples is one of its RGB colours.
    if (file.is_old(node) && value.find(':') == std::string_view::npos &&
        (parse_hexadecimal(value) || parse_list(value, where).size() == 3))
        return read_rgb(file, node);
    return spectrum_to_rgb(parse_spectrum(value, where), use, where);
}

inline Rgb XmlElement::color(const std::string& name, const Rgb& otherwise, SpectrumUse use) {
    return log().attempt(
        "its default is used",
        [&] {
            const auto node = find(name, {"rgb", "float", "integer", "spectrum", "srgb", "blackbody"});
            if (!node) return otherwise;
            const std::string_view tag = node.name();
            if (tag == "spectrum") return read_spectrum(file_, node, use);
            if (tag == "blackbody") return read_blackbody(file_, node);
            return read_rgb(file_, node);
        },
        [&] { return otherwise; });
}

}  // namespace lightswitch::detail
